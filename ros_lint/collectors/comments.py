"""Finds the comments of a file, for all languages that a ROS workspace may contain.

The search is exact rather than fast, because only files that contain the marker of a suppression are searched. Strings that
look like comments are left out. In a file with syntax errors, text that may be a comment or a string is left out.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import cache
from typing import TYPE_CHECKING

from ros_lint.collectors.suffixes import HEADERS, SOURCES

if TYPE_CHECKING:
    from ros_lint.base.text import Text

Ranges = Iterator[tuple[int, int]]
"""Offset ranges of comments, from the start of the opening mark (such as ``/*``) to the end of the closing mark (``*/``)."""

_XML = {"xml", "launch", "urdf", "xacro", "sdf", "world", "srdf", "rdf", "model", "config"}
_CXX = {*(suffix[1:] for suffix in (*HEADERS, *SOURCES)), "idl", "java", "rs"}
_HASH = {"msg", "srv", "action", "toml", "sh", "bash", "ps1", "dsv"}
_YAML = {"yaml", "yml", "rviz", "repos", "pkg", "meta"}
_TEMPLATE = (".in", ".em", ".template")


def comments(text: Text) -> tuple[tuple[int, int], ...]:
    """Return the offset ranges of the comments of a file, in order; () for an unknown language."""
    find = _finder(text)
    return tuple(find(text.text)) if find else ()


def _finder(text: Text) -> Callable[[str], Ranges] | None:
    name = text.path.rpartition("/")[2].lower()
    for ending in _TEMPLATE:
        name = name.removesuffix(ending)
    extension = name.rpartition(".")[2] if "." in name else ""
    if name == "cmakelists.txt" or extension == "cmake":
        return _in_cmake
    if extension in _XML:
        return _in_xml
    if extension in _CXX:
        return _in_cxx
    if extension in _YAML:
        return _in_yaml
    if extension in _HASH:
        return _after_hash
    if extension == "cfg":
        return _in_cfg
    if extension in ("py", "pyi") or (not extension and re.match(r"#!.*python", text.text)):
        return _in_python
    return None


def _matched(pattern: re.Pattern[str], text: str) -> Ranges:
    for match in pattern.finditer(text):
        if match["comment"] is not None:
            yield match.span("comment")


@cache
def _pattern(*parts: str) -> re.Pattern[str]:
    """Return a pattern for any of ``parts``: the comments of a language, and strings, which may contain comment marks."""
    return re.compile("|".join(parts), re.DOTALL | re.MULTILINE)


def _in_xml(text: str) -> Ranges:
    # "<!--" opens a comment wherever a plain "<" would be invalid, that is outside of attributes and character data.
    return _matched(_pattern(r"<!\[CDATA\[.*?\]\]>", r"<\?.*?\?>", r"(?P<comment><!--.*?-->)"), text)


def _in_cmake(text: str) -> Ranges:
    comment = r"(?P<comment>\#\[(?P<mark>=*)\[.*?\](?P=mark)\]|\#[^\r\n]*)"
    return _matched(_pattern(r'"(?:\\.|[^"\\])*"', r"\\.", comment, r"\[(?P<bracket>=*)\[.*?\](?P=bracket)\]"), text)


def _in_cxx(text: str) -> Ranges:
    comment = r"(?P<comment>//(?:\\\r?\n|[^\r\n])*|/\*.*?\*/)"
    raw = r'R"(?P<mark>[^()\\\s]{0,16})\(.*?\)(?P=mark)"'
    character = r"'(?:\\[^\r\n]{1,10}?|[^'\\\r\n])'"  # not the quotes in 1'000'000
    return _matched(_pattern(comment, raw, r'"(?:\\.|[^"\\\r\n])*"', character), text)


def _after_hash(text: str) -> Ranges:
    quoted = r'"(?:\\.|[^"\\\r\n])*"'
    return _matched(_pattern(quoted, r"'[^'\r\n]*'", r"(?P<comment>(?<!\S)\#[^\r\n]*)"), text)


def _in_cfg(text: str) -> Ranges:
    # configparser, as setuptools uses it: a comment is alone on its line.
    return _matched(_pattern(r"^[ \t]*(?P<comment>[\#;][^\r\n]*)"), text)


def _in_python(text: str) -> Ranges:
    from ros_lint.base import python_tokens  # noqa: PLC0415  (needed for few files)

    with suppress(python_tokens.TokenError):
        yield from ((start, end) for kind, start, end in python_tokens.tokens(text) if kind == "comment")


_TO_LINE_END = re.compile(r"#[^\r\n]*")


def _in_yaml(text: str) -> Ranges:
    from ros_lint.base.safe_yaml import YamlError, tokens  # noqa: PLC0415  (needed for few files)

    try:
        ranges = tokens(text)
    except YamlError:
        yield from _after_hash(text)  # such as a template of a YAML file
        return
    at = 0
    for start, end in (*ranges, (len(text), len(text))):
        # Between two tokens there are only spaces and comments.
        yield from (match.span() for match in _TO_LINE_END.finditer(text, at, start))
        at = max(at, end)
