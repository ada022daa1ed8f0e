"""
## What it finds

A package that is used directly but not declared: it is only available because a declared dependency depends on it. The message
names the path of dependencies.

## Why it matters

It works until the package in between drops the dependency, which its authors may do at any time. Then this package breaks
without any change of its own.

## How to fix it

Declare the used package with the tag that the message names. The fix adds the tag. It is unsafe if the message says that some
distributions do not have the package.

## Limitations

The rule is off by default, because most ROS packages rely on transitive dependencies, such as `rclcpp` on `rcl`.

Not reported:

- Packages that only provide CMake commands, if they come with the build tool.
- `action_msgs`, if only the code that is generated for actions needs it.
- Parts of launch that only launch files import, if `ros2launch` is declared.
- Packages that CMake finds but no code uses: see `unused-find-package`.
- Packages for which `package.xml` declares a wrong name: see `unknown-dependency`.
- A library of a declared vendor package, or of a declared key that stands for the whole library.
- Packages that no declared dependency provides: see `undeclared-dependency` and `launch-outside-closure`.
- Optional uses of a package that depends on this one.

Reported with medium confidence:

- All files that use the package may not be built or installed, or colcon rejects `package.xml`.
- The package depends on this one, with any tag, so declaring it would close a cycle that colcon rejects. There is no fix.

Optional uses are reported with low confidence and without a fix. There is also no fix if no rosdep key resolves for the
distribution.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ros_lint.api import Confidence, Finding, Package, Related, Rule, Severity, Workspace, dependencies, first_related

_LAUNCHER = "ros2launch"


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    if not dependencies.manifest_is_complete(package):
        return
    declared = tuple(dict.fromkeys(declared.name for declared in package.declared))
    unused = {mention.name for mention in dependencies.unused_find_packages(package, workspace)}
    misnamed = dependencies.intended_names(package, workspace)
    for need in dependencies.needs(package, workspace):
        if need.declared or not need.brought or need.name in unused or _is_command(need):
            continue
        if any(misnamed.intersection(use.providers) for use in need.uses):
            continue
        if not (_LAUNCHER in declared and dependencies.is_part_of_launch(package, need.uses)):
            yield _finding(package, workspace, declared, need, Confidence.HIGH if need.sure else Confidence.MEDIUM)
    for wish in dependencies.optional_needs(package, workspace):
        if wish.brought and not _is_command(wish):
            yield _finding(package, workspace, declared, wish, Confidence.LOW)._replace(fix=None)


def _is_command(need: dependencies.Need) -> bool:
    return all(use.via == "macro" for use in need.uses)


def _finding(
    package: Package, workspace: Workspace, declared: Sequence[str], need: dependencies.Need, confidence: Confidence
) -> Finding:
    """Return the finding for a need. The confidence is at most medium if colcon rejects the manifest, or for a cycle."""
    best, *others = need.uses
    paths = (workspace.world.path(declared, name) for name in best.providers)
    path = next((path for path in paths if path), (need.name,))
    name = path[-1]
    between = " > ".join(f"'{package_between}'" for package_between in path[:-1])
    proposal = dependencies.remedy(package, workspace, name, need.role)
    return Finding(
        f"'{name}' is used here, but is only available through {between}{proposal.ending}",
        best.span,
        name,
        first_related(Related(f"also used here: {use.what}", use.span) for use in others),
        proposal.fix,
        confidence if proposal.certain else min(confidence, Confidence.MEDIUM),
    )


RULE = Rule(
    name="transitive-dependency",
    code="ROS202",
    summary="packages declare all dependencies that they use directly",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    default=False,
    fixable=True,
    package=check,
)
