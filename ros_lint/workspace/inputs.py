"""The inputs of rules: every part of a loaded workspace that a rule can read, with a name that is the same in the next run."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from hashlib import blake2b
from typing import TYPE_CHECKING, Any

from ros_lint.knowledge.world import inputs_of

if TYPE_CHECKING:
    from ros_lint.base.questions import Cell, RecordedMapping
    from ros_lint.workspace.handles import Handles

DIGEST_SIZE = 16
"""Number of bytes of the digest of an input."""

_ABSENT = bytes(DIGEST_SIZE)
_NOTHING = object()


class Inputs:
    """The inputs of rules in a recorded workspace: fields of packages, attributes of the workspace, names, and the world.

    The name of an input is a text such as "field 14 robot_arm". A workspace with several workspaces in it has no inputs.
    """

    def __init__(self, handles: Handles) -> None:
        self._packages = handles.packages
        self._workspace = handles.workspace
        members, self._world = inputs_of(self._workspace.world)
        self._mappings: dict[str, RecordedMapping[Any]] = {"name": self._workspace.recorded_names, "member": members}

    def names(self) -> dict[Cell, str]:
        """Return the name of each input that has been read."""
        result: dict[Cell, str] = {}
        for (usable, path), handle in self._packages.items():
            kind = "field" if usable else "unusable"
            result.update((cell, f"{kind} {index} {path}") for index, cell in enumerate(handle.cells))
        result.update((cell, f"workspace {name}") for name, cell in self._workspace.cells.items())
        for kind, mapping in self._mappings.items():
            result.update((cell, f"{kind} {part}") for part, cell in mapping.cells())
        result.update((cell, f"world {part}") for part, (cell, _) in self._world.items())
        return result

    def digest(self, name: str) -> bytes:
        """Return a digest of the value of an input, the same in each process; zeros for an input that does not exist."""
        value = next(self._values(name), _NOTHING)
        return _ABSENT if value is _NOTHING else digest(value)

    def _values(self, name: str) -> Iterator[object]:
        kind, _, rest = name.partition(" ")
        if kind in ("field", "unusable"):
            index, _, path = rest.partition(" ")
            handle = self._packages.get((kind == "field", path))
            if handle is not None:
                yield handle.now[int(index)]
        elif kind == "workspace":
            yield self._workspace.now.get(rest)
        elif kind in self._mappings:
            yield self._mappings[kind].part(rest)
        elif rest in self._world:
            yield self._world[rest][1]


_SET = re.compile(r"frozenset\(\{([^{}]*)\}\)")
_LITERAL = re.compile(r"'[^']*'|\"[^\"]*\"")


def digest(value: object) -> bytes:
    """Return a digest of a frozen value: the same for equal values in each process, and different for others."""
    return blake2b(_text(value).encode("utf-8", "backslashreplace"), digest_size=DIGEST_SIZE).digest()


def _text(value: object) -> str:
    """Return a text that is the same for equal values in each process, and different for others."""
    text = repr(value)
    if "frozenset({" not in text:
        return text
    ordered = _SET.sub(_in_order, text)
    return ordered if "frozenset({" not in ordered else repr(_ordered(value))


def _in_order(found: re.Match[str]) -> str:
    """Return the text of a set of plain texts in order, that of another set unchanged."""
    items = found[1].split(", ")
    return f"frozenset({sorted(items)})" if all(map(_LITERAL.fullmatch, items)) else found[0]


def _ordered(value: Any) -> Any:
    """Return a value with a sorted tuple in place of each set, whose order differs between processes."""
    if isinstance(value, frozenset):
        return "frozenset", tuple(sorted(map(_text, value)))
    if isinstance(value, tuple):
        return type(value).__name__, tuple(map(_ordered, value))
    if isinstance(value, Mapping):
        return "mapping", tuple([(_ordered(key), _ordered(inner)) for key, inner in value.items()])
    return value
