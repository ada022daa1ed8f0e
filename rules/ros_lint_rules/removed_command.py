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

If the distribution is not set, one info for the workspace names the packages that call a removed CMake command. It is not
reported if the repository names only distributions that have the command, or if a file cannot be read.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from ros_lint.api import Call, Finding, Fix, Package, Related, Rule, Severity, Workspace, dependencies, edits, first_related

_REMOVED = {"ament_target_dependencies": ("ament_cmake_target_dependencies", frozenset({"lyrical", "rolling"}))}
_MODULE = "ament_python"


def check(workspace: Workspace) -> Iterator[Finding]:
    for package in workspace.packages:
        if package.builds_with == "ament_python":
            yield from _modules(package, workspace)
    for name, (provider, distros) in _REMOVED.items():
        if workspace.target.distro in distros:
            packages = [package for package in workspace.packages if package.builds_with == "ament_cmake"]
            callers = [(package, calls) for package in packages if (calls := _unprovided_calls(package, name, provider))]
            yield from _commands(name, callers, workspace) if workspace.target.explicit else _if_newer(name, callers, workspace)


def _modules(package: Package, workspace: Workspace) -> Iterator[Finding]:
    imports = [mention for mention in package.built.mentions if mention.via == "import"]
    removed = [mention for mention in imports if mention.name.partition(".")[0] == _MODULE and not mention.optional]
    if removed and not any(other.name == _MODULE for other in workspace.packages):
        first, *others = removed
        yield Finding(
            f"'{_MODULE}' was removed in Bouncy, so setup.py stops here; list data_files and set install_scripts in setup.cfg",
            first.span,
            _MODULE,
            first_related(Related(f"'{_MODULE}' is also imported here", mention.span) for mention in others),
            package=package.name,
        )


def _unprovided_calls(package: Package, name: str, provider: str) -> list[Call]:
    """Return the unconditional calls of a CMake command; none if the package finds ``provider``, which defines the command."""
    if package.script is None or provider in dependencies.names_searched(package, package.script):
        return []
    return [call for call in package.calls(name, anywhere=True) if not call.blocks or call.test]


def _commands(name: str, callers: Iterable[tuple[Package, list[Call]]], workspace: Workspace) -> Iterator[Finding]:
    """Yield an error for each package that calls a command which the distribution chosen by the user does not have."""
    for package, calls in callers:
        first, *others = calls
        yield Finding(
            f"{name}() was removed in {workspace.target.distro}; use target_link_libraries() with targets such as rclcpp::rclcpp",
            first.name_span,
            name,
            first_related(Related(f"{name}() is also called here", call.name_span) for call in others),
            Fix.of(edits.cmake.LINKED, *edits.cmake.link_to_targets(calls, workspace), safe=False),
            package=package.name,
        )


def _if_newer(name: str, callers: Sequence[tuple[Package, list[Call]]], workspace: Workspace) -> Iterator[Finding]:
    """Yield one info about all packages that call a command which the distribution does not have.

    The user has not chosen the distribution, so the packages may be built for an older one.
    """
    named = {named.distro for named in workspace.named_distros}
    if not callers or workspace.unread() or (named and not named & _REMOVED[name][1]):
        return
    (first, calls), *others = callers
    subject = f"'{first.name}' calls" if not others else f"{len(callers)} packages call"
    yield Finding(
        f"{subject} {name}(), which was removed in {workspace.target.distro}; use target_link_libraries() with targets such as "
        "rclcpp::rclcpp, or pass --distro if you build for an older distribution",
        calls[0].name_span,
        name,
        first_related(Related(f"'{package.name}' calls {name}() here", calls[0].name_span) for package, calls in others),
        severity=Severity.INFO,
        package=first.name,
    )


RULE = Rule(
    name="removed-command",
    code="ROS308",
    summary="build scripts use commands and modules that exist in the distribution",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    workspace=check,
)
