"""Read C and C++ sources: which headers they include, and which packages they look up by name."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from ros_lint.collectors.cpp_includes import blanked, in_doubt, includes
from ros_lint.collectors.cpp_registrations import registrations
from ros_lint.facts import Facet, FileFacts, Mention, Opaque

if TYPE_CHECKING:
    from ros_lint.text import Text

_LOOK_UP = re.compile(r'(get_package_(?:share_directory|share_path|prefix))\s*\(\s*"([^"\\\n]+)"')


def collect(source: Text) -> FileFacts:
    """Return the includes and look-ups of a C or C++ file, standard headers left out.

    An include is a mention ``via="include"`` whose ``what`` tells ``#include "a"`` from ``#include <a>``.
    Look-ups by ament_index_cpp with a literal are ``via="package"`` (reference, section E2, row 24).
    """
    found = includes(source.text)
    named = [item for item in found if item.quote]
    spans = source.spans([(start, start + len(name)) for start, name, _, _ in named])
    mentions = [
        Mention(name, "include", span, f"#include <{name}>" if quote == "<" else f'#include "{name}"', optional)
        for (_, name, quote, optional), span in zip(named, spans, strict=True)
    ]
    if "get_package_" in source.text:
        mentions += _look_ups(source)
        mentions.sort(key=lambda mention: mention.span)
    opaque = [
        Opaque(
            Facet.USES,
            f"only the preprocessor knows which header #include {item.name} names",
            source.span(item.start, item.start + len(item.name)),
        )
        for item in found
        if not item.quote
    ]
    return FileFacts(source.path, tuple(mentions), tuple(opaque), registrations=registrations(source))


def _look_ups(source: Text) -> list[Mention]:
    found = list(_LOOK_UP.finditer(source.text))
    if any(in_doubt(source.text, match.start()) for match in found):
        found = list(_LOOK_UP.finditer(blanked(source.text)))
    spans = source.spans([match.span(2) for match in found])
    return [
        Mention(match[2], "package", span, f'{match[1]}("{match[2]}")')
        for match, span in zip(found, spans, strict=True)
    ]
