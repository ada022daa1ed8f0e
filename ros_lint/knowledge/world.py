"""Look up package names and rosdep keys in all layers: the workspace, its underlays, and released packages.

A name is looked up in the workspace, then in the underlays, then in the package index of the distribution. The first
layer with a package overrides the others, as when an overlay is sourced.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Literal, NamedTuple

from ros_lint.base.questions import Cell, Memo, RecordedMapping
from ros_lint.collectors.interfaces.naming import GROUP
from ros_lint.facts.repositories import NOTHING_AWAITED, ExpectedRepositories
from ros_lint.knowledge import providers
from ros_lint.knowledge.closure import Closure, Reach
from ros_lint.knowledge.index import RUNTIME
from ros_lint.knowledge.providers import Layer, Providers, Suggestion
from ros_lint.knowledge.provides import NOTHING_KNOWN
from ros_lint.knowledge.spelling import Spelling, package_name

if TYPE_CHECKING:
    from collections.abc import Container, Iterable, Iterator, Mapping, Sequence

    from ros_lint.base.questions import Questions, Recorder
    from ros_lint.knowledge import Knowledge
    from ros_lint.knowledge.index import Released
    from ros_lint.knowledge.provides import ContentKind, Known
    from ros_lint.knowledge.underlays import Installed, Underlay

_SHARED_LIBRARY = re.compile(r"lib(?!.*-dev\b).*[0-9][a-z]?\Z")
"""Pattern of the names of Debian packages with shared libraries only, e.g. "libyaml-cpp0.8". Headers are in other packages."""

Resolution = Literal["known", "elsewhere", "end-of-life", "unknown", "unknowable"]
"""Result of the look-up of a declared name.

