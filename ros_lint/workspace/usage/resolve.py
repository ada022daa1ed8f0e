"""From mentions to uses: resolve each name to the package to declare, with its role.

Names are not packages: a header path, a Python module, the argument of find_package and a package name are in four
name spaces. Only this module translates between them.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple, Protocol

from ros_lint.base.paths import strip_folder
from ros_lint.base.text import Span
from ros_lint.facts.build import REPOSITORIES
from ros_lint.facts.launch import LaunchFile
from ros_lint.facts.manifest import Role
from ros_lint.facts.sources import Mention, Use, Via
from ros_lint.knowledge.spelling import may_be_package
from ros_lint.workspace.usage.file_roles import FileRoles
from ros_lint.workspace.usage.own_files import OwnFiles
from ros_lint.workspace.usage.package_files import Source, include_index

if TYPE_CHECKING:
    from ros_lint.facts.repositories import ExpectedRepositories
    from ros_lint.knowledge.providers import Providers
    from ros_lint.knowledge.world import Resolution


class Names(Protocol):
    """The look-ups that resolution needs; :class:`ros_lint.knowledge.world.World` implements them."""

    def by_cmake(self, name: str) -> Providers: ...
    def by_macro(self, package: str) -> Providers: ...
    def by_include(self, header: str) -> Providers: ...
    def by_import(self, module: str) -> Providers: ...
    def is_package(self, name: str) -> bool: ...
    def standing(self, name: str) -> Resolution: ...
    def is_declared(self, name: str) -> bool: ...
    @property
    def awaited(self) -> ExpectedRepositories: ...


_make = tuple.__new__
"""Creates a named tuple in half the time of a call of its class."""


_WORD = re.compile("[A-Za-z0-9]+")

_BUILD_MODULES = frozenset({"setuptools", "distutils", "pkg_resources", "pip"})
"""Modules that are always available when a Python package is built."""

_TEST = Role.TEST
_LOOKED_UP = Role.EXEC
"""Role of a package whose files are looked up at run time: nothing is compiled against it."""


class Answer(NamedTuple):
    """The owners of a mentioned name."""

    providers: tuple[str, ...]
    """Each name whose declaration satisfies the mention, the best first; empty if none is known."""
    sure: bool = True
    what: str = ""
    """Quotation of the mention for a message."""


_NOBODY = Answer(())
_INTERFACES = re.compile(r"[a-z][a-z0-9_]*[./](?:msg|srv|action)(?:[./]|\Z)")
"""Headers and modules of interfaces: only ROS packages have them, even if the package is unknown."""
_OF_ROS_1 = re.compile(r"[a-z][a-z0-9_]*_(?:msgs|srvs)/[A-Z]\w*\.h")
"""Headers of messages as ROS 1 generates them; headers of ROS 2 are in a folder ``msg``."""
_OF_TESTS = ("gtest/", "gmock/")
"""Include prefixes that only tests use when they are in a header without a source."""


class Resolver:
    """Resolves names to packages, once for all packages of a workspace."""

    def __init__(self, sources: Sequence[Source], names: Names) -> None:
        self.names = names
        self._headers = include_index(sources)
        self._sources = frozenset([source.name for source in sources])
        self._empty = frozenset([source.name for source in sources if source.built.cmake.makes_nothing])
        self._ask: Mapping[Via, Callable[[str], Answer]] = {
            "include": self._include,
            "import": self._imported,
            "cmake": self._found,
            "target": lambda name: self._told(self.names.by_cmake(name.partition("::")[0]), name.partition("::")[0]),
            "macro": lambda name: self._told(self.names.by_macro(name.partition("::")[0]), name.partition("::")[0]),
            "interface": lambda name: self._package(name.partition("/")[0]),
            "package": self._package,
            "symbol": lambda name: Answer((name,)) if self.names.is_package(name) else _NOBODY,
            "launch": lambda name: Answer((name,)) if self.names.is_package(name) else self._strange(name),
            "key": lambda name: Answer((name,)),
        }
        self._answers: Mapping[Via, dict[str, Answer]] = {via: {} for via in self._ask}

    def answer(self, via: Via, name: str) -> Answer:
        """Return the owner of a name, under the assumption that it is not the package that mentions it."""
        answers = self._answers[via]
        found = answers.get(name)
        if found is None:
            found = answers[name] = self._ask[via](name)._replace(what=_WHAT[via].format(name))
        return found

    def _include(self, header: str) -> Answer:
        found = self._headers.get(header)
        first, slash, _ = header.partition("/")
        if not found:
            if (slash and first in self._empty) or _OF_ROS_1.fullmatch(header):
                return _NOBODY  # a library named like a metapackage, or headers of ROS 1
            return self._told(self.names.by_include(header), first if slash else "", header)
        if slash and first not in found:
            known = self.names.by_include(header)
            if known.known and not set(found).intersection(known.names):  # a vendored copy of a known header
                return Answer((*known.names, *found), known.sure)
        return Answer(tuple(sorted(found, key=lambda package: package != first)))

    def _imported(self, module: str) -> Answer:
        first = module.partition(".")[0]
        found = self._told(self.names.by_import(module), first, module)
        # An interface module refers to the package of its name even if the module is unknown.
        meant = not found.providers and first in self._sources and _INTERFACES.match(module)
        return Answer((first,)) if meant else found

    def _package(self, name: str) -> Answer:
        # Definitions in test data and look-ups in templates contain many names that do not exist.
        return Answer((name,)) if self.names.is_package(name) else self._strange(name, self.names.is_declared(name))

    def looked_up(self, name: str) -> Answer:
        """Return an owner of an unknown name that is certainly looked up: the package of that name."""
        return Answer((name,), False, name) if self.names.standing(name) == "unknown" and may_be_package(name) else _NOBODY

    def _found(self, name: str) -> Answer:
        known = self.names.by_cmake(name)
        # A library may have any name, but hardly the name of a dependency of another package by chance.
        return self._told(known, name) if known.known or not may_be_package(name) else self._package(name)

    def _told(self, providers: Providers, name: str, whole: str = "") -> Answer:
        if providers.known:
            return Answer(providers.names, providers.sure)
        return self._strange(name, bool(whole) and _INTERFACES.match(whole) is not None)

    def _strange(self, name: str, interfaces: bool = False) -> Answer:
        """Return the owner of a name that no package here provides.

        The owner is a package of another or a former distribution, or the package of used ``interfaces``. The use
        of the latter is certain only if the workspace declares the package.
        """
        standing = self.names.standing(name) if name else "unknowable"
        if standing == "elsewhere":
            return Answer((name,))
        declared = interfaces and self.names.is_declared(name)
        # A submodule that is not cloned may be a library; a name that another package declares is not.
        if standing == "end-of-life" or (standing == "unknown" and interfaces) or (standing == "unknowable" and declared):
            return Answer((name,), declared)
        return _NOBODY


_WHAT: Mapping[Via, str] = {
    "package": "{}",
    "cmake": "find_package({})",
    "macro": "{}()",
    "target": "{}",
    "include": "#include <{}>",
    "import": "import {}",
    "interface": "{}",
    "symbol": "{}",
    "key": "{}",
    "launch": "{}",
}


def resolve(source: Source, resolver: Resolver, own: OwnFiles) -> tuple[Use, ...]:
    """Return each use of another package, sorted by place.

    ``own`` resolves names of the package's own files.
    """
    launched = frozenset(strip_folder(source.path, launch.path) for launch in source.launch)
    tests = frozenset(strip_folder(source.path, launch.path) for launch in source.launch if launch.test)
    alive = FileRoles(own, launched)
    uses = _Uses(source, own, alive, resolver)
    forgone = own.forgone(_lenient(source, alive))
    _add_script(source, uses)
    for path, facts in source.facts.items():
        if not facts.mentions or alive.is_foreign(path):
            continue
        role, sure = alive.place(path)
        role = _TEST if path in tests else role
        mentions = list(facts.mentions)
        if alive.is_optional(path) or (path in forgone and not alive.is_started(path)):
            mentions = [mention._replace(optional=True) for mention in mentions]
        if path in launched:  # the launch collector yields the packages, except for those of plugins
            mentions = [mention for mention in mentions if mention.via != "package" or mention.purpose == "plugins"]
        uses.add(path, mentions, role, _TEST if role is _TEST else _LOOKED_UP, sure)
    for launch in source.launch:
        path = strip_folder(source.path, launch.path)
        if alive.is_foreign(path):
            continue
        role, sure = alive.place(path)
        _launch_uses(launch, _TEST if launch.test else role, uses, sure)
    return uses.sorted()


def _add_script(source: Source, uses: _Uses) -> None:
    """Add the names in the build script, and the packages that it finds on behalf of dependents."""
    by_role: dict[tuple[str, Role], list[Mention]] = {}
    untaken = frozenset(source.built.cmake.unused_optional_finds)
    for mention in source.built.mentions:
        if mention.purpose == "plugins":
            continue  # the loader of the plugins is optional, and headers name the package of the base class
        role = _TEST if mention.test else _script_role(source, mention)
        only_named = mention.via == "cmake" and mention.span in untaken
        ours = by_role.setdefault((mention.span.path, role), [])
        ours.append(mention._replace(optional=True) if only_named else mention)
    for (path, role), mentions in by_role.items():
        uses.add(strip_folder(source.path, path), mentions, role, role, sure=True)
    for mention, always in source.built.exports.packages:
        uses.add(strip_folder(source.path, mention.span.path), [mention], Role.EXPORT, Role.EXPORT, always)
    _unspoken(source, uses)


class _Uses:
    """The uses collected in a package.

    The last of several uses with equal place, package and name space counts.
    """

    def __init__(self, source: Source, own: OwnFiles, alive: FileRoles, resolver: Resolver) -> None:
        self.package = source.name
        self.resolver = resolver
        self._own = own
        self._alive = alive
        self._absent = resolver.names.awaited.uncloned
        self._caught = frozenset([name for path in _lenient(source, alive) for name in source.facts[path].optional_modules])
        self._added = frozenset([span for facts in source.facts.values() for span in facts.path_additions])
        script = source.built
        self._reaches_out = script.cmake.includes_outside_package
        self._bundled = frozenset([name.lower() for name in script.cmake.bundled_projects])
        self._found_always = frozenset(
            [mention.name for mention in script.mentions if mention.via == "cmake" and not (mention.optional or mention.test)]
        )
        self._found: dict[tuple[Span, str, Via], Use] = {}

    def put(self, use: Use) -> None:
        self._found[use.span, use.package, use.via] = use

    def sorted(self) -> tuple[Use, ...]:
        return tuple([use for _, use in sorted(self._found.items())])

    def add(self, path: str, mentions: Iterable[Mention], role: Role, looked_up: Role, sure: bool) -> None:
        """Add the uses that result from the mentions in a file.

        ``looked_up`` is the role of packages whose files are looked up at run time.
        """
        package, answer, found = self.package, self.resolver.answer, self._found
        own = self._own.included(path)
        for name, via, span, what, optional, test, purpose in mentions:
            if (via == "include" and (name in own or self._is_bundled(name))) or (
                via == "import" and self._is_own_module(name, path)
            ):
                continue
            providers, known, usual = answer(via, name)
            if not providers and via == "package" and sure and not (optional or test or role is _TEST):
                providers, known, usual = self.resolver.looked_up(name)
            if not providers or package in providers:
                continue
            if via == "include" and providers[0] in self._own.include_folders and name.startswith(f"{providers[0]}/"):
                continue
            needed = _TEST if test else looked_up if via == "package" else role
            if via == "include" and name.startswith(_OF_TESTS) and self._alive.serves_tests(path):
                needed = _TEST
            spared = optional
            if via == "import":
                spared = spared or self._is_spared(name, span, providers[0])
                known = known and name.partition(".")[0] not in self._absent
            elif known and self._reaches_out and via == "include" and "/" not in name:
                known = False  # any include directory may have it
            elif self._absent and known:
                known = self._is_here(name, providers[0])
            if not known and providers[0] in self._found_always and _INTERFACES.match(name):
                known = True  # certainly in use: the build fails without it
            by: Via = "macro" if purpose == "helper" else via
            found[span, providers[0], by] = _make(
                Use, (providers[0], providers, needed, what or usual, by, spared, span, sure and known, name)
            )

    def _is_here(self, name: str, best: str) -> bool:
        """Return whether no submodule that is not cloned can provide a header or a library."""
        if REPOSITORIES.get(name.partition("/")[0]) in self._absent:
            return False
        return self.resolver.names.is_package(best) or self._absent.isdisjoint(_WORD.findall(name))

    def _is_spared(self, name: str, span: Span, best: str) -> bool:
        """Return whether a module may be missing or unknown: the package imports it elsewhere as optional."""
        if span in self._added:
            return not self.resolver.names.is_package(best)
        return bool(self._caught) and any(name == module or name.startswith(f"{module}.") for module in self._caught)

    def _is_bundled(self, header: str) -> bool:
        """Return whether a header is of a bundled project: in the project's folder, or ``owner/name.hpp``."""
        if not self._bundled:
            return False
        path = header.lower()
        folder = path.partition("/")[0]
        return not self._bundled.isdisjoint((folder, REPOSITORIES.get(folder, folder), path.rpartition(".")[0]))

    def _is_own_module(self, name: str, path: str) -> bool:
        top = name.partition(".")[0]
        return self._own.has_module(top, path) or (top in _BUILD_MODULES and path.endswith("setup.py"))


