"""Files of the cache folder: values of our own classes, written so that they can be read again without any other code.

A pickle calls what it names. Here a name means a class of facts or nothing, and a pickle gets something that makes objects of
this class and not the class itself, because the attributes of a class can be set. A file or a folder that another user can
write is neither read nor written.
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
"""The modules with classes of facts and reports."""

_MOST_BYTES = 64 << 20
"""Of a file. One of autoware.universe, with 500 packages, has 1 MB."""


class _Members(Sealed):
    """Makes members of an enumeration. A method of the enumeration would do, but its attributes could be set."""

    __slots__ = ("_of",)

    def __init__(self, of: type[Sealed]) -> None:
        self._of: Callable[[Any], Sealed] = of

    def __call__(self, value: Any) -> Sealed:
        return self._of(value)


@lru_cache(maxsize=len(MODULES))
def classes(module: str) -> Mapping[str, type]:
    """Return the classes of facts that a module defines, by their names: named tuples and sealed enumerations.

    There are none in a module that is not listed. What a module imports is none of its classes.
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
    """Return what makes objects of a class of facts. Raises LookupError for every other name."""
    made = classes(module).get(name)
    if made is None:
        raise LookupError(f"{module}.{name} is no class of facts")
    if issubclass(made, Sealed):
        return _Members(made)
    call: Callable[..., Any] = type.__call__.__get__(made)  # has no attributes that could be set
    return call


def load(path: str, state: str) -> Any:
    """Return the value that a file keeps, None when it is damaged, of another state, or can be written by another user."""
    import io  # noqa: PLC0415
    import pickle  # noqa: PLC0415  (a run that keeps nothing needs none of it)

    class Facts(pickle.Unpickler):
        """Makes objects of our own classes of facts, and refuses all other names."""

        def find_class(self, module: str, name: str) -> Any:
            return maker(module, name)

    try:
        if not files.is_private(os.path.dirname(path)):
            return None
        head, _, body = files.read(path, _MOST_BYTES, links=False, own=True).partition(b"\n")
        return Facts(io.BytesIO(body)).load() if head == _head(state, body) else None
    except Exception:  # what a damaged pickle raises is not limited: MemoryError, RecursionError, OverflowError and others
        return None


def save(path: str, state: str, value: Any) -> bool:
    """Write a file in one step, and return whether it is written. A folder that another user can write stays as it is."""
    import io  # noqa: PLC0415
    import pickle  # noqa: PLC0415
    import tempfile  # noqa: PLC0415  (a run that finds all that it needs writes nothing)

    folder, temporary = os.path.dirname(path), ""
    try:
        os.makedirs(folder, mode=0o700, exist_ok=True)
        if not files.is_private(folder):
            return False
        body = io.BytesIO()
        pickler = pickle.Pickler(body, protocol=5)
        pickler.dispatch_table = _reducers()
        pickler.dump(value)
        if body.tell() > _MOST_BYTES - len(_head(state, b"")) - 1:
            return False
        handle, temporary = tempfile.mkstemp(dir=folder)
        with os.fdopen(handle, "wb") as file:
            file.write(_head(state, body.getbuffer()) + b"\n")
            file.write(body.getbuffer())
        os.replace(temporary, path)
    except Exception:  # a run does not fail because nothing can be kept: the disk is full, a fact is nested too deep
        if temporary and os.path.exists(temporary):
            os.unlink(temporary)
        return False
    return True


def _head(state: str, body: bytes | memoryview) -> bytes:
    """Return the first line of a file. With its checksum a file that is damaged is not read."""
    return f"{state} {zlib.crc32(body):08x}".encode()


def _reducers() -> dict[type, Callable[[Any], tuple[type, tuple[Any, ...]]]]:
    """Return how to take facts apart, which takes the pickler twice as long by itself.

    Of enumerations as well: Python 3.11.2, that of Debian 12, writes them down as a call of getattr(), which is none of ours.
    """
    found = [value for module in MODULES if module in sys.modules for value in classes(module).values()]
    return {each: _member if issubclass(each, Sealed) else _parts for each in found}


def _parts(fact: tuple[Any, ...]) -> tuple[type, tuple[Any, ...]]:
    return fact.__class__, tuple(fact)


def _member(fact: Any) -> tuple[type, tuple[Any, ...]]:
    return fact.__class__, (fact.value,)
