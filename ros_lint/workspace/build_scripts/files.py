"""Collect the files that belong to a build script: plugin descriptions, programs, and resources such as maps and models."""

from __future__ import annotations

import re
from collections.abc import Container, Iterator, Mapping, Sequence, Set

from ros_lint.base.auxiliary_files import is_auxiliary
from ros_lint.base.paths import folders_of, join, parent, resolve
from ros_lint.base.text import Span, Text, from_bytes, span_in, to_bytes
from ros_lint.base.tree import Tree, contents, text_of
from ros_lint.collectors.cmake.syntax import ParsedScript
from ros_lint.collectors.launch.detect import is_of_ros_1
from ros_lint.collectors.manifest.plugin_exports import plugin_exports
from ros_lint.collectors.python.started_scripts import runs_when_started
from ros_lint.collectors.resources import plugin_descriptions as plugin_xml
from ros_lint.facts.build import BuildFiles, BuildScript, ScriptFile
from ros_lint.facts.visibility import Facet
from ros_lint.workspace.build_scripts import resources as resource_files
from ros_lint.workspace.discovery.discover import DiscoveredPackage

_PLUGIN_FILE = re.compile(r"plugin.*\.xml\Z", re.IGNORECASE)
_SCRIPTS = re.compile(r"(?:scripts|nodes|bin|script)/[^/]+\Z")
_MOST_RESOURCES = 40
"""Maximum number of resource files to search for in each folder.

A folder of models can have thousands of files, and one reference to the folder suffices for a finding.
"""
_DOCUMENTS = (".md", ".rst", ".txt", ".sh", ".bash")
_TEXTS_WITH_COMMANDS = (*_DOCUMENTS, ".py", ".yaml", ".yml")
"""Suffixes of files whose text is searched for ``ros2 run`` commands."""

_Texts = Sequence[tuple[str, bytes]]
"""Path and contents of each file of a package whose text may refer to resources."""


def with_files(tree: Tree, package: DiscoveredPackage, commands: Mapping[str, ParsedScript], script: BuildScript) -> BuildScript:
    """Return a build script with its ``files`` filled in: plugin descriptions, programs, and resources that are not installed.

    ``commands`` are the parsed CMake files of the package, by path relative to the package.
    """
    exports = (call for call in script.commands.calls if call.name.startswith("pluginlib_export"))
    exported = {call.texts[1] for call in exports if len(call.args) > 1}.union(plugin_exports(package.manifest))
    markup = [file for file in package.files if file.endswith(".xml")]
    candidates = [file for file in markup if file in exported or _PLUGIN_FILE.search(file)]
    described = (plugin_xml.collect(file, text) for file in candidates if (text := text_in(tree, package, file)))
    plugins = tuple([plugin for plugin in described if plugin])
    program_folders = (f"lib/{package.name}/", "bin/")
    sources = dict.fromkeys([p.source for p in script.products.installs if p.source and p.path.startswith(program_folders)])
    folders = {file.rpartition("/")[0] for file in sources}
    if script.of_cmake and not any(p.source.startswith(f"{package.name}/") for p in script.products.installs):
        folders.add(package.name)  # a Python package that CMake does not install
    sources.update(dict.fromkeys(_programs(package.files, folders)))
    if script.of_cmake:
        sources.update(dict.fromkeys([file for file in package.files if "/" not in file and file.endswith(".py")]))
    executables = Executables(tree, package)
    texts = {file: text for file in sources if (text := text_in(tree, package, file))}
    files = [_script_file(file, text, file in executables) for file, text in texts.items()]
    files = [file._replace(helper=_is_helper(file, texts)) for file in files]
    files = _with_runs(tree, package, script, files)
    uninstalled: Mapping[str, Sequence[str]] = {}
    if not script.hides(Facet.SHARE):
        uninstalled = resource_files.uninstalled_resources(package.files, script.products.installed)
    if not (plugins or files or uninstalled):
        return script
    may_refer = contents(tree, package.path, filter(resource_files.may_name, package.files)) if uninstalled else ()
    texts_of_ros_2 = [(path, data) for path, data in may_refer if not (b"<launch" in data and is_of_ros_1(from_bytes(data)))]
    macros = _source_folders(commands) if uninstalled else None
    referring = [(path, data) for path, data in texts_of_ros_2 if not (macros and macros.search(data))]
    in_sources = [data for _, data in texts_of_ros_2 if macros and macros.search(data)]
    pages = [*contents(tree, package.path, (file for file in package.files if file.endswith(".md")))] if uninstalled else []
    build_inputs = (
        *_inputs(commands, uninstalled, [file.path for file in files]),
        *_read_in_sources(package, uninstalled, [*referring, *pages]),
        *(f"{folder}/" for folder in uninstalled if any(b'"/%s/' % to_bytes(folder) in data for data in in_sources)),
    )
    return script._replace(
        files=BuildFiles(
            plugins, tuple(files), tuple(_referenced_resources(tree, package, uninstalled, referring)), build_inputs
        ),
    )


