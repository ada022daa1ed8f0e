"""Types of messages, services and actions that C++ code names, ``pkg::msg::Type``: each tells of the package.

The generators give every package a namespace of its own name (reference, section C4), so that such a name says as much
as an include. Other namespaces say less: nothing but a custom ties them to a package.
"""

from __future__ import annotations

import re
import string
from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

from ros_lint.collectors.cpp_includes import Found, branches, in_doubt
from ros_lint.facts import Mention

if TYPE_CHECKING:
    from ros_lint.text import Text

_KIND = re.compile("::(?:msg|srv|action)::")
_WORD = string.ascii_letters + string.digits + "_"
_INSIDE = frozenset(_WORD)
_LONGEST = 64
"""How many characters of a name are looked at."""
_NAME = re.compile(r"\w+")


def symbols(source: Text, known: Collection[str], directives: Found) -> list[Mention]:
    """Return the packages whose interfaces a C++ file names, each at its first place in the code.

    Those that are ``known`` are left out. Optional is what is named only where it depends on the build. All mentions
    are ``via="symbol"``, of the package.
    """
    text = source.text
    names = set()
    for match in _KIND.finditer(text):
        at = match.start()
        piece = text[at - _LONGEST if at > _LONGEST else 0 : at]
        names.add((piece[len(piece.rstrip(_WORD)) :], match[0]))
    names = {(package, kind) for package, kind in names if package.islower() and package not in known}
    if not names:
        return []
    conditional = branches(text, directives.directives) if directives.directives else []
    found = sorted(
        place for package, kind in names if (place := _first(text, package + kind, directives.code, conditional))
    )
    spans = source.spans([(start, end) for start, end, _ in found])
    return [
        Mention(text[start:end].partition("::")[0], "symbol", span, text[start:end], optional)
        for (start, end, optional), span in zip(found, spans, strict=True)
    ]


def _first(
    text: str, written: str, code: Sequence[int], conditional: Sequence[range]
) -> tuple[int, int, bool] | None:
    """Return start and end of the first place in plain code of a qualified name, and whether it depends on the build.

    Lines that may be comments, strings or directives are passed over: what a source needs it mostly names more than once.
    """
    optional = None
    start = text.find(written)
    while start >= 0:
        before = text[text.rfind("\n", 0, start) + 1 : start]
        if _is_code(before.removesuffix("::")) and not in_doubt(text, start, code):
            name = _NAME.match(text, start + len(written))
            end = name.end() if name else start + len(written) - 2
            if not conditional or not any(start in each for each in conditional):
                return start, end, False
            optional = optional or (start, end, True)
        start = text.find(written, start + 1)
    return optional


def _is_code(before: str) -> bool:
    """Return whether a qualified name may begin behind that part of a line."""
    if before[-1:] in _INSIDE or before.count('"') % 2:
        return False
    bare = before.strip()
    return not bare or (bare[0] != "#" and not bare.endswith("namespace"))
