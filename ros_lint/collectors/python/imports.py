"""The import statements of a Python source, found without parsing where that is safe.

In nine of ten files, each import can be read from its own line. :func:`scan` returns the imports of such files, and
None for all others, whose imports :func:`ros_lint.collectors.python.import_tree.walk` finds in the syntax tree. Where
both functions return imports, the imports are equal.
"""

from __future__ import annotations

import re
from typing import NamedTuple

from ros_lint.base.text import Text
from ros_lint.collectors.python.excerpt import block_end, is_whole
from ros_lint.collectors.python.import_tree import GUARD, Import, walk
from ros_lint.collectors.python.source_errors import NotPythonError
from ros_lint.collectors.python.syntax import parse

_IMPORT = re.compile(r"import(?=[ \t(*\\]|_module\(|orskip\(|__\()")
_MODULE = re.compile(r"[ \t]*([^\W\d]\w*(?:\.[^\W\d]\w*)*)(?:[ \t]+as[ \t]+[^\W\d]\w*)?[ \t\r]*(,|\Z)")
_FROM = re.compile(r"from[ \t]+([^\W\d]\w*(?:\.[^\W\d]\w*)*)[ \t]+\Z")
_RELATIVE = re.compile(r"from[ \t]*\.[ \t.\w]*\Z")
IMPORTED_NAMES = re.compile(r"[ \t\\\r\n]+import[ \t]*(?:\(([^()]*)\)|((?:[^\n#;\\(]|\\\r?\n)*))")
"""Matches the text after ``from module``: ``import names``. Group 1 has names in parentheses, group 2 names without."""
_TRIPLE = re.compile(r'"""|\'\'\'')
_CONTINUED = re.compile(r"\\\r?\n[ \t\f]*(?:import|from)\b")
_HEAD = re.compile(
    r"^([ \t]*)(?:(try|except|elif|else|finally)|(?:async[ \t]+)?(?:def|for|with)|class|while|match|case|if)\b[^\n]*",
    re.MULTILINE,
)
_DECIDES = re.compile(
    rf"{GUARD.pattern}"
    r"|except(?:[ \t]*:|\b[^\n]*(?:\b(?:ImportError|ModuleNotFoundError|Exception|BaseException)\b|\())"
)


# This regular expression finds the equals sign fast. The assigned name is tested only at its matches.
_OFF = re.compile(r"=[ \t]*(?:False|None|0|''|\"\")[ \t]*(?:#.*)?\r?$", re.MULTILINE)
_NAMED = re.compile(r"([^\W\d]\w*)[ \t]*(?::[^=\n]*)?")


def scan(text: str) -> list[Import] | None:
    """Return the imports of a source in textual order, None if only a parser can find them."""
    if "\r" in text and text.count("\r") != text.count("\r\n"):
        return None
    off = [match.start() for match in _OFF.finditer(text)]
    named = [_NAMED.fullmatch(text, text.rfind("\n", 0, start) + 1, start) for start in off]
    switches = {match[1] for match in named if match}
    if switches and re.search(rf"^[ \t]*(?:el)?if\b[^\n]*\b(?:{'|'.join(switches)})\b", text, re.MULTILINE):
        return None
    imports: list[Import] = []
    places: list[int] = []  # the result holds only if none of these is in a string
    blocks: _Blocks | None = None
    done = 0
    for match in _IMPORT.finditer(text):
        start = match.start()
        if start < done:
            continue
        line = text.rfind("\n", 0, start) + 1
        before = text[line:start].lstrip()
        names = _imported(text, match, before)
        if names is None:
            return None
        if not names and not (text[line] in " \t\f" and _RELATIVE.match(before)):
            continue
        places.append(line)
        if text[line] in " \t\f":
            blocks = blocks or _Blocks(text)
            around = blocks.around(line, start - len(before) - line)
            if not around or around[0].width:
                return None
            places += [block.head for block in around]
            guard = next((block for block in around if block.guards), None)
            if guard:
                statement = text[guard.start : block_end(text, guard.width, guard.head)]
                if not is_whole(statement):
                    return None
                if _DECIDES.search(statement):
                    done = guard.start + len(statement)
                    names = _fragment(statement, guard.start)
                    if names is None:
                        return None
                    while imports and imports[-1].start > guard.start:
                        imports.pop()
        imports += names
    if not places or (outside_strings(text, places) and not _CONTINUED.search(text)):
        return imports
    return None


def _imported(text: str, match: re.Match[str], before: str) -> list[Import] | None:
    """Return the imports at a match of the word ``import``, None if only a parser can find them.

    The result is [] for a relative import, and if the word does not belong to an import statement. ``before`` is the text of
    the line before the word, without indentation.
    """
    if not before:
        return _names(text, match.end())
    if before.startswith(("from ", "from\t", "from.")):
        if named := _FROM.match(before):
            return [Import(match.start() - len(before) + named.start(1), named[1], False)]
        return [] if _RELATIVE.match(before) else None
    if before[0] == "#" or (text[match.end()] in " \t(*\\" and not _may_follow(before)):
        return []
    return None


