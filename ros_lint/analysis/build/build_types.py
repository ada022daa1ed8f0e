"""The build types that package.xml files declare."""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.collectors.manifest import conditions
from ros_lint.facts.manifest import Element
from ros_lint.workspace.model import Package, Workspace


def build_types(workspace: Workspace) -> Iterator[tuple[Package, list[Element]]]:
    """Yield each package with its ``<build_type>`` elements. Elements with a condition that may be false are left out.

    Packages that colcon cannot use (``workspace.unusable``) are included, but not packages with errors in package.xml.
    """
    for package in (*workspace.packages, *workspace.unusable):
        if package.manifest and not package.manifest.problems:
            exports = (export for export in package.manifest.exports if export.tag == "build_type")
            yield package, [export for export in exports if conditions.truth(conditions.of(export), workspace.target.context)]
