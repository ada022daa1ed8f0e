"""Differences between texts, as patches."""

from __future__ import annotations

import difflib


def unified(path: str, before: str, after: str, context: int = 1) -> str:
    """Return the difference of two texts of a file, with lines of context around each change. Line ends are kept."""
    lines = difflib.unified_diff(before.splitlines(True), after.splitlines(True), f"a/{path}", f"b/{path}", n=context)
    return "".join(line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n" for line in lines)
