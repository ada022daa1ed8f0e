"""Find types of other packages that C++ code uses by unqualified names.

The code contains neither an include of the other package nor its name. Examples:

* `route_handler::RouteHandler` inside the outer namespace of both packages,
* a class, through a using-declaration of a third package,
* a message, through ``using pkg::msg::Type;`` in a header.

A package with such a use is not reported as unused. The use alone is not reported as an undeclared dependency.
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
    from ros_lint.workspace.usage.package_files import PackageSource

_CODE = (*HEADERS, *SOURCES)


class _TypeNames(NamedTuple):
    """The names of a package's types and namespaces. Their occurrence in C++ code shows that the code uses the package."""

    types: frozenset[bytes]
    spaces: frozenset[bytes]
    """Components of the package's namespaces; a qualified type counts only after one of them."""


class NameSet(Protocol):
    """A set of names that supports ``in`` only."""

    def __contains__(self, name: str, /) -> bool: ...


class Types:
    """Finds unqualified names of types in the packages of a workspace.

    ``transitive`` returns, for the name of a package, the names of all packages that its dependencies provide transitively.
    """

    def __init__(self, sources: Sequence[PackageSource], tree: Tree, transitive: Callable[[str], NameSet]) -> None:
        self._by_name = {source.name: source for source in sources}
        self._tree = tree
        self._transitive = transitive
        self._public: dict[str, _TypeNames] = {}
        self._introduced: dict[str, Mapping[str, set[bytes]]] = {}

    def used(self, source: PackageSource, names: Iterable[str]) -> Mapping[str, Span]:
        """Return, for each of the package names, a place where ``source`` uses a type of the package by an unqualified name.

        For a package of the workspace, the types are those that its public headers declare. For a package of
        interfaces, they are the aliases of its messages in public headers of transitive dependencies of ``source``.
        """
        wanted_names = {
            name: type_names for name in names if (type_names := self._type_names(source, name)).types or type_names.spaces
        }
        if not wanted_names:
            return {}
        texts = list(self._texts(source, source.files))
        code: dict[str, bytes] = {}
        places: dict[str, Span] = {}
        for name, type_names in wanted_names.items():
            tail = to_bytes(name.partition("_")[2])
            for word in (*sorted(type_names.types), *([tail] if tail in type_names.spaces else [])):
                texts_with_word = [(path, text) for path, text in texts if word in text]  # a quick check that excludes most files
                code.update((path, cpp_types.without_comments(text)) for path, text in texts_with_word if path not in code)
                place = cpp_types.first_use([(path, code[path]) for path, _ in texts_with_word], word, type_names.spaces)
                if place:
                    places[name] = place
                    break
        return places

    def _type_names(self, source: PackageSource, name: str) -> _TypeNames:
        workspace_source = self._by_name.get(name)
        if workspace_source is not None and not (workspace_source.script and workspace_source.script.products.interfaces):
            return self._declared_types(workspace_source)
        provided = self._transitive(source.name)
        types = [
            self._message_aliases(name, *header) for header in self._headers_by_package.get(name, ()) if header[0] in provided
        ]
        return _TypeNames(frozenset(name for of_header in types for name in of_header), frozenset())

    def _declared_types(self, source: PackageSource) -> _TypeNames:
        if source.name not in self._public:
            texts = [text for _, text in self._texts(source, filter(_is_public, source.files))]
            spaces = frozenset(part for text in texts for part in cpp_types.namespaces(text))
            self._public[source.name] = _TypeNames(
                frozenset(name for text in texts for name in cpp_types.declared_types(text)), spaces
            )
        return self._public[source.name]

    def _message_aliases(self, name: str, package: str, file: str) -> Set[bytes]:
        """Return the names that a header gives to messages of a package (``using pkg::msg::Type;``). The header is read once."""
        source = self._by_name[package]
        key = join(source.path, file)
        if key not in self._introduced:
            self._introduced[key] = cpp_types.interface_aliases(b"".join([text for _, text in self._texts(source, [file])]))
        return self._introduced[key].get(name, frozenset())

    @cached_property
    def _headers_by_package(self) -> Mapping[str, Sequence[tuple[str, str]]]:
        """For each package name: the public headers that mention it, as pairs of the header's package and the header's path."""
        headers: dict[str, dict[tuple[str, str], None]] = {}
        for source in self._by_name.values():
            for file in filter(_is_public, source.files):
                facts = source.facts.get(file)
                for mention in facts.mentions if facts else ():
                    if mention.via in ("include", "symbol"):
                        headers.setdefault(mention.name.partition("/")[0], {})[source.name, file] = None
        return {name: tuple(places) for name, places in headers.items()}

    def _texts(self, source: PackageSource, files: Iterable[str]) -> Iterator[tuple[str, bytes]]:
        return contents(self._tree, source.path, (file for file in files if file.endswith(_CODE)))


def _is_public(file: str) -> bool:
    return file.startswith("include/") and file.endswith(HEADERS)
