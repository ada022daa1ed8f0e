"""What the launch configurations of a launch file hold as long as nobody gives its arguments other values."""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping
from typing import NamedTuple

from ros_lint.collectors.symbolic_text import UNKNOWN, is_plain, is_settled, named_in
from ros_lint.facts.launch import LaunchAction, LaunchCondition


class DefaultConfigurations(NamedTuple):
    """The launch configurations of one file by name."""

    values: Mapping[str, tuple[str, ...]]
    """Each with its alternatives."""
    own: frozenset[str]
    """Those that the file itself sets, so that whoever launches it changes nothing about them, but for which alternative."""

    def is_own(self, text: str) -> bool:
        """Return whether a text is the same whatever the file is launched with, or one of the same."""
        return _hangs_on(text, self.own)


def default_configurations(actions: Iterable[LaunchAction]) -> DefaultConfigurations:
    """Return what launch configurations hold in a file, going by its arguments and by what it sets.

    What is set under a condition is one of several values, the only ones if another is set under the opposite.
    """
    found: dict[str, tuple[str, ...]] = {}
    given: set[str] = set()
    perhaps: dict[str, list[tuple[tuple[LaunchCondition, ...], tuple[str, ...]]]] = {}
    waiting: list[tuple[LaunchAction, tuple[LaunchCondition, ...]]] = [(action, ()) for action in reversed(tuple(actions))]
    while waiting:
        action, around = waiting.pop()
        if action.kind == "later":
            around = (*around, _SOME_TIME)
        around = (*around, *action.conditions)
        if action.value is not None and action.target is not None and action.kind in ("argument", "set"):
            for name in action.target.texts:
                if action.kind == "set" and around:
                    perhaps.setdefault(name, []).append((around, action.value.texts))
                    continue
                found[name] = action.value.texts
                given.discard(name)
                perhaps.pop(name, None)
        if action.kind == "argument" and action.target is not None:
            given.update(action.target.texts)
        waiting += [(child, around) for child in reversed(action.children)]
    for name, several in perhaps.items():
        texts = [text for _, one in several for text in one]
        if _covers([conditions for conditions, _ in several]):
            given.discard(name)
        else:
            given.update({name} - found.keys())
            texts = [*found.get(name, ()), *texts]
        found[name] = tuple(dict.fromkeys(texts))
    return DefaultConfigurations(found, _own(found, given))


_SOME_TIME = LaunchCondition((UNKNOWN,), None)


def _covers(several: list[tuple[LaunchCondition, ...]]) -> bool:
    """Whether one of two conditions is the opposite of the other, so that one of them holds."""
    single = {conditions[0] for conditions in several if len(conditions) == 1 and all(map(_is_known, conditions))}
    return any(condition._replace(wanted=not condition.wanted) in single for condition in single)


def _is_known(condition: LaunchCondition) -> bool:
    return all(is_plain(text) or named_in(text) for text in condition.texts)


def _own(values: Mapping[str, tuple[str, ...]], given: set[str]) -> frozenset[str]:
    """Return the configurations that depend on nothing but each other."""
    own = values.keys() - given
    while lost := {name for name in own if not all(_hangs_on(text, own) for text in values[name])}:
        own -= lost
    return frozenset(own)


def _hangs_on(text: str, names: Container[str]) -> bool:
    """Whether a text hangs on nothing, or only on some configurations; not so where their names are computed."""
    return is_settled(text) or all(name in names for name in named_in(text) or ("\0",))
