"""What install() puts where (cmake-commands install(7); reference, section C5)."""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterator
from typing import Final, NamedTuple

from ros_lint.facts.build import Provided
from ros_lint.facts.sight import Facet, Opaque
from ros_lint.interpret.cmake_arguments import sections, with_one_destination
from ros_lint.interpret.cmake_glob import glob_regex
from ros_lint.interpret.cmake_run import Handler, InstalledTarget, Run
from ros_lint.interpret.cmake_state import Properties
from ros_lint.interpret.cmake_target_headers import DESTINATION, FILE_SET, installed_headers
from ros_lint.interpret.cmake_targets import output_name, real_target
from ros_lint.interpret.cmake_values import HOLE, is_fixed, is_known, sure
from ros_lint.knowledge.cmake_commands import INSTALL_ARTIFACTS, INSTALL_TARGETS_WORDS, VARIABLES
from ros_lint.text import Span
from ros_lint.tree import is_outside
from ros_lint.tree import join as join_path

_ANYWHERE: Final = Facet.EXECUTABLES | Facet.SHARE | Facet.LIBRARIES | Facet.PYTHON
_TYPES: Final = {
    "BIN": "bin", "SBIN": "sbin", "LIB": "lib", "INCLUDE": "include", "SYSCONF": "etc", "SHAREDSTATE": "com",
    "LOCALSTATE": "var", "RUNSTATE": "var/run", "DATA": "share", "INFO": "share/info", "LOCALE": "share/locale",
    "MAN": "share/man", "DOC": "share/doc",
}  # fmt: skip
_OF_TARGETS: Final = frozenset({"ARCHIVE", "LIBRARY", "RUNTIME"})
_FILE_WORDS: Final = {
    "TYPE": 1, "DESTINATION": 1, "PERMISSIONS": -1, "CONFIGURATIONS": -1, "COMPONENT": 1, "RENAME": 1, "OPTIONAL": 0,
    "EXCLUDE_FROM_ALL": 0,
}  # fmt: skip
_DIRECTORY_WORDS: Final = {
    "TYPE": 1, "DESTINATION": 1, "FILE_PERMISSIONS": -1, "DIRECTORY_PERMISSIONS": -1, "USE_SOURCE_PERMISSIONS": 0,
    "OPTIONAL": 0, "MESSAGE_NEVER": 0, "CONFIGURATIONS": -1, "COMPONENT": 1, "EXCLUDE_FROM_ALL": 0, "FILES_MATCHING": 0,
}  # fmt: skip


_WRITES = re.compile(
    r"\bfile\s*\(|symlink|\bcopy|\binstall|\b(?:ln|cp|mv)\b|configure_file|rename|\btar\b|\bmake\b", re.IGNORECASE
)
"""What code that puts files somewhere has in it."""


def facet_of(run: Run, destination: str | None) -> Facet:
    """Return which side of the package something installed there belongs to."""
    if not destination or destination == ".":
        return _ANYWHERE
    if destination == "lib":
        return Facet.EXECUTABLES | Facet.LIBRARIES | Facet.PYTHON
    if destination.startswith("share"):
        return Facet.SHARE
    if destination.startswith("lib/python"):
        return Facet.PYTHON
    if destination in ("bin", f"lib/{run.sources.name}") or destination.startswith(f"lib/{run.sources.name}/"):
        return Facet.EXECUTABLES
    return Facet.LIBRARIES


def _hide(run: Run, destination: str | None, reason: str) -> None:
    """Note that it is not known what comes to a place, None if that is unknown, too."""
    run.hide(facet_of(run, destination), reason, below=destination or "")


def _install(run: Run, args: list[str]) -> None:
    mode = args[0] if args else ""
    args = with_one_destination(args)
    if args[1:2] and (args[1] == "DESTINATION" or (mode == "TARGETS" and args[1] in INSTALL_ARTIFACTS)):
        return  # the list was empty, which CMake allows
    if mode in ("FILES", "PROGRAMS", "DIRECTORY") and (strange := next((arg for arg in args if arg in _OF_TARGETS), "")):
        run.problem("cmake-syntax", f"install({mode}) knows no {strange}, that belongs to install(TARGETS)", run.where(strange))
        args = [arg for arg in args if arg not in _OF_TARGETS]
    if mode == "TARGETS":
        _install_targets(run, args[1:])
    elif mode in ("FILES", "PROGRAMS"):
        _install_files(run, [arg for arg in args[1:] if arg != mode], mode == "PROGRAMS")
    elif mode == "DIRECTORY":
        _install_directories(run, args[1:])
    elif mode == "SCRIPT" or (mode == "CODE" and any(not is_fixed(arg) or _WRITES.search(arg) for arg in args[1:])):
        run.hide(_ANYWHERE, f"install({mode}) runs code during the installation")
    elif mode == "CODE":
        pass  # such as compiling Python modules
    elif mode not in ("EXPORT", "EXPORT_ANDROID_MK", "IMPORTED_RUNTIME_ARTIFACTS", "RUNTIME_DEPENDENCY_SET"):
        run.hide(_ANYWHERE, "install() of something unknown")


