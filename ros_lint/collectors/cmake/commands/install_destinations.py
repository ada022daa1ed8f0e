"""Where in the prefix an install() puts something, and which side of the package that is."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

from ros_lint.collectors.cmake.evaluator.run import Run
from ros_lint.collectors.cmake.evaluator.values import sure
from ros_lint.facts.visibility import Facet

ANYWHERE: Final = Facet.EXECUTABLES | Facet.SHARE | Facet.LIBRARIES | Facet.PYTHON
_TYPES: Final = {
    "BIN": "bin", "SBIN": "sbin", "LIB": "lib", "INCLUDE": "include", "SYSCONF": "etc", "SHAREDSTATE": "com",
    "LOCALSTATE": "var", "RUNSTATE": "var/run", "DATA": "share", "INFO": "share/info", "LOCALE": "share/locale",
    "MAN": "share/man", "DOC": "share/doc",
}  # fmt: skip


def facet_of(run: Run, destination: str | None) -> Facet:
    """Return which side of the package something installed there belongs to."""
    if not destination or destination == ".":
        return ANYWHERE
    if destination == "lib":
        return Facet.EXECUTABLES | Facet.LIBRARIES | Facet.PYTHON
    if destination.startswith("share"):
        return Facet.SHARE
    if destination.startswith("lib/python"):
        return Facet.PYTHON
    if destination in ("bin", f"lib/{run.sources.name}") or destination.startswith(f"lib/{run.sources.name}/"):
        return Facet.EXECUTABLES
    return Facet.LIBRARIES


def hide(run: Run, destination: str | None, reason: str) -> None:
    """Note that it is not known what comes to a place, None if that is unknown, too."""
    run.hide(facet_of(run, destination), reason, below=destination or "")


def place_of(run: Run, parts: Mapping[str, Sequence[str]]) -> str | None:
    """Return where sections of arguments say that files go, None if that is not known or lies outside of the prefix."""
    found = parts.get("DESTINATION")
    if found:
        return run.destination(sure(found[0])[0]) if len(found) == 1 else None
    kind = parts.get("TYPE")
    return _TYPES.get(kind[0]) if kind else None
