"""Find and read the ``.gitignore`` files of a workspace and its packages."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from ros_lint.base.gitignore import _NAME, Pattern, patterns
from ros_lint.base.paths import folders_of, join, parent
from ros_lint.base.text import read
from ros_lint.base.tree import Tree
from ros_lint.workspace.target import UnreadFile


class Ignores(NamedTuple):
    """The patterns in the ``.gitignore`` files of a workspace, and the ``.gitignore`` files that cannot be read."""

    patterns: tuple[Pattern, ...]
    """Patterns in the order of git: a later pattern overrides an earlier one."""
    not_checked: tuple[UnreadFile, ...]


def find_ignores(tree: Tree, packages: Iterable[tuple[str, Iterable[str]]]) -> Ignores:
    """Return the patterns of the ``.gitignore`` files that apply to ``packages``, pairs of a folder and the files in it."""
    paths = {_NAME}
    for folder, files in packages:
        paths.update([join(folder, file) for file in files if file.rpartition("/")[2] == _NAME])
        paths.update([join(parent_folder, _NAME) for parent_folder in folders_of(folder)])
    result: list[Pattern] = []
    unread: list[UnreadFile] = []
    for path in sorted(paths, key=lambda path: (path.count("/"), path)):
        try:
            result += patterns(parent(path), read(path, tree.read(path)).text)
        except (FileNotFoundError, NotADirectoryError):
            continue
        except OSError as error:
            unread.append(UnreadFile.of(path, error))
    return Ignores(tuple(result), tuple(unread))
