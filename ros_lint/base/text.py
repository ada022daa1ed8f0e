"""Texts of files, and places (spans) in these texts."""

from __future__ import annotations

import codecs
import re
from bisect import bisect_right
from collections.abc import Iterable, Iterator
from contextlib import suppress
from itertools import accumulate
from typing import NamedTuple


class Span(NamedTuple):
    """A place in a file: from a line and column to an end that is exclusive.

    Lines and columns count from 1, columns in code points. Spans sort by file, then by place. ``str(span)`` is
    ``path:line:column``.
    """

    path: str
    """Path of the file, relative to the base folder of the run, with forward slashes."""
    line: int
    """First line, from 1."""
    column: int
    """Column of the first character, from 1."""
    end_line: int
    """Last line."""
    end_column: int
    """Column after the last character."""

    def __str__(self) -> str:
        return f"{self.path}:{self.line}:{self.column}"

    def start(self) -> Span:
        """Return the empty span at the start of this span."""
        return Span(self.path, self.line, self.column, self.line, self.column)

    def end(self) -> Span:
        """Return the empty span at the end of this span."""
        return Span(self.path, self.end_line, self.end_column, self.end_line, self.end_column)

    def inner(self, text: str) -> Span | None:
        """Return the span of ``text`` without its quotes. This span must be the place of ``text``, or of ``text`` in quotes.

        Return None if this span has another length, for example because the source contains ``text`` with an escape
        sequence.
        """
        quotes, odd = divmod(self.end_column - self.column - len(text), 2)
        if self.line != self.end_line or odd or quotes not in (0, 1):
            return None
        return self._replace(column=self.column + quotes, end_column=self.end_column - quotes)

    def covers(self, span: Span) -> bool:
        """Return whether this span contains ``span`` or is equal to it."""
        return self.path == span.path and self[1:3] <= span[1:3] and span[3:5] <= self[3:5]


def file_start(path: str) -> Span:
    """Return the empty span at the start of a file, for findings about the whole file."""
    return Span(path, 1, 1, 1, 1)


_make = tuple.__new__

# str.splitlines also splits at form feeds and U+2028, which no parser here counts as line ends.
_NEWLINE = re.compile(r"\r\n|\r|\n")


class Text:
    """The text of a file, with conversions between offsets and spans.

    ``codec`` is the codec that encodes the text to the original bytes; see :func:`decode`.
    """

    __slots__ = ("_starts", "codec", "path", "text")

    def __init__(self, path: str, text: str, codec: str = "utf-8") -> None:
        self.path = path
        self.text = text
        self.codec = codec
        self._starts: list[int] | None = None

    @property
    def newline(self) -> str:
        """The first line end in the file; a line feed if the file has none."""
        match = _NEWLINE.search(self.text)
        return match[0] if match else "\n"

    @property
    def line_count(self) -> int:
        """Number of lines. After a line end at the end of the text, an empty last line counts."""
        return len(self._line_starts())

    def span(self, start: int, end: int) -> Span:
        """Return the span between two offsets, each from 0 to the length of the text."""
        starts = self._starts or self._line_starts()
        line = bisect_right(starts, start)
        before = starts[line - 1] - 1
        if line < len(starts) and end >= starts[line]:
            return Span(self.path, line, start - before, *self.position(end))
        # Nearly all spans are within a line: a tuple is created twice as fast as by the constructor.
        return _make(Span, (self.path, line, start - before, line, end - before))

    def spans(self, ranges: Iterable[tuple[int, int]]) -> Iterator[Span]:
        """Yield the spans of pairs of offsets. The pairs are sorted, and each pair is within one line.

        For a few places in a long file this is faster than :meth:`span`, because ``str.count`` counts the lines.
        """
        text, path = self.text, self.path
        if "\r" in text:
            yield from (self.span(start, end) for start, end in ranges)
            return
        count, rfind = text.count, text.rfind
        line, at, before = 1, 0, -1
        for start, end in ranges:
            if line_feeds := count("\n", at, start):
                line += line_feeds
                before = rfind("\n", at, start)
            at = start
            yield _make(Span, (path, line, start - before, line, end - before))

    def offset(self, line: int, column: int) -> int:
        """Return the offset of a line and column, which count from 1. Raises IndexError if the line does not exist."""
        return self._line_starts()[line - 1] + column - 1

    def position(self, offset: int) -> tuple[int, int]:
        """Return the line and the column of an offset. Both count from 1."""
        starts = self._line_starts()
        line = bisect_right(starts, offset)
        return line, offset - starts[line - 1] + 1

    def line(self, number: int) -> str:
        """Return the line ``number`` (from 1) without its line end. Raises IndexError if the line does not exist."""
        starts = self._line_starts()
        end = starts[number] if number < len(starts) else None
        return self.text[starts[number - 1] : end].rstrip("\r\n")

    def slice(self, span: Span) -> str:
        """Return the text that ``span`` covers in this file."""
        return self.text[self.offset(span.line, span.column) : self.offset(span.end_line, span.end_column)]

    def encode(self, text: str) -> bytes:
        """Return a changed text as bytes in the encoding of the file.

        Raises UnicodeEncodeError if the encoding lacks a character.
        """
        if self.codec == "utf-8":
            return to_bytes(text)
        return text.encode(self.codec)

    def _line_starts(self) -> list[int]:
        if self._starts is None:
            if "\r" in self.text:
                self._starts = [0, *(match.end() for match in _NEWLINE.finditer(self.text))]
            else:
                lengths = [len(line) + 1 for line in self.text.split("\n")]
                self._starts = [0, *accumulate(lengths[:-1])]
        return self._starts


