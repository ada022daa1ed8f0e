"""Shared parts of messages: shortened lists of names, and related places."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import islice

from ros_lint.analysis.rule import Related

_MOST_RELATED = 4
_MOST_NAMES = 3


def few(names: Iterable[str]) -> str:
    """Return the first three of some names, in quotes, and the number of the others."""
    names = list(names)
    first = ", ".join([f"'{name}'" for name in names[:_MOST_NAMES]])
    return f"{first} and {len(names) - _MOST_NAMES} more" if len(names) > _MOST_NAMES else first


def several(places: Iterable[Related]) -> tuple[Related, ...]:
    """Return the first four related places: more do not help the reader."""
    return tuple(islice(places, _MOST_RELATED))
