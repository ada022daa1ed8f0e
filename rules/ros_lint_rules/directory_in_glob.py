"""
## What it finds

A folder among the files of `data_files`, usually because `glob('models/*')` matches it.

## Why it matters

setuptools copies only files. The build stops: `error: can't copy 'models/robot': doesn't exist or not a regular file`.

## How to fix it

Match only files: `glob('models/*.sdf')`. To install a whole tree, add an entry for each folder:

    for folder, _, files in os.walk('models'):
        data_files.append((os.path.join('share', package_name, folder), [os.path.join(folder, f) for f in files]))

## Limitations

Patterns and lists that cannot be evaluated are not reported.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Finding, Package, Rule, Severity, Workspace


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with != "ament_python":
        return
    reported: set[tuple[int, int]] = set()
    for problem in script.problems:
        at = problem.span[1:3]
        if problem.kind == "directory-in-data-files" and at not in reported:
            reported.add(at)
            yield Finding(problem.message, problem.span, problem.subject)


RULE = Rule(
    name="directory-in-glob",
    code="ROS411",
    summary="entries of data_files name files, not folders",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    package=check,
)
