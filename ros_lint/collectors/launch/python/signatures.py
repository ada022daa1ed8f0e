"""The arguments of the classes of launch and launch_ros in any ROS distribution.

The table ``signatures.tsv`` is made by :mod:`ros_lint.knowledge.refresh.launch_signatures`.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import cache
from typing import NamedTuple


class Signature(NamedTuple):
    """The arguments of a class of launch or launch_ros, in all ROS distributions together."""

    most_positional: int
    """The number of arguments that may be passed without keyword. These are the first arguments in ``kinds``."""
    closed: bool
    """False if the class may accept further arguments."""
    required: tuple[str, ...]
    """Keywords without a default in every distribution that has the class."""
    kinds: Mapping[str, str]
    """All keywords in any distribution, each with the accepted kind of value, such as "text"; "" if it is not restricted."""
    since: str
    """The first distribution with the class, "" if all distributions of the table have it."""
    newer: Mapping[str, str]
    """The first distribution with each keyword that older distributions with the class lack."""

    def position(self, keyword: str) -> int:
        """Return the position of a parameter among the positional ones, -1 if the parameter is keyword-only."""
        position = list(self.kinds).index(keyword)
        return position if position < self.most_positional else -1


@cache
def all_signatures() -> Mapping[str, Signature]:
    """Return the signatures of all classes of launch and launch_ros, by class name."""
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "signatures.tsv")
    with open(path, encoding="utf-8") as file:
        next(file)
        rows = [line.rstrip("\n").split("\t") for line in file]
    return {name: _signature(distros, most, words.split()) for name, distros, most, words in rows}


def _signature(distros: str, most: str, words: list[str]) -> Signature:
    required: list[str] = []
    kinds: dict[str, str] = {}
    newer: dict[str, str] = {}
    for word in words:
        spec, _, known = word.partition("@")
        name, _, kind = spec.partition(":")
        keyword = name.rstrip("!")
        kinds[keyword] = kind
        if name.endswith("!"):
            required.append(keyword)
        if known:
            newer[keyword] = known.partition(",")[0]
    return Signature(int(most or 0), bool(most), tuple(required), kinds, distros.partition(" ")[0], newer)
