"""Values of CMake variables: strings in which some pieces may be unknown.

A value is a ``str``. Four characters that no CMake file can hold (the parser sees to it) mark what is not plain text:

- :data:`HOLE` stands for any text, also for none and for several list elements, whose square brackets come in pairs;
- :data:`WILD` is a HOLE whose brackets may lack their partners: nobody knows which elements after it are glued to it;
- :data:`ATOM` and the letters after it stand for one text that is fixed and not empty, but unknown: where the package lies
  on the disk, say. It holds no semicolon, and two equal atoms are the same text;
- :data:`MAYBE` at the start of a list element says that the element may be missing.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from functools import lru_cache
from typing import Final, TypeVar

T = TypeVar("T")

HOLE: Final = "\0"
ATOM: Final = "\1"
MAYBE: Final = "\2"
WILD: Final = f"{HOLE}\3{HOLE}"  # whoever looks for a HOLE, also at the ends of a text, finds one

TREE: Final = f"/{ATOM}source"
"""Where the tree that is looked at lies. The folder of the package is in it."""
BINARY: Final = f"/{ATOM}build"
"""The build folder of the package."""
PREFIX: Final = f"/{ATOM}prefix"
"""Where the package is installed."""
FOREIGN: Final = f"/{ATOM}foreign-"
"""Followed by the name of another package of the workspace: where that one is installed."""

LONGEST: Final = 1 << 20
"""A longer value is taken for unknown, so that no script can make a run take all memory."""
ELEMENT: Final = 64
"""Characters that an element of a list counts for, because of the memory that Python takes for it."""
FILE: Final = 256
"""Characters that an installed file counts for."""
SLOW: Final = 16
"""Characters that one counts for where a text is read letter by letter."""


def is_known(value: str) -> bool:
    """Return whether every character of the value is known."""
    return HOLE not in value and ATOM not in value and MAYBE not in value


def is_fixed(value: str) -> bool:
    """Return whether the value is one text, even if a piece of it cannot be seen."""
    return HOLE not in value and MAYBE not in value


def natural(text: str) -> int | None:
    """Return the number that a text of at most nine ASCII digits is, None for any other text."""
    return int(text) if _NATURAL.fullmatch(text) else None


_NATURAL: Final = re.compile("[0-9]{1,9}")


def kept(most: int) -> Callable[[Callable[[str], T]], Callable[[str], T]]:
    """Return a decorator that keeps the results of a function for as many texts, but for long ones, which fill the memory."""

    def decorate(function: Callable[[str], T]) -> Callable[[str], T]:
        remembered = lru_cache(maxsize=most)(function)
        return lambda text: remembered(text) if len(text) <= _LONGEST_KEPT else function(text)

    return decorate


_LONGEST_KEPT: Final = 1024


def flat(value: str) -> str:
    """Return a value for use within a longer text: elements that may be missing make it unknown."""
    return HOLE if MAYBE in value else value


def split(value: str) -> list[str]:
    """Return the elements of a list without the empty ones, as an unquoted argument is split (cmake-language(7))."""
    if ";" not in value:
        return [value] if value else []
    if "\\" not in value and "[" not in value and "]" not in value and "\3" not in value:
        return [element for element in value.split(";") if element and element != MAYBE]
    return [element for element in _split(value) if element and element != MAYBE]


def elements(value: str) -> list[str]:
    """Return the elements of a list, the empty ones too. The empty text is the list without elements."""
    if not value:
        return []
    if ";" not in value:
        return [value]
    if "\\" not in value and "[" not in value and "]" not in value and "\3" not in value:
        found = value.split(";")
    else:
        found = _split(value)
    if found.count("") == 1 and all(element[:1] in ("", MAYBE, HOLE) for element in found):
        return [element or MAYBE for element in found]  # where it turns out to be the only one, it is none
    return found


def _split(value: str) -> list[str]:
    found: list[str] = []
    piece: list[str] = []
    depth = position = 0
    while position < len(value):
        letter = value[position]
        if letter == "\\" and value[position + 1 : position + 2] == ";":
            piece.append(";")
            position += 2
            continue
        if letter == "\3":
            return [*found, WILD]
        if letter == "[":
            depth += 1
        elif letter == "]":
            depth -= 1
        if letter == ";" and not depth:
            found.append("".join(piece))
            piece = []
        else:
            piece.append(letter)
        position += 1
    found.append("".join(piece))
    if depth and (MAYBE in value or HOLE in value):
        return [WILD]  # a bracket without its partner holds together what follows, if it is there
    return found


def effort(value: str) -> int:
    """Return how many characters it counts for to take a list apart."""
    return SLOW * len(value) if "[" in value or "\\" in value else ELEMENT * value.count(";")


def unpaired(value: str) -> bool:
    """Return whether a text holds a square bracket without its partner, or may hold one."""
    if "\3" in value:
        return True
    depth = lowest = 0
    for letter in value:
        depth += (letter == "[") - (letter == "]")
        lowest = min(lowest, depth)
    return depth != 0 or lowest < 0


def wild(value: str | None) -> str | None:
    """Return a value in a script where unknown texts may hold brackets without partners."""
    if not value:
        return value
    if MAYBE in value and unpaired(value):
        return WILD  # which elements are glued depends on which are there
    return value.replace(HOLE, WILD) if HOLE in value and WILD not in value else value


def join(values: Iterable[str]) -> str:
    """Return a list as CMake stores it, a HOLE for one that is too long."""
    if isinstance(values, (list, tuple)):
        return ";".join(values) if sum(map(len, values)) <= LONGEST else HOLE
    found = []
    size = 0
    for value in values:  # each may be made on the way, and all together be more than memory holds
        size += len(value)
        if size > LONGEST:
            return HOLE
        found.append(value)
    return ";".join(found)


def glued(glue: str, texts: Sequence[str]) -> str:
    """Return texts with another one between them, a HOLE when that is too long: a loop may double it each time."""
    if len(glue) * len(texts) + sum(map(len, texts)) > LONGEST:
        return HOLE
    return flat(glue).join(map(flat, texts))


def sure(element: str) -> tuple[str, bool]:
    """Return a list element without its mark, and whether it is certainly there."""
    return (element[1:], False) if element[:1] == MAYBE else (element, True)


def maybe(element: str) -> str:
    """Return a list element that may be missing."""
    return element if element.startswith(MAYBE) or element in (HOLE, WILD) else MAYBE + element


def certainly_set(value: str) -> bool:
    """Return whether a variable with this value is set for sure.

    Where one branch sets a variable to nothing and another does not set it, it is held to be empty.
    """
    return any(element and element not in (HOLE, WILD) and not element.startswith(MAYBE) for element in elements(value))


def merge(values: Sequence[str | None], default: int | None = None) -> str | None:
    """Return what a variable holds after one of several branches ran, each of which left it with one of the values.

    ``None`` is an unset variable. ``default`` is the index of the value that it has unless the user asks for another; then
    what the others add is kept as elements that may be missing, and nothing of the default is lost.
    """
    first = values[0]
    if all(value == first for value in values):
        return first
    if any(value and any(letter in value for letter in "\\[]") for value in values):
        return HOLE if default is None else values[default]  # taking such lists apart would change them
    if default is not None:
        base = values[default]
        have = set(elements(base or ""))
        if HOLE in have or base is None or ";" not in base:
            if all(_extends(value, base) for value in values):
                return _merge_lists(values)
            return base
        more = dict.fromkeys(
            maybe(element) for value in values for element in elements(value or "") if sure(element)[0] not in have
        )
        return join([base, *(element for element in more if element not in (HOLE, WILD))])
    return _merge_lists(values)


def _extends(value: str | None, base: str | None) -> bool:
    """Return whether a list begins with the elements of another."""
    old, new = elements(base or ""), elements(value or "")
    return new[: len(old)] == old


def _merge_lists(values: Sequence[str | None]) -> str | None:
    lists = [elements(value or "") for value in values]
    first = lists[0]
    if all(one == first for one in lists):
        return next(value for value in values if value is not None)
    shortest = min(map(len, lists))
    head = 0
    while head < shortest and all(one[head] == first[head] for one in lists):
        head += 1
    tail = 0
    while tail < shortest - head and all(one[-1 - tail] == first[-1 - tail] for one in lists):
        tail += 1
    middle = dict.fromkeys(maybe(element) for one in lists for element in one[head : len(one) - tail])
    return join([*first[:head], *middle, *first[len(first) - tail :]])
