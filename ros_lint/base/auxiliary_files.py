"""Recognize auxiliary files: tests, examples, templates and discarded files."""

from __future__ import annotations

import re

TEST_FOLDERS = frozenset(
    {"test", "tests", "testing", "integration_tests", "benchmark", "benchmarks", "unit_tests", "test_data", "testdata",
     "test_resources"}
)  # fmt: skip
THIRD_PARTY_FOLDERS = frozenset({"3rd_party", "3rdparty", "extern", "external", "externals", "third_party", "thirdparty"})
"""Names of folders for third-party code."""
EDITOR_COPY_FOLDERS = frozenset({".ipynb_checkpoints"})
"""Names of folders in which editors keep copies of files."""
_DISCARDED_FOLDERS = frozenset({"attic", "backup", "backups", "deprecated", "legacy", "obsolete", "old", "unused"})
_EXAMPLE_FOLDERS = frozenset({"example", "examples", "sample", "samples", "template", "templates", "doc", "docs"})
_AUXILIARY_FOLDERS = _EXAMPLE_FOLDERS | _DISCARDED_FOLDERS | EDITOR_COPY_FOLDERS
_COPY_SUFFIX = re.compile(r" (?:copy(?: \d+)?|\((?:\d+|(?:another |\d+\w\w )?copy)\))\.\w+\Z")
"""Pattern of the end of a file name that an editor or a file manager gives to a copy, e.g. " (copy).py"."""
_OLD_VERSION_SUFFIX = re.compile(r"[ _.-](?:backup|bak|old)\d*(?:(?:[ _.-]v?|v)\d+)*(?:\.launch)?\.\w+\Z")
"""Pattern of the end of a file name that a user gives to an old version, e.g. "_old.py"."""

_TEST_WORD = re.compile(r"(?:^|_)(?:tests?|testing)(?:_|$)")


def is_for_tests(package: str) -> bool:
    """Return whether a package serves tests only, because its name has the word "test", "tests" or "testing"."""
    return _TEST_WORD.search(package) is not None


def is_auxiliary(path: str) -> bool:
    """Return whether the path of a file shows that it is a test, an example, a template or a discarded file."""
    name = path.rpartition("/")[2]
    is_test = name.startswith("test_") or "_test." in name or ".test." in name
    return is_test or in_auxiliary_folder(path) or is_backup_copy(path) or _OLD_VERSION_SUFFIX.search(name) is not None


def is_backup_copy(path: str) -> bool:
    """Return whether the name of a file shows that an editor or a file manager made it as a copy: "a (copy).py"."""
    return " " in path and _COPY_SUFFIX.search(path) is not None


def in_auxiliary_folder(path: str) -> bool:
    """Return whether a file is in a folder for tests, examples, templates or discarded files.

    Only the folders of the path count, because a file with a name such as ``test_arm.launch.py`` is often started by
    hand. A path with "{" also counts, because it is the path of a template.
    """
    folders = path.split("/")[:-1]
    return not (TEST_FOLDERS.isdisjoint(folders) and _AUXILIARY_FOLDERS.isdisjoint(folders)) or "{" in path
