"""
## What it finds

Uses of what the distribution has removed:

- the CMake command `ament_target_dependencies()`, removed in Lyrical and Rolling;
- the modules of `ament_python`, removed in Bouncy, that `setup.py` imports.

## Why it matters

The build stops: "Unknown CMake command "ament_target_dependencies"", or "No module named 'ament_python'".

## How to fix it

For `ament_target_dependencies()`, link to targets: `target_link_libraries(t PUBLIC rclcpp::rclcpp ${std_msgs_TARGETS})`. As an
interim solution, the package `ament_cmake_target_dependencies` still provides the command: find it and declare it as
`<buildtool_depend>`.

The fix links to `${p_TARGETS}`, as the command did, if all calls name every package literally and each package is known to
export targets.

For `ament_python`, list the files in `data_files`, and set the folder of programs with `[install] install_scripts` in
`setup.cfg`.

## Limitations

Not reported:

- `ament_target_dependencies()` in other distributions.
- Packages that find `ament_cmake_target_dependencies` or define the command themselves.
- Calls under a condition, and imports guarded by `try`.
- `ament_python`, if it is a package of the workspace.

If the distribution is not set, the confidence of a removed CMake command is medium.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Confidence, Finding, Fix, Package, Related, Rule, Severity, Workspace, dependencies, edits, first_related

_REMOVED = {"ament_target_dependencies": ("ament_cmake_target_dependencies", frozenset({"lyrical", "rolling"}))}
_MODULE = "ament_python"


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    if package.builds_with == "ament_cmake":
        yield from _commands(package, workspace)
    elif package.builds_with == "ament_python":
        yield from _modules(package, workspace)


def _modules(package: Package, workspace: Workspace) -> Iterator[Finding]:
    imports = [mention for mention in package.built.mentions if mention.via == "import"]
    removed = [mention for mention in imports if mention.name.partition(".")[0] == _MODULE and not mention.optional]
    if removed and not any(other.name == _MODULE for other in workspace.packages):
        first, *others = removed
        yield Finding(
            f"'{_MODULE}' was removed in Bouncy, so setup.py stops here; list data_files and set install_scripts in setup.cfg",
            first.span,
            _MODULE,
            first_related(Related("also here", mention.span) for mention in others),
        )


def _commands(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None:
        return
    found = dependencies.names_searched(package, script)
    for name, (provider, distros) in _REMOVED.items():
        calls = [call for call in package.calls(name, anywhere=True) if not call.blocks or call.test]
        if not calls or workspace.target.distro not in distros or provider in found:
            continue
        first, *others = calls
        related = first_related(Related("also here", call.name_span) for call in others)
        yield Finding(
            f"{name}() was removed in {workspace.target.distro}; use target_link_libraries() with targets such as rclcpp::rclcpp",
            first.name_span,
            name,
            related,
            Fix.of(edits.cmake.LINKED, *edits.cmake.link_to_targets(calls, workspace), safe=False),
            Confidence.HIGH if workspace.target.explicit else Confidence.MEDIUM,
        )


RULE = Rule(
    name="removed-command",
    code="ROS308",
    summary="build scripts use commands and modules that exist in the distribution",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