# --- targets -------------------------------------------------------------------------------------------------------


def _install_targets(run: Run, args: list[str]) -> None:
    names: list[str] = []
    destinations: dict[str, str] = {}
    exported_in = ""
    artifact = ""
    room = -1
    keyword = ""
    for arg in args:
        if arg in INSTALL_ARTIFACTS:
            artifact, keyword = arg, arg
        elif arg in INSTALL_TARGETS_WORDS:
            keyword, room = arg, INSTALL_TARGETS_WORDS[arg]
        elif arg == "TARGETS":
            keyword = ""  # said again, which CMake allows; likewise with files
        elif not keyword:
            names.append(arg)
        elif keyword == "FILE_SET" and room:
            artifact = f"{FILE_SET}{arg}"
            destinations[artifact] = DESTINATION
            room -= 1
        elif keyword == "DESTINATION" and room:
            destinations[artifact] = arg
            room -= 1
        elif keyword == "EXPORT" and not exported_in:
            exported_in = sure(arg)[0]
            if not is_known(exported_in):
                run.hide(Facet.LIBRARIES, "the set that targets are exported in is not known")
    everywhere = destinations.get("")
    runtime = run.destination(sure(destinations.get("RUNTIME") or everywhere or "bin")[0])
    library = run.destination(sure(destinations.get("LIBRARY") or everywhere or "lib")[0])
    archive = run.destination(sure(destinations.get("ARCHIVE") or everywhere or "lib")[0])
    of_headers = [artifact for artifact in destinations if artifact.startswith(FILE_SET) or artifact.endswith("_HEADER")]
    headers = tuple([(artifact, run.destination(sure(destinations[artifact])[0])) for artifact in of_headers])
    for name in names:
        plain, certain = sure(name)
        if not is_known(plain):
            run.hide(Facet.EXECUTABLES | Facet.LIBRARIES, "install() of targets whose names are not known")
        elif not run.muted:
            conditional = run.conditional or run.testing or not certain
            span = run.where(name)
            made = InstalledTarget(plain, runtime, library, archive, conditional, span, exported_in, headers)
            run.installed_targets.append(made)


_PYTHON: Final = f"{VARIABLES['PYTHON_INSTALL_DIR']}/"


def installed_targets(run: Run) -> Iterator[Provided]:
    """Return the files of the targets that were installed, after the whole script has run."""
    for installed in run.installed_targets:
        name, span, conditional = installed.target, installed.span, installed.conditional
        target = real_target(run, name)
        if target is None:
            if not run.open_world or "::" not in name:
                run.undefined.append((name, span, conditional))
            reason = f"what the target {name} is, is not known"
            run.opaques.setdefault(Opaque(Facet.EXECUTABLES | Facet.LIBRARIES, reason, span, name))
            if installed.executables is not None:  # should it be there after all, it is most likely a program
                yield Provided(join_path(installed.executables, name), "", True, True, span, name)
            continue
        yield from installed_headers(run, name, target, installed.headers, conditional or "CONDITIONAL" in target, span)
        if target["KIND"] not in ("interface", "object", "other", "imported"):
            unsure = conditional or not {"CONDITIONAL", "PERHAPS", "TEST"}.isdisjoint(target)
            yield from _built_files(run, installed, target, unsure)
            if "PERHAPS" in target:
                yield from _built_files(run, installed, Properties(target, KIND=target["PERHAPS"]), unsure)


def _built_files(run: Run, installed: InstalledTarget, target: Properties, unsure: bool) -> Iterator[Provided]:
    """Return the files of an installed target that builds some."""
    name, span, kind = installed.target, installed.span, target["KIND"]
    where = {"executable": installed.executables, "static": installed.archives}.get(kind, installed.libraries)
    file = output_name(target)
    if where is None or file is None:
        facet = Facet.EXECUTABLES if kind == "executable" else Facet.LIBRARIES | Facet.PYTHON
        run.opaques.setdefault(Opaque(facet, f"where the target {name} is installed is not known", span))
        return
    path = join_path(where, file)
    yield Provided(path, "", kind == "executable", unsure, span, name)
    if path.startswith(_PYTHON) and not file.startswith("lib"):
        run.python_packages[path[len(_PYTHON) :].partition(".")[0].replace("/", ".")] = None
    if kind == "shared":
        for number in {target.get("VERSION", ""), target.get("SOVERSION", "")} - {""}:
            if is_known(number):
                yield Provided(join_path(where, f"{file}.{number}"), "", False, unsure, span, name)


