"""Files that name sources which belong to a workspace and need not be there."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from ros_lint.tree import Tree, join, parent, text_of

_ENDINGS = (".repos", ".rosinstall", ".gitmodules")


def find(tree: Tree, roots: Sequence[str], files: Iterable[str]) -> tuple[str, ...]:
    """Return the ``*.repos`` (vcstool), ``*.rosinstall`` (wstool) and ``.gitmodules`` of a workspace, sorted.

    Looked for are the base of the tree, the roots and the folders directly in either, and ``files``, which are those of
    packages. What cannot be read has none.
    """
    found = {path for path in files if path.endswith(_ENDINGS)}
    for top in {"", *roots}:
        folders = [top]
        for number, folder in enumerate(folders):
            try:
                entries = tree.list(folder)
            except OSError:
                continue
            found.update(join(folder, entry.name) for entry in entries if entry.name.endswith(_ENDINGS))
            if number == 0:
                inner = [entry.name for entry in entries if entry.kind == "directory" and not entry.name.startswith(".")]
                folders += [join(top, name) for name in inner]
    return tuple(sorted(found))


_SUBMODULE = re.compile(r"^[ \t]*path[ \t]*=[ \t]*(.+?)[ \t\r]*$", re.MULTILINE)


def submodules(tree: Tree, lists: Iterable[str]) -> tuple[str, ...]:
    """Return the folders that the ``.gitmodules`` among the lists name and that are empty, or not there: not cloned yet."""
    found = []
    for path in lists:
        if path.rpartition("/")[2] != ".gitmodules":
            continue
        text = text_of(tree, path)
        folders = (join(parent(path), match[1].strip("/")) for match in _SUBMODULE.finditer(text.text if text else ""))
        found += [folder for folder in folders if not _has_entries(tree, folder)]
    return tuple(sorted(found))


_REPOSITORY = re.compile(r"^[ \t]+['\"]?([\w./+-]+?)['\"]?[ \t]*:[ \t\r]*$|\blocal-name:[ \t]*['\"]?([\w./+-]+)", re.MULTILINE)


def repositories(tree: Tree, lists: Iterable[str]) -> frozenset[str]:
    """Return how the folders are called into which ``*.repos`` and ``*.rosinstall`` have repositories fetched."""
    texts = [text.text for path in lists if not path.endswith(".gitmodules") and (text := text_of(tree, path))]
    found = (match[1] or match[2] for text in texts for match in _REPOSITORY.finditer(text))
    return frozenset([folder.rstrip("/").rpartition("/")[2] for folder in found])


def _has_entries(tree: Tree, folder: str) -> bool:
    try:
        return bool(tree.list(folder))
    except OSError:
        return False
