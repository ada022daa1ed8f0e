"""Names of types in C++ code: declarations, aliases of interface types, and unqualified uses."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from ros_lint.base.text import Span, span_in

if TYPE_CHECKING:
    from collections.abc import Container, Iterable, Iterator, Mapping

_BEFORE_TYPE = rb"\b(?:class|struct|union|enum(?:\s+(?:class|struct))?)\s+(?:[A-Z][A-Z0-9_]*\s+)?"
_AFTER_TYPE = rb"\s*(?:final\b|\{|:(?!:))"
_TYPE = re.compile(_BEFORE_TYPE + rb"([A-Za-z_]\w+)(?=" + _AFTER_TYPE + rb")")
_NAMESPACE = re.compile(rb"\bnamespace\s+([\w:]+)\s*\{")
_DEFINITIONS = (
    (re.compile(_BEFORE_TYPE + rb"\Z"), re.compile(_AFTER_TYPE)),
    (re.compile(rb"\busing\s+\Z"), re.compile(rb"\s*=")),
    (re.compile(rb"\bnamespace\s+(?:\w+::)*\Z"), re.compile(rb"\s*\{")),
    (re.compile(rb"\btypedef\s[^;{}]*\Z"), re.compile(rb"\s*;")),
)
"""Patterns for the text before and after a name that the code itself defines."""
_MESSAGE = rb"(?:::)?(\w+)::(?:msg|srv|action)::"
_USING = re.compile(rb"\busing\s+" + _MESSAGE + rb"(\w+)\s*;")
_ALIAS = re.compile(rb"\busing\s+(\w+)\s*=\s*(?:typename\s+)?" + _MESSAGE + rb"\w+")
_CHAIN = re.compile(rb"(?:\w+\s*::\s*)+\Z")
_MAX_CONTEXT = 120
"""Number of bytes before a name that are examined, to recognize its definition and its namespace."""
_COMMENTS_AND_STRINGS = re.compile(rb'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.DOTALL)
_MIN_LENGTH = 4
"""Length of the shortest name considered, because shorter names are too often ambiguous."""


def declared_types(text: bytes) -> frozenset[bytes]:
    """Return the names of the types that C++ code declares, without forward declarations."""
    return frozenset(name for name in _TYPE.findall(text) if len(name) >= _MIN_LENGTH)


def interface_aliases(text: bytes) -> Mapping[str, set[bytes]]:
    """Return the aliases of interface types by package: ``T`` of ``using pkg::msg::T;``, ``X`` of ``using X = pkg::msg::T;``."""
    result: dict[str, set[bytes]] = {}
    if b"using " in text:
        alias = [(package, name) for name, package in _ALIAS.findall(text)]
        for package, name in (*_USING.findall(text), *alias):
            if len(name) >= _MIN_LENGTH:
                result.setdefault(package.decode(), set()).add(name)
    return result


def namespaces(text: bytes) -> frozenset[bytes]:
    """Return the namespaces that C++ code opens; ``namespace a::b`` opens ``a`` and ``b``."""
    return frozenset(part for name in _NAMESPACE.findall(text) for part in name.split(b"::"))


def without_comments(text: bytes) -> bytes:
    """Return C++ code with blanks for comments and strings. Offsets are unchanged."""
    return _COMMENTS_AND_STRINGS.sub(_blank, text)


def _blank(match: re.Match[bytes]) -> bytes:
    return b"\n".join([b" " * len(line) for line in match[0].split(b"\n")])


def first_use(texts: Iterable[tuple[str, bytes]], name: bytes, namespaces: Container[bytes]) -> Span | None:
    """Return the first place where C++ code uses ``name`` alone, or qualified by one of ``namespaces``.

    ``texts`` are pairs of path and code. The result is None if the code does not use the name, defines it itself, or also uses
    it from a namespace that is not in ``namespaces``. If ``name`` is a namespace, only ``name::`` counts as a use.
    """
    result: Span | None = None
    for path, text in texts:
        for start in _places(text, name):
            end = start + len(name)
            before = text[max(start - _MAX_CONTEXT, 0) : start]
            if any(prefix.search(before) and suffix.match(text, end) for prefix, suffix in _DEFINITIONS):
                return None
            chain = _CHAIN.search(before)
            if chain and not any(part.strip() in namespaces for part in chain[0].split(b"::")):
                return None
            if not result and (name not in namespaces or text.startswith(b"::", end)):
                result = span_in(path, text, start, end)
    return result


def _places(text: bytes, name: bytes) -> Iterator[int]:
    """Yield the offsets at which ``name`` is a whole word. Members such as ``a.name`` are left out."""
    start = text.find(name)
    while start >= 0:
        previous, following = text[max(start - 1, 0) : start], text[start + len(name) : start + len(name) + 1]
        if not (previous.isalnum() or previous in _NAME_JOINERS or following.isalnum() or following == b"_"):
            yield start
        start = text.find(name, start + 1)


_NAME_JOINERS = (b"_", b".", b">")
"""Characters before a name that make it a part or a member of another name."""
