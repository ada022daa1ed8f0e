"""Packages from which a launch file starts a node whether its conditions are true or false."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ros_lint.collectors.symbolic_text import negated
from ros_lint.facts.launch import LaunchAction, LaunchCondition, LaunchFile

Branch = frozenset[LaunchCondition]


def packages_of_every_branch(file: LaunchFile) -> frozenset[str]:
    """Return the packages from which the file certainly starts or loads a node, whether its conditions are true or false.

    A node of such a package has no condition, or further nodes of the package start under the negated condition.
    """
    branches: dict[str, set[Branch]] = {}
    for package, conditions in _started(file.actions, frozenset()):
        branches.setdefault(package, set()).add(conditions)
    return frozenset([package for package, conditions in branches.items() if _are_exhaustive(conditions)])


def _started(actions: Iterable[LaunchAction], outer: Branch) -> Iterator[tuple[str, Branch]]:
    for action in actions:
        inner = outer.union(map(_normalized, action.conditions))
        if action.kind in ("node", "component") and action.package is not None and len(action.package.texts) == 1:
            yield action.package.texts[0], inner
        yield from _started(action.children, inner)


def _normalized(condition: LaunchCondition) -> LaunchCondition:
    """Return a condition without the negation in its expression: ``unless x`` for ``if not x``."""
    text = negated(condition.texts[0]) if len(condition.texts) == 1 and condition.equals is None else ""
    return condition._replace(texts=(text,), wanted=not condition.wanted) if text else condition


def _are_exhaustive(given: Iterable[Branch]) -> bool:
    """Return whether in every case all conditions of at least one branch hold.

    A branch is a set of conditions. Two branches that differ only in the negation of a condition are replaced by a branch without
    this condition. The result is True if a branch without conditions remains.
    """
    branches = set(given)
    pending = list(branches)
    while pending:
        branch = pending.pop()
        for condition in branch:
            rest = branch - {condition}
            if rest not in branches and rest | {condition._replace(wanted=not condition.wanted)} in branches:
                branches.add(rest)
                pending.append(rest)
    return frozenset() in branches
