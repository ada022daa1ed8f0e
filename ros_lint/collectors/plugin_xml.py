"""Plugin descriptions of pluginlib: which library has which classes (reference, section C5.8)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from ros_lint.collectors.xml_tree import Element, XmlError, attribute_places, parse
from ros_lint.facts.build import PluginClass, PluginFile, PluginLibrary

if TYPE_CHECKING:
    from ros_lint.text import Span, Text


def collect(path: str, source: Text) -> PluginFile | None:
    """Return a plugin description, None for a text that is none. ``path`` is relative to the package."""
    if "<library" not in source.text and "<class" not in source.text:
        return None
    try:
        root = parse(source.text)
    except XmlError:
        return None
    if root.tag == "library":
        libraries = [root]
    elif root.tag == "class_libraries":
        libraries = [element for element in root.children if element.tag == "library"]
    else:
        return None
    place = source.span(root.start, root.start + 1 + len(root.tag))
    return PluginFile(path, tuple(_library(source, element) for element in libraries), place)


def _library(source: Text, element: Element) -> PluginLibrary:
    classes = tuple(_classes(source, element))
    return PluginLibrary(element.attributes.get("path", ""), _place(source, element, "path"), classes)


def _classes(source: Text, library: Element) -> Iterator[PluginClass]:
    for element in library.children:
        if element.tag == "class":
            get = element.attributes.get
            kind = get("type", "")
            yield PluginClass(get("name", kind), kind, get("base_class_type", ""), _place(source, element, "type"))


def _place(source: Text, element: Element, attribute: str) -> Span:
    places = attribute_places(source.text, element)
    start, end = places.get(attribute, (element.start, element.start + 1 + len(element.tag)))
    return source.span(start, end)