def _inputs(
    scripts: Mapping[str, ParsedScript], uninstalled: Mapping[str, Sequence[str]], programs: Sequence[str]
) -> Iterator[str]:
    """Yield those resources and programs of a package that are arguments of CMake commands other than install().

    ``uninstalled`` maps each folder to its resource files that are not installed. ``programs`` has paths of programs. Only these
    folders and files are yielded; a folder ends with a slash.
    """
    if not uninstalled and not programs:
        return
    subfolders = [command for parsed in scripts.values() for command in parsed.commands if command.name == "add_subdirectory"]
    subdirectories = [command.args[0][0] for command in subfolders if command.args]
    scripts_read = (parsed for path, parsed in scripts.items() if _may_be_read(path, subdirectories))
    commands = (command for parsed in scripts_read for command in parsed.commands if command.name != "install")
    text = "\n".join([argument[0] for command in commands for argument in command.args])
    for folder, files in uninstalled.items():
        if re.search(rf"(?<![\w.-]){re.escape(folder)}(?:/|$)", text, re.MULTILINE):
            yield f"{folder}/"
        yield from (file for file in files if file.rpartition("/")[2] in text)
    yield from (file for file in programs if re.search(rf"(?<![\w.-]){re.escape(file)}(?![\w.-])", text))


def _source_folders(scripts: Mapping[str, ParsedScript]) -> re.Pattern[bytes] | None:
    """Return a pattern for C++ macros whose value is the source folder, None if the CMake files define no such macro.

    Example: ``target_compile_definitions(x PRIVATE MAPS="${CMAKE_CURRENT_SOURCE_DIR}")`` defines ``MAPS``.
    """
    commands = (command for parsed in scripts.values() for command in parsed.commands if command.name in _DEFINE)
    macros = {match[1] for command in commands for argument in command.args if (match := _HOLDS_SOURCES.match(argument[0]))}
    return re.compile(rb"\b(?:%s)\b" % b"|".join(sorted(map(to_bytes, macros)))) if macros else None


_DEFINE = frozenset({"add_compile_definitions", "add_definitions", "target_compile_definitions"})
_HOLDS_SOURCES = re.compile(r"(?:-D)?(\w+)=[\\\"]*\$\{\w*_SOURCE_DIR\}")


def _read_in_sources(package: DiscoveredPackage, uninstalled: Mapping[str, Sequence[str]], referring: _Texts) -> Iterator[str]:
    """Yield the ``uninstalled`` folders that code probably reads from the source tree, because a file contains their source path.

    Examples of the path are ``/home/me/src/robot/maps/hall`` and ``"src", "robot", "maps"``. ``referring`` are the texts to
    search. A path with slashes does not count in a file of that same folder: xacro writes the path of its input into the
    model that it generates, and both are often in one folder.
    """
    if not uninstalled:
        return
    top = package.path.rpartition("/")[2] or package.name
    folders = b"|".join([re.escape(to_bytes(folder)) for folder in uninstalled])
    place = re.compile(rb"(?<=[\w.~}-])(?<!\bshare)/%s/(%s)(?![\w.-])" % (re.escape(to_bytes(top)), folders))
    part = re.compile(rb"(?<=[\"'])(%s)(?=[\"'])" % folders)
    below = b"/%s/" % to_bytes(top)
    for path, data in referring:
        if below in data:  # a quick check, because the pattern takes a hundred times as long
            named = {from_bytes(match[1]) for match in place.finditer(data)}
            yield from (f"{folder}/" for folder in sorted(named) if not path.startswith(f"{join(package.path, folder)}/"))
        if _OF_SOURCES.search(data) and not path.endswith(".md"):
            yield from (f"{from_bytes(match[1])}/" for match in part.finditer(data) if _is_below_sources(data, match.start()))


_OF_SOURCES = re.compile(rb"[\"']src[\"']\s*,\s*[\"']")
_BELOW_SOURCES = re.compile(rb"[\"']src[\"']\s*,\s*[\"'](?:[\w.-]+[\"']\s*,\s*[\"'])*\Z")


