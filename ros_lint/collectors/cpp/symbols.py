"""Names in C++ code that imply a package without an include: interface types and a few namespaces.

The generators put the interfaces of each package into a namespace of the package's name, ``pkg::msg::Type``
(rosidl_generator_cpp), so such a name proves the use of the package like an include. Other namespaces have the name of a
package only by convention: only the namespaces in ``_NAMESPACES`` count, each of which belongs to one package.
"""

from __future__ import annotations

import re
import string
from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

from ros_lint.collectors.cpp.includes import IncludeScan, branches, last_before, may_be_comment
from ros_lint.facts.sources import Mention

if TYPE_CHECKING:
    from ros_lint.base.text import Text

_NAMESPACES = (
    "ament_index_cpp", "cv_bridge", "image_transport", "message_filters", "pluginlib", "rclcpp_action", "rclcpp_lifecycle",
    "tf2_ros",
)  # fmt: skip
"""Packages with a namespace of their own name, which other packages usually provide transitively."""

# The pattern begins with "::", because a literal is searched fast. The lookbehind checks the last letter first.
_LAST = "".join(sorted({name[-1] for name in _NAMESPACES}))
_BEFORE = "|".join(f"(?<={name}::)" for name in _NAMESPACES)
_KIND = re.compile(rf"::(?:(?:msg|srv|action)::|(?<=[{_LAST}]::)(?:{_BEFORE}))")
_TYPE = re.compile(r"::(?:msg|srv|action)::\w+")
_NAME = re.compile(r"::\w+")
_WORD = string.ascii_letters + string.digits + "_"
_WORD_CHARACTERS = frozenset(_WORD)
_make = tuple.__new__
_MAX_NAME = 64
"""Number of characters before ``::`` in which the name of a package is searched."""


def symbols(source: Text, excluded: Collection[str], directives: IncludeScan) -> list[Mention]:
    """Return mentions of the packages whose interfaces or namespaces a C++ file names, each at its first place in the file.

    Packages in ``excluded`` are left out. A mention is optional if all uses of its package depend on the build. All
    mentions have ``via="symbol"`` and the name of the package.
    """
    text = source.text
    *pieces, _ = _KIND.split(text)  # faster than checking each match
    ends = {piece[-_MAX_NAME:] for piece in pieces}
    names = {end[len(end.rstrip(_WORD)) :] for end in ends}.difference(excluded)
    if not names:
        return []
    conditional = branches(text, directives.directives) if directives.directives else []
    places = sorted(place for name in names if name.islower() and (place := _first(text, name, directives.code, conditional)))
    spans = source.spans([place[:2] for place in places])
    return [
        _make(Mention, (package, "symbol", span, text[start:end], optional, False, ""))
        for (start, end, optional, package), span in zip(places, spans, strict=True)
    ]


def _first(text: str, package: str, code: Sequence[int], conditional: Sequence[range]) -> tuple[int, int, bool, str] | None:
    """Return the first qualified name such as ``package::msg::Type`` in code: start, end, whether optional, ``package``.

    Lines that may be comments, strings or directives are skipped, because a source usually has further names. The result is
    None if there is no name.
    """
    optional, clear = None, 0
    qualifier = f"{package}::"
    pattern = _NAME if package in _NAMESPACES else _TYPE
    start = text.find(qualifier)
    while start >= 0:
        name = pattern.match(text, start + len(package))
        clear = max(clear, last_before(code, start))
        if name and _is_code(text, start) and not may_be_comment(text, start, (clear,)):
            clear = start
            if not conditional or not any(start in index for index in conditional):
                return start, name.end(), False, package
            optional = optional or (start, name.end(), True, package)
        start = text.find(qualifier, start + 1)
    return optional


def _is_code(text: str, at: int) -> bool:
    """Return whether a qualified name may begin at an offset, judged by the text before it in its line."""
    line = text.rfind("\n", 0, at) + 1
    before = text[line:at].removesuffix("::")  # global namespace: ::pkg::msg::Type
    if before[-1:] in _WORD_CHARACTERS or before.count('"') % 2 or text[max(line - 3, 0) : line].rstrip("\r\n")[-1:] == "\\":
        return False
    bare = before.strip()
    return not bare or (bare[0] != "#" and not bare.endswith("namespace"))
