"""Why the rules about dependencies say nothing of a package and a dependency: the steps of each rule, told aloud."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ros_lint.carriers import carriers
from ros_lint.declare import builds_something, is_built_in_sight, is_library, is_mostly_run, leaves_trace, works_unseen
from ros_lint.facts.manifest import Role
from ros_lint.facts.sight import Facet
from ros_lint.facts.sources import Use
from ros_lint.needs import all_declared, despite, only_launched, tells
from ros_lint.workspace import Package, Workspace

_MOST = 5


def explain(package: Package, workspace: Workspace, name: str) -> Iterator[str]:
    """Yield lines: where the dependency is used, how it is declared, and why each rule is silent, if it is."""
    uses = [use for use in package.uses if name in use.providers]
    yield from used_in(uses)
    for depend in [each.depend for each in package.tags(name)]:
        condition = f" if {depend.condition}" if depend.condition else ""
        yield f"{depend.span}: <{depend.tag}>{depend.name}</{depend.tag}>{condition}"
    yield f"undeclared-dependency: {_not_undeclared(package, workspace, name, uses)}"
    yield f"unused-dependency: {_not_unused(package, workspace, name, uses)}"


def used_in(uses: Sequence[Use]) -> Iterator[str]:
    """Yield lines: where something is used, and for what."""
    for use in uses[:_MOST]:
        yield f"{use.span}: {use.what}, {_needed_for(use)}"
    if len(uses) > _MOST:
        yield f"and {len(uses) - _MOST} more uses"


def _needed_for(use: Use) -> str:
    words = [word for role, word in _WORDS if use.role & role]
    doubts = ["optional"] if use.optional else []
    if not use.sure:
        doubts.append("in a file that is perhaps not built or installed, or by a name that is not sure")
    return f"needed {' and '.join(words) or 'for nothing'}{''.join(f'; {doubt}' for doubt in doubts)}"


_WORDS = (
    (Role.BUILD, "to build"),
    (Role.EXPORT, "to build against"),
    (Role.EXEC, "to run"),
    (Role.TEST, "to test"),
    (Role.TOOL, "as a build tool"),
)


def _not_undeclared(package: Package, workspace: Workspace, name: str, uses: list[Use]) -> str:
    if not tells(package):
        return "silent, for package.xml cannot be used as it is"
    if package.declares(name):
        return "silent, for it is declared"
    if not uses:
        return f"silent, for nothing that is seen uses it{_hidden(package)}"
    if all(use.optional for use in uses):
        return "less than certain, for every use is optional; shown with --pedantic"
    closure = all_declared(package, workspace)
    starts = [each.name for each in package.declared]
    own = [use for use in uses if use.package == name and not use.optional] or uses
    brought = [next((other for other in use.providers if other in closure), "") for use in own if not use.optional]
    if all(brought):
        way = workspace.world.path(starts, brought[0])
        return f"silent, for it comes along: {' > '.join(way or (brought[0],))}; see transitive-dependency"
    if only_launched(package, uses):
        return "silent, for only launch files name it; see launch-outside-closure"
    if not any(use.sure for use in own):
        return "less than certain, for no use is sure; shown with --pedantic"
    if not despite(closure.unknown, own, workspace):
        return f"less than certain, for nobody knows what {', '.join(closure.unknown)} may bring; shown with --pedantic"
    return "reported"


def _not_unused(package: Package, workspace: Workspace, name: str, uses: list[Use]) -> str:
    declared = package.tags(name)
    tags = [each.depend for each in declared]
    if not tags:
        return "silent, for it is not declared"
    if all(depend.condition for depend in tags):
        return "silent, for it is declared under a condition"
    if uses:
        return f"silent, for it is used: {uses[0].span}"
    if name in package.traces:
        return f"silent, for its name stands here: {package.traces[name]}"
    if (hidden := _hidden(package)) and not (is_library(workspace.world, name) and is_built_in_sight(package)):
        return f"silent{hidden}"
    if not builds_something(package):
        return "silent, for the package builds and installs no code of its own"
    if not is_built_in_sight(package):
        return "silent, for its manifest or build script cannot be followed"
    unseen = works_unseen(package, workspace, name)
    if unseen or (is_mostly_run(workspace, name) and not leaves_trace(package, workspace, name)):
        return "silent, for it may do its work without being named"
    if not any(depend.tag in ("depend", "build_depend") for depend in tags):
        return "silent unless it is declared for tests and there are none: this tag says that it leaves no trace"
    carried = carriers(package, workspace, declared).get(name)
    if carried:
        whom = "" if carried.package == package.name else f" to {carried.package}"
        return f"less than certain, for it alone brings {carried.name}{whom}; shown with --pedantic"
    return "reported"


def _hidden(package: Package) -> str:
    hidden = package.hidden(Facet.USES)
    return f", and not everything is seen: {hidden[0].reason} ({hidden[0].span})" if hidden else ""