def _is_below_sources(data: bytes, start: int) -> bool:
    """Return whether the path component that starts at ``start`` follows a quoted ``src``, as in ``"src", "robot", "maps"``."""
    return _BELOW_SOURCES.search(data, max(start - 200, 0), start) is not None


def _may_be_read(path: str, subdirectories: Sequence[str]) -> bool:
    """Return whether a CMake file can be part of the build of its package.

    A CMakeLists.txt in a subfolder can be part of the build only if an add_subdirectory() may name the subfolder.
    """
    folder, _, name = path.rpartition("/")
    last_folder = folder.rpartition("/")[2]
    return name != "CMakeLists.txt" or not folder or any("$" in text or text.endswith(last_folder) for text in subdirectories)


def _referenced_resources(
    tree: Tree, package: DiscoveredPackage, uninstalled: Mapping[str, Sequence[str]], referring: _Texts
) -> Iterator[tuple[str, Span]]:
    """Yield each resource file that is not installed but is looked up, with the position of the first look-up.

    The look-ups are searched in the files ``referring``.
    """
    remaining: dict[str, tuple[bytes, bytes]] = {}
    for file in (file for files in uninstalled.values() for file in files[:_MOST_RESOURCES]):
        folder, _, name = to_bytes(file).rpartition(b"/")
        remaining[file] = folder.rpartition(b"/")[2], name
    if any(map(_is_picture, remaining)):  # most images are there for the documentation
        for _, page in contents(tree, package.path, (file for file in package.files if file.endswith(".md"))):
            remaining = {file: inner for file, inner in remaining.items() if not (_is_picture(file) and inner[1] in page)}
    for path, data in referring if remaining else ():
        folders = {folder for folder in {folder for folder, _ in remaining.values()} if folder in data}
        for resource, (folder, name) in list(remaining.items()) if folders else ():
            if folder not in folders or name not in data or join(package.path, resource) == path:
                continue
            matches = resource_files.pattern_of(resource).finditer(data)
            reference = next((match for match in matches if _looks_up(path, data, resource, match)), None)
            if reference:
                yield resource, span_in(path, data, *reference.span(1))
                del remaining[resource]
        if not remaining:
            return


_WORKING_FOLDER = re.compile(rb"\b(?:current_path|getcwd|cwd)\s*\(")
_BEFORE = re.compile(rb"[\"']([\w.-]+)[\"']\s*,\s*[\"']\Z")
"""Matches a quoted path component before another component: ``"maps", `` in ``"maps", "hall.yaml"``."""


def _looks_up(path: str, data: bytes, resource: str, match: re.Match[bytes]) -> bool:
    """Return whether ``match``, a reference to a resource file, may be a look-up in the install prefix.

    The result is False for a reference in a comment, in the working directory, in the source tree or in another folder.
    """
    if _is_comment_line(path, data, match.start(1)):
        return False
    if b"share" not in data and _WORKING_FOLDER.search(data):
        return False  # the resource is looked up in the working directory
    if _is_below_sources(data, match.start()):
        return False
    above = to_bytes(parent(parent(resource)).rpartition("/")[2])
    previous = _BEFORE.search(data, max(match.start() - 80, 0), match.start()) if above else None
    return previous is None or previous[1] == above


def _with_runs(tree: Tree, package: DiscoveredPackage, script: BuildScript, files: list[ScriptFile]) -> list[ScriptFile]:
    """Return ``files`` with the position of a ``ros2 run`` command for each program that is not installed.

    The command must be in a file of the package, e.g. its README.md. In a Python package, modules that no entry point names are
    added to the result if a command starts them.
    """
    if script.of_cmake:
        installed = script.products.installed
        uninstalled = [file.path for file in files if file.path not in installed and file.shebang and file.main]
        run = _run_places(tree, package, uninstalled, _TEXTS_WITH_COMMANDS) if uninstalled else {}
        return [file._replace(run=run.get(file.path)) for file in files] if run else files
    names = {provided.path.rpartition("/")[2] for provided in script.products.installs if not provided.path.startswith("share/")}
    entry_modules = {entry.module.replace(".", "/") for entry in script.products.entry_points}
    inside = (file for file in package.files if file.startswith(f"{package.name}/") and file.endswith(".py"))
    modules = [file for file in inside if file.removesuffix(".py") not in entry_modules]
    uninstalled = [
        f for f in (*modules, *_programs(package.files, ())) if names.isdisjoint(_program_names(f)) and not is_auxiliary(f)
    ]
    run = _run_places(tree, package, uninstalled, _DOCUMENTS) if uninstalled else {}
    texts = {path: text for path in run if (text := text_in(tree, package, path))}
    executables = Executables(tree, package)
    programs = [
        (file := _script_file(path, text, path in executables))._replace(
            run=run[path], main=file.main or "def main(" in text.text
        )
        for path, text in texts.items()
    ]
    return [*(file for file in files if file.path not in texts), *programs]


