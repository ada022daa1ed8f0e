"""Plugin descriptions of pluginlib: the classes of each library."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

from ros_lint.base.xml_tree import XmlElement, XmlError, attribute_places, parse
from ros_lint.collectors.cpp.registrations import class_name
from ros_lint.facts.build import PluginClass, PluginFile, PluginLibrary

if TYPE_CHECKING:
    from ros_lint.base.text import Span, Text

_DECLARATION = re.compile(r"<\?xml\b.*?\?>", re.DOTALL)
_TEMPLATE = re.compile(r"""=\s*(?:"[^"]*<[^"]*"|'[^']*<[^']*')""")
_PLACEHOLDER = "\ue000"
_ROOT = "<_>"


def roots(text: str) -> list[XmlElement]:
    """Return the top-level elements of a plugin description as tinyxml2 reads them for pluginlib, [] if it rejects the text.

    There may be several roots, and values of attributes may contain "<", as template types do.
    """
    try:
        return [parse(text)]
    except XmlError:
        pass
    plain = _DECLARATION.sub(lambda match: " " * len(match[0]), text)
    plain = _TEMPLATE.sub(lambda match: match[0].replace("<", _PLACEHOLDER), plain)
    try:
        root = parse(f"{_ROOT}{plain}</{_ROOT[1:]}")
    except XmlError:
        return []
    for element in root.walk():
        element.start -= len(_ROOT)
        element.attributes = {name: value.replace(_PLACEHOLDER, "<") for name, value in element.attributes.items()}
    return root.children


def collect(path: str, source: Text) -> PluginFile | None:
    """Return the plugin description in a file; None if the text is not a plugin description.

    ``path`` is the path of the file relative to the package.
    """
    if "<library" not in source.text and "<class" not in source.text:
        return None
    elements = roots(source.text)
    if not elements:
        return None
    first = elements[0]
    if first.tag == "library":
        libraries = [element for element in elements if element.tag == "library"]
    elif first.tag == "class_libraries":
        libraries = [element for element in first.children if element.tag == "library"]
    else:
        return None
    place = source.span(first.start, first.start + 1 + len(first.tag))
    return PluginFile(path, tuple(_library(source, element) for element in libraries), place)


def _library(source: Text, element: XmlElement) -> PluginLibrary:
    classes = tuple(_classes(source, element))
    return PluginLibrary(element.attributes.get("path", ""), _place(source, element, "path"), classes)


def _classes(source: Text, library: XmlElement) -> Iterator[PluginClass]:
    for element in library.children:
        if element.tag == "class":
            get = element.attributes.get
            class_type = get("type", "")
            place = _place(source, element, "type")
            yield PluginClass(get("name", class_type), class_name(class_type), class_name(get("base_class_type", "")), place)


def _place(source: Text, element: XmlElement, attribute: str) -> Span:
    places = attribute_places(source.text, element)
    start, end = places.get(attribute, (element.start, element.start + 1 + len(element.tag)))
    return source.span(start, end)
