"""The published XML schema that a manifest names. ament_xmllint validates the manifest with it (ament_xmllint/main.py)."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from ros_lint.base.text import Span, Text
from ros_lint.collectors.manifest.xml import attribute, read


class NamedSchema(NamedTuple):
    """The published schema that a manifest names."""

    format: int
    """The format of package.xml that the schema describes: 1, 2 or 3."""
    span: Span
    """The span of the number of the format in the address of the schema."""


_PUBLISHED = re.compile(r"http://download\.ros\.org/schema/package_format([123])\.xsd")
_SCHEMA_LANGUAGE = "http://www.w3.org/2001/XMLSchema"
_LOCATION = "xsi:noNamespaceSchemaLocation"
_MODEL = re.compile(r"<!--.*?-->|<!\[CDATA\[.*?\]\]>|<\?xml-model\s(?P<data>.*?)\?>", re.DOTALL)
_VALUE = re.compile(r"""\b(href|schematypens)\s*=\s*(?:"([^"]*)"|'([^']*)')""")


def named_schema(source: Text) -> NamedSchema | None:
    """Return the published schema that a manifest names; the manifest must be well-formed XML.

    The result is None if the manifest names no schema, or a schema at another address. ament_xmllint passes the schema of each
    ``<?xml-model ...?>`` to xmllint, then ``xsi:noNamespaceSchemaLocation`` of the root. xmllint validates by the last schema.
    """
    *_, last = (None, *_addresses(source))
    if last is None or not (match := _PUBLISHED.fullmatch(source.text, *last)):
        return None
    return NamedSchema(int(match[1]), source.span(*match.span(1)))


def _addresses(source: Text) -> Iterator[tuple[int, int]]:
    """Yield the start and end offset of each schema address in a manifest, in the order in which ament_xmllint uses them."""
    text = source.text
    for model in _MODEL.finditer(text) if "<?xml-model" in text else ():
        values = {value[1]: value for value in _VALUE.finditer(text, *model.span("data"))}
        language, address = values.get("schematypens"), values.get("href")
        if language and address and _SCHEMA_LANGUAGE in language.groups():
            yield address.span(2 if address[3] is None else 3)
    root = read(source).root if _LOCATION in text else None
    if root is not None and _LOCATION in root.attributes:
        yield attribute(text, root, _LOCATION)[1:]
