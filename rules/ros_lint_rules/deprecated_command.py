"""
## What it finds

What the distribution still takes but wants to be rid of: `rosidl_target_interfaces()` (since Humble),
`ament_export_interfaces()` (since Foxy), `ament_target_dependencies()` (since Kilted), and keys with a dash in `setup.cfg`
(`script-dir`, `install-scripts`; since setuptools 54).

## Why it matters

A later distribution stops there: `ament_target_dependencies()` is gone in Lyrical, and setuptools 78.0 refused dashed keys
with an error.

## How to fix it

- `ament_target_dependencies(t p)`: `target_link_libraries(t PUBLIC p::p)`, or `${p_TARGETS}` for interface packages. The fix
  links to `${p_TARGETS}`, as the command does, where each package is named in all calls and is known to export targets.
- `rosidl_target_interfaces(t ${PROJECT_NAME} "rosidl_typesupport_cpp")`: `rosidl_get_typesupport_target(support
  ${PROJECT_NAME} "rosidl_typesupport_cpp")` and `target_link_libraries(t ${support})`.
- `ament_export_interfaces()`: `ament_export_targets()`.
- `script-dir`: `script_dir`, `install-scripts`: `install_scripts`. The fix does these two and the one before.

## Limitations

- For distributions in which the command is not deprecated, so in Humble and Jazzy for `ament_target_dependencies()`. Where the
  command is gone, `removed-command` speaks instead.
- Under a condition, when what replaces the command is called under a condition, too: the script is for several distributions.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ros_lint.api import (
    Call,
    Edit,
    Finding,
    Fix,
    Package,
    Problem,
    Related,
    Rule,
    Severity,
    Workspace,
    called,
    cmake_edits,
    several,
)

_ALWAYS = {
    "rosidl_target_interfaces": (
        "rosidl_get_typesupport_target",
        "use rosidl_get_typesupport_target() and target_link_libraries()",
    ),
    "ament_export_interfaces": ("ament_export_targets", "use ament_export_targets()"),
}
_SINCE_KILTED = {"ament_target_dependencies": ("target_link_libraries", "use target_link_libraries() with p::p, or ${p_TARGETS}")}


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None:
        return
    if package.builds_with == "ament_cmake":
        old = {**_ALWAYS, **(_SINCE_KILTED if workspace.target.distro == "kilted" else {})}
        for name, (successor, instead) in old.items():
            replaced = any(_is_switched(call) for call in called(package, successor, anywhere=True))
            calls = [call for call in called(package, name, anywhere=True) if not (replaced and _is_switched(call))]
            if not calls:
                continue
            first, *others = calls
            fix = None
            if name == "ament_target_dependencies":
                fix = Fix.of(cmake_edits.LINKED, *cmake_edits.link_to_targets(calls, workspace), safe=False)
            elif name == "ament_export_interfaces":
                fix = Fix("call ament_export_targets()", tuple(Edit(call.place, "ament_export_targets") for call in calls))
            related = several(Related("also here", call.place) for call in others)
            yield Finding(f"{name}() is deprecated; {instead}", first.place, name, related, fix)
    dashed = [problem for problem in script.problems if problem.kind == "dashed-key"]
    if dashed:
        yield _dashed(dashed)


def _dashed(keys: Sequence[Problem]) -> Finding:
    """Speak of all keys with a dash at once: they are deprecated for one reason."""
    first, *others = keys
    better = " and ".join(dict.fromkeys(key.subject.replace("-", "_") for key in keys))
    fix = Fix(f"write {better}", tuple(Edit(key.span, key.subject.replace("-", "_")) for key in keys))
    what = f"the keys {' and '.join(dict.fromkeys(key.subject for key in keys))} are" if others else f"the key {first.subject} is"
    related = several(Related("and here", key.span) for key in others)
    return Finding(f"{what} deprecated; write {better}", first.span, first.subject, related, fix)


def _is_switched(call: Call) -> bool:
    """Whether a command stands under a condition, other than that tests are wanted."""
    return call.blocks.count("if") > call.test


RULE = Rule(
    name="deprecated-command",
    code="ROS307",
    summary="what a later distribution removes should be replaced",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
