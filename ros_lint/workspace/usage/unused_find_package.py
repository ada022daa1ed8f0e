"""Packages that CMake finds and that the package may use without an include or import."""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.collectors.interfaces import naming as interface_names
from ros_lint.facts.sources import Mention
from ros_lint.facts.visibility import Facet
from ros_lint.workspace.model import Package


def unused_in_sight(package: Package) -> Iterator[Mention]:
    """Yield the first find_package() of each name that is needed, tests aside, and that no code is seen to use.

    That targets are linked or exported is no use by code; plugins that macros are given by name are, and interfaces, unless
    all those are read that code is generated from, and none has a field of theirs. None where what is used is not seen whole.
    """
    script = package.script
    if script is None or script.problems or package.builds_with != "ament_cmake" or package.hidden(Facet.USES):
        return
    used = {name for use in package.uses if use.via not in _BY_SCRIPT for name in use.providers}
    read = _reads_interfaces(package)
    used |= {
        mention.name.partition("::")[0]
        for mention in script.mentions
        if mention.via not in _BY_SCRIPT
        or mention.purpose == "plugins"
        or (mention.purpose == "interfaces" and not (read and mention.name not in interface_names.UNDERLYING))
    }
    used.add(package.name)
    for mention in script.mentions:
        if mention.via == "cmake" and not (mention.optional or mention.test or mention.purpose or mention.name in used):
            used.add(mention.name)
            yield mention


_BY_SCRIPT = ("cmake", "target")


def _reads_interfaces(package: Package) -> bool:
    """Whether all interface files are read that code is generated from, so that it is known what their fields are made of."""
    given = generated_from(package)
    read = {package.relative(file.path) for file in package.interface_files if not file.problems}
    return len(given) == len(package.built.interfaces) and given <= read and not package.hidden(Facet.INTERFACES)


def generated_from(package: Package) -> frozenset[str]:
    """Return the interface files, relative to the package, that code is generated from in every build, and installed with it."""
    script = package.built
    if package.builds_with != "ament_cmake" or "rosidl_generate_interfaces" not in script.command_names:
        return frozenset()
    ends = tuple([f"/{interface}.{interface.partition('/')[0]}" for interface in script.interfaces])
    return frozenset([p.source for p in script.installs if p.source and p.path.endswith(ends) and not p.conditional])
