"""The XML of a manifest: elements with offsets, read by expat as catkin_pkg reads them and hardened against bombs.

catkin_pkg reads the file as UTF-8 whatever its declaration says, and resolves namespaces (reference, section A1).
Offsets count code points of the text. Nothing outside the file is looked up.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from contextlib import suppress
from typing import Final, NamedTuple
from xml.parsers import expat

from ros_lint.text import Text

MOST_DEPTH = 200
"""Deeper nesting is refused; tools that walk such a file recursively fail sooner or later."""

BLANK: Final = " \n\r\t"
"""What counts as white space around a value."""

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
    """Something wrong with the file as XML: kind, message, and the offsets of the place."""

    kind: str
    message: str
    start: int
    end: int


class Node:
    """An element. ``inner`` and ``close`` are the offsets where its content starts and ends, equal in ``<a/>``."""

    __slots__ = ("attributes", "children", "close", "end", "inner", "start", "tag")

    def __init__(self, tag: str, attributes: dict[str, str], start: int) -> None:
        self.tag = tag
        self.attributes = attributes
        self.start = start
        self.inner = self.close = self.end = -1
        self.children: list[Node] = []


class Document(NamedTuple):
    """A file as XML: the root, its children and their children; what is nested deeper only counts as content."""

    text: str
    """As expat read it. Offsets are good for the text that was given, too."""
    root: Node | None
    faults: tuple[Fault, ...]
    read: int
    """How far the file could be read: its length, or the offset where it breaks off."""


class _Refused(Exception):
    """Raised inside a handler, to stop at something that is not read for safety."""


def read(source: Text) -> Document:
    """Return the elements of a manifest. Elements that were not closed before a fault have ``end`` -1. Never raises."""
    text, faults = _as_utf8(source)
    document = _parse(text)
    if document.faults and (conflicts := _conflicts(text, document.faults[0].start)):
        # What both sides declare is the best that can be known; what else is wrong follows from the conflict.
        document = _parse(_CONFLICT.sub(lambda marker: " " * len(marker[0]), text))
        return document._replace(text=text, faults=(*faults, *conflicts))
    return document._replace(faults=(*faults, *document.faults))


def attribute(text: str, node: Node, name: str) -> tuple[int, int, int]:
    """Return the offsets of an attribute's name, of its value, and of the value's end."""
    opened = re.compile(r"<[^\s/>]+").match(text, node.start)
    at = opened.end() if opened else node.start
    while match := _ATTRIBUTE.match(text, at):
        if match[1] == name:
            group = 3 if match[2] is None else 2
            return match.start(1), match.start(group), match.end(group)
        at = match.end()
    return node.start, node.start, node.start


def value(text: str, node: Node) -> tuple[str, int, int]:
    """Return the text directly in an element as catkin_pkg takes it, and the offsets of where it stands.

    Comments, CDATA sections and the text of children do not count.
    """
    raw = text[node.inner : node.close]
    found = raw.strip(BLANK)
    if "<" not in raw and "&" not in raw:
        start = node.inner + (len(raw) - len(raw.lstrip(BLANK)) if found else 0)
        return found.replace("\r\n", "\n").replace("\r", "\n") if "\r" in found else found, start, start + len(found)
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
            if written := piece[0].strip(BLANK):
                start = node.inner + piece.start() + piece[0].index(written)
                places += (start, start + len(written))
    return "".join(parts).strip(BLANK), *((places[0], places[-1]) if places else (node.inner, node.inner))


def markup(text: str, node: Node) -> str:
    """Return the content of an element with its markup, as catkin_pkg takes description and export: "" when nothing is there."""
    raw = text[node.inner : node.close].strip(BLANK)
    if "<" not in raw:
        return value(text, node)[0]
    if any(_counts(piece) for piece in _PIECE.finditer(raw)):
        return raw.replace("\r\n", "\n").replace("\r", "\n")
    return ""


def _counts(piece: re.Match[str]) -> bool:
    """Whether a piece of content is something: neither blank text nor an empty CDATA section."""
    if piece.lastgroup in ("text", "entity"):
        return bool(_resolve(piece).strip(BLANK))
    return piece.lastgroup != "cdata" or bool(piece["cdata"])


def _resolve(piece: re.Match[str]) -> str:
    entity = piece["entity"]
    if entity is None:
        return piece[0].replace("\r\n", "\n").replace("\r", "\n")
    if entity.startswith("#"):
        return chr(int(entity[2:], 16) if entity[1] == "x" else int(entity[1:]))
    return _ENTITIES.get(entity, "")  # others come from a document type elsewhere, which nobody fetches


def _as_utf8(source: Text) -> tuple[str, tuple[Fault, ...]]:
    """Return the text as the tools read it, and a fault if they cannot."""
    text = source.text
    if source.codec not in ("utf-8", "utf-8-sig"):
        data = text.encode(source.codec)
        try:
            read_as = data.decode("utf-8")
        except UnicodeDecodeError as error:
            at = len(data[: error.start].decode(source.codec, "ignore"))
            message = f"the file is {source.codec}, but manifests are read as utf-8; save it as utf-8"
            return text, (Fault("encoding", message, at, min(at + 1, len(text))),)
        if "\0" not in read_as:  # else expat sees for itself that it is UTF-16
            text = read_as
    if not text.isascii() and (bad := re.search("[\ud800-\udfff]+", text)):
        message = "not utf-8, as which manifests are read; save the file as utf-8"
        return re.sub("[\ud800-\udfff]", "?", text), (Fault("encoding", message, bad.start(), bad.end()),)
    return text, ()


def _parse(text: str) -> Document:
    # Namespaces as in xml.dom.minidom, through which catkin_pkg reads.
    parser = expat.ParserCreate("utf-8", " ")
    parser.namespace_prefixes = True
    parser.specified_attributes = True
    data = text.encode()
    here: Callable[[], int] = _counter(parser, data) if len(data) != len(text) else lambda: parser.CurrentByteIndex
    roots: list[Node] = []
    children: list[Node] = []
    depth = 0

    def on_start(tag: str, attributes: dict[str, str]) -> None:
        nonlocal depth
        depth += 1
        if depth == 2:
            children.append(Node(tag, attributes, here()))
        elif depth == 3:
            children[-1].children.append(Node(tag, attributes, here()))
        elif depth == 1:
            roots.append(Node(tag, attributes, here()))
        elif depth > MOST_DEPTH:
            raise _Refused("too-deep", f"nested more than {MOST_DEPTH} levels deep; no manifest needs that")

    def on_end(_: str) -> None:
        nonlocal depth
        if depth == 2:
            children[-1].end = here()
        elif depth == 3:
            children[-1].children[-1].end = here()
        elif depth == 1:
            roots[0].end = here()
        depth -= 1

    def on_entity(*_: object) -> None:
        raise _Refused("entity", "declares an entity, which is not resolved here; write its text in its place")

    parser.StartElementHandler = on_start
    parser.EndElementHandler = on_end
    parser.EntityDeclHandler = on_entity
    faults: tuple[Fault, ...] = ()
    end = len(text)
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        end = len(data[: max(parser.ErrorByteIndex, 0)].decode("utf-8", "ignore"))
        faults = (_explain(text, error.code, end),)
    except _Refused as refused:
        end = here()
        faults = (Fault(*refused.args, end, min(end + 1, len(text))),)
    root = roots[0] if roots else None
    if root is not None:
        root.children = children
        for node in (root, *children, *(inner for child in children for inner in child.children)):
            _settle(text, node, end)
    return Document(text, root, faults, end)


def _counter(parser: expat.XMLParserType, data: bytes) -> Callable[[], int]:
    """Return a function that gives the parser's place in code points; the places must come in order."""
    done = count = 0

    def here() -> int:
        nonlocal done, count
        index = parser.CurrentByteIndex
        count += len(data[done:index].decode("utf-8", "ignore"))
        done = index
        return count

    return here


