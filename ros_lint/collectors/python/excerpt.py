"""Python sources without the functions that say nothing about a question, so that the parser has less to read.

Lines keep their numbers and functions their names, of which only the bodies are gone: what is left has the same
bindings everywhere but in those bodies.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from typing import NamedTuple

_DEF = re.compile(r"^([ \t]*)((?:async[ \t]+)?def[ \t]+\w+)[ \t]*\(", re.MULTILINE)
_LEAST = 200
"""A shorter function costs as much to leave out as to read."""


class Excerpt(NamedTuple):
    """A text that is shorter than the source, and what was left out of it."""

    text: str
    omitted: tuple[str, ...]


def excerpt(text: str, words: Collection[str]) -> Excerpt:
    """Return a source without those functions that have none of some words in their text."""
    parts: list[str] = []
    omitted: list[str] = []
    done = 0
    for start, end, head in _functions(text):
        body = text[start:end]
        if len(body) >= _LEAST and is_whole(body) and not any(word in body for word in words):
            omitted.append(body)
            parts += (text[done:start], f"{head}(): pass", "\n" * body.count("\n"))
            done = end
    return Excerpt("".join([*parts, text[done:]]), tuple(omitted))


def _functions(text: str) -> Iterator[tuple[int, int, str]]:
    """Yield start, end and head of what look like functions, inner ones left out."""
    match = _DEF.search(text)
    while match:
        end = block_end(text, len(match[1]), match.end())
        yield match.start(), end, match[1] + match[2]
        match = _DEF.search(text, end)


def block_end(text: str, width: int, head: int) -> int:
    """Return where a compound statement ends whose head has some indentation; ``head`` is an offset in it."""
    behind = text.find("\n", head) + 1
    if not behind:
        return len(text)
    further = rf"[ \t]{{{width + 1}}}|[ \t]*(?:[#\r\n)\]}}]|(?:except|elif|else|finally)\b)"
    match = re.compile(rf"^(?!{further})", re.MULTILINE).search(text, behind)
    return match.start() if match else len(text)


def is_whole(statement: str) -> bool:
    """Return whether no bracket or string goes on behind the text of a statement, as far as counting tells."""
    count = statement.count
    return (
        count("(") == count(")")
        and count("[") == count("]")
        and count("{") == count("}")
        and count('"""') % 2 == count("'''") % 2 == 0
        and statement.rstrip()[-1] != "\\"
    )
