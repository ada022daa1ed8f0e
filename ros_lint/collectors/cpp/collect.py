"""Reader of C and C++ sources: included headers, and packages that are looked up by name."""

from __future__ import annotations

import operator
from typing import TYPE_CHECKING

from ros_lint.collectors.cpp.includes import Include, scan_includes
from ros_lint.collectors.cpp.lookups import loaders, look_ups
from ros_lint.collectors.cpp.nodes import node_code
from ros_lint.collectors.cpp.registrations import registrations, wrapper_macros
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

    Names that may belong to another package become Mentions:

    - An include has ``via="include"``. Its ``what`` distinguishes ``#include "a"`` from ``#include <a>``.
    - An interface type has ``via="symbol"`` if no header of its package is included.
    - A lookup by ament_index_cpp or pluginlib with a literal has ``via="package"``.
    """
    scan = scan_includes(source)
    included, code = scan.mentions, scan.code
    included_folders = {mention[0].partition("/")[0] for mention in included}  # by index: there are tens of thousands
    packages, files = look_ups(source, code)
    plugin_loaders = (
        loaders(source, code) if not included_folders.isdisjoint(_LOADERS) or _implements(source.path, included) else ()
    )
    packages += [
        Mention(loader.package, "package", loader.span, f'"{loader.package}", "{loader.base}"')
        for loader in plugin_loaders
        if loader.base.startswith(f"{loader.package}::")  # otherwise the two texts may have another meaning
    ]
    packages += symbols(source, included_folders, scan)
    if packages:
        included += packages
        included.sort(key=_place)
    opaque = (_opaque(source, scan.computed) if scan.computed else ()) + wrapper_macros(source)
    return FileFacts(
        tuple(included), opaque, registrations(source, code), files, loaders=plugin_loaders, nodes=node_code(source, code)
    )


def _implements(path: str, included: Iterable[Mention]) -> bool:
    """Return whether a source includes a header with its own name, such as ``a.hpp`` in ``a.cpp``.

    Such a header may declare the plugin loaders of the source.
    """
    name = path.rpartition("/")[2]
    stem = name[: name.rfind(".") + 1]
    return name.endswith(SOURCES) and any(header[header.rfind("/") + 1 :].startswith(stem) for header, *_ in included)


def _opaque(source: Text, computed: list[Include]) -> tuple[Opaque, ...]:
    return tuple(
        Opaque(
            Facet.USES,
            f"the header in '#include {item.name}' is known only to the preprocessor",
            source.span(item.start, item.start + len(item.name)),
        )
        for item in computed
    )
