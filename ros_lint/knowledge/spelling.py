"""Find names similar to an unknown name.

A fix needs the one certain name (:meth:`Spelling.same`, :meth:`Spelling.one_slip`); a hint needs near names
(:meth:`Spelling.near`). The module also compares the name of a vendor package with its library, and the name of a
part of a library with the whole.
"""

from __future__ import annotations

import re
import string
from bisect import bisect_left
from functools import cached_property
from typing import TYPE_CHECKING

from ros_lint.base.suggestions import similar_names

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

_SHORTEST = 5
"""Words with fewer letters often differ by one letter only by chance, such as pcl and pil."""

_SHORTEST_SWAPPED = 4
"""No two known names differ by swapped letters only, even if the word is short."""

_COMMON = 150

_OF_PACKAGES = re.compile(r"[a-z][a-z0-9_]*")


class Spelling:
    """Names to compare with."""

    def __init__(self, names: Iterable[str]) -> None:
        self._names = sorted(set(names))
        self._by_word: dict[str, list[str]] = {}

    def same(self, name: str) -> tuple[str, ...]:
        """Return the names that differ only by dashes, underscores and capitals, sorted."""
        return tuple(self._plain.get(plain(name), ()))

    def one_slip(self, name: str) -> tuple[str, ...]:
        """Return the names at a distance of one letter, sorted.

        The letter is omitted, inserted, changed, or swapped with its successor. Changed digits do not count:
        ``lidar_2`` is not a typo of ``lidar_1``.
        """
        if len(name) < _SHORTEST:
            return ()
        half = len(name) // 2
        candidates = set(_beginning(self._names, name[: half - 1]))
        candidates.update([reverse[::-1] for reverse in _beginning(self._backwards, name[half + 1 :][::-1])])
        return tuple(sorted([word for word in candidates if -2 < len(word) - len(name) < 2 and _is_slip(name, word)]))

    def near(self, name: str) -> tuple[str, ...]:
        """Return similar names, nearest first, at most three. Nearest are names of the same words reordered."""
        words = _words(name)
        alike = {candidate for word in words for candidate in self._having(word)}
        scored = [(-_overlap(words, _words(candidate)), candidate) for candidate in alike]
        candidates = [candidate for _, candidate in sorted(scored)[:30]]
        moved = [candidate for candidate in candidates if sorted(_WORD.findall(name)) == sorted(_WORD.findall(candidate))]
        candidates += self.one_slip(name)
        return tuple(dict.fromkeys([*moved, *near_names(name, dict.fromkeys(candidates), 3, 0.8)]))[:3]

    def _having(self, word: str) -> list[str]:
        """Return the names with a word; none for a very common word, which is insignificant and slow."""
        known = self._by_word.get(word)
        if known is not None:
            return known
        text, same = self._lower, string.ascii_lowercase if word.isalpha() else string.digits
        names: list[str] = []
        at = text.find(word)
        while at >= 0 and len(names) <= _COMMON:
            end = at + len(word)
            if text[at - 1] not in same and text[end] not in same:
                start, end = text.rfind("\n", 0, at) + 1, text.find("\n", end)
                names += self._by_lower[text[start:end]]
            at = text.find(word, end)
        self._by_word[word] = names if len(names) <= _COMMON else []
        return self._by_word[word]

    @cached_property
    def _lower(self) -> str:
        return "\n".join(["", *self._by_lower, ""])

    @cached_property
    def _by_lower(self) -> Mapping[str, list[str]]:
        names_of: dict[str, list[str]] = {}
        for name in self._names:
            names_of.setdefault(name.lower(), []).append(name)
        return names_of

    @cached_property
    def _plain(self) -> Mapping[str, list[str]]:
        names_of: dict[str, list[str]] = {}
        for name, same in zip(self._names, plain("\n".join(self._names)).split("\n"), strict=True):
            names_of.setdefault(same, []).append(name)
        return names_of

    @cached_property
    def _backwards(self) -> list[str]:
        return sorted("\n".join(self._names)[::-1].split("\n"))


