"""From mentions to uses: whose name is it, what is it needed for, and is the place alive?

Names are not packages: a header path, a Python module, the argument of find_package and a package name live in four name
spaces (reference, sections C2b, D6, E3.8). This module is the only one that goes from one to the other.
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple, Protocol

from ros_lint.facts import BuildScript, Facet, FileFacts, LaunchFile, Mention, Opaque, Role, Use, Via
from ros_lint.text import Span, Text

if TYPE_CHECKING:
    from ros_lint.world import Providers


class Names(Protocol):
    """The look-ups of the world that evidence needs."""

    def by_cmake(self, name: str) -> Providers: ...
    def by_include(self, header: str) -> Providers: ...
    def by_import(self, module: str) -> Providers: ...
    def is_package(self, name: str) -> bool: ...


class Source(NamedTuple):
    """What evidence needs to know of one package."""

    name: str
    path: str
    files: tuple[str, ...]
    """Relative to the package."""
    script: BuildScript | None
    facts: Mapping[str, FileFacts]
    """By path relative to the package."""
    launch: tuple[LaunchFile, ...]
    builds_with: str


TEST_FOLDERS = frozenset({"test", "tests", "testing", "integration_tests", "benchmark", "benchmarks", "gtest", "unit_tests"})
"""Folders whose files serve tests when no build target says otherwise (reference, section C6.4)."""

_IDLE_FOLDERS = frozenset({"doc", "docs", "example", "examples", "tutorial", "tutorials", "tools", "sphinx"})
"""Folders whose files are often not part of what the package builds and installs."""

_HEADERS = (".h", ".hh", ".hpp", ".hxx", ".inl", ".ipp", ".tpp", ".cuh")


def resolve(source: Source, names: Names, headers: Mapping[str, tuple[str, ...]]) -> tuple[Use, ...]:
    """Return every use of another package, sorted by place.

    ``headers`` maps the include path of each header that the workspace has below an include folder to its packages.
    """
    own = _Own(source)
    uses: list[Use] = []
    if source.script is not None:
        for mention in source.script.mentions:
            role = Role.TEST if mention.test else _script_role(source, mention.via)
            uses += _use(source, own, names, headers, mention, role, sure=True)
    for path, facts in source.facts.items():
        role, sure = own.place(path)
        for mention in facts.mentions:
            uses += _use(source, own, names, headers, mention, Role.TEST if mention.test else role, sure)
    for launch in source.launch:
        uses += _launch_uses(source, own, names, launch)
    return tuple(sorted(set(uses), key=lambda use: (use.span, use.package, use.via)))


def _script_role(source: Source, via: Via) -> Role:
    if source.builds_with == "ament_python":
        return Role.TOOL
    return Role.TOOL if via == "macro" else Role.BUILD


class _Own:
    """What belongs to the package itself, and what its files serve."""

    def __init__(self, source: Source) -> None:
        self._source = source
        self._by_name: dict[str, list[str]] = {}
        modules: set[str] = set()
        for file in source.files:
            folder, _, name = file.rpartition("/")
            self._by_name.setdefault(name, []).append(file)
            if name.endswith(".py"):
                modules.add(name[:-3])
                modules.update(folder.split("/"))
        self.modules = modules
        script = source.script
        self._tests: set[str] = set()
        self._built: set[str] = set()
        self._installed: set[str] = set()
        self._packages: tuple[str, ...] = ()
        self._sees_targets = self._sees_python = False
        if script is not None:
            for target in script.targets:
                (self._tests if target.test else self._built).update(target.sources)
            self._tests -= self._built
            self._installed = {provided.source for provided in script.provides if provided.source}
            hidden = Facet(0)
            for opaque in script.opaque:
                hidden |= opaque.hides
            self._sees_targets = bool(self._built) and not hidden & (Facet.LIBRARIES | Facet.EXECUTABLES)
            self._sees_python = not hidden & (Facet.PYTHON | Facet.EXECUTABLES)
            self._packages = tuple(name.replace(".", "/") for name in script.python_packages)

    def place(self, path: str) -> tuple[Role, bool]:
        """Return what a file is needed for, and whether it is sure to be alive."""
        folders = path.split("/")[:-1]
        name = path.rpartition("/")[2]
        if path in self._tests:
            return Role.TEST, True
        if path in self._built:
            return Role.BUILD | Role.EXEC, True
        if name.endswith((".msg", ".srv", ".action", ".idl")):
            return Role.BUILD | Role.EXPORT | Role.EXEC, True
        if TEST_FOLDERS.intersection(folders) or (name.startswith("test_") and name.endswith(".py")) or name == "conftest.py":
            return Role.TEST, True
        if name.endswith(_HEADERS):
            public = path.startswith("include/")
            role = Role.BUILD | Role.EXPORT | Role.EXEC if public else Role.BUILD | Role.EXEC
            return role, public or not _IDLE_FOLDERS.intersection(folders)
        if name.endswith((".py", ".py.in")) or "." not in name:
            if path == "setup.py":
                return Role.TOOL, True
            alive = path in self._installed or any(
                path.startswith(f"{package}/") or path == f"{package}.py" for package in self._packages
            )
            return Role.EXEC, alive or (not self._sees_python and not _IDLE_FOLDERS.intersection(folders))
        return Role.BUILD | Role.EXEC, not self._sees_targets and not _IDLE_FOLDERS.intersection(folders)

    def has_header(self, header: str, includer: str) -> bool:
        """Whether an include can mean a file of the package."""
        if header.startswith(("./", "../")):
            return True
        head, _, name = header.rpartition("/")
        own = self._source.name
        if header.partition("/")[0] in (own, f"{own}_export") and "/" in header:
            return True
        stems = (name, f"{name}.in", f"{name}.em")
        return any(
            not head or file.rpartition("/")[0].endswith(head) for stem in stems for file in self._by_name.get(stem, ())
        ) or posixpath.normpath(posixpath.join(posixpath.dirname(includer), header)) in self._by_name.get(name, ())


def _use(
    source: Source,
    own: _Own,
    names: Names,
    headers: Mapping[str, tuple[str, ...]],
    mention: Mention,
    role: Role,
    sure: bool,
) -> Iterator[Use]:
    providers = _providers(source, own, names, headers, mention)
    if not providers or source.name in providers:
        return
    what = mention.what or _WHAT[mention.via].format(mention.name)
    yield Use(providers[0], providers, role, what, mention.via, mention.optional, mention.span, sure)


_WHAT: Mapping[Via, str] = {
    "package": "{}",
    "cmake": "find_package({})",
    "macro": "{}()",
    "target": "{}",
    "include": "#include <{}>",
    "import": "import {}",
    "interface": "{}",
    "key": "{}",
    "launch": "{}",
}


def _providers(
    source: Source, own: _Own, names: Names, headers: Mapping[str, tuple[str, ...]], mention: Mention
) -> tuple[str, ...]:
    name = mention.name
    match mention.via:
        case "include":
            if own.has_header(name, mention.span.path.removeprefix(f"{source.path}/")):
                return ()
            if found := headers.get(name):
                return found
            return names.by_include(name).names
        case "import":
            if name.partition(".")[0] in own.modules:
                return ()
            return names.by_import(name).names
        case "cmake":
            return names.by_cmake(name).names
        case "target" | "macro":
            return names.by_cmake(name.partition("::")[0]).names
        case "interface":
            package = name.partition("/")[0]
            return (package,) if names.is_package(package) else ()
        case "package" | "launch":
            return (name,) if names.is_package(name) else ()
        case "key":
            return (name,)


def _launch_uses(source: Source, own: _Own, names: Names, launch: LaunchFile) -> Iterator[Use]:
    relative = launch.path.removeprefix(f"{source.path}/") if source.path else launch.path
    role, sure = own.place(relative)
    role = Role.TEST if role == Role.TEST else Role.EXEC
    for reference in launch.references:
        package = reference.package
        if package == source.name or not names.is_package(package):
            continue
        starts = reference.kind in ("node", "component", "include")
        what = f"{reference.kind} {reference.name}".strip() if starts else package
        via: Via = "launch" if starts else "package"
        yield Use(package, (package,), role, what, via, False, reference.package_span, sure)


def include_index(sources: Iterable[Source]) -> dict[str, tuple[str, ...]]:
    """Return, for every header below an ``include`` folder of the workspace, the packages that have it, by include path."""
    found: dict[str, tuple[str, ...]] = {}
    for source in sources:
        for file in source.files:
            if not file.endswith(_HEADERS):
                continue
            _, marker, header = f"/{file}".partition("/include/")
            if not marker:
                continue
            # include/<package>/<package>/x.hpp and include/<package>/x.hpp are both written <package>/x.hpp.
            for spelling in {header, header.removeprefix(f"{source.name}/") if header.count("/") > 1 else header}:
                have = found.get(spelling, ())
                if source.name not in have:
                    found[spelling] = (*have, source.name)
    return found


def opaque_of(source: Source) -> tuple[Opaque, ...]:
    """Return everything that hides a side of the package."""
    found: list[Opaque] = list(source.script.opaque) if source.script else []
    for facts in source.facts.values():
        found += facts.opaque
    for launch in source.launch:
        found += launch.opaque
    return tuple(sorted(found, key=lambda opaque: (opaque.span, opaque.reason)))


def unused_names(declared: Sequence[str], uses: Sequence[Use]) -> tuple[str, ...]:
    """Return the declared names that no use, sure or not, is satisfied by."""
    used = {provider for use in uses for provider in use.providers}
    return tuple(name for name in dict.fromkeys(declared) if name not in used)


def traces(names: Sequence[str], texts: Iterable[Text]) -> dict[str, Span]:
    """Return a place for every name that stands as a word in one of the texts, dashes and underscores taken as equal."""
    left = {name: re.compile(_word(name)) for name in names}
    found: dict[str, Span] = {}
    for text in texts:
        for name, pattern in list(left.items()):
            if hit := pattern.search(text.text):
                found[name] = text.span(hit.start(), hit.end())
                del left[name]
        if not left:
            break
    return found


def _word(name: str) -> str:
    return rf"(?<![A-Za-z0-9]){'[-_]'.join(re.escape(part) for part in re.split('[-_]', name))}(?![A-Za-z0-9])"
