"""
## What it finds

A `glob()` in the `data_files` of `setup.py` that matches no file.

## Why it matters

Nothing is installed, and setuptools reports no error: `glob('launch/*.launch.py')` does not match `robot_launch.py`.

## How to fix it

Correct the pattern, or remove the entry. `glob(os.path.join('launch', '*launch.[pxy][yma]*'))` matches all launch files, both
`a.launch.py` and `a_launch.py`. The fix writes this pattern for launch files, and `*.yml` instead of `*.yaml` (or the reverse)
if that matches a file.

## Limitations

Not reported:

- Patterns that cannot be evaluated, and lists that several calls of `glob()` form together (`glob(...) + glob(...)`).
- Patterns for files that git ignores: such files are generated or downloaded.

Reported with medium confidence:

- The folder is empty except for hidden files such as `.gitkeep`.
- Other patterns install all files of the folder: this pattern may be for future files of another kind.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ros_lint.api import Confidence, Edit, Finding, Fix, Package, Rule, Severity, Workspace


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with != "ament_python":
        return
    installed = script.products.installed
    for problem in script.problems:
        if problem.kind == "empty-glob" and not workspace.is_made(package, problem.subject):
            folder = _folder(problem.subject)
            skipped = any(file not in installed and _is_in(file, folder) for file in package.files) if folder else True
            # Files that no pattern installs show a mistake; without them, the pattern may be for future files.
            yield Finding(
                problem.message,
                problem.span,
                problem.subject,
                confidence=Confidence.HIGH if skipped else Confidence.MEDIUM,
                severity=None if skipped else Severity.INFO,
                fix=_fix(package, problem.subject),
            )


def _is_in(file: str, folder: str) -> bool:
    """Return whether a file is below a folder and is no hidden file such as .gitkeep."""
    return file.startswith(f"{folder}/") and not file.rpartition("/")[2].startswith(".")


_LAUNCH = re.compile(r"launch\.(?:[pxy][yma]\w*)\Z")


def _fix(package: Package, pattern: str) -> Fix | None:
    """Return the fix that replaces a pattern that matches no file by a pattern that matches files.

    The new pattern is ``*launch.[pxy][yma]*`` for launch files, and ``*.yml`` for ``*.yaml`` or the reverse. The result is None
    if no file matches the new pattern, or the old pattern is not written in exactly one place.
    """
    script = package.script
    folder, _, name = pattern.rpartition("/")
    if script is None or not folder or _folder(pattern) != folder:
        return None
    names = [file.rpartition("/")[2] for file in package.files if file.rpartition("/")[0] == folder]
    pattern_for_all = ""
    if "launch" in name and any(_LAUNCH.search(file) for file in names):
        pattern_for_all = "*launch.[pxy][yma]*"
    elif name in _YAML and any(file.endswith(_YAML[name][1:]) for file in names):
        pattern_for_all = _YAML[name]
    places = [
        text
        for text in script.python.editable_texts
        if text.kind == "glob" and pattern.endswith(text.text) and text.text.endswith(name)
    ]
    if not pattern_for_all or len(places) != 1:
        return None
    span = places[0].span
    edit = Edit(span._replace(column=span.end_column - len(name)), pattern_for_all)
    return Fix(f"write '{folder}/{pattern_for_all}'", (edit,), safe=False)


_YAML = {"*.yaml": "*.yml", "*.yml": "*.yaml"}


def _folder(pattern: str) -> str:
    """Return the folder of a pattern: ``launch`` for ``launch/*.py``; "" if the folder itself contains wildcards."""
    parts = pattern.split("/")[:-1]
    fixed = [part for part in parts if not re.search(r"[*?\[]", part)]
    return "/".join(fixed) if fixed == parts else ""


RULE = Rule(
    name="empty-glob",
    code="ROS410",
    summary="globs in data_files match at least one file",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
