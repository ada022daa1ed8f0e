"""
## What it finds

A launch file that the real front end refuses: it does not parse, has a tag, an attribute or a substitution that does not
exist, misses one that is needed, or holds a value of another type; one in Python that gives a node, an argument or another
thing of the launch libraries keywords which do not exist or were removed, or something without its keyword, comes to a name
that nothing defines, or takes one from a module that has none; one that gives `PythonLaunchDescriptionSource` a file in XML;
or one with something that came to the launch format, or to Python, after the distribution that was asked for.

Also one with a path that begins right behind the share folder of a package, `[FindPackageShare('robot'), 'config', 'a.yaml']`
where nothing joins the parts: that is `.../share/robotconfiga.yaml`; or with one that is joined with a slash in front,
`os.path.join(share, '/config/a.yaml')`: that is `/config/a.yaml`, and the share folder is forgotten.

Besides, one in Python that takes a substitution for the text that it becomes once something is launched: adds it to a text,
formats, compares or tests it; that joins conditions by `and` and `or`, or gives a function, a substitution or a truth for one,
`condition=lambda context: ...`; or that gives numbers, truths and actions where texts are taken, `default_value=True`,
`LaunchConfiguration(argument)`, and `launch_arguments` without `.items()`.

## Why it matters

`ros2 launch` stops with the first of these, and whoever includes the file stops with it. A file half ported from ROS 1
fails this way: `$(find p)` is `$(find-pkg-share p)`, `$(arg x)` is `$(var x)`, `type=` of a node is `exec=`.
`'robot_' + LaunchConfiguration('name')` is an error, too; in an f-string stands `<launch.substitutions... object at 0x7f...>`,
and `LaunchConfiguration('mode') == 'real'` is never true, both without a word: where a file has nothing worse, that is a
warning.

## How to fix it

The message names what is wrong. See the launch format of your distribution for tags and attributes. Where a Python launch
file has nothing worse than keywords that have another name since Galactic, such as `node_executable`, the fix renames them.

## Limitations

- Launch files of ROS 1 as a whole, and files of another program whose nodes have neither package nor program.
- Tags that packages add to the format.
- Launch files of tests, examples and templates.
- A launch file that is called after a distribution which takes the removed keywords (`dashing_start.py`) is kept for that:
  the confidence is medium.
- What is newer than the distribution, where nobody said which one is meant.
- A substitution is taken for a text, or a number given for one, where errors are caught, or only in what people read, such as
  `print()`. A substitution is tested in a function that it was given to: that may ask whether it is there at all.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

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
    Target,
    Workspace,
    launchable,
    several,
    too_new,
)

_FOR_OLD = re.compile(r"(?:^|[_.-])(?:crystal|dashing|el[eo]quent|foxy)(?:[_.-]|$)")
"""In the name of a launch file: distributions that take the keywords which are gone since Galactic."""
_MAY_BE_NEWER = frozenset({"unknown-tag", "unexpected-attribute", "unexpected-child", "unexpected-keyword"})


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    for launch in launchable(package):
        newer = (*_newer(launch.file.newer, workspace.target), *too_new(launch.file.syntax, workspace.target))
        problems = (*launch.file.problems, *newer)
        if not problems:
            continue
        first, *others = sorted(problems, key=lambda problem: problem.span)
        yield Finding(
            _message(first),
            first.span,
            launch.path,
            several(Related(_also(first, other), other.span) for other in others),
            confidence=max(_confidence(problem, launch.path, workspace) for problem in problems),
            severity=Severity.WARNING if all(problem.kind == "substitution-as-text" for problem in problems) else None,
            fix=_fix(launch.path, problems),
        )


def _fix(path: str, problems: Iterable[Problem]) -> Fix | None:
    """Return how to give keywords their new names, where a file has no other problem."""
    if any(problem.kind != "removed-keyword" for problem in problems):
        return None
    edits = dict.fromkeys(Edit(problem.span, problem.subject) for problem in problems)
    return Fix("write the keywords that are there now", tuple(edits), safe=not _is_for_old(path))


def _is_for_old(path: str) -> bool:
    return _FOR_OLD.search(path.rpartition("/")[2]) is not None


def _newer(problems: Iterable[Problem], target: Target) -> Iterator[Problem]:
    """Yield what came after the distribution that was asked for; their names go with the alphabet."""
    if target.told and target.distro != "rolling":
        for problem in problems:
            if target.distro < problem.kind:
                message = f"{target.distro} has no {problem.message}: it came with {problem.kind}"
                yield problem._replace(message=message)


def _also(first: Problem, other: Problem) -> str:
    return "here, too" if _message(other) == _message(first) else _message(other)


def _message(problem: Problem) -> str:
    return f"{problem.message}; ROS 2 has {problem.instead}" if problem.instead else problem.message


def _confidence(problem: Problem, path: str, workspace: Workspace) -> Confidence:
    if problem.kind == "removed-keyword" and _is_for_old(path):
        return Confidence.MEDIUM
    # A package or a newer release may have added what is not known here.
    if problem.instead or problem.kind not in _MAY_BE_NEWER:
        return Confidence.HIGH
    anywhere = problem.kind in ("unknown-tag", "unexpected-keyword")
    return Confidence.MEDIUM if workspace.target.distro == "rolling" or anywhere else Confidence.HIGH


RULE = Rule(
    name="launch-invalid",
    code="ROS506",
    summary="a launch file must be one that ros2 launch takes",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
