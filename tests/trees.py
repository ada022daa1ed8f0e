"""Trees of files that behave as disks do at their worst."""

from __future__ import annotations

from collections.abc import Mapping

from ros_lint.base.tree import MemoryTree


class Locked(MemoryTree):
    """Has a file without permission to read it."""

    def __init__(self, files: Mapping[str, str | bytes], locked: str, executable: frozenset[str] = frozenset()) -> None:
        super().__init__(files, executable)
        self._locked = locked

    def read(self, path: str) -> bytes:
        if path == self._locked:
            raise PermissionError(13, "Permission denied", path)
        return super().read(path)
