"""Read ``package.xml``: what it says, and why catkin_pkg would not take it."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Final

from ros_lint.collectors.manifest_problems import VERSIONS, Facts, find_problems, read_format
from ros_lint.collectors.manifest_xml import BLANK, Document, Fault, Node, attribute, markup, read, value
from ros_lint.facts import ROLES, Depend, Element, Manifest, Problem
from ros_lint.text import Span, Text

DEPENDENCY_TAGS: Final = frozenset((*ROLES, "doc_depend", "conflict", "replace", "group_depend", "member_of_group"))
"""The tags that become a :class:`Depend`, whatever the format of the manifest (reference, section A1.4)."""

_NEWEST_FORMAT = 3
"""Taken for a manifest whose format is not known: it has the most tags."""

_ASIDE = re.compile(r"<!--.*?-->|<\?.*?\?>|<!\[CDATA\[.*?\]\]>|[^\s<]+(?:[^\S\r\n]+[^\s<]+)*", re.DOTALL)

_Place = Callable[[int, int], Span]


def collect(source: Text) -> Manifest:
    """Return what a ``package.xml`` says. Never raises.

    ``problems`` holds everything for which ``catkin_pkg.package.parse_package`` rejects the file, and is empty when it takes
    it (reference, sections A1 and A2); a rejected file gives the facts that can be read all the same. For safety two things
    are refused that catkin_pkg would take: entity declarations, and elements nested more than 200 levels deep.
    """
    document = read(source)
    text = Text(source.path, document.text)  # as the tools read it, should the declared encoding have led astray
    root = document.root
    if root is None or root.tag != "package":
        return _no_package(text, document)
    place = _placer(text)
    form = read_format(root)
    format_span = None
    if "format" in root.attributes:
        _, start, end = attribute(text.text, root, "format")
        format_span = place(start, end)
    begin = place(root.inner, root.inner)
    facts, exports, asides = _read_children(text.text, root, place)
    ended = root.close if root.end >= 0 else document.read
    end_span = text.span(ended, ended)
    faults = [*document.faults, *find_problems(document, root, form, facts)]
    names = [(fact.text, fact.text_span) for node, fact in facts if node.tag == "name" and isinstance(fact, Element)]
    versions = [fact.text for node, fact in facts if node.tag == "version" and isinstance(fact, Element)]
    return Manifest(
        text.path,
        form or _NEWEST_FORMAT,
        names[0][0] if names else "",
        versions[0] if versions else "",
        tuple([fact for _, fact in facts if isinstance(fact, Element)]),
        tuple([fact for _, fact in facts if isinstance(fact, Depend)]),
        exports,
        _problems(text, faults) if faults else (),
        names[0][1] if names else text.span(root.start + 1, root.start + 1 + len(root.tag)),
        end_span,
        begin,
        format_span,
        asides,
        _indent(text.text, root),
        text.newline,
    )


def _read_children(text: str, root: Node, place: _Place) -> tuple[Facts, tuple[Element, ...], tuple[Span, ...]]:
    """Return the children of the root with what they say, those of ``<export>``, and all that stands between them."""
    facts: Facts = []
    exports: list[Element] = []
    asides: list[Span] = []
    done = root.inner
    for child in root.children:
        if child.start != done and not (gap := text[done : child.start]).isspace():
            asides += [place(done + found.start(), done + found.end()) for found in _ASIDE.finditer(gap)]
        done = child.end
        if child.end < 0:  # the file breaks off in it
            done = len(text)
        elif child.tag in DEPENDENCY_TAGS:
            facts.append((child, _depend(text, child, place)))
        else:
            facts.append((child, _element(text, child, place, rich=child.tag in ("description", "export"))))
        if child.tag == "export":
            exports += [_element(text, inner, place, rich=True) for inner in child.children if inner.end >= 0]
    if root.end >= 0 and done < root.close and not (gap := text[done : root.close]).isspace():
        asides += [place(done + found.start(), done + found.end()) for found in _ASIDE.finditer(gap)]
    return facts, tuple(exports), tuple(asides)


def _depend(text: str, node: Node, place: _Place) -> Depend:
    span = place(node.start, node.end)
    name, start, end = value(text, node)
    name_span = place(start, end)
    close = node.end - node.close
    if close > len(node.tag) + 3 and not text[node.close : node.end].isprintable():
        close = 0
    attributes = node.attributes
    if not attributes:
        return Depend(name, node.tag, "", (), span, name_span, close)
    versions = tuple([(key, text) for key, text in attributes.items() if key in VERSIONS])
    condition = (attributes["condition"] or " ") if "condition" in attributes else ""
    return Depend(name, node.tag, condition, versions, span, name_span, close)


def _element(text: str, node: Node, place: _Place, *, rich: bool) -> Element:
    """``rich`` elements have their markup as text, as catkin_pkg has it."""
    span = place(node.start, node.end)
    found, start, end = value(text, node)
    if rich:
        found = markup(text, node)
        inner = text[node.inner : node.close]
        start = node.inner + len(inner) - len(inner.lstrip(BLANK))
        end = max(start, node.close - len(inner) + len(inner.rstrip(BLANK)))
    return Element(node.tag, found, tuple(node.attributes.items()), span, place(start, end))


def _no_package(text: Text, document: Document) -> Manifest:
    """Return the manifest of a file that has no ``<package>``."""
    faults = list(document.faults)
    root = document.root
    start = root.start + 1 if root else 0
    place = text.span(start, start + len(root.tag) if root else 0)
    if root is not None:
        message = f"the root element is <{root.tag}>, but a manifest has <package>"
        faults.append(Fault("no-package", message, start, start + len(root.tag)))
    end = text.span(document.read, document.read)
    return Manifest(text.path, _NEWEST_FORMAT, "", "", (), (), (), _problems(text, faults), place, end)


def _problems(text: Text, faults: list[Fault]) -> tuple[Problem, ...]:
    found = [Problem(fault.kind, fault.message, text.span(fault.start, fault.end)) for fault in faults]
    return tuple(sorted(found, key=lambda problem: problem.span))


def _indent(text: str, root: Node) -> str:
    """Return the white space before the first child that begins its line."""
    for child in root.children:
        begin = max(text.rfind("\n", 0, child.start), text.rfind("\r", 0, child.start)) + 1
        if begin > root.start and not text[begin : child.start].strip(" \t"):
            return text[begin : child.start]
    return "  "


def _placer(text: Text) -> _Place:
    """Return :meth:`Text.span` for places that come in the order of their starts, which then costs a third."""
    path, content = text.path, text.text
    if "\r" in content:
        return text.span
    line, begin, at = 1, 0, 0

    def place(start: int, end: int) -> Span:
        nonlocal line, begin, at
        if passed := content.count("\n", at, start):
            line += passed
            begin = content.rfind("\n", at, start) + 1
        at = start
        if inside := content.count("\n", start, end):
            return Span(path, line, start - begin + 1, line + inside, end - content.rfind("\n", start, end))
        return Span(path, line, start - begin + 1, line, end - begin + 1)

    return place
