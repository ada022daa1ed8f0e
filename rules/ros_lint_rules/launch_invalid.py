"""
## What it finds

A launch file that the launch front end rejects:

- It does not parse.
- It has a tag, attribute or substitution that does not exist or has a value of the wrong type, or it lacks a required one.
- A Python launch file passes unknown or removed keywords to a node, argument or other class of the launch libraries, or passes
  a value without the required keyword.
- A Python launch file omits a required keyword, such as `executable=` of a node.
- A Python launch file uses a name that is not defined, or imports a name that the module does not have.
- It passes a file in XML to `PythonLaunchDescriptionSource`.
- It uses something that was added to the launch format, or to Python, after the chosen distribution.
- A Python launch file adds a substitution to a string, or passes it where Python requires a string.
- It divides a string by a string: `get_package_share_directory('p') / 'config'`.
- It passes a function, a substitution or a boolean as a condition: `condition=lambda context: ...`.
- It passes numbers, booleans or actions where strings are required: `default_value=True`, `LaunchConfiguration(argument)`.
- It passes `launch_arguments` without `.items()`, `parameters` without a list, or an integer as the period of a timer.
- `generate_launch_description()` returns nothing, or a method of the launch description is misspelt.
- A condition is a text that is neither true nor false: `IfCondition('maybe')`. A parameter is an empty list.

One rule reports all of them, because one mistake is enough for `ros2 launch` to stop before it starts anything.

## Why it matters

`ros2 launch` stops at the first of these, also for launch files that include the file. A file half ported from ROS 1 fails this
way: `$(find p)` is `$(find-pkg-share p)`, `$(arg x)` is `$(var x)`, `type=` of a node is `exec=`.

## How to fix it

The message names the problem. See the launch format of your distribution for tags and attributes. If the only problem of a
Python launch file is keywords that were renamed in Galactic, such as `node_executable`, the fix renames them.

## Limitations

Not reported:

- Launch files of ROS 1, and files of another program whose nodes have neither package nor executable.
- Tags that packages add to the format.
- Launch files of tests, examples and templates.
- Removed keywords below a condition that names a distribution before Galactic, as `distro == 'foxy'`.
- Additions to the format, if no distribution was chosen.
- Substitutions treated as strings, or numbers passed as strings, in code that catches errors or only prints, such as `print()`.

The confidence is medium for removed keywords in a launch file named after a distribution that has them (`dashing_start.py`).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

from ros_lint.api import (
    Confidence,
    Edit,
    Finding,
    Fix,
    Package,
    Problem,
    Related,
    Rule,
    Severity,
    TargetDistro,
    Workspace,
    first_related,
    launch,
    too_new,
)

_FOR_OLD = re.compile(r"(?:^|[_.-])(?:crystal|dashing|el[eo]quent|foxy)(?:[_.-]|$)")
"""Pattern of launch file names with a distribution before Galactic, which still has the keywords that Galactic removed."""
_MAY_BE_NEWER = frozenset({"unknown-tag", "unexpected-attribute", "unexpected-child", "unexpected-keyword"})


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    for launch_file in launch.package_launch_files(package):
        newer = (
            *_newer(launch_file.file.version_problems, workspace.target),
            *too_new(launch_file.file.syntax, workspace.target.chosen),
        )
        problems_here = launch.with_added_tags(launch_file.file, workspace).problems
        rejected = (problem for problem in problems_here if problem.kind not in launch.ACCEPTED_PROBLEMS)
        problems = (*rejected, *newer)
        if not problems:
            continue
        first, *others = sorted(problems, key=lambda problem: problem.span)
        yield Finding(
            _message(first),
            first.span,
            launch_file.path,
            first_related(Related(_also(first, other), other.span) for other in others),
            confidence=max(_confidence(problem, launch_file.path, workspace) for problem in problems),
            fix=_fix(launch_file.path, problems),
        )


def _fix(path: str, problems: Sequence[Problem]) -> Fix | None:
    """Return the fix that renames keywords that launch no longer has; None if the launch file has a problem of another kind."""
    if any(problem.kind != "removed-keyword" for problem in problems):
        return None
    edits = dict.fromkeys(Edit(problem.span, problem.subject) for problem in problems)
    keywords = ", ".join(f"{name}=" for name in dict.fromkeys(problem.subject for problem in problems))
    return Fix(f"replace the removed keywords by {keywords}", tuple(edits), safe=not _is_for_old(path))


def _is_for_old(path: str) -> bool:
    return _FOR_OLD.search(path.rpartition("/")[2]) is not None


def _newer(problems: Iterable[Problem], target: TargetDistro) -> Iterator[Problem]:
    """Yield a problem for each feature that a distribution after the chosen one added.

    Distributions are compared by the alphabet: a later distribution has a later initial letter.
    """
    if target.explicit and target.distro != "rolling":
        for problem in problems:
            if target.distro < problem.kind:
                message = f"{target.distro} has no {problem.message}; it was added in {problem.kind}"
                yield problem._replace(message=message)


def _also(first: Problem, other: Problem) -> str:
    """Return the message of a further problem, without the advice if the message of the finding has the same advice."""
    return _message(other).partition("; ")[0] if _message(other) == _message(first) else _message(other)


def _message(problem: Problem) -> str:
    if problem.instead:
        return f"{problem.message}; ROS 2 uses {problem.instead}"
    remedy = "" if any(mark in problem.message for mark in ";?") else _REMEDIES.get(problem.kind, "")
    return f"{problem.message}{remedy}"


_REMEDIES = {
    "conditions": "; keep only one of them",
    "missing-argument": "; add it",
    "missing-attribute": "; add it",
    "missing-child": "; add one",
    "quotes": "; close it",
    "too-many-arguments": "; pass the other values as keyword arguments",
    "undefined-name": "; define or import it",
    "unexpected-attribute": "; correct or remove it",
    "unexpected-child": "; move or remove it",
    "unexpected-keyword": "; correct or remove it",
    "unknown-substitution": "; correct the name",
    "unknown-tag": "; correct the name, or remove it",
    "wrong-type": "; correct the value",
}
"""Remedies for problems whose message contains none, by the kind of the problem."""


def _confidence(problem: Problem, path: str, workspace: Workspace) -> Confidence:
    if problem.kind == "removed-keyword" and _is_for_old(path):
        return Confidence.MEDIUM
    # A package or a newer release may have added what is unknown here.
    if problem.instead or problem.kind not in _MAY_BE_NEWER:
        return Confidence.HIGH
    anywhere = problem.kind in ("unknown-tag", "unexpected-keyword")
    return Confidence.MEDIUM if workspace.target.distro == "rolling" or anywhere else Confidence.HIGH


RULE = Rule(
    name="launch-invalid",
    code="ROS506",
    summary="launch files are valid for ros2 launch",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
