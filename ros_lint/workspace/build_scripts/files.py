"""Collect files related to a build script: plugin descriptions, programs, resources."""

from __future__ import annotations

import re
from collections.abc import Container, Iterator, Mapping, Sequence, Set

from ros_lint.base.auxiliary_files import is_auxiliary
from ros_lint.base.paths import folders_of, join, parent, resolve
from ros_lint.base.text import Span, Text, from_bytes, span_in, to_bytes
from ros_lint.base.tree import Tree, contents, text_of
from ros_lint.collectors.cmake.syntax import Parsed
from ros_lint.collectors.launch.detect import is_of_ros_1
from ros_lint.collectors.resources import plugin_descriptions as plugin_xml
from ros_lint.facts.build import BuildFiles, BuildScript, ScriptFile
from ros_lint.facts.visibility import Facet
from ros_lint.workspace.build_scripts import resources as resource_files
from ros_lint.workspace.discovery.discover import DiscoveredPackage

_PLUGIN_FILE = re.compile(r"plugin.*\.xml\Z", re.IGNORECASE)
_SCRIPTS = re.compile(r"(?:scripts|nodes|bin|script)/[^/]+\Z")
_MOST_RESOURCES = 40
"""Maximum number of resources of a folder: a tree of models has thousands, and one reference suffices."""
_PAGES = (".md", ".rst", ".txt", ".sh", ".bash")
_TELLS = (*_PAGES, ".py", ".yaml", ".yml")
"""Suffixes of texts that may contain ``ros2 run`` commands."""

_Texts = Sequence[tuple[str, bytes]]
"""Files of a package that can refer to resources: paths in the tree and contents."""


def with_files(tree: Tree, found: DiscoveredPackage, commands: Mapping[str, Parsed], script: BuildScript) -> BuildScript:
    """Return a script with facts of related files: plugin descriptions, scripts, resources.

    ``commands`` are its CMake files, by path relative to the package.
    """
    named = {call.texts[1] for call in script.commands.calls if call.name.startswith("pluginlib_export") and len(call.args) > 1}
    markup = [file for file in found.files if file.endswith(".xml")]
    candidates = [file for file in markup if file in named or _PLUGIN_FILE.search(file)]
    described = (plugin_xml.collect(file, text) for file in candidates if (text := text_in(tree, found, file)))
    plugins = tuple([plugin for plugin in described if plugin])
    started = (f"lib/{found.name}/", "bin/")
    sources = dict.fromkeys([p.source for p in script.products.installs if p.source and p.path.startswith(started)])
    folders = {file.rpartition("/")[0] for file in sources}
    if script.of_cmake and not any(p.source.startswith(f"{found.name}/") for p in script.products.installs):
        folders.add(found.name)  # a Python package that CMake does not install
    sources.update(dict.fromkeys(_programs(found.files, folders)))
    executables = Executables(tree, found)
    texts = {file: text for file in sources if (text := text_in(tree, found, file))}
    files = [_script_file(file, text, file in executables) for file, text in texts.items()]
    files = [file._replace(helper=_is_helper(file, texts)) for file in files]
    files = _with_runs(tree, found, script, files)
    missing = {} if script.hides(Facet.SHARE) else resource_files.uninstalled_resources(found.files, script.products.installed)
    if not (plugins or files or missing):
        return script
    texts_that_name = contents(tree, found.path, filter(resource_files.may_name, found.files)) if missing else ()
    every = [(path, data) for path, data in texts_that_name if not (b"<launch" in data and is_of_ros_1(from_bytes(data)))]
    macros = _source_folders(commands) if missing else None
    naming = [(path, data) for path, data in every if not (macros and macros.search(data))]
    in_sources = [data for _, data in every if macros and macros.search(data)]
    pages = [*contents(tree, found.path, (file for file in found.files if file.endswith(".md")))] if missing else []
    build_inputs = (
        *_inputs(commands, missing, [file.path for file in files]),
        *_read_in_sources(found, missing, [*naming, *pages]),
        *(f"{folder}/" for folder in missing if any(b'"/%s/' % to_bytes(folder) in data for data in in_sources)),
    )
    return script._replace(
        files=BuildFiles(plugins, tuple(files), tuple(_named(tree, found, missing, naming)), build_inputs),
    )


