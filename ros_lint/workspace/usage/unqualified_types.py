"""Find types of other packages that C++ code uses by unqualified names.

The code contains neither an include of the other package nor its name. Examples:

* `route_handler::RouteHandler` inside the outer namespace of both packages,
* a class, through a using-declaration of a third package,
* a message, through ``using pkg::msg::Type;`` in a header.

A package with such a use is not reported as unused. The use alone is not reported as an undeclared dependency.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol

from ros_lint.base.paths import join
from ros_lint.base.questions import Memo, RecordedMapping
from ros_lint.base.text import to_bytes
from ros_lint.base.tree import contents
from ros_lint.collectors.cpp import types as cpp_types
from ros_lint.collectors.suffixes import HEADERS, SOURCES

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Set

    from ros_lint.base.questions import Questions, Recorder
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


class _Declaring(NamedTuple):
    """The part of a package that tells which types it declares."""

    name: str
    path: str
    headers: tuple[str, ...]
    """The public headers, relative to the package."""
    interfaces: bool
    """True if the package generates code for interfaces."""
    mentioned: Mapping[str, tuple[str, ...]]
    """The public headers that mention a package, by the name of the package."""

    @classmethod
    def of(cls, source: PackageSource) -> _Declaring:
        headers = tuple(filter(_is_public, source.files))
        mentioned: dict[str, dict[str, None]] = {}
        for file in headers:
            facts = source.facts.get(file)
            for mention in facts.mentions if facts else ():
                if mention.via in ("include", "symbol"):
                    mentioned.setdefault(mention.name.partition("/")[0], {})[file] = None
        interfaces = bool(source.script and source.script.products.interfaces)
        return cls(source.name, source.path, headers, interfaces, {name: tuple(files) for name, files in mentioned.items()})


class Types:
    """Finds unqualified names of types in the packages of a workspace.

    ``transitive`` returns, for the name of a package, the names of all packages that its dependencies provide transitively.
    With a ``recorder``, the object can be renewed, and answers of the recorder that ask it record what they read.
    """

    def __init__(self, tree: Tree, transitive: Callable[[str], NameSet], recorder: Recorder | None = None) -> None:
        self._tree = tree
        self._transitive = transitive
        self._recorder = recorder
        self._questions: Questions = recorder.scope() if recorder else Memo()
        self._sources: Mapping[str, PackageSource] = {}
        self._declaring: dict[str, tuple[PackageSource, _Declaring]] = {}
        self._by_name: Mapping[str, _Declaring] = RecordedMapping(recorder) if recorder else {}

    def renew(self, sources: Sequence[PackageSource]) -> None:
        """Take the packages of the workspace."""
        self._sources = {source.name: source for source in sources}
        if self._recorder is None:
            return
        assert isinstance(self._by_name, RecordedMapping)
        for name, source in self._sources.items():
            known = self._declaring.get(name)
            if known is None or known[0] is not source:
                self._declaring[name] = source, _Declaring.of(source)
        self._recorder.change(list(self._by_name.update({name: self._declaring[name][1] for name in self._sources})))

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
        declaring = self._packages.get(name)
        if declaring is not None and not declaring.interfaces:
            return self._questions.ask(("declared", name), lambda: self._declared_types(name))
        provided = self._transitive(source.name)
        headers = self._questions.ask(("headers", name), lambda: self._headers_with(name))
        types = [self._message_aliases(package, file).get(name, frozenset()) for package, file in headers if package in provided]
        return _TypeNames(frozenset(name for of_header in types for name in of_header), frozenset())

    @property
    def _packages(self) -> Mapping[str, _Declaring]:
        """The packages by name."""
        if self._recorder is None and not self._by_name:  # few workspaces need them
            self._by_name = {name: _Declaring.of(source) for name, source in self._sources.items()}
        return self._by_name

    def _declared_types(self, name: str) -> _TypeNames:
        declaring = self._packages[name]
        texts = [text for _, text in contents(self._tree, declaring.path, declaring.headers)]
        spaces = frozenset(part for text in texts for part in cpp_types.namespaces(text))
        return _TypeNames(frozenset(name for text in texts for name in cpp_types.declared_types(text)), spaces)

    def _message_aliases(self, package: str, file: str) -> Mapping[str, Set[bytes]]:
        """Return the names that a header gives to messages (``using pkg::msg::Type;``), by package. The header is read once."""
        path = join(self._packages[package].path, file)
        return self._questions.ask(("aliases", path), lambda: self._find_aliases(path))

    def _find_aliases(self, path: str) -> Mapping[str, Set[bytes]]:
        return cpp_types.interface_aliases(b"".join([text for _, text in contents(self._tree, "", [path])]))

    def _headers_with(self, name: str) -> Sequence[tuple[str, str]]:
        """Return the public headers that mention a package, as pairs of the header's package and the header's path."""
        return self._questions.ask("headers", self._find_headers).get(name, ())

    def _find_headers(self) -> Mapping[str, Sequence[tuple[str, str]]]:
        headers: dict[str, list[tuple[str, str]]] = {}
        for declaring in self._packages.values():
            for name, files in declaring.mentioned.items():
                headers.setdefault(name, []).extend([(declaring.name, file) for file in files])
        return headers

    def _texts(self, source: PackageSource, files: Iterable[str]) -> Iterator[tuple[str, bytes]]:
        return contents(self._tree, source.path, (file for file in files if file.endswith(_CODE)))


def _is_public(file: str) -> bool:
    return file.startswith("include/") and file.endswith(HEADERS)
