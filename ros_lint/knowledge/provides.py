"""The contents of released packages, one line each, and their format (``.prov``; docs/knowledge.md).

A look-up has three answers: a name exists, is missing, or is unknowable.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple

from ros_lint.knowledge.store import Entries, KnowledgeError, Store, Table

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

Answer = Literal["exists", "missing", "unknowable"]
"""Answer to the question whether a name exists. "unknowable": there is no data to decide it."""
Offer = Literal["executables", "launch", "components", "plugins", "modules", "interfaces", "programs"]
"""Kinds of names that a package provides. "programs" are files in bin, "executables" those in lib/<package>."""

LETTERS: Mapping[Offer, str] = {
    "executables": "X",
    "launch": "L",
    "components": "C",
    "plugins": "P",
    "modules": "Y",
    "interfaces": "I",
    "programs": "B",
}
"""The letters of each kind, in their order in a line.

Executables in lib/<package>; launch files relative to share/<package>; component classes; plugins as base=class;
Python modules; interfaces as msg/Name; programs in bin.
"""


class Known(NamedTuple):
    """The known names of one kind that a package provides."""

    names: tuple[str, ...] = ()
    """Names that exist."""
    maybe: tuple[str, ...] = ()
    """Names that depend on how the package was built."""
    complete: bool = False
    """True if there are no other names."""
    endings: tuple[str, ...] = ()
    """If not empty, the list covers only names with these suffixes: other names are unknown."""

    @property
    def possible(self) -> tuple[str, ...]:
        """All names that may exist."""
        return (*self.names, *self.maybe)

    def ask(self, name: str) -> Answer:
        """Return whether a name exists."""
        if name in self.names:
            return "exists"
        if not self.complete or name in self.maybe or (self.endings and not name.endswith(self.endings)):
            return "unknowable"
        return "missing"

    def between(self, before: Iterable[Known], after: Iterable[Known]) -> Known:
        """Return the names supplemented by the lists for earlier and later distributions.

        The result is complete if one earlier and one later list are complete. Names in any of the lists may exist.
        """
        earlier, later = list(before), list(after)
        sides = [next((known for known in side if known.complete), None) for side in (earlier, later)]
        if None in sides:
            return self
        others = [name for known in (*earlier, *later) for name in known.possible]
        maybe = dict.fromkeys(name for name in (*self.maybe, *others) if name not in self.names)
        endings = next((known.endings for known in sides if known), ())
        return Known(self.names, tuple(maybe), True, endings)


NOTHING_KNOWN = Known()
LAUNCH_ENDINGS = ("launch.py", "launch.xml", "launch.yaml", ".launch")
"""Suffixes of the files that the data count as launch files."""


class ReleasedContents(NamedTuple):
    """The contents of a package, as far as they can be derived from its sources."""

    name: str
    origin: str
    """Sources that were read.

    ``=`` the sources of the release, ``b`` the branch for the distribution, ``~`` the nearest tag.
    """
    fields: Mapping[str, tuple[str, ...]]
    """Names by letter, see LETTERS.

    The suffix ``?`` marks a name that depends on how the package was built.
    """

    @property
    def solid(self) -> bool:
        """True if names that are not listed do not exist."""
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
    """Return the contents in a line, given its tab-separated fields.

    Raises ValueError if they are invalid.
    """
    name, origin, *rest = fields
    found: dict[str, tuple[str, ...]] = {}
    for field in rest:
        letter, colon, text = field.partition(":")
        if len(letter) != 1:
            raise ValueError(f"{field!r} is not a list of names")
        # Y without names stands for the module named like the package.
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
    """Yield base=class for each class in base=class,class."""
    for plugin in plugins:
        base, equals, classes = plugin.partition("=")
        yield from (f"{base}{equals}{name}" for name in classes.split(","))


def _together(plugins: Iterable[str]) -> tuple[str, ...]:
    """Return base=class,class for each base. The inverse of :func:`_apart`."""
    found: dict[str, list[str]] = {}
    for plugin in plugins:
        base, _, name = plugin.partition("=")
        found.setdefault(base, []).append(name)
    return tuple(f"{base}={','.join(classes)}" for base, classes in found.items())


def render_file(distro: str, packages: Iterable[ReleasedContents]) -> str:
    """Return the contents of a ``.prov`` file."""
    lines = sorted(render(package) for package in packages)
    return "\n".join([f"#ros-provides 1 distro={distro} packages={len(lines)}", *lines, ""])


class Provides(Entries[ReleasedContents]):
    """The contents of the packages of one distribution."""

    def __init__(self, table: Table) -> None:
        super().__init__(table, parse)

    def known(self, name: str, offer: Offer) -> Known:
        """Return the known names of one kind that a package provides."""
        found = self.get(name)
        return found.known(offer) if found else NOTHING_KNOWN


def load(store: Store, distro: str) -> Provides:
    """Return the contents of the packages of a distribution: empty if there is no file.

    Raises KnowledgeError if the file is damaged.
    """
    name = f"{distro}.prov"
    head, table = store.table(name)
    if head and not head.startswith("#ros-provides 1 "):
        raise KnowledgeError(f"{store.find(name)} is not a list of installed files in a format that this version supports")
    return Provides(table)
