"""The values of the launch configurations of a launch file if all launch arguments have their default values."""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping
from typing import NamedTuple

from ros_lint.collectors.symbolic_text import UNKNOWN, is_plain, is_settled, named_in
from ros_lint.facts.launch import LaunchAction, LaunchCondition


class DefaultConfigurations(NamedTuple):
    """The possible values of the launch configurations of one launch file, if the caller passes no arguments."""

    values: Mapping[str, tuple[str, ...]]
    """The possible values of each launch configuration, by its name."""
    own: frozenset[str]
    """Names of the launch configurations whose possible values are all in the file itself.

    A caller of the file can only change which of the possible values applies, for example with an argument in a condition."""

    def is_own(self, text: str) -> bool:
        """Return whether no caller can add a value to the launch configurations in a text: all of them are in ``own``."""
        return _depends_only_on(text, self.own)


def default_configurations(actions: Iterable[LaunchAction]) -> DefaultConfigurations:
    """Return the possible values of all launch configurations that the actions of a file declare or set.

    A value that is set under a condition is possible in addition to the default. The default is not possible if values are
    set under a condition and under the opposite condition.
    """
    values: dict[str, tuple[str, ...]] = {}
    settable: set[str] = set()
    conditional: dict[str, list[tuple[tuple[LaunchCondition, ...], tuple[str, ...]]]] = {}
    pending: list[tuple[LaunchAction, tuple[LaunchCondition, ...]]] = [(action, ()) for action in reversed(tuple(actions))]
    while pending:
        action, conditions = pending.pop()
        if action.kind == "later":
            conditions = (*conditions, _UNKNOWN_CONDITION)
        conditions = (*conditions, *action.conditions)
        if action.value is not None and action.target is not None and action.kind in ("argument", "set"):
            for name in action.target.texts:
                if action.kind == "set" and conditions:
                    conditional.setdefault(name, []).append((conditions, action.value.texts))
                    continue
                values[name] = action.value.texts
                settable.discard(name)
                conditional.pop(name, None)
        if action.kind == "argument" and action.target is not None:
            settable.update(action.target.texts)
        pending += [(child, conditions) for child in reversed(action.children)]
    for name, assignments in conditional.items():
        texts = [text for _, alternatives in assignments for text in alternatives]
        if _is_exhaustive([conditions for conditions, _ in assignments]):
            settable.discard(name)
        else:
            settable.update({name} - values.keys())
            texts = [*values.get(name, ()), *texts]
        values[name] = tuple(dict.fromkeys(texts))
    return DefaultConfigurations(values, _independent_configurations(values, settable))


_UNKNOWN_CONDITION = LaunchCondition((UNKNOWN,), None)


def _is_exhaustive(condition_sets: list[tuple[LaunchCondition, ...]]) -> bool:
    """Return whether one of several sets of conditions certainly holds.

    The result is True if two of the sets have only a single condition each, and the two conditions are opposites.
    """
    single = {conditions[0] for conditions in condition_sets if len(conditions) == 1 and all(map(_is_known, conditions))}
    return any(condition._replace(wanted=not condition.wanted) in single for condition in single)


def _is_known(condition: LaunchCondition) -> bool:
    return all(is_plain(text) or named_in(text) for text in condition.texts)


def _independent_configurations(values: Mapping[str, tuple[str, ...]], settable: set[str]) -> frozenset[str]:
    """Return the names of the launch configurations whose values depend on no configuration in ``settable``.

    ``settable`` are the configurations that a caller can set.
    """
    independent = values.keys() - settable
    while dependent := {name for name in independent if not all(_depends_only_on(text, independent) for text in values[name])}:
        independent -= dependent
    return frozenset(independent)


def _depends_only_on(text: str, names: Container[str]) -> bool:
    """Return whether all launch configurations in a text are among ``names``; False if a name is computed at launch."""
    return is_settled(text) or all(name in names for name in named_in(text) or ("\0",))