# Decoding with "utf-16-be" keeps its byte order mark as the first character of the text, because "utf-16" would write
# the mark of UTF-16LE when encoding.
_BOMS = ((codecs.BOM_UTF8, "utf-8-sig"), (codecs.BOM_UTF16_LE, "utf-16"), (codecs.BOM_UTF16_BE, "utf-16-be"))
# XML 1.0, appendix F: a file without a byte order mark that begins with markup.
_XML_WIDE = (
    (re.compile(rb"(?:[ \t\r\n]\0)*<\0"), "utf-16-le"),
    (re.compile(rb"(?:\0[ \t\r\n])*\0<"), "utf-16-be"),
)
_XML_ENCODING = re.compile(rb"""\A<\?xml[^>]{0,200}?\bencoding\s*=\s*["']([A-Za-z][\w.-]*)["']""")
_PYTHON_ENCODING = re.compile(rb"\A(?:[^\n]*\n)?[ \t\f]*#[^\n]*?coding[:=][ \t]*([-\w.]+)")  # PEP 263


def decode(data: bytes) -> tuple[str, str]:
    """Return the bytes of a file as text, and the name of the codec that encodes the text to the same bytes.

    The encoding is determined by, in this order:

    * a byte order mark,
    * the first characters of XML,
    * an XML declaration or a Python coding line,
    * the default UTF-8.

    Bytes that are not UTF-8 become lone surrogates, so that no error is raised and no byte is lost.
    """
    head = data[:400]
    has_coding = b"coding" in head
    if not has_coding and data.isascii() and b"\0" not in head[:2]:
        return data.decode("ascii"), "utf-8"  # nearly every file
    for mark, codec in _BOMS:
        if data.startswith(mark):
            try:
                text = data.decode(codec)
            except UnicodeDecodeError:
                break
            return text, codec
    for begins, codec in _XML_WIDE:
        if b"\0" in head[:2] and begins.match(data):
            with suppress(UnicodeDecodeError):
                return data.decode(codec), codec
    declared = _XML_ENCODING.match(data) or (_PYTHON_ENCODING.match(data) if has_coding else None)
    if declared:
        try:
            codec = codecs.lookup(declared[1].decode("ascii")).name
            text = data.decode(codec)
            if codec == "utf-8" or text.encode(codec) == data:
                return text, codec
        except (LookupError, UnicodeError):
            pass
    return from_bytes(data), "utf-8"


def span_in(path: str, data: bytes, start: int, end: int) -> Span:
    """Return the span between two byte offsets in one line of a file. ``data`` has the bytes of the file.

    It serves searches in the bytes of files. Few files have a match, so decoding all of them would take longer.
    """
    line_start = data.rfind(b"\n", 0, start) + 1
    line = data.count(b"\n", 0, start) + 1
    column, width = (len(part.decode("utf-8", "replace")) for part in (data[line_start:start], data[start:end]))
    return Span(path, line, column + 1, line, column + 1 + width)


def to_bytes(text: str) -> bytes:
    """Return a text or a path as its bytes on disk. Lone surrogates that represent undecodable bytes become these bytes."""
    return text.encode("utf-8", "surrogateescape")


def octets(text: str) -> str:
    """Return a text with one character (U+0000 to U+00FF) for each of its bytes on disk, for matching by bytes."""
    return text if text.isascii() else to_bytes(text).decode("latin-1")


def from_bytes(data: bytes) -> str:
    """Return bytes as a text or a path: the inverse of :func:`to_bytes`."""
    return data.decode("utf-8", "surrogateescape")


def read(path: str, data: bytes) -> Text:
    """Return the bytes of the file at ``path`` as a Text; see :func:`decode`."""
    text, codec = decode(data)
    return Text(path, text, codec)
