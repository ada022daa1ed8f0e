"""Write JSON in which only the outermost levels are split into lines, so that versions are easy to read and compare."""

from __future__ import annotations

import json
import re
from typing import Any

from ros_lint.base.controls import HARMFUL, LOG_COMMAND

_LONE = re.compile("[\ud800-\udfff]")


def encode(value: Any, levels: int) -> str:
    """Return ``value`` as JSON, with a line feed at the end.

    Lists and mappings in the outermost ``levels`` levels have one line for each entry; deeper levels are on one line.
    Lone surrogates, which represent undecodable bytes, become U+FFFD.
    """
    return harmless(f"{_lines(value, levels, '')}\n")


def harmless(text: str) -> str:
    """Return JSON with escapes for characters that are harmful in a terminal, and for commands in the log of a build.

    Lone surrogates become U+FFFD.
    """
    return HARMFUL.sub(lambda match: f"\\u{ord(match[0]):04x}", LOG_COMMAND.sub(r"#\\u0023", _LONE.sub("\ufffd", text)))


def _lines(value: Any, levels: int, indent: str) -> str:
    if levels and isinstance(value, dict) and value:
        inner = [f"{json.dumps(key)}: {_lines(entry, levels - 1, f'{indent} ')}" for key, entry in value.items()]
        return _block("{}", inner, indent)
    if levels and isinstance(value, list) and value:
        return _block("[]", [_lines(entry, levels - 1, f"{indent} ") for entry in value], indent)
    return json.dumps(value, ensure_ascii=False, allow_nan=False)


def _block(signs: str, inner: list[str], indent: str) -> str:
    return f"{signs[0]}\n{indent} " + f",\n{indent} ".join(inner) + f"\n{indent}{signs[1]}"


def for_html(value: Any) -> str:
    """Return a value as JSON for a ``<script>`` element: it contains no ``<``, so it cannot end the element."""
    return encode(value, 0).replace("<", "\\u003c")
