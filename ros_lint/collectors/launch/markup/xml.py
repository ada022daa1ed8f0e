"""Static analysis of launch files in XML."""

from __future__ import annotations

from ros_lint.base import xml_tree
from ros_lint.base.text import Text
from ros_lint.collectors.launch.markup.collect import launch_file
from ros_lint.collectors.launch.markup.entity import Entity
from ros_lint.facts.launch import LaunchFile
from ros_lint.facts.visibility import Facet, Opaque, Problem


def collect(source: Text) -> LaunchFile:
    """Return the facts of a launch file in XML. Errors in the file are in the result; none raises an exception."""
    try:
        root = entities(source)
    except xml_tree.XmlError as error:
        span = source.span(error.offset, error.offset)
        return LaunchFile(
            source.path,
            "xml",
            opaque=(Opaque(Facet.USES, "the file is not valid XML", span),),
            problems=(Problem("syntax", error.message, span),),
        )
    return launch_file(source, "xml", root)


def entities(source: Text) -> Entity:
    """Return the root element of an XML launch file, with its children. Raises XmlError if the file is not valid XML."""
    simple = "-sep" not in source.text

    def entity(tag: str, attributes: dict[str, str], start: int) -> Entity:
        return Entity(source, tag, attributes, [], start + 1, start + 1 + len(tag), "element", None, simple)

    return xml_tree.parse_as(source.text, entity)