def _inputs(scripts: Mapping[str, Parsed], missing: Mapping[str, Sequence[str]], programs: Sequence[str]) -> Iterator[str]:
    """Yield resources, their folders and programs that are arguments of CMake commands except install()."""
    if not missing and not programs:
        return
    subfolders = [command for parsed in scripts.values() for command in parsed.commands if command.name == "add_subdirectory"]
    entered = [command.args[0][0] for command in subfolders if command.args]
    built = (parsed for path, parsed in scripts.items() if _may_be_read(path, entered))
    commands = (command for parsed in built for command in parsed.commands if command.name != "install")
    text = "\n".join([argument[0] for command in commands for argument in command.args])
    for folder, files in missing.items():
        if re.search(rf"(?<![\w.-]){re.escape(folder)}(?:/|$)", text, re.MULTILINE):
            yield f"{folder}/"
        yield from (file for file in files if file.rpartition("/")[2] in text)
    yield from (file for file in programs if re.search(rf"(?<![\w.-]){re.escape(file)}(?![\w.-])", text))


def _source_folders(scripts: Mapping[str, Parsed]) -> re.Pattern[bytes] | None:
    """Return a pattern for macros in code whose value is the source folder, None if CMake defines none."""
    commands = (command for parsed in scripts.values() for command in parsed.commands if command.name in _DEFINE)
    found = {match[1] for command in commands for argument in command.args if (match := _HOLDS_SOURCES.match(argument[0]))}
    return re.compile(rb"\b(?:%s)\b" % b"|".join(sorted(map(to_bytes, found)))) if found else None


_DEFINE = frozenset({"add_compile_definitions", "add_definitions", "target_compile_definitions"})
_HOLDS_SOURCES = re.compile(r"(?:-D)?(\w+)=[\\\"]*\$\{\w*_SOURCE_DIR\}")


def _read_in_sources(found: DiscoveredPackage, missing: Mapping[str, Sequence[str]], naming: _Texts) -> Iterator[str]:
    """Yield resource folders that a text names in the sources, as in ``/home/me/src/robot/maps/hall``.

    Texts in the folder itself do not count: xacro writes the path of its input into the generated model.
    """
    if not missing:
        return
    top = found.path.rpartition("/")[2] or found.name
    folders = b"|".join([re.escape(to_bytes(folder)) for folder in missing])
    place = re.compile(rb"(?<=[\w.~}-])(?<!\bshare)/%s/(%s)(?![\w.-])" % (re.escape(to_bytes(top)), folders))
    part = re.compile(rb"(?<=[\"'])(%s)(?=[\"'])" % folders)
    below = b"/%s/" % to_bytes(top)
    for path, data in naming:
        if below in data:  # the pattern takes a hundred times as long
            named = {from_bytes(hit[1]) for hit in place.finditer(data)}
            yield from (f"{folder}/" for folder in sorted(named) if not path.startswith(f"{join(found.path, folder)}/"))
        if _OF_SOURCES.search(data) and not path.endswith(".md"):
            yield from (f"{from_bytes(hit[1])}/" for hit in part.finditer(data) if _is_below_sources(data, hit.start()))


_OF_SOURCES = re.compile(rb"[\"']src[\"']\s*,\s*[\"']")
_BELOW_SOURCES = re.compile(rb"[\"']src[\"']\s*,\s*[\"'](?:[\w.-]+[\"']\s*,\s*[\"'])*\Z")


def _is_below_sources(data: bytes, start: int) -> bool:
    """Return whether a quoted path component follows other components with the ``src`` of a workspace."""
    return _BELOW_SOURCES.search(data, max(start - 200, 0), start) is not None


