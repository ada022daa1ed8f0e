"""
## What it finds

Scripts that are installed to `lib/<package>` and cannot be run:

- installed without the executable bit: by `install(DIRECTORY scripts/ ...)` without `USE_SOURCE_PERMISSIONS`, by
  `install(FILES ...)`, or by `data_files` from a file that does not have it;
- without an interpreter line such as `#!/usr/bin/env python3`;
- with one that ends with a carriage return, so that no system finds the interpreter;
- installed by `install(PROGRAMS ...)` from a file without the bit: with `colcon build --symlink-install` that file is what
  is started. The confidence is medium where no other script of the package that is installed so has the bit either.

## Why it matters

`ros2 run` and launch see executable files only: "No executable found". Many tutorials have the first of these mistakes, and
it shows only in builds without `--symlink-install`.

## How to fix it

`install(PROGRAMS scripts/a.py DESTINATION lib/${PROJECT_NAME})`, or `USE_SOURCE_PERMISSIONS` and `chmod +x`. The fix writes
`PROGRAMS` for `FILES`, or adds `USE_SOURCE_PERMISSIONS` where the files have the bit.

## Limitations

For modules that scripts import from beside them: files without an interpreter line that run nothing when they are
started, unless a launch file of the workspace starts them. If they run something, a test of their own say, the confidence
is medium. Under conditions that may not hold.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import (
    Call,
    Confidence,
    Edit,
    Finding,
    Fix,
    Package,
    Provided,
    Related,
    Rule,
    ScriptFile,
    Severity,
    Span,
    Workspace,
    called,
    cmake_edits,
    few,
    place_of,
    relative,
    several,
)

_ENDINGS = (".py", ".sh", ".bash", ".rb", ".pl")


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with not in ("ament_cmake", "ament_python"):
        return
    files = {file.path: file for file in script.files}
    started = workspace.started.get(package.name, {})
    runs = {provided.path for provided in script.provides if provided.program}
    kept = any(
        provided.program and provided.source in files and files[provided.source].executable for provided in script.provides
    )
    told: dict[Span, list[Provided]] = {}
    for provided in script.provides:
        file = files.get(provided.source)
        folder, _, name = provided.path.rpartition("/")
        if file is None or provided.conditional or folder != f"lib/{package.name}":
            continue
        wanted = name in started or (file.main and bool(file.shebang))
        if provided.path not in runs:
            if wanted and (file.shebang or name.endswith(_ENDINGS)):
                told.setdefault(provided.span, []).append(provided)
        elif provided.program and (file.main or name in started):
            yield from _line(package, file, name, name in started, kept)
    for span, provided_here in told.items():
        yield _no_bit(package, span, provided_here, files)


def _line(package: Package, file: ScriptFile, name: str, started: bool, kept: bool) -> Iterator[Finding]:
    """Yield what is wrong with the interpreter line, or else with the permissions of the source.

    ``kept``: others that are installed have the executable bit. Where none has, they may come from where there is no such bit.
    """
    place = place_of(package, file.path)
    if file.carriage_return:
        message = f"the first line of {file.path} ends with a carriage return, so no interpreter is found; save it with LF"
        yield Finding(message, place, file.path)
    elif not file.shebang:
        if name.endswith(_ENDINGS):
            interpreter = "#!/usr/bin/env python3" if name.endswith(".py") else "#!/bin/bash"
            message = f"{file.path} has no interpreter line, so it cannot be started; begin it with {interpreter}"
            sure = name.endswith(".py") and (started or (file.main and not file.helper))
            fix = Fix(f"begin with {interpreter}", (Edit(place, f"{interpreter}\n"),)) if sure else None
            yield Finding(message, place, file.path, fix=fix, confidence=Confidence.HIGH if sure else Confidence.MEDIUM)
    elif not file.executable and package.builds_with == "ament_cmake":
        message = f"{file.path} is not executable, so it does not start after colcon build --symlink-install; chmod +x"
        confidence = Confidence.HIGH if kept else Confidence.MEDIUM
        yield Finding(message, place, file.path, confidence=confidence, severity=Severity.WARNING)


def _no_bit(package: Package, span: Span, provided: list[Provided], files: dict[str, ScriptFile]) -> Finding:
    names = sorted(dict.fromkeys(one.path.rpartition("/")[2] for one in provided))
    named = few(names)
    installs = (call for call in called(package, "install", anywhere=True) if call.args)
    call = next((call for call in installs if call.whole.covers(span)), None)
    way, fix = "install(PROGRAMS)", None
    if call is not None and call.texts[0] == "DIRECTORY":
        way = "USE_SOURCE_PERMISSIONS, or install(PROGRAMS)"
        if all(files[one.source].executable for one in provided):
            fix = Fix("add USE_SOURCE_PERMISSIONS", (cmake_edits.keep_permissions(call),))
    elif call is not None and call.texts[0] == "FILES":
        fix = Fix("install as PROGRAMS", (cmake_edits.write(call, 0, "PROGRAMS"),), safe=False)
    elif not span.path.endswith((".txt", ".cmake")):
        way = "chmod +x, or entry_points"
    it = "them" if len(names) > 1 else "it"
    return Finding(
        f"{named} {'are' if len(names) > 1 else 'is'} installed without the executable bit, so ros2 run does not find {it}; "
        f"use {way}",
        span,
        relative(package, provided[0].source),
        several(Related("this script", place_of(package, one.source)) for one in provided),
        fix,
        _confidence(package, call),
    )


def _confidence(package: Package, call: Call | None) -> Confidence:
    """A script that CMake code of the package starts for others needs no permission to be run."""
    generator = package.built.extras and call is not None and call.texts[0] == "FILES"
    return Confidence.MEDIUM if generator else Confidence.HIGH


RULE = Rule(
    name="script-not-executable",
    code="ROS405",
    summary="a script that is installed to be run must be executable",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
