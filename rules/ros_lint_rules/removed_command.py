"""
## What it finds

What the distribution has no more: the CMake command `ament_target_dependencies()` in Lyrical and Rolling, and the modules of
`ament_python`, which `setup.py` imported before Bouncy.

## Why it matters

The build stops: "Unknown CMake command "ament_target_dependencies"", or "No module named 'ament_python'".

## How to fix it

For `ament_python`: write `data_files` out, and let `[install] install_scripts` of `setup.cfg` say where programs go. Otherwise
link to targets: `target_link_libraries(t PUBLIC rclcpp::rclcpp ${std_msgs_TARGETS})`. For the time being, the package
`ament_cmake_target_dependencies` brings the command back: find it and declare it as `<buildtool_depend>`.

The fix links to `${p_TARGETS}`, as the command did, where each package is named in all calls and is known to export targets.

## Limitations

In other distributions; where that package is found, or the command is defined in the package itself; under conditions, and
for imports that `try` guards. The confidence is medium where nobody said which distribution is meant.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import (
    Confidence,
    Finding,
    Fix,
    Package,
    Related,
    Rule,
    Severity,
    Workspace,
    called,
    cmake_edits,
    found_names,
    several,
)

_GONE = {"ament_target_dependencies": ("ament_cmake_target_dependencies", frozenset({"lyrical", "rolling"}))}
_MODULE = "ament_python"


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    if package.builds_with == "ament_cmake":
        yield from _commands(package, workspace)
    elif package.builds_with == "ament_python":
        yield from _modules(package, workspace)


def _modules(package: Package, workspace: Workspace) -> Iterator[Finding]:
    imports = [mention for mention in package.built.mentions if mention.via == "import"]
    gone = [mention for mention in imports if mention.name.partition(".")[0] == _MODULE and not mention.optional]
    if gone and not any(other.name == _MODULE for other in workspace.packages):
        first, *others = gone
        yield Finding(
            f"{_MODULE} is gone since Bouncy, so setup.py stops here; write data_files out, and install_scripts into setup.cfg",
            first.span,
            _MODULE,
            several(Related("also here", mention.span) for mention in others),
        )


def _commands(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None:
        return
    found = found_names(package, script)
    for name, (provider, distros) in _GONE.items():
        calls = [call for call in called(package, name, anywhere=True) if not call.blocks or call.test]
        if not calls or workspace.target.distro not in distros or provider in found:
            continue
        first, *others = calls
        related = several(Related("also here", call.place) for call in others)
        yield Finding(
            f"{name}() is gone in {workspace.target.distro}; use target_link_libraries() with p::p, or ${{p_TARGETS}}",
            first.place,
            name,
            related,
            Fix.of(cmake_edits.LINKED, *cmake_edits.link_to_targets(calls, workspace), safe=False),
            Confidence.HIGH if workspace.target.told else Confidence.MEDIUM,
        )


RULE = Rule(
    name="removed-command",
    code="ROS308",
    summary="what a build script calls must exist in the distribution",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
