"""Find mentions, in texts of a package, of names that its code does not seem to use.

Such a mention speaks against reporting the name as unused.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import accumulate
from typing import TYPE_CHECKING

from ros_lint.base.paths import join
from ros_lint.base.text import Span, file_start, span_in, to_bytes
from ros_lint.base.tree import Tree, contents
from ros_lint.facts.sources import Via
from ros_lint.workspace.model import Package
from ros_lint.workspace.usage.package_files import Source
from ros_lint.workspace.usage.resolve import satisfying, used_names
from ros_lint.workspace.usage.unqualified_types import Types
from ros_lint.workspace.usage.unused_find_package import unused_in_sight
from ros_lint.workspace.usage.visibility import is_build_visible, is_traceless_by_name, name_suggests_no_trace

if TYPE_CHECKING:
    from ros_lint.knowledge.world import World

_NO_TEXT = (
    ".md", ".rst", ".png", ".jpg", ".svg", ".gif", ".pdf", ".stl", ".dae", ".obj", ".pgm", ".pcd",
    ".zip", ".onnx", ".bag", ".mcap",
)  # fmt: skip
_NO_TRACE = ("changelog", "readme", "license", "licence", "contributing", "quality_declaration", "copying", "notice")


def of_package(tree: Tree, package: Package, source: Source, world: World, types: Types) -> Mapping[str, Span]:
    """Return a place for each declared name that a text of the package contains and no code uses."""
    if not is_build_visible(package):
        return {}
    built = [d.name for d in package.declared if d.depend.tag in ("depend", "build_depend") and d.always]
    used, satisfied = used_names(built, package.uses), satisfying(package.uses)
    names = world.knowledge.names
    wanted = [
        name
        for name in dict.fromkeys(built)
        if not (name in used or name_suggests_no_trace(world, name) or (name in satisfied and is_traceless_by_name(world, name)))
    ]
    libraries = {name: names.called(name) for name in wanted if world.is_key(name)}
    found = mentioned(wanted, source, libraries, _may_trace) if wanted else {}
    remaining = [name for name in wanted if name not in found]
    if remaining:
        found = {**found, **find_mentions(remaining, _contents(tree, package, package.files), libraries)}
        remaining = [name for name in remaining if name not in found]
    if remaining:
        found = {**found, **types.used(source, remaining)}
        remaining = [name for name in remaining if name not in found]
    return {**found, **_started(remaining, tree, package)} if remaining else found


def _started(names: Sequence[str], tree: Tree, package: Package) -> dict[str, Span]:
    """Return a place for each name that a documentation page starts with ``ros2 run`` or ``ros2 launch``.

    A page that cannot be read may do so for each name.
    """
    found: dict[str, Span] = {}
    for path in (join(package.path, file) for file in package.files if file.lower().endswith(_PAGES)):
        try:
            data = tree.read(path)
        except OSError:
            return dict.fromkeys(names, file_start(path))
        for match in _START.finditer(data) if b"ros2 " in data else ():
            name = match[1].decode()
            if name in names:
                found.setdefault(name, span_in(path, data, *match.span(1)))
    return found


_PAGES = (".md", ".rst")
_START = re.compile(rb"ros2 +(?:run|launch) +([a-z][a-z0-9_]*)")
"""A command line in a documentation page."""


def possibly_used(tree: Tree, package: Package, source: Source, world: World, types: Types) -> frozenset[str]:
    """Return the packages that CMake finds and that may be used although no code certainly uses them.

    Each of these suffices:

    * A text other than a build script contains the name: a namespace is often available through a header of another
      package.
    * The script uses a variable of the package for more than linking.
    * A header of an unknown package may be one of its headers.
    """
    wanted = [mention.name for mention in unused_in_sight(package) if not is_traceless_by_name(world, mention.name)]
    if not wanted:
        return frozenset()
    scripts, others = ([file for file in package.files if file.endswith(_OF_BUILD) is of_build] for of_build in (True, False))
    found = frozenset(find_mentions(wanted, _contents(tree, package, others), whole=True))
    commands = b"\n".join([data for _, data in _contents(tree, package, scripts)])
    found |= {name for name in wanted if re.search(_VARIABLE % re.escape(to_bytes(name)), commands)}
    if len(found) < len(wanted):
        folders = _unknown_folders(package, source)
        found |= {name for name in wanted if any(f"{name}_".startswith(f"{folder}_") for folder in folders)}
    return found.union(types.used(source, [name for name in wanted if name not in found]))


def unwritten(tree: Tree, package: Package) -> frozenset[str]:
    """Return the classes in plugin descriptions whose name is not in a source of the package.

    Empty if a macro may compose names, because the full name need not be in a source.
    """
    made = {registration.name for registration in package.registrations}
    plugins = package.built.files.plugin_files
    described = [entry.type for plugin in plugins for library in plugin.libraries for entry in library.classes]
    wanted = [name for name in dict.fromkeys(described) if name not in made]
    if not wanted:
        return frozenset()
    sources = [file for file in package.files if file.endswith(_OF_CODE) or file.endswith(_OF_BUILD)]
    words = {name: word for name in wanted if (word := to_bytes(name.rpartition("::")[2]))}
    for _, data in contents(tree, package.path, sources):
        if _PUT_TOGETHER.search(data):
            return frozenset()
        words = {name: word for name, word in words.items() if not re.search(rb"\b%s\b" % re.escape(word), data)}
    return frozenset(words)


_PUT_TOGETHER = re.compile(rb"#[ \t]*define\b(?:[^\n]|\\\n)*(?:PLUGINLIB_EXPORT_|CLASS_LOADER_REGISTER_)CLASS")
"""A definition of a macro that exports classes: it may also compose their names."""

_OF_CODE = (".c", ".cc", ".cpp", ".cu", ".cxx", ".em", ".h", ".hh", ".hpp", ".hxx", ".in", ".inl", ".ipp", ".jinja", ".py")
"""Suffixes of sources and of templates of sources."""


def _unknown_folders(package: Package, source: Source) -> frozenset[str]:
    """Return the first folders of included headers that no known package has.

    The names of packages begin with such a folder, as ``moveit_core`` with the folder of
    ``moveit/planning_scene.h``.
    """
    used = {use.span for use in package.uses if use.via == "include"}
    found = {
        mention.name
        for facts in source.facts.values()
        for mention in facts.mentions
        if mention.via == "include" and "/" in mention.name and mention.span not in used
    }
    own = "\n".join(["", *package.files, ""])
    return frozenset(header.partition("/")[0] for header in found if f"/{header}\n" not in own)


_VARIABLE = rb"\$\{%s_(?!(?:TARGETS|LIBRAR|INCLUDE_DIR|DEFINITIONS|FOUND|VERSION)\w*\})"
"""A variable of a found package that is used for more than linking, for example its list of files."""

_OF_BUILD = ("CMakeLists.txt", ".cmake")


def _contents(tree: Tree, package: Package, files: Iterable[str]) -> Iterator[tuple[str, bytes]]:
    """Yield the files of a package that may be evidence of a use: no documentation and no package.xml."""
    for path, data in contents(tree, package.path, filter(_may_trace, files)):
        if b"\0" not in data[:1024]:
            yield path, data


def _may_trace(file: str) -> bool:
    name = file.rpartition("/")[2].lower()
    return not (name == "package.xml" or name.startswith(_NO_TRACE) or name.endswith(_NO_TEXT))


def find_mentions(
    names: Sequence[str],
    files: Iterable[tuple[str, bytes]],
    words: Mapping[str, Sequence[str]] | None = None,
    *,
    whole: bool = False,
) -> dict[str, Span]:
    """Return a place for each name that is a word in one of the files; dashes equal underscores.

    ``files`` are paths with contents. Several files are searched at once and undecoded, because few contain a name.
    ``words`` replaces some of the names by other texts, which are searched for anywhere and case-insensitively.
    With ``whole`` a part of a longer name does not count: ``tf2`` is not in ``tf2_ros``.
    """
    found: dict[str, Span] = {}
    for batch in _batches(files):
        found.update(_traces_in(batch, [name for name in names if name not in found], words or {}, whole))
        if len(found) == len(names):
            break
    return {name: found[name] for name in names if name in found}


_BATCH = 1 << 24
"""Bytes of texts that are searched together; most packages have less."""


def _batches(files: Iterable[tuple[str, bytes]]) -> Iterator[list[tuple[str, bytes]]]:
    """Yield the files in batches, each of which ends with the file that reaches the size limit."""
    batch: list[tuple[str, bytes]] = []
    size = 0
    for path, data in files:
        batch.append((path, data))
        size += len(data)
        if size >= _BATCH:
            yield batch
            batch, size = [], 0
    yield batch


def _traces_in(
    listed: Sequence[tuple[str, bytes]], names: Sequence[str], words: Mapping[str, Sequence[str]], whole: bool
) -> dict[str, Span]:
    data = b"\n".join([content for _, content in listed])
    starts = list(accumulate([len(content) + 1 for _, content in listed], initial=0))
    found: dict[str, Span] = {}
    lower = data.lower() if words else b""
    for name in names:
        if name in words:
            places = ((lower.find(to_bytes(word.lower())), to_bytes(word)) for word in words[name])
        else:
            places = ((_find_word(data, spelling, _JOINING if whole else b""), spelling) for spelling in _written(name, data))
        start, spelling = next((place for place in places if place[0] >= 0), (-1, b""))
        if start < 0:
            continue
        file = bisect_right(starts, start) - 1
        offset = start - starts[file]
        found[name] = span_in(*listed[file], offset, offset + len(spelling))
    return found


def mentioned(
    names: Sequence[str], source: Source, words: Mapping[str, Sequence[str]], counts: Callable[[str], bool]
) -> dict[str, Span]:
    """Return the result of :func:`find_mentions` for names in includes and imports, without reading texts.

    ``counts`` decides which files are searched.
    """
    mentions = [
        mention
        for file, facts in source.facts.items()
        if facts.mentions and counts(file)
        for mention in facts.mentions
        if mention[1] in _AS_WRITTEN  # by index: there are ten thousands
    ]
    lines = to_bytes("\n".join([mention[0] for mention in mentions]))
    return {name: mentions[span.line - 1].span for name, span in find_mentions(names, [("", lines)], words).items()}


_AS_WRITTEN: frozenset[Via] = frozenset({"include", "import", "symbol"})
"""Name spaces of mentions whose name is literally in the source."""


def _written(name: str, data: bytes) -> Iterator[bytes]:
    """Yield the spellings of a name whose last part is in ``data``.

    The last parts are searched first because they are rarer than the first parts.
    """
    there: dict[bytes, bool] = {}
    for spelling in _spellings(name):
        written = to_bytes(spelling)
        end = _SEPARATOR.split(written, maxsplit=1)[-1]
        if end not in there:
            there[end] = end in data
        if there[end]:
            yield written


_SEPARATOR = re.compile(rb"[-_/]|::")


def _spellings(name: str) -> tuple[str, ...]:
    """Return the spellings of a package name: with dashes, as a nested namespace, as an include folder.

    Code in the outer namespace omits it, and libraries omit the prefix ``lib``. Conversions of tf2 are selected by
    the types of their arguments, so only ``tf2`` is in the code.
    """
    found = [name, name.replace("-", "_"), name.replace("_", "-"), name.replace("_", "::", 1), name.replace("_", "/", 1)]
    inner = name.partition("_")[2]
    if "_" in inner and name not in _CONVERSIONS:
        found.append(f"{inner}::")
    if name.startswith("lib"):
        found += [f"{name[3:]}/", f"{name[3:]}::"]
    return tuple(dict.fromkeys([*found, "tf2"] if name in _CONVERSIONS else found))


_CONVERSIONS = frozenset({"tf2_bullet", "tf2_eigen", "tf2_eigen_kdl", "tf2_geometry_msgs", "tf2_kdl", "tf2_sensor_msgs"})


_JOINING = b"-_"


def _find_word(data: bytes, word: bytes, joining: bytes) -> int:
    """Return the offset of a word, -1 if there is none. This is many times faster than a pattern.

    ``joining`` are the bytes that belong to a word besides letters and digits. A word that ends with another
    character is complete whatever follows.
    """
    start = data.find(word)
    marked = not word[-1:].isalnum()
    joining = _JOINING if marked else joining
    while start >= 0:
        end = start + len(word)
        around = data[max(start - 1, 0) : start], b"" if marked else data[end : end + 1]
        if not any(byte.isalnum() or (byte and byte in joining) for byte in around):
            return start
        start = data.find(word, start + 1)
    return -1
