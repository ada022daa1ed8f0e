"""What makes catkin_pkg reject a manifest that is well-formed XML (reference, sections A1 and A2)."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Final

from ros_lint.collectors.manifest_xml import Document, Fault, Node, attribute
from ros_lint.facts import Depend, Element

Facts = list[tuple[Node, Element | Depend]]
"""The children of ``<package>``, each with what it says."""

VERSIONS: Final = frozenset(("version_lt", "version_lte", "version_eq", "version_gte", "version_gt"))
"""The attributes that ask for a version of the dependency (reference, section A4)."""

_NAME = re.compile(r"^[a-zA-Z0-9][a-zA-Z0-9_-]*$")
_VERSION = re.compile(r"^[0-9]+\.[0-9]+\.[0-9]+$")
_EMAIL = re.compile(r"^[-a-zA-Z0-9_%+]+(\.[-a-zA-Z0-9_%+]+)*@[-a-zA-Z0-9%]+(\.[-a-zA-Z0-9%]+)*\.[a-zA-Z]{2,}$")

_BASE = ("build_depend", "buildtool_depend", "test_depend", "conflict", "replace")
_SINCE_2 = ("build_export_depend", "buildtool_export_depend", "depend", "exec_depend", "doc_depend")
_ALIKE = {
    "name": (),
    "version": ("compatibility",),
    "description": (),
    "maintainer": ("email",),
    "license": (),
    "url": ("type",),
    "author": ("email",),
    "export": (),
}


def _allowed(form: int) -> dict[str, frozenset[str]]:
    """Return the attributes of each tag of a format."""
    tags = {tag: frozenset(names) for tag, names in _ALIKE.items()}
    condition = ("condition",) if form > 2 else ()
    of_format = ("run_depend",) if form == 1 else _SINCE_2
    tags.update(dict.fromkeys((*_BASE, *of_format), VERSIONS.union(condition)))
    if form > 2:
        tags.update(dict.fromkeys(("group_depend", "member_of_group"), frozenset(condition)))
        tags["license"] = frozenset(("file",))
    return tags


ALLOWED: Final = {form: _allowed(form) for form in (1, 2, 3)}
"""By format, the tags that may stand in ``<package>``, each with its attributes."""

_GENERIC = frozenset(("depend", "build_depend", "build_export_depend", "exec_depend"))
"""A <depend>, and the tags that it stands for."""

_NOT_ON_ITSELF = frozenset((*_SINCE_2, "build_depend", "buildtool_depend", "test_depend", "run_depend"))


def read_format(root: Node) -> int:
    """Return the format of a manifest, 0 when it is none that exists."""
    try:
        form = int(root.attributes.get("format", "1"))
    except ValueError:
        return 0
    return form if form in ALLOWED else 0


def find_problems(document: Document, root: Node, form: int, facts: Facts) -> Iterator[Fault]:
    """Yield what is wrong with the content of a manifest, in no order. ``form`` is 0 when the format is unknown.

    Of a file that could not be read to its end, nothing is said to be missing.
    """
    text = document.text
    if not form:
        _, start, end = attribute(text, root, "format")
        written = root.attributes["format"]
        yield Fault("format", f'there is no format "{written}" of package.xml; write format="3"', start, end)
    for name in root.attributes:
        if name != "format" and ":" not in name:
            yield _unknown_attribute(text, root, name, form)
    if form:
        allowed = ALLOWED[form]
        for node, _ in facts:
            attributes = allowed.get(node.tag)
            if attributes is None:
                yield _unknown_tag(node, form)
                continue
            if node.attributes and not attributes.issuperset(node.attributes):
                for name in node.attributes:
                    if name not in attributes and ":" not in name:
                        yield _unknown_attribute(text, node, name, form)
            if node.children and node.tag not in ("description", "export"):
                for child in node.children:
                    message = f"<{node.tag}> must hold text only; remove <{child.tag}>"
                    yield Fault("nested-tag", message, child.start, child.end if child.end >= 0 else document.read)
    yield from _elements(document, root, [(node, fact) for node, fact in facts if isinstance(fact, Element)])
    name = next((fact.text for node, fact in facts if node.tag == "name" and isinstance(fact, Element)), "")
    yield from _depends([(node, fact) for node, fact in facts if isinstance(fact, Depend)], name, form)


def _unknown_tag(node: Node, form: int) -> Fault:
    tag = node.tag
    if tag == "run_depend":
        way_out = "write <exec_depend>"
    elif tag == "exec_depend":
        way_out = 'write <run_depend>, or raise the format to "2" or "3"'
    elif form < 3 and tag in ALLOWED[3]:
        way_out = f'raise the format to "{2 if tag in ALLOWED[2] else 3}"'
    else:
        from difflib import get_close_matches  # noqa: PLC0415  (slow to import, and needed for a slip only)

        close = get_close_matches(tag, ALLOWED[form], 1, 0.75)
        way_out = f"did you mean <{close[0]}>?" if close else "remove it, or move it into <export>"
    return Fault("unknown-tag", f"there is no <{tag}> in format {form} of package.xml; {way_out}", node.start, node.end)


def _unknown_attribute(text: str, node: Node, name: str, form: int) -> Fault:
    start, _, end = attribute(text, node, name)
    if form < 3 and name in ALLOWED[3].get(node.tag, ()):
        message = f'the attribute {name} of <{node.tag}> needs format 3; write <package format="3">'
    else:
        message = f"<{node.tag}> has no attribute {name}; remove it"
    return Fault("unknown-attribute", message, start, min(end + 1, node.inner))


def _elements(document: Document, root: Node, elements: list[tuple[Node, Element]]) -> Iterator[Fault]:
    """Yield what is wrong with everything but the dependencies."""
    text = document.text
    seen: dict[str, Node] = {}
    for node, element in elements:
        tag = node.tag
        if tag in seen and tag in ("name", "version", "description", "export"):
            yield Fault("repeated-tag", f"there must be one <{tag}> only; remove the others", node.start, node.end)
        seen[tag] = node
        start, end = node.inner, max(node.close, node.inner)
        if tag == "name":
            if not element.text:
                yield Fault("empty-tag", "<name> is empty; write the name of the package", node.start, node.end)
            elif not _NAME.match(element.text):
                message = f'"{element.text}" is no package name; use letters, digits and underscores only'
                yield Fault("invalid-name", message, start, end)
        elif tag == "version":
            yield from _version(text, node, element)
        elif tag in ("maintainer", "author"):
            email = node.attributes.get("email")
            if email is None:
                if tag == "maintainer":
                    message = f'maintainer "{element.text}" has no email; add the attribute email'
                    yield Fault("missing-attribute", message, node.start, node.inner)
            elif not _EMAIL.match(email):
                _, start, end = attribute(text, node, "email")
                yield Fault("invalid-email", f'"{email}" is no e-mail address; write name@example.org', start, end)
        elif tag == "license":
            if not element.text.strip():
                message = "<license> is empty; name the licence, such as Apache-2.0"
                yield Fault("empty-tag", message, node.start, node.end)
        elif tag == "description" and not element.text:
            yield Fault("empty-tag", "<description> is empty; say what the package is for", node.start, node.end)
    if not document.faults:
        for tag in ("name", "version", "description", "maintainer", "license"):
            if tag not in seen:
                message = f"<package> has no <{tag}>; add it"
                yield Fault("missing-tag", message, root.start + 1, root.start + 1 + len(root.tag))


def _version(text: str, node: Node, element: Element) -> Iterator[Fault]:
    compatibility = node.attributes.get("compatibility")
    if compatibility and not _VERSION.match(compatibility):
        _, start, end = attribute(text, node, "compatibility")
        message = f'compatibility "{compatibility}" is not of the form 1.2.3; write three numbers'
        yield Fault("invalid-version", message, start, end)
    if not element.text:
        yield Fault("empty-tag", "<version> is empty; write one of the form 1.2.3", node.start, node.end)
    elif not _VERSION.match(element.text):
        message = f'version "{element.text}" is not of the form 1.2.3; write three numbers'
        start = text.find(element.text, node.inner, node.close)
        whole = (start, start + len(element.text)) if start >= 0 else (node.inner, node.close)
        yield Fault("invalid-version", message, *whole)


def _depends(depends: list[tuple[Node, Depend]], name: str, form: int) -> Iterator[Fault]:
    """Yield what is wrong with the dependencies among each other. ``name`` is the package's own."""
    generic = False
    group_depends, groups = set(), set()
    for node, depend in depends:
        if name and depend.name == name and node.tag in _NOT_ON_ITSELF:
            message = f"the package depends on itself; remove this <{node.tag}>"
            yield Fault("self-dependency", message, node.start, node.end)
        if node.tag == "depend":
            generic = True
        elif node.tag == "group_depend":
            group_depends.add(depend.name)
        elif node.tag == "member_of_group":
            groups.add(depend.name)
    if both := group_depends & groups:
        for node, depend in depends:
            if node.tag == "group_depend" and depend.name in both:
                message = f"the package depends on group {depend.name}, of which it is a member itself; remove one of the two"
                yield Fault("own-group", message, node.start, node.end)
    if form == 1:
        yield from _duplicate_tests(depends)
    elif generic:
        yield from _duplicates(depends)


def _duplicates(depends: list[tuple[Node, Depend]]) -> Iterator[Fault]:
    """Yield the dependencies that an equal <depend> holds already: equal in name, versions and condition, letter by letter."""
    kept = {_equality(node, depend): node for node, depend in reversed(depends) if node.tag == "depend"}
    for node, depend in depends:
        first = kept.get(_equality(node, depend)) if node.tag in _GENERIC else None
        if first is not None and first is not node:
            message = f"<depend>{depend.name}</depend> says the same already; remove this <{node.tag}>"
            yield Fault("duplicate-dependency", message, node.start, node.end)


def _duplicate_tests(depends: list[tuple[Node, Depend]]) -> Iterator[Fault]:
    others = {_equality(node, depend): node.tag for node, depend in depends if node.tag in ("build_depend", "run_depend")}
    for node, depend in depends:
        if node.tag == "test_depend" and (tag := others.get(_equality(node, depend))):
            message = f"<{tag}>{depend.name}</{tag}> says the same already, in format 1; remove this <test_depend>"
            yield Fault("duplicate-dependency", message, node.start, node.end)


def _equality(node: Node, depend: Depend) -> tuple[object, ...]:
    return (depend.name, node.attributes.get("condition"), frozenset(depend.versions))
