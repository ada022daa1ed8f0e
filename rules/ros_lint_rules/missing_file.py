"""
## What it finds

Files and folders that a build script names and that are not there: sources of a target, interface files, subfolders,
included CMake code, `CONFIG_EXTRAS` of `ament_package()`, environment hooks, what `install()` is to install, `data_files`,
`scripts` and `packages` of `setup.py`, the package that `ament_python_install_package()` installs. Also folders where
`install(FILES)` wants a file.

## Why it matters

The build stops: CMake when it configures or when it installs (`file INSTALL cannot find`), setuptools with
`error: can't copy 'x': doesn't exist or not a regular file`. On the machine of the author the file is often there: empty
folders and ignored files are not part of a repository.

## How to fix it

Correct the path, add the file to the repository, or remove the line. A folder that may be empty needs a file in it, or
`OPTIONAL` in the install rule.

## Limitations

- Paths that cannot be evaluated, files in the build folder, and files that the build generates.
- Under a condition that may not hold, with `OPTIONAL`, and a folder that `FILES_MATCHING` leaves out by its own name, as
  `PATTERN "*.h"` does: CMake passes over it. So it does over folders among the sources of a target.
- The confidence is medium where the script runs programs that may make files or downloads them, for what git ignores or may
  be a submodule, and for what is installed where custom commands or targets work in the source folder: they may make it.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import (
    Call,
    Confidence,
    Finding,
    Package,
    Problem,
    Rule,
    Severity,
    Workspace,
    called,
    evaluated_name,
    is_meant,
    similar,
)

_KINDS = ("missing-file", "missing-folder", "missing-script", "file-is-directory")
_KINDS_OF_INSTALL = ("DIRECTORY", "FILES", "PROGRAMS", "TARGETS")
_WORKS = ("COMMAND", "ARGS", "WORKING_DIRECTORY")
_RUNS = ("execute_process", "exec_program")
_MAKES_FILES = frozenset({*_RUNS, "externaldata_add_target", "externaldata_expand_arguments"})
_TELLS = frozenset({
    "arch", "date", "dpkg-architecture", "hostname", "lsb_release", "nproc", "nvidia-smi", "pkg-config", "uname", "which",
    "whoami",
})  # fmt: skip
"""Programs that only tell something."""
_GIT_TELLS = frozenset({"describe", "diff", "log", "ls-files", "rev-list", "rev-parse", "show", "status", "symbolic-ref"})


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or not package.type.startswith("ros."):
        return
    seen: set[str] = set()
    for problem in script.problems:
        path = problem.subject
        if problem.kind in _KINDS and path not in seen and not _is_unseen(package, path):
            seen.add(path)
            hint = _hint(package, path) if problem.kind != "file-is-directory" else ""
            says = f"{path} does not exist" if path in _KINDS_OF_INSTALL else problem.message
            yield Finding(f"{says}{hint}", problem.span, path, confidence=_confidence(package, workspace, problem))
    if package.builds_with == "ament_cmake":
        yield from _python_packages(package)


def _is_unseen(package: Package, path: str) -> bool:
    """Whether something lies at a path, or around it or in it, that nobody has looked into, such as a submodule."""
    return any(f"{path}/".startswith(f"{folder}/") or folder.startswith(f"{path}/") for folder in package.unseen)


def _confidence(package: Package, workspace: Workspace, problem: Problem) -> Confidence:
    script = package.script
    assert script is not None
    if any(workspace.is_made(package, path) for path in (problem.subject, f"{problem.subject}/*")):  # or all that lies in it
        return Confidence.MEDIUM
    if _makes_files(package) or (_is_installed(package, problem) and _builds_in_sources(package)):
        return Confidence.MEDIUM
    if problem.kind == "missing-folder" and any(path.endswith(".gitmodules") for path in workspace.source_lists):
        return Confidence.MEDIUM
    return Confidence.HIGH


def _makes_files(package: Package) -> bool:
    """Whether the script may make files while CMake configures."""
    ran = _MAKES_FILES.intersection(package.built.calls)
    if not ran.issubset(_RUNS):
        return True
    calls = list(called(package, *_RUNS, anywhere=True))
    return bool(ran) and not (calls and all(_only_tells(call) for call in calls))


def _only_tells(call: Call) -> bool:
    texts = ("COMMAND", *call.texts) if call.name == "exec_program" else call.texts
    programs = [at + 1 for at, text in enumerate(texts[:-1]) if text == "COMMAND"]
    return bool(programs) and all(
        texts[at] in _TELLS or (texts[at] in ("git", "${GIT_EXECUTABLE}") and not _GIT_TELLS.isdisjoint(texts[at + 1 : at + 4]))
        for at in programs
    )


def _is_installed(package: Package, problem: Problem) -> bool:
    """Whether it is missed when everything is built, and not when CMake configures."""
    return any(call.whole.covers(problem.span) for call in called(package, "install", anywhere=True))


def _builds_in_sources(package: Package) -> bool:
    """Whether a custom command or target has the source folder to work in, or to work on."""
    for call in called(package, "add_custom_command", "add_custom_target", anywhere=True):
        word = ""
        for text in call.texts:
            if text.isupper() and "$" not in text:
                word = text
            elif word in _WORKS and "SOURCE_DIR}" in text:
                return True
    return False


def _hint(package: Package, path: str) -> str:
    """Say which file is meant: one of that name elsewhere, or one with a similar name beside it."""
    if path in _KINDS_OF_INSTALL:
        return f"; CMake takes the word for a path where it stands again, so write {path} once"
    folder, _, name = path.rpartition("/")
    same = [file for file in package.files if file.rpartition("/")[2] == name]
    if len(same) == 1:
        return is_meant(same)
    beside = [file.rpartition("/")[2] for file in package.files if file.rpartition("/")[0] == folder]
    return is_meant([f"{folder}/{near}".lstrip("/") for near in similar(name, beside, 1, 0.8)])


def _python_packages(package: Package) -> Iterator[Finding]:
    for call in called(package, "ament_python_install_package"):
        name = evaluated_name(package, call.texts[0]) if call.args else None
        if call.blocks or name is None or _has_option(call):
            continue
        folder = name.replace(".", "/")
        if f"{folder}/__init__.py" in package.files or _is_unseen(package, folder):
            continue
        what = "has no __init__.py" if any(file.startswith(f"{folder}/") for file in package.files) else "does not exist"
        yield Finding(
            f"ament_python_install_package() of {folder}, which {what}",
            call.span(0),
            folder if what.startswith("does") else f"{folder}/__init__.py",
        )


def _has_option(call: Call) -> bool:
    return any(text == "PACKAGE_DIR" or "$" in text for text in call.texts[1:])


RULE = Rule(
    name="missing-file",
    code="ROS304",
    summary="a file that a build script names must exist",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    package=check,
)
