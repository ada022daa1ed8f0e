"""Validation of a manifest with the XML schema of its format, by lxml."""

from __future__ import annotations

import codecs
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
    """An element or attribute of a manifest that the schema does not allow."""

    kind: str
    """The violated rule as libxml2 calls it, such as "ELEMENT_CONTENT", or MISPLACED; "" if libxml2 cannot read the file."""
    child: int
    """The position of the element among the children of ``<package>``, from 0; -1 for ``<package>`` itself."""
    attribute: str
    """The name of the wrong attribute as ``name`` or ``{namespace}name``, "" if no attribute is wrong."""
    message: str
    """The message of libxml2, without the full stop at its end."""


MOST_CHARACTERS: Final = 100_000
"""Size limit of a validated manifest. libxml2 takes quadratic time for many errors; real manifests have 5,000 characters."""

_UNEXPECTED = "ELEMENT_CONTENT"

MISPLACED: Final = "misplaced"
"""The kind of the violation by an element that would be allowed at another place."""

TEXT: Final = "CVC_COMPLEX_TYPE_2_3"
"""The kind of the violation by a text where only elements are allowed."""

BAD_VALUE: Final = ("CVC_PATTERN_VALID", "CVC_DATATYPE_VALID_1_2_1", "CVC_ENUMERATION_VALID")
"""The kinds of the violation by a text or an attribute whose value its type does not allow."""


def violations(source: Text, form: int) -> tuple[Violation, ...] | None:
    """Return the elements and attributes of a manifest that the schema of a format does not allow.

    ``form`` is the number of the format. The result is empty exactly if xmllint accepts the file. xmllint stops at the
    first misplaced element; this function also checks the elements after it, as if all elements were sorted.
    The result is None if the file is not checked: it is not well-formed, declares an entity, is too large or nested too
    deep, or is in UTF-16, which versions of xmllint read differently.
    """
    if len(source.text) > MOST_CHARACTERS or source.codec.startswith("utf-16") or read(source).faults:
        return None
    if message := _misdeclared_encoding(source):
        return (Violation("", -1, "", message),)
    from lxml import etree  # noqa: PLC0415  (runs without the rule must not wait for it)

    try:
        root = _parse(source.encode(source.text))
        children = [child for child in root if isinstance(child.tag, str)]
        found = list(_errors(root, children, form))
        if any(violation.kind == _UNEXPECTED for violation in found):
            root[:] = sorted(root, key=lambda child: schema_rank(child.tag) if isinstance(child.tag, str) else 0)
            of_sorted = dict.fromkeys(_errors(root, children, form))
            found = [*of_sorted, *(_misplaced(violation) for violation in found if violation not in of_sorted)]
    except etree.XMLSyntaxError as error:
        return (Violation("", -1, "", " ".join(error.msg.split())),)
    except etree.XMLSchemaValidateError as error:
        return (Violation("", -1, "", str(error).rstrip(".")),)
    # libxml2 reports some values twice, first the reason and then the type.
    first = {(violation.child, violation.attribute): violation for violation in reversed(found)}
    return tuple(sorted(first.values(), key=lambda violation: violation.child))


def _misplaced(violation: Violation) -> Violation:
    return violation._replace(kind=MISPLACED) if violation.kind == _UNEXPECTED else violation


_DECLARED = re.compile(r"""<\?xml\b[^>]*?\bencoding\s*=\s*["']([^"']*)""")


def _misdeclared_encoding(source: Text) -> str:
    """Return an error message if a file in UTF-8 with a byte order mark declares a contradicting encoding, else "".

    The xmllint of Ubuntu 22.04 and 24.04 reads such a file in the declared encoding. Newer versions ignore the declaration.
    """
    declared = _DECLARED.match(source.text) if source.codec == "utf-8-sig" else None
    if declared is None:
        return ""
    try:
        codec = codecs.lookup(declared[1]).name
        source.text.encode().decode(codec)
    except (LookupError, UnicodeDecodeError):
        codec = ""
    if codec and not codec.startswith(("utf-16", "utf-32")):
        return ""
    return f"the declared encoding '{declared[1]}' contradicts the byte order mark of UTF-8"


def _parse(data: bytes) -> etree._Element:
    """Return the root element of an XML file, as xmllint reads it. Raises XMLSyntaxError."""
    from lxml import etree  # noqa: PLC0415  (runs without the rule must not wait for it)

    parser = _parser(recover=False)
    try:
        return etree.fromstring(data, parser)
    except etree.XMLSyntaxError:
        # xmllint reports invalid addresses of namespaces, but accepts the file.
        if any(entry.domain_name != "NAMESPACE" for entry in _entries(parser.error_log)):
            raise
        return etree.fromstring(data, _parser(recover=True))


def _parser(*, recover: bool) -> etree.XMLParser:
    from lxml import etree  # noqa: PLC0415

    return etree.XMLParser(
        recover=recover,
        resolve_entities=False,
        no_network=True,
        load_dtd=False,
        dtd_validation=False,
        huge_tree=False,
        strip_cdata=False,  # a blank section is text for xmllint
    )


def _entries(log: Any) -> Iterator[Any]:
    """Yield the entries of an error log of lxml. Its type stubs do not allow to iterate over the log itself."""
    yield from log


@cache
def _schema(form: int) -> etree.XMLSchema:
    from lxml import etree  # noqa: PLC0415

    folder = os.path.dirname(os.path.abspath(__file__))
    return etree.XMLSchema(etree.parse(os.path.join(folder, f"format{form}.xsd")))


_ATTRIBUTE = re.compile(r"Element '[^']*', attribute '([^']*)'")
_STEP = re.compile(r"/[^/]+/([^/\[]+)(?:\[(\d+)\])?")


def _errors(root: etree._Element, children: list[etree._Element], form: int) -> Iterator[Violation]:
    """Yield the violations in the XML tree of ``root``. ``children`` are the children of the root in the order of the file."""
    schema = _schema(form)
    if schema.validate(root):
        return
    positions = {child: position for position, child in enumerate(children)}
    by_step: dict[str, list[int]] = {"*": []}
    for child in root:
        if child in positions:
            by_step["*"].append(positions[child])
            if (name := _written(child)) != "*":
                by_step.setdefault(name, []).append(positions[child])
    for error in _entries(schema.error_log):
        attribute = _ATTRIBUTE.match(error.message)
        step = _STEP.match(error.path or "")
        yield Violation(
            error.type_name.removeprefix("SCHEMAV_"),
            -1 if step is None else by_step[step[1]][int(step[2] or 1) - 1],
            attribute[1] if attribute else "",
            error.message.rstrip(". "),
        )


def _written(element: etree._Element) -> str:
    """Return the tag of an element as libxml2 writes it in the path of an error: ``*`` if it is in a default namespace."""
    name = str(element.tag).rpartition("}")[2]
    return f"{element.prefix}:{name}" if element.prefix else name if name == element.tag else "*"
