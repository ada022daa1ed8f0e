"""An edit of a file: the replacement of the text between two places."""

from __future__ import annotations

from typing import NamedTuple

from ros_lint.base.text import Span


class Edit(NamedTuple):
    """The replacement of the text in ``span`` by ``text``. If ``span`` is empty, ``text`` is inserted there."""

    span: Span
    """The place of the text to replace. An empty span is a place of insertion."""
    text: str
    """The new text. "" deletes the old text."""
    kind: int = 0
    """Rank among several insertions at the same place: the lowest number comes first.

    Insertions with equal numbers form a group, and a blank line separates groups. Insertions of kind 0 form no group.
    """
    order: str = ""
    """Sort key among insertions of the same ``kind`` at a place. Insertions with equal keys keep their order."""
