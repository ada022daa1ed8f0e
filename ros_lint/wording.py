"""What the messages of several rules have in common: lists that are cut short, and further places."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import islice

from ros_lint.rule import Related

_MOST_RELATED = 4
_MOST_NAMES = 3


def few(names: Iterable[str]) -> str:
    """Return the first of some names, with dots if there are more."""
    first = list(islice(names, _MOST_NAMES + 1))
    return ", ".join(first[:_MOST_NAMES]) + (" ..." if len(first) > _MOST_NAMES else "")


def several(places: Iterable[Related]) -> tuple[Related, ...]:
    """Return as many further places as help: the first of those that there are."""
    return tuple(islice(places, _MOST_RELATED))
