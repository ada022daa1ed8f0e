"""
## What it finds

Interface files without generated code:

- Messages, services and actions in `msg/`, `srv/` and `action/` that `rosidl_generate_interfaces()` does not list, although it
  lists others.
- Interface files of an `ament_python` package that declares in `package.xml` that it generates interfaces. `ament_python`
  cannot generate code.

## Why it matters

Without generated code the build or the import fails: "fatal error: robot/msg/state.hpp: No such file or directory", "cannot
import name 'State' from 'robot.msg'". `ros2 interface show` does not find the interface.

## How to fix it

Add the file to the call, or remove the file. The fix adds it below another file of the same folder, if the call lists files of
this folder literally.

- rosidl rejects names like `motor_state.msg`: rename the file to `MotorState.msg` first.
- Move the interfaces of an `ament_python` package to an `ament_cmake` package.

## Limitations

Not reported:

- Files in packages that generate nothing. `unknown-interface` reports them if they are used.
- Files in other folders, and copies such as `State copy.msg` or `State.old.msg`.
- Files, if the list cannot be evaluated.

The confidence is medium if a comment in the CMake file contains the file in place of a list element, or if the call is under a
condition.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import (
    Call,
    Confidence,
    Edit,
    Facet,
    Finding,
    Fix,
    Package,
    Related,
    Rule,
    Severity,
    Workspace,
    first_related,
    names,
)

_GENERATE = "rosidl_generate_interfaces"
_DECLARE_INTERFACES = (names.interfaces.GROUP, "rosidl_default_generators")


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if package.builds_with == "ament_python":
        yield from _of_python(package)
    if script is None or package.builds_with != "ament_cmake" or package.hidden(Facet.INTERFACES):
        return
    calls = list(package.calls(_GENERATE, anywhere=True))
    if not calls or not script.products.interfaces:
        return
    plain: dict[str, list[str]] = {}
    for file in package.files:
        interface = names.interfaces.defined_in(file) if file.count("/") == 1 else ""
        kind, _, name = interface.partition("/")
        if interface in script.products.interfaces or not name.isidentifier():
            continue
        required = "" if file.endswith(".idl") or names.interfaces.is_message(name) else names.interfaces.camel(name)
        rejection = next(_rejections(package, workspace, file), "")
        commented_out = interface in script.cmake.commented_interfaces
        if required or rejection or commented_out:
            yield _finding(package, calls, file, required, rejection, commented_out=commented_out)
        else:
            plain.setdefault(kind, []).append(file)
    for files in plain.values():
        if len(files) > _MANY:
            yield _of_many(package, calls, files)
        else:
            yield from (_finding(package, calls, file) for file in files)


def _of_python(package: Package) -> Iterator[Finding]:
    """Yield one finding for all interface files of an ament_python package, because ament_python cannot generate code.

    The place of the finding is the tag by which the package declares that it generates interfaces.
    """
    depends = package.manifest.depends if package.manifest else ()
    tag = next((depend for depend in depends if depend.name in _DECLARE_INTERFACES), None)
    suffixes = tuple([f".{kind}" for kind in names.interfaces.KINDS])
    files = [file for file in package.files if file.endswith(suffixes) and names.interfaces.defined_in(file)]
    if tag is None or not files:
        return
    others = f" and {len(files) - 1} more file{'s' if files[2:] else ''}" if len(files) > 1 else ""
    yield Finding(
        f"no code is generated for '{files[0]}'{others}, because ament_python cannot generate interfaces; move "
        f"{'them' if others else 'it'} to an ament_cmake package",
        tag.span,
        files[0],
        first_related(_here(package, file) for file in files),
    )


def _here(package: Package, file: str) -> Related:
    return Related(f"no code is generated for '{file}'", package.start_of(file))


def _rejections(package: Package, workspace: Workspace, file: str) -> Iterator[str]:
    """Yield the reasons why no code can be generated for a file: rosidl rejects it, or the package of a field type is unknown."""
    for interface in package.interface_files:
        if package.relative(interface.path) == file:
            yield from (problem.message for problem in interface.problems)
            for field_type, _ in interface.types:
                owner = field_type.partition("/")[0] if "/" in field_type else package.name
                if owner != package.name and workspace.world.resolution(owner) == "unknown":
                    yield f"there is no package '{owner}'"


def _finding(
    package: Package, calls: list[Call], file: str, required: str = "", rejection: str = "", *, commented_out: bool = False
) -> Finding:
    """Return the finding about an interface file that is not listed in rosidl_generate_interfaces().

    ``required``: the name that rosidl requires, "" if the file has a valid name. ``rejection``: why rosidl rejects the content,
    "" if it does not. ``commented_out``: the list has the file in a comment.
    """
    remedy = f"rename it to '{required}', as rosidl requires, and add it" if required else "add it or remove the file"
    if required and f"{names.interfaces.defined_in(file).partition('/')[0]}/{required}" in package.built.products.interfaces:
        remedy = f"'{required}' replaces it, so remove the file"
    elif rejection and not required:
        remedy = f"remove the file; to generate it, first correct the error in it: {rejection}"
    return Finding(
        f"'{file}' is not listed in {_GENERATE}(), so no code is generated for it; {remedy}",
        calls[0].name_span,
        file,
        (_here(package, file),),
        None if required or commented_out or rejection else _fix(calls, [file]),
        Confidence.MEDIUM if commented_out or calls[0].blocks else Confidence.HIGH,
    )


_MANY = 5
"""Maximum number of unlisted files of one folder that get a finding each. More files share one finding."""


def _of_many(package: Package, calls: list[Call], files: list[str]) -> Finding:
    return Finding(
        f"'{files[0]}' and {len(files) - 1} more files are not listed in {_GENERATE}(), so no code is generated for them; "
        "add or remove them",
        calls[0].name_span,
        f"{files[0].partition('/')[0]}/",
        first_related(_here(package, file) for file in files),
        _fix(calls, files),
        Confidence.MEDIUM if calls[0].blocks else Confidence.HIGH,
    )


def _fix(calls: list[Call], files: list[str]) -> Fix | None:
    """Return the fix that lists files of one folder after the last listed file; None if no file is listed literally."""
    folder = f"{files[0].partition('/')[0]}/"
    for call in calls:
        at = max((index for index, text in enumerate(call.texts) if text.startswith(folder)), default=None)
        if at is not None:
            span = call.span(at)
            quote = '"' if span.end_column - span.column == len(call.texts[at]) + 2 else ""
            gap = " " if at and span.line == call.span(at - 1).line else "\n" + " " * (span.column - 1)
            added = "".join(f"{gap}{quote}{file}{quote}" for file in files)
            return Fix(f"add {names.shorten_list(files)} to {_GENERATE}()", (Edit(span.end(), added),), safe=False)
    return None


RULE = Rule(
    name="ungenerated-interface",
    code="ROS313",
    summary="code is generated for interface files",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
