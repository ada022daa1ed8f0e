"""The files of a workspace that fixes may write."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from ros_lint.base.paths import is_below, join
from ros_lint.base.tree import Entry, Tree


class Writable:
    """The files that a fix may write: files below the requested folders that have only one path.

    ``roots`` are the requested folders and ``paths`` the files of all packages, both relative to the base folder of the tree.
    Links are resolved. A link gives a file a second path.
    """

    def __init__(self, tree: Tree, roots: Iterable[str], paths: Iterable[str]) -> None:
        self._tree = tree
        self._roots = [tree.identity(root) for root in roots]
        self._names = names_of_files(tree, dict.fromkeys(paths))

    def refusal(self, path: str) -> str:
        """Return the reason why a fix must not write a file, "" if it may write the file."""
        identity = self._tree.identity(path)
        if not any(is_below(identity, root) for root in self._roots):
            return f"'{path}' is outside the folders to check"
        names = self._names.get(identity, ())
        return f"{' and '.join(map(repr, names))} are the same file" if len(names) > 1 else ""


def names_of_files(tree: Tree, paths: Iterable[str]) -> dict[str, list[str]]:
    """Return, by the real path of each file, those of the ``paths`` that lead to it. Only links give a file several paths."""
    paths_by_identity: dict[str, list[str]] = {}
    folders: dict[str, tuple[str, frozenset[str]]] = {}
    for path in paths:
        folder, _, name = path.rpartition("/")
        if folder not in folders:
            folders[folder] = tree.identity(folder), frozenset(entry.name for entry in _entries(tree, folder) if entry.link)
        folder_identity, links = folders[folder]
        paths_by_identity.setdefault(tree.identity(path) if name in links else join(folder_identity, name), []).append(path)
    return paths_by_identity


def _entries(tree: Tree, folder: str) -> Sequence[Entry]:
    try:
        return tree.list(folder)
    except OSError:
        return ()
