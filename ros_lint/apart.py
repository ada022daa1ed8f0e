"""Files that are beside the point: tests, examples, templates."""

from __future__ import annotations

_TESTS = frozenset({"test", "tests", "testing", "integration_tests", "benchmark", "benchmarks", "unit_tests"})
_APART = frozenset({"example", "examples", "template", "templates", "doc", "docs"})


def is_apart(path: str) -> bool:
    """Return whether a file serves tests, shows something, or is to be filled in, by its path."""
    *folders, name = path.split("/")
    folder_names = frozenset(folders)
    if not _TESTS.isdisjoint(folder_names) or not _APART.isdisjoint(folder_names):
        return True
    return name.startswith("test_") or "_test." in name or ".test." in name or "{" in path
