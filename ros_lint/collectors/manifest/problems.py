"""Errors for which catkin_pkg rejects a manifest, although the manifest is well-formed XML (catkin_pkg/package.py)."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from typing import Final

from ros_lint.base.suggestions import did_you_mean, similar_names
from ros_lint.collectors.manifest.xml import Document, Fault, XmlNode, attribute, attributes, children, value
from ros_lint.facts.manifest import Depend, Element

_Elements = Sequence[tuple[XmlNode, Element]]
_Depends = Sequence[tuple[XmlNode, Depend]]
"""The dependency elements in ``<package>``, each with the dependency that was read from it."""

VERSIONS: Final = frozenset(("version_lt", "version_lte", "version_eq", "version_gte", "version_gt"))
"""The attributes that restrict the version of a dependency (REP 149)."""

_NAME = re.compile(r"^[a-zA-Z0-9][a-zA-Z0-9_-]*$")
_VERSION = re.compile(r"^[0-9]+\.[0-9]+\.[0-9]+$")
_EMAIL = re.compile(r"^[-a-zA-Z0-9_%+]+(\.[-a-zA-Z0-9_%+]+)*@[-a-zA-Z0-9%]+(\.[-a-zA-Z0-9%]+)*\.[a-zA-Z]{2,}$")

_BASE = ("build_depend", "buildtool_depend", "test_depend", "conflict", "replace")
_SINCE_2 = ("build_export_depend", "buildtool_export_depend", "depend", "exec_depend", "doc_depend")
_COMMON_TAGS = {
    "name": (),
    "version": ("compatibility",),
    "description": (),
    "maintainer": ("email",),
    "license": (),
    "url": ("type",),
    "author": ("email",),
    "export": (),
}


def _allowed(format_number: int) -> dict[str, frozenset[str]]:
    """Return the allowed attributes of each tag in a format of package.xml, by tag."""
    tags = {tag: frozenset(names) for tag, names in _COMMON_TAGS.items()}
    condition = ("condition",) if format_number > 2 else ()
    of_format = ("run_depend",) if format_number == 1 else _SINCE_2
    tags.update(dict.fromkeys((*_BASE, *of_format), VERSIONS.union(condition)))
    if format_number > 2:
        tags.update(dict.fromkeys(("group_depend", "member_of_group"), frozenset(condition)))
        tags["license"] = frozenset(("file",))
    return tags


ALLOWED: Final = {format_number: _allowed(format_number) for format_number in (1, 2, 3)}
"""The tags that ``<package>`` may contain, by format, each with the attributes that the tag may have."""

_DEPEND_TAGS = frozenset(("depend", "build_depend", "build_export_depend", "exec_depend"))
"""The tag <depend>, and the tags for which <depend> is an abbreviation."""

_EXPORT_TAGS = frozenset(("build_type", "metapackage", "architecture_independent", "deprecated", "message_generator"))
"""Tags that are valid only inside of <export>."""

_TAGS_FOR_OTHERS = frozenset((*_SINCE_2, "build_depend", "buildtool_depend", "test_depend", "run_depend"))


def read_format(root: XmlNode) -> int:
    """Return the format that a manifest declares: 1 without the attribute ``format``, 0 if there is no such format."""
    try:
        format_number = int(root.attributes.get("format", "1"))
    except ValueError:
        return 0
    return format_number if format_number in ALLOWED else 0


def surely_accepted(root: XmlNode, format_number: int, elements: Sequence[Element], depends: Sequence[Depend]) -> bool:
    """Return whether the children of ``<package>`` are certainly valid, apart from their attributes and their own children.

    False means that :func:`find_problems` has to check them, which takes five times as long.
    """
    if not format_number or not root.attributes.keys() <= {"format"}:
        return False
    tags = [element.tag for element in elements]
    kinds = [depend.tag for depend in depends]
    if not ALLOWED[format_number].keys() >= {*tags, *kinds} or "group_depend" in kinds or tags.count("export") > 1:
        return False
    if not tags.count("name") == tags.count("version") == tags.count("description") == 1:
        return False
    if "maintainer" not in tags or "license" not in tags or not all(map(_is_valid, elements)):
        return False
    names = [depend.name for depend in depends]
    if elements[tags.index("name")].text in names:
        return False
    if format_number == 1:
        return "test_depend" not in kinds
    if "depend" in kinds:
        names = [depend.name for depend in depends if depend.tag in _DEPEND_TAGS]
        return len(set(names)) == len(names)
    return True


def _is_valid(element: Element) -> bool:
    """Return whether the text of an element, and the attributes that catkin_pkg checks, are certainly valid."""
    tag = element.tag
    if tag == "name":
        return bool(_NAME.match(element.text))
    if tag == "version":
        return bool(_VERSION.match(element.text)) and not element.attributes
    if tag == "license":
        return bool(element.text.strip())
    if tag == "description":
        return bool(element.text)
    if tag in ("maintainer", "author"):
        for name, text in element.attributes:
            if name == "email":
                return bool(_EMAIL.match(text))
        return tag == "author"
    return True


def find_problems(
    document: Document, root: XmlNode, format_number: int, elements: Sequence[Element], depends: Sequence[Depend]
) -> Iterator[Fault]:
    """Yield the errors for which catkin_pkg rejects a manifest, unsorted. ``format_number`` is 0 if the format is unknown.

    ``elements`` and ``depends`` are the children of the root that have an end tag. If the file could not be read to its end,
    missing elements are not reported.
    """
    nodes = [node for node in children(document) if node.end >= 0]
    dependency_tags = {depend.tag for depend in depends}
    of_elements = list(zip([node for node in nodes if node.tag not in dependency_tags], elements, strict=True))
    of_depends = list(zip([node for node in nodes if node.tag in dependency_tags], depends, strict=True))
    yield from _unknown_attributes(document.text, root, {"format"}, format_number)
    if format_number:
        for node in nodes:
            yield from _content(document, node, format_number)
    else:
        _, start, end = attribute(document.text, root, "format")
        value_text = root.attributes["format"]
        yield Fault("format", f"there is no format '{value_text}' of package.xml; write format=\"3\"", start, end)
    yield from _presence(document, root, of_elements)
    own_name = ""
    for node, element in of_elements:
        if node.tag == "name":
            own_name = own_name or element.text
        if check := _CHECKS.get(node.tag):
            yield from check(document.text, node, element)
    yield from _self_dependencies(of_depends, own_name)
    if format_number == 1:
        yield from _duplicate_tests(of_depends)
    else:
        yield from _duplicates(of_depends)


def _content(document: Document, node: XmlNode, format_number: int) -> Iterator[Fault]:
    """Yield the errors of one element: a tag, an attribute or a child that the format does not have."""
    allowed = ALLOWED[format_number].get(node.tag)
    if allowed is None:
        yield _unknown_tag(node, format_number)
        return
    yield from _unknown_attributes(document.text, node, allowed, format_number)
    if node.tag not in ("description", "export"):
        for inner_node in node.children:
            message = f"<{node.tag}> may contain only text; remove <{inner_node.tag}>"
            yield Fault("nested-tag", message, inner_node.start, inner_node.end if inner_node.end >= 0 else document.read)


def _unknown_tag(node: XmlNode, format_number: int) -> Fault:
    tag = node.tag
    newer_format = next((str(later) for later, tags in ALLOWED.items() if later > format_number and tag in tags), "")
    if tag == "run_depend":
        remedy = "write <exec_depend>"
    elif tag == "exec_depend":
        remedy = "write <run_depend>, or raise the format to 2 or 3"
    elif tag in _EXPORT_TAGS:
        remedy = "move it into <export>"
    elif newer_format:
        remedy = f"raise the format to {newer_format}"
    else:
        suggestions = [f"<{known_tag}>" for known_tag in similar_names(tag, ALLOWED[format_number], 1, 0.75)]
        remedy = did_you_mean(suggestions, "") or "remove it, or move it into <export>"
    return Fault(
        "unknown-tag",
        f"there is no <{tag}> in format {format_number} of package.xml; {remedy}",
        node.start,
        node.end,
        newer_format,
    )


def _unknown_attributes(text: str, node: XmlNode, allowed: Collection[str], format_number: int) -> Iterator[Fault]:
    unknown = [name for name in node.attributes if name not in allowed and ":" not in name]
    places = attributes(text, node) if unknown else {}
    for name in unknown:
        yield _unknown_attribute(node, name, places, format_number)


def _unknown_attribute(node: XmlNode, name: str, places: Mapping[str, tuple[int, int, int]], format_number: int) -> Fault:
    start, _, end = places.get(name, (node.start, node.start, node.start))
    newer_format = next(
        (str(later) for later, tags in ALLOWED.items() if later > format_number and name in tags.get(node.tag, ())), ""
    )
    if newer_format:
        message = f"the attribute '{name}' of <{node.tag}> needs format {newer_format}; write <package format=\"{newer_format}\">"
    else:
        message = f"<{node.tag}> has no attribute '{name}'; remove it"
    return Fault("unknown-attribute", message, start, min(end + 1, node.inner), newer_format)


def _presence(document: Document, root: XmlNode, elements: _Elements) -> Iterator[Fault]:
    """Yield an error for each required element that is missing, and for each element that occurs too often."""
    tags = [node.tag for node, _ in elements]
    for tag in ("name", "version", "description", "export"):
        if tags.count(tag) > 1:
            first = tags.index(tag)
            for node, _ in elements[first + 1 :]:
                if node.tag == tag:
                    yield Fault("repeated-tag", f"only one <{tag}> is allowed; remove the others", node.start, node.end)
    if not document.faults:
        for tag in ("name", "version", "description", "maintainer", "license"):
            if tag not in tags:
                message = f"<package> has no <{tag}>; add it"
                yield Fault("missing-tag", message, root.start + 1, root.start + 1 + len(root.tag))


def _name(text: str, node: XmlNode, element: Element) -> Iterator[Fault]:
    if not element.text:
        yield Fault("empty-tag", "<name> is empty; write the name of the package", node.start, node.end)
    elif not _NAME.match(element.text):
        message = f"'{element.text}' is not a valid package name; use only letters, digits and underscores"
        _, start, end = value(text, node)
        yield Fault("invalid-name", message, start, end)


def _version(text: str, node: XmlNode, element: Element) -> Iterator[Fault]:
    compatibility = node.attributes.get("compatibility")
    if compatibility and not _VERSION.match(compatibility):
        _, start, end = attribute(text, node, "compatibility")
        message = f"compatibility '{compatibility}' is not of the form 1.2.3; write three numbers"
        yield Fault("invalid-version", message, start, end)
    if not element.text:
        yield Fault("empty-tag", "<version> is empty; write a version of the form 1.2.3", node.start, node.end)
    elif not _VERSION.match(element.text):
        message = f"version '{element.text}' is not of the form 1.2.3; write three numbers"
        _, start, end = value(text, node)
        yield Fault("invalid-version", message, start, end)


def _description(_: str, node: XmlNode, element: Element) -> Iterator[Fault]:
    if not element.text:
        yield Fault("empty-tag", "<description> is empty; describe the package", node.start, node.end)


def _person(text: str, node: XmlNode, element: Element) -> Iterator[Fault]:
    email = node.attributes.get("email")
    if email is None:
        if node.tag == "maintainer":
            message = f"maintainer '{element.text}' has no email; add the attribute 'email'"
            yield Fault("missing-attribute", message, node.start, node.inner)
    elif not _EMAIL.match(email):
        _, start, end = attribute(text, node, "email")
        yield Fault("invalid-email", f"'{email}' is not an e-mail address; write an address such as name@example.org", start, end)


def _license(_: str, node: XmlNode, element: Element) -> Iterator[Fault]:
    if not element.text.strip():
        yield Fault("empty-tag", "<license> is empty; name the licence, e.g. Apache-2.0", node.start, node.end)


_CHECKS: dict[str, Callable[[str, XmlNode, Element], Iterator[Fault]]] = {
    "name": _name,
    "version": _version,
    "description": _description,
    "maintainer": _person,
    "author": _person,
    "license": _license,
}


def _self_dependencies(depends: _Depends, own_name: str) -> Iterator[Fault]:
    """Yield an error for each dependency of the package on itself, or on a group of which it is a member."""
    for node, depend in depends:
        if depend.name == own_name and own_name and node.tag in _TAGS_FOR_OTHERS:
            message = f"the package depends on itself; remove this <{node.tag}>"
            yield Fault("self-dependency", message, node.start, node.end)
        elif node.tag == "group_depend" and any(
            sibling.tag == "member_of_group" and sibling.name == depend.name for _, sibling in depends
        ):
            message = f"the package depends on the group '{depend.name}', of which it is a member; remove one of the two tags"
            yield Fault("own-group", message, node.start, node.end)


def _duplicates(depends: _Depends) -> Iterator[Fault]:
    """Yield an error for each dependency that repeats a ``<depend>`` with the same name, versions and condition."""
    first_depends = {_equality(node, depend): node for node, depend in reversed(depends) if node.tag == "depend"}
    if not first_depends:
        return
    for node, depend in depends:
        first = first_depends.get(_equality(node, depend)) if node.tag in _DEPEND_TAGS else None
        if first is not None and first is not node:
            message = f"'{depend.name}' is already declared as <depend>; remove this <{node.tag}>"
            yield Fault("duplicate-dependency", message, node.start, node.end)


def _duplicate_tests(depends: _Depends) -> Iterator[Fault]:
    build_tags = {_equality(node, depend): node.tag for node, depend in depends if node.tag in ("build_depend", "run_depend")}
    for node, depend in depends:
        if node.tag == "test_depend" and (tag := build_tags.get(_equality(node, depend))):
            message = f"<{tag}>{depend.name}</{tag}> covers tests too in format 1; remove this <test_depend>"
            yield Fault("duplicate-dependency", message, node.start, node.end)


def _equality(node: XmlNode, depend: Depend) -> tuple[object, ...]:
    return (depend.name, node.attributes.get("condition"), frozenset(depend.versions)) if node.attributes else (depend.name,)
