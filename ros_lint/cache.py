"""Keep the facts of files between runs, in the user's cache folder and never in the workspace.

What a workspace could plant is not loaded: the folder is the user's own, and unpickling makes no object but facts.
A file counts as unchanged when its time, size and mode are; facts depend on nothing but its text.
"""

from __future__ import annotations

import hashlib
import io
import os
import pickle
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from ros_lint import __version__
from ros_lint.tree import Stamp, Tree

_MODULES = frozenset({
    "ros_lint.collect", "ros_lint.collectors.cmake_syntax", "ros_lint.facts", "ros_lint.rule", "ros_lint.suppress",
    "ros_lint.text", "ros_lint.tree",
})  # fmt: skip


class _Facts(pickle.Unpickler):
    """Loads values of our own fact classes, and refuses everything else."""

    def find_class(self, module: str, name: str) -> Any:
        if module in _MODULES and "." not in name:
            return super().find_class(module, name)
        raise pickle.UnpicklingError(f"{module}.{name} is no fact")


class Cache:
    """Facts by path and stamp. An empty ``folder`` keeps nothing. Nothing here raises: a cache that fails is empty."""

    def __init__(self, folder: str, base: str) -> None:
        self._file = ""
        if folder:
            name = hashlib.sha256(os.path.realpath(base).encode("utf-8", "surrogateescape")).hexdigest()[:24]
            self._file = os.path.join(folder, f"{name}.facts")
        self._kept: dict[str, tuple[Stamp, Any]] = self._load() if self._file else {}

    def fetch(self, tree: Tree, paths: Sequence[str]) -> dict[str, Any]:
        """Return what is kept of those files that have not changed."""
        if not self._kept:
            return {}
        found = {}
        for path in paths:
            kept = self._kept.get(path)
            if kept is not None and kept[0] == _stamp(tree, path):
                found[path] = kept[1]
        return found

    def store(self, tree: Tree, fresh: Mapping[str, Any]) -> None:
        """Keep what was read now, besides what was kept of files that are still there."""
        if not self._file or not fresh:
            return
        for path, collected in fresh.items():
            if (stamp := _stamp(tree, path)) is not None:
                self._kept[path] = (stamp, collected)
        temporary = ""
        try:
            os.makedirs(os.path.dirname(self._file), mode=0o700, exist_ok=True)
            handle, temporary = tempfile.mkstemp(dir=os.path.dirname(self._file))
            with os.fdopen(handle, "wb") as file:
                file.write(_state().encode() + b"\n")
                pickler = pickle.Pickler(file, protocol=5)
                pickler.dispatch_table = _reducers()
                pickler.dump(self._kept)
            os.replace(temporary, self._file)
        except OSError:
            if temporary and os.path.exists(temporary):
                os.unlink(temporary)

    def _load(self) -> dict[str, tuple[Stamp, Any]]:
        try:
            with open(self._file, "rb") as file:
                state, _, data = file.read().partition(b"\n")
            if state == _state().encode():
                kept = _Facts(io.BytesIO(data)).load()
                return kept if isinstance(kept, dict) else {}
        except (OSError, pickle.UnpicklingError, EOFError, AttributeError, TypeError, ValueError, IndexError):
            pass
        return {}


def folder(environment: Mapping[str, str]) -> str:
    """Return the user's cache folder for ros-lint, or "" when the system has none (XDG base directories)."""
    home = environment.get("HOME") or environment.get("USERPROFILE") or ""
    above = environment.get("XDG_CACHE_HOME") or (os.path.join(home, ".cache") if home else "")
    return os.path.join(above, "ros-lint") if os.path.isabs(above) else ""


def _reducers() -> dict[type, Callable[[Any], tuple[type, tuple[Any, ...]]]]:
    """Return how to take facts apart, which takes the pickler twice as long by itself."""
    classes = [value for module in _MODULES if module in sys.modules for value in vars(sys.modules[module]).values()]
    return {each: _parts for each in classes if isinstance(each, type) and issubclass(each, tuple)}


def _parts(fact: tuple[Any, ...]) -> tuple[type, tuple[Any, ...]]:
    return fact.__class__, tuple(fact)


def _stamp(tree: Tree, path: str) -> Stamp | None:
    try:
        return tree.stamp(path)
    except OSError:
        return None


def _state() -> str:
    """Return what the facts depend on besides the files: the interpreter and the very code of the collectors."""
    here = os.path.dirname(os.path.abspath(__file__))
    code = []
    for directory in (here, os.path.join(here, "collectors")):
        with os.scandir(directory) as entries:
            code += [
                f"{entry.name}{(found := entry.stat()).st_mtime_ns}{found.st_size}"
                for entry in sorted(entries, key=lambda entry: entry.name)
                if entry.name.endswith(".py")
            ]
    digest = hashlib.sha256("".join(code).encode()).hexdigest()[:16]
    return f"ros-lint {__version__} {sys.implementation.cache_tag} {digest}"
