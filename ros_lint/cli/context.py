"""Find the package of a path, and the folder around the package. The other packages of this folder are read as context."""

from __future__ import annotations

import os

from ros_lint.base.paths import is_below, upwards
from ros_lint.base.tree import DiskTree, repository_of

_BUILT = ("build", "install", "log")
"""Folders that colcon creates beside ``src``."""


def requested_folder(path: str) -> str:
    """Return the folder to check for a path: the folder itself, or the package that contains the file or folder.

    ``path`` is absolute and exists. A folder that is in a package and contains packages of its own is not replaced. Returns ""
    for a file outside any package.
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
    """Return the absolute folder whose packages are read in order to check an absolute ``folder``.

    It is the workspace that contains the folder, else the folder itself. A repository and a colcon workspace are checked
    without the packages around them. The home folder and the folders above it are no context, because they contain
    unrelated repositories.
    """
    around = "" if _is_workspace(folder) else workspace_around(folder)
    home = os.path.realpath(os.path.expanduser("~"))
    return folder if not around or is_below(home, around) or os.path.dirname(around) == around else around


def workspace_around(folder: str) -> str:
    """Return the workspace that contains an absolute folder, "" if there is none.

    It is the first of these folders that exists:

    - the folder whose ``src`` contains the package of ``folder``, if both are in one repository or colcon has built there,
    - the repository.
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
    """Return the outermost package that contains an absolute folder, in its repository; else the folder itself.

    colcon does not look for packages inside of packages.
    """
    repository = repository_of(folder)
    packages = [place for place in upwards(folder) if is_below(place, repository) and _is_package(place)]
    return packages[-1] if packages else folder


def _is_workspace(folder: str) -> bool:
    """Return whether a folder is a repository, or the folder or the ``src`` of a colcon workspace."""
    if os.path.exists(os.path.join(folder, ".git")):
        return True
    is_source = os.path.basename(folder) == "src" and not _is_package(os.path.dirname(folder))
    return not _is_package(folder) and (is_source or os.path.isdir(os.path.join(folder, "src")))


def _is_package(folder: str) -> bool:
    return os.path.isfile(os.path.join(folder, "package.xml"))


def _has_packages(folder: str) -> bool:
    from ros_lint.workspace.discovery.discover import discover  # noqa: PLC0415  (only for a folder inside a package)

    return bool(discover(DiskTree(folder), ("",)).packages)
