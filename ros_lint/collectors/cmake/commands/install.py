"""install() of files, programs, folders and targets (cmake-commands(7))."""

from __future__ import annotations

import posixpath
import re
from itertools import count
from typing import Final

from ros_lint.base.paths import join as join_path
from ros_lint.base.wildcards import LONGEST, spaced
from ros_lint.collectors.cmake.commands.install_destinations import ANYWHERE, destination_of, hide
from ros_lint.collectors.cmake.commands.install_directory import install_directories
from ros_lint.collectors.cmake.commands.install_targets import install_targets
from ros_lint.collectors.cmake.evaluator.arguments import sections, with_one_destination
from ros_lint.collectors.cmake.evaluator.run import Handler, Run
from ros_lint.collectors.cmake.evaluator.values import ATOM, HOLE, is_fixed, is_known, strip_mark
from ros_lint.collectors.cmake.released_macros import INSTALL_ARTIFACTS
from ros_lint.facts.build import InstalledFile

_OF_TARGETS: Final = frozenset({"ARCHIVE", "LIBRARY", "RUNTIME"})
_FILE_WORDS: Final = {
    "TYPE": 1, "DESTINATION": 1, "PERMISSIONS": -1, "CONFIGURATIONS": -1, "COMPONENT": 1, "RENAME": 1, "OPTIONAL": 0,
    "EXCLUDE_FROM_ALL": 0,
}  # fmt: skip


_WRITES = re.compile(
    r"\bfile\s*\(|symlink|\bcopy|\binstall|\b(?:ln|cp|mv)\b|configure_file|rename|\btar\b|\bmake\b", re.IGNORECASE
)
"""Pattern of the words in install(CODE) that write or copy files."""


def _install(run: Run, args: list[str]) -> None:
    mode = args[0] if args else ""
    args = with_one_destination(args)
    if args[1:2] and (args[1] == "DESTINATION" or (mode == "TARGETS" and args[1] in INSTALL_ARTIFACTS)):
        return  # the list was empty, which CMake allows
    if mode in ("FILES", "PROGRAMS", "DIRECTORY") and (artifact := next((arg for arg in args if arg in _OF_TARGETS), "")):
        message = f"install({mode}) does not accept '{artifact}', which belongs to install(TARGETS)"
        run.add_problem("cmake-syntax", message, run.place_of(artifact))
        args = [arg for arg in args if arg not in _OF_TARGETS]
    if mode == "TARGETS":
        install_targets(run, args[1:])
    elif mode in ("FILES", "PROGRAMS"):
        _install_files(run, [arg for arg in args[1:] if arg != mode], mode == "PROGRAMS")
    elif mode == "DIRECTORY":
        install_directories(run, args[1:])
    elif mode == "SCRIPT" or (mode == "CODE" and any(not is_fixed(arg) or _WRITES.search(arg) for arg in args[1:])):
        run.hide(ANYWHERE, f"install({mode}) runs code during installation")
    elif mode == "CODE":
        pass  # such as compiling Python modules
    elif mode not in ("EXPORT", "EXPORT_ANDROID_MK", "IMPORTED_RUNTIME_ARTIFACTS", "RUNTIME_DEPENDENCY_SET"):
        run.hide(ANYWHERE, "the form of install() is unknown")


def _install_files(run: Run, args: list[str], program: bool) -> None:
    parts = sections(args, _FILE_WORDS)
    destination = destination_of(run, parts)
    rename = parts.get("RENAME", [""])[0] if parts.get("RENAME") else ""
    if "PERMISSIONS" in parts:
        program = any(word.endswith("_EXECUTE") for word in parts["PERMISSIONS"])
    for value in dict.fromkeys(parts[""]):
        plain, certain = strip_mark(value)
        name = rename or posixpath.basename(plain)
        if destination is None or "$<" in name or not is_fixed(name):
            hide(run, destination, "the files or the destination of install() are unknown")
            continue
        _install_file(run, value, join_path(destination, name), program, certain, "OPTIONAL" in parts)


def _install_file(run: Run, value: str, path: str, program: bool, certain: bool, optional: bool) -> None:
    if run.muted:
        return
    plain = strip_mark(value)[0]
    span = run.place_of(value)
    source = run.paths.source(plain)
    conditional = run.conditional or run.testing or not certain
    if source is None:
        source = run.paths.outside(plain)
        conditional = conditional or (source is None and (optional or not _may_exist(run, plain)))
    elif run.paths.is_unlisted(source):
        source = None
    if source is not None and not run.paths.is_file(source):
        if run.paths.is_folder(source) and source:
            message = f"install(FILES) cannot install '{source}', because it is a directory; use install(DIRECTORY)"
            run.add_problem("file-is-directory", message, span, source)
            return
        if optional:
            return
        run.results.missing_files.append((source, span, conditional))
        if source not in run.paths.generated:
            run.results.installed.append(InstalledFile(path, source, program, True, span))
            return
        source = ""
    run.results.installed.append(InstalledFile(path, source or "", program, conditional, span, test=run.testing))


def _may_exist(run: Run, value: str) -> bool:
    """Return whether a file may exist at a partly known path. The result is True for a path outside of the package."""
    home = f"{run.paths.absolute('')}/"
    if value.startswith(home):
        inside = value[len(home) :]
    elif value[:1] in ("/", "$", HOLE):
        return True
    else:
        inside = join_path(run.paths.directory, value)
    if is_known(inside):
        return True
    if len(inside) > LONGEST:
        return False
    like = re.compile(spaced(list(map(re.escape, _UNKNOWN.split(inside))), ".*", count()))
    return any(map(like.fullmatch, (*run.paths.files, *run.paths.generated)))


_UNKNOWN: Final = re.compile(rf"[{HOLE}\3]+|{ATOM}[^/]*")


COMMANDS: Final[dict[str, Handler]] = {"install": _install}
