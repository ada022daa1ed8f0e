"""Validation of a manifest by the XML schema of a format, with lxml."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from functools import cache
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from ros_lint.base.text import Text
from ros_lint.collectors.manifest.edits import schema_rank
from ros_lint.collectors.manifest.xml import read

if TYPE_CHECKING:
    from lxml import etree


class Violation(NamedTuple):
    """A place of a manifest that its schema does not allow."""

    kind: str
    """The violated rule as libxml2 names it, such as "ELEMENT_CONTENT", or "misplaced"; "" if libxml2 cannot read the file."""
    child: int
    """Position among the children of ``<package>``; -1 for ``<package>`` itself."""
    attribute: str
    """Name of the attribute concerned as ``name`` or ``{namespace}name``, or ""."""
    message: str
    """The words of libxml2, without a final full stop."""


_UNEXPECTED = "ELEMENT_CONTENT"

MISPLACED: Final = "misplaced"
"""The kind of an element that would be allowed at another place."""

TEXT: Final = "CVC_COMPLEX_TYPE_2_3"
"""The kind of a text where only elements are allowed."""

BAD_VALUE: Final = ("CVC_PATTERN_VALID", "CVC_DATATYPE_VALID_1_2_1", "CVC_ENUMERATION_VALID")
"""The kinds of a text or an attribute with a value that its type does not have."""


def violations(source: Text, form: int) -> tuple[Violation, ...] | None:
    """Return what the schema of a format does not allow in a manifest; empty exactly if xmllint accepts the file.

    xmllint stops at the first misplaced element. Here the elements after it are checked as well, as if all were
    sorted. None if the file is not checked: it is not well-formed, declares an entity, or is nested too deep.
    """
    if read(source).faults:
        return None
    from lxml import etree  # noqa: PLC0415  (runs without the rule must not wait for it)

    parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False, dtd_validation=False, huge_tree=False)
    try:
        root = etree.fromstring(source.encode(source.text), parser)
        children = [child for child in root if isinstance(child.tag, str)]
        found = list(_errors(root, children, form))
        if any(violation.kind == _UNEXPECTED for violation in found):
            root[:] = sorted(root, key=lambda child: schema_rank(child.tag) if isinstance(child.tag, str) else 0)
            of_sorted = list(_errors(root, children, form))
            found = [*of_sorted, *(_misplaced(violation) for violation in found if violation not in of_sorted)]
    except (etree.XMLSyntaxError, etree.XMLSchemaValidateError) as error:
        return (Violation("", -1, "", str(error).rstrip(".")),)
    # libxml2 reports some values twice, first the reason and then the type.
    first = {(violation.child, violation.attribute): violation for violation in reversed(found)}
    return tuple(sorted(first.values(), key=lambda violation: violation.child))


def _misplaced(violation: Violation) -> Violation:
    return violation._replace(kind=MISPLACED) if violation.kind == _UNEXPECTED else violation


@cache
def _schema(form: int) -> etree.XMLSchema:
    from lxml import etree  # noqa: PLC0415

    folder = os.path.dirname(os.path.abspath(__file__))
    return etree.XMLSchema(etree.parse(os.path.join(folder, f"format{form}.xsd")))


_ATTRIBUTE = re.compile(r"Element '[^']*', attribute '([^']*)'")
_STEP = re.compile(r"/[^/]+/([^/\[]+)(?:\[(\d+)\])?")


def _errors(root: etree._Element, children: list[etree._Element], form: int) -> Iterator[Violation]:
    """Yield the errors in a tree. ``children`` are the children of the root in the order of the file."""
    schema = _schema(form)
    if schema.validate(root):
        return
    log: Any = schema.error_log  # its type stubs lack the iteration
    for error in log:
        attribute = _ATTRIBUTE.match(error.message)
        child = _child_at(root, error.path or "")
        yield Violation(
            error.type_name.removeprefix("SCHEMAV_"),
            -1 if child is None else children.index(child),
            attribute[1] if attribute else "",
            error.message.rstrip(". "),
        )


def _child_at(root: etree._Element, path: str) -> etree._Element | None:
    """Return the child of the root that contains the place of an error, None for the root itself.

    libxml2 writes an element in a default namespace as ``*``.
    """
    step = _STEP.match(path)
    if step is None:
        return None
    children = [child for child in root if isinstance(child.tag, str)]
    matches = [child for child in children if step[1] in ("*", _written(child))]
    return matches[int(step[2] or 1) - 1]


def _written(element: etree._Element) -> str:
    """Return the tag as libxml2 writes it in a path."""
    name = str(element.tag).rpartition("}")[2]
    return f"{element.prefix}:{name}" if element.prefix else name if name == element.tag else "*"
