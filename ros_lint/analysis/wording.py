"""Shared parts of messages: shortened lists of names, and related places."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import islice

from ros_lint.analysis.finding import Related

_MOST_RELATED = 4


def first_related(places: Iterable[Related]) -> tuple[Related, ...]:
    """Return the first four related places. More do not help the reader."""
    return tuple(islice(places, _MOST_RELATED))
