"""What released packages install: one line each, read and written here (``.prov``; docs/knowledge.md).

Three answers, never two: a name exists, is missing, or nobody can tell.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple

from ros_lint.knowledge.store import Entries, KnowledgeError, Store, Table

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

Answer = Literal["exists", "missing", "unknowable"]
Offer = Literal["executables", "launch", "components", "plugins", "modules", "interfaces", "programs"]

LETTERS: Mapping[Offer, str] = {
    "executables": "X",
    "launch": "L",
    "components": "C",
    "plugins": "P",
    "modules": "Y",
    "interfaces": "I",
    "programs": "B",
}
"""Names in lib/<package>; launch files, relative to share/<package>; component classes; plugins as base=class; Python
modules; interfaces as msg/Name; names in bin. In the order in which they stand in a line."""


class Known(NamedTuple):
    """What is known of the names of one kind that a package provides."""

    names: tuple[str, ...] = ()
    maybe: tuple[str, ...] = ()
    """Those that depend on how it was built."""
    complete: bool = False
    """Whether there is no other name."""
    endings: tuple[str, ...] = ()
    """With any, only of names that end so was a list made: nothing is known of others."""

    @property
    def possible(self) -> tuple[str, ...]:
        """Return all names that may be there."""
        return (*self.names, *self.maybe)

    def ask(self, name: str) -> Answer:
        """Return what is known of a name."""
        if name in self.names:
            return "exists"
        if not self.complete or name in self.maybe or (self.endings and not name.endswith(self.endings)):
            return "unknowable"
        return "missing"

    def between(self, before: Iterable[Known], after: Iterable[Known]) -> Known:
        """Return what can be told from what is known of the same in earlier and in later distributions.

        It is whole where one before and one after are; what any of them has may be there.
        """
        earlier, later = list(before), list(after)
        sides = [next((one for one in side if one.complete), None) for side in (earlier, later)]
        if None in sides:
            return self
        others = [name for one in (*earlier, *later) for name in one.possible]
        maybe = dict.fromkeys(name for name in (*self.maybe, *others) if name not in self.names)
        endings = next((one.endings for one in sides if one), ())
        return Known(self.names, tuple(maybe), True, endings)


NOTHING_KNOWN = Known()
LAUNCH_ENDINGS = ("launch.py", "launch.xml", "launch.yaml", ".launch")
"""Which files the data count as launch files."""


class ReleasedContents(NamedTuple):
    """What a package installs, as far as its sources tell."""

    name: str
    origin: str
    """Which sources were read: ``=`` those of the release, ``b`` those of the branch for the distribution, ``~`` those
    of the nearest tag."""
    fields: Mapping[str, tuple[str, ...]]
    """By letter, see LETTERS. A name with ``?`` at its end depends on how the package was built."""

    @property
    def solid(self) -> bool:
        """Return whether a name that is not here does not exist either."""
        return self.origin in {"=", "b"}

    def known(self, offer: Offer) -> Known:
        names = self.fields.get(LETTERS[offer], ())
        return Known(
            tuple(name for name in names if not name.endswith("?")),
            tuple(name[:-1] for name in names if name.endswith("?")),
            self.solid,
            LAUNCH_ENDINGS if offer == "launch" else (),
        )


def parse(fields: list[str]) -> ReleasedContents:
    """Return what a line says that has been split at its tabs. Raises ValueError when it says nothing."""
    name, origin, *rest = fields
    found: dict[str, tuple[str, ...]] = {}
    for field in rest:
        letter, colon, text = field.partition(":")
        if len(letter) != 1:
            raise ValueError(f"{field!r} is not a list of names")
        # A lone Y is the module that is called as the package.
        names = text.split(" ") if colon else [name]
        found[letter] = tuple(_apart(names) if letter == LETTERS["plugins"] else names)
    return ReleasedContents(name, origin, found)


def render(provided: ReleasedContents) -> str:
    """Return the line of a package, without line end. The inverse of :func:`parse`."""
    fields = [provided.name, provided.origin]
    for letter in LETTERS.values():
        names = provided.fields.get(letter, ())
        if letter == LETTERS["plugins"]:
            names = _together(names)
        if names == (provided.name,) and letter == "Y":
            fields.append(letter)
        elif names:
            fields.append(f"{letter}:{' '.join(names)}")
    return "\t".join(fields)


def _apart(plugins: Iterable[str]) -> Iterator[str]:
    """Yield base=class for each of base=class,class."""
    for plugin in plugins:
        base, equals, classes = plugin.partition("=")
        yield from (f"{base}{equals}{one}" for one in classes.split(","))


def _together(plugins: Iterable[str]) -> tuple[str, ...]:
    """Return base=class,class for all classes of a base. The inverse of :func:`_apart`."""
    found: dict[str, list[str]] = {}
    for plugin in plugins:
        base, _, one = plugin.partition("=")
        found.setdefault(base, []).append(one)
    return tuple(f"{base}={','.join(classes)}" for base, classes in found.items())


def render_file(distro: str, packages: Iterable[ReleasedContents]) -> str:
    """Return a whole ``.prov`` file."""
    lines = sorted(render(package) for package in packages)
    return "\n".join([f"#ros-provides 1 distro={distro} packages={len(lines)}", *lines, ""])


class Provides(Entries[ReleasedContents]):
    """What the packages of one distribution install."""

    def __init__(self, table: Table) -> None:
        super().__init__(table, parse)

    def known(self, name: str, offer: Offer) -> Known:
        """Return what is known of one side of a package."""
        found = self.get(name)
        return found.known(offer) if found else NOTHING_KNOWN


def load(store: Store, distro: str) -> Provides:
    """Return what is known of a distribution: empty when nothing is. Raises KnowledgeError when the file is damaged."""
    name = f"{distro}.prov"
    head, table = store.table(name)
    if head and not head.startswith("#ros-provides 1 "):
        raise KnowledgeError(f"{store.find(name)} is not a list of installed files in a format that this version supports")
    return Provides(table)
