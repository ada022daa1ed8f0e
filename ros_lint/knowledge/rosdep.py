"""The rosdep keys with the platforms on which they resolve, and their data file (``rosdep.tsv``; docs/knowledge.md)."""

from __future__ import annotations

import re
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.knowledge.store import Entries, KnowledgeError, Store, Table

if TYPE_CHECKING:
    from collections.abc import Mapping

PLATFORMS: Mapping[str, tuple[str, ...]] = {
    "foxy": ("ubuntu:focal",),
    "galactic": ("ubuntu:focal",),
    "humble": ("ubuntu:jammy",),
    "iron": ("ubuntu:jammy",),
    "jazzy": ("ubuntu:noble",),
    "kilted": ("ubuntu:noble",),
    "lyrical": ("ubuntu:resolute",),
    "rolling": ("ubuntu:resolute", "ubuntu:noble"),
}
"""Tier 1 platforms with Debian packages, by distribution (REP 2000).

rolling is changing its platform, so a rosdep key must resolve on one of its two platforms.
"""

LETTERS: Mapping[str, str] = {
    "j": "ubuntu:jammy",
    "n": "ubuntu:noble",
    "r": "ubuntu:resolute",
    "b": "debian:bookworm",
    "t": "debian:trixie",
    "8": "rhel:8",
    "9": "rhel:9",
    "X": "rhel:10",
    "f": "fedora:43",
    "A": "arch:",
    "o": "osx:",
}
"""The platforms in the data file by letter. A line has the letters in this order."""


class RosdepKey(NamedTuple):
    """A rosdep key, with the platforms on which it resolves and its apt and pip packages."""

    name: str
    platforms: tuple[str, ...]
    """Platforms on which the key resolves, such as "ubuntu:noble"."""
    apt: tuple[str, ...]
    """Packages that the key installs with apt on any platform."""
    pip: tuple[str, ...]


def parse(fields: list[str]) -> RosdepKey:
    """Return the rosdep key in a line, given its tab-separated fields. Raises ValueError if the fields are invalid."""
    name, letters, apt, pip = (*fields, "", "", "")[:4]
    unknown = set(letters) - LETTERS.keys()
    if unknown:
        raise ValueError(f"unknown platforms {sorted(unknown)}")
    return RosdepKey(name, tuple(LETTERS[letter] for letter in letters), tuple(apt.split()), tuple(pip.split()))


def render(key: RosdepKey) -> str:
    """Return the line of a rosdep key, without line end. The inverse of :func:`parse`."""
    letters = "".join(letter for letter, platform in LETTERS.items() if platform in key.platforms)
    return "\t".join((key.name, letters, " ".join(key.apt), " ".join(key.pip))).rstrip("\t")


def render_file(keys: Mapping[str, RosdepKey]) -> str:
    """Return the contents of the file ``rosdep.tsv``."""
    platforms = " ".join(f"{letter}={platform}" for letter, platform in LETTERS.items())
    lines = sorted(render(key) for key in keys.values())
    return "\n".join([f"# key\tresolves on: {platforms}\tapt\tpip", *lines, ""])


class Rosdep(Entries[RosdepKey]):
    """All rosdep keys of the data file."""

    def __init__(self, table: Table) -> None:
        super().__init__(table, parse)
        self._installing_keys: dict[str, tuple[str, ...]] = {}

    def resolves(self, name: str, distro: str) -> bool | None:
        """Return whether a rosdep key has a rule for a platform of a distribution; None if the key or the platform is unknown."""
        key, platforms = self.get(name), PLATFORMS.get(distro)
        if key is None or platforms is None or not set(platforms) & set(LETTERS.values()):
            return None
        return not set(platforms).isdisjoint(key.platforms)

    def installing(self, name: str) -> tuple[str, ...]:
        """Return the rosdep keys that install the apt or pip package ``name``, sorted."""
        if name not in self._installing_keys:
            spellings = dict.fromkeys((name, _pip_name(name)))
            self._installing_keys[name] = next(filter(None, map(self._installing, spellings)), ())
        return self._installing_keys[name]

    def _installing(self, name: str) -> tuple[str, ...]:
        # Names in pip have many spellings; their longest word is in each of them.
        words = [word for word in re.findall(r"[a-z0-9]+", name.lower()) if not word.startswith("python")]
        word = max(words, key=len, default="python" if name else "\n").encode()
        text, lower = self._text
        keys = []
        at = lower.find(word)
        while at >= 0:
            start, end = lower.rfind(b"\n", 0, at) + 1, lower.find(b"\n", at)
            key = parse(text[start:end].decode().split("\t"))
            if name in key.apt or any(_pip_name(pip) == name for pip in key.pip):
                keys.append(key.name)
            at = lower.find(word, end + 1)
        return tuple(keys)

    @cached_property
    def _text(self) -> tuple[bytes, bytes]:
        """All lines of the data file as bytes, and a copy in lower case of the same length, so that offsets are valid in both."""
        text = "".join(f"{line}\n" for line in self._table.lines()).encode()
        return text, text.lower()


def _pip_name(requirement: str) -> str:
    # A requirement may have a version and extras; names are compared as in PEP 503.
    return re.sub(r"[-_.]+", "-", re.split(r"[\[<>=!~; ]", requirement, maxsplit=1)[0]).lower()


def load(store: Store) -> Rosdep:
    """Return the rosdep keys of the data file. Raises KnowledgeError if the file is damaged."""
    head, table = store.table("rosdep.tsv")
    if head and not head.startswith("# key\t"):
        raise KnowledgeError(f"{store.find('rosdep.tsv')} is not a list of rosdep keys")
    return Rosdep(table)