* "known": a package or a rosdep key.
* "elsewhere": a package of other active distributions only.
* "end-of-life": a package of distributions at their end of life only.
* "unknown": none of these.
* "unknowable": this cannot be decided, because the distribution has no package index or a repository is not cloned.
"""


class Member(NamedTuple):
    """A package of the workspace, with its manifest data and Python modules, by which :class:`World` looks up names."""

    name: str
    version: str
    depends: Mapping[str, tuple[str, ...]]
    """Declared names by the letter of the dependency kind, without tags whose condition is false.

    b build, t buildtool, e build_export, u buildtool_export, x exec, s test, d doc, G groups
    (:data:`ros_lint.facts.manifest.DEPENDENCY_KINDS`).
    """
    groups: tuple[str, ...] = ()
    """Dependency groups that the package is a member of."""
    modules: tuple[str, ...] | None = None
    """Top-level Python modules that the package provides, None if unknown."""


class World:
    """Look-ups of names in the workspace, its underlays and the released packages.

    Data files and underlays are read when they are first needed, which may raise KnowledgeError. If several packages of
    the workspace have the same name, or several underlays have the same package, the first one counts.
    With a ``recorder``, the world can be renewed, and answers of the recorder that ask the world record what they read.
    """

    def __init__(
        self,
        members: Iterable[Member],
        underlays: Sequence[Underlay],
        knowledge: Knowledge,
        awaited: ExpectedRepositories = NOTHING_AWAITED,
        recorder: Recorder | None = None,
    ) -> None:
        self.underlays = tuple(underlays)
        """Install prefixes below the workspace, topmost first. Plugins must not use this attribute."""
        self.knowledge = knowledge
        """Data about released packages. Plugins must not use this attribute."""
        self._recorder = recorder
        self._questions: Questions = recorder.scope() if recorder else Memo()
        self._of_awaited = Cell()
        self._awaited = awaited
        self._recorded_members = RecordedMapping[Member](recorder) if recorder else None
        self._members: Mapping[str, Member] = {}
        self._set_members(members)
        self._installed: dict[str, Installed] = {}
        for underlay in underlays:
            for name, installed in underlay.packages.items():
                self._installed.setdefault(name, installed)
        self._reach = Reach(self._provided_directly)
        self._of_reach = Cell()
        self._direct = self._find_direct() if recorder else {}

    def _renew(self, members: Iterable[Member], awaited: ExpectedRepositories) -> None:
        assert self._recorder is not None
        changed = list(self._set_members(members))
        if awaited != self._awaited:
            self._awaited = awaited
            changed.append(self._of_awaited)
        if not changed:
            return
        self._recorder.change(changed)
        direct = self._find_direct()
        if direct != self._direct:
            self._direct = direct
            self._reach = Reach(self._provided_directly, self._reach)
            self._recorder.change([self._of_reach])

    def _find_direct(self) -> Mapping[str, tuple[str, ...] | None]:
        """Return the names that each package of the workspace provides directly."""
        return {name: self._provided_directly(name) for name in self._members}

    def _set_members(self, members: Iterable[Member]) -> Iterator[Cell]:
        by_name: dict[str, Member] = {}
        for member in members:
            by_name.setdefault(member.name, member)
        if self._recorded_members is None:
            self._members = by_name
            return iter(())
        self._members = self._recorded_members
        return iter(list(self._recorded_members.update(by_name)))

    @property
    def awaited(self) -> ExpectedRepositories:
        """Repositories that the workspace lists, for example in a .repos file, but may not contain."""
        if self._recorder is not None:
            self._recorder.note(self._of_awaited)
        return self._awaited

    # --- packages -------------------------------------------------------------------------------------------------

    def layer(self, name: str) -> Layer | None:
        """Return the first layer (workspace, underlay or index) that contains a package, None if there is none."""
        if name in self._members:
            return "workspace"
        if name in self._installed:
            return "underlay"
        return "index" if name in self.knowledge.index else None

    def is_package(self, name: str) -> bool:
        """Return whether the workspace, an underlay or the package index contains a package."""
        return self._look_up(name)[0]

    def is_key(self, name: str) -> bool:
        """Return whether a name is a rosdep key, even if the key resolves only on platforms of other distributions."""
        return self._look_up(name)[1]

    def is_runtime_library(self, name: str) -> bool:
        """Return whether a name is a rosdep key for shared libraries only, without the headers to build against them."""
        if not name.startswith("lib") or self.is_package(name):
            return False
        key = self.knowledge.rosdep.get(name)
        return key is not None and bool(key.apt) and all(map(_SHARED_LIBRARY.match, key.apt))

    def resolution(self, name: str) -> Resolution:
        """Return how a name in a dependency tag of a manifest resolves, e.g. "known" or "end-of-life", see :data:`Resolution`."""
        if self.is_package(name) or self.is_key(name):
            return "known"
        if not self.knowledge.covered:
            return "unknowable"
        if self.knowledge.elsewhere(name):
            return "elsewhere"
        if self._may_be_uncloned(name):
            return "unknowable"
        return "end-of-life" if self.knowledge.names.end_of_life(name) else "unknown"

    def _may_be_uncloned(self, name: str) -> bool:
        """Return whether a package may be in a listed repository that is not cloned.

        This holds if the name of the package equals the name of the repository or begins with it: ``arm_msgs`` may be in
        the repository ``arm`` or ``Arm-Msgs``. If a list of repositories cannot be read, it holds for any package.
        """
        return not self.awaited.complete or name in self.awaited.uncloned or f"{name}_".startswith(self._uncloned)

    @property
    def _uncloned(self) -> tuple[str, ...]:
        """Beginnings of the names of packages that may be in repositories that are not cloned, e.g. "arm_"."""
        return self._questions.ask("uncloned", lambda: tuple([f"{package_name(name)}_" for name in self.awaited.uncloned]))

    def successor(self, name: str) -> str:
        """Return the existing package that replaces a package of ROS 1 or of a former ROS 2 distribution, "" if there is none."""
        successor = self.knowledge.names.successor(name)
        return successor if self.is_package(successor) else ""

    def is_declared(self, name: str) -> bool:
        """Return whether any package of the workspace declares a name, with any tag."""
        return self._questions.ask(("is declared", name), lambda: name in self._declared)

    @property
    def _declared(self) -> frozenset[str]:
        return self._questions.ask("declared", self._find_declared)

    def _find_declared(self) -> frozenset[str]:
        return frozenset([name for member in self._members.values() for names in member.depends.values() for name in names])

    def version(self, name: str) -> str | None:
        """Return the version of a package in the first layer that contains it, None if unknown."""
        member = self._members.get(name)
        if member is not None:
            return member.version
        released = self.released(name)
        return released.version or None if released else None

    def released(self, name: str) -> Released | None:
        """Return the data of a package in the topmost underlay that has it, else in the package index; None if unknown."""
        installed = self._installed.get(name)
        return installed.released if installed is not None else self.knowledge.index.get(name)

    def installed(self, name: str) -> Installed | None:
        """Return the package ``name`` as installed in the topmost underlay that contains it; None if no underlay does.

        A workspace package of the same name does not change the result.
        """
        return self._installed.get(name)

    def depends(self, name: str, kinds: Iterable[str]) -> tuple[str, ...] | None:
        """Return the dependencies of a package, sorted; None if unknown.

        ``kinds`` has the letters of the dependency kinds that count, see :attr:`Member.depends`: "bx" for build and exec.
        """
        member = self._members.get(name)
        if member is not None:
            return tuple(sorted({dependency for kind in kinds for dependency in member.depends.get(kind, ())}))
        released = self.released(name)
        return released.on(kinds) if released is not None and released.described else None

    def dependents_below(self, name: str) -> tuple[str, ...]:
        """Return the packages of the underlays with a run-time or exported dependency on a package, sorted.

        Packages that the workspace overrides are left out.
        """
        dependents = []
        for dependent, installed in self._installed.items():
            released = None if dependent in self._members else installed.released
            if released is not None and any(name in released.depends.get(kind, ()) for kind in RUNTIME):
                dependents.append(dependent)
        return tuple(sorted(dependents))

    def closure(self, names: Iterable[str]) -> Closure:
        """Return the closure of ``names``: these names and all names that they provide directly or indirectly.

        A package provides its build_export, buildtool_export and exec dependencies. A package of the workspace also
        provides the workspace packages in the groups that it depends on. A rosdep key provides the keys of the system
        packages that its own system package depends on.
        """
        starts = tuple(names)
        return self._questions.ask(("closure", starts), lambda: self._noted_reach.closure(starts))

    def closure_without(self, names: Iterable[str], package: str, removed: Container[str]) -> Closure:
        """Return the closure of ``names`` as if ``package`` did not depend directly on the names in ``removed``."""
        return self._noted_reach.closure_without(names, package, removed)

    def path(self, starts: Iterable[str], goal: str) -> tuple[str, ...]:
        """Return a shortest chain of dependencies from one of ``starts`` to ``goal``, with both ends; () if there is none."""
        names = tuple(starts)
        return self._questions.ask(("path", names, goal), lambda: self._noted_reach.path(names, goal))

    def group_members(self, group: str) -> tuple[str, ...]:
        """Return the packages of all layers that are members of a dependency group (REP 149), sorted."""
        names = set(self._members_of.get(group, ()))
        names.update(name for name, installed in self._installed.items() if group in installed.groups)
        names.update(self.knowledge.index.members(group))
        return tuple(sorted(names))

    # --- what packages provide ------------------------------------------------------------------------------------

    def executables(self, name: str) -> Known:
        """Return the executables of a package as file names in lib/<package>.

        For a package of the workspace, the result is an empty and incomplete list (``NOTHING_KNOWN``).
        """
        return self._known(name, "executables")

    def lacks(self, name: str, kind: ContentKind, wanted: str, *, everywhere: bool) -> bool:
        """Return whether a package certainly does not provide ``wanted``, a name of a kind such as "executables".

        If ``everywhere`` is True, ``wanted`` must be missing in every distribution that contains the package.
        """
        if self._known(name, kind).ask(wanted) != "missing":
            return False
        return not (everywhere and self.knowledge.may_exist_elsewhere(name, kind, wanted))

    def launch_files(self, name: str) -> Known:
        """Return the launch files of a package, relative to share/<package>.

        For a package of the workspace, the result is an empty and incomplete list (``NOTHING_KNOWN``).
        """
        return self._known(name, "launch")

    def components(self, name: str) -> Known:
        """Return the component classes of a package.

        For a package of the workspace, the result is an empty and incomplete list (``NOTHING_KNOWN``).
        """
        return self._known(name, "components")

    def plugins(self, name: str) -> Known:
        """Return the plugins of a package as base=class.

        For a package of the workspace, the result is an empty and incomplete list (``NOTHING_KNOWN``).
        """
        return self._known(name, "plugins")

    def programs(self, name: str) -> Known:
        """Return the programs of a package as file names in bin.

        For a package of the workspace, the result is an empty and incomplete list (``NOTHING_KNOWN``).
        """
        return self._known(name, "programs")

    def interfaces(self, name: str, *, everywhere: bool) -> frozenset[str]:
        """Return all interfaces that a package may have, as msg/Name; empty if the list may be incomplete.

        The interfaces of the package in other distributions are included if ``everywhere`` is True, or if nothing is known
        for the distribution to check for. Data may be missing for some distributions, but not for the newest one, because
        interfaces are rarely removed.
        """
        return self._questions.ask(("interfaces", name, everywhere), lambda: self._find_interfaces(name, everywhere=everywhere))

    def _find_interfaces(self, name: str, *, everywhere: bool) -> frozenset[str]:
        target_contents = self._known(name, "interfaces")
        all_contents = [target_contents]
        if name not in self._members and (everywhere or target_contents == NOTHING_KNOWN):
            all_contents += self.knowledge.known_elsewhere(name, "interfaces")
        lists = [contents for contents in all_contents if contents != NOTHING_KNOWN]
        complete = all_contents[-1].complete and all(contents.complete and contents.possible for contents in lists)
        names = [interface for contents in lists for interface in contents.possible]
        return frozenset(names if complete else ())

    def python_modules(self, name: str) -> Known:
        """Return the top-level Python modules of a package.

        A package with messages, services or actions has a module of its own name. A package with interfaces only in other
        distributions may have such a module: interfaces of turtlesim, for example, have moved to turtlesim_msgs.
        """
        modules = self._known(name, "modules")
        released = self.released(name) if self.layer(name) in ("underlay", "index") else None
        if released is None or name in modules.names:
            return modules
        if released.interfaces:
            return modules._replace(names=(*modules.names, name))
        if modules.complete and any(contents.possible for contents in self.knowledge.known_elsewhere(name, "interfaces")):
            return modules._replace(maybe=(*modules.maybe, name))
        return modules

    # --- names of headers, modules and CMake packages --------------------------------------------------------------------------

    def exports_targets(self, name: str) -> bool:
        """Return whether a released package is known to export all its libraries as CMake targets."""
        released = self.released(name)
        return released is not None and (released.interfaces or self.knowledge.names.exports_targets(name))

    def by_cmake(self, name: str) -> Providers:
        """Return the packages and keys that provide ``name``, the argument of find_package()."""
        return self._questions.ask(("cmake", name), lambda: providers.by_cmake(self, name))

    def by_macro(self, package: str) -> Providers:
        """Return the packages and rosdep keys that provide the CMake macros of ``package``.

        Besides ``package``, these are its alternatives: a vendor package, for example, and the rosdep key of the library.
        """
        return self._questions.ask(("macro", package), lambda: providers.by_macro(self, package))

    def by_include(self, header: str) -> Providers:
        """Return the packages and keys that provide a header. ``header`` is the path in ``#include <header>``.

        A header of the workspace is recognized only if its first folder is named like the package. Therefore callers
        search the files of the workspace first.
        """
        return self._questions.ask(("include", header), lambda: providers.by_include(self, header))

    def by_include_folder(self, folder: str) -> Providers:
        """Return the package that provides the headers below an include folder, judging by the name of the folder."""
        return self._questions.ask(("folder", folder), lambda: providers.by_include_folder(self, folder))

    def by_import(self, module: str) -> Providers:
        """Return the packages and keys that provide a Python module. ``module`` may be dotted."""
        return self._questions.ask(("import", module), lambda: providers.by_import(self, module))

    def packages_with_module(self, module: str) -> tuple[str, ...]:
        """Return the workspace packages whose build script installs a top-level Python module.

        If there is none, return the package with the name of the module, provided that its modules are unknown or it
        generates interfaces.
        """
        packages = self._modules.get(module, ())
        member = self._members.get(module)
        if not packages and member is not None and (member.modules is None or GROUP in member.groups):
            return (module,)
        return packages

    def where_else(self, name: str) -> tuple[str, ...]:
        """Return the distributions that contain a package, oldest first, without the distribution to check for."""
        return self.knowledge.elsewhere(name)

    def meant(self, name: str, *, python: bool = False) -> Suggestion | None:
        """Return the existing name that an unknown name certainly means, None if there is any doubt. A fix may use the result.

        ``python`` is True if the name is needed to run Python code.
        """
        return self._questions.ask(("meant", name, python), lambda: providers.meant(self, name, python=python))

    def suggest(self, name: str, *, python: bool = False) -> tuple[str, ...]:
        """Return at most three packages and rosdep keys that resemble an unknown name, the most similar first.

        ``python`` is True if the name is needed to run Python code.
        """
        return self._questions.ask(("near", name, python), lambda: providers.near(self, name, python=python))

    @property
    def spelling(self) -> Spelling:
        """All names of packages and rosdep keys, for look-ups of similar names."""
        return self._questions.ask("spelling", self._find_spelling)

    def _find_spelling(self) -> Spelling:
        name_sources = (self._members, self._installed, self.knowledge.index.names(), self.knowledge.rosdep.names())
        return Spelling(name for names in name_sources for name in names)

    # --- inside ---------------------------------------------------------------------------------------------------

    def _look_up(self, name: str) -> tuple[bool, bool]:
        return self._questions.ask(("look up", name), lambda: (self.layer(name) is not None, name in self.knowledge.rosdep))

    @property
    def _noted_reach(self) -> Reach:
        if self._recorder is not None:
            self._recorder.note(self._of_reach)
        return self._reach

    def _known(self, name: str, kind: ContentKind) -> Known:
        if name in self._members:
            return NOTHING_KNOWN
        installed = self._installed.get(name)
        return installed.known(kind) if installed is not None else self.knowledge.provided(name, kind)

    def _provided_directly(self, name: str) -> tuple[str, ...] | None:
        member = self._members.get(name)
        if member is not None:
            names = [provided for kind in "eux" for provided in member.depends.get(kind, ())]
            names += [provided for group in member.depends.get("G", ()) for provided in self._members_of.get(group, ())]
            return tuple(names)
        installed = self._installed.get(name)
        if installed is not None:
            return installed.runtime
        if name in self.knowledge.index:
            return self.knowledge.index.runtime(name)
        return self.knowledge.names.provided_keys(name) if self.is_key(name) else None

    @property
    def _members_of(self) -> Mapping[str, tuple[str, ...]]:
        return self._questions.ask("members_of", self._find_members_of)

    def _find_members_of(self) -> Mapping[str, tuple[str, ...]]:
        members: dict[str, tuple[str, ...]] = {}
        for member in self._members.values():
            for group in member.groups:
                members[group] = (*members.get(group, ()), member.name)
        return members

    @property
    def _modules(self) -> Mapping[str, tuple[str, ...]]:
        return self._questions.ask("modules", self._find_modules)

    def _find_modules(self) -> Mapping[str, tuple[str, ...]]:
        packages_of: dict[str, tuple[str, ...]] = {}
        for member in self._members.values():
            for module in member.modules or ():
                packages_of[module] = (*packages_of.get(module, ()), member.name)
        return packages_of


def renew(world: World, members: Iterable[Member], awaited: ExpectedRepositories) -> None:
    """Replace the packages of the workspace and the awaited repositories of a world with a recorder."""
    world._renew(members, awaited)


class WorldInputs(NamedTuple):
    """The inputs of the answers of a world with a recorder."""

    members: RecordedMapping[Member]
    """The packages of the workspace by name."""
    others: Mapping[str, tuple[Cell, object]]
    """All other inputs by name, each with its value."""


def inputs_of(world: World) -> WorldInputs:
    """Return the inputs of the answers of a world with a recorder."""
    assert world._recorded_members is not None
    others: dict[str, tuple[Cell, object]] = {
        "awaited": (world._of_awaited, world._awaited),
        "reach": (world._of_reach, world._direct),
    }
    return WorldInputs(world._recorded_members, others)
