"""Which nodes a YAML file has parameters for (``rcl_yaml_param_parser``: names of nodes, then ``ros__parameters``).

Such files are long, and a few lines of them tell: those with ``ros__parameters`` and, above, those that are indented less.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from ros_lint.facts.sources import ParameterFile

if TYPE_CHECKING:
    from ros_lint.text import Span, Text

_MARK = "ros__parameters"
_PARAMETERS = re.compile(r"^([ ]*)[\"']?ros__parameters[\"']?[ \t]*:", re.MULTILINE)
_KEY = re.compile(r"([ ]*)([\"']?)([^\s\"'#:{}\[\],&*!|>%@`-][^\"'#:{}\[\],]*?|/?\*\*?[^\"'#:{}\[\],]*?)\2[ \t]*:(?=\s|$)")
_FIRST = re.compile(r"^[ ]*[\"']?([^\s\"'#:{}\[\],&!|>%@`-][^\"'#:{}\[\]\n]*?)[\"']?[ \t]*:(?=\s)", re.MULTILINE)
_ANY = "/**"
_MOST_LINES = 20_000


def collect(source: Text) -> ParameterFile | None:
    """Return what a file says, None when it has no keys."""
    found = _collected(source)
    if found is None or "$(var" not in source.text:
        return found
    from ros_lint.collectors.launch_markup import asks  # noqa: PLC0415  (few files of parameters are filled in)

    return found._replace(asks=asks(source.text))


def _collected(source: Text) -> ParameterFile | None:
    text = source.text
    first = _FIRST.search(text)
    marks = text.count(_MARK)
    if not marks or marks == _in_comments(text):
        return None if first is None else ParameterFile(source.path, (), source.span(*first.span(1)))
    found: list[tuple[str, Span]] = []
    for match in _PARAMETERS.finditer(text):
        keys = _above(text, match.start(), len(match[1]))
        if not keys:
            break
        name = "/".join(key.strip("/") for _, _, key in keys)
        found.append((f"/{name}", source.span(*keys[-1][:2])))
    if len(found) != marks - _in_comments(text):
        # Written in another way: it may be for any node.
        found.append((_ANY, source.span(0, 0)))
    return ParameterFile(source.path, tuple(found), found[0][1] if first is None else source.span(*first.span(1)))


def _in_comments(text: str) -> int:
    return sum(_MARK in line.partition("#")[2] for line in text.splitlines() if "#" in line)


def _above(text: str, at: int, indent: int) -> list[tuple[int, int, str]]:
    """Return the keys that a line stands under, from the top: offsets and key. [] when one cannot be read."""
    found: list[tuple[int, int, str]] = []
    for _ in range(_MOST_LINES):
        if indent == 0 or at <= 0:
            break
        start = text.rfind("\n", 0, at - 1) + 1
        line = text[start : at - 1]
        at = start
        bare = line.lstrip(" ")
        if not bare.strip() or bare.startswith("#") or len(line) - len(bare) >= indent:
            continue
        key = _KEY.match(line)
        if key is None:
            return []
        indent = len(key[1])
        found.append((start + key.start(3), start + key.end(3), key[3]))
    return found[::-1] if indent == 0 else []
