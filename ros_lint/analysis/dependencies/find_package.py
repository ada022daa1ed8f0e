"""Which packages a CMake script has found, names and exports, from the mentions of its evaluation."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from ros_lint.analysis.build.commands import FINDS_TESTS, generated_from, relative
from ros_lint.collectors.interfaces import naming as interface_names
from ros_lint.facts.build import BuildScript
from ros_lint.facts.sources import Mention, Purpose
from ros_lint.facts.visibility import Facet
from ros_lint.workspace.model import Package, Workspace

if TYPE_CHECKING:
    from ros_lint.knowledge.closure import Closure

_FIND_DECLARED = frozenset({"ament_auto_find_build_dependencies", "autoware_package"})
_AT_BUILD = ("depend", "build_depend", "buildtool_depend")


def found_names(package: Package, script: BuildScript) -> frozenset[str]:
    """Return the names that find_package() is called with, also by those macros that find what the manifest declares."""
    names = {mention.name for mention in script.mentions if mention.via == "cmake"}
    calls = frozenset(script.calls)
    if calls & _FIND_DECLARED:
        names.update(each.name for each in package.declared if each.depend.tag in _AT_BUILD)
    if calls & FINDS_TESTS:
        names.update(each.name for each in package.declared if each.depend.tag == "test_depend")
    return frozenset(names)


def finds_declared(package: Package) -> bool:
    """Return whether CMake finds whatever the manifest declares for building, and gives it to every target."""
    return package.script is not None and not _FIND_DECLARED.isdisjoint(package.script.calls)


def not_seen_used(package: Package) -> Iterator[Mention]:
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
    read = {relative(package, file.path) for file in package.interface_files if not file.problems}
    return len(given) == len(package.built.interfaces) and given <= read and not package.hidden(Facet.INTERFACES)


def come_along(workspace: Workspace, names: Iterable[str]) -> frozenset[str] | None:
    """Return what is found together with names of find_package(), these included: what their packages bring along.

    None when nobody knows of one of them whose it is, or what it brings.
    """
    closure = found_along(workspace, names)
    return closure.names.union(names) if closure.complete else None


def found_along(workspace: Workspace, names: Iterable[str]) -> Closure:
    """Return what is found together with names of find_package(), as far as it is known whose they are and what they bring."""
    starts: set[str] = set()
    for name in names:
        providers = workspace.world.by_cmake(name)
        mapped = providers.known and not workspace.world.is_package(name)
        starts.update(providers.packages if mapped else (name,))
    return workspace.world.closure(sorted(starts))


def given_for(script: BuildScript, *purposes: Purpose) -> Iterator[Mention]:
    """Yield the packages that macros are given by name for one of some purposes: ament_export_dependencies() those to export."""
    for mention in script.mentions:
        if mention.via == "target" and mention.purpose in purposes:
            yield mention
