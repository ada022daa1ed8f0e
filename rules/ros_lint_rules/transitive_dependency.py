"""
## What it finds

A package that is used directly and comes along only because something else that is declared needs it. The message
names the way by which it comes.

## Why it matters

It works until the package in between drops the dependency, which its authors may do at any time, for what they need is
their business. Then this package breaks, without any change of its own.

## How to fix it

Declare what is used, in the tag that the message names. The fix does this. It is unsafe where the message says that not every
distribution has the name.

## Limitations

- It is off unless asked for: most of ROS relies on what other packages bring along, such as `rclcpp` on `rcl`.
- The files that use it are perhaps not built or installed, or colcon rejects `package.xml`: then the confidence is
  medium. The use is optional: then it is low, and nothing is fixed.
- The package needs this one itself, in whatever tag, so that declaring it would close a cycle that colcon refuses: then, too,
  the confidence is medium, and nothing is fixed, and of an optional use nothing is said. Nor is it fixed where no key resolves
  for the distribution.
- The package merely gives CMake commands, and comes along with the build tool, or it is `action_msgs` and nothing but the
  code that is generated for actions needs it.
- It is part of what launches, nothing but launch files import it, and `ros2launch` is declared for them.
- CMake finds it, and no code uses it: `unused-find-package` says so.
- It is declared by a name that does not exist, and must be meant by it: `unknown-dependency` says so.
- A vendor package is declared, or a key for the whole of a library that the package uses a part of.
- Nothing declared brings it along: that is `undeclared-dependency` or `launch-outside-closure`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ros_lint.api import (
    Confidence,
    Finding,
    Need,
    Package,
    Related,
    Rule,
    Severity,
    Workspace,
    advice,
    comes_with_launching,
    found_for_nothing,
    meant,
    needs,
    several,
    tells,
    wishes,
)

_LAUNCHER = "ros2launch"


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    if not tells(package):
        return
    declared = tuple(dict.fromkeys(declared.name for declared in package.declared))
    idle = {mention.name for mention in found_for_nothing(package, workspace)}
    otherwise = meant(package, workspace)
    for need in needs(package, workspace):
        if need.declared or not need.brought or need.name in idle or _is_command(need):
            continue
        if any(otherwise.intersection(use.providers) for use in need.uses):
            continue
        if not (_LAUNCHER in declared and comes_with_launching(package, need.uses)):
            yield _finding(package, workspace, declared, need, Confidence.HIGH if need.sure else Confidence.MEDIUM)
    for wish in wishes(package, workspace):
        if wish.brought and not _is_command(wish):
            yield _finding(package, workspace, declared, wish, Confidence.LOW)._replace(fix=None)


def _is_command(need: Need) -> bool:
    return all(use.via == "macro" for use in need.uses)


def _finding(package: Package, workspace: Workspace, declared: Sequence[str], need: Need, confidence: Confidence) -> Finding:
    """Return what is to say of a need. A manifest that colcon rejects has to be mended first: then nothing is certain."""
    best, *others = need.uses
    ways = (workspace.world.path(declared, name) for name in best.providers)
    way = next((way for way in ways if way), (need.name,))
    name = way[-1]
    way_out = advice(package, workspace, name, need.role)
    return Finding(
        f"{name} is used here, but comes along only by way of {' > '.join(way[:-1])}{way_out.ending}",
        best.span,
        name,
        several(Related(f"also used here: {use.what}", use.span) for use in others),
        way_out.fix,
        confidence if way_out.certain else min(confidence, Confidence.MEDIUM),
    )


RULE = Rule(
    name="transitive-dependency",
    code="ROS202",
    summary="what is used directly should be declared, and not merely come along",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    default=False,
    fixable=True,
    package=check,
)
