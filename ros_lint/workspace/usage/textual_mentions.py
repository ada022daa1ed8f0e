"""Search the files of a package as plain text for names of dependencies that its code does not seem to use.

A name that occurs in such a file is not reported as unused.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cache, partial
from itertools import accumulate
from typing import TYPE_CHECKING

from ros_lint.base.paths import join
from ros_lint.base.text import Span, Text, file_start, from_bytes, span_in, to_bytes
from ros_lint.base.tree import Tree, contents
from ros_lint.collectors.comments import comments
from ros_lint.facts.sources import Via
from ros_lint.workspace.model import Declared, Package
from ros_lint.workspace.usage.package_files import PackageSource
from ros_lint.workspace.usage.resolve import satisfying, used_names
from ros_lint.workspace.usage.unqualified_types import Types
from ros_lint.workspace.usage.unused_find_package import unused_finds
from ros_lint.workspace.usage.visibility import is_build_visible, is_traceless_by_name, name_suggests_no_trace

if TYPE_CHECKING:
    from ros_lint.knowledge.world import World

_SKIPPED_SUFFIXES = (
    ".md", ".rst", ".png", ".jpg", ".svg", ".gif", ".pdf", ".stl", ".dae", ".obj", ".pgm", ".pcd",
    ".zip", ".onnx", ".bag", ".mcap",
)  # fmt: skip
_SKIPPED_PREFIXES = ("changelog", "readme", "license", "licence", "contributing", "quality_declaration", "copying", "notice")


def find_textual_mentions(tree: Tree, package: Package, source: PackageSource, world: World, types: Types) -> Mapping[str, Span]:
    """Return, for each declared name that no code uses, a place where the text of a file of the package contains it.

    Names that occur nowhere are left out.
    """
    if not is_build_visible(package):
        return {}
    declared = [d.name for d in package.declared if d.always and _needs_a_trace(world, d)]
    used_declared, satisfied = used_names(declared, package.uses), satisfying(package.uses)
    names = world.knowledge.names
    unused = [
        name
        for name in dict.fromkeys(declared)
        if not (
            name in used_declared
            or name_suggests_no_trace(world, name)
            or (name in satisfied and is_traceless_by_name(world, name))
        )
    ]
    libraries = {name: names.called(name) for name in unused if world.is_key(name)}
    places = find_code_mentions(unused, source, libraries, _is_searched) if unused else {}
    remaining = [name for name in unused if name not in places]
    if remaining:
        places = {**places, **find_mentions(remaining, _contents(tree, package, package.files), libraries)}
        remaining = [name for name in remaining if name not in places]
    if remaining:
        places = {**places, **_named_by_prefix(remaining, _c_sources(tree, package)), **types.used(source, remaining)}
        remaining = [name for name in remaining if name not in places]
    return {**places, **_find_commands_in_pages(remaining, tree, package)} if remaining else places


def _needs_a_trace(world: World, declared: Declared) -> bool:
    """Return whether a dependency is reported as unused if no file of the package contains its name.

    The result is True for dependencies for the build, and for test dependencies on message packages.
    """
    tag = declared.depend.tag
    if tag == "test_depend":
        released = world.released(declared.name)
        return released is not None and bool(released.interfaces)
    return tag in ("depend", "build_depend")


def _find_commands_in_pages(names: Sequence[str], tree: Tree, package: Package) -> dict[str, Span]:
    """Return, for each of the package names, a place in a documentation page with ``ros2 run NAME`` or ``ros2 launch NAME``.

    If a page cannot be read, its start is the place for every name, because the page may contain the commands.
    """
    places: dict[str, Span] = {}
    for path in (join(package.path, file) for file in package.files if file.lower().endswith(_PAGES)):
        try:
            data = tree.read(path)
        except OSError:
            return dict.fromkeys(names, file_start(path))
        for match in _START.finditer(data) if b"ros2 " in data else ():
            name = match[1].decode()
            if name in names:
                places.setdefault(name, span_in(path, data, *match.span(1)))
    return places


_PAGES = (".md", ".rst")
_START = re.compile(rb"ros2 +(?:run|launch) +([a-z][a-z0-9_]*)")
"""Matches ``ros2 run PACKAGE`` and ``ros2 launch PACKAGE`` in a documentation page."""


def possibly_used(tree: Tree, package: Package, source: PackageSource, world: World, types: Types) -> frozenset[str]:
    """Return the packages that CMake finds and the package may use, although no code certainly uses them.

    Each of these suffices:

    * The text of a file other than a build script contains the name: a namespace is often available through a header of
      another package.
    * C or C++ code contains a type, function or macro that begins with the name: ``rmw_request_id_t``, ``RCUTILS_LOG_INFO(``.
    * The script uses a CMake variable of the package for more than linking.
    * An included header of an unknown package may belong to the package.
    """
    unused = [mention.name for mention in unused_finds(package) if not is_traceless_by_name(world, mention.name)]
    if not unused:
        return frozenset()
    scripts, other_files = (
        [file for file in package.files if file.endswith(_SCRIPT_SUFFIXES) is of_build] for of_build in (True, False)
    )
    result = frozenset(find_mentions(unused, _contents(tree, package, other_files), whole_names=True))
    commands = b"\n".join([data for _, data in _contents(tree, package, scripts)])
    result |= {name for name in unused if re.search(_VARIABLE % re.escape(to_bytes(name)), commands)}
    result |= _named_by_prefix([name for name in unused if name not in result], _c_sources(tree, package)).keys()
    if len(result) < len(unused):
        folders = _unknown_folders(package, source)
        result |= {name for name in unused if any(f"{name}_".startswith(f"{folder}_") for folder in folders)}
    return result.union(types.used(source, [name for name in unused if name not in result]))


def _named_by_prefix(names: Sequence[str], files: Iterable[tuple[str, bytes]]) -> dict[str, Span]:
    """Return, for each package name with which an identifier in C code begins, such a place: ``rmw`` for ``rmw_request_id_t``.

    The identifiers are those of types, functions and macros in ``files``, outside comments.
    """
    result: dict[str, Span] = {}
    for path, data in files if names else ():
        for name in names:
            word = to_bytes(name)
            if name in result or not (word + b"_" in data or word.upper() + b"_" in data):
                continue  # a quick check that excludes most files, because the pattern is slow
            pattern = re.compile(_OF_C % {b"name": re.escape(word), b"NAME": re.escape(word.upper())})
            if pattern.search(data) and (match := pattern.search(_without_comments(path, data))):
                result[name] = span_in(path, data, *match.span())
    return result


def _c_sources(tree: Tree, package: Package) -> Iterator[tuple[str, bytes]]:
    """Yield path and contents of the C and C++ files of a package."""
    return _contents(tree, package, [file for file in package.files if file.endswith(_C_SUFFIXES)])


_OF_C = rb"\b(?:%(name)s_(?:\w+_t\b|\w*[a-z0-9][ \t]*\()|%(NAME)s_[A-Z0-9_]+[ \t]*\()"
"""Matches a name of a C library, which has no namespaces: a type, or a function or macro that is called."""
_C_SUFFIXES = (".c", ".cc", ".cpp", ".cxx", ".h", ".hh", ".hpp", ".hxx")


def find_unwritten_classes(tree: Tree, package: Package) -> frozenset[str]:
    """Return the classes in plugin descriptions whose name does not occur in the sources of the package.

    Empty if a macro may compose names, because the full name then need not occur.
    """
    registered = {registration.name for registration in package.registrations}
    plugins = package.built.files.plugin_files
    described = [entry.type for plugin in plugins for library in plugin.libraries for entry in library.classes]
    unregistered = [name for name in dict.fromkeys(described) if name not in registered]
    if not unregistered:
        return frozenset()
    sources = [file for file in package.files if file.endswith(_CODE_SUFFIXES) or file.endswith(_SCRIPT_SUFFIXES)]
    words = {name: word for name in unregistered if (word := to_bytes(name.rpartition("::")[2]))}
    for _, data in contents(tree, package.path, sources):
        if _COMPOSING_MACRO.search(data):
            return frozenset()
        words = {name: word for name, word in words.items() if not re.search(rb"\b%s\b" % re.escape(word), data)}
    return frozenset(words)


_COMPOSING_MACRO = re.compile(rb"#[ \t]*define\b(?:[^\n]|\\\n)*(?:PLUGINLIB_EXPORT_|CLASS_LOADER_REGISTER_)CLASS")
"""Matches the definition of a macro that exports classes, because it may also compose their names."""

_CODE_SUFFIXES = (".c", ".cc", ".cpp", ".cu", ".cxx", ".em", ".h", ".hh", ".hpp", ".hxx", ".in", ".inl", ".ipp", ".jinja", ".py")
"""Suffixes of sources and of templates of sources."""


def _unknown_folders(package: Package, source: PackageSource) -> frozenset[str]:
    """Return the first folder of each included header that no known package provides.

    The name of the package with the header often begins with this folder: ``moveit_core`` provides ``moveit/planning_scene.h``.
    """
    used = {use.span for use in package.uses if use.via == "include"}
    headers = {
        mention.name
        for facts in source.facts.values()
        for mention in facts.mentions
        if mention.via == "include" and "/" in mention.name and mention.span not in used
    }
    own_files = "\n".join(["", *package.files, ""])
    return frozenset(header.partition("/")[0] for header in headers if f"/{header}\n" not in own_files)


_VARIABLE = rb"\$\{%s_(?!(?:TARGETS|LIBRAR|INCLUDE_DIR|DEFINITIONS|FOUND|VERSION)\w*\})"
"""Matches a CMake variable of a found package that is used for more than linking, for example its list of files.

Example: ``${robot_MESHES}``, but not ``${robot_LIBRARIES}``.
"""

_SCRIPT_SUFFIXES = ("CMakeLists.txt", ".cmake")


def _contents(tree: Tree, package: Package, files: Iterable[str]) -> Iterator[tuple[str, bytes]]:
    """Yield path and contents of the files of a package that may be evidence of a use: no documentation and no package.xml."""
    for path, data in contents(tree, package.path, filter(_is_searched, files)):
        if b"\0" not in data[:1024]:
            yield path, data


def _is_searched(file: str) -> bool:
    name = file.rpartition("/")[2].lower()
    return not (name == "package.xml" or name.startswith(_SKIPPED_PREFIXES) or name.endswith(_SKIPPED_SUFFIXES))


def find_mentions(
    names: Sequence[str],
    files: Iterable[tuple[str, bytes]],
    words: Mapping[str, Sequence[str]] | None = None,
    *,
    whole_names: bool = False,
) -> dict[str, Span]:
    """Return, for each name, a place where it is a word in one of the files, outside comments. Dashes equal underscores.

    ``files`` are paths with contents. Several files are searched at once and undecoded, because few contain a name.
    ``words`` maps some of the names to other texts to search for. These texts match anywhere and case-insensitively.
    With ``whole_names``, a part of a longer name does not count: ``tf2`` is not in ``tf2_ros``.
    """
    places: dict[str, Span] = {}
    for batch in _batches(files):
        places.update(_search_batch(batch, [name for name in names if name not in places], words or {}, whole_names))
        if len(places) == len(names):
            break
    return {name: places[name] for name in names if name in places}


_BATCH = 1 << 24
"""Number of bytes that are searched together; most packages have less."""


def _batches(files: Iterable[tuple[str, bytes]]) -> Iterator[list[tuple[str, bytes]]]:
    """Yield the files in batches. A batch ends with the file that reaches the size limit ``_BATCH``."""
    batch: list[tuple[str, bytes]] = []
    size = 0
    for path, data in files:
        batch.append((path, data))
        size += len(data)
        if size >= _BATCH:
            yield batch
            batch, size = [], 0
    yield batch


def _search_batch(
    files: Sequence[tuple[str, bytes]], names: Sequence[str], words: Mapping[str, Sequence[str]], whole_names: bool
) -> dict[str, Span]:
    data = b"\n".join([content for _, content in files])
    starts = list(accumulate([len(content) + 1 for _, content in files], initial=0))
    without_comments = cache(lambda index: _without_comments(*files[index]))
    result: dict[str, Span] = {}
    for name in names:
        search = partial(_search_words, words[name]) if name in words else partial(_search_spellings, name, whole_names)
        start, spelling = search(data)
        index = bisect_right(starts, start) - 1 if start >= 0 else len(files)
        while index < len(files):
            offset, spelling = search(without_comments(index)) if search(files[index][1])[0] >= 0 else (-1, spelling)
            if offset >= 0:
                result[name] = span_in(*files[index], offset, offset + len(spelling))
                break
            index += 1
    return result


def _search_words(words: Sequence[str], data: bytes) -> tuple[int, bytes]:
    """Find the first element of ``words`` that occurs in ``data``, in upper or lower case. Return its offset and the word.

    A part of a longer word counts, too. The offset is -1 if no word occurs.
    """
    lower = data.lower()
    places = ((lower.find(to_bytes(word.lower())), to_bytes(word)) for word in words)
    return next((place for place in places if place[0] >= 0), (-1, b""))


def _search_spellings(name: str, whole_names: bool, data: bytes) -> tuple[int, bytes]:
    """Return the offset of a package name in ``data`` and its spelling there, -1 and b"" if no spelling of the name occurs.

    A spelling is a form of the name in code: ``nav_core``, ``nav-core``, ``nav::core``. ``whole_names`` ignores the name where it
    is joined to another word by ``-`` or ``_``.
    """
    joining = _WORD_JOINERS if whole_names else b""
    places = ((_find_word(data, spelling, joining), spelling) for spelling in _present_spellings(name, data))
    return next((place for place in places if place[0] >= 0), (-1, b""))


def _without_comments(path: str, data: bytes) -> bytes:
    """Return the contents of a file with spaces in place of its comments, so that offsets stay the same."""
    text = Text(path, from_bytes(data))
    parts: list[str] = []
    at = 0
    for start, end in comments(text):
        parts += text.text[at:start], " " * len(to_bytes(text.text[start:end]))
        at = end
    return to_bytes("".join([*parts, text.text[at:]]))


def find_code_mentions(
    names: Sequence[str], source: PackageSource, words: Mapping[str, Sequence[str]], is_searched: Callable[[str], bool]
) -> dict[str, Span]:
    """Return, for each name, a place where it occurs in an include or import. No file is read, only the collected facts.

    ``names`` and ``words`` have the meaning as in :func:`find_mentions`. ``is_searched`` decides which files count.
    """
    mentions = [
        mention
        for file, facts in source.facts.items()
        if facts.mentions and is_searched(file)
        for mention in facts.mentions
        if mention[1] in _LITERAL_SPACES  # mention[1] is mention.via, but faster: there are tens of thousands of mentions
    ]
    lines = to_bytes("\n".join([mention[0] for mention in mentions]))
    return {name: mentions[span.line - 1].span for name, span in find_mentions(names, [("", lines)], words).items()}


_LITERAL_SPACES: frozenset[Via] = frozenset({"include", "import", "symbol"})
"""Kinds of mentioned names that code contains literally."""


def _present_spellings(name: str, data: bytes) -> Iterator[bytes]:
    """Yield the spellings of a package name (``nav_core``, ``nav::core``) whose last part is in ``data``.

    The last parts are searched first because they are rarer than the first parts.
    """
    present: dict[bytes, bool] = {}
    for spelling in _spellings(name):
        data_word = to_bytes(spelling)
        end = _SEPARATOR.split(data_word, maxsplit=1)[-1]
        if end not in present:
            present[end] = end in data
        if present[end]:
            yield data_word


_SEPARATOR = re.compile(rb"[-_/]|::")


def _spellings(name: str) -> tuple[str, ...]:
    """Return the forms of a package name in code: with dashes, as a nested namespace, as an include folder.

    Code inside the outer namespace omits that namespace, and libraries omit the prefix ``lib``. The forms of ``tf2_eigen`` and
    of similar packages are the functions of ``tf2`` that these packages define for their types.
    """
    spellings = [name, name.replace("-", "_"), name.replace("_", "-"), name.replace("_", "::", 1), name.replace("_", "/", 1)]
    inner = name.partition("_")[2]
    if "_" in inner and name not in _CONVERSIONS:
        spellings.append(f"{inner}::")
    if name.startswith("lib"):
        spellings += [f"{name[3:]}/", f"{name[3:]}::"]
    return tuple(dict.fromkeys([*spellings, *_CONVERTERS] if name in _CONVERSIONS else spellings))


_CONVERSIONS = frozenset({"tf2_bullet", "tf2_eigen", "tf2_eigen_kdl", "tf2_geometry_msgs", "tf2_kdl", "tf2_sensor_msgs"})
"""Packages whose headers define the functions of :data:`_CONVERTERS` for further types."""
_CONVERTERS = (
    "toMsg",
    "fromMsg",
    "doTransform",
    "convert",
    "transform",
    "getYaw",
    "getEulerYPR",
    "to_msg",
    "from_msg",
    "do_transform",
)
"""Functions of tf2 (``tf2/convert.hpp``, ``tf2/utils.hpp``, ``tf2_ros/buffer_interface.hpp``) and their forms in Python."""


_WORD_JOINERS = b"-_"


def _find_word(data: bytes, word: bytes, joining: bytes) -> int:
    """Return the offset of a word, -1 if there is none. This is many times faster than a regular expression.

    ``joining`` are the bytes that belong to a word besides letters and digits. If ``word`` ends with neither a letter nor a
    digit (``tf2::``), any byte may follow it.
    """
    start = data.find(word)
    marked = not word[-1:].isalnum()
    joining = _WORD_JOINERS if marked else joining
    while start >= 0:
        end = start + len(word)
        around = data[max(start - 1, 0) : start], b"" if marked else data[end : end + 1]
        if not any(byte.isalnum() or (byte and byte in joining) for byte in around):
            return start
        start = data.find(word, start + 1)
    return -1
