"""
## What it finds

CMake commands that the distribution has no more: `ament_target_dependencies()` in Lyrical and Rolling.

## Why it matters

CMake stops: "Unknown CMake command "ament_target_dependencies"".

## How to fix it

Link to targets: `target_link_libraries(t PUBLIC rclcpp::rclcpp ${std_msgs_TARGETS})`. For the time being, the package
`ament_cmake_target_dependencies` brings the command back: find it and declare it as `<buildtool_depend>`.

## When it keeps silent

In other distributions; where that package is found, or the command is defined in the package itself; under conditions. The
confidence is medium where nobody said which distribution is meant.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Confidence, Finding, Package, Related, Rule, Severity, Workspace, called

_GONE = {"ament_target_dependencies": ("ament_cmake_target_dependencies", frozenset({"lyrical", "rolling"}))}
_MOST_RELATED = 4


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with != "ament_cmake":
        return
    found = {mention.name for mention in script.mentions if mention.via == "cmake"}
    for name, (provider, distros) in _GONE.items():
        calls = [call for call in called(package, name, anywhere=True) if not call.blocks or call.test]
        if not calls or workspace.target.distro not in distros or provider in found:
            continue
        first, *others = calls
        related = tuple(Related("also here", call.place) for call in others[:_MOST_RELATED])
        yield Finding(
            f"{name}() is gone in {workspace.target.distro}; use target_link_libraries() with p::p, or ${{p_TARGETS}}",
            first.place,
            name,
            related,
            confidence=Confidence.HIGH if workspace.target.told else Confidence.MEDIUM,
        )


RULE = Rule(
    name="removed-command",
    code="ROS308",
    summary="a command must exist in the distribution",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    package=check,
)
