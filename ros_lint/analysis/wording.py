"""Limit the number of related places in a finding."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import islice

from ros_lint.analysis.finding import Related

_MOST_RELATED = 4


def first_related(places: Iterable[Related]) -> tuple[Related, ...]:
    """Return the first four related places, because more places do not help the user."""
    return tuple(islice(places, _MOST_RELATED))