def _may_be_read(path: str, entered: Sequence[str]) -> bool:
    """Return whether a CMake file can be part of the build.

    A CMakeLists.txt in a folder without add_subdirectory() cannot.
    """
    folder, _, name = path.rpartition("/")
    inner = folder.rpartition("/")[2]
    return name != "CMakeLists.txt" or not folder or any("$" in text or text.endswith(inner) for text in entered)


def _named(
    tree: Tree, found: DiscoveredPackage, missing: Mapping[str, Sequence[str]], naming: _Texts
) -> Iterator[tuple[str, Span]]:
    """Yield the resources that are not installed and that a text refers to, with the first place."""
    remaining: dict[str, tuple[bytes, bytes]] = {}
    for file in (file for files in missing.values() for file in files[:_MOST_RESOURCES]):
        folder, _, name = to_bytes(file).rpartition(b"/")
        remaining[file] = folder.rpartition(b"/")[2], name
    if any(map(_is_picture, remaining)):  # most images are there for the documentation
        for _, page in contents(tree, found.path, (file for file in found.files if file.endswith(".md"))):
            remaining = {file: inner for file, inner in remaining.items() if not (_is_picture(file) and inner[1] in page)}
    for path, data in naming if remaining else ():
        folders = {folder for folder in {folder for folder, _ in remaining.values()} if folder in data}
        for resource, (folder, name) in list(remaining.items()) if folders else ():
            if folder not in folders or name not in data or join(found.path, resource) == path:
                continue
            hits = resource_files.pattern_of(resource).finditer(data)
            hit = next((match for match in hits if _looks_up(path, data, resource, match)), None)
            if hit:
                yield resource, span_in(path, data, *hit.span(1))
                del remaining[resource]
        if not remaining:
            return


_WORKING_FOLDER = re.compile(rb"\b(?:current_path|getcwd|cwd)\s*\(")
_BEFORE = re.compile(rb"[\"']([\w.-]+)[\"']\s*,\s*[\"']\Z")
"""The quoted path component before another one."""


def _looks_up(path: str, data: bytes, resource: str, hit: re.Match[bytes]) -> bool:
    """Return whether a text that names a resource may look it up where it would be installed."""
    if _is_remark(path, data, hit.start(1)):
        return False
    if b"share" not in data and _WORKING_FOLDER.search(data):
        return False  # it is looked up in the working directory
    if _is_below_sources(data, hit.start()):
        return False
    above = to_bytes(parent(parent(resource)).rpartition("/")[2])
    before = _BEFORE.search(data, max(hit.start() - 80, 0), hit.start()) if above else None
    return before is None or before[1] == above


def _with_runs(tree: Tree, found: DiscoveredPackage, script: BuildScript, files: list[ScriptFile]) -> list[ScriptFile]:
    """Return the scripts with the places that start them, and with started modules that are not installed.

    In a CMake package, only the files among the scripts are candidates. In a Python package, modules are
    candidates, too, because entry points make programs of them.
    """
    if script.of_cmake:
        kept = script.products.installed
        lost = [file.path for file in files if file.path not in kept and file.shebang and file.main]
        run = _run(tree, found, lost, _TELLS) if lost else {}
        return [file._replace(run=run.get(file.path)) for file in files] if run else files
    names = {provided.path.rpartition("/")[2] for provided in script.products.installs if not provided.path.startswith("share/")}
    named = {entry.module.replace(".", "/") for entry in script.products.entry_points}
    inside = (file for file in found.files if file.startswith(f"{found.name}/") and file.endswith(".py"))
    modules = [file for file in inside if file.removesuffix(".py") not in named]
    lost = [f for f in (*modules, *_programs(found.files, ())) if names.isdisjoint(_called(f)) and not is_auxiliary(f)]
    run = _run(tree, found, lost, _PAGES) if lost else {}
    texts = {path: text for path in run if (text := text_in(tree, found, path))}
    executables = Executables(tree, found)
    started = [
        _script_file(path, text, path in executables)._replace(
            run=run[path], main="def main(" in text.text or "__main__" in text.text
        )
        for path, text in texts.items()
    ]
    return [*(file for file in files if file.path not in texts), *started]


