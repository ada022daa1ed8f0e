"""Files that are beside the point: tests, examples, templates, and what is put aside."""

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
"""What editors and file managers call the copy of a file."""
_KEPT = re.compile(r"[ _.-](?:backup|bak|old)\d*(?:(?:[ _.-]v?|v)\d+)*(?:\.launch)?\.\w+\Z")
"""What people call a file that they keep."""

_OF_TESTS = re.compile(r"(?:^|_)(?:tests?|testing)(?:_|$)")


def is_for_tests(package: str) -> bool:
    """Return whether a package is called so that all of it serves tests."""
    return _OF_TESTS.search(package) is not None


def is_auxiliary(path: str) -> bool:
    """Return whether a file serves tests, shows something, is to be filled in, or kept for later, by its path."""
    name = path.rpartition("/")[2]
    of_tests = name.startswith("test_") or "_test." in name or ".test." in name
    return of_tests or in_auxiliary_folder(path) or is_backup_copy(path) or _KEPT.search(name) is not None


def is_backup_copy(path: str) -> bool:
    """Return whether a file is one that an editor or a file manager has copied, by its name: nobody is to start it."""
    return " " in path and _COPY.search(path) is not None


def in_auxiliary_folder(path: str) -> bool:
    """Return the same by the folders alone: what is merely called a test is often one that people start by hand."""
    folders = path.split("/")[:-1]
    return not (TEST_FOLDERS.isdisjoint(folders) and _APART.isdisjoint(folders)) or "{" in path
