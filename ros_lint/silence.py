"""Why the rules about dependencies say nothing of a package and a dependency."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from ros_lint.advice import circle
from ros_lint.carriers import carriers
from ros_lint.declare import builds_something, is_built_in_sight, is_library, is_unseen_by_name
from ros_lint.facts.manifest import Role
from ros_lint.facts.sight import Facet
from ros_lint.facts.sources import Use
from ros_lint.needs import all_declared, despite, only_launched, tells, undeclared
from ros_lint.rule import Confidence
from ros_lint.workspace import Package, Workspace

_MOST = 5


RULES = ("undeclared-dependency", "unused-dependency")
"""Those that are explained here."""


def explain(package: Package, workspace: Workspace, name: str, told: Mapping[str, Confidence]) -> Iterator[str]:
    """Yield lines: where the dependency is used, how it is declared, and why each of the rules is silent, if it is.

    ``told`` is how sure those are that say something of it. What they do is theirs to say; here are the reasons only.
    """
    uses = [use for use in package.uses if name in use.providers]
    yield from used_in(uses)
    for depend in [each.depend for each in package.tags(name)]:
        condition = f" if {depend.condition}" if depend.condition else ""
        yield f"{depend.span}: <{depend.tag}>{depend.name}</{depend.tag}>{condition}"
    silent = (_not_undeclared(package, workspace, name, uses), _not_unused(package, workspace, name, uses))
    unsure = (_unsure_undeclared(package, workspace, name, uses), _unsure_unused(package, workspace, name))
    for rule, reason, doubt in zip(RULES, silent, unsure, strict=True):
        if rule not in told:
            yield f"{rule}: silent, {reason}"
        elif told[rule] is Confidence.HIGH:
            yield f"{rule}: reported"
        else:
            yield f"{rule}: less than certain{doubt}; shown with --pedantic"


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
        return "for package.xml cannot be used as it is"
    if package.declares(name):
        return "for it is declared"
    if not uses:
        return f"for nothing that is seen uses it{_hidden(package)}"
    told = next((need.name for need, _ in undeclared(package, workspace) if any(use in need.uses for use in uses)), "")
    if told:
        return f"for {told} is told, which will do as well"
    closure = all_declared(package, workspace)
    starts = [each.name for each in package.declared]
    brought = [next((other for other in use.providers if other in closure), "") for use in _of_itself(name, uses)]
    if all(brought):
        way = workspace.world.path(starts, brought[0])
        return f"for it comes along: {' > '.join(way or (brought[0],))}; see transitive-dependency"
    if only_launched(package, uses):
        return "for only launch files name it; see launch-outside-closure"
    if way := circle(package, workspace, name):
        return f"for it needs this package itself: {' > '.join(way)}"
    best = " or ".join(dict.fromkeys(use.package for use in uses if use.package != name))
    return f"for it would only do as well as {best}" if best else "for what it is used for is declared otherwise"


def _unsure_undeclared(package: Package, workspace: Workspace, name: str, uses: list[Use]) -> str:
    if all(use.optional for use in uses):
        return ", for every use is optional"
    own = _of_itself(name, uses)
    if not any(use.sure for use in own):
        return ", for no use is sure"
    unknown = all_declared(package, workspace).unknown
    return "" if despite(unknown, own, workspace) else f", for nobody knows what {', '.join(unknown)} may bring"


def _of_itself(name: str, uses: list[Use]) -> list[Use]:
    """Return the uses that need a name more than another one, all if there is none; those that need not be if all are such."""
    needed = [use for use in uses if not use.optional] or uses
    return [use for use in needed if use.package == name] or needed


def _not_unused(package: Package, workspace: Workspace, name: str, uses: list[Use]) -> str:
    tags = package.tags(name)
    if not tags:
        return "for it is not declared"
    if not any(declared.always for declared in tags):
        return "for it is declared under a condition"
    if uses:
        return f"for it is used: {uses[0].span}"
    if name in package.traces:
        return f"for its name stands here: {package.traces[name]}"
    hidden = _hidden(package)
    if hidden and not (is_library(workspace.world, name) and is_built_in_sight(package)):
        return hidden.removeprefix(", ")
    if not builds_something(package):
        return "for the package builds and installs no code of its own"
    if not is_built_in_sight(package):
        return "for its manifest or build script cannot be followed"
    if not any(declared.depend.tag in ("depend", "build_depend") for declared in tags):
        return "for this tag says that it leaves no trace, or there are tests that may use it"
    return "for it may do its work without being named"


def _unsure_unused(package: Package, workspace: Workspace, name: str) -> str:
    carried = carriers(package, workspace, package.tags(name)).get(name)
    if carried:
        whom = "" if carried.package == package.name else f" to {carried.package}"
        return f", for it alone brings {carried.name}{whom}"
    return ", for it may do its work without being named" if is_unseen_by_name(workspace.world, name) else ""


def _hidden(package: Package) -> str:
    hidden = package.hidden(Facet.USES)
    return f", and not everything is seen: {hidden[0].reason} ({hidden[0].span})" if hidden else ""
