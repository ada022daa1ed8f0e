"""The files of a package by their names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from ros_lint.analysis.memo import cached_by_package
from ros_lint.workspace.model import Package, Workspace


@cached_by_package
def files_by_name(package: Package, _workspace: Workspace) -> Mapping[str, Sequence[str]]:
    """Return the files of a package by the last component of their paths. The paths are relative to the package and sorted."""
    result: dict[str, list[str]] = {}
    for file in package.files:
        result.setdefault(file.rpartition("/")[2], []).append(file)
    return result
