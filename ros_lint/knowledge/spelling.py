"""Did you mean: names near an unknown one.

Two questions, two answers. Which name is meant, for a fix: one of which nobody would doubt. Which names are near, for a
hint. Besides, what a name says of another one: that of a vendor package of its library, that of a part of its whole.
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
"""Words with fewer letters are one letter apart by chance, such as pcl and pil."""

_SHORTEST_SWAPPED = 4
"""Letters are swapped by chance in no two names that are known, however short the word."""

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
        """Return the names that one letter makes: left out, put in, changed, or swapped with the next. Sorted.

        A digit changed for another is no slip: ``lidar_2`` is not meant to be ``lidar_1``.
        """
        if len(name) < _SHORTEST:
            return ()
        half = len(name) // 2
        near = set(_beginning(self._names, name[: half - 1]))
        near.update([found[::-1] for found in _beginning(self._backwards, name[half + 1 :][::-1])])
        return tuple(sorted([other for other in near if -2 < len(other) - len(name) < 2 and _is_slip(name, other)]))

    def near(self, name: str) -> tuple[str, ...]:
        """Return names that resemble a name, nearest first, at most three. Nearest are the same words in another order."""
        words = _words(name)
        alike = {other for word in words for other in self._having(word)}
        scored = [(-_overlap(words, _words(other)), other) for other in alike]
        candidates = [other for _, other in sorted(scored)[:30]]
        moved = [other for other in candidates if sorted(_WORD.findall(name)) == sorted(_WORD.findall(other))]
        candidates += self.one_slip(name)
        return tuple(dict.fromkeys([*moved, *near_names(name, dict.fromkeys(candidates), 3, 0.8)]))[:3]

    def _having(self, word: str) -> list[str]:
        """Return the names that have a word. None for a word of very many: it tells nothing, and comparing takes long."""
        known = self._by_word.get(word)
        if known is not None:
            return known
        text, same = self._lower, string.ascii_lowercase if word.isalpha() else string.digits
        found: list[str] = []
        at = text.find(word)
        while at >= 0 and len(found) <= _COMMON:
            end = at + len(word)
            if text[at - 1] not in same and text[end] not in same:
                start, end = text.rfind("\n", 0, at) + 1, text.find("\n", end)
                found += self._by_lower[text[start:end]]
            at = text.find(word, end)
        self._by_word[word] = found if len(found) <= _COMMON else []
        return self._by_word[word]

    @cached_property
    def _lower(self) -> str:
        return "\n".join(["", *self._by_lower, ""])

    @cached_property
    def _by_lower(self) -> Mapping[str, list[str]]:
        found: dict[str, list[str]] = {}
        for name in self._names:
            found.setdefault(name.lower(), []).append(name)
        return found

    @cached_property
    def _plain(self) -> Mapping[str, list[str]]:
        found: dict[str, list[str]] = {}
        for name, same in zip(self._names, plain("\n".join(self._names)).split("\n"), strict=True):
            found.setdefault(same, []).append(name)
        return found

    @cached_property
    def _backwards(self) -> list[str]:
        return sorted("\n".join(self._names)[::-1].split("\n"))


def near_names(name: str, names: Iterable[str], most: int, least: float) -> list[str]:
    """Return the names that an unknown name may mean: those similar to it (:func:`ros_lint.base.suggestions.similar`).

    Where both have words that the other one lacks, these must resemble each other: front_camera is not meant to be
    rear_camera, however much of it is the same. If there is one more besides, those that it lacks must begin like others:
    icar_description is not meant to be flir_camera_description. What several complete alike, as left_arm and right_arm do
    arm, is neither.
    """
    words = _words(name)
    found = [other for other in similar_names(name, names, most, least) if _may_be_meant(words, _words(other))]
    longer = [other for other in found if words < _words(other)]
    return [other for other in found if other not in longer] if len(longer) > 1 else found


def _may_be_meant(words: frozenset[str], others: frozenset[str]) -> bool:
    lacking, more = words - others, others - words
    if not (lacking and more):
        return True
    if all(similar_names(word, lacking) for word in more):
        return all(similar_names(word, more) for word in lacking)
    return all(any(word.startswith(other) or other.startswith(word) for other in more) for word in lacking)


def may_be_package(name: str) -> bool:
    """Return whether a package of ROS may have a name: small letters, digits and underscores after a small letter (REP 144)."""
    return _OF_PACKAGES.fullmatch(name) is not None


def plain(name: str) -> str:
    """Return a name without what people get wrong first."""
    return name.replace("-", "").replace("_", "").lower()


VENDOR = "_vendor"
"""How the names of packages end that bring a library, whose headers, targets and CMake name are the library's own."""


def is_vendor(package: str, library: str) -> bool:
    """Return whether a package has the name of the vendor package of a library, by whatever name or key that goes.

    What stands before it says whose vendor package it is: rviz_assimp_vendor, google_benchmark_vendor.
    """
    if not package.endswith(VENDOR):
        return False
    words = package.removesuffix(VENDOR).split("_")
    return _bare(library) in [_bare("_".join(words[start:])) for start in range(len(words))]


def is_part(library: str, whole: str) -> bool:
    """Return whether a key is, going by its name, of a part of the library that another key is of: libboost-thread-dev."""
    words = _of_library(whole)
    return words == _of_library(library)[: len(words)]


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


def _is_slip(one: str, other: str) -> bool:
    """Whether one edit leads from one name to the other, in a word long enough, and it is no matter of digits."""
    longer, shorter = (one, other) if len(one) >= len(other) else (other, one)
    if one == other or len(longer) - len(shorter) > 1:
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
