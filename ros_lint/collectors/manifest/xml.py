"""The XML of a manifest: elements with offsets, read by expat as in catkin_pkg, but with limits and without entities.

catkin_pkg reads the file as UTF-8 in spite of its declaration, and resolves namespaces. Offsets count code points of
the text. No other file is read.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from contextlib import suppress
from typing import Final, NamedTuple
from xml.parsers import expat

from ros_lint.base.text import Text
from ros_lint.base.xml_tree import unmarked

_new = tuple.__new__  # half the time of calling a named tuple

MOST_DEPTH = 200
"""The maximum nesting of elements, because tools that read such a file recursively fail at deeper nesting."""

BLANK: Final = " \n\r\t"
"""The white space that is removed at both ends of a value."""

_CONFLICT = re.compile(r"^(?:<{7}|\|{7}|={7}|>{7})(?![<|=>])[^\r\n]*", re.MULTILINE)
_OPEN_TAG = re.compile(r"""<([^\s/>"'=]+)(?:\s+[^\s=/>"']+\s*=\s*(?:"[^"]*"|'[^']*'))*\s*(/?)>""")
_ATTRIBUTE = re.compile(r"""\s+([^\s=/>"']+)\s*=\s*(?:"([^"]*)"|'([^']*)')""")
_PIECE = re.compile(
    r"(?P<aside><!--.*?-->|<\?.*?\?>)|<!\[CDATA\[(?P<cdata>.*?)\]\]>|(?P<close></[^>]*>)"
    r"""|(?P<open><(?:[^>"']|"[^"]*"|'[^']*')*>)|&(?P<entity>[^;]*);|(?P<text>[^<&]+)""",
    re.DOTALL,
)
_ENTITIES = {"lt": "<", "gt": ">", "amp": "&", "apos": "'", "quot": '"'}


class Fault(NamedTuple):
    """An error in a manifest. ``start`` and ``end`` are the offsets of its position.

    ``subject`` is "" except for a tag or attribute that the declared format of package.xml lacks: then ``subject`` is a newer
    format that has the tag or attribute, such as "3".
    """

    kind: str
    message: str
    start: int
    end: int
    subject: str = ""


Start = tuple[str, dict[str, str], int]
"""A start tag as expat reports it: name and attributes with namespaces resolved, and offset."""

Event = Start | int
"""A start tag, or the offset at which expat reports the end of an element: at its end tag, or after ``<a/>``."""


class XmlNode(NamedTuple):
    """An XML element. ``end`` is -1 if the element is never closed.

    The content is from ``inner`` to ``close``, and is empty for ``<a/>``.
    """

    tag: str
    attributes: dict[str, str]
    start: int
    inner: int
    close: int
    end: int
    children: tuple[XmlNode, ...] = ()
    """The direct children of the element. Their own ``children`` are empty."""


class Document(NamedTuple):
    """A manifest read as XML. ``root`` is None if not even the root element could be read."""

    text: str
    """The text that expat read. Offsets in this text are valid in the original text, too."""
    events: list[Event]
    """All start tags and ends of elements, in order. The first is the start tag of the root."""
    root: XmlNode | None
    """The root without its children, see :func:`children`."""
    faults: tuple[Fault, ...]
    read: int
    """The length of the part that could be read: of the whole file, or up to the offset of the error."""


def read(source: Text) -> Document:
    """Return a manifest read as XML. Never raises: errors are listed in ``faults`` of the result."""
    text, faults = _as_utf8(source)
    document = _parse(text)
    if document.faults and (conflicts := _conflicts(text, document.faults[0].start)):
        # The declarations of both sides are the best estimate; other errors result from the conflict.
        document = _parse(_CONFLICT.sub(lambda marker: " " * len(marker[0]), text))
        return document._replace(text=text, faults=(*faults, *conflicts))
    return document._replace(faults=(*faults, *document.faults))


_START = re.compile(r"<[^\s/>]+")


def attribute(text: str, node: XmlNode, name: str) -> tuple[int, int, int]:
    """Return the offsets of an attribute's name, of its value and of the value's end.

    All of them are the start of the element if it has no such attribute.
    """
    return attributes(text, node).get(name, (node.start, node.start, node.start))


def attributes(text: str, node: XmlNode) -> Mapping[str, tuple[int, int, int]]:
    """Return the offsets of the name, of the value and of the value's end for the attributes of an element, by their names."""
    places: dict[str, tuple[int, int, int]] = {}
    start_tag = _START.match(text, node.start)
    at = start_tag.end() if start_tag else node.start
    while match := _ATTRIBUTE.match(text, at):
        group = 3 if match[2] is None else 2
        places.setdefault(match[1], (match.start(1), match.start(group), match.end(group)))
        at = match.end()
    return places


def value(text: str, node: XmlNode) -> tuple[str, int, int]:
    """Return the text of an element as catkin_pkg reads it, and the start and end offset of the text.

    Comments, CDATA sections and the text of children do not count.
    """
    raw = text[node.inner : node.close]
    stripped = raw.strip(BLANK)
    if "<" not in raw and "&" not in raw:
        start = node.inner + (len(raw) - len(raw.lstrip(BLANK)) if stripped else 0)
        return _one_newline(stripped) if "\r" in stripped else stripped, start, start + len(stripped)
    parts: list[str] = []
    places: list[int] = []
    depth = 0
    for piece in _PIECE.finditer(raw):
        if piece["open"]:
            depth += not piece["open"].endswith("/>")
        elif piece["close"]:
            depth -= 1
        elif depth == 0 and piece.lastgroup in ("text", "entity"):
            parts.append(_resolve(piece))
            if piece_text := piece[0].strip(BLANK):
                start = node.inner + piece.start() + piece[0].index(piece_text)
                places += (start, start + len(piece_text))
    return "".join(parts).strip(BLANK), *((places[0], places[-1]) if places else (node.inner, node.inner))


def markup(text: str, node: XmlNode) -> str:
    """Return the content of an element with its markup, as catkin_pkg reads ``<description>`` and ``<export>``.

    The result is "" if the content is blank.
    """
    raw = text[node.inner : node.close].replace("<![CDATA[]]>", "").strip(BLANK)  # as xml.dom.minidom does
    if "<" not in raw:
        return value(text, node)[0]
    pieces = list(_PIECE.finditer(raw))
    if not any(_counts(piece) for piece in pieces):
        return ""
    return "".join([escaped(_resolve(p)) if p.lastgroup in ("text", "entity") else _one_newline(p[0]) for p in pieces])


def escaped(text: str) -> str:
    """Return a text in which ``&``, ``<`` and ``>`` are escaped, for use as the content of an XML element."""
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


def _one_newline(text: str) -> str:
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _counts(piece: re.Match[str]) -> bool:
    """Return whether a piece of the content of an element is neither blank text nor an empty CDATA section."""
    if piece.lastgroup in ("text", "entity"):
        return bool(_resolve(piece).strip(BLANK))
    return piece.lastgroup != "cdata" or bool(piece["cdata"])


def _resolve(piece: re.Match[str]) -> str:
    entity = piece["entity"]
    if entity is None:
        return _one_newline(piece[0])
    if entity.startswith("#x"):
        return chr(int(f"0{entity[1:]}", 0))
    if entity.startswith("#"):
        return chr(int(entity[1:]))
    return _ENTITIES.get(entity, "")  # other entities are defined in an external document type, which is not fetched


def _as_utf8(source: Text) -> tuple[str, tuple[Fault, ...]]:
    """Return the text of a manifest as catkin_pkg reads it, in UTF-8, and a fault if the file is not valid UTF-8."""
    text = source.text
    if source.codec not in ("utf-8", "utf-8-sig"):
        data = text.encode(source.codec)
        try:
            read_as = data.decode("utf-8")
        except UnicodeDecodeError as error:
            at = len(data[: error.start].decode(source.codec, "ignore"))
            message = f"the file is in {source.codec}, but manifests are read as UTF-8; save it as UTF-8"
            return text, (Fault("encoding", message, at, min(at + 1, len(text))),)
        if "\0" not in read_as:  # else expat itself detects UTF-16
            text = read_as
    if not text.isascii() and (bad := re.search("[\ud800-\udfff]+", text)):
        message = "the file is not valid UTF-8, the encoding of manifests; save it as UTF-8"
        return re.sub("[\ud800-\udfff]", "?", text), (Fault("encoding", message, bad.start(), bad.end()),)
    return text, ()


def _parse(text: str) -> Document:
    data = unmarked(text.encode())
    events, fault, stopped = _events(text, data)
    if len(data) != len(text):
        events = _in_code_points(events, data)
    faults = (fault,) if fault else ()
    if not events or isinstance(first := events[0], int):
        return Document(text, [], None, faults, stopped)
    if len(events) > MOST_DEPTH and (start := _too_deep(events)) >= 0:
        message = f"the elements are nested more than {MOST_DEPTH} levels deep; remove the inner ones"
        faults = (*faults, Fault("too-deep", message, start, start + 1))
    if fault is None and isinstance(last := events[-1], int):
        root = _closed(text, first, last, ())
    else:
        root = _unclosed(text, first, stopped, ())
    return Document(text, events, root, faults, stopped)


def children(document: Document) -> list[XmlNode]:
    """Return the children of the root element. Each child contains its own children."""
    result = []
    at, last = 1, len(document.events)
    while at < last and not isinstance(document.events[at], int):
        node, at = child(document, at)
        result.append(node)
    return result


def child(document: Document, at: int) -> tuple[XmlNode, int]:
    """Return the element whose start tag is ``document.events[at]``, and the index of the event after the element's end.

    The events are the start tags and the ends of elements.
    """
    text, events, last = document.text, document.events, len(document.events)
    open_elements: list[tuple[Start, list[XmlNode]]] = []
    while at < last:
        event = events[at]
        at += 1
        if not isinstance(event, int):
            open_elements.append((event, []))
            continue
        start_event, inner_nodes = open_elements.pop()
        if not open_elements:
            return _closed(text, start_event, event, tuple(inner_nodes)), at
        if len(open_elements) == 1:
            open_elements[0][1].append(_closed(text, start_event, event, ()))
    start_event, inner_nodes = open_elements[0]
    return _unclosed(text, start_event, document.read, tuple(inner_nodes)), at


def _events(text: str, data: bytes) -> tuple[list[Event], Fault | None, int]:
    """Return the tags of an XML text, the error that stopped the parser expat (or None), and the offset where expat stopped.

    The offsets of the tags are in bytes, the offset of the stop is in characters.
    """
    # Namespaces as in xml.dom.minidom, which catkin_pkg uses.
    parser = expat.ParserCreate("utf-8", " ")
    parser.namespace_prefixes = True
    parser.specified_attributes = True
    events: list[Event] = []
    push = events.append
    parser.StartElementHandler = lambda tag, attributes: push((tag, attributes, parser.CurrentByteIndex))
    parser.EndElementHandler = lambda _: push(parser.CurrentByteIndex)
    parser.EntityDeclHandler = _refuse_entity
    fault = None
    stopped = len(text)
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        stopped = len(data[: max(parser.ErrorByteIndex, 0)].decode("utf-8", "ignore"))
        fault = _explain(text, error.code, stopped)
    except _EntityDeclaredError:
        stopped = len(data[: parser.CurrentByteIndex].decode("utf-8", "ignore"))
        message = "it declares an entity, which ros-lint does not resolve; write the text of the entity where it is used"
        fault = Fault("entity", message, stopped, text.find(">", stopped) + 1 or len(text))
    finally:
        # Parser and handlers refer to each other, and the garbage collector may be off: unfreed parsers cost more than
        # the rest.
        parser.StartElementHandler = parser.EndElementHandler = parser.EntityDeclHandler = None
    return events, fault, stopped


class _EntityDeclaredError(Exception):
    """A manifest declares an entity, which could expand without bound or read other files."""


def _refuse_entity(*_: object) -> None:
    raise _EntityDeclaredError


def _in_code_points(events: list[Event], data: bytes) -> list[Event]:
    """Return the events (start tags, and ends of elements) with their offsets converted from bytes to code points.

    The offsets must be ascending.
    """
    converted = count = 0
    result: list[Event] = []
    for event in events:
        index = event if isinstance(event, int) else event[2]
        count += len(data[converted:index].decode("utf-8", "ignore"))
        converted = index
        result.append(count if isinstance(event, int) else (event[0], event[1], count))
    return result


def _too_deep(events: list[Event]) -> int:
    """Return the offset of the first element that is nested too deep, -1 if there is none."""
    depth = 0
    for event in events:
        depth += -1 if isinstance(event, int) else 1
        if depth > MOST_DEPTH and not isinstance(event, int):
            return event[2]
    return -1


def _closed(text: str, event: Start, close: int, children: tuple[XmlNode, ...]) -> XmlNode:
    """Return the XML element of the start tag ``event``. ``close`` is the offset of its end tag."""
    tag, inner = _start_tag(text, event)
    if text[inner - 2] == "/":
        close = end = inner
    else:
        end = text.index(">", close) + 1
    return _new(XmlNode, (tag, _names(event[1]), event[2], inner, close, end, children))


def _unclosed(text: str, event: Start, read_length: int, children: tuple[XmlNode, ...]) -> XmlNode:
    tag, inner = _start_tag(text, event)
    return XmlNode(tag, _names(event[1]), event[2], inner, max(inner, read_length), -1, children)


def _start_tag(text: str, event: Start) -> tuple[str, int]:
    """Return the name in a start tag as written in the file, and the offset after the tag."""
    name, _, start = event
    inner = start + len(name) + 2
    if text[inner - 1 : inner] == ">" and " " not in name:
        return name, inner
    match = _OPEN_TAG.match(text, start)
    return (match[1], match.end()) if match else (name, len(text))


def _names(attributes: dict[str, str]) -> dict[str, str]:
    """Return attributes by their names as written in the file. expat reports a name such as ``xsi:a`` as ``uri a xsi``."""
    if not attributes or " " not in "".join(attributes):
        return attributes
    return {_qualified(name): value for name, value in attributes.items()}


def _qualified(name: str) -> str:
    """Return a name as written in the file, ``xsi:a``, from the notation of expat: ``uri a xsi``, or ``uri a``."""
    parts = name.split(" ")
    return f"{parts[2]}:{parts[1]}" if len(parts) == 3 else parts[-1]


def _conflicts(text: str, fault: int) -> tuple[Fault, ...]:
    """Return a fault for each unresolved merge conflict in a text, () if all conflicts are after the offset ``fault``.

    ``fault`` is the offset of the error that expat reports.
    """
    starts = [marker for marker in _CONFLICT.finditer(text) if marker[0].startswith("<")]
    if not starts or starts[0].start() > fault:
        return ()
    message = "unresolved merge conflict; keep one side and remove the marker lines"
    return tuple(Fault("merge-conflict", message, marker.start(), marker.end()) for marker in starts)


_MARKUP = re.compile(r"<!--.*?-->|<\?.*?\?>|<!.*?>|<([^\s>/!?]+)[^>]*>?", re.DOTALL)
"""Matches markup. Group 1 is the name of an element."""


_OPENED = re.compile(r"<!--|<!\[CDATA\[|<\?|</?[^\s>]*|")
_NAME = re.compile(r"[^\s>]*")


def _explain(text: str, code: int, at: int) -> Fault:
    """Return a fault with a message and a remedy for an error of expat. ``at`` is the offset that expat reports."""
    start, end = at, min(at + 1, len(text))
    errors = expat.errors.codes
    if code == errors[expat.errors.XML_ERROR_NO_ELEMENTS]:
        if not text.strip():
            return Fault("invalid-xml", "the file is empty", 0, 0)
        element = _still_open(text) if "<" in text else ""
        closing = f"the file ends inside {element}; close this element"
        message = closing if element.startswith("<") else "the file contains no element"
    elif code in (errors[expat.errors.XML_ERROR_UNCLOSED_TOKEN], errors[expat.errors.XML_ERROR_UNCLOSED_CDATA_SECTION]):
        if not text.startswith("<", at):
            start = max(text.rfind("<![CDATA[", 0, at), 0)
        opening = _OPENED.match(text, start)
        end = len(text)
        message = f"'{opening[0] if opening else ''}' is never closed"
    elif code == errors[expat.errors.XML_ERROR_TAG_MISMATCH]:
        name = _NAME.match(text, at)
        end = name.end() if name else end
        message = f"</{text[start:end]}> closes {_still_open(text)}; one of the two is misspelt or missing"
    elif code == errors[expat.errors.XML_ERROR_UNDEFINED_ENTITY]:
        end = text.index(";", at) + 1
        message = f"'{text[at:end]}' is not defined in XML; write the character itself"
    elif code == errors[expat.errors.XML_ERROR_JUNK_AFTER_DOC_ELEMENT]:
        message = "the file continues after the end of its root element; remove the rest, because only one <package> is allowed"
        first = next(match for match in _MARKUP.finditer(text) if match[1])
        if first[1] != "package" and text.find("<package", at) >= 0:
            message = f"<{first[1]}> comes before <package>; remove it, because only one root element is allowed"
            start, end = first.span()
    elif code == errors[expat.errors.XML_ERROR_DUPLICATE_ATTRIBUTE]:
        message = f"the attribute '{re.split('[ =]', text[at:], maxsplit=1)[0]}' is repeated; remove one"
    elif code == errors[expat.errors.XML_ERROR_UNBOUND_PREFIX]:
        message = "the prefix before ':' belongs to no namespace; remove it"
    elif code == errors[expat.errors.XML_ERROR_INVALID_TOKEN] and text[at - 1 : at] in ("&", "<"):
        start, end = at - 1, at
        if text[start] == "&":
            return Fault("bare-ampersand", "a bare '&' is not valid in XML; write '&amp;'", start, end)
        message = "a bare '<' is not valid in XML; write '&lt;'"
    else:
        message = f"invalid XML: {(expat.ErrorString(code) or 'not well-formed').lower()}"
    return Fault("invalid-xml", message, start, end)


def _still_open(text: str) -> str:
    """Return the start tag, without attributes, of the element in which expat stops, "the file" outside of elements."""
    names: list[str] = []
    parser = expat.ParserCreate("utf-8")
    parser.StartElementHandler = lambda name, _: names.append(name)
    parser.EndElementHandler = lambda _: names.pop()
    with suppress(expat.ExpatError):
        parser.Parse(text, True)
    return f"<{names[-1]}>" if names else "the file"
