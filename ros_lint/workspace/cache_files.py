"""Read and write files of the cache folder, which contain only facts and reports.

A pickle can call any function by its name. Here, a name resolves to a class of facts or to nothing, and the unpickler gets
a function that creates objects of the class, not the class itself, because attributes of a class can be set. A file
or folder that another user can write is neither read nor written.
"""

from __future__ import annotations

import os
import sys
import zlib
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any

from ros_lint.base import files
from ros_lint.base.sealed import Sealed

MODULES = (
    "ros_lint.analysis.finding", "ros_lint.analysis.rule", "ros_lint.base.edit", "ros_lint.base.text", "ros_lint.base.tree",
    "ros_lint.collectors.cmake.syntax", "ros_lint.engine.report", "ros_lint.facts.build", "ros_lint.facts.cmake",
    "ros_lint.facts.interfaces", "ros_lint.facts.launch", "ros_lint.facts.manifest", "ros_lint.facts.repositories",
    "ros_lint.facts.setup_py", "ros_lint.facts.sources", "ros_lint.facts.suppressions", "ros_lint.facts.visibility",
    "ros_lint.workspace.collect", "ros_lint.workspace.target",
)  # fmt: skip
"""Modules with classes of facts and reports."""

_MAX_BYTES = 64 << 20
"""Maximum size of a file in bytes. The file of autoware.universe, with 500 packages, has 1 MB."""


class _MemberConstructor(Sealed):
    """Creates members of an enumeration; unlike a method of the enumeration, it has no attributes to set."""

    __slots__ = ("_enumeration",)

    def __init__(self, enumeration: type[Sealed]) -> None:
        self._enumeration: Callable[[Any], Sealed] = enumeration

    def __call__(self, value: Any) -> Sealed:
        return self._enumeration(value)


@lru_cache(maxsize=len(MODULES))
def classes(module: str) -> Mapping[str, type]:
    """Return the classes of facts defined in a module, by name: named tuples and sealed enumerations.

    The result is empty for a module that is not in ``MODULES``. Imported classes are left out.
    """
    if module not in MODULES:
        return {}
    from importlib import import_module  # noqa: PLC0415

    return {
        name: value
        for name, value in vars(import_module(module)).items()
        if issubclass(type(value), type)  # isinstance() takes an alias such as tuple[str, ...] for a class in Python 3.10
        and issubclass(value, tuple | Sealed)
        and (value.__module__, value.__qualname__) == (module, name)
    }


def maker(module: str, name: str) -> Callable[..., Any]:
    """Return a function that creates objects of a class of facts. Raises LookupError for other names."""
    fact_class = classes(module).get(name)
    if fact_class is None:
        raise LookupError(f"{module}.{name} is not a class of facts")
    if issubclass(fact_class, Sealed):
        return _MemberConstructor(fact_class)
    call: Callable[..., Any] = type.__call__.__get__(fact_class)  # a method wrapper: its attributes cannot be set
    return call


def load(path: str, state: str) -> Any:
    """Return the value in a cache file; ``state`` identifies the version of ros-lint and of its data.

    None if the file is damaged, was written with another ``state``, or can be written by another user.
    """
    import io  # noqa: PLC0415
    import pickle  # noqa: PLC0415  (not needed by a run without a cache)

    class Facts(pickle.Unpickler):
        """Creates objects of the classes of facts, and rejects all other names."""

        def find_class(self, module: str, name: str) -> Any:
            return maker(module, name)

    try:
        if not files.is_private(os.path.dirname(path)):
            return None
        head, _, body = files.read(path, _MAX_BYTES, links=False, private=True).partition(b"\n")
        return Facts(io.BytesIO(body)).load() if head == _head(state, body) else None
    except Exception:  # the errors of a damaged pickle are not limited: MemoryError, RecursionError, OverflowError and others
        return None


def save(path: str, state: str, value: Any) -> bool:
    """Write ``value`` to a cache file atomically, and return whether the file was written.

    ``state`` identifies the version of ros-lint and of its data. Nothing is written to a folder that another user can
    write.
    """
    import io  # noqa: PLC0415
    import pickle  # noqa: PLC0415
    import tempfile  # noqa: PLC0415  (not needed if everything is cached)

    folder, temporary = os.path.dirname(path), ""
    try:
        os.makedirs(folder, mode=0o700, exist_ok=True)
        if not files.is_private(folder):
            return False
        body = io.BytesIO()
        pickler = pickle.Pickler(body, protocol=5)
        pickler.dispatch_table = _reducers()
        pickler.dump(value)
        if body.tell() > _MAX_BYTES - len(_head(state, b"")) - 1:
            return False
        handle, temporary = tempfile.mkstemp(dir=folder)
        with os.fdopen(handle, "wb") as file:
            file.write(_head(state, body.getbuffer()) + b"\n")
            file.write(body.getbuffer())
        os.replace(temporary, path)
    except Exception:  # the run continues without a cache: the disk may be full, or a fact too deeply nested
        if temporary and os.path.exists(temporary):
            os.unlink(temporary)
        return False
    return True


def _head(state: str, body: bytes | memoryview) -> bytes:
    """Return the first line of a cache file with the given body: the state and a checksum, which reveals damage."""
    return f"{state} {zlib.crc32(body):08x}".encode()


def _reducers() -> dict[type, Callable[[Any], tuple[type, tuple[Any, ...]]]]:
    """Return reducers for facts: the default reducers of pickle take twice as long.

    Enumerations need a reducer, too: Python 3.11.2, the version of Debian 12, pickles their members as a call of
    getattr(), which :func:`load` rejects.
    """
    fact_classes = [value for module in MODULES if module in sys.modules for value in classes(module).values()]
    return {fact_class: _member if issubclass(fact_class, Sealed) else _parts for fact_class in fact_classes}


def _parts(fact: tuple[Any, ...]) -> tuple[type, tuple[Any, ...]]:
    return fact.__class__, tuple(fact)


def _member(fact: Any) -> tuple[type, tuple[Any, ...]]:
    return fact.__class__, (fact.value,)
