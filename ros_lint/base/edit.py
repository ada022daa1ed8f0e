"""A text edit: the replacement of a span."""

from __future__ import annotations

from typing import NamedTuple

from ros_lint.base.text import Span


class Edit(NamedTuple):
    """Put ``text`` where ``span`` is. An empty span inserts."""

    span: Span
    text: str
    kind: int = 0
    """Of several insertions at one place the one of the least kind comes first. Those of one kind belong together: they are set
    off by a blank line once. 0 belongs to nothing."""
    order: str = ""
    """Of those of one kind the one with the least comes first; those with the same one keep their order."""
