"""Static analysis of launch files in YAML."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ros_lint.base.budget import Budget
from ros_lint.base.safe_yaml import YamlBoundError, YamlError, compose, scalar
from ros_lint.base.text import Text
from ros_lint.collectors.launch.markup.collect import launch_file
from ros_lint.collectors.launch.markup.entity import CHILDREN, NO_VALUE, Entity
from ros_lint.facts.launch import LaunchFile
from ros_lint.facts.visibility import Facet, Opaque, Problem

if TYPE_CHECKING:
    import yaml

_MAX_DEPTH = 100
_MAX_ENTITIES = 20_000


def collect(source: Text) -> LaunchFile:
    """Return the facts of a launch file in YAML. Errors in the file are in the result; none raises an exception."""
    try:
        node = compose(source.text)
    except YamlBoundError as error:
        span = source.span(error.offset, error.offset)
        return LaunchFile(source.path, "yaml", opaque=(Opaque(Facet.USES, error.message, span, unchecked=True),))
    except YamlError as error:
        span = source.span(error.offset, error.offset)
        return LaunchFile(
            source.path,
            "yaml",
            opaque=(Opaque(Facet.USES, "the file is not valid YAML", span),),
            problems=(Problem("syntax", f"not valid YAML: {error.message}", span),),
        )
    root = _Reader(source).root(node)
    if root is None:
        start = source.span(0, 0)
        problem = Problem("root", "the file must be a mapping with 'launch' as its only key", start)
        return LaunchFile(source.path, "yaml", problems=(problem,))
    return launch_file(source, "yaml", root)


class _Reader:
    """Converts YAML nodes to elements. The number of elements is limited, because aliases can multiply a few nodes."""

    def __init__(self, source: Text) -> None:
        self._source = source
        self._budget = Budget(_MAX_ENTITIES)

    def root(self, node: yaml.Node | None) -> Entity | None:
        import yaml  # noqa: PLC0415

        if not isinstance(node, yaml.MappingNode) or len({key.value for key, _ in node.value if _is_scalar(key)}) != 1:
            return None
        key, value = node.value[-1]
        return self._entity(key, value, 0)

    def _entity(self, key: yaml.Node, value: yaml.Node, depth: int) -> Entity:
        """Return the element of a YAML key: a mapping has attributes and lists of child elements, a list has child elements."""
        tag = str(key.value) if _is_scalar(key) else "?"
        return self._entity_of_value(tag, key.start_mark.index, key.end_mark.index, value, depth)

    def _entity_of_value(self, tag: str, start: int, end: int, value: yaml.Node, depth: int) -> Entity:
        import yaml  # noqa: PLC0415

        affordable = self._budget.affords(1 + (len(value.value) if isinstance(value.value, list) else 0))
        attributes: dict[str, Any] = {}
        spots: dict[str, tuple[int, int]] = {}
        children: list[Entity] = []
        if depth >= _MAX_DEPTH or not affordable:
            return Entity(self._source, tag, {}, [], start, end, "other", {}, simple=False)
        if isinstance(value, yaml.SequenceNode):
            children = [self._item(item, depth + 1) for item in value.value]
            return Entity(self._source, tag, {}, children, start, end, "list", {}, simple=False)
        if not isinstance(value, yaml.MappingNode):
            return Entity(self._source, tag, {}, [], start, end, "other", {}, simple=False)
        for name_node, content in value.value:
            name = str(name_node.value) if _is_scalar(name_node) else "?"
            attributes.pop(name, None)
            children = [child for child in children if child.tag not in (name, CHILDREN if name == "children" else name)]
            inner = content.value if isinstance(content, yaml.SequenceNode) else []
            if name == "children" and isinstance(content, yaml.SequenceNode):
                place = (name_node.start_mark.index, name_node.end_mark.index)
                items = [self._item(item, depth + 1) for item in inner]
                children.append(Entity(self._source, CHILDREN, {}, items, *place, "list", {}, simple=False))
            elif inner and isinstance(inner[0], yaml.MappingNode):
                children += [self._entity(name_node, item, depth + 1) for item in inner]
            else:
                attributes[name] = _value(content)
                spots[name] = self._spot(content, attributes[name])
        return Entity(self._source, tag, attributes, children, start, end, "mapping", spots, simple=False)

    def _item(self, item: yaml.Node, depth: int) -> Entity:
        import yaml  # noqa: PLC0415

        if isinstance(item, yaml.MappingNode) and len({str(key.value) for key, _ in item.value}) == 1:
            key, value = item.value[-1]
            return self._entity(key, value, depth)
        start, end = item.start_mark.index, item.end_mark.index
        return Entity(self._source, CHILDREN, {}, [], start, max(start, min(end, start + 1)), "other", {}, simple=False)

    def _spot(self, node: yaml.Node, value: Any) -> tuple[int, int]:
        start, end = node.start_mark.index, node.end_mark.index
        quoted = getattr(node, "style", None) in ("'", '"')
        if quoted and isinstance(value, str) and self._source.text[start + 1 : end - 1] == value:
            return start + 1, end - 1
        return start, end


def _is_scalar(node: yaml.Node) -> bool:
    return isinstance(node.value, str)


def _value(node: yaml.Node) -> Any:
    """Return the text, number, boolean or None of a YAML scalar, a list of these for a list of scalars, else NO_VALUE.

    Nested lists are not read, because aliases can multiply a few of them.
    """
    import yaml  # noqa: PLC0415

    if isinstance(node, yaml.SequenceNode):
        values = [_value(item) if _is_scalar(item) else NO_VALUE for item in node.value[:1_000]]
        return NO_VALUE if NO_VALUE in values else values
    if not isinstance(node, yaml.ScalarNode):
        return NO_VALUE
    kind = node.tag.rpartition(":")[2]
    if kind == "str":
        return str(node.value)
    if kind not in ("int", "float", "bool", "null"):
        return NO_VALUE
    try:
        return scalar(node)
    except YamlError:
        return NO_VALUE
