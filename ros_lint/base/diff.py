"""Differences between two versions of a file, as patches."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable

from ros_lint.base.controls import HARMFUL
from ros_lint.base.text import to_bytes


def unified(path: str, before: str | None, after: str) -> str:
    """Return the unified diff of two texts of a file, with one line of context. The line ends of the file are kept.

    ``before`` is None for a new file. The result is "" for equal texts.
    """
    return _diff(path, before, after, lambda name: name)


def _diff(path: str, before: str | None, after: str, encoded: Callable[[str], str]) -> str:
    old = "/dev/null" if before is None else _quoted(f"a/{path}")
    lines = difflib.unified_diff(_lines(before or ""), _lines(after), encoded(old), encoded(_quoted(f"b/{path}")), n=1)
    return "".join(line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n" for line in lines)


def unified_bytes(path: str, before: bytes | None, after: bytes) -> bytes:
    """Return the unified diff of two versions of a file as bytes, in any encoding; see :func:`unified`."""
    # latin-1 maps each byte to a character, because difflib compares texts.
    was = None if before is None else before.decode("latin-1")
    return _diff(path, was, after.decode("latin-1"), lambda name: to_bytes(name).decode("latin-1")).encode("latin-1")


_SPECIAL = re.compile(f'["\\\\\n\t]|{HARMFUL.pattern}')


def _quoted(name: str) -> str:
    """Return the name of a file as git writes it in a patch: in quotes, with octal escapes, if it has special characters."""
    if not _SPECIAL.search(name):
        return name
    return (
        '"'
        + "".join(chr(byte) if 32 <= byte < 127 and chr(byte) not in '"\\' else f"\\{byte:03o}" for byte in to_bytes(name))
        + '"'
    )


def _lines(text: str) -> list[str]:
    """Return the lines of a text with their line ends.

    Only line feeds end a line, as in the program ``patch``. str.splitlines() also splits at other characters, such as
    form feeds.
    """
    return re.findall(r"[^\n]*\n|[^\n]+", text)


def line_before(before: str, after: str, line: int) -> int:
    """Return the number of the line in ``before`` that corresponds to line number ``line`` of ``after``. Lines count from 1.

    For an inserted line, return the old line before it; for a line inserted at the start, return line 1.
    """
    old, new = _lines(before), _lines(after)
    for _, old_start, old_end, new_start, new_end in difflib.SequenceMatcher(None, old, new, autojunk=False).get_opcodes():
        if line - 1 < new_end:
            return max(min(old_start + line - 1 - new_start, old_end - 1), 0) + 1
    return max(len(old), 1)