def _settle(text: str, node: Node, read: int) -> None:
    """Complete a node: its name as written, and where content and end tag start. expat says only where the tags start."""
    tag = node.tag
    if " " in tag:
        tag = node.tag = _qualified(tag)
    if node.attributes and " " in "".join(node.attributes):
        node.attributes = {_qualified(name): text for name, text in node.attributes.items()}
    node.inner = inner = node.start + len(tag) + 2
    if text[inner - 1 : inner] != ">":
        opened = _OPEN_TAG.match(text, node.start)
        node.inner = inner = opened.end() if opened else read
    if node.end < 0:
        node.close = max(inner, read)
    elif text[inner - 2 : inner] == "/>":
        node.close = node.end = inner
    else:
        node.close = node.end
        node.end = text.index(">", node.close) + 1


def _qualified(name: str) -> str:
    """Return a name as written, from what expat makes of it: ``uri name`` or ``uri name prefix``."""
    parts = name.split(" ")
    return f"{parts[2]}:{parts[1]}" if len(parts) == 3 else parts[-1]


def _conflicts(text: str, fault: int) -> tuple[Fault, ...]:
    """Return the merge conflicts that nobody resolved, if the first of them is what broke the file."""
    starts = [marker for marker in _CONFLICT.finditer(text) if marker[0].startswith("<")]
    if not starts or starts[0].start() > fault:
        return ()
    message = "a merge conflict was left here; keep one side and remove the marker lines"
    return tuple(Fault("merge-conflict", message, marker.start(), marker.end()) for marker in starts)


