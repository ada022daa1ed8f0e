"""Nodes and the parameters that they declare in C++ sources (rclcpp)."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from ros_lint.collectors.cpp.includes import blank_comments_near
from ros_lint.facts.sources import DeclaredParameter, NodeCode, ParameterType

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ros_lint.base.text import Text

# Each expression begins with a literal, because the regular expression engine searches a literal fast.
_NODE: Final = r"Node(?:\s*>)?(?:::make_shared|\s+\w+)?\s*[({]"
_NAMED = re.compile(_NODE + r'\s*["/]')
_NAME = re.compile(_NODE + r'\s*"(\w+)"')
_CLASS = re.compile(r"(?<!\w)(?:[A-Z]\w*)?\Z")
"""Matches the beginning of the name of a class that ends in Node."""
_DECLARE = re.compile(
    r"""declare_(?:or_get_)?parameter(?:_if_not_declared)?\s*
    (?:<\s*((?:[\w:\s]|<[\w:\s]*>)+?)\s*>)?\s*
    \(\s*(?:[\w.>()-]+\s*,\s*)?"([\w./-]+)"\s*([,)])""",
    re.VERBOSE,
)
_CALL = re.compile(r"declare_(?:or_get_)?parameter")
_COUNT = re.compile(r"declare_(?<!\wdeclare_)(?:or_get_)?parameters?(?:_if_not_declared)?\s*[<(]")
_CREATES = (
    re.compile(r"create_(?<!\wcreate_)(?:generic_)?(?:publisher|subscription|service|client|server)\s*[<(]"),
    re.compile(r"Subscriber(?<!\wSubscriber)\s*[<(]"),
    re.compile(r"subscribe(?<!\wsubscribe)\s*\("),
)
"""Match the beginning of a call that creates a topic, service or action (rclcpp, rclcpp_action, message_filters)."""
_TOPIC = re.compile(r"""\w+\s*(?:<(?:[^<>();]|<[^<>();]*>)*>)?\s*\(\s*(?:[\w.>()-]+\s*,\s*)?"([^"\n]+)"\s*[,)]""")
_WORD = re.compile(r'"([\w./]*\w)"')
_OPEN: Final = ("automatically_declare_parameters_from_overrides", "allow_undeclared_parameters")
_DYNAMIC: Final = ("dynamic_typing", "ParameterTypeException")
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


def node_code(source: Text, code: Sequence[int] = ()) -> NodeCode | None:
    """Return the node names and declared parameters in a C++ file, None if it has neither.

    ``code`` has sorted offsets that are certainly outside of comments and strings.
    """
    text = source.text
    words = tuple(sorted(set(_WORD.findall(text)))) if "arameter" in text else ()
    calls = [match.start() for match in _CALL.finditer(text)]
    names = [match.start() for match in _NAMED.finditer(text)]
    topics = [match.start() for pattern in _CREATES for match in pattern.finditer(text)]
    if not (words or calls or names or topics):
        return None
    options = [at for word in (*_OPEN, *_DYNAMIC) if (at := text.find(word)) >= 0]
    clean = blank_comments_near(text, [*calls, *names, *topics, *options], code)
    matches = list(_DECLARE.finditer(clean)) if calls else []
    is_dynamic = any(word in clean for word in _DYNAMIC)
    spans = source.spans([match.span(2) for match in matches])
    declared = [
        DeclaredParameter(match[2], "" if is_dynamic else _type(match, clean), span)
        for match, span in zip(matches, spans, strict=True)
    ]
    complete = len(matches) == len(_COUNT.findall(clean)) and not any(word in clean for word in _OPEN)
    return NodeCode(source.path, _names(clean), tuple(declared), words, complete, _topics(clean) if topics else ())


def _names(code: str) -> tuple[str, ...]:
    found = [match for match in _NAME.finditer(code) if _CLASS.search(code, max(match.start() - 100, 0), match.start())]
    return tuple(dict.fromkeys([match[1] for match in found]))


def _topics(code: str) -> tuple[str, ...] | None:
    named = [_TOPIC.match(code, match.start()) for pattern in _CREATES for match in pattern.finditer(code)]
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
