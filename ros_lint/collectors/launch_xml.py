"""Launch files in XML."""

from __future__ import annotations

from ros_lint.collectors import launch_markup, xml_tree
from ros_lint.collectors.launch_markup import Attribute, Entity
from ros_lint.facts import Facet, LaunchFile, Opaque, Problem
from ros_lint.text import Text


def collect(source: Text) -> LaunchFile:
    """Return what a launch file in XML says. Never raises."""
    try:
        root = xml_tree.parse(source.text)
    except xml_tree.XmlError as error:
        span = source.span(error.offset, error.offset)
        return LaunchFile(
            source.path,
            "xml",
            opaque=(Opaque(Facet.USES, "the file is no XML that can be read", span),),
            problems=(Problem("syntax", error.message, span),),
        )
    return LaunchFile(source.path, "xml", *launch_markup.read(source, entities(source.text, root)))


def entities(text: str, root: xml_tree.Element) -> Entity:
    """Return the elements as entities."""
    # Children come before their parents, so that no depth of nesting needs a stack of calls.
    done: dict[int, Entity] = {}
    for element in reversed(list(root.walk())):
        places = xml_tree.attribute_places(text, element)
        attributes = {
            name: Attribute(value, *places.get(name, (element.start, element.start)))
            for name, value in element.attributes.items()
        }
        children = tuple(done.pop(id(child)) for child in element.children)
        end = element.start + 1 + len(element.tag)
        done[id(element)] = Entity(element.tag, attributes, children, element.start, end)
    return done[id(root)]
