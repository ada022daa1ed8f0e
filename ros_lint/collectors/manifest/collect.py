"""Reader of ``package.xml``: its contents, and the reasons why catkin_pkg would reject it."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from typing import Final

from ros_lint.base.text import Span, Text
from ros_lint.collectors.manifest.problems import ALLOWED, VERSIONS, find_problems, read_format, surely_accepted
from ros_lint.collectors.manifest.xml import BLANK, Document, Fault, XmlNode, attribute, attributes, child, markup, read, value
from ros_lint.facts.manifest import DEPENDENCY_KINDS, Depend, Element, Manifest
from ros_lint.facts.visibility import Problem

DEPENDENCY_TAGS: Final = frozenset(DEPENDENCY_KINDS)
"""The tags that become a :class:`Depend`, in any format of the manifest."""

_NEWEST_FORMAT = 3
"""The format that is assumed for a manifest of unknown format, because it has the most tags."""

_ASIDE = re.compile(r"<!--.*?-->|<\?.*?\?>|<!\[CDATA\[.*?\]\]>|[^\s<]+(?:[^\S\r\n]+[^\s<]+)*", re.DOTALL)

_PLAIN = re.compile(r"[^<&\s](?:[^<&\n]*[^<&\s])?").fullmatch

_NONE: frozenset[str] = frozenset()

_Place = Callable[[int, int], Span]

_new = tuple.__new__  # half the time of calling a named tuple


def collect(source: Text) -> Manifest:
    """Return the contents of a ``package.xml``. Never raises.

    ``problems`` lists everything for which ``catkin_pkg.package.parse_package`` rejects the file, and is empty if it
    accepts the file. The readable facts of a rejected file are returned, too. For safety, files with entity declarations, or
    with elements nested more than 200 levels deep, are rejected, although catkin_pkg accepts them.
    """
    document = read(source)
    text = Text(source.path, document.text)  # as the tools read it, if the declared encoding is wrong
    root = document.root
    if root is None or root.tag != "package":
        return _without_package(text, document)
    format_number = read_format(root)
    place = _placer(text)
    format_span = None
    if "format" in root.attributes:
        _, start, end = attribute(text.text, root, "format")
        format_span = place(start, end)
    begin = place(root.inner, root.inner)
    content = _read_children(text.path, document, root, ALLOWED.get(format_number, {}), place)
    end = root.close if root.end >= 0 else document.read
    faults = document.faults
    if faults or content.doubtful or not surely_accepted(root, format_number, content.elements, content.depends):
        faults = (*faults, *find_problems(document, root, format_number, content.elements, content.depends))
    name = next((element for element in content.elements if element.tag == "name"), None)
    return Manifest(
        text.path,
        format_number or _NEWEST_FORMAT,
        name.text if name else "",
        next((element.text for element in content.elements if element.tag == "version"), ""),
        tuple(content.elements),
        tuple(content.depends),
        tuple(content.exports),
        _problems(text, faults) if faults else (),
        name.text_span if name else text.span(root.start + 1, root.start + 1 + len(root.tag)),
        place(end, end),
        begin,
        format_span,
        tuple(content.other_contents),
        tuple(content.stray_text),
        _indent(text.text, document),
        text.newline,
        source.text,
        source.codec,
    )


class _PackageContent:
    """The children of ``<package>`` that have been read so far.

    ``doubtful`` is True if any element may have invalid attributes or children, so that :mod:`problems` has to check them.
    """

    __slots__ = ("depends", "doubtful", "elements", "exports", "other_contents", "stray_text")

    def __init__(self) -> None:
        self.elements: list[Element] = []
        self.depends: list[Depend] = []
        self.exports: list[Element] = []
        self.other_contents: list[Span] = []
        self.stray_text: list[Span] = []
        self.doubtful = False


def _read_children(
    path: str, document: Document, root: XmlNode, allowed: Mapping[str, frozenset[str]], place: _Place
) -> _PackageContent:
    content = _PackageContent()
    text, events = document.text, document.events
    count, rfind, add_depend, add_element = text.count, text.rfind, content.depends.append, content.elements.append
    plain_lines = "\r" not in text
    at, last = 1, len(events)
    line, begin, counted = 1, -1, 0
    previous_end = root.inner
    while at < last and not isinstance(event := events[at], int):
        tag, attributes, start = event
        if start != previous_end and not (gap := text[previous_end:start]).isspace():
            _read_asides(gap, previous_end, content, place)
        if plain_lines and not attributes and at + 1 < last and isinstance(close := events[at + 1], int):
            # Most elements contain only text, on one line. They are read here, at a third of the cost.
            inner = start + len(tag) + 2
            previous_end = close + len(tag) + 3
            raw = text[inner:close]
            if text[inner - 1] == ">" == text[previous_end - 1] and " " not in tag and (raw.isidentifier() or _PLAIN(raw)):
                at += 2
                if newlines := count("\n", counted, start):
                    line += newlines
                    begin = rfind("\n", counted, start)
                counted = start
                column = inner - begin
                span = _new(Span, (path, line, start - begin, line, previous_end - begin))
                name_span = _new(Span, (path, line, column, line, column + len(raw)))
                if tag in DEPENDENCY_TAGS:
                    add_depend(_new(Depend, (raw, tag, "", (), span, name_span, previous_end - close)))
                else:
                    add_element(_new(Element, (tag, raw, (), span, name_span, ())))
                continue
        node, at = child(document, at)
        previous_end = node.end if node.end >= 0 else len(text)  # else the file ends in it
        rich = node.tag in ("description", "export")
        if (node.children and not rich) or not allowed.get(node.tag, _NONE).issuperset(node.attributes):
            content.doubtful = True
        if node.end >= 0 and node.tag in DEPENDENCY_TAGS:
            content.depends.append(_depend(text, node, place))
        elif node.end >= 0:
            content.elements.append(_element(text, node, place, rich=rich))
        if node.tag == "export":
            content.exports += [
                _element(text, inner_node, place, rich=True) for inner_node in node.children if inner_node.end >= 0
            ]
    if root.end >= 0 and previous_end < root.close and not (gap := text[previous_end : root.close]).isspace():
        _read_asides(gap, previous_end, content, place)
    return content


def _read_asides(gap: str, start: int, content: _PackageContent, place: _Place) -> None:
    for aside in _ASIDE.finditer(gap):
        span = place(start + aside.start(), start + aside.end())
        content.other_contents.append(span)
        if not aside[0].startswith(("<!--", "<?")):
            content.stray_text.append(span)


def _depend(text: str, node: XmlNode, place: _Place) -> Depend:
    span = place(node.start, node.end)
    name, start, end = value(text, node)
    name_span = place(start, end)
    close = node.end - node.close
    if close > len(node.tag) + 3 and not text[node.close : node.end].isprintable():
        close = 0
    attributes = node.attributes
    versions = tuple([(key, text) for key, text in attributes.items() if key in VERSIONS])
    condition = (attributes["condition"] or " ") if "condition" in attributes else ""
    return Depend(name, node.tag, condition, versions, span, name_span, close)


def _element(text: str, node: XmlNode, place: _Place, *, rich: bool = False) -> Element:
    """Return the Element of an XML node. ``rich`` keeps the markup in its text, as catkin_pkg does for ``<description>``."""
    span = place(node.start, node.end)
    places = attributes(text, node) if node.attributes else {}
    nowhere = (node.start, node.start, node.start)
    attribute_spans = tuple([place(*places.get(name, nowhere)[1:]) for name in node.attributes])
    if rich:
        content = markup(text, node) if node.tag != "export" else ""
        inner = text[node.inner : node.close]
        start = node.inner + len(inner) - len(inner.lstrip(BLANK))
        end = max(start, node.close - len(inner) + len(inner.rstrip(BLANK)))
    else:
        content, start, end = value(text, node)
    return _new(Element, (node.tag, content, tuple(node.attributes.items()), span, place(start, end), attribute_spans))


def _placer(source: Text) -> _Place:
    """Return a function that computes the same spans as :meth:`Text.span`, but three times as fast.

    The returned function must be called with ascending offsets.
    """
    path, text = source.path, source.text
    if "\r" in text:
        return source.span
    count, rfind = text.count, text.rfind
    line, begin, at = 1, 0, 0

    def place(start: int, end: int) -> Span:
        nonlocal line, begin, at
        if newlines := count("\n", at, start):
            line += newlines
            begin = rfind("\n", at, start) + 1
        at = start
        if lines := count("\n", start, end):
            return _new(Span, (path, line, start - begin + 1, line + lines, end - rfind("\n", start, end)))
        return _new(Span, (path, line, start - begin + 1, line, end - begin + 1))

    return place


def _without_package(text: Text, document: Document) -> Manifest:
    """Return the manifest of a file that has no root ``<package>``. It has the problems of the file, and no other contents."""
    faults = list(document.faults)
    root = document.root
    start = root.start + 1 if root else 0
    place = text.span(start, start + len(root.tag) if root else 0)
    if root is not None and not faults:
        message = f"the root element is <{root.tag}>, but a manifest has <package>"
        faults.append(Fault("no-package", message, start, start + len(root.tag)))
    end = text.span(document.read, document.read)
    return Manifest(text.path, _NEWEST_FORMAT, "", "", (), (), (), _problems(text, faults), place, end)


def _problems(text: Text, faults: Iterable[Fault]) -> tuple[Problem, ...]:
    problems = [Problem(kind, message, text.span(start, end), subject=subject) for kind, message, start, end, subject in faults]
    return tuple(sorted(problems, key=lambda problem: problem.span))


def _indent(text: str, document: Document) -> str:
    """Return the indentation of the first child of ``<package>`` that begins its line, two blanks if there is none."""
    for event in document.events[1:]:
        if not isinstance(event, int):
            begin = max(text.rfind("\n", 0, event[2]), text.rfind("\r", 0, event[2])) + 1
            if begin and not text[begin : event[2]].strip(" \t"):
                return text[begin : event[2]]
    return "  "
