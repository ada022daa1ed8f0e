"""``colcon.pkg`` and ``colcon.meta``: names, types and dependencies that complement the manifest.

Source: colcon-metadata, and ``update_descriptor`` of colcon-core.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros_lint.base.safe_yaml import YamlBoundError, YamlError, compose
from ros_lint.facts.manifest import ColconDepend, ColconMeta, ColconSettings, Role

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    import yaml

    from ros_lint.base.text import Span, Text

_CATEGORIES = {
    "dependencies": Role.BUILD | Role.EXEC | Role.TEST,
    "build-dependencies": Role.BUILD,
    "run-dependencies": Role.EXEC,
    "test-dependencies": Role.TEST,
}


class ColconYamlError(ValueError):
    """A ``colcon.pkg`` or ``colcon.meta`` is not a YAML mapping, so colcon ignores it. ``span`` is the span of the error."""

    def __init__(self, reason: str, span: Span) -> None:
        super().__init__(reason)
        self.span = span


def package(text: Text) -> ColconSettings:
    """Return the settings of a ``colcon.pkg``. Raises ColconYamlError."""
    return _settings(text, _top(text))


def meta(text: Text) -> ColconMeta:
    """Return the settings of a ``colcon.meta``. Raises ColconYamlError."""
    top = _top(text)
    return ColconMeta(text.path, _sections(text, top.get("names")), _sections(text, top.get("paths")))


def _sections(text: Text, node: yaml.Node | None) -> tuple[tuple[str, ColconSettings], ...]:
    return tuple((key, _settings(text, _mapping(value))) for key, value in _mapping(node).items())


def _settings(text: Text, values: Mapping[str, yaml.Node]) -> ColconSettings:
    depends = [
        ColconDepend(name, role, _span(text, node)) for key, role in _CATEGORIES.items() for name, node in _items(values.get(key))
    ]
    return ColconSettings(_string(values.get("name")), _string(values.get("type")), tuple(depends))


def _top(text: Text) -> Mapping[str, yaml.Node]:
    try:
        node = compose(text.text)
    except YamlError as error:
        reason = error.message if isinstance(error, YamlBoundError) else f"it is not valid YAML: {error.message}"
        raise ColconYamlError(reason, text.span(error.offset, error.offset)) from None
    if node is not None and _kind(node) != "mapping":
        raise ColconYamlError("it is not a mapping", _span(text, node))
    return _mapping(node)


def _kind(node: yaml.Node) -> str:
    return str(getattr(node, "id", ""))


def _mapping(node: yaml.Node | None) -> Mapping[str, yaml.Node]:
    # The last of equal keys counts, as in every loader of PyYAML.
    if node is None or _kind(node) != "mapping":
        return {}
    return {key.value: value for key, value in node.value if _kind(key) == "scalar"}


def _items(node: yaml.Node | None) -> Iterator[tuple[str, yaml.Node]]:
    # colcon iterates over the value: over the keys of a mapping in place of a list.
    if node is None or _kind(node) == "scalar":
        return
    for item in node.value:
        entry = item[0] if _kind(node) == "mapping" else item
        if name := _string(entry):
            yield name, entry


def _string(node: yaml.Node | None) -> str:
    if node is None or _kind(node) != "scalar" or node.tag != "tag:yaml.org,2002:str":
        return ""
    return str(node.value)


def _span(text: Text, node: yaml.Node) -> Span:
    return text.span(node.start_mark.index, node.end_mark.index)
