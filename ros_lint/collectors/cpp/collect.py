"""Reader of C and C++ sources: included headers, and packages that are looked up by name."""

from __future__ import annotations

import operator
from typing import TYPE_CHECKING

from ros_lint.collectors.cpp.includes import Include, mentions
from ros_lint.collectors.cpp.lookups import loaders, look_ups
from ros_lint.collectors.cpp.registrations import registrations, wrapped
from ros_lint.collectors.cpp.symbols import symbols
from ros_lint.collectors.suffixes import SOURCES
from ros_lint.facts.sources import FileFacts, Mention
from ros_lint.facts.visibility import Facet, Opaque

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ros_lint.base.text import Text

_LOADERS = ("pluginlib", "class_loader")
_place = operator.itemgetter(Mention._fields.index("span"))


def collect(source: Text) -> FileFacts:
    """Return the includes, lookups and registered classes of a C or C++ file, without standard headers.

    - An include is a mention ``via="include"``; its ``what`` distinguishes ``#include "a"`` from ``#include <a>``.
    - Interface types whose package is not included are ``via="symbol"``.
    - Lookups by ament_index_cpp and pluginlib with a literal are ``via="package"``.
    """
    scan = mentions(source)
    included, code = scan.mentions, scan.code
    known = {mention[0].partition("/")[0] for mention in included}  # by index: there are tens of thousands
    packages, files = look_ups(source, code)
    loading = loaders(source, code) if not known.isdisjoint(_LOADERS) or _implements(source.path, included) else ()
    packages += [
        Mention(loader.package, "package", loader.span, f'"{loader.package}", "{loader.base}"')
        for loader in loading
        if loader.base.startswith(f"{loader.package}::")  # else it may be any pair of words
    ]
    packages += symbols(source, known, scan)
    if packages:
        included += packages
        included.sort(key=_place)
    opaque = (_opaque(source, scan.computed) if scan.computed else ()) + wrapped(source)
    return FileFacts(tuple(included), opaque, registrations(source, code), files, loaders=loading)


def _implements(path: str, included: Iterable[Mention]) -> bool:
    """Return whether a source includes the header of its own name, which may declare its plugin loaders."""
    name = path.rpartition("/")[2]
    stem = name[: name.rfind(".") + 1]
    return name.endswith(SOURCES) and any(header[header.rfind("/") + 1 :].startswith(stem) for header, *_ in included)


def _opaque(source: Text, computed: list[Include]) -> tuple[Opaque, ...]:
    return tuple(
        Opaque(
            Facet.USES,
            f"only the preprocessor knows which header #include {item.name} names",
            source.span(item.start, item.start + len(item.name)),
        )
        for item in computed
    )
