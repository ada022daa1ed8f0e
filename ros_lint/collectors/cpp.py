"""Read C and C++ sources: which headers they include, and which packages they look up by name."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros_lint.collectors.cpp_includes import includes
from ros_lint.collectors.cpp_look_ups import look_ups
from ros_lint.collectors.cpp_registrations import registrations
from ros_lint.facts import Facet, FileFacts, Mention, Opaque

if TYPE_CHECKING:
    from ros_lint.text import Text


def collect(source: Text) -> FileFacts:
    """Return the includes, look-ups and registered classes of a C or C++ file, standard headers left out.

    An include is a mention ``via="include"`` whose ``what`` tells ``#include "a"`` from ``#include <a>``.
    Look-ups by ament_index_cpp and pluginlib with a literal are ``via="package"`` (reference, section E2, rows 23 and 24).
    """
    found = includes(source.text)
    named = [item for item in found if item.quote]
    spans = source.spans([(start, start + len(name)) for start, name, _, _ in named])
    mentions = [
        Mention(name, "include", span, f"#include <{name}>" if quote == "<" else f'#include "{name}"', optional)
        for (_, name, quote, optional), span in zip(named, spans, strict=True)
    ]
    loads_plugins = any(name.startswith(("pluginlib/", "class_loader/")) for _, name, _, _ in named)
    packages, files = look_ups(source, loads_plugins)
    if packages:
        mentions = sorted([*mentions, *packages], key=lambda mention: mention.span)
    opaque = [
        Opaque(
            Facet.USES,
            f"only the preprocessor knows which header #include {item.name} names",
            source.span(item.start, item.start + len(item.name)),
        )
        for item in found
        if not item.quote
    ]
    return FileFacts(source.path, tuple(mentions), tuple(opaque), registrations=registrations(source), look_ups=files)