def _program_names(program: str) -> tuple[str, str]:
    """Return the names by which a program may be started: the file name with and without the suffix ``.py``."""
    name = program.rpartition("/")[2]
    return name, name.removesuffix(".py")


def _run_places(tree: Tree, package: DiscoveredPackage, programs: Sequence[str], endings: tuple[str, ...]) -> dict[str, Span]:
    """Return the position of a ``ros2 run`` command for each program that has one, by path of the program.

    The command is searched in the files of the package with one of the ``endings``, and in the README.md of each folder above
    the package. The command may omit the suffix ``.py``, because install() can rename a program.
    """
    names = {program.rpartition("/")[2]: program for program in programs}
    names = {**{name.removesuffix(".py"): program for name, program in names.items()}, **names}
    words = b"|".join([re.escape(to_bytes(name)) for name in names])
    command = re.compile(rb"\bros2 run +%s +(%s)(?![\w-]|\.\w)" % (re.escape(to_bytes(package.name)), words))
    above = [join(folder, "README.md") for folder in (*folders_of(package.path), "")] if package.path else []
    texts = [file for file in package.files if file.endswith(endings) and not file.startswith("CHANGELOG")]
    places: dict[str, Span] = {}
    for path, data in (*contents(tree, package.path, texts), *contents(tree, "", above)):
        for match in command.finditer(data) if b"ros2 run" in data else ():
            places.setdefault(names[from_bytes(match[1])], span_in(path, data, *match.span(1)))
    return places


def _is_comment_line(file: str, data: bytes, start: int) -> bool:
    """Return whether the line that contains the offset ``start`` begins with a comment sign."""
    mark = b"#" if file.endswith((".py", ".yaml", ".yml")) else b"//"
    return data[data.rfind(b"\n", 0, start) + 1 : start].lstrip().startswith(mark)


def _is_picture(file: str) -> bool:
    return file.startswith(("images/", "media/")) and file.endswith((".png", ".jpg", ".jpeg"))


def _programs(files: Sequence[str], folders: Container[str]) -> Iterator[str]:
    """Yield the files that may be programs: the suffix is ``.py``, ``.sh`` or missing, and the folder is one for programs.

    A folder for programs is one of ``folders`` or has a usual name: ``scripts``, ``nodes``, ``bin``.
    """
    for file in files:
        if file.endswith((".py", ".sh")) or file.rfind(".") < file.rfind("/"):
            folder = file.rpartition("/")[0]
            if folder in folders or _SCRIPTS.match(file):
                yield file


def _is_helper(file: ScriptFile, texts: Mapping[str, Text]) -> bool:
    """Return whether ``file`` is a Python script without an interpreter line that another script in its folder imports."""
    if file.shebang or not (file.main and file.path.endswith(".py")):
        return False
    folder, _, name = file.path.removesuffix(".py").rpartition("/")
    imports = re.compile(rf"^[ \t]*(?:from|import)[ \t]+{re.escape(name)}\b", re.MULTILINE)
    beside = (text.text for path, text in texts.items() if path.rpartition("/")[0] == folder)
    return any(map(imports.search, beside))


def _script_file(path: str, text: Text, executable: bool) -> ScriptFile:
    first = text.text[: text.text.find("\n") + 1] or text.text
    shebang = first[2:].strip() if first.startswith("#!") else ""
    main = not path.endswith(".py") or runs_when_started(text, is_program=executable and bool(shebang))
    return ScriptFile(path, shebang, bool(shebang) and first.endswith("\r\n"), main, executable)


def text_in(tree: Tree, package: DiscoveredPackage, file: str) -> Text | None:
    """Return the text of a file of a package, None if the file is missing or unreadable."""
    return text_of(tree, join(package.path, file)) if file in package.files else None


class Executables(Set[str]):
    """The paths, relative to a package, of files with the executable bit.

    ``path in executables`` reads the file system, and accepts paths outside the package (``../tools/run``).
    """

    def __init__(self, tree: Tree, package: DiscoveredPackage) -> None:
        self._tree = tree
        self._package = package

    def __contains__(self, file: object) -> bool:
        try:
            return self._tree.stamp(resolve(self._package.path, str(file))).executable
        except OSError:
            return False

    def __iter__(self) -> Iterator[str]:
        return (file for file in self._package.files if file in self)

    def __len__(self) -> int:
        return sum(1 for _ in self)
