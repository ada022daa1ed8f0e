"""Find the Python distributions that a package requires from pip: in its requirement files and in its setup.py."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from ros_lint.base.paths import join
from ros_lint.base.tree import Tree, text_of
from ros_lint.collectors.colcon.python_project import from_setup_py

_FILE = re.compile(r"(?:.*/)?requirements[\w.-]*\.(?:txt|in)\Z")
_LINE = re.compile(r"^[ \t]*([A-Za-z][\w.-]*)", re.MULTILINE)


def pip_requirements(tree: Tree, folder: str, files: Iterable[str]) -> frozenset[str]:
    """Return the normalized names of the distributions in the ``requirements*.txt`` files and the setup.py of a package.

    ``files`` are the files of the package, relative to its ``folder``.
    """
    return frozenset(normalized(name) for name in _names(tree, folder, files))


def normalized(name: str) -> str:
    """Return the name of a distribution in lower case and with underscores, the usual form of a module name."""
    return re.sub(r"[-_.]+", "_", name).lower()


def _names(tree: Tree, folder: str, files: Iterable[str]) -> Iterator[str]:
    for file in files:
        text = text_of(tree, join(folder, file)) if file == "setup.py" or _FILE.match(file) else None
        if text is None:
            continue
        if file == "setup.py":
            yield from (depend.name for depend in from_setup_py(text, None, None).depends)
        else:
            yield from _LINE.findall(text.text)
