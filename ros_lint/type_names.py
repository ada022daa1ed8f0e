"""Types of other packages that C++ code uses by their bare names, which some header in between makes possible.

Neither an include nor the name of a package stands there: `route_handler::RouteHandler` inside the namespace that both
packages are in, a class by a using-declaration of a third package, a message by ``using pkg::msg::Type;`` in a header.
So these are traces: they speak against "unused", and are no evidence of a need.
"""

from __future__ import annotations

import re
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.liveness import HEADERS
from ros_lint.text import Span
from ros_lint.tree import join

if TYPE_CHECKING:
    from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence

    from ros_lint.evidence import Source

_SOURCES = (*HEADERS, ".c", ".cc", ".cpp", ".cxx", ".cu")
_TYPE = re.compile(
    rb"\b(?:class|struct|union|enum(?:\s+(?:class|struct))?)\s+(?:[A-Z][A-Z0-9_]*\s+)?([A-Za-z_]\w+)(?=\s*(?:final\b|\{|:(?!:)))"
)
_ALIAS = re.compile(rb"\busing\s+(\w+)\s*=|\btypedef\s+[^;{}]*?\b(\w+)\s*;")
_QUALIFIED = re.compile(rb"(\w+)::(\w+)")
_NAMESPACE = re.compile(rb"\bnamespace\s+([\w:]+)\s*\{")
_WORDS = re.compile(rb"[A-Za-z_]\w+")
_NO_CODE = re.compile(rb'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.DOTALL)
_QUALIFIER = re.compile(rb"(\w+)\s*::\s*\Z")
_NEAR = 80
"""How many bytes before a name are looked at for what qualifies it."""
_SHORTEST = 4
"""Of shorter names too many mean something else."""


def declared(text: bytes) -> frozenset[bytes]:
    """Return the names of the types that C++ code declares, forward declarations left out."""
    return frozenset(name for name in _TYPE.findall(text) if len(name) >= _SHORTEST)


def introduced(text: bytes, package: str) -> frozenset[bytes]:
    """Return the names under which C++ code makes messages of a package known: ``using pkg::msg::T;``, ``using X = ...``."""
    name = re.escape(package.encode())
    kinds = rb"::(?:msg|srv|action)::"
    plain = re.findall(rb"\busing\s+(?:::)?" + name + kinds + rb"(\w+)\s*;", text)
    alias = re.findall(rb"\busing\s+(\w+)\s*=\s*(?:typename\s+)?(?:::)?" + name + kinds + rb"\w+", text)
    return frozenset(found for found in (*plain, *alias) if len(found) >= _SHORTEST)


class _Wanted(NamedTuple):
    """What tells of a package."""

    types: frozenset[bytes]
    spaces: frozenset[bytes]
    """The parts of its namespaces: its types may stand behind these, and behind no other."""


class Types:
    """Looks for bare names of types, in the packages of a workspace. ``brought`` says what comes along with a package."""

    def __init__(self, sources: Sequence[Source], read: Callable[[str], bytes], brought: Callable[[str], Container[str]]) -> None:
        self._by_name = {source.name: source for source in sources}
        self._read = read
        self._brought = brought
        self._public: dict[str, _Wanted] = {}
        self._introduced: dict[tuple[str, str], frozenset[bytes]] = {}

    def used(self, source: Source, names: Iterable[str]) -> Mapping[str, Span]:
        """Return a place for each of some packages that a package uses a type of without saying whose it is.

        Packages of the workspace are asked for what their public headers declare, packages of messages for what public
        headers of packages that come along make of their messages.
        """
        sought = {name: wanted for name in names if (wanted := self._wanted(source, name)).types or wanted.spaces}
        if not sought:
            return {}
        texts = [(path, _code(text)) for path, text in self._texts(source, source.files)]
        own = frozenset(name for _, text in texts for name in _own(text))
        qualified = {pair for _, text in texts for pair in _QUALIFIED.findall(text)}
        words = {path: frozenset(_WORDS.findall(text)) for path, text in texts}
        found: dict[str, Span] = {}
        for name, wanted in sought.items():
            others = frozenset(word for space, word in qualified if space not in wanted.spaces)
            tail = frozenset([name.partition("_")[2].encode()]) & wanted.spaces
            for path, text in texts:
                types = words[path] & (wanted.types - own - others)
                place = _first_type(text, sorted(types), wanted.spaces) or _first_space(text, words[path] & (tail - own))
                if place:
                    found[name] = _span(path, text, *place)
                    break
        return found

    def _wanted(self, source: Source, name: str) -> _Wanted:
        other = self._by_name.get(name)
        if other is not None and not (other.script and other.script.interfaces):
            return self._declared(other)
        places = [place for place in self._naming.get(name, ()) if place[0] in self._brought(source.name)]
        types = [self._of_messages(name, *place) for place in places]
        return _Wanted(frozenset(name for of_header in types for name in of_header), frozenset())

    def _declared(self, source: Source) -> _Wanted:
        if source.name not in self._public:
            texts = [text for _, text in self._texts(source, filter(_is_public, source.files))]
            spaces = frozenset(part for text in texts for name in _NAMESPACE.findall(text) for part in name.split(b"::"))
            self._public[source.name] = _Wanted(frozenset(name for text in texts for name in declared(text)), spaces)
        return self._public[source.name]

    def _of_messages(self, name: str, package: str, file: str) -> frozenset[bytes]:
        source = self._by_name[package]
        for path, text in self._texts(source, [file]):
            if (path, name) not in self._introduced:
                self._introduced[path, name] = introduced(text, name)
            return self._introduced[path, name]
        return frozenset()

    @cached_property
    def _naming(self) -> Mapping[str, Sequence[tuple[str, str]]]:
        """Return the public headers that name a package, each with the package that it belongs to."""
        found: dict[str, dict[tuple[str, str], None]] = {}
        for source in self._by_name.values():
            for file in filter(_is_public, source.files):
                facts = source.facts.get(file)
                for mention in facts.mentions if facts else ():
                    if mention.via in ("include", "symbol"):
                        found.setdefault(mention.name.partition("/")[0], {})[source.name, file] = None
        return {name: tuple(places) for name, places in found.items()}

    def _texts(self, source: Source, files: Iterable[str]) -> Iterator[tuple[str, bytes]]:
        for file in files:
            if file.endswith(_SOURCES):
                path = join(source.path, file)
                try:
                    yield path, self._read(path)
                except OSError:
                    continue


def _is_public(file: str) -> bool:
    return file.startswith("include/") and file.endswith(HEADERS)


def _code(text: bytes) -> bytes:
    """Return C++ code with blanks for comments and strings, each character at its offset."""
    return _NO_CODE.sub(lambda match: re.sub(rb"[^\n]", b" ", match[0]), text)


def _own(text: bytes) -> Iterator[bytes]:
    """Yield the names that a file gives a meaning itself."""
    yield from declared(text)
    yield from (name for match in _ALIAS.findall(text) for name in match if name)
    yield from (name.rpartition(b"::")[2] for name in _NAMESPACE.findall(text))


def _first_type(text: bytes, names: Iterable[bytes], spaces: Container[bytes]) -> tuple[int, int] | None:
    """Return start and end of the first of some names that stands alone, or behind one of the namespaces."""
    for name in names:
        for match in re.finditer(rb"(?<![\w.>])" + name + rb"\b", text):
            qualifier = _QUALIFIER.search(text, max(match.start() - _NEAR, 0), match.start())
            if qualifier is None or qualifier[1] in spaces:
                return match.span()
    return None


def _first_space(text: bytes, names: Iterable[bytes]) -> tuple[int, int] | None:
    """Return start and end of the first of some namespaces that something is taken from."""
    for name in names:
        if match := re.search(rb"\b" + name + rb"(?=::)", text):
            return match.span()
    return None


def _span(path: str, text: bytes, start: int, end: int) -> Span:
    line = text.count(b"\n", 0, start) + 1
    column = len(text[text.rfind(b"\n", 0, start) + 1 : start].decode("utf-8", "replace")) + 1
    return Span(path, line, column, line, column + end - start)
