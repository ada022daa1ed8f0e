"""Explanations why the dependency rules report nothing about a dependency of a package."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from ros_lint.analysis.dependencies.declared_closure import all_declared
from ros_lint.analysis.dependencies.load_bearing import needed_transitively
from ros_lint.analysis.dependencies.remedy import cycle_through
from ros_lint.analysis.dependencies.traceless import is_library
from ros_lint.analysis.dependencies.undeclared import manifest_is_complete, only_launched, undeclared, uses_not_explained_by
from ros_lint.analysis.finding import Confidence
from ros_lint.facts.manifest import Role
from ros_lint.facts.sources import Use
from ros_lint.facts.visibility import Facet
from ros_lint.workspace.model import Package, Workspace
from ros_lint.workspace.usage.visibility import builds_something, is_build_visible, is_traceless_by_name

_MOST = 5


RULES = ("undeclared-dependency", "unused-dependency")
"""Names of the rules whose results are explained."""


def explain(package: Package, workspace: Workspace, name: str, confidences: Mapping[str, Confidence]) -> Iterator[str]:
    """Yield lines of text: the uses and tags of the dependency ``name``, and a line for each of the ``RULES``.

    Example of a line: "unused-dependency: not reported, because ...". ``confidences`` has the rules that do report the
    dependency, each with the confidence of its finding.
    """
    uses = [use for use in package.uses if name in use.providers]
    yield from used_in(uses)
    for depend in [declared.depend for declared in package.tags(name)]:
        condition = f" if {depend.condition}" if depend.condition else ""
        yield f"{depend.span}: <{depend.tag}>{depend.name}</{depend.tag}>{condition}"
    reasons = (_not_undeclared(package, workspace, name, uses), _not_unused(package, workspace, name, uses))
    doubts = (_unsure_undeclared(package, workspace, name, uses), _unsure_unused(package, workspace, name))
    for rule, reason, doubt in zip(RULES, reasons, doubts, strict=True):
        if rule not in confidences:
            yield f"{rule}: not reported, because {reason}"
        elif confidences[rule] is Confidence.HIGH:
            yield f"{rule}: reported"
        else:
            yield f"{rule}: reported with lower confidence{doubt}; use --pedantic to show it"


def used_in(uses: Sequence[Use]) -> Iterator[str]:
    """Yield a line for each of the first five uses: place, used name and purposes. A last line counts further uses."""
    for use in uses[:_MOST]:
        yield f"{use.span}: {use.what}, {_needed_for(use)}"
    if len(uses) > _MOST:
        yield f"and {len(uses) - _MOST} more uses"


def _needed_for(use: Use) -> str:
    words = [word for role, word in _WORDS if use.role & role]
    doubts = ["optional"] if use.optional else []
    if not use.certain:
        doubts.append("the file may not be built or installed, or the name is ambiguous")
    return f"needed {' and '.join(words) or 'for nothing'}{''.join(f'; {doubt}' for doubt in doubts)}"


_WORDS = (
    (Role.BUILD, "to build"),
    (Role.EXPORT, "to build against"),
    (Role.EXEC, "to run"),
    (Role.TEST, "to test"),
    (Role.TOOL, "as a build tool"),
)


def _not_undeclared(package: Package, workspace: Workspace, name: str, uses: list[Use]) -> str:
    if not manifest_is_complete(package):
        return "package.xml has errors"
    if package.declares(name):
        return "it is declared"
    if not uses:
        return f"no use of it was found{_hidden(package)}"
    reported = next((need.name for need, _ in undeclared(package, workspace) if any(use in need.uses for use in uses)), "")
    if reported:
        return f"'{reported}' is reported instead, and provides the same"
    closure = all_declared(package, workspace)
    starts = [declared.name for declared in package.declared]
    provided = [next((provider for provider in use.providers if provider in closure), "") for use in _of_itself(name, uses)]
    if all(provided):
        way = workspace.world.path(starts, provided[0])
        return f"a declared dependency provides it: {' -> '.join(way or (provided[0],))}; see rule transitive-dependency"
    if only_launched(package, uses):
        return "only launch files use it; see rule launch-outside-closure"
    if way := cycle_through(package, workspace, name):
        return f"it depends on this package, so declaring it would close a cycle: {' -> '.join(way)}"
    best = "' or '".join(dict.fromkeys(use.package for use in uses if use.package != name))
    return f"'{best}' is the better match for these uses" if best else "another declared dependency covers these uses"


def _unsure_undeclared(package: Package, workspace: Workspace, name: str, uses: list[Use]) -> str:
    if all(use.optional for use in uses):
        return ", because every use is optional"
    direct_uses = _of_itself(name, uses)
    if not any(use.certain for use in direct_uses):
        return ", because no use is certain"
    unknown = all_declared(package, workspace).unknown
    if uses_not_explained_by(unknown, direct_uses, workspace):
        return ""
    return f", because the dependencies of {', '.join(unknown)} are unknown and may include it"


def _of_itself(name: str, uses: list[Use]) -> list[Use]:
    """Return the uses that were resolved to the package ``name``. If there are none, return all uses.

    Optional uses are left out if any use is required.
    """
    needed = [use for use in uses if not use.optional] or uses
    return [use for use in needed if use.package == name] or needed


def _not_unused(package: Package, workspace: Workspace, name: str, uses: list[Use]) -> str:
    tags = package.tags(name)
    if not tags:
        return "it is not declared"
    if not any(declared.always for declared in tags):
        return "it is declared under a condition"
    if uses:
        return f"it is used: {uses[0].span}"
    if name in package.textual_mentions:
        return f"its name appears here: {package.textual_mentions[name]}"
    hidden = _hidden(package)
    if hidden and not (is_library(workspace.world, name) and is_build_visible(package)):
        return hidden.removeprefix(", and ")
    if not builds_something(package):
        return "the package builds and installs no code of its own"
    if not is_build_visible(package):
        return "its manifest or build script cannot be analysed"
    if not any(declared.depend.tag in ("depend", "build_depend") for declared in tags):
        return "a dependency with this tag may be used without any trace in the sources, or by tests"
    return "it may be used without being named in the sources"


def _unsure_unused(package: Package, workspace: Workspace, name: str) -> str:
    lost = needed_transitively(package, workspace, package.tags(name)).get(name)
    if lost:
        where = "" if lost.package == package.name else f" for '{lost.package}'"
        return f", because only this dependency provides '{lost.name}'{where}"
    return ", because it may be used without being named in the sources" if is_traceless_by_name(workspace.world, name) else ""


def _hidden(package: Package) -> str:
    hidden = package.hidden(Facet.USES)
    return f", and not everything could be analysed: {hidden[0].reason} ({hidden[0].span})" if hidden else ""
