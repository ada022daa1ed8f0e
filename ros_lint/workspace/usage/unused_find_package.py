"""Find find_package() calls whose package no code seems to use."""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.collectors.interfaces import naming
from ros_lint.facts.sources import Mention
from ros_lint.facts.visibility import Facet
from ros_lint.workspace.model import Package
from ros_lint.workspace.usage.visibility import problems_hide_uses, uses_code_outside


def unused_finds(package: Package) -> Iterator[Mention]:
    """Yield, for each package that no code uses, its first required find_package() call. Calls for tests are left out.

    To link or export a target of the package is not a use by code. These count as uses:

    * packages that a macro gets by name to export plugins: ``pluginlib_export_plugin_description_file(nav2_core ...)``,
    * packages of interfaces, unless all interface files are read and no field has a type of the package.

    The result is empty if parts of the package that may use other packages could not be evaluated.
    """
    script = package.script
    if script is None or package.builds_with != "ament_cmake":
        return
    if problems_hide_uses(script) or uses_code_outside(script) or package.hidden(Facet.USES):
        return
    used = {name for use in package.uses if use.via not in _BY_SCRIPT for name in use.providers}
    reads_interfaces = _reads_interfaces(package)
    used |= {
        mention.name.partition("::")[0]
        for mention in script.mentions
        if mention.via not in _BY_SCRIPT
        or mention.purpose == "plugins"
        or (mention.purpose == "interfaces" and not (reads_interfaces and mention.name not in naming.UNDERLYING))
    }
    used.add(package.name)
    for mention in script.mentions:
        if mention.via == "cmake" and not (mention.optional or mention.test or mention.purpose or mention.name in used):
            used.add(mention.name)
            yield mention


_BY_SCRIPT = ("cmake", "target")


def _reads_interfaces(package: Package) -> bool:
    """Return whether ros-lint could read all interface files from which code is generated, so their field types are known."""
    generated = generated_from(package)
    read_files = {package.relative(file.path) for file in package.interface_files if not file.problems}
    return (
        len(generated) == len(package.built.products.interfaces)
        and generated <= read_files
        and not package.hidden(Facet.INTERFACES)
    )


def generated_from(package: Package) -> frozenset[str]:
    """Return the installed interface files from which code is generated in each build.

    Paths are relative to the package.
    """
    script = package.built
    if package.builds_with != "ament_cmake" or "rosidl_generate_interfaces" not in script.commands.names:
        return frozenset()
    ends = tuple([f"/{interface}.{interface.partition('/')[0]}" for interface in script.products.interfaces])
    return frozenset([p.source for p in script.products.installs if p.source and p.path.endswith(ends) and not p.conditional])
