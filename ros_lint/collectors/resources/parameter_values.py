"""Read the parameters in a parameter file, with the types and errors of rcl_yaml_param_parser (``parse.c``)."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from ros_lint.base.safe_yaml import YamlBoundError, YamlError, events
from ros_lint.facts.sources import ANY_NODE, PARAMETERS_KEY, FileParameter, ParameterType
from ros_lint.facts.visibility import Problem

if TYPE_CHECKING:
    from ros_lint.base.text import Span, Text

_TRUTHS = frozenset({
    "Y", "y", "yes", "Yes", "YES", "true", "True", "TRUE", "on", "On", "ON",
    "N", "n", "no", "No", "NO", "false", "False", "FALSE", "off", "Off", "OFF",
})  # fmt: skip
_INTEGER = re.compile(r"\s*[+-]?(?:0[xX][0-9a-fA-F]+|0[0-7]*|[1-9][0-9]*)")
_FLOAT = re.compile(
    r"\s*[+-]?(?:(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?|(?i:inf(?:inity)?|nan))|[+-]?\.(?:inf|Inf|INF)|\.(?:nan|NaN|NAN)"
)
_NAME = re.compile(r"/?(?:(?:\*\*?|[A-Za-z_]\w*)/)*(?:\*\*?|[A-Za-z_]\w*)", re.ASCII)
"""Pattern of the full name of a node, with wildcards (``_validate_name()`` in rcl_yaml_param_parser)."""
_PLACEHOLDER = re.compile(r"\$\(|[<{]")
"""Matches text that launch or another program replaces before rcl reads the file."""
_LONGEST: Final = 1_000
"""Maximum length of the text of a value. Longer texts, such as robot descriptions, are cut."""
_LARGEST: Final = 500_000
"""Maximum number of characters of a file whose values are read."""


class ParameterValues(NamedTuple):
    """The parameters in a file, and the reasons why rcl refuses the file."""

    nodes: tuple[tuple[str, Span], ...] = ()
    """The names of the nodes, as :attr:`ParameterFile.nodes`."""
    parameters: tuple[FileParameter, ...] = ()
    refusals: tuple[Problem, ...] = ()


def type_of(text: str, *, quoted: bool = False) -> ParameterType:
    """Return the type of a scalar value (``get_value()`` in rcl_yaml_param_parser)."""
    if quoted:
        return "string"
    if text in _TRUTHS:
        return "bool"
    if _INTEGER.fullmatch(text) and _fits(text):
        return "integer"
    return "double" if _FLOAT.fullmatch(text) else "string"


def _fits(text: str) -> bool:
    """Return whether an integer has at most 64 bits, as ``strtoll()`` requires."""
    digits = text.strip().lstrip("+-")
    base = 16 if digits[:2] in ("0x", "0X") else 8 if digits.startswith("0") else 10
    return len(digits) < 70 and -(1 << 63) <= int(digits, base) < 1 << 63


def read_values(source: Text) -> ParameterValues:
    """Return the nodes and parameters in a YAML file; none for a file that exceeds a limit or is not valid YAML.

    Aliases are replaced by their values, because components, launch and RewrittenYaml (nav2_common) support them.
    """
    if len(source.text) > _LARGEST:
        return ParameterValues()
    try:
        stream = events(source.text)
    except YamlBoundError:
        return ParameterValues()
    except YamlError as error:
        place = source.span(error.offset, error.offset)
        return ParameterValues(refusals=(Problem("syntax", f"it is not valid YAML: {error.message}", place),))
    reader = _Reader(stream)
    reader.read()
    ranges = sorted({(found.start, found.end) for found in reader.found} | {(start, end) for _, start, end in reader.nodes})
    spans = dict(zip(ranges, source.spans(ranges), strict=True))
    return ParameterValues(
        tuple([(name, spans[start, end]) for name, start, end in reader.nodes]),
        tuple(
            [FileParameter(node, name, text, type_, spans[start, end]) for node, name, text, type_, start, end in reader.found]
        ),
        tuple([Problem(kind, message, source.span(start, end)) for kind, message, start, end in reader.refusals]),
    )


class _Found(NamedTuple):
    node: str
    name: str
    text: str
    type: ParameterType
    start: int
    end: int


class _Reader:
    """Reads a list of YAML events.

    ``nodes`` has the name of each node, with start and end of its last key. ``refusals`` has kind, message, start and end of each
    error of rcl.
    """

    def __init__(self, stream: Sequence[Any]) -> None:
        self._events = stream
        self._at = 0
        self.nodes: list[tuple[str, int, int]] = []
        self.found: list[_Found] = []
        self.refusals: list[tuple[str, str, int, int]] = []

    def read(self) -> None:
        """Read all documents."""
        while self._at < len(self._events):
            if _kind(self._events[self._at]) == "MappingStart":
                self._nodes("", None)
            else:
                self._at += 1

    def _nodes(self, above: str, last: Any) -> None:
        """Read a mapping of node names and namespaces, below the names ``above``. ``last`` is the key above the mapping."""
        for key, event in self._pairs():
            is_mapping = _kind(event) == "MappingStart"
            if key is not None and key.value == PARAMETERS_KEY:
                self.nodes.append((_node_name(above), *_range(last or key)))
            if key is None:
                self._skip()
            elif key.value == PARAMETERS_KEY and is_mapping and above:
                if not _NAME.fullmatch(above) and _PLACEHOLDER.search(above) is None:
                    self._refuse("bad-name", f"'{above}' is not the name of a node", key)
                self._parameters(above, "")
            elif key.value == PARAMETERS_KEY:
                self._refuse("no-value", "ros__parameters has no parameters, or no node name above it", key)
                self._skip()
            elif is_mapping:
                self._nodes(f"{above}{'' if above.endswith('/') else '/'}{key.value}" if above else key.value, key)
            else:
                self._refuse("value-outside", f"the value of '{key.value}' is not below ros__parameters", key)
                self._skip()

    def _parameters(self, node: str, above: str) -> None:
        """Read a mapping of parameters whose names begin with ``above``."""
        for key, event in self._pairs():
            if key is None:
                self._skip()
            elif key.value == "<<" and _kind(event) == "MappingStart":  # only for readers that support aliases
                self._parameters(node, above)
            elif _kind(event) == "MappingStart":
                self._parameters(node, f"{above}{key.value}.")
            else:
                self._value(node, f"{above}{key.value}", key)

    def _pairs(self) -> Iterator[tuple[Any, Any]]:
        """Yield the keys of the mapping that begins here, None for a key that is no scalar, with the first event of the value.

        The caller reads the value before the next key.
        """
        self._at += 1
        while _kind(event := self._events[self._at]) != "MappingEnd":
            if _kind(event) == "Alias":
                self._note_alias()
                continue
            if _kind(event) == "Scalar":
                self._at += 1
                if _kind(self._events[self._at]) == "Alias":
                    self._note_alias()
                yield event, self._events[self._at]
            else:
                self._skip()
                yield None, self._events[self._at]
        self._at += 1

    def _value(self, node: str, name: str, key: Any) -> None:
        event = self._events[self._at]
        if _kind(event) == "Scalar":
            self._at += 1
            if not event.value and not _is_quoted(event):
                self._refuse("no-value", f"'{name}' has no value", key)
            self._add(node, name, event.value, _type(event), key)
            return
        texts: list[str] = []
        types: list[ParameterType] = []
        is_flat = True
        self._at += 1
        while _kind(event := self._events[self._at]) != "SequenceEnd":
            if _kind(event) == "Scalar":
                texts.append(event.value)
                types.append(_type(event))
                self._at += 1
            elif _kind(event) == "Alias":
                self._note_alias()
            else:
                is_flat = False
                self._skip()
        self._at += 1
        if len(set(types)) > 1:
            self._refuse("mixed-list", f"the list '{name}' has elements of types {' and '.join(dict.fromkeys(types))}", key)
        array: Any = f"{types[0]}_array" if types and is_flat and len(set(types)) == 1 else ""
        self._add(node, name, f"[{', '.join(texts)}]", array, key)

    def _add(self, node: str, name: str, text: str, kind: ParameterType, key: Any) -> None:
        self.found.append(_Found(node, name, text[:_LONGEST], kind, *_range(key)))

    def _note_alias(self) -> None:
        self._refuse("alias", "rcl supports no aliases", self._events[self._at])
        self._at += 1

    def _refuse(self, kind: str, message: str, event: Any) -> None:
        self.refusals.append((kind, message, *_range(event)))

    def _skip(self) -> None:
        """Go to the event after the value that begins here."""
        depth = 0
        while True:
            kind = _kind(self._events[self._at])
            depth += (kind in ("MappingStart", "SequenceStart")) - (kind in ("MappingEnd", "SequenceEnd"))
            if kind == "Alias":
                self._note_alias()
            else:
                self._at += 1
            if depth <= 0 and kind != "Alias":
                return


def _kind(event: Any) -> str:
    name: str = type(event).__name__
    return name.removesuffix("Event")


def _node_name(keys: str) -> str:
    """Return the full name of the node for the joined keys above its parameters."""
    if not keys or "{" in keys:  # without a name, or a template
        return ANY_NODE
    return "/".join(["", *[part for part in keys.split("/") if part]])


def _range(event: Any) -> tuple[int, int]:
    """Return the start and end offsets of an event; those of a quoted text without its quotes."""
    start, end = event.start_mark.index, event.end_mark.index
    return (start + 1, end - 1) if getattr(event, "style", None) in ("'", '"') else (start, end)


def _is_quoted(event: Any) -> bool:
    return event.style in ("'", '"') or event.tag == "tag:yaml.org,2002:str"


def _type(event: Any) -> ParameterType:
    return type_of(event.value, quoted=_is_quoted(event))
