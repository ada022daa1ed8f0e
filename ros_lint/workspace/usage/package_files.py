"""The files of a package as the resolution of names sees them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from ros_lint.collectors.suffixes import HEADERS
from ros_lint.facts.build import NOTHING_BUILT, BuildScript
from ros_lint.facts.launch import LaunchFile
from ros_lint.facts.sources import FileFacts
from ros_lint.facts.visibility import Opaque


class Source(NamedTuple):
    """What evidence needs to know of one package."""

    name: str
    path: str
    files: tuple[str, ...]
    """Relative to the package."""
    script: BuildScript | None
    facts: Mapping[str, FileFacts]
    """By path relative to the package."""
    launch: tuple[LaunchFile, ...]
    builds_with: str

    @property
    def built(self) -> BuildScript:
        """Return the build script, one that builds and installs nothing where there is none."""
        return self.script or NOTHING_BUILT


def include_index(sources: Iterable[Source]) -> dict[str, tuple[str, ...]]:
    """Return, for every header below an ``include`` folder of the workspace, the packages that have it, by include path."""
    found: dict[str, tuple[str, ...]] = {}
    for source in sources:
        for file in source.files:
            if not file.endswith(HEADERS):
                continue
            _, marker, header = f"/{file}".partition("/include/")
            if not marker:
                continue
            # include/<package>/<package>/x.hpp and include/<package>/x.hpp are both written <package>/x.hpp.
            for spelling in {header, header.removeprefix(f"{source.name}/") if header.count("/") > 1 else header}:
                have = found.get(spelling, ())
                if source.name not in have:
                    found[spelling] = (*have, source.name)
    return found


def opaque_of(source: Source) -> tuple[Opaque, ...]:
    """Return everything that hides a side of the package."""
    found: list[Opaque] = list(source.built.opaque)
    for facts in source.facts.values():
        found += facts.opaque
    for launch in source.launch:
        found += launch.opaque
    return tuple(sorted(found, key=lambda opaque: (opaque.span, opaque.reason)))
