"""A file tree with only the files of a repository that git tracks, as in a fresh clone."""

from __future__ import annotations

import errno
import os
from collections.abc import Sequence
from typing import Final

from ros_lint.base.git_index import Tracked
from ros_lint.base.paths import folders_of, join
from ros_lint.base.tree import DiskTree, Entry, Stamp

_MOST_NESTING: Final = 2
"""Maximum number of levels from an untracked folder down to a repository in it, e.g. 2 in ``external/vendor/robot``."""
_MOST_FOLDERS: Final = 200
"""Maximum number of subfolders of an untracked folder in which repositories are searched for."""


class TrackedTree(DiskTree):
    """A disk tree without the untracked files of the git repository in its base folder.

    The tree includes all files below tracked links, submodules and other repositories, such as clones by vcstool.
    """

    __slots__ = ("_folders", "_foreign", "_tracked")

    def __init__(self, base: str, inside: Sequence[str], tracked: Tracked) -> None:
        super().__init__(base, inside)
        self._tracked = tracked
        self._folders = frozenset([folder for file in tracked.files for folder in folders_of(file)])
        self._foreign: dict[str, bool] = {}

    def list(self, path: str) -> list[Entry]:
        if self._is_foreign(path):
            return super().list(path)
        return [entry for entry in super().list(path) if self._is_visible(join(path, entry.name), entry.kind == "directory")]

    def read(self, path: str) -> bytes:
        self._check(path)
        return super().read(path)

    def stamp(self, path: str) -> Stamp:
        self._check(path)
        return super().stamp(path)

    def is_untracked(self, path: str) -> bool:
        return not path.startswith("../") and not self._is_visible(path) and os.path.lexists(self.place(path))

    def _check(self, path: str) -> None:
        if not self._is_visible(path):
            raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), path)

    def _is_visible(self, path: str, folder: bool = False) -> bool:
        if path in self._tracked.files or path in self._folders or not path or self._is_foreign(path):
            return True
        return folder and self._leads_to_repository(path, _MOST_NESTING)

    def _is_foreign(self, path: str) -> bool:
        """Return whether a path is, or is below, a tracked link, a submodule or another repository."""
        return any(self._is_foreign_folder(folder) for folder in (path, *folders_of(path)) if folder)

    def _is_foreign_folder(self, folder: str) -> bool:
        if folder in self._folders:
            return False
        if folder not in self._foreign:
            is_link = folder in self._tracked.links
            self._foreign[folder] = is_link or os.path.exists(os.path.join(self.place(folder), ".git"))
        return self._foreign[folder]

    def _leads_to_repository(self, folder: str, depth: int) -> bool:
        if not depth:
            return False
        try:
            with os.scandir(self.place(folder)) as entries:
                folders = [entry.name for entry in entries if entry.is_dir(follow_symlinks=False)][:_MOST_FOLDERS]
        except OSError:
            return False
        paths = [join(folder, name) for name in sorted(folders)]
        return any(self._is_foreign_folder(path) or self._leads_to_repository(path, depth - 1) for path in paths)
