"""Recognize auxiliary files: tests, examples, templates and discarded files."""

from __future__ import annotations

import re

TEST_FOLDERS = frozenset(
    {"test", "tests", "testing", "integration_tests", "benchmark", "benchmarks", "unit_tests", "test_data", "testdata",
     "test_resources"}
)  # fmt: skip
EDITORS_COPIES = frozenset({".ipynb_checkpoints"})
"""Folders in which editors keep copies."""
_PUT_ASIDE = frozenset({"attic", "backup", "backups", "deprecated", "legacy", "obsolete", "old", "unused"}) | EDITORS_COPIES
_APART = frozenset({"example", "examples", "sample", "samples", "template", "templates", "doc", "docs"}) | _PUT_ASIDE
_COPY = re.compile(r" (?:copy(?: \d+)?|\((?:\d+|(?:another |\d+\w\w )?copy)\))\.\w+\Z")
"""Suffix that editors and file managers add to the name of a copy."""
_KEPT = re.compile(r"[ _.-](?:backup|bak|old)\d*(?:(?:[ _.-]v?|v)\d+)*(?:\.launch)?\.\w+\Z")
"""Suffix that users add to the name of an old version."""

_OF_TESTS = re.compile(r"(?:^|_)(?:tests?|testing)(?:_|$)")


def is_for_tests(package: str) -> bool:
    """Return whether the name of a package shows that all of it serves tests."""
    return _OF_TESTS.search(package) is not None


def is_auxiliary(path: str) -> bool:
    """Return whether a file is a test, an example, a template or a discarded file, by its path."""
    name = path.rpartition("/")[2]
    of_tests = name.startswith("test_") or "_test." in name or ".test." in name
    return of_tests or in_auxiliary_folder(path) or is_backup_copy(path) or _KEPT.search(name) is not None


def is_backup_copy(path: str) -> bool:
    """Return whether a file is a copy made by an editor or a file manager, by its name."""
    return " " in path and _COPY.search(path) is not None


def in_auxiliary_folder(path: str) -> bool:
    """Return whether a file is in an auxiliary folder.

    The file name is ignored because files named like tests are often started by hand.
    """
    folders = path.split("/")[:-1]
    return not (TEST_FOLDERS.isdisjoint(folders) and _APART.isdisjoint(folders)) or "{" in path
