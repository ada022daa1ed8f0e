"""C++ macros that register classes: components (rclcpp_components), plugins (pluginlib, class_loader)."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Literal

from ros_lint.collectors.cpp.includes import blank_comments, may_be_comments
from ros_lint.facts.sources import Registration
from ros_lint.facts.visibility import Facet, Opaque

if TYPE_CHECKING:
    from ros_lint.base.text import Text

_COMPONENT_MACRO = "RCLCPP_COMPONENTS_REGISTER_NODE"
_NAMES = (_COMPONENT_MACRO, "PLUGINLIB_EXPORT_CLASS", "CLASS_LOADER_REGISTER_CLASS")
_MACRO = re.compile(rf"({'|'.join(_NAMES)})\s*\(([^;{{}}()#]*)\)")
_CONTINUED = re.compile(r"\\\r?\n")


def registrations(source: Text, code: Sequence[int] = ()) -> tuple[Registration, ...]:
    """Return the classes that a C++ file registers, in order.

    ``code`` has sorted offsets that are certainly outside of comments and strings.
    """
    text = source.text
    if not ("_REGISTER_" in text or "PLUGINLIB_EXPORT_CLASS" in text):
        return ()
    matches = list(_matches(text))
    if may_be_comments(text, [match.start() for match in matches], code):
        matches = list(_matches(blank_comments(text)))
    spans = source.spans([match.span(1) for match in matches])
    result = []
    for match, span in zip(matches, spans, strict=True):
        name, _, base = (part.strip() for part in _CONTINUED.sub("", match[2]).partition(","))
        kind: Literal["component", "plugin"] = "component" if match[1] == _COMPONENT_MACRO else "plugin"
        if name and (base or kind == "component"):
            result.append(Registration(kind, class_name(name), span, class_name(base) if kind == "plugin" else ""))
    return tuple(result)


_DEFINITION = re.compile(r"^[ \t]*#[ \t]*define[ \t]+(\w+)((?:[^\\\n]|\\\r?\n|\\.)*)", re.MULTILINE)


def wrapper_macros(source: Text) -> tuple[Opaque, ...]:
    """Return each definition of a macro that registers components, as a place that could not be evaluated.

    The components are unknown, because the calls of the macro name them. Plugins of such macros are searched by the names in
    the plugin descriptions, see :func:`ros_lint.workspace.usage.textual_mentions.find_unwritten_classes`.
    """
    text = source.text
    if "define" not in text or _COMPONENT_MACRO not in text:
        return ()
    return tuple(
        Opaque(Facet.COMPONENTS, f"the classes that the macro '{macro[1]}' registers are not known", source.span(*macro.span(1)))
        for macro in _DEFINITION.finditer(text)
        if macro[1] != _COMPONENT_MACRO and _COMPONENT_MACRO in macro[2]
    )


def _matches(text: str) -> Iterator[re.Match[str]]:
    """Yield the calls of registration macros at the beginning of a line, except the calls in macro definitions.

    The names are searched as plain texts first, because this is many times faster than a search for the pattern.
    """
    places = sorted(place for name in _NAMES for place in _places(text, name))
    for place in places:
        match = _MACRO.match(text, place)
        start = text.rfind("\n", 0, place) + 1
        if match and not text[start:place].strip(" \t") and not text.endswith(("\\\n", "\\\r\n"), 0, start):
            yield match


def _places(text: str, name: str) -> Iterator[int]:
    place = text.find(name)
    while place >= 0:
        yield place
        place = text.find(name, place + 1)


def class_name(name: str) -> str:
    """Return the name of a class in a canonical form for comparison: no blanks, no leading ``::``."""
    return "".join(name.split()).removeprefix("::")
