"""
## What it finds

A `glob()` in the `data_files` of `setup.py` that matches no file.

## Why it matters

Nothing is installed and nothing is said: `glob('launch/*.launch.py')` passes over `robot_launch.py`.

## How to fix it

Correct the pattern, or remove the entry. `glob(os.path.join('launch', '*launch.[pxy][yma]*'))` takes all launch files, those
that are called `a.launch.py` as well as `a_launch.py`; the fix writes this where launch files are passed over.

## Limitations

Where the pattern cannot be evaluated, where several globs are added up, and where git ignores what the pattern names: such
files are made or fetched. That there is nothing yet in the folder, but for a `.gitkeep`, is said with little certainty; so is
it where all that is in the folder is installed by other patterns: then this one provides for files of another kind.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ros_lint.api import Confidence, Edit, Finding, Fix, Package, Rule, Severity, Workspace


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with != "ament_python":
        return
    kept = script.installed
    for problem in script.problems:
        if problem.kind == "empty-glob" and not workspace.is_made(package, problem.subject):
            folder = _folder(problem.subject)
            passed_over = any(file not in kept and _is_in(file, folder) for file in package.files) if folder else True
            # A pattern for what may come is a template for the future; files that are passed over are a mistake.
            yield Finding(
                problem.message,
                problem.span,
                problem.subject,
                confidence=Confidence.HIGH if passed_over else Confidence.MEDIUM,
                severity=None if passed_over else Severity.INFO,
                fix=_fix(package, problem.subject),
            )


def _is_in(file: str, folder: str) -> bool:
    """Whether a file lies below a folder, and not only to have git keep the folder."""
    return file.startswith(f"{folder}/") and not file.rpartition("/")[2].startswith(".")


_LAUNCH = re.compile(r"launch\.(?:[pxy][yma]\w*)\Z")


def _fix(package: Package, pattern: str) -> Fix | None:
    """Write a pattern that takes the files of the folder: launch files of any name, or the other ending of YAML."""
    script = package.script
    folder, _, name = pattern.rpartition("/")
    if script is None or not folder or _folder(pattern) != folder:
        return None
    names = [file.rpartition("/")[2] for file in package.files if file.rpartition("/")[0] == folder]
    other = ""
    if "launch" in name and any(_LAUNCH.search(file) for file in names):
        other = "*launch.[pxy][yma]*"
    elif name in _YAML and any(file.endswith(_YAML[name][1:]) for file in names):
        other = _YAML[name]
    places = [text for text in script.texts if text.kind == "glob" and pattern.endswith(text.text) and text.text.endswith(name)]
    if not other or len(places) != 1:
        return None
    span = places[0].span
    return Fix(f"write {folder}/{other}", (Edit(span._replace(column=span.end_column - len(name)), other),), safe=False)


_YAML = {"*.yaml": "*.yml", "*.yml": "*.yaml"}


def _folder(pattern: str) -> str:
    """Return the folders that a pattern names before its first wildcard."""
    parts = pattern.split("/")[:-1]
    fixed = [part for part in parts if not re.search(r"[*?\[]", part)]
    return "/".join(fixed) if fixed == parts else ""


RULE = Rule(
    name="empty-glob",
    code="ROS410",
    summary="a glob in data_files must match something",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