def _explain(text: str, code: int, at: int) -> Fault:
    """Return an expat error in words that say how to get out of it. ``at`` is the offset that expat gives."""
    start, end = at, min(at + 1, len(text))
    errors = expat.errors.codes
    if code == errors[expat.errors.XML_ERROR_NO_ELEMENTS]:
        if not text.strip():
            return Fault("invalid-xml", "the file is empty", 0, 0)
        message = f"the file breaks off inside {_still_open(text)}" if "<" in text else "no element found"
    elif code in (errors[expat.errors.XML_ERROR_UNCLOSED_TOKEN], errors[expat.errors.XML_ERROR_UNCLOSED_CDATA_SECTION]):
        opened = re.compile(r"<!--|<!\[CDATA\[|<\?|</?[^\s>]*|").match(text, at)
        start, end = at, len(text)
        message = f"{opened[0] if opened and opened[0] else 'a section <![CDATA['} is never closed"
    elif code == errors[expat.errors.XML_ERROR_TAG_MISMATCH]:
        name = re.compile(r"[^\s>]*").match(text, at)
        end = name.end() if name else end
        message = f"</{text[start:end]}> closes {_still_open(text)}; one of the two is misspelt or missing"
    elif code == errors[expat.errors.XML_ERROR_UNDEFINED_ENTITY]:
        end = text.index(";", at) + 1
        message = f"{text[at:end]} is not defined in xml; write the character itself"
    elif code == errors[expat.errors.XML_ERROR_JUNK_AFTER_DOC_ELEMENT]:
        message = "the file goes on after the end of its root element; remove what follows, one <package> is all there may be"
    elif code == errors[expat.errors.XML_ERROR_DUPLICATE_ATTRIBUTE]:
        message = f"the attribute {re.split('[ =]', text[at:], maxsplit=1)[0]} is there twice; remove one"
    elif code == errors[expat.errors.XML_ERROR_UNBOUND_PREFIX]:
        message = "the prefix before ':' belongs to no namespace; remove it"
    elif code == errors[expat.errors.XML_ERROR_INVALID_TOKEN] and text[at - 1 : at] in ("&", "<"):
        start, end = at - 1, at
        message = f"a bare {text[start]} is not valid in xml; write {'&amp;' if text[start] == '&' else '&lt;'}"
    else:
        message = f"invalid xml: {(expat.ErrorString(code) or 'not well-formed').lower()}"
    return Fault("invalid-xml", message, start, end)


def _still_open(text: str) -> str:
    """Return the start tag, without its attributes, that is open where the text stops to be well-formed."""
    names: list[str] = []
    parser = expat.ParserCreate("utf-8")
    parser.StartElementHandler = lambda name, _: names.append(name)
    parser.EndElementHandler = lambda _: names.pop()
    with suppress(expat.ExpatError):
        parser.Parse(text, True)
    return f"<{names[-1]}>" if names else "the file"
