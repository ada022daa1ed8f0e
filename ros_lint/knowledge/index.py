"""The index of the packages of a distribution, and its file format (``.idx``; docs/knowledge.md).

Each package has one line with tab-separated fields: name, version, flags and repository, then a field for each set of
dependency kinds. Such a field has the letters of the kinds, and the names that are declared with exactly these kinds.

Example: ``rclcpp_action<TAB>28.1.9<TAB>c<TAB>rclcpp<TAB>bex:action_msgs rclcpp<TAB>t:ament_cmake_ros``
"""

from __future__ import annotations

import re
from collections import defaultdict
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.collectors.interfaces.naming import GROUP
from ros_lint.knowledge.closure import Closure, Reach
from ros_lint.knowledge.store import Entries, KnowledgeError, Store, Table

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

KINDS = "bteuxsd"
"""Letters of dependency kinds in their order in a field: build, buildtool, build_export, buildtool_export, exec, test, doc."""

RUNTIME = frozenset("eux")
"""Letters of the dependency kinds that also apply to the dependents of a package: build_export, buildtool_export and exec."""

BUILD_TYPES: Mapping[str, str] = {
    "c": "ament_cmake",
    "p": "ament_python",
    "m": "cmake",
    "k": "catkin",
    "n": "meson",
    "?": "",
}


class Released(NamedTuple):
    """The entry of a package in the index of a distribution."""

    name: str
    """Name of the package."""
    version: str
    """Version of the release."""
    flags: str
    """Letter of the build type (a key of BUILD_TYPES), followed by letters for properties.

    ``i`` interface package, ``m`` metapackage, ``D`` deprecated, ``E`` repository at its end of life, ``U`` listed in the
    distribution file but not released, ``-`` only the name is known, ``~`` the dependencies may be those of an older
    version.
    """
    repository: str
    """Name of the repository that contains the package."""
    depends: Mapping[str, tuple[str, ...]]
    """Sorted names by letter: letters of KINDS for dependencies, ``M`` for groups with this package, ``G`` for required groups.

    b build, t buildtool, e build_export, u buildtool_export, x exec, s test, d doc.
    """

    @property
    def build_type(self) -> str:
        """Build type such as "ament_cmake", "ament_python" or "cmake"; "" if unknown."""
        return BUILD_TYPES.get(self.flags[:1], "")

    @property
    def described(self) -> bool:
        """True if the dependencies of the package are known."""
        return not {"-", "U"} & set(self.flags)

    @property
    def interfaces(self) -> bool:
        """True if the package generates messages, services or actions."""
        return "i" in self.flags[1:]

    @property
    def groups(self) -> tuple[str, ...]:
        """Dependency groups (REP 149) that the package is a member of, including the group of interface packages."""
        return (*self.depends.get("M", ()), *((GROUP,) if self.interfaces else ()))

    def on(self, kinds: Iterable[str]) -> tuple[str, ...]:
        """Return the dependencies of the given kinds (letters of KINDS), sorted."""
        return tuple(sorted({name for kind in kinds for name in self.depends.get(kind, ())}))


def parse(fields: list[str]) -> Released:
    """Return the index entry in a line, given its tab-separated fields. Raises ValueError if the fields are invalid."""
    name, version, flags, *rest = fields
    repository, *sets = rest or [""]
    depends: dict[str, tuple[str, ...]] = {}
    for field in sets:
        kinds, colon, text = field.partition(":")
        if not colon:
            raise ValueError(f"{field!r} has no colon")
        names = tuple(text.split(" "))
        for kind in (kinds,) if kinds in "MG" else kinds:
            depends[kind] = (*depends[kind], *names) if kind in depends else names
    return Released(name, version, flags, repository or name, depends)


def render(package: Released) -> str:
    """Return the line of an index entry, without line end. The inverse of :func:`parse`, except for the order of names."""
    kinds_of: dict[str, str] = {}
    for kind in KINDS:
        for name in package.depends.get(kind, ()):
            kinds_of[name] = kinds_of.get(name, "") + kind
    names_of: dict[str, list[str]] = {}
    for name in sorted(kinds_of):
        names_of.setdefault(kinds_of[name], []).append(name)
    for group in "MG":
        if groups := package.depends.get(group):
            names_of[group] = sorted(groups)
    # <depend> comes first because most look-ups need it.
    order = sorted(names_of, key=lambda kinds: (kinds != "bex", kinds))
    sets = [f"{kinds}:{' '.join(names_of[kinds])}" for kinds in order]
    repository = "" if package.repository == package.name else package.repository
    return "\t".join((package.name, package.version, package.flags, repository, *sets)).rstrip("\t")


