"""Parser of CMake files: CMakeLists.txt, ``*.cmake`` and templates (``*.cmake.in``, ``*.in.cmake``).

The result is a list of commands. The syntax is cmake-language(7) as parsed by CMake 3.25, including legacy unquoted
arguments (``-Da="b c"``). Nothing is evaluated here: see :mod:`ros_lint.collectors.cmake.evaluate`.
"""

from __future__ import annotations

import re
from typing import NamedTuple

from ros_lint.base.text import Span, Text
from ros_lint.facts.cmake import position
from ros_lint.facts.visibility import Problem

PLAIN = 0
"""Kind of an unquoted argument whose text is its value: it has no reference, escape sequence, semicolon or bracket."""
UNQUOTED = 1
"""Kind of an unquoted argument that is evaluated and split into list elements."""
QUOTED = 2
"""Kind of a quoted argument that is evaluated, but not split into list elements."""
LITERAL = 3
"""Kind of a quoted argument whose text is its value: it has no reference and no escape sequence."""
BRACKET = 4
"""Kind of a bracket argument (``[[text]]``), which is never evaluated."""
OPEN = 5
"""Kind of an opening parenthesis among the arguments."""
CLOSE = 6

Argument = tuple[str, int, int, int]
"""An argument: its text without quotes or brackets, its kind (such as PLAIN), and the offsets of its start and end.

The offsets include quotes and brackets. It is a plain tuple because a run creates very many arguments, and a plain tuple is
created much faster than a named tuple."""


class Command(NamedTuple):
    """A command call in a CMake file."""

    name: str
    """The name in lower case, because names of CMake commands are case-insensitive."""
    written: str
    """The name as it is written in the file."""
    args: tuple[Argument, ...]
    start: int
    """Offset of the name in the file."""
    end: int
    """Offset after the closing parenthesis."""
    line: int
    """The line of the name. Lines and columns count from 1."""
    column: int
    breaks: tuple[int, ...]
    """Offsets of the starts of all lines of the command except the first line."""

    def span(self, path: str, start: int, end: int) -> Span:
        """Return the span between two offsets of the command. ``path`` is the path of the file."""
        if not self.breaks:
            shift = self.column - self.start
            # Equals Span(...), but takes half the time; a run creates tens of thousands of spans.
            return tuple.__new__(Span, (path, self.line, start + shift, self.line, end + shift))
        return Span(path, *self._position(start), *self._position(end))

    def place(self, path: str) -> Span:
        """Return the span of the command's name. ``path`` is the path of the file."""
        return tuple.__new__(Span, (path, self.line, self.column, self.line, self.column + len(self.written)))

    def _position(self, offset: int) -> tuple[int, int]:
        return position(offset, self.start, self.line, self.column, self.breaks)


class ParsedScript(NamedTuple):
    """The commands and syntax errors of a CMake file. CMake runs no command of a file that has a syntax error."""

    commands: tuple[Command, ...]
    """The commands before the first syntax error."""
    problems: tuple[Problem, ...]
    set_aside: tuple[str, ...] = ()
    """Interface files in commented-out lines, as ``msg/Name``, for example ``# "msg/Name.msg"`` in a list of files."""


_SET_ASIDE = re.compile(r"""^[ \t]*\#[ \t\#"]*((?:msg|srv|action)/\w+)\.(?:msg|srv|action|idl)\b""", re.MULTILINE)

_TOKEN = re.compile(
    r"""[ \t\r\n]*(?:\#(?!\[=*\[)[^\n]*(?:\n[ \t\r\n]*|\Z))*       # spaces and line comments
    (?:([^ \t\r\n()\#"\\$;\[\0]+(?=[ \t\r\n()\#]))                 # 1: plain
    |([()])                                                         # 2: parenthesis
    |"([^"\\\0]*(?:\\[^\0][^"\\\0]*)*)"                             # 3: quoted
    |\[(=*)\[((?s:.*?))\]\4\]                                       # 4, 5: bracket argument
    |\#\[(=*)\[(?s:.*?)\]\6\]                                       # 6: bracket comment
    |(?!\[=*\[)((?:\$\([A-Za-z0-9_]*\)|[^ \t\r\n()\#"\\\0]|\\[^\0\n])      # 7: unquoted
      (?:\$\([A-Za-z0-9_]*\)|[^ \t\r\n()\#"\\\0]|\\[^\0\n]               #    with quotes inside (legacy)
        |"(?:\$\([A-Za-z0-9_]*\)|[^()\#"\\\r\n\0]|\\[^\0\n])*")*)
    |\Z
    |((?s:.)))                                                      # 8: no token
    """,
    re.VERBOSE,
)
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\Z")
_PLACEHOLDER = re.compile(r"@\w+@\Z")
_NEW_LINE = re.compile(r"\n")
_OPENING = re.compile(r"(?:[ \t\r]|#\[(=*)\[(?s:(?!\]\1\]).)*\]\1\])*\(")
"""Pattern of the text between the name of a command and its parenthesis: spaces and bracket comments."""
_MARKS = dict.fromkeys((1, 2, 3), "\ufffd")


def is_template(path: str) -> bool:
    """Return whether the name of a file is that of a template, from which configure_file() writes another file."""
    return path.endswith((".in", ".in.cmake")) or _OTHER_LANGUAGE.search(path) is not None


_OTHER_LANGUAGE = re.compile(r"\.(?:c|cc|cpp|cxx|h|hh|hpp|hxx|json|md|pc|py|sh|txt|xml|yaml|yml)\.cmake\Z")
"""Pattern of the names of templates for files of other languages, such as ``config.h.cmake``."""


