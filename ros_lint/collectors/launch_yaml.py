"""Launch files in YAML."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros_lint.collectors import launch_markup
from ros_lint.collectors.launch_markup import Attribute, Entity
from ros_lint.facts import Facet, LaunchFile, Opaque, Problem
from ros_lint.text import Text

if TYPE_CHECKING:
    import yaml

_MAX_DEPTH = 100
_MOST_ENTITIES = 20_000


def collect(source: Text) -> LaunchFile:
    """Return what a launch file in YAML says. Never raises."""
    from ros_lint.collectors.yaml_tree import YamlError, compose  # noqa: PLC0415  (yaml takes 20 ms to import)

    try:
        node = compose(source)
    except YamlError as error:
        span = source.span(error.offset, error.offset)
        return LaunchFile(
            source.path,
            "yaml",
            opaque=(Opaque(Facet.USES, "the file is no YAML that can be read", span),),
            problems=(Problem("syntax", error.message, span),),
        )
    root = _Reader(source).root(node)
    if root is None:
        return LaunchFile(source.path, "yaml")
    return LaunchFile(source.path, "yaml", *launch_markup.read(source, root))


class _Reader:
    """Makes entities from nodes. Aliases can make few nodes look like many, so it stops at a bound."""

    def __init__(self, source: Text) -> None:
        self._source = source
        self._left = _MOST_ENTITIES

    def root(self, node: yaml.Node | None) -> Entity | None:
        import yaml  # noqa: PLC0415

        if not isinstance(node, yaml.MappingNode) or len(node.value) != 1:
            return None
        key, value = node.value[0]
        return self._entity(key, value, 0)

    def _entity(self, key: yaml.Node, value: yaml.Node, depth: int) -> Entity:
        """Return an entity: a mapping has attributes, and entities under ``children``; a list is its children."""
        import yaml  # noqa: PLC0415

        attributes: dict[str, Attribute] = {}
        children: list[Entity] = []
        self._left -= 1
        if depth < _MAX_DEPTH and self._left > 0:
            if isinstance(value, yaml.SequenceNode):
                children = self._children(value, depth)
            elif isinstance(value, yaml.MappingNode):
                for name, content in value.value:
                    if isinstance(content, yaml.ScalarNode):
                        attributes[str(name.value)] = self._attribute(content)
                    elif isinstance(content, yaml.SequenceNode) and name.value == "children":
                        children += self._children(content, depth)
                    elif isinstance(content, yaml.SequenceNode):
                        children += [self._entity(name, item, depth + 1) for item in content.value]
        return Entity(str(key.value), attributes, tuple(children), key.start_mark.index, key.end_mark.index)

    def _children(self, node: yaml.SequenceNode, depth: int) -> list[Entity]:
        import yaml  # noqa: PLC0415

        return [
            self._entity(item.value[0][0], item.value[0][1], depth + 1)
            for item in node.value
            if isinstance(item, yaml.MappingNode) and len(item.value) == 1
        ]

    def _attribute(self, node: yaml.ScalarNode) -> Attribute:
        start, end = node.start_mark.index, node.end_mark.index
        value = str(node.value)
        if node.style in ("'", '"') and self._source.text[start + 1 : end - 1] == value:
            return Attribute(value, start + 1, end - 1)
        return Attribute(value, start, end)
