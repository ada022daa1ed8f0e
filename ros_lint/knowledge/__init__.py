"""Data about released ROS 2 packages: indexes of distributions, rosdep keys, and maps from names to packages.

The data are shipped with ros-lint and have a date. Data that ``ros-lint index refresh`` wrote to the user's data folder
override them. Each file is read when it is first needed. Formats and accuracy: docs/knowledge.md.
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
    from collections.abc import Collection, Mapping, Sequence

    from ros_lint.knowledge.provides import ContentKind, Known


class RosDistribution(NamedTuple):
    """A ROS 2 distribution whose package index is in the data."""

    name: str
    long_term: bool
    """True for a long-term support release."""


def distros(places: Sequence[str] = ()) -> tuple[RosDistribution, ...]:
    """Return the distributions with a package index, oldest first, rolling last.

    ``places`` are folders whose data files override the shipped ones, e.g.
    :func:`ros_lint.knowledge.store.user_directory`.
    """
    names = sorted(Store(places).names(".idx"), key=lambda name: name == "rolling")
    return tuple([RosDistribution(name, name != "rolling" and _is_long_term(name)) for name in names])


def newest_lts(places: Sequence[str] = ()) -> str:
    """Return the newest long-term support release with a package index.

    ``places`` are folders with data as in :func:`distros`.
    """
    return [distro.name for distro in distros(places) if distro.long_term][-1]


_LONG_TERM = frozenset({"foxy", "humble", "jazzy", "lyrical"})


def _is_long_term(name: str) -> bool:
    # Names are alphabetic, one a year; every second release, in even years, has five years of support (REP 2000).
    return name in _LONG_TERM or (name[0] > "l" and (ord(name[0]) - ord("l")) % 2 == 0)


class _DataFiles:
    """The parsed data files of all distributions. Each file is read when it is first needed."""

    def __init__(self, store: Store) -> None:
        self._store = store
        self._indexes: dict[str, Index] = {}
        self._contents: dict[str, Provides] = {}

    def index(self, distro: str) -> Index:
        if distro not in self._indexes:
            self._indexes[distro] = index.load(self._store, distro)
        return self._indexes[distro]

    def provides(self, distro: str) -> Provides:
        if distro not in self._contents:
            self._contents[distro] = provides.load(self._store, distro)
        return self._contents[distro]

    @cached_property
    def rosdep(self) -> Rosdep:
        return rosdep.load(self._store)

    @cached_property
    def names(self) -> Names:
        return names.Names(self._store)

    @cached_property
    def distros(self) -> tuple[str, ...]:
        """All distributions with a package index, oldest first."""
        return tuple(distro.name for distro in distros(self._store.places))


class Knowledge:
    """The data about one distribution, with look-ups in the data of other distributions.

    Each look-up raises KnowledgeError if a data file is damaged. For a distribution without a package index,
    :attr:`covered` is False and all look-ups of packages are empty.
    """

    def __init__(self, distro: str, places: Sequence[str] = ()) -> None:
        self.distro = distro
        self._data = _DataFiles(Store(places))
        self._elsewhere: dict[str, frozenset[str]] = {}
        self._distros_with: dict[str, tuple[Index, ...]] = {}
        self._supplemented: dict[tuple[str, str, ContentKind], Known] = {}

    def of(self, distro: str) -> Knowledge:
        """Return the data about another distribution. It shares the parsed data files with this object."""
        other = Knowledge(distro)
        other._data = self._data
        return other

    @property
    def covered(self) -> bool:
        """True if the distribution has a package index."""
        return len(self.index) > 0

    @property
    def distributions(self) -> Mapping[str, bool]:
        """All known distributions by name.

        The value is True if the distribution has a package index; most ended ones have none.
        """
        ended = dict.fromkeys([name.rpartition(" ")[2].lower() for name in names.END_OF_LIFE.values()], False)
        return {**ended, **dict.fromkeys(self._order, True)}

    @property
    def date(self) -> str:
        """Date of the package index as YYYY-MM-DD, "" if there is no index."""
        date: str = self.index.date
        return date

    @cached_property
    def index(self) -> Index:
        return self._data.index(self.distro)

    def provided(self, package: str, kind: ContentKind) -> Known:
        """Return the known names of one kind, such as executables, that a released package provides.

        If the sources of the release were not read, the lists of earlier and later distributions are used. A name in any
        of these lists may exist. Other names are missing if one earlier and one later list are complete, because nearly
        no name exists in a middle distribution only. Of packages whose sources were read for three distributions, this
        holds for 0 of 995 executables, 0 of 304 components, 0 of 1,182 plugins, 2 of 772 launch files and 4 of 1,855
        interfaces.
        """
        return self._provided(self.distro, package, kind)

    def _provided(self, distro: str, package: str, kind: ContentKind) -> Known:
        contents = self._provides(distro).known(package, kind)
        if contents.complete or package not in self._index(distro):
            return contents
        key = (distro, package, kind)
        if key not in self._supplemented:
            self._supplemented[key] = contents.between(*self._neighbours(distro, package, kind))
        return self._supplemented[key]

    def _neighbours(self, distro: str, package: str, kind: ContentKind) -> tuple[list[Known], list[Known]]:
        """Return the names of one kind in a package, for each distribution: two lists, before ``distro`` and after it."""
        at = self._order.index(distro)
        parts = self._order[:at], self._order[at + 1 :]
        before, after = ([self._provides(name).known(package, kind) for name in part] for part in parts)
        return before, after

    def _provides(self, distro: str) -> Provides:
        return self._data.provides(distro)

    @cached_property
    def rosdep(self) -> Rosdep:
        return self._data.rosdep

    @cached_property
    def names(self) -> Names:
        return self._data.names

    @cached_property
    def others(self) -> tuple[Index, ...]:
        """Package indexes of the other distributions, oldest first."""
        return tuple(self._data.index(distro) for distro in self._order if distro != self.distro)

    @property
    def _order(self) -> tuple[str, ...]:
        """All distributions with a package index, oldest first."""
        return self._data.distros

    def _index(self, distro: str) -> Index:
        return self.index if distro == self.distro else next(entry for entry in self.others if entry.distro == distro)

    def elsewhere(self, name: str) -> tuple[str, ...]:
        """Return the distributions that contain a package, oldest first, without the distribution to check for."""
        return tuple(entry.distro for entry in self._indexes_with(name))

    def _indexes_with(self, name: str) -> tuple[Index, ...]:
        distributions = self._distros_with.get(name)
        if distributions is None:
            distributions = self._distros_with[name] = tuple([entry for entry in self.others if name in entry])
        return distributions

    def may_exist_elsewhere(self, package: str, kind: ContentKind, name: str) -> bool:
        """Return whether a package may provide ``name``, a name of a kind such as "executables", in any other distribution."""
        return any(contents.ask(name) != "missing" for contents in self.known_elsewhere(package, kind))

    def known_elsewhere(self, package: str, kind: ContentKind) -> tuple[Known, ...]:
        """Return the names of a kind that a package provides, with one entry for each other distribution with the package."""
        return tuple([self._provided(entry.distro, package, kind) for entry in self._indexes_with(package)])

    def provides_elsewhere(self, package: str, name: str) -> bool | None:
        """Return whether ``name`` is a transitive dependency of ``package`` in any other distribution.

        Return None if no other distribution contains the package, or if ``name`` is unknown in those that do.
        """
        distributions = self._indexes_with(package)
        is_known = name in self.rosdep or any(distribution in distributions for distribution in self._indexes_with(name))
        if not distributions or not is_known:
            return None
        if package not in self._elsewhere:
            provided = set().union(*(distribution.closure((package,)).names for distribution in distributions))
            queue = list(provided)
            for name_or_key in queue:  # keys provide further keys
                new = [key for key in self.names.provided_keys(name_or_key) if key not in provided]
                provided.update(new)
                queue += new
            self._elsewhere[package] = frozenset(provided)
        return name in self._elsewhere[package]

    def distros_providing(self, packages: Collection[str], name: str) -> tuple[str, ...]:
        """Return the other distributions in which ``name`` is a transitive dependency of one of ``packages``, oldest first."""
        return tuple([entry.distro for entry in self._indexes_with(name) if name in entry.closure(packages)])

    @property
    def active(self) -> tuple[str, ...]:
        """Distributions before their end of life, with a package index, oldest first."""
        return self._order

    def rosdep_resolves(self, name: str, distro: str) -> bool:
        """Return whether ``rosdep install`` resolves a name in a distribution, as a released package or as a rosdep key.

        ``distro`` is the distribution of this object, or another one with a package index. If the platforms of the
        distribution are unknown, all rosdep keys count as resolved.
        """
        if self._index(distro).releases(name):
            return True
        return name in self.rosdep and self.rosdep.resolves(name, distro) is not False

    @property
    def platform(self) -> str:
        """First platform of the distribution, such as "ubuntu:noble"; "" if unknown."""
        return next(iter(PLATFORMS.get(self.distro, ())), "")

    def distros_resolving(self, key: str) -> tuple[str, ...]:
        """Return the distributions on whose platforms a rosdep key resolves, oldest first."""
        return tuple(distro for distro in self._data.distros if self.rosdep.resolves(key, distro))

    def resolves(self, key: str) -> bool | None:
        """Return whether a rosdep key has a rule for a platform of the distribution; None if key or platform is unknown."""
        return self.rosdep.resolves(key, self.distro)
