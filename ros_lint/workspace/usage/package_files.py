"""The data about one package that the resolution of names (headers, modules) to packages needs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from ros_lint.collectors.suffixes import HEADERS
from ros_lint.facts.build import NOTHING_BUILT, BuildScript
from ros_lint.facts.launch import LaunchFile
from ros_lint.facts.sources import FileFacts
from ros_lint.facts.visibility import Opaque


class PackageSource(NamedTuple):
    """A package with its files and the data extracted from them, in the form that the resolution of names to packages needs."""

    name: str
    path: str
    files: tuple[str, ...]
    """Paths of all files, relative to the package."""
    script: BuildScript | None
    facts: Mapping[str, FileFacts]
    """The facts (data that collectors extract from one file), by path relative to the package."""
    launch: tuple[LaunchFile, ...]
    builds_with: str

    @property
    def built(self) -> BuildScript:
        """The build script; if there is none, a BuildScript that builds and installs nothing."""
        return self.script or NOTHING_BUILT


def include_index(sources: Iterable[PackageSource]) -> dict[str, tuple[str, ...]]:
    """Return, for each header below a folder ``include``, the names of the packages that have it.

    The key is the path as written in an include: ``geometry/line.hpp``.
    """
    index: dict[str, tuple[str, ...]] = {}
    for source in sources:
        for file in source.files:
            if not file.endswith(HEADERS):
                continue
            _, marker, header = f"/{file}".partition("/include/")
            if not marker:
                continue
            # include/<package>/<package>/x.hpp and include/<package>/x.hpp are both included as <package>/x.hpp.
            for spelling in {header, header.removeprefix(f"{source.name}/") if header.count("/") > 1 else header}:
                owners = index.get(spelling, ())
                if source.name not in owners:
                    index[spelling] = (*owners, source.name)
    return index


def opaque_of(source: PackageSource) -> tuple[Opaque, ...]:
    """Return all places of a package that could not be evaluated, sorted."""
    places: list[Opaque] = list(source.built.opaque)
    for facts in source.facts.values():
        places += facts.opaque
    for launch in source.launch:
        places += launch.opaque
    return tuple(sorted(places, key=lambda opaque: (opaque.span, opaque.reason)))
