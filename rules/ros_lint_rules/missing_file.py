"""
## What it finds

Files and folders that a build script names but that do not exist:

- sources of targets, interface files, subfolders, included CMake files;
- `CONFIG_EXTRAS` of `ament_package()` and environment hooks;
- files and folders in `install()` and `ament_python_install_package()`;
- `data_files`, `scripts` and `packages` of `setup.py`.

Also folders where `install(FILES)` expects a file.

In a hook of pre-commit (`PRE_COMMIT=1`), files that git does not track count as missing: "'src/extra.cpp' exists, but git does
not track it".

One rule reports all of them, because each is a path in a build script at which there is no such file.

## Why it matters

The build fails: CMake when it configures or installs (`file INSTALL cannot find`), setuptools with
`error: can't copy 'x': doesn't exist or not a regular file`. On the author's machine the file often exists, but empty folders and
ignored files are not part of a repository.

## How to fix it

Correct the path, add the file to the repository, or remove the line. Put a file into a folder that may be empty, or write
`OPTIONAL` in its install rule.

## Limitations

Not reported:

- Paths that cannot be evaluated, files in the build folder, and files that the build generates.
- Commands under a condition that may be false, and `install()` with `OPTIONAL`.
- A folder that its own `FILES_MATCHING PATTERN` excludes, as `PATTERN "*.h"` does, and folders among the sources of a target:
  CMake ignores both.

Reported with medium confidence, because something may create the file:

- The script runs programs that may generate or download files.
- The file is ignored by git, or may be in a submodule.
- The file is installed, and custom commands or targets work in the source folder.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Mapping

from ros_lint.api import (
    Call,
    Confidence,
    Finding,
    Package,
    Problem,
    Rule,
    Severity,
    Workspace,
    build,
    cached_by_package,
    files,
    names,
)

_KINDS = ("missing-file", "missing-folder", "missing-script", "file-is-directory")
_KINDS_OF_INSTALL = ("DIRECTORY", "FILES", "PROGRAMS", "TARGETS")
_KEYWORDS_OF_WORK = ("COMMAND", "ARGS", "WORKING_DIRECTORY")
_RUNS = ("execute_process", "exec_program")
_MAKES_FILES = frozenset({*_RUNS, "externaldata_add_target", "externaldata_expand_arguments"})
_PRINTING = frozenset({
    "arch", "date", "dpkg-architecture", "hostname", "lsb_release", "nproc", "nvidia-smi", "pkg-config", "uname", "which",
    "whoami",
})  # fmt: skip
"""Programs that only print information and create no file."""
_PRINTING_OF_GIT = frozenset({"describe", "diff", "log", "ls-files", "rev-list", "rev-parse", "show", "status", "symbolic-ref"})


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or not package.type.startswith("ros."):
        return
    seen: set[str] = set()
    for problem in script.problems:
        path = problem.subject.rstrip("/")
        if problem.kind in _KINDS and path not in seen and not _is_unseen(package, path):
            seen.add(path)
            message = _message(package, workspace, problem, path)
            yield Finding(message, problem.span, path, confidence=_confidence(package, workspace, problem))
    if package.builds_with == "ament_cmake":
        yield from _python_packages(package)


def _message(package: Package, workspace: Workspace, problem: Problem, path: str) -> str:
    if workspace.is_untracked(package, path):
        return f"'{path}' exists, but git does not track it, so a clone lacks it; run git add"
    hint = _hint(package, path, workspace) if problem.kind != "file-is-directory" else ""
    message = f"'{path}' does not exist" if path in _KINDS_OF_INSTALL else problem.message
    if not hint and ";" not in message:  # the message has no remedy
        hint = f"; correct the path, or add the {'folder' if problem.kind == 'missing-folder' else 'file'}"
    return f"{message}{hint}"


def _is_unseen(package: Package, path: str) -> bool:
    """Return whether a path is in a folder that was not read, such as a submodule, or is a folder above such a folder."""
    return any(f"{path}/".startswith(f"{folder}/") or folder.startswith(f"{path}/") for folder in package.unvisited_folders)


def _confidence(package: Package, workspace: Workspace, problem: Problem) -> Confidence:
    script = package.script
    assert script is not None
    missing = problem.subject.rstrip("/")
    if any(workspace.is_made(package, path) for path in (missing, f"{missing}/*")):  # or everything in it
        return Confidence.MEDIUM
    if _makes_files(package, workspace) or (_is_installed(package, problem) and _builds_in_sources(package, workspace)):
        return Confidence.MEDIUM
    if problem.kind == "missing-folder" and any(path.endswith(".gitmodules") for path in workspace.source_lists):
        return Confidence.MEDIUM
    return Confidence.HIGH


@cached_by_package
def _makes_files(package: Package, _workspace: Workspace) -> bool:
    """Return whether the script may create files while CMake configures."""
    makers = _MAKES_FILES.intersection(package.built.commands.names)
    if not makers.issubset(_RUNS):
        return True
    calls = list(package.calls(*_RUNS, anywhere=True))
    return bool(makers) and not (calls and all(_only_prints(call) for call in calls))


def _only_prints(call: Call) -> bool:
    texts = ("COMMAND", *call.texts) if call.name == "exec_program" else call.texts
    programs = [at + 1 for at, text in enumerate(texts[:-1]) if text == "COMMAND"]
    return bool(programs) and all(
        texts[at] in _PRINTING
        or (texts[at] in ("git", "${GIT_EXECUTABLE}") and not _PRINTING_OF_GIT.isdisjoint(texts[at + 1 : at + 4]))
        for at in programs
    )


def _is_installed(package: Package, problem: Problem) -> bool:
    """Return whether install() needs the missing file of a problem, so that only the installation fails."""
    installs = package.built.commands.calls.named("install")
    before = bisect_right(installs, problem.span[:3], key=lambda call: call.name_span[:3])
    return before > 0 and installs[before - 1].extent.covers(problem.span)


@cached_by_package
def _builds_in_sources(package: Package, _workspace: Workspace) -> bool:
    """Return whether a custom command or target names the source folder in its command, arguments or working directory."""
    for call in package.calls("add_custom_command", "add_custom_target", anywhere=True):
        word = ""
        for text in call.texts:
            if text.isupper() and "$" not in text:
                word = text
            elif word in _KEYWORDS_OF_WORK and "SOURCE_DIR}" in text:
                return True
    return False


def _hint(package: Package, path: str, workspace: Workspace) -> str:
    """Return the suggestion for a missing file: the only file of the package with its name, or a similar name in its folder.

    A repeated keyword of install(), such as ``FILES FILES a.txt``, is read as a path, too: then the suggestion is to write it
    once. The result is "" if there is no suggestion.
    """
    if path in _KINDS_OF_INSTALL:
        return f"; CMake reads a repeated {path} as a path, so write it only once"
    folder, _, name = path.rpartition("/")
    same = files.files_by_name(package, workspace).get(name, ())
    if len(same) == 1:
        return names.ask_if_meant(same)
    siblings = names.of_same_kind(path, _names_by_folder(package, workspace).get(folder, ()))
    return names.ask_if_meant([f"{folder}/{near}".lstrip("/") for near in names.similar_names(name, siblings, 1, 0.8)])


@cached_by_package
def _names_by_folder(package: Package, _workspace: Workspace) -> Mapping[str, tuple[str, ...]]:
    """Return the names of the files in each folder of a package."""
    result: dict[str, list[str]] = {}
    for file in package.files:
        folder, _, name = file.rpartition("/")
        result.setdefault(folder, []).append(name)
    return {folder: tuple(found) for folder, found in result.items()}


def _python_packages(package: Package) -> Iterator[Finding]:
    for call in package.calls("ament_python_install_package"):
        name = build.evaluated_name(package, call.texts[0]) if call.args else None
        if call.blocks or name is None or _has_option(call):
            continue
        folder = name.replace(".", "/")
        if f"{folder}/__init__.py" in package.files or _is_unseen(package, folder):
            continue
        exists = any(file.startswith(f"{folder}/") for file in package.files)
        what = "has no __init__.py; add one" if exists else "does not exist; correct the name, or add the folder"
        yield Finding(
            f"ament_python_install_package() fails because the folder '{folder}' {what}",
            call.span(0),
            f"{folder}/__init__.py" if exists else folder,
        )


def _has_option(call: Call) -> bool:
    return any(text == "PACKAGE_DIR" or "$" in text for text in call.texts[1:])


RULE = Rule(
    name="missing-file",
    code="ROS304",
    summary="files that a build script names exist",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    package=check,
)
