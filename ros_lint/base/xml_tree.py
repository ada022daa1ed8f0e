"""Parse XML into a tree of elements with exact offsets. Entities and external files are not resolved."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from typing import Any, Final, Protocol, TypeVar
from xml.parsers import expat

from ros_lint.base.text import from_bytes, to_bytes


class XmlError(Exception):
    """The text is not XML, or not safe to read. ``offset`` is the offset of the error in the text."""

    def __init__(self, message: str, offset: int) -> None:
        super().__init__(message)
        self.message: Final = message
        self.offset: Final = offset


class XmlElement:
    """An XML element. ``start`` is the offset of its ``<``. Comments and text between elements are not stored."""

    __slots__ = ("attributes", "children", "start", "tag")

    def __init__(self, tag: str, attributes: dict[str, str], start: int) -> None:
        self.tag = tag
        self.attributes = attributes
        self.start = start
        self.children: list[XmlElement] = []

    def walk(self) -> Iterator[XmlElement]:
        """Yield the element and its descendants in document order."""
        stack = [self]
        while stack:
            element = stack.pop()
            yield element
            stack += reversed(element.children)


_DEEPEST = 200
_ATTRIBUTE = re.compile(r"""\s+([^\s=/>"']+)\s*=\s*("[^"]*"|'[^']*')""")
_NAME = re.compile(r"<[^\s/>]+")


class _Parent(Protocol):
    @property
    def children(self) -> list[Any]: ...


_E = TypeVar("_E", bound=_Parent)


def parse(text: str) -> XmlElement:
    """Return the root element of a text. Raises XmlError if the text is not XML or declares an entity.

    Entities are rejected, because an entity could expand without limit or read other files.
    """
    return parse_as(text, XmlElement)


def parse_as(text: str, make: Callable[[str, dict[str, str], int], _E]) -> _E:
    """Return the root element of a text. ``make`` creates an element from its tag, attributes and offset.

    Raises XmlError like :func:`parse`.
    """
    data = unmarked(to_bytes(text))
    offset = _Offsets(data).of
    parser = expat.ParserCreate("utf-8")  # the text is decoded already, whatever its declaration says
    parser.buffer_text = True
    root: list[_E] = []
    open_elements: list[_E] = []

    def start(tag: str, attributes: dict[str, str]) -> None:
        if len(open_elements) > _DEEPEST:
            raise XmlError("elements are nested too deeply", offset(parser.CurrentByteIndex))
        element = make(tag, attributes, offset(parser.CurrentByteIndex))
        (open_elements[-1].children if open_elements else root).append(element)
        open_elements.append(element)

    def end(_: str) -> None:
        open_elements.pop()

    def entity(*_: object) -> None:
        raise XmlError("declares an entity, which is not resolved here", offset(parser.CurrentByteIndex))

    parser.StartElementHandler = start
    parser.EndElementHandler = end
    parser.EntityDeclHandler = entity
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        message = f"not valid XML: {expat.ErrorString(error.code) or 'not well-formed'}"
        if error.code == expat.errors.codes[expat.errors.XML_ERROR_TAG_MISMATCH]:
            message = "not valid XML: this closing tag does not belong to the open element; close that element first"
        raise XmlError(message, offset(parser.ErrorByteIndex)) from None
    return root[0]


def unmarked(data: bytes) -> bytes:
    """Replace a byte order mark at the start of ``data`` by an invalid character, so that the XML parser rejects ``data``.

    The mark is the second one of the file, because decoding has removed the first. XML forbids a second mark, but the
    parser (expat) would ignore it.
    """
    return b"\xef\xbf\xbe" + data[3:] if data.startswith(b"\xef\xbb\xbf") else data


def attribute_places(text: str, element: XmlElement) -> dict[str, tuple[int, int]]:
    """Return the start and end offset of each attribute value of an element, without the quotes, by attribute name."""
    name = _NAME.match(text, element.start)
    at = name.end() if name else element.start
    places = {}
    while match := _ATTRIBUTE.match(text, at):
        places[match[1]] = (match.start(2) + 1, match.end(2) - 1)
        at = match.end()
    return places


class _Offsets:
    """Converts byte offsets in ``data`` to character offsets. This is fast if the offsets increase."""

    __slots__ = ("_ascii", "_byte", "_character", "_data")

    def __init__(self, data: bytes) -> None:
        self._data = data
        self._ascii = data.isascii()
        self._byte = self._character = 0

    def of(self, byte: int) -> int:
        if self._ascii:
            return byte
        if byte < self._byte:
            self._byte = self._character = 0
        self._character += len(from_bytes(self._data[self._byte : byte]))
        self._byte = byte
        return self._character
