"""A text edit: the replacement of a span."""

from __future__ import annotations

from typing import NamedTuple

from ros_lint.base.text import Span


class Edit(NamedTuple):
    """Replaces the text of ``span`` by ``text``. An empty span inserts."""

    span: Span
    """The text to replace; an empty span is a place to insert at."""
    text: str
    """The new text; "" deletes."""
    kind: int = 0
    """Rank among several insertions at one place: the lowest kind comes first.

    Insertions of one kind form a group. Groups are separated by a blank line. Kind 0 forms no group.
    """
    order: str = ""
    """Sort key among insertions of one kind; equal keys keep the order of the edits."""
