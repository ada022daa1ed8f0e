"""Launch files in XML."""

from __future__ import annotations

from ros_lint.collectors import launch_markup, xml_tree
from ros_lint.collectors.launch_entity import Attribute, Entity
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
    found = launch_markup.read(source, entities(source, root))
    return LaunchFile(source.path, "xml", found.references, found.opaque, found.problems, actions=found.actions)


def entities(source: Text, root: xml_tree.Element) -> Entity:
    """Return the elements as entities."""
    # Children come before their parents, so that no depth of nesting needs a stack of calls.
    done: dict[int, Entity] = {}
    for element in reversed(list(root.walk())):
        places = xml_tree.attribute_places(source.text, element) if element.attributes else {}
        nowhere = (element.start, element.start)
        attributes = {name: Attribute(value, *places.get(name, nowhere)) for name, value in element.attributes.items()}
        children = [done.pop(id(child)) for child in element.children]
        end = element.start + 1 + len(element.tag)
        done[id(element)] = Entity(source, element.tag, attributes, children, element.start + 1, end, "element")
    return done[id(root)]