def _lenient(source: Source, alive: FileRoles) -> list[str]:
    """Return the files of the package with optional imports, tests aside."""
    return [path for path, facts in source.facts.items() if facts.optional_modules and alive.place(path)[0] is not _TEST]


def _unspoken(source: Source, uses: _Uses) -> None:
    """Add the implicit use of action_msgs: rosidl generates actions with its types."""
    if source.name == _ACTIONS or not any(interface.startswith("action/") for interface in source.built.products.interfaces):
        return
    for mention in source.built.mentions:
        if mention.via == "macro" and mention.purpose == "interfaces" and uses.resolver.names.is_package(_ACTIONS):
            role = _TEST if mention.test else Role.BUILD | Role.EXPORT | Role.EXEC
            uses.put(Use(_ACTIONS, (_ACTIONS,), role, "an action", "macro", mention.optional, mention.span))


_ACTIONS = "action_msgs"


def _script_role(source: Source, mention: Mention) -> Role:
    if source.builds_with == "ament_python" or mention.via == "macro" or mention.purpose == "tool":
        return Role.TOOL
    return Role.EXPORT if mention.purpose == "export" else Role.BUILD


def _launch_uses(launch: LaunchFile, role: Role, uses: _Uses, sure: bool) -> None:
    for reference in launch.references:
        package = reference.package
        if reference.kind == "program":
            continue
        answer = uses.resolver.answer("launch", package)
        if package != uses.package and answer.providers:
            what = package if reference.kind == "package" else f"{reference.kind} {reference.name}"
            uses.put(
                Use(package, (package,), role, what, "launch", reference.optional, reference.package_span, sure and answer.sure)
            )


def satisfying(uses: Iterable[Use]) -> frozenset[str]:
    """Return each name whose declaration satisfies a use."""
    return frozenset([name for answer in {use.providers for use in uses} for name in answer])


def used_names(declared: Iterable[str], uses: Iterable[Use]) -> frozenset[str]:
    """Return the declared names that satisfy a use: for each use, only the best declared provider."""
    names = frozenset(declared)
    answers = {use.providers for use in uses}
    return frozenset([name for answer in answers for name in [provider for provider in answer if provider in names][:1]])
