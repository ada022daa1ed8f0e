"""The hash by which GitHub recognizes a finding after lines above it have changed.

It is the ``primaryLocationLineHash`` of the CodeQL action (src/fingerprints.ts): a polynomial over the first hundred
UTF-16 units from the start of the line, without blanks. A number is appended to distinguish equal hashes in one file.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Collection

    from ros_lint.base.text import Text

_UNITS = 100
_BASE = 37
_MODULUS = 1 << 64
_END = b"\xff\xff"


def line_hashes(source: Text, lines: Collection[int]) -> dict[int, str]:
    """Return the hash of each line of a file whose number is in ``lines``, by number (from 1). Missing lines are left out."""
    # The file is read as UTF-8 whatever its encoding, as other tools do that compute this hash.
    text = source.encode(source.text).decode("utf-8", "replace").removeprefix("\ufeff")
    text = re.sub(r"[ \t]+", "", re.sub(r"\r\n?", "\n", text))
    units = text.encode("utf-16-le", "surrogatepass") + _END
    result: dict[int, str] = {}
    counts: dict[bytes, int] = {}
    last = max(lines, default=0)
    start = 0
    for number in range(1, last + 1):
        window = units[start : start + 2 * _UNITS]
        if not window:
            break
        counts[window] = counts.get(window, 0) + 1
        if number in lines:
            result[number] = f"{_hash(window):x}:{counts[window]}"
        start = _next_line(units, start)
        if start < 0:
            break
    return result


def _next_line(units: bytes, start: int) -> int:
    at = units.find(b"\n\x00", start)
    while at >= 0 and at % 2:
        at = units.find(b"\n\x00", at + 1)
    return at + 2 if at >= 0 else -1


def _hash(window: bytes) -> int:
    value = 0
    for index in range(0, 2 * _UNITS, 2):
        value = (value * _BASE + int.from_bytes(window[index : index + 2], "little")) % _MODULUS
    return value
