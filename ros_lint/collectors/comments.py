"""Finds the comments of a file, for all languages that a ROS workspace may contain.

The search is exact rather than fast, because only files that contain the marker of a suppression are searched. Strings that
look like comments are left out. In a file with syntax errors, text that may be a comment or a string is left out.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

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
        return _CMAKE_MARKS.comments
    if extension in _XML:
        return _XML_MARKS.comments
    if extension in _CXX:
        return _CXX_MARKS.comments
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


class _Mark(NamedTuple):
    start: str
    """The first characters of the opening mark."""
    closing: str
    """The closing mark. ``%s`` is the group ``repeated`` of the opening mark: the closing mark of ``[==[`` is ``]==]``."""
    is_comment: bool
    """False for a string."""


class _Brackets(NamedTuple):
    """Comments and strings of a language that end with a mark of their own, perhaps some lines later."""

    marks: tuple[_Mark, ...]
    opening: str
    """Pattern of the opening marks. The closing mark contains the text of the group ``repeated`` again."""
    closing: str
    """Pattern of the closing marks."""
    plain: tuple[str, ...]
    """Patterns of other comments, as the group ``comment``, and of other strings."""

    def comments(self, text: str) -> Ranges:
        """Yield the comments of a text. An opening mark that is never closed counts as other text."""
        last = {match[1]: match.start() for match in _pattern(f"(?=({self.closing}))").finditer(text)}
        plain = _pattern(*self.plain)
        either = _pattern(f"(?P<opening>{self.opening})", *self.plain)
        at = 0
        while found := either.search(text, at):
            start = found.start()
            if opening := found["opening"]:
                mark = next(mark for mark in self.marks if opening.startswith(mark.start))
                closing = mark.closing.replace("%s", found["repeated"] or "")
                if last.get(closing, -1) >= found.end():
                    at = text.index(closing, found.end()) + len(closing)
                    if mark.is_comment:
                        yield start, at
                    continue
                found = plain.match(text, start)
            at = found.end() if found else start + 1
            if found and found["comment"] is not None:
                yield found.span("comment")


_QUOTED = r'"(?:\\.|[^"\\\r\n])*"?'
"""Pattern of a string, which ends with its line if it is not closed."""
_XML_MARKS = _Brackets(
    # "<!--" opens a comment wherever a plain "<" would be invalid, that is outside of attributes and character data.
    (_Mark("<!--", "-->", True), _Mark("<?", "?>", False), _Mark("<!", "]]>", False)),
    r"<!\[CDATA\[|<\?|<!--(?P<repeated>)",
    r"\]\]>|\?>|-->",
    (r"(?P<comment>(?!))",),
)
_CMAKE_MARKS = _Brackets(
    (_Mark("#", "]%s]", True), _Mark("[", "]%s]", False)),
    r"\#?\[(?P<repeated>=*)\[",
    r"\]=*\]",
    (r'"(?:\\.|[^"\\])*"', r"\\.", r"(?P<comment>\#[^\r\n]*)"),
)
_CXX_MARKS = _Brackets(
    (_Mark("/*", "*/", True), _Mark("R", ')%s"', False)),
    r'R"(?P<repeated>[^()\\\s"]{0,16})\(|/\*',
    r'\*/|\)[^()\\\s"]{0,16}"',
    # The character is not the quotes in 1'000'000.
    (r"(?P<comment>//(?:\\\r?\n|[^\r\n])*)", _QUOTED, r"'(?:\\[^\r\n]{1,10}?|[^'\\\r\n])'"),
)


def _after_hash(text: str) -> Ranges:
    return _matched(_pattern(_QUOTED, r"'[^'\r\n]*'", r"(?P<comment>(?<!\S)\#[^\r\n]*)"), text)


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
