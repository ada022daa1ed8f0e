"""Read the parameters in a parameter file, with the types and errors of rcl_yaml_param_parser (``parse.c``)."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from ros_lint.base.safe_yaml import YamlBoundError, YamlError, events
from ros_lint.facts.sources import FileParameter, ParameterType
from ros_lint.facts.visibility import Problem

if TYPE_CHECKING:
    from ros_lint.base.text import Text

_MARK: Final = "ros__parameters"
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

    parameters: tuple[FileParameter, ...]
    refusals: tuple[Problem, ...]


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
    """Return the parameters in a YAML file.

    Aliases are replaced by their values, because components, launch and RewrittenYaml (nav2_common) support them.
    """
    if len(source.text) > _LARGEST:
        return ParameterValues((), ())
    try:
        stream = events(source.text)
    except YamlBoundError:
        return ParameterValues((), ())
    except YamlError as error:
        place = source.span(error.offset, error.offset)
        return ParameterValues((), (Problem("syntax", f"it is not valid YAML: {error.message}", place),))
    reader = _Reader(stream)
    reader.read()
    ranges = sorted({(found.start, found.end) for found in reader.found})
    spans = dict(zip(ranges, source.spans(ranges), strict=True))
    return ParameterValues(
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
    """Reads a list of YAML events. ``refusals`` has kind, message, start and end of each error of rcl."""

    def __init__(self, stream: Sequence[Any]) -> None:
        self._events = stream
        self._at = 0
        self.found: list[_Found] = []
        self.refusals: list[tuple[str, str, int, int]] = []

    def read(self) -> None:
        """Read all documents."""
        while self._at < len(self._events):
            if _kind(self._events[self._at]) == "MappingStart":
                self._nodes("")
            else:
                self._at += 1

    def _nodes(self, above: str) -> None:
        """Read a mapping of node names and namespaces, below the names ``above``."""
        for key, event in self._pairs():
            is_mapping = _kind(event) == "MappingStart"
            if key is None:
                self._skip()
            elif key.value == _MARK and is_mapping and above:
                if not _NAME.fullmatch(above) and _PLACEHOLDER.search(above) is None:
                    self._refuse("bad-name", f"'{above}' is not the name of a node", key)
                self._parameters(above, "")
            elif key.value == _MARK:
                self._refuse("no-value", "ros__parameters has no parameters, or no node name above it", key)
                self._skip()
            elif is_mapping:
                self._nodes(f"{above}{'' if above.endswith('/') else '/'}{key.value}" if above else key.value)
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
            quoted = event.style in ("'", '"') or event.tag == "tag:yaml.org,2002:str"
            if node and not event.value and not quoted:
                self._refuse("no-value", f"'{name}' has no value", key)
            self._add(node, name, event.value, type_of(event.value, quoted=quoted), key)
            return
        texts: list[str] = []
        types: list[ParameterType] = []
        is_flat = True
        self._at += 1
        while _kind(event := self._events[self._at]) != "SequenceEnd":
            if _kind(event) == "Scalar":
                texts.append(event.value)
                types.append(type_of(event.value, quoted=event.style in ("'", '"') or event.tag == "tag:yaml.org,2002:str"))
                self._at += 1
            elif _kind(event) == "Alias":
                self._note_alias()
            else:
                is_flat = False
                self._skip()
        self._at += 1
        if node and len(set(types)) > 1:
            self._refuse("mixed-list", f"the list '{name}' has elements of types {' and '.join(dict.fromkeys(types))}", key)
        array: Any = f"{types[0]}_array" if types and is_flat and len(set(types)) == 1 else ""
        self._add(node, name, f"[{', '.join(texts)}]", array, key)

    def _add(self, node: str, name: str, text: str, kind: ParameterType, key: Any) -> None:
        self.found.append(_Found(node, name, text[:_LONGEST], kind, key.start_mark.index, key.end_mark.index))

    def _note_alias(self) -> None:
        self._refuse("alias", "rcl supports no aliases", self._events[self._at])
        self._at += 1

    def _refuse(self, kind: str, message: str, event: Any) -> None:
        self.refusals.append((kind, message, event.start_mark.index, event.end_mark.index))

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