def parse(source: Text) -> ParsedScript:
    """Return the commands of a CMake file, and its first syntax error if there is one."""
    return _Reader(source).read()


class _SyntaxError(Exception):
    def __init__(self, message: str, start: int, end: int) -> None:
        super().__init__(message)
        self.start = start
        self.end = end


class _Reader:
    def __init__(self, source: Text) -> None:
        self.source = source
        self.text = source.text
        self.commands: list[Command] = []

    def read(self) -> ParsedScript:
        problems: tuple[Problem, ...] = ()
        try:
            self._commands()
        except _SyntaxError as error:
            span = self.source.span(error.start, error.end)
            problems = (Problem("cmake-syntax", str(error), span),)
        text = self.text
        comments = "#" in text and (".msg" in text or ".srv" in text or ".action" in text or ".idl" in text)
        return ParsedScript(tuple(self.commands), problems, tuple(_SET_ASIDE.findall(text)) if comments else ())

    def _commands(self) -> None:
        text = self.text
        add = self.commands.append
        args: list[Argument] = []
        name = ""
        begin = end = depth = counted_to = position = 0
        last = adjoining = -1
        line, column = 1, 0
        template = is_template(self.source.path)
        has_marks = "\r" in text or "\1" in text or "\2" in text or "\3" in text
        for match in _TOKEN.finditer(text):
            position = match.end()
            group = match.lastindex
            if adjoining >= 0:  # a bracket argument or comment ends at this offset
                if group not in (None, 2, 8) and text[adjoining] not in " \t\r\n":
                    raise _SyntaxError("a space is missing between two arguments", adjoining, position)
                adjoining = -1
            if depth:
                if group == 1:
                    args.append((match[1], PLAIN, match.start(1), position))
                elif group == 3:
                    value = match[3]
                    kind = QUOTED if "$" in value or "\\" in value else LITERAL
                    args.append((value, kind, match.start(3) - 1, position))
                elif group == 7:
                    args.append((match[7], UNQUOTED, match.start(7), position))
                elif group == 2:
                    at = position - 1
                    if text[at] == "(":
                        depth += 1
                        args.append(("(", OPEN, at, position))
                        continue
                    depth -= 1
                    if depth:
                        args.append((")", CLOSE, at, position))
                        continue
                    breaks: tuple[int, ...] = ()
                    if text.find("\n", begin, position) >= 0:
                        breaks = tuple([line_end.end() for line_end in _NEW_LINE.finditer(text, begin, position)])
                    if has_marks:
                        args = [(_cleaned(value), kind, start, stop) for value, kind, start, stop in args]
                    add(Command(name.lower(), name, tuple(args), begin, position, line, column, breaks))
                    name = ""
                    last = position
                elif group == 5:
                    value = match[5]
                    if value.startswith("\n"):
                        value = value[1:]
                    elif value.startswith("\r\n"):
                        value = value[2:]
                    start = match.start(4) - 1
                    args.append((value, BRACKET, start, position))
                    if text[start - 1] not in " \t\r\n()":
                        raise _SyntaxError("a space is missing between two arguments", start, position)
                    adjoining = position
                elif group == 6:
                    adjoining = position
                elif group == 8:
                    raise self._wrong(position - 1)
            elif group == 1 or group == 7:  # noqa: PLR1714  (a tuple test is slower, and this runs for every command)
                name = match[group]
                end, begin = position, match.start(group)
                new_lines = text.count("\n", counted_to, begin)
                if last >= 0 and text.find("\n", last, begin) < 0:
                    raise _SyntaxError("a command must start on a new line", begin, end)
                if not _NAME.match(name):
                    if template and _PLACEHOLDER.match(name):
                        continue
                    raise _SyntaxError(f"'{name}' is not a valid command name", begin, end)
                line += new_lines
                column = begin - text.rfind("\n", 0, begin)
                counted_to = begin
                following = text[end : end + 1]
                if following != "(" and not self._opens(end):
                    raise _SyntaxError(f"'(' is missing after '{name}'", begin, end)
            elif group == 2 and text[position - 1] == "(" and name:
                depth = 1
                args = []
            elif group == 8:
                raise self._wrong(position - 1)
            elif group is not None and group != 6:
                raise _SyntaxError("a command is expected here", match.start(group) - (group in (3, 5)), position)
        if depth:
            raise _SyntaxError(f"')' is missing at the end of {name}()", begin, end)
        if "\r" in text:
            self._count_lines()

    def _opens(self, offset: int) -> bool:
        """Return whether an opening parenthesis follows an offset, after only spaces and bracket comments."""
        return _OPENING.match(self.text, offset) is not None

    def _wrong(self, at: int) -> _SyntaxError:
        """Return the syntax error at an offset where no token begins, with a reason such as "a string is not closed"."""
        letter = self.text[at]
        reasons = {
            '"': "a string is not closed",
            "[": "a bracket argument is not closed",
            "#": "a comment is not closed",
        }
        return _SyntaxError(reasons.get(letter, f"{letter!r} is not allowed here"), at, at + 1)

    def _count_lines(self) -> None:
        """Recount the lines of commands in a file with carriage returns, because :class:`Text` ends lines at them, too."""
        for number, command in enumerate(self.commands):
            line, column = self.source.position(command.start)
            last = self.source.position(command.end)[0]
            breaks = tuple(self.source.offset(further, 1) for further in range(line + 1, last + 1))
            self.commands[number] = command._replace(line=line, column=column, breaks=breaks)


def _cleaned(value: str) -> str:
    """Return the text of an argument with normalized line ends, and without the control characters of ``values.py``.

    These control characters are reserved for unknown pieces of values.
    """
    return value.replace("\r\n", "\n").translate(_MARKS)