# --- files ---------------------------------------------------------------------------------------------------------


def _install_files(run: Run, args: list[str], program: bool) -> None:
    parts = sections(args, _FILE_WORDS)
    destination = _destination(run, parts)
    rename = parts.get("RENAME", [""])[0] if parts.get("RENAME") else ""
    if "PERMISSIONS" in parts:
        program = any(word.endswith("_EXECUTE") for word in parts["PERMISSIONS"])
    for value in parts[""]:
        plain, certain = sure(value)
        name = rename or posixpath.basename(plain)
        if destination is None or HOLE in name or not is_fixed(name):
            _hide(run, destination, "install() of files whose names or place are not known")
            continue
        _install_file(run, value, join_path(destination, name), program, certain, "OPTIONAL" in parts)


def _install_file(run: Run, value: str, path: str, program: bool, certain: bool, optional: bool) -> None:
    if run.muted:
        return
    plain = sure(value)[0]
    span = run.where(value)
    source = run.source(plain)
    conditional = run.conditional or run.testing or not certain
    if source is None:
        source = run.beside(plain)
    elif run.is_unseen(source):
        source = None
    if source is not None and not run.is_file(source):
        if run.is_folder(source) and source:
            run.problem("file-is-directory", f"install(FILES) of {source}, which is a directory", span, source)
            return
        if optional:
            return
        run.missing.append((source, span, conditional))
        if source not in run.generated:
            run.installed.append(Provided(path, source, program, True, span))
            return
        source = ""
    run.installed.append(Provided(path, source or "", program, conditional, span, test=run.testing))


def _destination(run: Run, parts: dict[str, list[str]]) -> str | None:
    found = parts.get("DESTINATION")
    if found:
        return run.destination(sure(found[0])[0]) if len(found) == 1 else None
    kind = parts.get("TYPE")
    return _TYPES.get(kind[0]) if kind else None


# --- directories ---------------------------------------------------------------------------------------------------


class _Pattern(NamedTuple):
    matches: re.Pattern[str]
    excluded: bool
    executable: bool | None
    """What its permissions say, None when it gives none."""


class _Rule(NamedTuple):
    """What an install(DIRECTORY) says of all its folders."""

    patterns: list[_Pattern]
    only: bool
    """Whether files that no pattern matches are left out (FILES_MATCHING)."""
    executable: bool | None
    """What the permissions say, None when those of the source are kept."""
    optional: bool


def _install_directories(run: Run, args: list[str]) -> None:
    at = min([args.index(word) for word in ("PATTERN", "REGEX") if word in args], default=len(args))
    parts = sections(args[:at], _DIRECTORY_WORDS)
    destination = _destination(run, parts)
    patterns = _patterns(args[at:]) if at < len(args) else []
    if patterns is None:
        _hide(run, destination, "install(DIRECTORY) with a pattern that is not known")
        return
    permissions = parts.get("FILE_PERMISSIONS")
    executable: bool | None = None if "USE_SOURCE_PERMISSIONS" in parts else False
    if permissions is not None:
        executable = any(word.endswith("_EXECUTE") for word in permissions)
    rule = _Rule(patterns, "FILES_MATCHING" in parts or "FILES_MATCHING" in args[at:], executable, "OPTIONAL" in parts)
    for value in parts[""]:
        plain = sure(value)[0]
        source = run.reached(plain)
        if destination is None or HOLE in plain:
            name = posixpath.basename(plain)  # that of the folder is kept, wherever it lies
            known = destination is not None and name not in ("", ".", "..") and HOLE not in name
            place = join_path(destination or "", name) if known else destination
            _hide(run, place, "install(DIRECTORY) of a folder or to a place that is not known")
        elif source is None or (is_outside(source) and not (run.below(source) or run.is_file(source))):
            _hide(run, destination, "install(DIRECTORY) of a folder that is not in the sources")
            _install_configured(run, value, destination, rule)
        elif not run.muted:
            target = posixpath.normpath(join_path(destination, posixpath.basename(plain)))
            _install_directory(run, value, source, "" if target == "." else target, rule)


