"""Destinations of install(), and the kinds of facts about a package (``Facet``) to which the installed files belong."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

from ros_lint.collectors.cmake.evaluator.run import Run
from ros_lint.collectors.cmake.evaluator.values import strip_mark
from ros_lint.facts.visibility import Facet

ANYWHERE: Final = Facet.EXECUTABLES | Facet.SHARE | Facet.LIBRARIES | Facet.PYTHON
_TYPES: Final = {
    "BIN": "bin", "SBIN": "sbin", "LIB": "lib", "INCLUDE": "include", "SYSCONF": "etc", "SHAREDSTATE": "com",
    "LOCALSTATE": "var", "RUNSTATE": "var/run", "DATA": "share", "INFO": "share/info", "LOCALE": "share/locale",
    "MAN": "share/man", "DOC": "share/doc",
}  # fmt: skip


def facet_of(run: Run, destination: str | None) -> Facet:
    """Return the kind of facts to which the files at a destination belong, such as SHARE.

    The result for an unknown destination (None) is ANYWHERE.
    """
    if not destination or destination == ".":
        return ANYWHERE
    if destination == "lib":
        return Facet.EXECUTABLES | Facet.LIBRARIES | Facet.PYTHON
    if destination.startswith("share"):
        return Facet.SHARE
    if destination.startswith("lib/python"):
        return Facet.PYTHON
    if destination in ("bin", f"lib/{run.paths.sources.name}") or destination.startswith(f"lib/{run.paths.sources.name}/"):
        return Facet.EXECUTABLES
    return Facet.LIBRARIES


def hide(run: Run, destination: str | None, reason: str) -> None:
    """Record that install() may install further, unknown files to a destination. None means an unknown destination."""
    run.hide(facet_of(run, destination), reason, below=destination or "")


def destination_of(run: Run, parts: Mapping[str, Sequence[str]]) -> str | None:
    """Return the folder to which a call of install() installs, relative to the install prefix.

    ``parts`` are the arguments of the call by keyword (see ``sections()``). The result is None if the folder is unknown or
    outside of the install prefix.
    """
    destinations = parts.get("DESTINATION")
    if destinations:
        return run.paths.destination(strip_mark(destinations[0])[0]) if len(destinations) == 1 else None
    kind = parts.get("TYPE")
    return _TYPES.get(kind[0]) if kind else None
