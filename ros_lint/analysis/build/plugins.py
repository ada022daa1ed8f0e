"""Plugins of pluginlib: their registrations in C++ sources, their descriptions, and the loaders that search for them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from ros_lint.analysis.build.commands import EXPORTING_PLUGINS, opaque_except_undefined_targets
from ros_lint.analysis.memo import cached_by_workspace
from ros_lint.base.auxiliary_files import is_auxiliary
from ros_lint.collectors.manifest.plugin_exports import plugin_exports
from ros_lint.facts.build import PluginFile
from ros_lint.facts.manifest import Element
from ros_lint.facts.sources import PluginLoader, Registration
from ros_lint.facts.visibility import Facet
from ros_lint.workspace.model import Package, Workspace


class Plugins(NamedTuple):
    """The plugins that a package registers in its sources, and the plugin descriptions (XML files) that it contains."""

    macros: Sequence[Registration]
    """All registrations of plugins in the sources."""
    registered: Sequence[Registration]
    """Registrations of plugins that need a description. Registrations in tests and examples are left out."""
    installed: Sequence[PluginFile]
    """Plugin descriptions that are installed."""
    uninstalled: Sequence[PluginFile]
    """Plugin descriptions that are not installed. Descriptions for tests and examples are left out."""
    exports: bool
    """True if the build script exports plugin descriptions."""
    of_ros_1: Mapping[str, Element]
    """Elements of package.xml that export a plugin description for ROS 1, by the path of the description."""


_NEEDED = Facet.LIBRARIES | Facet.SHARE | Facet.COMPONENTS


def plugins(package: Package) -> Plugins | None:
    """Return the plugins of a package, None if its libraries or installed files cannot be fully analysed."""
    script = package.script
    if script is None or package.builds_with != "ament_cmake" or opaque_except_undefined_targets(package, _NEEDED):
        return None
    macros = [macro for macro in package.registrations if macro.kind == "plugin"]
    registered = [
        macro for macro in macros if not (is_auxiliary(package.relative(macro.span.path)) or _needs_no_description(macro))
    ]
    used = [plugin for plugin in script.files.plugin_files if not is_auxiliary(plugin.path)]
    return Plugins(
        macros,
        registered,
        [plugin for plugin in used if plugin.path in script.products.installed],
        [plugin for plugin in used if plugin.path not in script.products.installed],
        EXPORTING_PLUGINS in script.commands.names or any(package.calls(EXPORTING_PLUGINS, anywhere=True)),
        plugin_exports(package.manifest),
    )


def _needs_no_description(macro: Registration) -> bool:
    """Return whether a registered class needs no plugin description.

    The result is True for nodelets, because ROS 2 does not build them, and for components: ROS 2 Crystal registered
    components, too, by ``PLUGINLIB_EXPORT_CLASS``.
    """
    return macro.base.startswith("nodelet::") or macro.base in ("rclcpp::Node", "rclcpp_lifecycle::LifecycleNode")


@cached_by_workspace
def plugin_loaders(workspace: Workspace) -> Mapping[str, Sequence[PluginLoader]]:
    """Return the plugin loaders in all packages, by the base class of the plugins that they load."""
    loaders: dict[str, list[PluginLoader]] = {}
    for package in workspace.packages:
        for loader in package.loaders:
            loaders.setdefault(loader.base, []).append(loader)
    return loaders
