"""Names in C++ code that tell of a package without an include: types of messages, and a few namespaces.

The generators give every package of messages a namespace of its own name, ``pkg::msg::Type`` (reference, section C4), so
that such a name says as much as an include. Nothing but a custom ties other namespaces to a package: those that count
are known to be of one package only.
"""

from __future__ import annotations

import re
import string
from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

from ros_lint.collectors.cpp.includes import Found, branches, in_doubt
from ros_lint.facts.sources import Mention

if TYPE_CHECKING:
    from ros_lint.base.text import Text

_NAMESPACES = (
    "ament_index_cpp", "cv_bridge", "image_transport", "message_filters", "pluginlib", "rclcpp_action", "rclcpp_lifecycle",
    "tf2_ros",
)  # fmt: skip
"""Packages that have a namespace of their name for themselves, and that others bring along more often than not."""

# "::" first, as that is looked for fast; of what may stand before it the last letter is looked at before the rest.
_LAST = "".join(sorted({name[-1] for name in _NAMESPACES}))
_BEFORE = "|".join(f"(?<={name}::)" for name in _NAMESPACES)
_KIND = re.compile(rf"::(?:(?:msg|srv|action)::|(?<=[{_LAST}]::)(?:{_BEFORE}))")
_TYPE = re.compile(r"::(?:msg|srv|action)::\w+")
_NAME = re.compile(r"::\w+")
_WORD = string.ascii_letters + string.digits + "_"
_INSIDE = frozenset(_WORD)
_make = tuple.__new__
_LONGEST = 64
"""How many characters of a name are looked at."""


def symbols(source: Text, known: Collection[str], directives: Found) -> list[Mention]:
    """Return the packages whose interfaces or namespaces a C++ file names, each at its first place in the code.

    Those that are ``known`` are left out. Optional is what is named only where it depends on the build. All mentions
    are ``via="symbol"``, of the package.
    """
    text = source.text
    *pieces, _ = _KIND.split(text)  # faster than to look at each match
    ends = {piece[-_LONGEST:] for piece in pieces}
    names = {end[len(end.rstrip(_WORD)) :] for end in ends}.difference(known)
    if not names:
        return []
    conditional = branches(text, directives.directives) if directives.directives else []
    found = sorted(place for name in names if name.islower() and (place := _first(text, name, directives.code, conditional)))
    spans = source.spans([place[:2] for place in found])
    return [
        _make(Mention, (package, "symbol", span, text[start:end], optional, False, ""))
        for (start, end, optional, package), span in zip(found, spans, strict=True)
    ]


def _first(text: str, package: str, code: Sequence[int], conditional: Sequence[range]) -> tuple[int, int, bool, str] | None:
    """Return start and end of the first name of a package in plain code, whether it depends on the build, and the package.

    Lines that may be comments, strings or directives are passed over: what a source needs it mostly names more than once.
    """
    optional = None
    written = f"{package}::"
    pattern = _NAME if package in _NAMESPACES else _TYPE
    start = text.find(written)
    while start >= 0:
        name = pattern.match(text, start + len(package))
        if name and _is_code(text, start) and not in_doubt(text, start, code):
            if not conditional or not any(start in each for each in conditional):
                return start, name.end(), False, package
            optional = optional or (start, name.end(), True, package)
        start = text.find(written, start + 1)
    return optional


def _is_code(text: str, at: int) -> bool:
    """Return whether a qualified name may begin at an offset, going by what stands before it in its line."""
    line = text.rfind("\n", 0, at) + 1
    before = text[line:at].removesuffix("::")  # of no namespace: ::pkg::msg::Type
    if before[-1:] in _INSIDE or before.count('"') % 2 or text[max(line - 3, 0) : line].rstrip("\r\n")[-1:] == "\\":
        return False
    bare = before.strip()
    return not bare or (bare[0] != "#" and not bare.endswith("namespace"))
