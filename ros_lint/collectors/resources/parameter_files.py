"""The nodes for which a YAML file has parameters, as rcl_yaml_param_parser reads the file.

Parameter files are long, but the node names are in a few lines: above each key ``ros__parameters``, in lines that are
less indented.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from ros_lint.facts.sources import ParameterFile

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ros_lint.base.text import Span, Text

_MARK = "ros__parameters"
_LINE = re.compile(r"^([ ]*)([\"']?ros__parameters[\"']?[ \t]*:|[^\s#])", re.MULTILINE)
"""Matches a line with content.

Group 2 is the key ``ros__parameters``, after which the parameters of a node begin, or the first character of other content.
"""
# A key ends with a letter or its quote. If it could end with blanks, a long row of them would take quadratic time.
_KEY = re.compile(
    r"""([ ]*)(["'])?
    ((?:[^\s"'\#:{}\[\],&*!|>%@`-]|/?\*\*?)
      (?(2)[^"'\#:{}\[\],]*|(?:[^"'\#:{}\[\],]*[^"'\#:{}\[\], \t])?))
    (?(2)\2)[ \t]*:(?=\s|$)""",
    re.VERBOSE,
)
_FIRST = re.compile(
    r"""^[ ]*["']?
    ([^\s"'\#:{}\[\],&!|>%@`-](?:[^"'\#:{}\[\]\n]*[^"'\#:{}\[\] \t\n])?(?:[ \t]*(?=["']))?)
    ["']?[ \t]*:(?=\s)""",
    re.VERBOSE | re.MULTILINE,
)
_ANY = "/**"


def collect(source: Text) -> ParameterFile | None:
    """Return the node names and parameters in a parameter file, with their places; None if the file has no keys."""
    file = _read_nodes(source)
    if file is None or not file.nodes:
        return file
    from ros_lint.collectors.resources.parameter_values import read_values  # noqa: PLC0415  (imports the YAML library)

    values = read_values(source)
    file = file._replace(parameters=values.parameters, refusals=values.refusals)
    if "$(var" not in source.text:
        return file
    from ros_lint.collectors.launch.markup.collect import configurations_read  # noqa: PLC0415  (few parameter files have substitutions)

    return file._replace(configurations_read=configurations_read(source.text))


def _read_nodes(source: Text) -> ParameterFile | None:
    text = source.text
    first = _FIRST.search(text)
    marks = text.count(_MARK)
    if not marks or marks == _in_comments(text):
        return None if first is None else ParameterFile(source.path, (), source.span(*first.span(1)))
    result: list[tuple[str, Span]] = []
    for keys in _headings(text):
        if not keys:
            break
        name = "/".join(key.strip("/") for _, _, key in keys)
        result.append((f"/{name}", source.span(*keys[-1][:2])))
    if len(result) != marks - _in_comments(text):
        # In another notation, it may be for any node.
        result.append((_ANY, source.span(0, 0)))
    return ParameterFile(source.path, tuple(result), result[0][1] if first is None else source.span(*first.span(1)))


def _in_comments(text: str) -> int:
    return sum(_MARK in line.partition("#")[2] for line in text.splitlines() if "#" in line)


def _headings(text: str) -> Iterator[list[tuple[int, int, str]]]:
    """Yield the keys above each ``ros__parameters``, outermost first; [] if a key above it cannot be read."""
    parents: list[tuple[int, int]] = []
    for match in _LINE.finditer(text):
        indent = len(match[1])
        while parents and parents[-1][1] >= indent:
            parents.pop()
        if len(match[2]) > 1:
            keys = [_KEY.match(text, start) for start, _ in parents]
            readable = keys and not parents[0][1]
            yield [(key.start(3), key.end(3), key[3]) for key in keys if key] if readable and all(keys) else []
        parents.append((match.start(), indent))
