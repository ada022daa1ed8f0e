"""Look up the files that launch files name from their own folder, as ``$(dirname)`` and ``__file__`` do.

The folder of an installed launch file is its folder in the install space, which can have another layout than the sources.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from ros_lint.base.paths import is_outside, parent, resolve, strip_folder
from ros_lint.facts.build import BuildScript
from ros_lint.facts.launch import BESIDE, LaunchFile, LaunchReference


def with_places(
    launch: Sequence[LaunchFile], package: str, folder: str, files: Collection[str], script: BuildScript | None
) -> tuple[LaunchFile, ...]:
    """Return launch files whose references to files beside them name their package.

    ``folder`` is the folder of the package, and ``files`` are its files, relative to it. Left out are references that lead
    out of the package, and references of a launch file that is not installed to files that exist in the sources.
    """
    if not any(reference.package == BESIDE for file in launch for reference in file.references):
        return tuple(launch)
    share = f"share/{package}/"
    provides = script.products.installs if script else ()
    installed = {file.source: file.path[len(share) :] for file in reversed(provides) if file.path.startswith(share)}
    return tuple([_placed(file, package, strip_folder(folder, file.path), installed, files) for file in launch])


def _placed(file: LaunchFile, package: str, path: str, installed: Mapping[str, str], files: Collection[str]) -> LaunchFile:
    place = installed.get(path)
    own = parent(path if place is None else place)

    def named(name: str) -> str:
        """Return the path below the share folder, or in the sources; "" if the file exists or is not of the package."""
        result = resolve(own, name)
        return "" if is_outside(result) or (place is None and result in files) else result

    def replaced() -> Iterator[LaunchReference]:
        for reference in file.references:
            if reference.package != BESIDE:
                yield reference
            elif name := named(reference.name):
                fallback_for = tuple(
                    [(owner or package, other if owner else named(other)) for owner, other in reference.fallback_for]
                )
                yield reference._replace(package=package, name=name, fallback_for=fallback_for)

    return file._replace(references=tuple(replaced()))
