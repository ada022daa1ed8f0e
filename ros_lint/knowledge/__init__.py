"""Knowledge about released ROS 2 packages: distributions, rosdep keys, name maps.

The data are shipped with ros-lint and dated. Data that ``ros-lint index refresh`` wrote to the user's data folder
override them. Each file is read at its first use. Formats and accuracy: docs/knowledge.md.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.knowledge import index, names, provides, rosdep
from ros_lint.knowledge.index import Index
from ros_lint.knowledge.names import Names
from ros_lint.knowledge.provides import Provides
from ros_lint.knowledge.rosdep import PLATFORMS, Rosdep
from ros_lint.knowledge.store import Store

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from ros_lint.knowledge.provides import Known, Offer


class Distribution(NamedTuple):
    """A distribution with an index."""

    name: str
    long_term: bool


def distros(places: Sequence[str] = ()) -> tuple[Distribution, ...]:
    """Return the distributions with an index, oldest first, rolling last.

    ``places`` are folders that override the shipped data, e.g. :func:`ros_lint.knowledge.store.user_directory`.
    """
    names = sorted(Store(places).names(".idx"), key=lambda name: name == "rolling")
    return tuple([Distribution(name, name != "rolling" and _is_long_term(name)) for name in names])


def newest_lts(places: Sequence[str] = ()) -> str:
    """Return the newest long-term release with an index. ``places`` as for :func:`distros`."""
    return [distro.name for distro in distros(places) if distro.long_term][-1]


_LONG_TERM = frozenset({"foxy", "humble", "jazzy", "lyrical"})


def _is_long_term(name: str) -> bool:
    # Names are alphabetic, one a year; every second release, in even years, has five years of support (REP 2000).
    return name in _LONG_TERM or (name[0] > "l" and (ord(name[0]) - ord("l")) % 2 == 0)


class Knowledge:
    """The data from the perspective of one distribution.

    Each look-up may raise KnowledgeError if a data file is damaged. A distribution without an index has an empty
    one: :attr:`covered` is False, and no name counts as unknown.
    """

    def __init__(self, distro: str, places: Sequence[str] = ()) -> None:
        self.distro = distro
        self._store = Store(places)
        self._elsewhere: dict[str, frozenset[str]] = {}
        self._having: dict[str, tuple[Index, ...]] = {}
        self._installed: dict[str, Provides] = {}
        self._between: dict[tuple[str, str, Offer], Known] = {}

    @property
    def covered(self) -> bool:
        """True if the distribution has an index."""
        return len(self.index) > 0

    @property
    def date(self) -> str:
        """Date of the index, as in 2026-08-22, or "". Messages about unknown names show it."""
        date: str = self.index.date
        return date

    @cached_property
    def index(self) -> Index:
        return index.load(self._store, self.distro)

    def provided(self, package: str, offer: Offer) -> Known:
        """Return the known names of one kind that a package provides.

        If the sources of the release were not read, earlier and later distributions are consulted. Names in any of
        them may exist. A name that no distribution has is missing if one earlier and one later list are complete.
        (Packages whose sources were read for three distributions have 995 executables, 304 components, 1,182
        plugins, 772 launch files and 1,855 interfaces; 0, 0, 0, 2 and 4 of these exist only in the middle
        distribution.)
        """
        return self._provided(self.distro, package, offer)

    def _provided(self, distro: str, package: str, offer: Offer) -> Known:
        own = self._provides(distro).known(package, offer)
        if own.complete or package not in self._index(distro):
            return own
        key = (distro, package, offer)
        if key not in self._between:
            self._between[key] = own.between(*self._around(distro, package, offer))
        return self._between[key]

    def _around(self, distro: str, package: str, offer: Offer) -> tuple[list[Known], list[Known]]:
        """Return what is known of a package in the distributions before ``distro``, and in those after it."""
        at = self._order.index(distro)
        parts = self._order[:at], self._order[at + 1 :]
        before, after = ([self._provides(name).known(package, offer) for name in part] for part in parts)
        return before, after

    def _provides(self, distro: str) -> Provides:
        if distro not in self._installed:
            self._installed[distro] = provides.load(self._store, distro)
        return self._installed[distro]

    @cached_property
    def rosdep(self) -> Rosdep:
        return rosdep.load(self._store)

    @cached_property
    def names(self) -> Names:
        return names.Names(self._store)

    @cached_property
    def others(self) -> tuple[Index, ...]:
        """Indexes of the other distributions, oldest first."""
        return tuple(index.load(self._store, distro) for distro in self._order if distro != self.distro)

    @cached_property
    def _order(self) -> tuple[str, ...]:
        """All distributions with an index, oldest first."""
        return tuple(distro.name for distro in distros(self._store.places))

    def _index(self, distro: str) -> Index:
        return self.index if distro == self.distro else next(entry for entry in self.others if entry.distro == distro)

    def elsewhere(self, name: str) -> tuple[str, ...]:
        """Return the other distributions that contain a package, oldest first."""
        return tuple(other.distro for other in self._where(name))

    def _where(self, name: str) -> tuple[Index, ...]:
        having = self._having.get(name)
        if having is None:
            having = self._having[name] = tuple([other for other in self.others if name in other])
        return having

    def offered_elsewhere(self, package: str, offer: Offer, name: str) -> bool:
        """Return whether a package may provide a name in one of the other distributions that contain it."""
        return any(known.ask(name) != "missing" for known in self.known_elsewhere(package, offer))

    def known_elsewhere(self, package: str, offer: Offer) -> tuple[Known, ...]:
        """Return the names that a package provides in each of the other distributions that contain it."""
        return tuple([self._provided(other.distro, package, offer) for other in self._where(package)])

    def brings_elsewhere(self, package: str, name: str) -> bool | None:
        """Return whether a package provides a dependency transitively in another distribution.

        None if no other distribution contains the package, or if the name is unknown there.
        """
        having = self._where(package)
        if not having or not (name in self.rosdep or any(distribution in having for distribution in self._where(name))):
            return None
        if package not in self._elsewhere:
            provided = set().union(*(distribution.brought((package,)).names for distribution in having))
            queue = list(provided)
            for name_or_key in queue:  # keys provide further keys
                new = [key for key in self.names.brought(name_or_key) if key not in provided]
                provided.update(new)
                queue += new
            self._elsewhere[package] = frozenset(provided)
        return name in self._elsewhere[package]

    def comes_elsewhere(self, packages: Collection[str], name: str) -> bool:
        """Return whether another distribution has ``name`` in the closure of any of ``packages``."""
        return any(name in other.brought(packages) for other in self._where(name))

    @property
    def active(self) -> tuple[str, ...]:
        """Active distributions with an index, oldest first."""
        return self._order

    def rosdep_resolves(self, name: str, distro: str) -> bool:
        """Return whether ``rosdep install`` resolves a name, as a released package or as a key.

        ``distro`` is an active distribution or this one. A key counts if the platforms of the distribution are
        unknown.
        """
        if self._index(distro).releases(name):
            return True
        return name in self.rosdep and self.rosdep.resolves(name, distro) is not False

    @property
    def platform(self) -> str:
        """First platform of the distribution, such as "ubuntu:noble", or "" if unknown."""
        return next(iter(PLATFORMS.get(self.distro, ())), "")

    def resolving(self, key: str) -> tuple[str, ...]:
        """Return the distributions for which a rosdep key resolves, oldest first."""
        known = distros(self._store.places)
        return tuple(distro.name for distro in known if self.rosdep.resolves(key, distro.name))

    def resolves(self, key: str) -> bool | None:
        """Return whether a rosdep key has a rule for a platform of the distribution; None if unknown."""
        return self.rosdep.resolves(key, self.distro)
