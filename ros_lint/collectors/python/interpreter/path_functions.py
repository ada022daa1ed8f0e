"""Functions of os.path and attributes of pathlib paths, for paths with parts that are known only at launch."""

from __future__ import annotations

import posixpath
import re
from pathlib import PurePosixPath
from typing import TYPE_CHECKING

from ros_lint.collectors.python.interpreter.alternatives import plain
from ros_lint.collectors.python.interpreter.elements import waits
from ros_lint.collectors.python.interpreter.values import (
    FilePath,
    Method,
    ProgramRaised,
    Unknown,
    Value,
    written,
)
from ros_lint.collectors.symbolic_text import BRACKETS, OWN_FOLDER, UNKNOWN, expression, is_plain, may_contain_place, quoted

if TYPE_CHECKING:
    import ast

    from ros_lint.collectors.python.interpreter.protocol import Interpreter
    from ros_lint.collectors.python.interpreter.values import Frame

_MOST_PARENTS = 12
_IN_OWN_FOLDER = re.compile(rf"{OWN_FOLDER}(?:/\.\.)*")
"""Pattern of the folder of the launch file, and of the folders above it."""


def split(path: str) -> tuple[str, str]:
    """Return the folder and the last name of a path, as ``os.path.split()`` does: ``a/b.py`` -> ``("a", "b.py")``.

    A part that is known only at launch counts as one name. Exceptions, for which the result is not known before launch:

    - The default of the part contains a slash.
    - Nothing precedes the part.

    The folder of the launch file is in ``..``, seen from that folder.
    """
    if is_plain(path):
        return posixpath.split(path)
    if _IN_OWN_FOLDER.fullmatch(path):
        return f"{path}/..", ""
    slash = _last_outside(path, "/")
    name = path[slash + 1 :]
    if is_plain(name) or (slash >= 0 and "/" not in name):
        return posixpath.split(path[: slash + 1])[0], name
    if not waits(name):
        return UNKNOWN, UNKNOWN if "/" in name else name
    return UNKNOWN, UNKNOWN if may_contain_place(name) else expression(f"{quoted(name)}.split('/')[-1]")


def normalized(path: str) -> str:
    """Return a path without ``.`` and needless ``..``, as ``os.path.normpath()`` does.

    ``..`` remains after the folder of the launch file, because the folder above it is not known.
    """
    if not path.startswith(OWN_FOLDER):
        return posixpath.normpath(path)
    inner = posixpath.normpath(f".{path[len(OWN_FOLDER) :]}")
    return OWN_FOLDER if inner == "." else f"{OWN_FOLDER}/{inner}"


def split_suffix(path: str) -> tuple[str, str]:
    """Return a path without its suffix, and the suffix, as os.path.splitext does.

    Both are UNKNOWN if the suffix is known only at launch.
    """
    if is_plain(path):
        return posixpath.splitext(path)
    dot = _last_outside(path, ".")
    if dot > path.rfind("/") and is_plain(path[dot:]):
        return path[:dot], path[dot:]
    return UNKNOWN, UNKNOWN


def _last_outside(path: str, character: str) -> int:
    """Return the last offset of a character in a symbolic path, -1 if there is none.

    Characters in parts that are known only at launch do not count.
    """
    position, start, depth = -1, 0, 0
    for mark in BRACKETS.finditer(path):
        if not depth:
            position = max(position, path.rfind(character, start, mark.start()))
        depth += 1 if mark[1] else -1
        start = mark.end()
    return max(position, path.rfind(character, start))


def of_path(owner: FilePath, name: str) -> Value:
    """Return the attribute ``name`` of a path of pathlib, such as ``parent`` or ``stem``. For a method, return a Method."""
    folder, last = split(owner.text)
    match name:
        case "parent":
            return FilePath(folder)
        case "name":
            return last
        case "stem":
            return _split_name(last)[0]
        case "suffix":
            return _split_name(last)[1]
        case "parts" | "suffixes" if is_plain(owner.text):
            return getattr(PurePosixPath(owner.text), name)
        case "parents":
            folders: list[FilePath] = []
            while folder and len(folders) < _MOST_PARENTS and (not folders or folder != folders[-1].text):
                folders.append(FilePath(folder))
                folder = split(folder)[0]
            # The folders above an unknown folder are unknown.
            return tuple(folders) if is_plain(owner.text) else [*folders, *[FilePath(UNKNOWN)] * _MOST_PARENTS]
    return Method(owner, name)


def _split_name(name: str) -> tuple[str, str]:
    """Return stem and suffix of a file name as pathlib does: ``a.py`` -> ``("a", ".py")``, ``a.`` -> ``("a.", "")``."""
    stem, suffix = split_suffix(name)
    return (name, "") if suffix == "." else (stem, suffix)


def call_of_path(
    machine: Interpreter,
    owner: FilePath,
    name: str,
    arguments: list[Value],
    keywords: dict[str, Value],
    node: ast.Call,
    frame: Frame,
) -> Value:
    """Return the result of calling the method ``name`` of a path of pathlib."""
    match name:
        case "joinpath":
            return machine.join_paths(owner, arguments, node, frame)
        case "as_posix" | "__str__" | "__fspath__":
            return written(owner.text, node, frame.source)
        case "with_suffix" | "with_name":
            argument = plain(arguments[0]) if arguments else None
            if isinstance(argument, str):
                if name == "with_suffix":
                    return FilePath(split_suffix(owner.text)[0] + argument)
                return FilePath(posixpath.join(split(owner.text)[0], argument))
        case "match" | "is_relative_to" | "relative_to" | "is_absolute" if is_plain(owner.text):
            return _by_pathlib(owner, name, arguments)
    return machine.library.call(machine, Method(owner, name), arguments, keywords, node, frame)


def _by_pathlib(owner: FilePath, name: str, arguments: list[Value]) -> Value:
    texts = [value.text if isinstance(value, FilePath) else value for value in map(plain, arguments)]
    if not all(isinstance(text, str) and is_plain(text) for text in texts):
        return Unknown(f"{name}() of a path")
    try:
        result = getattr(PurePosixPath(owner.text), name)(*texts)
    except (TypeError, ValueError) as error:
        raise ProgramRaised(type(error).__name__) from None
    return FilePath(str(result)) if isinstance(result, PurePosixPath) else result