def _may_follow(before: str) -> bool:
    """Return whether an import statement may follow the text ``before`` in the same line: ``a = 1;`` or ``if a:``."""
    return before.rstrip()[-1] in ";:" or ("from" in before and (";" in before or ":" in before))


def _names(text: str, start: int) -> list[Import] | None:
    """Return the imports of ``import a.b as c, d``, None if the line contains anything else.

    ``start`` is the offset after the word ``import``.
    """
    end = text.find("\n", start)
    line = text[start : end if end >= 0 else len(text)].partition("#")[0]
    imports = []
    at = 0
    while True:
        match = _MODULE.match(line, at)
        if match is None:
            return None
        imports.append(Import(start + match.start(1), match[1], False))
        if not match[2]:
            return imports
        at = match.end()


class _Block(NamedTuple):
    width: int
    """The number of characters before the head of the block, such as ``if a:``, in its line."""
    head: int
    """The offset of the line with the head of the block."""
    start: int
    """The offset of the line with which the statement begins: for an ``except`` block, the line of ``try``."""
    guards: bool
    """True if the block may make the imports in it optional."""


class _Blocks:
    """The compound statements, such as ``if`` and ``try``, that surround the lines of a text, by their indentation.

    :meth:`around` must be called for the lines in their order.
    """

    def __init__(self, text: str) -> None:
        self._heads = _HEAD.finditer(text)
        self._next = next(self._heads, None)
        self._stack: list[_Block] = []

    def around(self, line: int, width: int) -> list[_Block]:
        """Return the blocks that contain a line, outermost first.

        ``line`` is the offset of the line, ``width`` its indentation.
        """
        while self._next and self._next.start() < line:
            self._enter(self._next)
            self._next = next(self._heads, None)
        self._leave(width)
        return self._stack

    def _leave(self, width: int) -> _Block | None:
        """Remove the blocks that are indented by ``width`` columns or more.

        Return the outermost of the removed blocks, None if no block is removed.
        """
        block = None
        while self._stack and self._stack[-1].width >= width:
            block = self._stack.pop()
        return block

    def _enter(self, head: re.Match[str]) -> None:
        width, line = len(head[1]), head.start()
        block = self._leave(width)
        continues = block is not None and block.width == width and head[2] not in (None, "try")
        start = block.start if block and continues else line
        guards = head[2] is not None or ":" not in head[0] or GUARD.search(head[0]) is not None
        self._stack.append(_Block(width, line, start, guards))


def _fragment(text: str, start: int) -> list[Import] | None:
    """Return the imports of the text of one statement, None if the text does not parse.

    The statement may be indented. ``start`` is its offset in the source, and is added to the offsets of the imports.
    """
    head = "if 1:\n" if text[0] in " \t\f" else ""
    source = Text("", head + text)
    try:
        imports = walk(source, parse(source))
    except NotPythonError:
        return None
    return [item._replace(start=item.start + start - len(head)) for item in imports]


_EXTENDS = re.compile(r"\bsys\.path(?:\.(?:append|insert|extend)[ \t]*\(|[ \t]*\+?=|\[)([^\n]*(?:\n[^\n()]*\)?)?)")
_WRITTEN = re.compile(r"""["']([^"'\n]*)["']""")


def added_folders(text: str) -> list[tuple[int, frozenset[str]]]:
    """Return where a source extends sys.path: the offset, and the folder names in the string literals of the added path.

    ``sys.path.append("../a/b")`` -> {"..", "a", "b"}. Literals that are assigned to a name in the added path count, too.
    """
    folders = []
    for match in _EXTENDS.finditer(text):
        added = match[1]
        for name in re.findall(r"\b[^\W\d]\w*\b", _WRITTEN.sub("", added)):
            added += "\n".join(re.findall(rf"^[ \t]*{name}[ \t]*=([^=\n].*)$", text, re.MULTILINE))
        parts = [part for written in _WRITTEN.findall(added) for part in written.split("/")]
        folders.append((match.start(), frozenset(parts) - {""}))
    return folders


def outside_strings(text: str, places: list[int]) -> bool:
    """Return whether all offsets in ``places`` are certainly outside of triple-quoted strings.

    ``places`` must not be empty. The result is False if the text is too unusual to decide.
    """
    places = sorted(places)
    quote = _TRIPLE.search(text, 0, places[-1])
    waiting = iter(places)
    place = next(waiting)
    while quote:
        line = text[text.rfind("\n", 0, quote.start()) + 1 : quote.start()]
        if "#" in line or "'" in line or '"' in line:
            return False  # perhaps the quotes do not begin a string
        closing = text.find(quote[0], quote.end())
        if closing < 0 or text[closing - 1] == "\\":
            return False
        while place < quote.start():
            place = next(waiting)
        if place < closing:
            return False
        quote = _TRIPLE.search(text, closing + 3, places[-1])
    return True
