"""Actions that timers and events start, and their order in time."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ros_lint.collectors.symbolic_text import is_settled

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ros_lint.base.text import Span
    from ros_lint.collectors.launch.expansion import Started
    from ros_lint.collectors.launch.final_parameters import Texts
    from ros_lint.collectors.launch.scope import LaunchScope
    from ros_lint.facts.launch import LaunchAction

_SHARED_VALUES = frozenset({"humble", "iron"})
_SHARED_ENVIRONMENT = _SHARED_VALUES | {"jazzy", "kilted"}
"""Distributions in which the actions of a timer run with the environment of launch at that time (timer_action.py)."""


class Delayed(NamedTuple):
    """The actions that a timer or an event starts. They are expanded after all other actions."""

    host: list[Started]
    """The list of started actions that the timer or event handler belongs to."""
    place: int
    """The number of actions in ``host`` that were started before the timer or the event handler."""
    actions: tuple[LaunchAction, ...]
    scope: LaunchScope
    """The settings in effect at the place of the timer or event handler, and the time at which the actions start."""
    open: tuple[tuple[str, dict[str, Texts]], ...]
    """The files that are being included, each with its launch configurations, innermost last."""
    via: Span | None
    read: tuple[str, ...]
    """Launch configurations whose values at the place of the timer or event handler may be in the actions."""
    is_timer: bool
    number: int
    """The number of timers and event handlers before this one."""

    @property
    def time(self) -> float | None:
        """The time in seconds after the start at which the actions start, None if it is unknown."""
        return self.scope.time


def has_own_values(distro: str) -> bool:
    """Return whether the actions of a timer run with the launch configurations at the place of the timer."""
    return distro not in _SHARED_VALUES


def has_own_environment(distro: str) -> bool:
    """Return whether the actions of a timer run with the environment variables at the place of the timer."""
    return distro not in _SHARED_ENVIRONMENT


def time_of(periods: Texts, start: float | None) -> float | None:
    """Return the time at which a timer ends that starts at the time ``start``, None if it is unknown. Unit: seconds."""
    if start is None or len(periods) != 1 or not is_settled(periods[0]):
        return None
    try:
        return start + float(periods[0])
    except ValueError:
        return None


def next_of(waiting: list[Delayed]) -> Delayed | None:
    """Remove and return the actions that start next, None if ``waiting`` is empty.

    Events come first, in the order of their handlers, because their times are unknown; then come timers in the order of time.
    """
    if not waiting:
        return None
    index = min(range(len(waiting)), key=lambda index: -1.0 if (time := waiting[index].time) is None else time)
    return waiting.pop(index)


def assembled(host: list[Started], finished: Sequence[tuple[Delayed, list[Started]]]) -> list[Started]:
    """Return the started actions of ``host`` with those of timers and events at the place of the timer or event handler."""
    by_host: dict[int, list[tuple[int, list[Started]]]] = {}
    for entry, started in sorted(finished, key=lambda pair: pair[0].number):
        by_host.setdefault(id(entry.host), []).append((entry.place, started))
    return _with_later(host, by_host)


def _with_later(host: list[Started], by_host: dict[int, list[tuple[int, list[Started]]]]) -> list[Started]:
    result: list[Started] = []
    done = 0
    for place, started in sorted(by_host.get(id(host), ()), key=lambda pair: pair[0]):
        result += [*host[done:place], *_with_later(started, by_host)]
        done = place
    return [*result, *host[done:]]
