"""Globbing as CMake does it, against the files of the package."""

from __future__ import annotations

import re
from functools import lru_cache


@lru_cache(maxsize=256)
def glob_regex(pattern: str) -> str:
    """Return a glob pattern as a regular expression for a path (KWSys Glob: ``*`` and ``?`` stop at a slash)."""
    found: list[str] = []
    index = 0
    while index < len(pattern):
        letter = pattern[index]
        index += 1
        if letter == "*":
            found.append("[^/]*")
        elif letter == "?":
            found.append("[^/]")
        elif letter == "[":
            end = pattern.find("]", index + (pattern[index : index + 1] in ("!", "^")) + 1)
            if end < 0:
                found.append(r"\[")
                continue
            inner = pattern[index:end]
            index = end + 1
            negated = inner[:1] in ("!", "^")
            body = (inner[1:] if negated else inner).replace("\\", r"\\").replace("[", r"\[")
            found.append(f"[{'^' if negated else ''}{body}]")
        else:
            found.append(re.escape(letter))
    return "".join(found)
