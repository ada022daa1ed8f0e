"""Values of CMake variables, as Python strings in which some pieces may be unknown.

Four markers, made of control characters that occur in no parsed CMake file, stand for unknown pieces:

- :data:`HOLE`: any text, which may be empty or have several list elements. Its square brackets come in pairs.
- :data:`UNPAIRED_HOLE`: like HOLE, but its square brackets may be unpaired. An unpaired bracket joins the list elements
  after it, so the later elements are unknown as well.
- :data:`ATOM` with the letters after it: one fixed, non-empty text that is unknown, such as the folder of the package on
  the disk. It has no semicolon, and two equal atoms are equal texts.
- :data:`MAYBE` at the start of a list element: the element may be missing from the list.
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
UNPAIRED_HOLE: Final = f"{HOLE}\3{HOLE}"  # a search for a HOLE also finds a UNPAIRED_HOLE, even at the ends of a text

TREE: Final = f"/{ATOM}source"
"""Placeholder for the root folder of the analysed workspace, whose place on the disk is unknown."""
BINARY: Final = f"/{ATOM}build"
"""Placeholder for the build folder of the package, whose place on the disk is unknown."""
PREFIX: Final = f"/{ATOM}prefix"
"""Placeholder for the install prefix of the package, whose place on the disk is unknown."""
OTHER_PACKAGE: Final = f"/{ATOM}package-"
"""Start of the placeholder for the install prefix of another package of the workspace. The package name follows."""

LONGEST: Final = 1 << 20
"""Maximum length of a value, in characters.

