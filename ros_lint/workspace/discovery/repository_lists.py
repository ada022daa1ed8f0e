"""Files that list repositories of a workspace, which need not be cloned."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

from ros_lint.base.paths import join, parent
from ros_lint.base.tree import Tree, text_of
from ros_lint.facts.repositories import ExpectedRepositories
from ros_lint.workspace.target import UnreadFile

_ENDINGS = (".repos", ".rosinstall", ".gitmodules")


def find_lists(tree: Tree, roots: Sequence[str], files: Iterable[str]) -> tuple[str, ...]:
    """Return the ``*.repos`` (vcstool), ``*.rosinstall`` (wstool) and ``.gitmodules`` files, sorted.

    Searched are the base of the tree, the roots, the direct subfolders of both, and ``files``, the files of
    packages. Folders that cannot be read count as empty.
    """
    result = {path for path in files if path.endswith(_ENDINGS)}
    for top in {"", *roots}:
        folders = [top]
        for number, folder in enumerate(folders):
            try:
                entries = tree.list(folder)
            except OSError:
                continue
            lists = [entry.name for entry in entries if entry.name.endswith(_ENDINGS) and entry.kind != "directory"]
            result.update(join(folder, name) for name in lists)
            if number == 0:
                inner = [entry.name for entry in entries if entry.kind == "directory" and not entry.name.startswith(".")]
                folders += [join(top, name) for name in inner]
    return tuple(sorted(result))


def unreadable_lists(tree: Tree, lists: Iterable[str]) -> Iterator[UnreadFile]:
    """Yield the lists that cannot be read, such as a FIFO of that name."""
    for path in lists:
        try:
            tree.read(path)
        except FileNotFoundError:
            continue  # a dangling link
        except OSError as error:
            yield UnreadFile.of(path, error)


_SUBMODULE = re.compile(r"^[ \t]*path[ \t]*=[ \t]*(.+?)[ \t\r]*$", re.MULTILINE)


def submodules(tree: Tree, lists: Iterable[str]) -> tuple[str, ...]:
    """Return the folders of submodules that are not cloned: empty or missing."""
    result = []
    for path in lists:
        if path.rpartition("/")[2] != ".gitmodules":
            continue
        text = text_of(tree, path)
        folders = (join(parent(path), match[1].strip("/")) for match in _SUBMODULE.finditer(text.text if text else ""))
        result += [folder for folder in folders if not _has_entries(tree, folder)]
    return tuple(sorted(result))


_REPOSITORY = re.compile(r"^[ \t]+['\"]?([\w./+-]+?)['\"]?[ \t]*:[ \t\r]*$|\blocal-name:[ \t]*['\"]?([\w./+-]+)", re.MULTILINE)


def expected_repositories(tree: Tree, lists: Iterable[str], submodules: Iterable[str]) -> ExpectedRepositories:
    """Return the repositories in the lists of a workspace, and the submodules that are not cloned."""
    texts = [text.text for path in lists if not path.endswith(".gitmodules") and (text := text_of(tree, path))]
    folders = (match[1] or match[2] for text in texts for match in _REPOSITORY.finditer(text))
    return ExpectedRepositories(_names(submodules), _names(folder.rstrip("/") for folder in folders))


def _names(folders: Iterable[str]) -> frozenset[str]:
    return frozenset([folder.rpartition("/")[2] for folder in folders])


def _has_entries(tree: Tree, folder: str) -> bool:
    try:
        return bool(tree.list(folder))
    except OSError:
        return False