def near_names(name: str, names: Iterable[str], most: int, least: float) -> list[str]:
    """Return the intended names among similar ones (:func:`ros_lint.base.suggestions.similar_names`).

    If each name has words that the other lacks, these words must resemble each other: rear_camera is not suggested
    for front_camera. If the suggestion has more words besides, its words must begin like the lacking ones:
    flir_camera_description is not suggested for icar_description. If several suggestions extend the name, as
    left_arm and right_arm extend arm, none of these is returned.
    """
    words = _words(name)
    similar = [candidate for candidate in similar_names(name, names, most, least) if _may_be_meant(words, _words(candidate))]
    longer = [candidate for candidate in similar if words < _words(candidate)]
    return [candidate for candidate in similar if candidate not in longer] if len(longer) > 1 else similar


def _may_be_meant(words: frozenset[str], others: frozenset[str]) -> bool:
    lacking, more = words - others, others - words
    if not (lacking and more):
        return True
    if all(similar_names(word, lacking) for word in more):
        return all(similar_names(word, more) for word in lacking)
    return all(any(word.startswith(other) or other.startswith(word) for other in more) for word in lacking)


def may_be_package(name: str) -> bool:
    """Return whether a name is valid for a ROS package (REP 144).

    Lower-case letters, digits and underscores after a lower-case letter.
    """
    return _OF_PACKAGES.fullmatch(name) is not None


def plain(name: str) -> str:
    """Return a name without its most frequent variations: dashes, underscores and capitals."""
    return name.replace("-", "").replace("_", "").lower()


VENDOR = "_vendor"
"""Suffix of packages that wrap a library but keep its headers, targets and CMake name."""


def is_vendor(package: str, library: str) -> bool:
    """Return whether a package is named as a vendor package of a library, which may be a name or a key.

    The prefix may name the owner: rviz_assimp_vendor, google_benchmark_vendor.
    """
    if not package.endswith(VENDOR):
        return False
    words = package.removesuffix(VENDOR).split("_")
    return _bare(library) in [_bare("_".join(words[start:])) for start in range(len(words))]


def is_part(part: str, key: str) -> bool:
    """Return whether a key is for a part of the library of another key, by name: libboost-thread-dev."""
    words = _of_library(key)
    return words == _of_library(part)[: len(words)]


def _of_library(key: str) -> list[str]:
    return key.removesuffix("-dev").removeprefix("lib").split("-")


def _bare(library: str) -> str:
    return plain(library.removesuffix("-dev").removeprefix("lib"))


_WORD = re.compile(r"[a-z]+|[0-9]+")


def _words(name: str) -> frozenset[str]:
    return frozenset(_WORD.findall(name.lower()))


def _overlap(left: frozenset[str], right: frozenset[str]) -> float:
    return len(left & right) / len(left | right)


def _beginning(ordered: list[str], beginning: str) -> list[str]:
    start = bisect_left(ordered, beginning)
    end = bisect_left(ordered, f"{beginning}\uffff")
    return ordered[start:end]


def _is_slip(name: str, other: str) -> bool:
    """Return whether two names differ by one edit in a sufficiently long word, and not in a digit."""
    longer, shorter = (name, other) if len(name) >= len(other) else (other, name)
    if name == other or len(longer) - len(shorter) > 1:
        return False
    start = 0
    while start < len(shorter) and longer[start] == shorter[start]:
        start += 1
    if longer[start].isdigit() or shorter[start : start + 1].isdigit():
        return False
    if len(longer) > len(shorter):
        alike = longer[start + 1 :] == shorter[start:]
        plural = longer[start] == "s" and not longer[start + 1 : start + 2].isalnum()
        return alike and (plural or _word_length(longer, start) >= _SHORTEST)
    letters = _word_length(longer, start)
    swapped = longer[start + 1 : start + 2] + longer[start]
    if swapped == shorter[start : start + 2] and longer[start + 2 :] == shorter[start + 2 :]:
        return letters >= _SHORTEST_SWAPPED
    return letters >= _SHORTEST and longer[start + 1 :] == shorter[start + 1 :]


def _word_length(name: str, at: int) -> int:
    start = end = at
    while start > 0 and name[start - 1].isalpha():
        start -= 1
    while end < len(name) and name[end].isalpha():
        end += 1
    return end - start
