"""Suggestions for unknown names in settings, on the command line and in files."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from functools import lru_cache
from itertools import islice, pairwise

_MOST_COMPARED = 100
"""Number of names that are all compared with a name. Among more names, only those that share rare letter pairs with it are."""
_MOST_NAMES = 4_000
"""Greatest number of names in which similar ones are searched for: a suggestion is not worth more time."""
_MOST_PLACES = 600
_MOST_CANDIDATES = 6


def similar_names(name: str, names: Iterable[str], most: int = 1, least: float = 0.6) -> list[str]:
    """Return at most ``most`` of ``names`` that resemble ``name``, the most similar first.

    ``least`` is the minimum similarity, from 0 to 1. Among more than a hundred names, only some are compared, and none among
    more than some thousand.
    """
    from difflib import get_close_matches  # noqa: PLC0415  (slow to import, and needed for unknown names only)

    known = _sorted(names) if isinstance(names, frozenset) else tuple(sorted(islice(names, _MOST_NAMES + 1)))
    if len(known) > _MOST_COMPARED:
        known = _candidates(name, known) if len(known) <= _MOST_NAMES else ()
    return get_close_matches(name, known, most, least)


@lru_cache(maxsize=8)
def _sorted(names: frozenset[str]) -> tuple[str, ...]:
    """Return the names sorted, only some if there are too many. A frozenset computes its hash once, so that look-ups are fast."""
    return tuple(sorted(islice(names, _MOST_NAMES + 1)))


def _candidates(name: str, names: tuple[str, ...]) -> tuple[str, ...]:
    """Return those of many names that share the largest part of their letter pairs with ``name``.

    The rarest pairs are looked up first.
    """
    places = _places_of_pairs(names)
    found = sorted([places[pair] for pair in dict.fromkeys(_pairs(name)) if pair in places], key=len)
    shared: Counter[int] = Counter()
    left = _MOST_PLACES
    for numbers in found:
        shared.update(numbers[:left])
        left -= len(numbers)
        if left <= 0:
            break
    ranked = sorted([(-common / (len(name) + len(names[number])), number) for number, common in shared.items()])
    return tuple([names[number] for _, number in ranked[:_MOST_CANDIDATES]])


@lru_cache(maxsize=8)
def _places_of_pairs(names: tuple[str, ...]) -> dict[str, list[int]]:
    """Return the numbers of the names that contain a pair of letters, by pair."""
    places: dict[str, list[int]] = {}
    for number, name in enumerate(names):
        for pair in dict.fromkeys(_pairs(name)):
            places.setdefault(pair, []).append(number)
    return places


def _pairs(name: str) -> list[str]:
    return [first + second for first, second in pairwise(f"^{name}$")]


def nearest_names(name: str, names: Iterable[str]) -> list[str]:
    """Return the members of ``names`` that resemble ``name`` most: several if they are equally similar, [] if none is similar."""
    from difflib import SequenceMatcher  # noqa: PLC0415  (slow to import, and needed for unknown names only)

    near = similar_names(name, names, most=3)
    ratios = [SequenceMatcher(None, other, name).ratio() for other in near]
    return [other for other, ratio in zip(near, ratios, strict=True) if ratio == max(ratios)]


_DESCRIPTIONS = frozenset({"launch", "lua", "rviz", "sdf", "srdf", "urdf", "yaml"})
_SAME_KIND = {"world": "sdf", "yml": "yaml"}


def of_same_kind(path: str, paths: tuple[str, ...]) -> tuple[str, ...]:
    """Return the members of ``paths`` with the kind of file of the misspelled ``path``, or with no known kind.

    Example: robot.srdf cannot mean robot.urdf.xacro. The kind is the last suffix, without ``.xacro`` and without the
    suffix of the language (``.launch.py``). Only robot descriptions, launch files and parameter files have a kind: a mesh,
    for example, may be stored in another format. If ``path`` has no kind, all members are returned.
    """
    kind = _kind_of_file(path)
    return _of_kind(kind, paths) if kind else paths


@lru_cache(maxsize=8)
def _of_kind(kind: str, paths: tuple[str, ...]) -> tuple[str, ...]:
    return tuple([path for path in paths if _kind_of_file(path) in ("", kind)])


def _kind_of_file(path: str) -> str:
    suffixes = path.rpartition("/")[2].split(".")[1:]
    kinds = [_SAME_KIND.get(suffix, suffix) for suffix in suffixes]
    return next((kind for kind in ("launch", *reversed(kinds)) if kind in kinds and kind in _DESCRIPTIONS), "")


def did_you_mean(names: Sequence[str], after: str = "; ") -> str:
    """Return the end of a message that suggests ``names``: "; did you mean 'a' or 'b'?". Return "" if ``names`` is empty.

    ``after`` is the text between the message and the suggestion.
    """
    return f"{after}did you mean {' or '.join(map(_quoted, names))}?" if names else ""


def ask_if_meant(names: Sequence[str]) -> str:
    """Return the end of a message that suggests only the first of ``names``: "; did you mean 'a'?".

    Return "" if ``names`` is empty.
    """
    return did_you_mean(names[:1])


def _quoted(name: str) -> str:
    """Return a name as it appears in messages: in quotes, except for tags such as <depend>."""
    return name if name.startswith("<") else f"'{name}'"


def and_list(words: Sequence[str]) -> str:
    """Return words joined for a sentence: "a, b and c"."""
    return " and ".join(filter(None, (", ".join(words[:-1]), *words[-1:])))


_MOST_LISTED = 3


def shorten_list(names: Iterable[str]) -> str:
    """Return the first three names in quotes, followed by the number of further names: "'a', 'b', 'c' and 2 more"."""
    names = list(names)
    first = ", ".join([f"'{name}'" for name in names[:_MOST_LISTED]])
    return f"{first} and {len(names) - _MOST_LISTED} more" if len(names) > _MOST_LISTED else first
