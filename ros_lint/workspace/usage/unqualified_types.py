"""Find types of other packages that C++ code uses by unqualified names.

Neither an include nor the name of the package is in the code. Examples:

* `route_handler::RouteHandler` inside the outer namespace of both packages,
* a class, through a using-declaration of a third package,
* a message, through ``using pkg::msg::Type;`` in a header.

Such a place speaks against "unused", but it is not evidence of a missing dependency.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple, Protocol

from ros_lint.base.paths import join
from ros_lint.base.text import to_bytes
from ros_lint.base.tree import contents
from ros_lint.collectors.cpp import types as cpp_types
from ros_lint.collectors.suffixes import HEADERS, SOURCES

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Set

    from ros_lint.base.text import Span
    from ros_lint.base.tree import Tree
    from ros_lint.workspace.usage.package_files import Source

_CODE = (*HEADERS, *SOURCES)


class _Wanted(NamedTuple):
    """The names that identify a use of a package."""

    types: frozenset[bytes]
    spaces: frozenset[bytes]
    """Components of the package's namespaces; a qualified type counts only after one of them."""


class Names(Protocol):
    """A set of names that supports ``in`` only."""

    def __contains__(self, name: str, /) -> bool: ...


class Types:
    """Finds unqualified names of types in the packages of a workspace.

    ``along`` returns the names that a package provides transitively.
    """

    def __init__(self, sources: Sequence[Source], tree: Tree, along: Callable[[str], Names]) -> None:
        self._by_name = {source.name: source for source in sources}
        self._tree = tree
        self._along = along
        self._public: dict[str, _Wanted] = {}
        self._introduced: dict[str, Mapping[str, set[bytes]]] = {}

    def used(self, source: Source, names: Iterable[str]) -> Mapping[str, Span]:
        """Return a place for each name of a package whose types ``source`` uses unqualified.

        For a package of the workspace, the types are those that its public headers declare. For a package of
        interfaces, they are the names that public headers of transitive dependencies give to its messages.
        """
        sought = {name: wanted for name in names if (wanted := self._wanted(source, name)).types or wanted.spaces}
        if not sought:
            return {}
        texts = list(self._texts(source, source.files))
        code: dict[str, bytes] = {}
        found: dict[str, Span] = {}
        for name, wanted in sought.items():
            tail = to_bytes(name.partition("_")[2])
            for word in (*sorted(wanted.types), *([tail] if tail in wanted.spaces else [])):
                having = [(path, text) for path, text in texts if word in text]  # few have it, and this is fast
                code.update((path, cpp_types.code(text)) for path, text in having if path not in code)
                place = cpp_types.first([(path, code[path]) for path, _ in having], word, wanted.spaces)
                if place:
                    found[name] = place
                    break
        return found

    def _wanted(self, source: Source, name: str) -> _Wanted:
        other = self._by_name.get(name)
        if other is not None and not (other.script and other.script.products.interfaces):
            return self._declared(other)
        along = self._along(source.name)
        types = [self._of_messages(name, *place) for place in self._naming.get(name, ()) if place[0] in along]
        return _Wanted(frozenset(name for of_header in types for name in of_header), frozenset())

    def _declared(self, source: Source) -> _Wanted:
        if source.name not in self._public:
            texts = [text for _, text in self._texts(source, filter(_is_public, source.files))]
            spaces = frozenset(part for text in texts for part in cpp_types.namespaces(text))
            self._public[source.name] = _Wanted(frozenset(name for text in texts for name in cpp_types.declared(text)), spaces)
        return self._public[source.name]

    def _of_messages(self, name: str, package: str, file: str) -> Set[bytes]:
        """Return the names that a header gives to messages of a package. The header is read once."""
        source = self._by_name[package]
        key = join(source.path, file)
        if key not in self._introduced:
            self._introduced[key] = cpp_types.introduced(b"".join([text for _, text in self._texts(source, [file])]))
        return self._introduced[key].get(name, frozenset())

    @cached_property
    def _naming(self) -> Mapping[str, Sequence[tuple[str, str]]]:
        """The public headers that mention each package, with the package that has the header."""
        found: dict[str, dict[tuple[str, str], None]] = {}
        for source in self._by_name.values():
            for file in filter(_is_public, source.files):
                facts = source.facts.get(file)
                for mention in facts.mentions if facts else ():
                    if mention.via in ("include", "symbol"):
                        found.setdefault(mention.name.partition("/")[0], {})[source.name, file] = None
        return {name: tuple(places) for name, places in found.items()}

    def _texts(self, source: Source, files: Iterable[str]) -> Iterator[tuple[str, bytes]]:
        return contents(self._tree, source.path, (file for file in files if file.endswith(_CODE)))


def _is_public(file: str) -> bool:
    return file.startswith("include/") and file.endswith(HEADERS)