def _install_directory(run: Run, value: str, source: str, target: str, rule: _Rule) -> None:
    plain, certain = sure(value)
    span = run.where(value)
    conditional = run.conditional or run.testing or not certain
    if run.is_file(source):
        run.problem("directory-is-file", f"install(DIRECTORY) of {source}, which is a file", span, source)
        return
    more = unlisted(run, source, facet_of(run, target), span) if run.sources.unseen else []
    own = run.below(source)
    made, filled = _made(run, source)
    top = plain.rstrip("/") if plain.startswith("/") else f"/{join_path(run.directory, plain)}".rstrip("/")
    if filled:
        _hide(run, target, "install(DIRECTORY) of a folder that the build fills")
    elif not (own or made) and source and not run.is_unseen(source):
        # What is not there is no folder for CMake, but a file, which it passes over where patterns leave it out.
        if not rule.optional and _chosen(posixpath.basename(top), posixpath.dirname(top), rule)[0]:
            run.missing.append((f"{source}/", span, conditional))
        return
    skip = len(source) + 1 if source else 0
    start = f"{target}/" if target else ""
    chosen = bool(rule.patterns or rule.only)
    for file in (*own, *more, *made) if more or made else own:
        program = file in run.sources.executables if rule.executable is None else rule.executable
        if chosen:
            wanted, given = _chosen(file[skip:], top, rule)
            if not wanted:
                continue
            program = program if given is None else given
        path = f"{start}{file[skip:]}"
        run.installed.append(Provided(path, run.listed(file), program, conditional, span, test=run.testing))


def _made(run: Run, folder: str) -> tuple[list[str], bool]:
    """Return the files below a folder that come into being during the build, and whether there are more that nobody knows."""
    below = f"{folder}/" if folder else ""
    new = sorted(path for path in run.generated if path.startswith(below) and path not in run.files)
    return [path for path in new if path[-1] != "/"], any(path[-1] == "/" and not run.below(path[:-1]) for path in new)


def _install_configured(run: Run, value: str, destination: str, rule: _Rule) -> None:
    """Install what configure_file() has put into a folder below the build folder. The build may put more there."""
    plain, certain = sure(value)
    folder = run.build(plain)
    if folder is None or run.muted:
        return
    span = run.where(value)
    target = destination if plain.endswith("/") or not folder else join_path(destination, posixpath.basename(folder))
    for path, always in run.configured.items():
        inner = path if not folder else path[len(folder) + 1 :] if path.startswith(f"{folder}/") else ""
        if inner and _chosen(inner, plain.rstrip("/"), rule)[0]:
            conditional = run.conditional or run.testing or not certain or not always
            run.installed.append(Provided(join_path(target, inner), "", False, conditional, span))


def unlisted(run: Run, source: str, facet: Facet, span: Span) -> list[str]:
    """Return the files below a folder that are none of the package's own, but are installed with them all the same.

    These are those of nested packages, and of folders that colcon is told to ignore.
    """
    found: list[str] = []
    for folder in run.sources.unseen:
        inside = source == folder or source.startswith(f"{folder}/")
        if inside or not source or folder.startswith(f"{source}/"):
            files = run.sources.look(folder)
            if not files:
                run.hide(facet, "install(DIRECTORY) of a folder whose files are not listed", span)
            found += [file for file in files if not source or file.startswith(f"{source}/")]
    return found


def _chosen(file: str, top: str, rule: _Rule) -> tuple[bool, bool | None]:
    """Return whether patterns leave a file below a folder in, and what permissions they give it.

    Patterns see the path of the folder as it is written.
    """
    end = -1
    while True:  # the folder and those on the way to the file
        folder = f"{top}/{file[:end]}" if end > 0 else top
        if any(pattern.excluded and pattern.matches.search(folder) for pattern in rule.patterns):
            return False, None
        end = file.find("/", end + 1)
        if end < 0:
            break
    matching = [pattern for pattern in rule.patterns if pattern.matches.search(f"{top}/{file}")]
    if any(pattern.excluded for pattern in matching) or (rule.only and not matching):
        return False, None
    given = [pattern.executable for pattern in matching if pattern.executable is not None]
    return True, any(given) if given else None


def _patterns(args: list[str]) -> list[_Pattern] | None:
    found: list[_Pattern] = []
    index = 0
    while index < len(args):
        word = args[index]
        index += 1
        if word not in ("PATTERN", "REGEX") or index >= len(args):
            continue
        text = args[index]
        if not is_known(text):
            return None
        index += 1
        regex = _regex(text) if word == "REGEX" else re.compile(f"/{glob_regex(text)}$")
        if regex is None:
            return None
        excluded, executable = False, None
        while index < len(args) and args[index] not in ("PATTERN", "REGEX"):
            excluded = excluded or args[index] == "EXCLUDE"
            if args[index] == "PERMISSIONS":
                executable = False
            executable = executable or (True if args[index].endswith("_EXECUTE") else executable)
            index += 1
        found.append(_Pattern(regex, excluded, executable))
    return found


def _regex(text: str) -> re.Pattern[str] | None:
    from ros_lint.interpret.cmake_regex import translated  # noqa: PLC0415  (few packages match by expressions)

    return translated(text)


COMMANDS: Final[dict[str, Handler]] = {"install": _install}