def _called(program: str) -> tuple[str, str]:
    """Return the names by which a program may be started: with and without suffix."""
    name = program.rpartition("/")[2]
    return name, name.removesuffix(".py")


def _run(tree: Tree, found: DiscoveredPackage, programs: Sequence[str], endings: tuple[str, ...]) -> dict[str, Span]:
    """Return the places with ``ros2 run`` for programs, by path: in scripts and documentation pages.

    The suffix is optional because install() can rename a program. The README files of the folders above are
    searched, too.
    """
    names = {program.rpartition("/")[2]: program for program in programs}
    names = {**{name.removesuffix(".py"): program for name, program in names.items()}, **names}
    words = b"|".join([re.escape(to_bytes(name)) for name in names])
    command = re.compile(rb"\bros2 run +%s +(%s)(?![\w-]|\.\w)" % (re.escape(to_bytes(found.name)), words))
    above = [join(folder, "README.md") for folder in (*folders_of(found.path), "")] if found.path else []
    texts = [file for file in found.files if file.endswith(endings) and not file.startswith("CHANGELOG")]
    places: dict[str, Span] = {}
    for path, data in (*contents(tree, found.path, texts), *contents(tree, "", above)):
        for hit in command.finditer(data) if b"ros2 run" in data else ():
            places.setdefault(names[from_bytes(hit[1])], span_in(path, data, *hit.span(1)))
    return places


def _is_remark(file: str, data: bytes, start: int) -> bool:
    """Return whether a place is in a line that is a comment as a whole."""
    mark = b"#" if file.endswith((".py", ".yaml", ".yml")) else b"//"
    return data[data.rfind(b"\n", 0, start) + 1 : start].lstrip().startswith(mark)


def _is_picture(file: str) -> bool:
    return file.startswith(("images/", "media/")) and file.endswith((".png", ".jpg", ".jpeg"))


def _programs(files: Sequence[str], folders: Container[str]) -> Iterator[str]:
    """Yield files that may be programs, by folder and name.

    The folder has other programs or is usual for scripts.
    """
    for file in files:
        if file.endswith((".py", ".sh")) or file.rfind(".") < file.rfind("/"):
            folder = file.rpartition("/")[0]
            if folder and (folder in folders or _SCRIPTS.match(file)):
                yield file


def _is_helper(file: ScriptFile, texts: Mapping[str, Text]) -> bool:
    """Return whether a neighbour imports a script that has no interpreter line."""
    if file.shebang or not (file.main and file.path.endswith(".py")):
        return False
    folder, _, name = file.path.removesuffix(".py").rpartition("/")
    imports = re.compile(rf"^[ \t]*(?:from|import)[ \t]+{re.escape(name)}\b", re.MULTILINE)
    beside = (text.text for path, text in texts.items() if path.rpartition("/")[0] == folder)
    return any(map(imports.search, beside))


def _script_file(path: str, text: Text, executable: bool) -> ScriptFile:
    first = text.text[: text.text.find("\n") + 1] or text.text
    shebang = first[2:].strip() if first.startswith("#!") else ""
    main = not path.endswith(".py") or "__main__" in text.text
    return ScriptFile(path, shebang, bool(shebang) and first.endswith("\r\n"), main, executable)


def text_in(tree: Tree, found: DiscoveredPackage, file: str) -> Text | None:
    """Return the text of a file of a package, None if it is missing or unreadable."""
    return text_of(tree, join(found.path, file)) if file in found.files else None


class Executables(Set[str]):
    """Files of a package, and around it, with the executable bit. Each look-up asks the file system."""

    def __init__(self, tree: Tree, found: DiscoveredPackage) -> None:
        self._tree = tree
        self._found = found

    def __contains__(self, file: object) -> bool:
        try:
            return self._tree.stamp(resolve(self._found.path, str(file))).executable
        except OSError:
            return False

    def __iter__(self) -> Iterator[str]:
        return (file for file in self._found.files if file in self)

    def __len__(self) -> int:
        return sum(1 for _ in self)