def render_file(distro: str, commit: str, date: str, packages: Iterable[Released]) -> str:
    """Return the contents of an ``.idx`` file.

    ``commit`` is that of rosdistro, ``date`` the date of the data, as in 2026-08-22.
    """
    lines = sorted(render(package) for package in packages)
    head = f"#ros-index 1 distro={distro} rosdistro={commit or 'unknown'} date={date} packages={len(lines)}"
    return "\n".join([head, *lines, ""])


class Index(Entries[Released]):
    """The package index of one distribution."""

    def __init__(self, distro: str, head: str, table: Table) -> None:
        super().__init__(table, parse)
        self.distro = distro
        fields = dict(_HEAD.findall(head))
        self.date = fields.get("date", "")
        self.commit = fields.get("rosdistro", "")
        self._reach = Reach(self.runtime)

    def releases(self, name: str) -> bool:
        """Return whether a package is released. Some packages are listed in the distribution file without a release."""
        row = self._table.row(name)
        return row is not None and (len(row) < 3 or "U" not in row[2])

    def members(self, group: str) -> Iterator[str]:
        """Yield the names of the packages that are members of a dependency group (REP 149), sorted."""
        # Few lines name a group, and parsing all of them takes long. Membership in the group of interface packages is
        # the flag i, because a sixth of all packages has it.
        lines = self._table.lines() if group == GROUP else self._grouped
        for line in lines:
            if group == GROUP or group in line:
                package = self.get(line.partition("\t")[0])
                if package is not None and group in package.groups:
                    yield package.name

    @cached_property
    def _grouped(self) -> list[str]:
        """Lines of the packages that are members of a dependency group other than the group of interface packages."""
        return [line for line in self._table.lines() if "\tM:" in line]

    def declared_as(self, name: str) -> Mapping[str, int]:
        """Return how many packages declare a dependency on ``name``, by the kinds of the declaration (letters of KINDS).

        {"t": 12, "bex": 1}: 12 packages declare ``buildtool_depend``, and one declares ``depend``.
        """
        counts: dict[str, int] = {}
        for kinds in self._declared.get(name, ()):
            counts[kinds] = counts.get(kinds, 0) + 1
        return counts

    @cached_property
    def _declared(self) -> Mapping[str, list[str]]:
        """For each name, the kinds (letters of KINDS) with which packages declare it: ["t", "bex"] if two packages do.

        All names are collected at once in 7 ms; one name alone would take 0.3 ms.
        """
        kinds_of: defaultdict[str, list[str]] = defaultdict(list)
        for line in self._table.lines():
            for field in line.split("\t")[4:]:
                kinds, _, names = field.partition(":")
                if kinds not in "MG":
                    for name in names.split(" "):
                        kinds_of[name].append(kinds)
        return kinds_of

    def count_providers(self, name: str, most: int) -> int:
        """Return how many packages depend on ``name``, directly or indirectly, at run time or by export.

        Counting stops when the number exceeds ``most``.
        """
        providers = {name}
        queue = [name]
        for provided in queue:
            new = [provider for provider in self._direct_providers.get(provided, ()) if provider not in providers]
            providers.update(new)
            queue += new
            if len(providers) - 1 > most:
                break
        return len(providers) - 1

    @cached_property
    def _direct_providers(self) -> Mapping[str, list[str]]:
        providers: defaultdict[str, list[str]] = defaultdict(list)
        for line in self._table.lines():
            row = line.split("\t")
            for name in _runtime(row) or ():
                providers[name].append(row[0])
        return providers

    def closure(self, names: Iterable[str]) -> Closure:
        """Return ``names`` together with all their direct and indirect run-time and exported dependencies."""
        return self._reach.closure(names)

    def runtime(self, name: str) -> tuple[str, ...] | None:
        """Return the run-time and exported dependencies of a package, without groups; None if they are unknown.

        This is much faster than :meth:`get`, because no other field is parsed.
        """
        row = self._table.row(name)
        return None if row is None else _runtime(row)


def _runtime(row: list[str]) -> tuple[str, ...] | None:
    """Return the run-time and exported dependencies of a package from the fields of its line in the index; None if unknown."""
    if len(row) < 3 or "-" in row[2] or "U" in row[2]:
        return None
    result: list[str] = []
    for field in row[4:]:
        kinds, _, names = field.partition(":")
        if not RUNTIME.isdisjoint(kinds):
            result += names.split(" ")
    return tuple(result)


_HEAD = re.compile(r"(\w+)=(\S+)")


def load(store: Store, distro: str) -> Index:
    """Return the package index of a distribution. If there is no file, the index is empty and its date is "".

    Raises KnowledgeError if the file is damaged.
    """
    if not re.fullmatch(r"[a-z][a-z0-9_]*", distro):
        return Index(distro, "", Table([]))
    name = f"{distro}.idx"
    head, table = store.table(name)
    if head and not head.startswith("#ros-index 1 "):
        raise KnowledgeError(f"{store.find(name)} is not a package index in a format that this version supports")
    return Index(distro, head, table)
