"""Imports whose names a Python source never uses."""

from __future__ import annotations

import re
from collections import Counter
from typing import TYPE_CHECKING

from ros_lint.collectors.python.imports import IMPORTED_NAMES

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from ros_lint.collectors.python.import_tree import Import

_FROM = re.compile(r"\bfrom[\s\\]+\Z")
_ALIAS = re.compile(r"[ \t]+as[ \t]+(\w+)")
_NAME = re.compile(r"[\s\\]*(?:\w+[\s\\]+as[\s\\]+)?(\w+)[\s\\]*\Z")
_COMMENT = re.compile("#[^\n]*")
_REGISTERS = re.compile(r"(?:tf2_\w+|mpl_toolkits)(?:\.|\Z)")
"""Modules whose import has an effect: ``tf2_geometry_msgs`` registers conversions, ``mplot3d`` a projection."""
_LONGEST_STATEMENT = 40


def unused_imports(text: str, path: str, imports: Iterable[Import]) -> frozenset[int]:
    """Return the offsets of the imported modules that a source never uses.

    An import is unused if none of the names that it binds occurs anywhere else in the source, comments and strings included.
    The result is empty for ``__init__.py``, ``conftest.py`` and sources with ``__all__``, whose names other modules import.
    Modules whose import has an effect, ``import *`` and lines with ``noqa`` count as used.
    """
    if path.endswith(("__init__.py", "conftest.py")) or "__all__" in text:
        return frozenset()
    items = tuple(imports)
    if len(items) > _MANY_IMPORTS:  # then it is faster to count all words than to search each name
        words = Counter(_WORD.findall(text))
        return frozenset([item.start for item in items if _is_unused(text, item, lambda name: words[name] > 1)])
    return frozenset([item.start for item in items if _is_unused(text, item, lambda name: _occurs_again(text, name))])


_MANY_IMPORTS = 200
_WORD = re.compile(r"\w+")


def _is_unused(text: str, item: Import, occurs_again: Callable[[str], bool]) -> bool:
    if item.optional or not item.module or item.module[0] == "." or _REGISTERS.match(item.module):
        return False
    names = list(_bound_names(text, item))
    return bool(names) and not any(map(occurs_again, names)) and "noqa" not in _line(text, item.start)


def _bound_names(text: str, item: Import) -> Iterator[str]:
    """Yield the names that an import statement binds; nothing if they are not certain, as for ``import *``."""
    start, end = item.start, item.start + len(item.module)
    if not _FROM.search(text, max(0, start - _LONGEST_STATEMENT), start):
        alias = _ALIAS.match(text, end)
        yield alias[1] if alias else item.module.partition(".")[0]
        return
    match = IMPORTED_NAMES.match(text, end)
    if match is None:
        return
    listed = _COMMENT.sub("", match[1] if match[1] is not None else match[2]).rstrip().rstrip(",")
    names = [_NAME.match(part) for part in listed.split(",")]
    yield from [name[1] for name in names if name] if all(names) else ()


def _occurs_again(text: str, name: str) -> bool:
    """Return whether a name occurs at least twice in a text, as a whole word."""
    count, at = 0, text.find(name)
    while at >= 0:
        end = at + len(name)
        count += not (_is_of_word(text[at - 1 : at]) or _is_of_word(text[end : end + 1]))
        if count == 2:
            return True
        at = text.find(name, end)
    return False


def _is_of_word(character: str) -> bool:
    return character.isalnum() or character == "_"


def _line(text: str, at: int) -> str:
    end = text.find("\n", at)
    return text[at : end if end >= 0 else len(text)]
