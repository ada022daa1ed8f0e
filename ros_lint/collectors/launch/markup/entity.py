"""Elements of XML and YAML launch files, and the types of attributes (``launch.frontend.Entity``).

XML and YAML differ in one respect: in XML every attribute is a text, which is converted to the requested type; in YAML every
value has a type, which is checked.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, Final, Literal

from ros_lint.base.text import Span
from ros_lint.base.xml_tree import XmlElement, attribute_places
from ros_lint.collectors.launch.markup.tags import ROS_1
from ros_lint.facts.visibility import Problem

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from ros_lint.base.text import Text

Type = Literal["str", "int", "float", "bool", "any", "strs", "ints", "floats", "bools"]
"""The requested type of an attribute. ``any`` is the type that YAML infers from the text."""

_make = tuple.__new__  # takes half the time of the constructor

_SCALARS: Mapping[str, type] = {"str": str, "int": int, "float": float, "bool": bool}
_LISTS: Mapping[str, type] = {"strs": str, "ints": int, "floats": float, "bools": bool}


class Rejected(Exception):  # noqa: N818
    """The package launch would reject the launch file, because of the error ``problem``."""

    def __init__(self, kind: str, message: str, span: Span, instead: str = "") -> None:
        super().__init__(message)
        self.problem: Final = Problem(kind, message, span, instead)


NO_VALUE: Final = object()
"""The stand-in for a YAML value that no attribute accepts: a mapping, a date, nested lists."""


class Entity:
    """An element of a launch file: an XML element, or a YAML key with its value. It has attributes and children.

    ``start`` and ``end`` are the offsets of the tag (in YAML: of the key) in the source.
    """

    __slots__ = (
        "_read_children",
        "_source",
        "_spots",
        "_written",
        "attributes",
        "children",
        "end",
        "form",
        "read",
        "simple",
        "start",
        "tag",
    )

    def __init__(
        self,
        source: Text,
        tag: str,
        attributes: Mapping[str, Any],
        children: list[Entity],
        start: int,
        end: int,
        form: Literal["element", "mapping", "list", "other"],
        spots: dict[str, tuple[int, int]] | None,
        simple: bool,
    ) -> None:
        """Create an element.

        ``spots`` are the offsets of the attribute values, None if :meth:`written` has to find the offsets.
        """
        self._source = source
        self.tag = tag
        self.attributes = attributes
        """Attributes by name: texts in XML; in YAML texts, numbers, booleans, None, lists of these, or :data:`NO_VALUE`."""
        self.children = children
        """Child elements.

        In YAML: the items of the key ``children``, and the items of lists of mappings under other keys. The tag of the latter
        is the key."""
        self.start = start
        self.end = end
        self.form = form
        """``element`` in XML. In YAML the type of the value: ``mapping``, ``list`` or ``other``."""
        self._spots = spots
        self._written: dict[str, tuple[Span, bool]] | None = None
        self.simple = simple
        """True if each attribute value is exactly the text in the source: only in XML, in files without separators (``-sep``)."""
        self.read: set[str] = set()
        """The names of the attributes that were requested so far."""
        self._read_children: set[str] | None = set()

    @property
    def span(self) -> Span:
        """The span of the tag of the element."""
        return self._source.span(self.start, self.end)

    def written(self, name: str) -> tuple[Span, bool]:
        """Return the span of the value of an attribute, and whether the source contains the value literally."""
        places = self._written
        if places is None:
            places = self._written = self._find_written()
        return places.get(name) or (self._source.span(self.start - 1, self.start - 1), False)

    def _find_written(self) -> dict[str, tuple[Span, bool]]:
        source, text = self._source, self._source.text
        if self._spots is not None:
            return self._from_spots(self._spots)
        # Nearly all attributes are literal, and in the order of the parser, so one pass over the lines suffices.
        places: dict[str, tuple[Span, bool]] = {}
        at = self.end
        path, line, column, _, _ = source.span(at, at)
        line_offset = at - column
        for name, value in self.attributes.items():
            plain = f'{name}="{value}"'
            start = at + 1
            if not (text.startswith(plain, start) and text[at] == " "):
                start = text.find(name, at)
                gap = text[at:start]
                if not (text.startswith(plain, start) and gap.isspace()):
                    return self._from_spots(attribute_places(text, XmlElement(self.tag, {}, self.start - 1)))
                if not gap.isascii() or "\r" in gap:
                    _, line, column, _, _ = source.span(start, start)
                    line_offset = start - column
                elif "\n" in gap:
                    line += gap.count("\n")
                    line_offset = at + gap.rindex("\n")
            start += len(name) + 2
            end = start + len(value)
            places[name] = (_make(Span, (path, line, start - line_offset, line, end - line_offset)), True)
            at = end + 1
        return places

    def _from_spots(self, spots: dict[str, tuple[int, int]]) -> dict[str, tuple[Span, bool]]:
        text, span = self._source.text, self._source.span
        return {name: (span(start, end), text[start:end] == self.attributes.get(name)) for name, (start, end) in spots.items()}

    def place(self, name: str) -> Span:
        """Return the span of the value of an attribute, the span of the tag if the element has no such attribute."""
        return self.written(name)[0] if name in self.attributes else self.span

    def has_none_of(self, names: Iterable[str]) -> bool:
        """Return whether the element certainly has none of the attributes ``names``, so that requesting them cannot fail."""
        return self.form == "element" and self.attributes.keys().isdisjoint(names)

    def get(self, name: str, kind: Type = "str") -> Any:
        """Return the value of an attribute with the type ``kind``, None if the attribute is missing.

        Raises Rejected if the value has another type.
        """
        attributes = self.attributes
        if self.form == "element":
            if name not in attributes:
                return None
            self.read.add(name)
            if kind == "str" and (self.simple or f"{name}-sep" not in attributes):
                return attributes[name]
            return self._converted(name, kind)
        if self.form == "other":
            raise Rejected("wrong-type", f"<{self.tag}> is neither a mapping nor a list", self.span)
        if name not in attributes:
            if self.form == "mapping" and any(child.tag == name for child in self.children):
                raise Rejected("wrong-type", f"'{name}' of <{self.tag}> is a list", self.span)
            return None
        self.read.add(name)
        if not _is_instance(attributes[name], kind):
            raise Rejected("wrong-type", f"'{name}' of <{self.tag}> is not {_NAMES[kind]}", self.place(name))
        return attributes[name]

    def _converted(self, name: str, kind: Type) -> Any:
        """Return the text of an XML attribute converted to a type.

        If the element has an attribute ``<name>-sep``, the text is first split at the separator in this attribute: ``a;b``
        with the separator ``;`` -> ``a`` and ``b``.
        """
        value: str | list[str] = self.attributes[name]
        separator = self.attributes.get(f"{name}-sep")
        if separator is not None:
            self.read.add(f"{name}-sep")
            if not separator:
                raise Rejected("wrong-type", f"'{name}-sep' of <{self.tag}> is empty", self.place(name))
            value = self.attributes[name].split(separator)
        try:
            return _coerced(value, kind)
        except ValueError:
            raise Rejected("wrong-type", f"'{name}' of <{self.tag}> is not {_NAMES[kind]}", self.place(name)) from None

    def need(self, name: str, kind: Type = "str") -> Any:
        """Return the value of an attribute. Raises Rejected if the attribute is missing or has another type."""
        value = self.get(name, kind)
        if value is None:
            raise Rejected("missing-attribute", f"<{self.tag}> requires the attribute '{name}'", self.span)
        return value

    def entities(self, tag: str) -> list[Entity]:
        """Return the children whose tag is ``tag``.

        In YAML, ``tag`` is a key of the element. Raises Rejected if the value of the key is not a list of mappings.
        """
        if self.form == "other":
            raise Rejected("wrong-type", f"<{self.tag}> is neither a mapping nor a list", self.span)
        if self.form == "list":
            return []
        if self.form == "mapping" and tag in self.attributes:
            raise Rejected("wrong-type", f"'{tag}' of <{self.tag}> is not a list of mappings", self.place(tag))
        if not self.children:
            return []
        if self._read_children is not None:
            self._read_children.add(tag)
        return [child for child in self.children if child.tag == tag]

    def actions(self) -> list[Entity]:
        """Return the children that are actions. Raises Rejected if a YAML element has no list of actions."""
        if self.form == "element":
            self._read_children = None
            return self.children
        if self.form == "mapping":
            if self.attributes.get("children") == "":
                self.read.add("children")
                return []  # launch.frontend iterates over an empty text as well
            if "children" in self.attributes:
                raise Rejected("wrong-type", f"'children' of <{self.tag}> is not a list of mappings", self.place("children"))
            self._read_children = (self._read_children or set()) | {CHILDREN}
            for child in self.children:
                if child.tag == CHILDREN:
                    return [_single_entity(inner) for inner in child.children]
            raise Rejected("missing-attribute", f"<{self.tag}> requires 'children'", self.span)
        if self.form == "list":
            self._read_children = None
            return [_single_entity(inner) for inner in self.children]
        raise Rejected("wrong-type", f"<{self.tag}> is neither a mapping nor a list", self.span)

    def finish(self) -> None:
        """Raise Rejected if the element has an attribute or a child that was never requested: launch does not support it."""
        requested = self._read_children
        if self.form == "list":
            if requested is not None:
                raise Rejected("unexpected-child", f"<{self.tag}> cannot contain a list", self.span)
            return
        for child in self.children:
            if requested is not None and child.tag not in requested:
                name = "children" if child.tag == CHILDREN else child.tag
                raise Rejected("unexpected-child", f"<{self.tag}> cannot contain <{name}>", child.span)
        if len(self.read) != len(self.attributes):
            for name in self.attributes:
                if name not in self.read:
                    instead = ROS_1.get(f"{name} of <{self.tag}>", "")
                    raise Rejected("unexpected-attribute", f"<{self.tag}> has no attribute '{name}'", self.place(name), instead)


CHILDREN: Final = "\0children"
"""The tag that represents the key ``children`` in YAML, or a list item that is not an element."""


def _single_entity(item: Entity) -> Entity:
    """Return the only element in an item of a YAML list. Raises Rejected if the item does not have exactly one key."""
    if item.tag != CHILDREN:
        return item
    raise Rejected("wrong-type", "each list item must have exactly one key, the tag", item.span)


_NAMES: Mapping[Type, str] = {
    "str": "a string",
    "int": "an integer",
    "float": "a number with a decimal point",
    "bool": "a boolean",
    "any": "a string, number, boolean or list of these",
    "strs": "a list of strings",
    "ints": "a list of integers",
    "floats": "a list of numbers",
    "bools": "a list of booleans",
}


def _is_valid(value: Any) -> bool:
    """Return whether a YAML value has a type that launch accepts for attributes (``is_instance_of_valid_type``).

    The value must be a scalar or a list of scalars. Besides texts, the list may have scalars of only one type.
    """
    if not isinstance(value, list):
        return isinstance(value, (int, float, bool, str))
    kind = next((type(item) for item in value if type(item) is not str), str)
    return kind in (int, float, bool, str) and all(isinstance(item, (kind, str)) for item in value)


def _is_instance(value: Any, kind: Type) -> bool:
    """Return whether a YAML value has the type ``kind`` (``is_instance_of``).

    A text is accepted in place of any scalar, also in a list, because the text may contain substitutions.
    """
    if kind == "any":
        return _is_valid(value)
    if kind in _SCALARS:
        return isinstance(value, (str, _SCALARS[kind]))
    return isinstance(value, list) and all(isinstance(item, (str, _LISTS[kind])) for item in value)


def _coerced(value: str | list[str], kind: Type) -> Any:
    """Return the text of an XML attribute, or its split parts, converted to a type. Raises ValueError if this is impossible.

    A text that is no number is returned unchanged for a number type, because it may contain a substitution.
    """
    if isinstance(value, list):
        if kind in _SCALARS:
            raise ValueError(kind)
        inner: Type = "any" if kind == "any" else kind[:-1]  # type: ignore[assignment]
        items = [_coerced(item, inner) for item in value]
        if not _is_valid(items):
            raise ValueError(kind)
        return items
    if kind == "str":
        return value
    if kind in ("int", "float"):
        try:
            return _SCALARS[kind](value)
        except ValueError:
            return value
    if kind == "bool":
        value = {"1": "true", "0": "false"}.get(value, value)
    output = _as_yaml(value)
    if kind == "bool":
        if not isinstance(output, (str, bool)):
            raise ValueError(kind)
    elif kind != "any" and not (isinstance(output, list) and all(isinstance(item, (str, _LISTS[kind])) for item in output)):
        raise ValueError(kind)
    return output


def _as_yaml(value: str) -> Any:
    """Return the value that a text has in YAML: ``1`` -> 1. A text that is not YAML is returned unchanged.

    Raises ValueError if the value is of a type that attributes do not support.
    """
    if value in _WORDS:
        return _WORDS[value]
    if value in ("null", "Null", "NULL"):
        raise ValueError(value)
    if not value or not _is_suspicious(value):
        return value
    if _INTEGER.fullmatch(value):
        return int(value)
    if _DECIMAL.fullmatch(value):
        return float(value)
    if _SIMPLE_LIST.fullmatch(value):
        items = [_as_yaml(item.strip(" ")) for item in value[1:-1].split(",")]
        if not _is_valid(items):
            raise ValueError(value)
        return items
    from ros_lint.base.safe_yaml import YamlError, load  # noqa: PLC0415  (few values are of YAML)

    try:
        output = load(value)
    except YamlError:  # launch.frontend takes any failure for "not YAML"
        return value
    if not _is_valid(output):
        raise ValueError(value)
    return output


_WORDS: Mapping[str, bool] = {
    word: truth
    for truth, words in ((True, ("true", "yes", "on")), (False, ("false", "no", "off")))
    for plain in words
    for word in (plain, plain.capitalize(), plain.upper())
}

# These texts are parsed here, because importing yaml takes 20 ms.
_INTEGER = re.compile(r"[-+]?(?:0|[1-9][0-9]{0,17})", re.ASCII)
_DECIMAL = re.compile(r"[-+]?[0-9]+\.[0-9]*", re.ASCII)
_ITEM = r" *(?:[-+]?(?:0|[1-9][0-9]{0,17})|[-+]?[0-9]+\.[0-9]*|[A-Za-z/$][\w/.$()-]*(?: [\w/.$()-]+)*) *"
_SIMPLE_LIST = re.compile(rf"\[{_ITEM}(?:,{_ITEM})*\]", re.ASCII)


def _is_suspicious(value: str) -> bool:
    """Return whether YAML may convert a text to another type, e.g. ``1`` or ``[a]``.

    The caller must have excluded the empty text and the words for true and false, such as ``yes`` (``_WORDS``).
    """
    if not (value[0].isalpha() or value[0] in "$/") or value[-1] in ": \t":
        return True
    return ": " in value or " #" in value or "\n" in value
