"""From mentions to uses: resolve each name in a file to the package to declare, and to the role (build, run, test).

A mention is a place with a name that may belong to another package, a use is a mention with a known package. There are
several name spaces: header paths, Python modules, arguments of find_package(), package names and others. Only this module
translates names to packages.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple, Protocol

from ros_lint.base.paths import strip_folder
from ros_lint.base.questions import Questions, RecordedMapping, Recorder
from ros_lint.base.text import Span
from ros_lint.facts.build import REPOSITORIES
from ros_lint.facts.launch import LaunchFile
from ros_lint.facts.manifest import Role
from ros_lint.facts.sources import Mention, Use, Via
from ros_lint.knowledge.spelling import may_be_package
from ros_lint.workspace.usage.file_roles import FileRoles
from ros_lint.workspace.usage.own_files import OwnFiles
from ros_lint.workspace.usage.package_files import PackageSource, include_index

if TYPE_CHECKING:
    from ros_lint.facts.repositories import ExpectedRepositories
    from ros_lint.knowledge.providers import Providers
    from ros_lint.knowledge.world import Resolution


class ProviderLookup(Protocol):
    """The look-ups that the resolution of names needs; :class:`ros_lint.knowledge.world.World` implements them."""

    def by_cmake(self, name: str) -> Providers: ...
    def by_macro(self, package: str) -> Providers: ...
    def by_include(self, header: str) -> Providers: ...
    def by_import(self, module: str) -> Providers: ...
    def is_package(self, name: str) -> bool: ...
    def resolution(self, name: str) -> Resolution: ...
    def is_declared(self, name: str) -> bool: ...
    @property
    def awaited(self) -> ExpectedRepositories: ...


_make = tuple.__new__
"""Creates a named tuple in half the time of a call of its class."""


_WORD = re.compile("[A-Za-z0-9]+")

_BUILD_MODULES = frozenset({"setuptools", "distutils", "pkg_resources", "pip"})
"""Modules that are always available when a Python package is built."""

_TEST = Role.TEST
_LOOK_UP_ROLE = Role.EXEC
"""Role of a package whose files are looked up at run time, because nothing is compiled against it."""


class ProviderMatch(NamedTuple):
    """The packages to which a name in a file may belong."""

    providers: tuple[str, ...]
    """Names of packages or rosdep keys, each of which may be declared for the mention, the best first; () if none is known."""
    sure: bool = True
    what: str = ""
    """Text for a message that quotes the place, e.g. ``find_package(rclcpp)``."""


_NO_MATCH = ProviderMatch(())
_INTERFACES = re.compile(r"[a-z][a-z0-9_]*[./](?:msg|srv|action)(?:[./]|\Z)")
"""Matches headers and modules of interfaces. They belong to a ROS package even if it is unknown."""
_ROS_1_HEADER = re.compile(r"[a-z][a-z0-9_]*_(?:msgs|srvs)/[A-Z]\w*\.h")
"""Matches headers of messages as ROS 1 generates them. Headers of ROS 2 are in a folder ``msg`` or ``srv``."""
_TEST_PREFIXES = ("gtest/", "gmock/")
"""Include prefixes for which a header without a source is assumed to serve tests only."""


class Resolver:
    """Resolves names to packages, once for all packages of a workspace.

    With a ``recorder``, the resolver can be renewed, and answers of the recorder that ask it record what they read.
    """

    def __init__(self, names: ProviderLookup, recorder: Recorder | None = None) -> None:
        self.names = names
        self._recorder = recorder
        self._questions: Questions | None = recorder.scope() if recorder else None
        self._headers: Mapping[str, tuple[str, ...]] = RecordedMapping(recorder) if recorder else {}
        self._empty: Mapping[str, bool] = RecordedMapping(recorder) if recorder else {}
        """The packages by name. The value is True if the package makes nothing."""
        self._indexed: Sequence[tuple[str, tuple[str, ...]]] = ()
        self._matchers: Mapping[Via, Callable[[str], ProviderMatch]] = {
            "include": self._include,
            "import": self._import,
            "cmake": self._find_package,
            "target": lambda name: self._match(self.names.by_cmake(name.partition("::")[0]), name.partition("::")[0]),
            "macro": lambda name: self._match(self.names.by_macro(name.partition("::")[0]), name.partition("::")[0]),
            "interface": lambda name: self._package(name.partition("/")[0]),
            "package": self._package,
            "symbol": lambda name: ProviderMatch((name,)) if self.names.is_package(name) else _NO_MATCH,
            "launch": lambda name: ProviderMatch((name,)) if self.names.is_package(name) else self._unresolved(name),
            "key": lambda name: ProviderMatch((name,)),
        }
        self._matches: Mapping[Via, dict[str, ProviderMatch]] = {via: {} for via in self._matchers}

    def renew(self, sources: Sequence[PackageSource]) -> None:
        """Take the packages of the workspace, in which names are looked up."""
        empty: dict[str, bool] = {}
        for source in sources:
            empty[source.name] = empty.get(source.name, False) or source.built.cmake.makes_nothing
        indexed = [(source.name, source.files) for source in sources]
        headers = None if indexed == self._indexed else include_index(sources)
        self._indexed = indexed
        if self._recorder is None:
            self._empty, self._headers = empty, headers or {}
            return
        assert isinstance(self._empty, RecordedMapping)
        assert isinstance(self._headers, RecordedMapping)
        self._recorder.change([*self._empty.update(empty), *(self._headers.update(headers) if headers is not None else ())])

    def match(self, via: Via, name: str) -> ProviderMatch:
        """Return the packages that may provide ``name``, e.g. a header path. ``via`` is the kind of the name, e.g. "include".

        The result does not depend on the package that contains the name, and may contain this package.
        """
        if self._questions:
            return self._questions.ask((via, name), lambda: self._find(via, name))
        matches = self._matches[via]
        match = matches.get(name)
        if match is None:
            match = matches[name] = self._find(via, name)
        return match

    def _find(self, via: Via, name: str) -> ProviderMatch:
        return self._matchers[via](name)._replace(what=_QUOTATIONS[via].format(name))

    def _include(self, header: str) -> ProviderMatch:
        packages = self._headers.get(header)
        first, slash, _ = header.partition("/")
        if not packages:
            if (slash and self._empty.get(first, False)) or _ROS_1_HEADER.fullmatch(header):
                return _NO_MATCH  # a library named like a metapackage, or headers of ROS 1
            return self._match(self.names.by_include(header), first if slash else "", header)
        if slash and first not in packages:
            providers = self.names.by_include(header)
            if providers.known and not set(packages).intersection(providers.names):  # a vendored copy of a known header
                return ProviderMatch((*providers.names, *packages), providers.sure)
        return ProviderMatch(tuple(sorted(packages, key=lambda package: package != first)))

    def _import(self, module: str) -> ProviderMatch:
        first = module.partition(".")[0]
        match = self._match(self.names.by_import(module), first, module)
        # An interface module refers to the package of its name even if the module is unknown.
        is_own_interface = not match.providers and first in self._empty and _INTERFACES.match(module)
        return ProviderMatch((first,)) if is_own_interface else match

    def _package(self, name: str) -> ProviderMatch:
        # Definitions in test data and look-ups in templates contain many names that do not exist.
        return ProviderMatch((name,)) if self.names.is_package(name) else self._unresolved(name, self.names.is_declared(name))

    def looked_up(self, name: str) -> ProviderMatch:
        """Return the unknown package ``name``, in which code looks up files, as uncertain provider.

        The ProviderMatch is empty if the name exists in any distribution, may belong to a package that ros-lint cannot read, or
        is not a valid package name.
        """
        is_unknown = self.names.resolution(name) == "unknown" and may_be_package(name)
        return ProviderMatch((name,), False, name) if is_unknown else _NO_MATCH

    def _find_package(self, name: str) -> ProviderMatch:
        providers = self.names.by_cmake(name)
        # A library may have any name, but hardly the name of a dependency of another package by chance.
        return self._match(providers, name) if providers.known or not may_be_package(name) else self._package(name)

    def _match(self, providers: Providers, name: str, mention: str = "") -> ProviderMatch:
        if providers.known:
            return ProviderMatch(providers.names, providers.sure)
        return self._unresolved(name, bool(mention) and _INTERFACES.match(mention) is not None)

    def _unresolved(self, name: str, is_interface: bool = False) -> ProviderMatch:
        """Return the package ``name`` as provider, although neither the workspace nor the target distribution has it.

        The result is empty unless a package of another or a former distribution has the name, or ``is_interface`` is True: the
        name is part of the type of an interface, such as ``a_msgs/msg/B``. Such a package is certain only if the workspace
        declares it.
        """
        resolution = self.names.resolution(name) if name else "unknowable"
        if resolution == "elsewhere":
            return ProviderMatch((name,))
        is_declared = is_interface and self.names.is_declared(name)
        # A submodule that is not cloned may be a library; a name that another package declares is not.
        if (
            resolution == "end-of-life"
            or (resolution == "unknown" and is_interface)
            or (resolution == "unknowable" and is_declared)
        ):
            return ProviderMatch((name,), is_declared)
        return _NO_MATCH


_QUOTATIONS: Mapping[Via, str] = {
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


def resolve(source: PackageSource, resolver: Resolver, own_files: OwnFiles) -> tuple[Use, ...]:
    """Return each place in a package that needs another package, sorted by position.

    ``own_files`` resolves includes and imports of files of the package itself.
    """
    launched = frozenset(strip_folder(source.path, launch.path) for launch in source.launch)
    tests = frozenset(strip_folder(source.path, launch.path) for launch in source.launch if launch.test)
    roles = FileRoles(own_files, launched)
    uses = _Uses(source, own_files, roles, resolver)
    optional_files = own_files.optional_modules(_files_with_optional_imports(source, roles))
    _add_script(source, uses)
    for path, facts in source.facts.items():
        if not facts.mentions or roles.is_template_or_recipe(path):
            continue
        role, certain = roles.role(path)
        role = _TEST if path in tests else role
        mentions = list(facts.mentions)
        if roles.is_optional(path) or (path in optional_files and not roles.is_started(path)):
            mentions = [mention._replace(optional=True) for mention in mentions]
        if path in launched:  # the launch collector yields the packages, except for those of plugins
            mentions = [mention for mention in mentions if mention.via != "package" or mention.purpose == "plugins"]
        uses.add(path, mentions, role, _TEST if role is _TEST else _LOOK_UP_ROLE, certain)
    for launch in source.launch:
        path = strip_folder(source.path, launch.path)
        if roles.is_template_or_recipe(path):
            continue
        role, certain = roles.role(path)
        _launch_uses(launch, _TEST if launch.test else role, uses, certain)
    return uses.sorted()


def _add_script(source: PackageSource, uses: _Uses) -> None:
    """Add the uses of other packages in the build script: names in its commands, and packages that it exports to dependents."""
    by_role: dict[tuple[str, Role], list[Mention]] = {}
    unused_finds = frozenset(source.built.cmake.unused_optional_finds)
    for mention in source.built.mentions:
        if mention.purpose == "plugins":
            continue  # the loader of the plugins is optional, and headers name the package of the base class
        role = _TEST if mention.test else _script_role(source, mention)
        only_named = mention.via == "cmake" and mention.span in unused_finds
        of_role = by_role.setdefault((mention.span.path, role), [])
        of_role.append(mention._replace(optional=True) if only_named else mention)
    for (path, role), mentions in by_role.items():
        uses.add(strip_folder(source.path, path), mentions, role, role, in_use=True)
    for mention, always in source.built.exports.packages:
        uses.add(strip_folder(source.path, mention.span.path), [mention], Role.EXPORT, Role.EXPORT, always)
    _add_implicit_uses(source, uses)


class _Uses:
    """The uses of other packages that are collected in one package.

    If several uses have equal place, package and kind of name, the last one replaces the others.
    """

    def __init__(self, source: PackageSource, own_files: OwnFiles, roles: FileRoles, resolver: Resolver) -> None:
        self.package = source.name
        self.resolver = resolver
        self._own_files = own_files
        self._roles = roles
        names, awaited = resolver.names, resolver.names.awaited
        # A released package need not be cloned, and a declared name is that of a package.
        packages = [name for name in awaited.listed if names.is_package(name) or names.is_declared(name)]
        self._uncloned = awaited.uncloned.difference(packages)
        self._optional_modules = frozenset(
            [name for path in _files_with_optional_imports(source, roles) for name in source.facts[path].optional_modules]
        )
        self._path_additions = frozenset([span for facts in source.facts.values() for span in facts.path_additions])
        script = source.built
        self._includes_outside = script.cmake.includes_outside_package
        self._bundled = frozenset([name.lower() for name in script.cmake.bundled_projects])
        self._found_always = frozenset(
            [mention.name for mention in script.mentions if mention.via == "cmake" and not (mention.optional or mention.test)]
        )
        self._by_place: dict[tuple[Span, str, Via], Use] = {}

    def add_use(self, use: Use) -> None:
        self._by_place[use.span, use.package, use.via] = use

    def sorted(self) -> tuple[Use, ...]:
        return tuple([use for _, use in sorted(self._by_place.items())])

    def add(self, path: str, mentions: Iterable[Mention], role: Role, looked_up: Role, in_use: bool) -> None:
        """Add the uses of other packages that result from ``mentions``, the mentions in a file.

        A mention is a place with a name that may belong to another package. ``role`` is the role of the file, ``looked_up`` the
        role of packages whose files are looked up at run time.
        """
        package, match, uses = self.package, self.resolver.match, self._by_place
        own_headers = self._own_files.included(path)
        for name, via, span, quotation, optional, test, purpose in mentions:
            if (via == "include" and (name in own_headers or self._is_of_bundled_project(name))) or (
                via == "import" and self._is_own_module(name, path)
            ):
                continue
            providers, certain, default_quotation = match(via, name)
            if not providers and via == "package" and in_use and not (optional or test or role is _TEST):
                providers, certain, default_quotation = self.resolver.looked_up(name)
            if not providers or package in providers:
                continue
            if via == "include" and providers[0] in self._own_files.include_folders and name.startswith(f"{providers[0]}/"):
                continue
            needed = _TEST if test else looked_up if via == "package" else role
            if via == "include" and name.startswith(_TEST_PREFIXES) and self._roles.serves_tests(path):
                needed = _TEST
            is_optional = optional
            if via == "import":
                is_optional = is_optional or self._may_be_missing(name, span, providers[0])
                certain = certain and name.partition(".")[0] not in self._uncloned
            elif certain and self._includes_outside and via == "include" and "/" not in name:
                certain = False  # any include directory may contain the header
            elif self._uncloned and certain:
                certain = self._is_available(name, providers[0])
            if not certain and providers[0] in self._found_always and _INTERFACES.match(name):
                certain = True  # certainly in use: the build fails without the package
            name_space: Via = "macro" if purpose == "helper" else via
            uses[span, providers[0], name_space] = _make(
                Use,
                (
                    providers[0],
                    providers,
                    needed,
                    quotation or default_quotation,
                    name_space,
                    is_optional,
                    span,
                    in_use and certain,
                    name,
                    purpose == "conditional",
                    purpose == "unused",
                ),
            )

    def _is_available(self, name: str, provider: str) -> bool:
        """Return whether a header or library ``name`` is certainly available from its ``provider``.

        The result is False if a git submodule that is not cloned may contain the header or library instead.
        """
        if REPOSITORIES.get(name.partition("/")[0]) in self._uncloned:
            return False
        return self.resolver.names.is_package(provider) or self._uncloned.isdisjoint(_WORD.findall(name))

    def _may_be_missing(self, name: str, span: Span, provider: str) -> bool:
        """Return whether an import may fail without harm, so that it requires no declaration.

        Either the package imports the module elsewhere as optional, or the file adds a folder of the module's name to
        ``sys.path`` and no package ``provider`` exists.
        """
        if span in self._path_additions:
            return not self.resolver.names.is_package(provider)
        return bool(self._optional_modules) and any(
            name == module or name.startswith(f"{module}.") for module in self._optional_modules
        )

    def _is_of_bundled_project(self, header: str) -> bool:
        """Return whether a header belongs to a project that the package bundles: ``fmt`` has ``fmt/core.h`` and ``fmt.h``."""
        if not self._bundled:
            return False
        path = header.lower()
        folder = path.partition("/")[0]
        return not self._bundled.isdisjoint((folder, REPOSITORIES.get(folder, folder), path.rpartition(".")[0]))

    def _is_own_module(self, name: str, path: str) -> bool:
        top = name.partition(".")[0]
        return self._own_files.has_module(top, path) or (top in _BUILD_MODULES and path.endswith("setup.py"))


def _files_with_optional_imports(source: PackageSource, roles: FileRoles) -> list[str]:
    """Return the files of the package, except for tests, that contain optional imports (``try`` with ``except ImportError``)."""
    return [path for path, facts in source.facts.items() if facts.optional_modules and roles.role(path)[0] is not _TEST]


def _add_implicit_uses(source: PackageSource, uses: _Uses) -> None:
    """Add the implicit use of action_msgs, because rosidl generates code for actions with types of action_msgs."""
    if source.name == _ACTIONS or not any(interface.startswith("action/") for interface in source.built.products.interfaces):
        return
    for mention in source.built.mentions:
        if mention.via == "macro" and mention.purpose == "interfaces" and uses.resolver.names.is_package(_ACTIONS):
            role = _TEST if mention.test else Role.BUILD | Role.EXPORT | Role.EXEC
            uses.add_use(Use(_ACTIONS, (_ACTIONS,), role, "an action", "macro", mention.optional, mention.span))


_ACTIONS = "action_msgs"


def _script_role(source: PackageSource, mention: Mention) -> Role:
    if source.builds_with == "ament_python" or mention.via == "macro" or mention.purpose == "tool":
        return Role.TOOL
    return Role.EXPORT if mention.purpose == "export" else Role.BUILD


def _launch_uses(launch: LaunchFile, role: Role, uses: _Uses, in_use: bool) -> None:
    for reference in launch.references:
        package = reference.package
        if reference.kind == "program":
            continue
        match = uses.resolver.match("launch", package)
        if package != uses.package and match.providers:
            quotation = package if reference.kind == "package" else f"{reference.kind} {reference.name}"
            uses.add_use(
                Use(
                    package,
                    (package,),
                    role,
                    quotation,
                    "launch",
                    reference.optional,
                    reference.package_span,
                    in_use and match.sure,
                )
            )


def satisfying(uses: Iterable[Use]) -> frozenset[str]:
    """Return all names of packages and rosdep keys, each of which satisfies one of the uses if package.xml declares it."""
    return frozenset([name for match in {use.providers for use in uses} for name in match])


def used_names(declared: Iterable[str], uses: Iterable[Use]) -> frozenset[str]:
    """Return the declared names that a use needs. If several declared names satisfy a use, only the best of them counts."""
    names = frozenset(declared)
    alternatives = {use.providers for use in uses}
    return frozenset([name for match in alternatives for name in [provider for provider in match if provider in names][:1]])
