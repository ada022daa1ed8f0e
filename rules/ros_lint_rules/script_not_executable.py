"""
## What it finds

Scripts that are installed to `lib/<package>` but cannot be run:

- Scripts installed without the executable bit: by `install(DIRECTORY scripts/ ...)` without `USE_SOURCE_PERMISSIONS`, by
  `install(FILES ...)`, or by `data_files` from a file without the bit.
- Scripts without an interpreter line such as `#!/usr/bin/env python3`.
- Scripts with an interpreter line that ends with a carriage return, so that the system does not find the interpreter.
- Scripts installed by `install(PROGRAMS ...)` from a file without the bit, because after `colcon build --symlink-install` the
  installed program is that file. The confidence is medium if none of the installed scripts of the package has the bit.

One rule reports all of them, because the effect is the same: the script is installed as a program but does not start.

## Why it matters

`ros2 run` and launch find only executable files: "No executable found". Many tutorials contain the first of these mistakes. It
appears only in builds without `--symlink-install`.

## How to fix it

Write `install(PROGRAMS scripts/a.py DESTINATION lib/${PROJECT_NAME})`, or `USE_SOURCE_PERMISSIONS` and `chmod +x`. The fix
replaces `FILES` by `PROGRAMS`, adds `USE_SOURCE_PERMISSIONS` if the files have the bit, or adds an interpreter line to Python
scripts.

A script whose module is also started by an entry point is an info: remove the script from `data_files`. Exception: a launch file
of the workspace starts the script under its file name.

## Limitations

Not reported:

- Modules that scripts import from the same folder: files without an interpreter line that run nothing when they are started,
  unless a launch file of the workspace starts them.
- Scripts that are installed under a condition.

Reported with medium confidence:

- Imported modules that run something when they are started, for example their own test.
- Scripts installed with `install(FILES)` in a package that exports CMake code, because that code may run them with an
  interpreter.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import (
    Call,
    Confidence,
    Edit,
    Finding,
    Fix,
    InstalledFile,
    Package,
    Related,
    Rule,
    ScriptFile,
    Severity,
    Span,
    Workspace,
    edits,
    first_related,
    launch,
    names,
)

_ENDINGS = (".py", ".sh", ".bash", ".rb", ".pl")


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with not in ("ament_cmake", "ament_python"):
        return
    files = {file.path: file for file in script.files.scripts}
    started = launch.nodes_started(workspace, package.name)
    runs = {provided.path for provided in script.products.installs if provided.program}
    any_executable = any(
        provided.program and provided.source in files and files[provided.source].executable
        for provided in script.products.installs
    )
    entries = {f"{entry.module.replace('.', '/')}.py": entry.name for entry in script.products.entry_points}
    without_bit: dict[Span, list[InstalledFile]] = {}
    for provided in script.products.installs:
        file = files.get(provided.source)
        folder, _, name = provided.path.rpartition("/")
        if file is None or provided.conditional or folder != f"lib/{package.name}":
            continue
        wanted = name in started or (file.main and bool(file.shebang))
        if provided.path not in runs:
            if provided.source in entries and name not in started:
                yield _twice(package, provided, name, entries[provided.source])
            elif wanted and (file.shebang or name.endswith(_ENDINGS)):
                without_bit.setdefault(provided.span, []).append(provided)
        elif provided.program and (file.main or name in started):
            yield from _line(package, file, name, name in started, any_executable)
    for span, scripts in without_bit.items():
        yield _no_bit(package, span, scripts, files)


def _line(package: Package, file: ScriptFile, name: str, started: bool, any_executable: bool) -> Iterator[Finding]:
    """Yield the finding about the interpreter line of a script; if the line is right, about the permissions of the script.

    ``name``: the file name of the script after installation. ``started``: whether a launch file starts the script.
    ``any_executable``: whether any installed script of the package has the executable bit. If none has it, the file system may
    not support the bit.
    """
    place = package.start_of(file.path)
    if file.carriage_return:
        message = f"the first line of '{file.path}' ends with a carriage return, so the interpreter is not found; save it with LF"
        yield Finding(message, place, file.path)
    elif not file.shebang:
        if name.endswith(_ENDINGS):
            interpreter = "#!/usr/bin/env python3" if name.endswith(".py") else "#!/bin/bash"
            message = f"'{file.path}' has no interpreter line, so it cannot be started; begin it with '{interpreter}'"
            sure = name.endswith(".py") and (started or (file.main and not file.helper))
            fix = Fix(f"begin with '{interpreter}'", (Edit(place, f"{interpreter}\n"),)) if sure else None
            yield Finding(message, place, file.path, fix=fix, confidence=Confidence.HIGH if sure else Confidence.MEDIUM)
    elif not file.executable and package.builds_with == "ament_cmake":
        message = f"'{file.path}' is not executable, so it does not start after colcon build --symlink-install; run chmod +x"
        confidence = Confidence.HIGH if any_executable else Confidence.MEDIUM
        yield Finding(message, place, file.path, confidence=confidence, severity=Severity.WARNING)


def _twice(package: Package, script: InstalledFile, name: str, entry: str) -> Finding:
    """Return the finding for a script without the executable bit whose module an entry point starts.

    ``name``: the file name of the script after installation. ``entry``: the name of the entry point.
    """
    return Finding(
        f"'{name}' is installed without the executable bit, so ros2 run does not find it; remove it from data_files, because the "
        f"entry point '{entry}' starts the same module",
        script.span,
        script.source,
        (Related(f"the script '{script.source}'", package.start_of(script.source)),),
        severity=Severity.INFO,
    )


def _no_bit(package: Package, span: Span, scripts: list[InstalledFile], files: dict[str, ScriptFile]) -> Finding:
    all_names = sorted(dict.fromkeys(script.path.rpartition("/")[2] for script in scripts))
    named = names.shorten_list(all_names)
    installs = (call for call in package.calls("install", anywhere=True) if call.args)
    call = next((call for call in installs if call.extent.covers(span)), None)
    remedy, fix = "install(PROGRAMS)", None
    if call is not None and call.texts[0] == "DIRECTORY":
        remedy = "USE_SOURCE_PERMISSIONS or install(PROGRAMS)"
        if all(files[script.source].executable for script in scripts):
            fix = Fix("add USE_SOURCE_PERMISSIONS", (edits.cmake.keep_permissions(call),))
    elif call is not None and call.texts[0] == "FILES":
        fix = Fix("replace FILES by PROGRAMS", (edits.cmake.write(call, 0, "PROGRAMS"),), safe=False)
    elif not span.path.endswith((".txt", ".cmake")):
        remedy = "chmod +x or entry_points"
    it = "them" if len(all_names) > 1 else "it"
    return Finding(
        f"{named} {'are' if len(all_names) > 1 else 'is'} installed without the executable bit, so ros2 run does not find {it}; "
        f"use {remedy}",
        span,
        package.relative(scripts[0].source),
        first_related(Related(f"the script '{script.source}'", package.start_of(script.source)) for script in scripts),
        fix,
        _confidence(package, call),
    )


def _confidence(package: Package, call: Call | None) -> Confidence:
    """Return the confidence of the finding for scripts that are installed without the executable bit.

    It is medium for install(FILES) in a package that exports CMake code, because that code may run the scripts with an
    interpreter, else high.
    """
    run_by_cmake = package.built.exports.config_extras and call is not None and call.texts[0] == "FILES"
    return Confidence.MEDIUM if run_by_cmake else Confidence.HIGH


RULE = Rule(
    name="script-not-executable",
    code="ROS405",
    summary="installed scripts are executable",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
