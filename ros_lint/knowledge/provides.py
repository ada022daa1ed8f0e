"""The contents of released packages, such as executables, and their file format (``.prov``; docs/knowledge.md).

The file has a line for each package. For some names, the file does not decide whether they exist.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple

from ros_lint.knowledge.store import Entries, KnowledgeError, Store, Table

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

Answer = Literal["exists", "missing", "unknowable"]
"""Answer to the question whether a name exists. "unknowable": there is no data to decide the question."""
ContentKind = Literal["executables", "launch", "components", "plugins", "modules", "interfaces", "programs"]
"""Kinds of names that a package provides. "programs" are files in bin, "executables" are files in lib/<package>."""

LETTERS: Mapping[ContentKind, str] = {
    "executables": "X",
    "launch": "L",
    "components": "C",
    "plugins": "P",
    "modules": "Y",
    "interfaces": "I",
    "programs": "B",
}
"""The letter of each kind of names, in the order of the fields in a line.

The names are: executables in lib/<package>; launch files relative to share/<package>; component classes; plugins as
base=class; Python modules; interfaces as msg/Name; programs in bin.
"""


class Known(NamedTuple):
    """The known names of one kind, such as executables, that a package provides."""

    names: tuple[str, ...] = ()
    """Names that certainly exist."""
    maybe: tuple[str, ...] = ()
    """Names that exist or not, depending on how the package was built."""
    complete: bool = False
    """True if ``names`` and ``maybe`` are all names."""
    endings: tuple[str, ...] = ()
    """If not empty, only a name with one of these suffixes can be missing; any other unlisted name is unknowable."""

    @property
    def possible(self) -> tuple[str, ...]:
        """All names that exist or may exist."""
        return (*self.names, *self.maybe)

    def ask(self, name: str) -> Answer:
        """Return "exists" or "missing" for a name, "unknowable" if the known names do not decide whether it exists."""
        if name in self.names:
            return "exists"
        if not self.complete or name in self.maybe or (self.endings and not name.endswith(self.endings)):
            return "unknowable"
        return "missing"

    def between(self, before: Iterable[Known], after: Iterable[Known]) -> Known:
        """Return this list of names, completed by the lists of earlier (``before``) and later (``after``) distributions.

        If one earlier and one later list are complete, the result is complete, too, and the names of all lists may exist.
        Otherwise this list is returned unchanged.
        """
        earlier, later = list(before), list(after)
        sides = [next((contents for contents in side if contents.complete), None) for side in (earlier, later)]
        if None in sides:
            return self
        neighbours = [name for contents in (*earlier, *later) for name in contents.possible]
        maybe = dict.fromkeys(name for name in (*self.maybe, *neighbours) if name not in self.names)
        endings = next((contents.endings for contents in sides if contents), ())
        return Known(self.names, tuple(maybe), True, endings)


NOTHING_KNOWN = Known()
LAUNCH_ENDINGS = ("launch.py", "launch.xml", "launch.yaml", ".launch")
"""Endings of the names of launch files that the data files list."""


class ReleasedContents(NamedTuple):
    """The contents of a released package that can be derived from its sources."""

    name: str
    origin: str
    """The sources that were read: ``=`` those of the release, ``b`` the branch for the distribution, ``~`` the nearest tag."""
    fields: Mapping[str, tuple[str, ...]]
    """Names by the letter of their kind, see LETTERS.

    The suffix ``?`` of a name means that its existence depends on how the package was built.
    """

    @property
    def complete(self) -> bool:
        """True if ``fields`` has all contents of the package."""
        return self.origin in {"=", "b"}

    def known(self, kind: ContentKind) -> Known:
        """Return the names of one kind, such as executables, in this package, and whether the list of names is complete."""
        names = self.fields.get(LETTERS[kind], ())
        return Known(
            tuple(name for name in names if not name.endswith("?")),
            tuple(name[:-1] for name in names if name.endswith("?")),
            self.complete,
            LAUNCH_ENDINGS if kind == "launch" else (),
        )


def parse(fields: list[str]) -> ReleasedContents:
    """Return the contents of the package in a line, given the tab-separated fields of the line.

    Raises ValueError if the fields are invalid.
    """
    name, origin, *rest = fields
    names_of: dict[str, tuple[str, ...]] = {}
    for field in rest:
        letter, colon, text = field.partition(":")
        if len(letter) != 1:
            raise ValueError(f"{field!r} is not a list of names")
        # Y without names means the module named like the package.
        names = text.split(" ") if colon else [name]
        names_of[letter] = tuple(_split_plugins(names) if letter == LETTERS["plugins"] else names)
    return ReleasedContents(name, origin, names_of)


def render(package: ReleasedContents) -> str:
    """Return the line of a data file that lists what a released package contains, without line end. :func:`parse` reads it."""
    fields = [package.name, package.origin]
    for letter in LETTERS.values():
        names = package.fields.get(letter, ())
        if letter == LETTERS["plugins"]:
            names = _join_plugins(names)
        if names == (package.name,) and letter == "Y":
            fields.append(letter)
        elif names:
            fields.append(f"{letter}:{' '.join(names)}")
    return "\t".join(fields)


def _split_plugins(plugins: Iterable[str]) -> Iterator[str]:
    """Yield ``base=class`` for each class in texts such as ``base=class,class``."""
    for plugin in plugins:
        base, equals, classes = plugin.partition("=")
        yield from (f"{base}{equals}{name}" for name in classes.split(","))


def _join_plugins(plugins: Iterable[str]) -> tuple[str, ...]:
    """Return ``base=class,class`` for each base, given texts such as ``base=class``. The inverse of :func:`_split_plugins`."""
    classes_of: dict[str, list[str]] = {}
    for plugin in plugins:
        base, _, name = plugin.partition("=")
        classes_of.setdefault(base, []).append(name)
    return tuple(f"{base}={','.join(classes)}" for base, classes in classes_of.items())


def render_file(distro: str, packages: Iterable[ReleasedContents]) -> str:
    """Return the contents of a ``.prov`` file for a distribution and its packages."""
    lines = sorted(render(package) for package in packages)
    return "\n".join([f"#ros-provides 1 distro={distro} packages={len(lines)}", *lines, ""])


class Provides(Entries[ReleasedContents]):
    """The contents of the packages of one distribution."""

    def __init__(self, table: Table) -> None:
        super().__init__(table, parse)

    def known(self, name: str, kind: ContentKind) -> Known:
        """Return the names of one kind, such as executables, that a package provides.

        If the data file does not list the package, the result is an empty and incomplete list (``NOTHING_KNOWN``).
        """
        contents = self.get(name)
        return contents.known(kind) if contents else NOTHING_KNOWN


def load(store: Store, distro: str) -> Provides:
    """Return the contents of the packages of a distribution. The result is empty if there is no file.

    Raises KnowledgeError if the file is damaged.
    """
    name = f"{distro}.prov"
    head, table = store.table(name)
    if head and not head.startswith("#ros-provides 1 "):
        raise KnowledgeError(f"{store.find(name)} is not a list of installed files in a format that this version supports")
    return Provides(table)
