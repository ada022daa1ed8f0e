"""Exports of plugin descriptions in package.xml, as pluginlib of ROS 1 reads them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ros_lint.facts.manifest import Element, Manifest

_PREFIX = "${prefix}/"


def plugin_exports(manifest: Manifest | None) -> Mapping[str, Element]:
    """Return the elements in ``<export>`` that name a plugin description, by its path in the package.

    ``<base plugin="${prefix}/plugins.xml"/>`` exports ``plugins.xml`` for package ``base``.
    Without a manifest, the result is empty.
    """
    exports = manifest.exports if manifest else ()
    named = ((element.get("plugin"), element) for element in exports)
    return {path.removeprefix(_PREFIX).removeprefix("./"): element for path, element in named if path.startswith(_PREFIX)}
