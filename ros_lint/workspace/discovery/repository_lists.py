"""Files that list the repositories of a workspace, which need not be cloned: ``*.repos``, ``*.rosinstall``, ``.gitmodules``."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

from ros_lint.base.paths import join, parent
from ros_lint.base.tree import Tree, text_of
from ros_lint.facts.repositories import ExpectedRepositories, UnclonedRepositories
from ros_lint.workspace.target import UnreadFile

ENDINGS = (".repos", ".rosinstall", ".gitmodules")
"""Ends of the names of files that list repositories."""


def find_lists(tree: Tree, roots: Sequence[str], files: Iterable[str]) -> tuple[str, ...]:
    """Return the paths of the ``*.repos`` (vcstool), ``*.rosinstall`` (wstool) and ``.gitmodules`` files, sorted.

    Searched are the base folder of the tree, the ``roots``, the direct subfolders of both, and ``files``, the other files that
    discovery has found. Folders that cannot be read count as empty.
    """
    result = {path for path in files if path.endswith(ENDINGS)}
    for top in {"", *roots}:
        folders = [top]
        for number, folder in enumerate(folders):
            try:
                entries = tree.list(folder)
            except OSError:
                continue
            lists = [entry.name for entry in entries if entry.name.endswith(ENDINGS) and entry.kind != "directory"]
            result.update(join(folder, name) for name in lists)
            if number == 0:
                inner = [entry.name for entry in entries if entry.kind == "directory" and not entry.name.startswith(".")]
                folders += [join(top, name) for name in inner]
    return tuple(sorted(result))


def unreadable_lists(tree: Tree, lists: Iterable[str]) -> Iterator[UnreadFile]:
    """Yield those ``lists`` of repositories that cannot be read, e.g. a FIFO called ``deps.repos``."""
    for path in lists:
        try:
            tree.read(path)
        except FileNotFoundError:
            continue  # a dangling link
        except OSError as error:
            yield UnreadFile.of(path, error)


_SUBMODULE = re.compile(r"^[ \t]*path[ \t]*=[ \t]*(.+?)[ \t\r]*$", re.MULTILINE)


def submodules(tree: Tree, lists: Iterable[str]) -> tuple[str, ...]:
    """Return the folders of git submodules that are not cloned, i.e. empty or missing, sorted."""
    of_git = [path for path in lists if path.rpartition("/")[2] == ".gitmodules"]
    return tuple(sorted(folder for path in of_git for folder in _submodules_of(tree, path) if not _has_entries(tree, folder)))


def _submodules_of(tree: Tree, path: str) -> list[str]:
    """Return the folders of all git submodules that the ``.gitmodules`` at ``path`` lists."""
    text = text_of(tree, path)
    return [join(parent(path), match[1].strip("/")) for match in _SUBMODULE.finditer(text.text if text else "")]


_KEY = re.compile(r"[ \t]+['\"]?([\w./+-]+?)['\"]?[ \t]*:[ \t]*\Z")
"""Matches the line with the folder of a repository in a file of vcstool."""
_NAME = re.compile(r"\b(?:local-name|ur[il]):[ \t]*['\"]?([^\s'\",}]+)")
"""Matches the folder or the URL of a repository in a file of wstool, or the URL in a file of vcstool."""


def expected_repositories(
    tree: Tree, lists: Iterable[str], submodules: Iterable[str], packages: Iterable[tuple[str, str]]
) -> ExpectedRepositories:
    """Return the repositories that the ``lists`` of a workspace name, and those of them that are not cloned.

    ``submodules`` are the folders of submodules that are not cloned; ``packages`` are the names and paths of the packages.
    """
    present = {part for name, path in packages for part in (name, *path.split("/"))}
    empty = frozenset(submodules)
    listed: set[str] = set()
    uncloned = set(map(_last, empty))
    missing: list[UnclonedRepositories] = []
    for path in lists:
        if path.endswith(".gitmodules"):
            names = sorted(_last(folder) for folder in _submodules_of(tree, path) if folder in empty)
        else:
            names = []
            for folder, *url in _repositories(tree, path):
                aliases = {_last(folder), *map(_last, url)}
                listed.update(aliases)
                if present.isdisjoint(aliases) and not _is_cloned(tree, path, folder):
                    uncloned.update(aliases)
                    names.append(_last(folder))
        if names:
            missing.append(UnclonedRepositories(path, tuple(sorted(set(names)))))
    return ExpectedRepositories(frozenset(uncloned), frozenset(listed), tuple(missing))


def _repositories(tree: Tree, path: str) -> Iterator[list[str]]:
    """Yield, for each repository of a list, its folder and, if the list contains it, its URL."""
    text = text_of(tree, path)
    values: list[str] = []
    for line in text.text.splitlines() if text else ():
        key = _KEY.match(line)
        if (key or line.lstrip().startswith("- ")) and values:
            yield values
            values = []
        if key:
            values.append(key[1])
        values += _NAME.findall(line)
    if values:
        yield values


def _is_cloned(tree: Tree, path: str, folder: str) -> bool:
    """Return whether a repository is cloned to a usual place. ``folder`` is its folder as written in the list at ``path``."""
    tops = dict.fromkeys((parent(path), join(parent(path), "src"), "", "src"))
    return any(_has_entries(tree, join(top, folder)) for top in tops)


def _last(place: str) -> str:
    """Return the name of a repository: the last component of its folder or URL, without ``.git``."""
    return re.split(r"[/:]", place.rstrip("/").removesuffix(".git"))[-1]


def _has_entries(tree: Tree, folder: str) -> bool:
    try:
        return bool(tree.list(folder))
    except OSError:
        return False
