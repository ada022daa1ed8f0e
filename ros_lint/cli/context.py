"""Find the folder to check for a path, and the workspace around the folder, because the check needs its other packages."""

from __future__ import annotations

import os

from ros_lint.base.paths import is_below, upwards
from ros_lint.base.tree import DiskTree, repository_of

_BUILT = ("build", "install", "log")
"""Folders that colcon creates next to ``src``."""


def requested_folder(path: str) -> str:
    """Return the folder to check for a path: the package that contains it, else the folder itself.

    Return "" for a file outside any package. ``path`` is absolute and exists. A folder that is in a package and contains
    packages of its own is returned as it is.
    """
    folder = path if os.path.isdir(path) else os.path.dirname(path)
    if _is_package(folder):
        return folder
    repository = repository_of(folder)
    above = upwards(folder)
    package = next((place for place in above if _is_package(place) and is_below(place, repository)), "")
    if not package or folder == repository:
        return path if folder == path else ""
    return folder if folder == path and _has_packages(folder) else package


def context_of(folder: str) -> str:
    """Return the absolute folder whose packages are read in order to check the absolute ``folder``.

    It is the workspace that contains ``folder``, else ``folder`` itself. If ``folder`` is a repository or a colcon
    workspace, packages around it are not read. The home folder and the folders above it are never returned, because they
    contain unrelated repositories.
    """
    around = "" if _is_workspace(folder) else workspace_around(folder)
    home = os.path.realpath(os.path.expanduser("~"))
    return folder if not around or is_below(home, around) or os.path.dirname(around) == around else around


def workspace_around(folder: str) -> str:
    """Return the workspace that contains an absolute folder, "" if there is none.

    It is the first of these folders that exists:

    - the parent folder of a ``src`` folder that contains ``folder``, if colcon has built in the parent folder or if
      ``folder`` and the parent folder are in one git repository,
    - the git repository that contains ``folder``.
    """
    folders = list(upwards(folder))
    repository = repository_of(folder)
    inside = folders[: folders.index(repository) + 1] if repository else folders
    start = outermost_package(folder)
    for place in folders[folders.index(start) + 1 :]:
        above = os.path.dirname(place)
        built = os.path.exists(os.path.join(above, ".colcon")) or any(os.path.isdir(os.path.join(above, name)) for name in _BUILT)
        if os.path.basename(place) == "src" and (built or (repository and above in inside)):
            return above
    return repository


def outermost_package(folder: str) -> str:
    """Return the outermost package in the same repository that contains an absolute folder; without a package, the folder itself.

    colcon does not search for packages inside of packages, so an inner package is part of the outermost one.
    """
    repository = repository_of(folder)
    packages = [place for place in upwards(folder) if is_below(place, repository) and _is_package(place)]
    return packages[-1] if packages else folder


def _is_workspace(folder: str) -> bool:
    """Return whether a folder is a git repository, or the root or the ``src`` folder of a colcon workspace."""
    if os.path.exists(os.path.join(folder, ".git")):
        return True
    is_source = os.path.basename(folder) == "src" and not _is_package(os.path.dirname(folder))
    return not _is_package(folder) and (is_source or os.path.isdir(os.path.join(folder, "src")))


def _is_package(folder: str) -> bool:
    return os.path.isfile(os.path.join(folder, "package.xml"))


def _has_packages(folder: str) -> bool:
    from ros_lint.workspace.discovery.discover import discover  # noqa: PLC0415  (only for a folder inside a package)

    return bool(discover(DiskTree(folder), ("",)).packages)