A longer value becomes unknown (HOLE), so that no script can exhaust the memory."""
ELEMENT: Final = 64
"""Cost that the budget of a run charges for a list element, in characters. A short Python string takes this much memory."""
FILE: Final = 256
"""Cost that the budget of a run charges for an installed file, in characters."""
SLOW: Final = 16
"""Factor by which the budget of a run charges more for a text that is read character by character."""


def is_known(value: str) -> bool:
    """Return whether every character of a value is known: the value has none of the markers of unknown parts."""
    return HOLE not in value and ATOM not in value and MAYBE not in value


def is_fixed(value: str) -> bool:
    """Return whether a value is one fixed text, even if a part is not known here, such as the folder of the workspace.

    A value with a marker for any text (HOLE) or for elements that may be missing (MAYBE) is not fixed.
    """
    return HOLE not in value and MAYBE not in value


def natural(text: str) -> int | None:
    """Return the number written in a text of at most nine ASCII digits, None for any other text."""
    return int(text) if _NATURAL.fullmatch(text) else None


_NATURAL: Final = re.compile("[0-9]{1,9}")


def cached_short(most: int) -> Callable[[Callable[[str], T]], Callable[[str], T]]:
    """Return a decorator that caches up to ``most`` results of a function with a text as its only argument.

    Results for texts of more than 1,024 characters are not cached, because they would fill the memory.
    """

    def decorate(function: Callable[[str], T]) -> Callable[[str], T]:
        remembered = lru_cache(maxsize=most)(function)
        return lambda text: remembered(text) if len(text) <= _LONGEST_KEPT else function(text)

    return decorate


_LONGEST_KEPT: Final = 1024


def embeddable(value: str) -> str:
    """Return the text that a value contributes to a longer text: the value itself if no list element may be missing.

    For any other value, the result is HOLE, which means an unknown text.
    """
    return HOLE if MAYBE in value else value


def split(value: str) -> list[str]:
    """Return the non-empty elements of a CMake list, split like an unquoted argument (cmake-language(7))."""
    if ";" not in value:
        return [value] if value else []
    if "\\" not in value and "[" not in value and "]" not in value and "\3" not in value:
        return [element for element in value.split(";") if element and element != MAYBE]
    return [element for element in _split(value) if element and element != MAYBE]


def elements(value: str) -> list[str]:
    """Return the elements of a CMake list, including empty ones. The empty text is a list without elements."""
    if not value:
        return []
    if ";" not in value:
        return [value]
    if "\\" not in value and "[" not in value and "]" not in value and "\3" not in value:
        items = value.split(";")
    else:
        items = _split(value)
    if items.count("") == 1 and all(element[:1] in ("", MAYBE, HOLE) for element in items):
        return [element or MAYBE for element in items]  # if the other elements are missing, the list is empty
    return items


def _split(value: str) -> list[str]:
    parts: list[str] = []
    piece: list[str] = []
    depth = position = 0
    while position < len(value):
        letter = value[position]
        if letter == "\\" and value[position + 1 : position + 2] == ";":
            piece.append(";")
            position += 2
            continue
        if letter == "\3":
            return [*parts, UNPAIRED_HOLE]
        if letter == "[":
            depth += 1
        elif letter == "]":
            depth -= 1
        if letter == ";" and not depth:
            parts.append("".join(piece))
            piece = []
        else:
            piece.append(letter)
        position += 1
    parts.append("".join(piece))
    if depth and (MAYBE in value or HOLE in value):
        return [UNPAIRED_HOLE]  # an unpaired bracket joins the elements after it
    return parts


def split_cost(value: str) -> int:
    """Return the cost of splitting a list, in characters, for the budget that limits the work of a run."""
    return SLOW * len(value) if "[" in value or "\\" in value else ELEMENT * value.count(";")


def is_unpaired(value: str) -> bool:
    """Return whether a text has an unpaired square bracket, or an unknown piece that may have one."""
    if "\3" in value:
        return True
    depth = lowest = 0
    for letter in value:
        depth += (letter == "[") - (letter == "]")
        lowest = min(lowest, depth)
    return depth != 0 or lowest < 0


def with_unpaired_holes(value: str | None) -> str | None:
    """Return a value after a change of its unknown parts: they may have unpaired square brackets (UNPAIRED_HOLE for HOLE).

    The result for None is None.
    """
    if not value:
        return value
    if MAYBE in value and is_unpaired(value):
        return UNPAIRED_HOLE  # the elements that are joined depend on which ones are missing
    return value.replace(HOLE, UNPAIRED_HOLE) if HOLE in value and UNPAIRED_HOLE not in value else value


def join(values: Iterable[str]) -> str:
    """Return list elements joined by semicolons, as CMake stores a list; HOLE (an unknown text) if it would be too long."""
    if isinstance(values, (list, tuple)):
        return ";".join(values) if sum(map(len, values)) <= LONGEST else HOLE
    texts = []
    size = 0
    for value in values:  # values of a generator may together exceed the memory
        size += len(value)
        if size > LONGEST:
            return HOLE
        texts.append(value)
    return ";".join(texts)


def join_with(glue: str, texts: Sequence[str]) -> str:
    """Return texts joined by ``glue``.

    The result is HOLE, which means an unknown value, if it would be too long: a loop can double a text in each round.
    """
    if len(glue) * len(texts) + sum(map(len, texts)) > LONGEST:
        return HOLE
    return embeddable(glue).join(map(embeddable, texts))


def strip_mark(element: str) -> tuple[str, bool]:
    """Return a list element without its marker, and whether it certainly exists.

    The marker (MAYBE) means that the element may be missing.
    """
    return (element[1:], False) if element[:1] == MAYBE else (element, True)


def mark_maybe(element: str) -> str:
    """Return a list element with the marker (MAYBE) that the element may be missing.

    An element that is entirely unknown is returned unchanged, because it may be empty anyway.
    """
    return element if element.startswith(MAYBE) or element in (HOLE, UNPAIRED_HOLE) else MAYBE + element


def certainly_set(value: str) -> bool:
    """Return whether a variable with this value is certainly set: at least one list element of the value certainly exists.

    The empty value does not count: if only one branch of an if() sets a variable to "", the variable has the empty value
    after the if(), but it may be unset.
    """
    return any(element and element not in (HOLE, UNPAIRED_HOLE) and not element.startswith(MAYBE) for element in elements(value))


def merge(values: Sequence[str | None], default: int | None = None) -> str | None:
    """Return the value of a variable after one of several branches of an if() ran, given its value after each branch.

    A value of None is an unset variable. ``default`` is the index of the branch that runs with default options, None if there
    is no such branch. If ``default`` is given, the result has every element of the value of the default branch. Elements of
    the other values get a marker (MAYBE), because they may be missing.
    """
    first = values[0]
    if all(value == first for value in values):
        return first
    if any(value and any(letter in value for letter in "\\[]") for value in values):
        return HOLE if default is None else values[default]  # splitting and joining such a list would change it
    if default is not None:
        base = values[default]
        base_elements = set(elements(base or ""))
        if HOLE in base_elements or base is None or ";" not in base:
            if all(_extends(value, base) for value in values):
                return _merge_lists(values)
            return base
        added = dict.fromkeys(
            mark_maybe(element)
            for value in values
            for element in elements(value or "")
            if strip_mark(element)[0] not in base_elements
        )
        return join([base, *(element for element in added if element not in (HOLE, UNPAIRED_HOLE))])
    return _merge_lists(values)


def _extends(value: str | None, base: str | None) -> bool:
    """Return whether the list ``value`` begins with the elements of the list ``base``."""
    base_items, items = elements(base or ""), elements(value or "")
    return items[: len(base_items)] == base_items


def _merge_lists(values: Sequence[str | None]) -> str | None:
    lists = [elements(value or "") for value in values]
    first = lists[0]
    if all(items == first for items in lists):
        return next(value for value in values if value is not None)
    shortest = min(map(len, lists))
    head = 0
    while head < shortest and all(items[head] == first[head] for items in lists):
        head += 1
    tail = 0
    while tail < shortest - head and all(items[-1 - tail] == first[-1 - tail] for items in lists):
        tail += 1
    middle = dict.fromkeys(mark_maybe(element) for items in lists for element in items[head : len(items) - tail])
    return join([*first[:head], *middle, *first[len(first) - tail :]])
