"""Find existing package names and rosdep keys that are similar to an unknown name.

A fix needs a name that is certainly meant (:meth:`Spelling.same`, :meth:`Spelling.one_slip`). For a suggestion in a
message, similar names suffice (:meth:`Spelling.near`). Further functions recognize the name of a library's vendor
package, and the rosdep key for a part of a library.
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

_MIN_LETTERS = 5
"""Minimum length of a word with one wrong letter, because shorter words such as pcl and pil are similar by chance."""

_MIN_SWAPPED = 4
"""Minimum length of a word with two swapped letters. It is smaller, because no two known names differ by swapped letters."""

_MOST_NAMES_WITH_WORD = 150

_PACKAGE_NAME = re.compile(r"[a-z][a-z0-9_]*")


class Spelling:
    """A set of existing names, for look-ups of names that are similar to an unknown name."""

    def __init__(self, names: Iterable[str]) -> None:
        self._names = sorted({name for name in names if "\n" not in name})
        self._by_word: dict[str, list[str]] = {}

    def same(self, name: str) -> tuple[str, ...]:
        """Return the existing names that differ from ``name`` only by dashes, underscores and capitals, sorted."""
        return tuple(self._plain.get(plain(name), ()))

    def one_slip(self, name: str) -> tuple[str, ...]:
        """Return the existing names that differ from ``name`` by one letter, sorted.

        The letter is omitted, added, changed, or swapped with the next letter. Digits must be equal, because ``lidar_2``
        is not a typo of ``lidar_1``.
        """
        if len(name) < _MIN_LETTERS:
            return ()
        half = len(name) // 2
        candidates: set[str] = set()
        for length in range(len(name) - 1, len(name) + 2):
            forwards, backwards = self._by_length.get(length, ([], []))
            candidates.update(_with_prefix(forwards, name[: half - 1]))
            candidates.update([reverse[::-1] for reverse in _with_prefix(backwards, name[half + 1 :][::-1])])
        return tuple(sorted([word for word in candidates if _is_slip(name, word)]))

    def near(self, name: str) -> tuple[str, ...]:
        """Return at most three existing names that resemble ``name``, the most similar first.

        Names with the same words in another order come before all others.
        """
        words = _words(name)
        alike = {candidate for word in words for candidate in self._names_with(word)}
        scored = [(-_overlap(words, _words(candidate)), candidate) for candidate in alike]
        candidates = [candidate for _, candidate in sorted(scored)[:30]]
        reordered = [candidate for candidate in candidates if sorted(_WORD.findall(name)) == sorted(_WORD.findall(candidate))]
        candidates += self.one_slip(name)
        return tuple(dict.fromkeys([*reordered, *near_names(name, dict.fromkeys(candidates), 3, 0.8)]))[:3]

    def _names_with(self, word: str) -> list[str]:
        """Return the existing names that contain a word; [] for a very common word, which is not significant."""
        cached = self._by_word.get(word)
        if cached is not None:
            return cached
        text, word_characters = self._lower, string.ascii_lowercase if word.isalpha() else string.digits
        names: list[str] = []
        at = text.find(word)
        while at >= 0 and len(names) <= _MOST_NAMES_WITH_WORD:
            end = at + len(word)
            if text[at - 1] not in word_characters and text[end] not in word_characters:
                start, end = text.rfind("\n", 0, at) + 1, text.find("\n", end)
                names += self._by_lower[text[start:end]]
            at = text.find(word, end)
        self._by_word[word] = names if len(names) <= _MOST_NAMES_WITH_WORD else []
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
        for name, plain_name in zip(self._names, plain("\n".join(self._names)).split("\n"), strict=True):
            names_of.setdefault(plain_name, []).append(name)
        return names_of

    @cached_property
    def _by_length(self) -> Mapping[int, tuple[list[str], list[str]]]:
        """The names of each length, sorted; and the names read backwards, sorted."""
        names_of: dict[int, list[str]] = {}
        for name in self._names:
            names_of.setdefault(len(name), []).append(name)
        return {length: (names, sorted([name[::-1] for name in names])) for length, names in names_of.items()}


def near_names(name: str, names: Iterable[str], most: int, least: float) -> list[str]:
    """Return at most ``most`` members of ``names`` that ``name`` may be a misspelling of, the most similar first.

    ``least`` is the minimum similarity, from 0 to 1. The members are found by
    :func:`ros_lint.base.suggestions.similar_names`, but two kinds of them are left out:

    * names with a different word, such as rear_camera for front_camera. A word that resembles a word of ``name``, or begins
      like it, does not count as different.
    * names that extend ``name``, if there are several, such as left_arm and right_arm for arm.
    """
    words = _words(name)
    similar = [candidate for candidate in similar_names(name, names, most, least) if _may_be_intended(words, _words(candidate))]
    longer = [candidate for candidate in similar if words < _words(candidate)]
    return [candidate for candidate in similar if candidate not in longer] if len(longer) > 1 else similar


def _may_be_intended(words: frozenset[str], others: frozenset[str]) -> bool:
    lacking, additional = words - others, others - words
    if not (lacking and additional):
        return True
    if all(similar_names(word, lacking) for word in additional):
        return all(similar_names(word, additional) for word in lacking)
    return all(any(word.startswith(other) or other.startswith(word) for other in additional) for word in lacking)


def may_be_package(name: str) -> bool:
    """Return whether a name is valid for a ROS package (REP 144).

    A valid name consists of lower-case letters, digits and underscores, and starts with a letter.
    """
    return _PACKAGE_NAME.fullmatch(name) is not None


def package_name(repository: str) -> str:
    """Return the name that a package in a repository most likely has: "BehaviorTree.CPP" -> "behaviortree_cpp"."""
    return re.sub("[-.]", "_", repository.lower())


def plain(name: str) -> str:
    """Return a name in lower case without dashes and underscores, because names often differ only in these and in capitals."""
    return name.replace("-", "").replace("_", "").lower()


VENDOR = "_vendor"
"""Suffix of the names of vendor packages, which wrap a library but keep its headers, CMake targets and CMake name."""


def is_vendor(package: str, library: str) -> bool:
    """Return whether a package has the name of a vendor package for ``library``.

    ``library`` is the name or the rosdep key of a library. The package name may have a prefix: rviz_assimp_vendor is for
    assimp, and google_benchmark_vendor for benchmark.
    """
    if not package.endswith(VENDOR):
        return False
    words = package.removesuffix(VENDOR).split("_")
    return _bare(library) in [_bare("_".join(words[start:])) for start in range(len(words))]


def is_part(part: str, key: str) -> bool:
    """Return whether ``key`` is the rosdep key of a library, and ``part`` the rosdep key of a part of the library.

    Example: libboost-thread-dev is a part of libboost.
    """
    words = _of_library(key)
    return words == _of_library(part)[: len(words)]


def _of_library(key: str) -> list[str]:
    return key.removesuffix("-dev").removeprefix("lib").split("-")


def _bare(library: str) -> str:
    return plain(library.removesuffix("-dev").removeprefix("lib"))


_WORD = re.compile(r"[a-z]+|[0-9]+")


def _words(name: str) -> frozenset[str]:
    return frozenset(_WORD.findall(name.lower()))


def _overlap(first: frozenset[str], second: frozenset[str]) -> float:
    return len(first & second) / len(first | second)


def _with_prefix(ordered: list[str], prefix: str) -> list[str]:
    start = bisect_left(ordered, prefix)
    end = bisect_left(ordered, f"{prefix}\uffff")
    return ordered[start:end]


def _is_slip(name: str, other: str) -> bool:
    """Return whether two names differ by one wrong letter.

    The word with the letter must be long, unless the letter is a plural s, because short words such as arm and art are often
    both right.
    """
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
        return alike and (plural or _word_length(longer, start) >= _MIN_LETTERS)
    letters = _word_length(longer, start)
    swapped = longer[start + 1 : start + 2] + longer[start]
    if swapped == shorter[start : start + 2] and longer[start + 2 :] == shorter[start + 2 :]:
        return letters >= _MIN_SWAPPED
    return letters >= _MIN_LETTERS and longer[start + 1 :] == shorter[start + 1 :]


def _word_length(name: str, at: int) -> int:
    start = end = at
    while start > 0 and name[start - 1].isalpha():
        start -= 1
    while end < len(name) and name[end].isalpha():
        end += 1
    return end - start
