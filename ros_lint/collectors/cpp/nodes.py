"""Nodes and the parameters that they declare in C++ sources (rclcpp)."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from ros_lint.collectors.cpp.includes import blank_comments
from ros_lint.facts.sources import DeclaredParameter, NodeCode, ParameterType

if TYPE_CHECKING:
    from ros_lint.base.text import Text

_NAME = re.compile(r'\b(?:[A-Z]\w*)?Node(?:\s*>)?(?:::make_shared|\s+\w+)?\s*[({]\s*"(\w+)"')
_DECLARE = re.compile(
    r"""declare_(?:or_get_)?parameter(?:_if_not_declared)?\s*
    (?:<\s*((?:[\w:\s]|<[\w:\s]*>)+?)\s*>)?\s*
    \(\s*(?:[\w.>()-]+\s*,\s*)?"([\w./-]+)"\s*([,)])""",
    re.VERBOSE,
)
_COUNT = re.compile(r"\bdeclare_(?:or_get_)?parameters?(?:_if_not_declared)?\s*[<(]")
_CREATES = re.compile(
    r"\b(?:create_(?:generic_)?(?:publisher|subscription|service|client|server)|Subscriber)\s*[<(]|\bsubscribe\s*\("
)
"""Matches the beginning of a call that creates a topic, service or action (rclcpp, rclcpp_action, message_filters)."""
_TOPIC = re.compile(r"""\w+\s*(?:<(?:[^<>();]|<[^<>();]*>)*>)?\s*\(\s*(?:[\w.>()-]+\s*,\s*)?"([^"\n]+)"\s*[,)]""")
_WORD = re.compile(r'"([\w./]*\w)"')
_OPEN: Final = ("automatically_declare_parameters_from_overrides", "allow_undeclared_parameters")
_TYPES: dict[str, ParameterType] = {
    "bool": "bool",
    "double": "double",
    "float": "double",
    "int": "integer",
    "int64_t": "integer",
    "long": "integer",
    "string": "string",
}
_ELEMENTS: dict[str, ParameterType] = {
    "bool": "bool_array",
    "double": "double_array",
    "int": "integer_array",
    "int64_t": "integer_array",
    "string": "string_array",
}
_VECTOR = re.compile(r"(?:std::)?vector<(?:std::)?(\w+)>")
_CONSTANT = re.compile(r"(?:rclcpp::)?(?:ParameterType::)?PARAMETER_(\w+)")
_LITERAL: tuple[tuple[re.Pattern[str], ParameterType], ...] = (
    (re.compile(r"true|false"), "bool"),
    (re.compile(r"[+-]?\d+[lL]{0,2}"), "integer"),
    (re.compile(r"[+-]?(?:\d+\.\d*|\.\d+|\d+(?=[eE]))(?:[eE][+-]?\d+)?[fF]?"), "double"),
    (re.compile(r'(?:std::)?(?:string\s*[({]\s*)?"[^"\\]*"\s*[)}]?(?:s)?'), "string"),
)
_WRAPPED = re.compile(r"(?:rclcpp::)?ParameterValue\s*[({]\s*(.*?)\s*[)}]", re.DOTALL)


def node_code(source: Text) -> NodeCode | None:
    """Return the node names and declared parameters in a C++ file, None if it has neither."""
    text = source.text
    has_parameters = "arameter" in text
    words = tuple(sorted(set(_WORD.findall(text)))) if has_parameters else ()
    has_calls = has_parameters and _COUNT.search(text) is not None
    has_names = "Node" in text and _NAME.search(text) is not None
    has_topics = _CREATES.search(text) is not None
    if not (words or has_calls or has_names or has_topics):
        return None
    code = blank_comments(text) if has_calls or has_names or has_topics else text
    matches = list(_DECLARE.finditer(code)) if has_parameters else []
    names = tuple(dict.fromkeys(match[1] for match in _NAME.finditer(code)))
    is_dynamic = "dynamic_typing" in code or "ParameterTypeException" in code
    spans = source.spans([match.span(2) for match in matches])
    declared = [
        DeclaredParameter(match[2], "" if is_dynamic else _type(match, code), span)
        for match, span in zip(matches, spans, strict=True)
    ]
    complete = len(matches) == len(_COUNT.findall(code)) and not any(word in code for word in _OPEN)
    return NodeCode(source.path, names, tuple(declared), words, complete, _topics(code) if has_topics else ())


def _topics(code: str) -> tuple[str, ...] | None:
    named = [_TOPIC.match(code, match.start()) for match in _CREATES.finditer(code)]
    return tuple(sorted({match[1] for match in named if match is not None})) if all(named) else None


def _type(match: re.Match[str], code: str) -> ParameterType:
    """Return the type of the parameter that a call declares, "" if it is not certain."""
    if match[1] is not None:
        return _named_type(match[1])
    if match[3] == ")":
        return ""
    default = _argument(code, match.end())
    if constant := _CONSTANT.fullmatch(default):
        return _constant_type(constant[1])
    if vector := _VECTOR.match(re.sub(r"\s+", "", default)):
        return _ELEMENTS.get(vector[1], "")
    wrapped = _WRAPPED.fullmatch(default)
    return next((type_ for pattern, type_ in _LITERAL if pattern.fullmatch(wrapped[1] if wrapped else default)), "")


def _named_type(name: str) -> ParameterType:
    plain = re.sub(r"\s+", "", name).removeprefix("std::")
    vector = _VECTOR.fullmatch(plain)
    return _ELEMENTS.get(vector[1], "") if vector else _TYPES.get(plain, "")


def _constant_type(name: str) -> ParameterType:
    words = name.lower().split("_")
    scalar = _TYPES.get({"integer": "int"}.get(words[0], words[0]), "")
    if words[1:] == ["array"]:
        return _ELEMENTS.get({"integer": "int"}.get(words[0], words[0]), "")
    return scalar if len(words) == 1 else ""


def _argument(code: str, start: int) -> str:
    """Return the argument of a call that begins at ``start``, without blanks around it."""
    depth = 0
    for match in _DELIMITER.finditer(code, start, start + 400):
        character = match[0]
        if character in "([{":
            depth += 1
        elif character in ")]}":
            depth -= 1
            if depth < 0:
                return code[start : match.start()].strip()
        elif character == "," and not depth:
            return code[start : match.start()].strip()
    return ""


_DELIMITER = re.compile(r'[()\[\]{},]|"(?:[^"\\\n]|\\.)*"')
