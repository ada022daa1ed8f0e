"""The path patterns of the settings ``exclude`` and ``per-path-ignores``, and warnings about patterns without effect."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from ros_lint.base.paths import is_below_any, join

if TYPE_CHECKING:
    from ros_lint.cli.settings import Settings
    from ros_lint.workspace.model import Workspace


class Excluder:
    """A predicate for paths that match the patterns of ``exclude``. It records the patterns that matched a path."""

    def __init__(self, patterns: Sequence[str]) -> None:
        self.patterns = patterns
        self.matched: set[str] = set()

    def __call__(self, path: str) -> bool:
        if not self.patterns:
            return False
        from ros_lint.engine.selection import matches  # noqa: PLC0415

        matching = [pattern for pattern in self.patterns if matches(path, pattern)]
        self.matched.update(matching)
        return bool(matching)


def without_effect(
    settings: Settings, excluder: Excluder, base: str, roots: Sequence[str], workspace: Workspace
) -> Iterator[str]:
    """Yield a warning for each pattern that matches no package and no file of the loaded workspace.

    ``roots`` are the requested folders, relative to the absolute folder ``base``. Nothing is yielded for patterns in a
    configuration file if the run does not read the whole folder of the file.
    """

    def is_read(option: str) -> bool:
        path = os.path.relpath(settings.folder(option) or base, base).replace(os.sep, "/")
        return not path.startswith("..") and is_below_any("" if path == "." else path, roots)

    if is_read("exclude"):
        for pattern in settings["exclude"]:
            if pattern not in excluder.matched:
                yield f"{settings.place('exclude', pattern)}: exclude: the pattern '{pattern}' matches no file"
    ignores = settings["per-path-ignores"]
    if not ignores or not is_read("per-path-ignores"):
        return
    from ros_lint.engine.selection import matches  # noqa: PLC0415

    files = [join(package.path, file) for package in workspace.packages for file in package.files]
    files += [package.manifest.path for package in workspace.unusable if package.manifest]
    for pattern in ignores:
        if not any(matches(path, pattern) for path in files):
            yield f"{settings.place('per-path-ignores', pattern)}: per-path-ignores: the pattern '{pattern}' matches no file"
