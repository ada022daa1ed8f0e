"""
## What it finds

Commands and keys that are deprecated in the target distribution and that a later one removes:

- `rosidl_target_interfaces()`, since Humble;
- `ament_export_interfaces()`, since Foxy;
- `ament_target_dependencies()`, since Kilted;
- keys with a dash in `setup.cfg` (`script-dir`, `install-scripts`), since setuptools 54.

## Why it matters

The build fails in a later distribution: `ament_target_dependencies()` was removed in Lyrical, and setuptools 78.0 stopped at
dashed keys.

## How to fix it

- `ament_target_dependencies(t p)`: use `target_link_libraries(t PUBLIC p::p)`, or `${p_TARGETS}` for interface packages. The
  fix links to `${p_TARGETS}`, as the command does. It is offered if no call has a variable among the package names, and each
  package is known to export targets.
- `rosidl_target_interfaces(t ${PROJECT_NAME} "rosidl_typesupport_cpp")`: use `rosidl_get_typesupport_target(support
  ${PROJECT_NAME} "rosidl_typesupport_cpp")` and `target_link_libraries(t ${support})`.
- `ament_export_interfaces()`: use `ament_export_targets()`. The fix does this.
- `script-dir` and `install-scripts`: write `script_dir` and `install_scripts`. The fix does this.

## Limitations

Not reported:

- Commands that the target distribution has not deprecated: in Humble and Jazzy, `ament_target_dependencies()`.
- Commands that the target distribution has removed: see `removed-command`.
- Commands under a condition, if the replacement is called under a condition, too: such a script supports several distributions.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ros_lint.api import Call, Edit, Finding, Fix, Package, Problem, Related, Rule, Severity, Workspace, edits, first_related

_ALWAYS = {
    "rosidl_target_interfaces": (
        "rosidl_get_typesupport_target",
        "use rosidl_get_typesupport_target() and target_link_libraries()",
    ),
    "ament_export_interfaces": ("ament_export_targets", "use ament_export_targets()"),
}
_SINCE_KILTED = {
    "ament_target_dependencies": ("target_link_libraries", "use target_link_libraries() with targets such as rclcpp::rclcpp")
}


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None:
        return
    if package.builds_with == "ament_cmake":
        old = {**_ALWAYS, **(_SINCE_KILTED if workspace.target.distro == "kilted" else {})}
        for name, (successor, instead) in old.items():
            replaced = any(_is_conditional(call) for call in package.calls(successor, anywhere=True))
            calls = [call for call in package.calls(name, anywhere=True) if not (replaced and _is_conditional(call))]
            if not calls:
                continue
            first, *others = calls
            fix = None
            if name == "ament_target_dependencies":
                fix = Fix.of(edits.cmake.LINKED, *edits.cmake.link_to_targets(calls, workspace), safe=False)
            elif name == "ament_export_interfaces":
                fix = Fix("call ament_export_targets()", tuple(Edit(call.name_span, "ament_export_targets") for call in calls))
            related = first_related(Related(f"{name}() is also called here", call.name_span) for call in others)
            yield Finding(f"{name}() is deprecated; {instead}", first.name_span, name, related, fix)
    dashed = [problem for problem in script.problems if problem.kind == "dashed-key"]
    if dashed:
        yield _dashed(dashed)


def _dashed(keys: Sequence[Problem]) -> Finding:
    """Return one finding for all deprecated keys of setup.cfg, those with a dash in their name."""
    first, *others = keys
    better = " and ".join(f"'{key}'" for key in dict.fromkeys(key.subject.replace("-", "_") for key in keys))
    fix = Fix(f"write {better} in setup.cfg", tuple(Edit(key.span, key.subject.replace("-", "_")) for key in keys))
    dashed = " and ".join(f"'{key}'" for key in dict.fromkeys(key.subject for key in keys))
    what = f"the keys {dashed} are" if others else f"the key {dashed} is"
    related = first_related(Related(f"the key '{key.subject}' is also deprecated", key.span) for key in others)
    return Finding(f"{what} deprecated; write {better}", first.span, first.subject, related, fix)


def _is_conditional(call: Call) -> bool:
    """Return whether a call is under a condition other than BUILD_TESTING."""
    return call.blocks.count("if") > call.test


RULE = Rule(
    name="deprecated-command",
    code="ROS307",
    summary="build scripts use nothing that a later distribution removes",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
