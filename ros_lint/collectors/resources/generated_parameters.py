"""The parameters that generate_parameter_library declares in nodes, from the YAML file that describes them.

The format is that of ``parse_yaml.py`` in generate_parameter_library_py: one root key, whose name does not matter, and below it
a tree of names. A name whose first key has no keys of its own is a parameter, and ``type`` is its type.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, Final, NamedTuple

from ros_lint.base.safe_yaml import YamlError, compose
from ros_lint.facts.sources import ANY_PART, PARAMETERS_KEY, DeclaredParameter, NodeCode, ParameterType

if TYPE_CHECKING:
    import yaml

    from ros_lint.base.text import Text

_TYPED = re.compile(r"""^[ ]+["']?type["']?[ ]*:[ ]*["']?(?:bool|double|int|string|none)(?:_|\b)""", re.MULTILINE)
_TYPES: Final[dict[str, ParameterType]] = {
    "bool": "bool",
    "int": "integer",
    "double": "double",
    "string": "string",
    "bool_array": "bool_array",
    "int_array": "integer_array",
    "double_array": "double_array",
    "string_array": "string_array",
}
_FIXED = re.compile(r"_fixed(?:_\d+)?$")
_MAPPED: Final = "__map_"
"""The beginning of a part of a name that may be any name."""
_NONE: Final = "none"
"""The type of a parameter that is only documented, because other code declares it."""
_KEYS: Final = frozenset({"default_value", "description", "read_only", "additional_constraints", "validation", "type"})
_LARGEST: Final = 200_000
"""Maximum number of characters of a file that is read."""


class _Leaf(NamedTuple):
    name: str
    type: str
    key: yaml.ScalarNode


def collect(source: Text) -> NodeCode | None:
    """Return the parameters that a YAML file describes, None if the file has another format.

    A part of a name that may be any name (``__map_joints``) becomes ANY_PART. ``words`` are all names, ``declared`` are the
    parameters that the generated code declares.
    """
    text = source.text
    if len(text) > _LARGEST or PARAMETERS_KEY in text or _TYPED.search(text) is None:
        return None
    try:
        leaves = list(_leaves(compose(text)))
    except (YamlError, _OtherFormatError):
        return None
    spans = source.spans([(leaf.key.start_mark.index, leaf.key.end_mark.index) for leaf in leaves])
    declared = [
        DeclaredParameter(leaf.name, _TYPES.get(_FIXED.sub("", leaf.type), ""), span)
        for leaf, span in zip(leaves, spans, strict=True)
        if leaf.type != _NONE
    ]
    return NodeCode(source.path, (), tuple(declared), tuple(sorted({leaf.name for leaf in leaves})))


class _OtherFormatError(Exception):
    """The file does not have the format of generate_parameter_library."""


def _leaves(root: yaml.Node | None) -> Iterator[_Leaf]:
    pairs = _pairs(root)
    if len(pairs) != 1:
        raise _OtherFormatError
    waiting = [(key, value, key.value) for key, value in reversed(_pairs(pairs[0][1]))]
    while waiting:
        key, value, name = waiting.pop()
        inner = _pairs(value)
        if not inner:
            raise _OtherFormatError
        if not _is_mapping(inner[0][1]):
            options = {option.value: option_value for option, option_value in inner}
            kind = options.get("type")
            if not options.keys() <= _KEYS or kind is None or not isinstance(kind.value, str):
                raise _OtherFormatError
            yield _Leaf(".".join([ANY_PART if part.startswith(_MAPPED) else part for part in name.split(".")]), kind.value, key)
            continue
        # As in parse_dict(), keys that are no mappings are ignored below a key that has parameters.
        waiting += [(k, v, f"{name}.{k.value}") for k, v in reversed(inner) if _is_mapping(v)]


def _is_mapping(node: yaml.Node) -> bool:
    return type(node).__name__ == "MappingNode"


def _pairs(node: yaml.Node | None) -> list[tuple[yaml.ScalarNode, yaml.Node]]:
    """Return the keys and values of a mapping, [] for another node. Raises _OtherFormatError for a key that is no text."""
    if node is None or not _is_mapping(node):
        return []
    if any(type(key).__name__ != "ScalarNode" for key, _ in node.value):
        raise _OtherFormatError
    return list(node.value)
