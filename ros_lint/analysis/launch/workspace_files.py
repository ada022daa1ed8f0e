"""The launch files and parameter files of a workspace, by their path in the sources and by their install path.

Each answer is about one file or one package, so that it remains valid if another file changes.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from ros_lint.analysis.memo import cached_by_name, cached_by_package, cached_by_workspace
from ros_lint.base.paths import strip_folder
from ros_lint.facts.launch import LaunchFile
from ros_lint.facts.sources import ParameterFile
from ros_lint.workspace.model import Package, Workspace


class InstalledPlaces(NamedTuple):
    """The places below share/<package> to which a package installs some of its files."""

    sources: Mapping[str, tuple[str, ...]]
    """The paths of the files by install path. Several files, or one file twice, may be installed to one path."""
    installed: Mapping[str, str]
    """The first install path of each file, by its path in the sources."""

    @classmethod
    def of(cls, package: Package, paths: Iterable[str]) -> InstalledPlaces:
        """Return the places of those files at ``paths`` that the package installs below share/<package>."""
        by_source = {strip_folder(package.path, path): path for path in paths}
        share = f"share/{package.name}/"
        sources: dict[str, tuple[str, ...]] = {}
        installed: dict[str, str] = {}
        for provided in package.built.products.installs if by_source else ():
            path = by_source.get(provided.source)
            if path is not None and provided.path.startswith(share):
                place = provided.path[len(share) :]
                sources[place] = (*sources.get(place, ()), path)
                installed.setdefault(path, place)
        return cls(sources, installed)


@cached_by_workspace
def file_owners(workspace: Workspace) -> Mapping[str, Package]:
    """Return the packages that contain the launch files and parameter files, by path of the file."""
    result = {file.path: package for package in workspace.packages for file in package.launch}
    result.update({file.path: package for package in workspace.packages for file in package.parameter_files})
    return result


@cached_by_package
def _launch_files(package: Package, _: Workspace) -> Mapping[str, LaunchFile]:
    return {file.path: file for file in package.launch}


@cached_by_package
def _parameter_files(package: Package, _: Workspace) -> Mapping[str, ParameterFile]:
    return {file.path: file for file in package.parameter_files}


@cached_by_package
def launch_places(package: Package, _: Workspace) -> InstalledPlaces:
    """Return the places to which a package installs its launch files."""
    return InstalledPlaces.of(package, [file.path for file in package.launch])


@cached_by_package
def parameter_places(package: Package, _: Workspace) -> InstalledPlaces:
    """Return the places to which a package installs its parameter files."""
    return InstalledPlaces.of(package, [file.path for file in package.parameter_files])


@cached_by_name
def launch_file(workspace: Workspace, path: str) -> LaunchFile | None:
    """Return the launch file of a package at ``path``, None if there is none. A question reads only this file."""
    owner = file_owners(workspace).get(path)
    return _launch_files(owner, workspace).get(path) if owner is not None else None


@cached_by_name
def parameter_file(workspace: Workspace, path: str) -> ParameterFile | None:
    """Return the parameter file of a package at ``path``, None if there is none. A question reads only this file."""
    owner = file_owners(workspace).get(path)
    return _parameter_files(owner, workspace).get(path) if owner is not None else None
