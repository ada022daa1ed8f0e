"""Python sources without the bodies of irrelevant functions, so that the parser has less to read.

A function is irrelevant if its text contains none of the words that the caller searches for. Only the head of the function
is kept, as ``def f(): pass``. The line numbers of the source do not change.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from typing import NamedTuple

_DEF = re.compile(r"^([ \t]*)((?:async[ \t]+)?def[ \t]+\w+)[ \t]*\(", re.MULTILINE)
_LEAST = 200
"""Minimum length of a function that is left out, in characters. Shorter functions are parsed as fast as they are left out."""


class Excerpt(NamedTuple):
    """The shortened text of a Python source, and the texts of the functions that were left out."""

    text: str
    omitted: tuple[str, ...]


def excerpt(text: str, words: Collection[str]) -> Excerpt:
    """Return a Python source without the bodies of the functions whose texts contain none of ``words``.

    Short functions keep their bodies.
    """
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
    """Yield start offset, end offset and head (``    def f``) of each function in a text.

    Functions within functions are omitted. Because the functions are found by a regular expression, a result may be a part of
    a string that looks like a function.
    """
    match = _DEF.search(text)
    while match:
        end = block_end(text, len(match[1]), match.end())
        yield match.start(), end, match[1] + match[2]
        match = _DEF.search(text, end)


def block_end(text: str, width: int, head: int) -> int:
    """Return the offset of the line after a compound statement that is indented by ``width`` characters.

    ``head`` is any offset in the first line of the statement. The clauses ``except``, ``elif``, ``else`` and ``finally`` belong
    to the statement.
    """
    behind = text.find("\n", head) + 1
    if not behind:
        return len(text)
    further = rf"[ \t]{{{width + 1}}}|[ \t]*(?:[#\r\n)\]}}]|(?:except|elif|else|finally)\b)"
    match = re.compile(rf"^(?!{further})", re.MULTILINE).search(text, behind)
    return match.start() if match else len(text)


def is_whole(statement: str) -> bool:
    """Return whether the text of a statement closes all its brackets and triple-quoted strings.

    The brackets and quotes are only counted, so brackets in strings count, too.
    """
    count = statement.count
    return (
        count("(") == count(")")
        and count("[") == count("]")
        and count("{") == count("}")
        and count('"""') % 2 == count("'''") % 2 == 0
        and statement.rstrip()[-1] != "\\"
    )
