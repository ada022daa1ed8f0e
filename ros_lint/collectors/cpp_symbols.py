"""Names in C++ sources that tell of a package without an include: ``pkg::msg::Type``, and ``pkg::`` for namespaces.

A source can only name what some header brings in, so this finds what is used by way of other packages. It costs as
much as everything else that is read from C++, which is why it is a collector of its own.
"""

from __future__ import annotations

import re
import string
from typing import TYPE_CHECKING

from ros_lint.facts import Mention

if TYPE_CHECKING:
    from ros_lint.text import Text

_WORD = string.ascii_letters + string.digits + "_"
_INSIDE = frozenset(_WORD)
_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
_PACKAGE = re.compile(r"[a-z][a-z0-9]*_[a-z0-9_]*[a-z0-9]\Z")
_PLAIN = frozenset({"rclcpp", "rcutils", "rcpputils", "tf2", "pluginlib", "rviz", "nav2"})
"""Namespaces of one word that are named after their package. Others say too little: ``filters``, ``utils``."""
_KINDS = frozenset({"msg", "srv", "action"})


def symbols(source: Text) -> tuple[Mention, ...]:
    """Return the packages after which namespaces in a C++ file are named, each at its first place in the code.

    All are mentions ``via="interface"``: of ``pkg/Type`` for messages, and of ``pkg`` for other namespaces.
    """
    text = source.text
    pieces = text.split("::")
    words = [piece[len(piece.rstrip(_WORD)) :] for piece in pieces]
    interfaces = {f"{word}::{kind}::" for word, kind in zip(words, pieces[1:], strict=False) if kind in _KINDS}
    packages = {interface.partition("::")[0] for interface in interfaces}
    namespaces = {word for word in {*words[:-1]} - packages if word in _PLAIN or _PACKAGE.match(word)}
    wanted = [*interfaces, *(f"{name}::" for name in namespaces)]
    comments = [match.span() for match in _COMMENT.finditer(text)]
    found = sorted((start, written) for written in wanted if (start := _first(text, written, comments)) >= 0)
    spans = source.spans([(start, start + len(written) - 2) for start, written in found])
    return tuple(
        Mention(written[:-2].replace("::", "/"), "interface", span, written)
        for (_, written), span in zip(found, spans, strict=True)
    )


def _first(text: str, written: str, comments: list[tuple[int, int]]) -> int:
    """Return where a qualified name stands for the first time in plain code, -1 when it does nowhere.

    A line that may be a comment or a string is passed over: what a source needs, it mostly names more than once.
    """
    start = text.find(written)
    while start >= 0:
        before = text[text.rfind("\n", 0, start) + 1 : start]
        outer = before.removesuffix("::")  # of another namespace, or of none: ::pkg::Type
        if (
            before[-1:] not in _INSIDE
            and (outer is before or outer[-1:] not in _INSIDE)
            and "//" not in before
            and before.count('"') % 2 == 0
            and not before.rstrip().endswith("namespace")
            and not any(opened < start < closed for opened, closed in comments)
        ):
            return start
        start = text.find(written, start + 1)
    return -1
