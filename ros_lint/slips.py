"""Names that look like one that means nothing, and how a message says so: in settings, on the command line, in files."""

from __future__ import annotations

from collections.abc import Iterable, Sequence


def similar(name: str, names: Iterable[str], most: int = 1, least: float = 0.6) -> list[str]:
    """Return which of some names look like another one, nearest first; ``least`` is how alike they are, from 0 to 1."""
    from difflib import get_close_matches  # noqa: PLC0415  (slow to import, and needed for a slip only)

    return get_close_matches(name, list(names), most, least)


def did_you_mean(names: Sequence[str], after: str = "; ") -> str:
    """Return how a message goes on, ``after`` what it has said, that asks for what may be meant; "" if nothing is."""
    return f"{after}did you mean {' or '.join(names)}?" if names else ""


def is_meant(names: Sequence[str]) -> str:
    """Return how a message goes on that asks for the first of some names alone, as it can hardly be another one."""
    return f"; is {names[0]} meant?" if names else ""
