"""All packages and keys that a workspace can use: its own packages, underlays and released packages.

A name is looked up in the workspace, then in the underlays, then in the index of the distribution. The first layer
with a package hides the others, as sourced overlays do.
"""

from __future__ import annotations

import re
from functools import cached_property
from typing import TYPE_CHECKING, Literal, NamedTuple

from ros_lint.collectors.interfaces.naming import GROUP
from ros_lint.facts.repositories import NOTHING_AWAITED, ExpectedRepositories
from ros_lint.knowledge import providers
from ros_lint.knowledge.closure import Closure, Reach
from ros_lint.knowledge.index import RUNTIME
from ros_lint.knowledge.providers import Layer, Providers, Suggestion
from ros_lint.knowledge.provides import NOTHING_KNOWN
from ros_lint.knowledge.spelling import Spelling

if TYPE_CHECKING:
    from collections.abc import Container, Iterable, Mapping, Sequence

    from ros_lint.knowledge import Knowledge
    from ros_lint.knowledge.index import Released
    from ros_lint.knowledge.provides import Known, Offer
    from ros_lint.knowledge.underlays import Installed, Underlay

_SHARED = re.compile(r"lib(?!.*-dev\b).*[0-9][a-z]?\Z")
"""Names of system packages with shared libraries end with a version; headers are in other packages."""

Resolution = Literal["known", "elsewhere", "end-of-life", "unknown", "unknowable"]
"""Result of the look-up of a declared name.

* "known": a package or a rosdep key.
* "elsewhere": a package of other active distributions only.
* "end-of-life": a package of distributions at their end of life only.
* "unknown": none of these.
* "unknowable": cannot be decided, because the distribution has no index or a submodule is not cloned.
"""


class Member(NamedTuple):
    """A package of the workspace with the facts that look-ups need."""

    name: str
    version: str
    depends: Mapping[str, tuple[str, ...]]
    """Declared names by letter of the tag, without tags whose condition is false.

    b build, t buildtool, e build_export, u buildtool_export, x exec, s test, d doc, G groups
    (:data:`ros_lint.facts.manifest.DEPENDENCY_KINDS`).
    """
    groups: tuple[str, ...] = ()
    """Dependency groups that the package is a member of."""
    modules: tuple[str, ...] | None = None
    """Top-level Python modules that the package provides, None if unknown."""


class World:
    """Look-ups of names in all layers.

    Data files and underlays are read at their first use, which may raise KnowledgeError. Of two members with one
    name the first counts; of two underlays with one package, the first.
    """

    def __init__(
        self,
        members: Iterable[Member],
        underlays: Sequence[Underlay],
        knowledge: Knowledge,
        awaited: ExpectedRepositories = NOTHING_AWAITED,
    ) -> None:
        self.underlays = tuple(underlays)
        """Install prefixes below the workspace, topmost first. Not for plugins."""
        self.knowledge = knowledge
        """Data of released packages. Not for plugins."""
        self.awaited = awaited
        """Repositories of the workspace that may be missing."""
        self._members: dict[str, Member] = {}
        for member in members:
            self._members.setdefault(member.name, member)
        self._installed: dict[str, Installed] = {}
        for underlay in underlays:
            for name, installed in underlay.packages.items():
                self._installed.setdefault(name, installed)
        self._remembered: dict[tuple[str, str], Providers] = {}
        self._interfaces: dict[tuple[str, bool], frozenset[str]] = {}
        self._meant: dict[tuple[str, bool], Suggestion | None] = {}
        self._near: dict[tuple[str, bool], tuple[str, ...]] = {}
        self._is: dict[str, tuple[bool, bool]] = {}
        self._reach = Reach(self._brings)

    # --- packages -------------------------------------------------------------------------------------------------

    def layer(self, name: str) -> Layer | None:
        """Return the layer that provides a package, or None."""
        if name in self._members:
            return "workspace"
        if name in self._installed:
            return "underlay"
        return "index" if name in self.knowledge.index else None

    def is_package(self, name: str) -> bool:
        """Return whether any layer contains a package."""
        return self._look_up(name)[0]

    def is_key(self, name: str) -> bool:
        """Return whether a name is a rosdep key, on whatever platform it resolves."""
        return self._look_up(name)[1]

    def only_runs(self, name: str) -> bool:
        """Return whether a name is a key for shared libraries without the files to build against them."""
        if not name.startswith("lib") or self.is_package(name):
            return False
        key = self.knowledge.rosdep.get(name)
        return key is not None and bool(key.apt) and all(map(_SHARED.match, key.apt))

    def standing(self, name: str) -> Resolution:
        """Return how a declared name resolves."""
        if self.is_package(name) or self.is_key(name):
            return "known"
        if not self.knowledge.covered:
            return "unknowable"
        if self.knowledge.elsewhere(name):
            return "elsewhere"
        if name in self.awaited.uncloned:
            return "unknowable"
        return "end-of-life" if self.knowledge.names.end_of_life(name) else "unknown"

    def successor(self, name: str) -> str:
        """Return the ROS 2 successor of a ROS 1 package, or ""."""
        successor = self.knowledge.names.successor(name)
        return successor if self.is_package(successor) else ""

    def is_declared(self, name: str) -> bool:
        """Return whether a package of the workspace declares a name in any tag."""
        return name in self._declared

    @cached_property
    def _declared(self) -> frozenset[str]:
        return frozenset([name for member in self._members.values() for names in member.depends.values() for name in names])

    def version(self, name: str) -> str | None:
        """Return the version of a package in the layer that provides it, or None."""
        member = self._members.get(name)
        if member is not None:
            return member.version
        released = self.released(name)
        return released.version or None if released else None

    def released(self, name: str) -> Released | None:
        """Return a package of the topmost layer below the workspace, or None."""
        installed = self._installed.get(name)
        return installed.released if installed is not None else self.knowledge.index.get(name)

    def installed(self, name: str) -> Installed | None:
        """Return a package of the underlays, even if the workspace hides it, or None."""
        return self._installed.get(name)

    def depends(self, name: str, kinds: Iterable[str]) -> tuple[str, ...] | None:
        """Return the dependencies of a package, sorted; None if unknown. ``kinds`` are letters as in Released."""
        member = self._members.get(name)
        if member is not None:
            return tuple(sorted({other for kind in kinds for other in member.depends.get(kind, ())}))
        released = self.released(name)
        return released.on(kinds) if released is not None and released.described else None

    def dependents_below(self, name: str) -> tuple[str, ...]:
        """Return the packages of the underlays that need a package at run time or to build against, sorted.

        Packages hidden by the workspace are left out.
        """
        found = []
        for other, installed in self._installed.items():
            released = None if other in self._members else installed.released
            if released is not None and any(name in released.depends.get(kind, ()) for kind in RUNTIME):
                found.append(other)
        return tuple(sorted(found))

    def closure(self, names: Iterable[str]) -> Closure:
        """Return the declared names with all names that they provide transitively.

        The closure follows build_export, buildtool_export and exec dependencies. For packages of the workspace it
        also follows groups, to the members that are in the workspace. A key provides the keys of the system
        packages that its package depends on.
        """
        return self._reach.closure(names)

    def closure_without(self, names: Iterable[str], package: str, gone: Container[str]) -> Closure:
        """Return the closure of ``names`` as if ``package`` did not itself provide the names in ``gone``."""
        return self._reach.closure_without(names, package, gone)

    def path(self, starts: Iterable[str], goal: str) -> tuple[str, ...]:
        """Return a shortest chain from one of ``starts`` to ``goal``, both ends included, or ()."""
        return self._reach.path(starts, goal)

    def group_members(self, group: str) -> tuple[str, ...]:
        """Return the members of a group in all layers, sorted."""
        found = set(self._members_of.get(group, ()))
        found.update(name for name, installed in self._installed.items() if group in installed.groups)
        found.update(self.knowledge.index.members(group))
        return tuple(sorted(found))

    # --- what packages provide ------------------------------------------------------------------------------------

    def executables(self, name: str) -> Known:
        """Return the names in lib/<package>.

        Like the methods below, this knows nothing of packages of the workspace.
        """
        return self._known(name, "executables")

    def lacks(self, name: str, offer: Offer, wanted: str, *, everywhere: bool) -> bool:
        """Return whether a package is known not to provide a name.

        With ``everywhere``, no distribution that contains the package may provide it.
        """
        if self._known(name, offer).ask(wanted) != "missing":
            return False
        return not (everywhere and self.knowledge.offered_elsewhere(name, offer, wanted))

    def launch_files(self, name: str) -> Known:
        """Return the launch files, relative to share/<package>."""
        return self._known(name, "launch")

    def components(self, name: str) -> Known:
        """Return the component classes."""
        return self._known(name, "components")

    def plugins(self, name: str) -> Known:
        """Return the plugins, as base=class."""
        return self._known(name, "plugins")

    def programs(self, name: str) -> Known:
        """Return the names in bin."""
        return self._known(name, "programs")

    def interfaces(self, name: str, *, everywhere: bool) -> frozenset[str]:
        """Return all interfaces that a package may have, as msg/Name; empty if they are not all known.

        With ``everywhere``, or if nothing is known for this distribution, the other distributions that contain the
        package count, too. The newest of them must be known completely, because interfaces of older ones are rarely
        removed.
        """
        key = (name, everywhere)
        if key not in self._interfaces:
            own = self._known(name, "interfaces")
            known = [own]
            if name not in self._members and (everywhere or own == NOTHING_KNOWN):
                known += self.knowledge.known_elsewhere(name, "interfaces")
            whole = known[-1].complete and all(k.complete and k.possible for k in known if k != NOTHING_KNOWN)
            self._interfaces[key] = frozenset([interface for k in known for interface in k.possible]) if whole else frozenset()
        return self._interfaces[key]

    def python_modules(self, name: str) -> Known:
        """Return the top-level Python modules. A package of interfaces has a module of its own name.

        A package that has interfaces only in other distributions may have the module: interfaces of turtlesim, for
        example, have moved to turtlesim_msgs.
        """
        known = self._known(name, "modules")
        released = self.released(name) if self.layer(name) in ("underlay", "index") else None
        if released is None or name in known.names:
            return known
        if released.interfaces:
            return known._replace(names=(*known.names, name))
        if known.complete and any(k.possible for k in self.knowledge.known_elsewhere(name, "interfaces")):
            return known._replace(maybe=(*known.maybe, name))
        return known

    # --- names that are none of packages --------------------------------------------------------------------------

    def exports_targets(self, name: str) -> bool:
        """Return whether a released package is known to export everything for CMake as targets."""
        released = self.released(name)
        return released is not None and (released.interfaces or self.knowledge.names.exports_targets(name))

    def by_cmake(self, name: str) -> Providers:
        """Return the providers of the argument of find_package()."""
        key = ("cmake", name)
        if key not in self._remembered:
            self._remembered[key] = providers.by_cmake(self, name)
        return self._remembered[key]

    def by_macro(self, package: str) -> Providers:
        """Return the providers of a package's macros, with equivalents of a vendor package."""
        key = ("macro", package)
        if key not in self._remembered:
            self._remembered[key] = providers.by_macro(self, package)
        return self._remembered[key]

    def by_include(self, header: str) -> Providers:
        """Return the providers of a header, by its path as written between the brackets.

        Headers of the workspace are matched by package name only, so callers look for their files first.
        """
        key = ("include", header)
        if key not in self._remembered:
            self._remembered[key] = providers.by_include(self, header)
        return self._remembered[key]

    def by_folder(self, folder: str) -> Providers:
        """Return the providers of headers below a folder whose name alone identifies the package."""
        key = ("folder", folder)
        if key not in self._remembered:
            self._remembered[key] = providers.by_folder(self, folder)
        return self._remembered[key]

    def by_import(self, module: str) -> Providers:
        """Return the providers of a Python module, which may be dotted."""
        key = ("import", module)
        if key not in self._remembered:
            self._remembered[key] = providers.by_import(self, module)
        return self._remembered[key]

    def offering(self, module: str) -> tuple[str, ...]:
        """Return the workspace packages with a Python module: by their build script, else by their name."""
        found = self._modules.get(module, ())
        member = self._members.get(module)
        if not found and member is not None and (member.modules is None or GROUP in member.groups):
            return (module,)
        return found

    def where_else(self, name: str) -> tuple[str, ...]:
        """Return the other distributions that contain a package, oldest first."""
        return self.knowledge.elsewhere(name)

    def meant(self, name: str, *, python: bool = False) -> Suggestion | None:
        """Return the name that an unknown name certainly means, or None. The result is safe for a fix.

        ``python`` is True if the name is needed to run Python code.
        """
        key = (name, python)
        if key not in self._meant:
            self._meant[key] = providers.meant(self, name, python=python)
        return self._meant[key]

    def suggest(self, name: str, *, python: bool = False) -> tuple[str, ...]:
        """Return packages and keys similar to an unknown name, nearest first, at most three."""
        key = (name, python)
        if key not in self._near:
            self._near[key] = providers.near(self, name, python=python)
        return self._near[key]

    @cached_property
    def spelling(self) -> Spelling:
        """Index of all names of packages and keys, for similar names."""
        known = (self._members, self._installed, self.knowledge.index.names(), self.knowledge.rosdep.names())
        return Spelling(name for names in known for name in names)

    # --- inside ---------------------------------------------------------------------------------------------------

    def _look_up(self, name: str) -> tuple[bool, bool]:
        found = self._is.get(name)
        if found is None:
            found = self._is[name] = (self.layer(name) is not None, name in self.knowledge.rosdep)
        return found

    def _known(self, name: str, offer: Offer) -> Known:
        if name in self._members:
            return NOTHING_KNOWN
        installed = self._installed.get(name)
        return installed.known(offer) if installed is not None else self.knowledge.provided(name, offer)

    def _brings(self, name: str) -> tuple[str, ...] | None:
        member = self._members.get(name)
        if member is not None:
            names = [other for kind in "eux" for other in member.depends.get(kind, ())]
            names += [other for group in member.depends.get("G", ()) for other in self._members_of.get(group, ())]
            return tuple(names)
        installed = self._installed.get(name)
        if installed is not None:
            return installed.runtime
        if name in self.knowledge.index:
            return self.knowledge.index.runtime(name)
        return self.knowledge.names.brought(name) if self.is_key(name) else None

    @cached_property
    def _members_of(self) -> Mapping[str, tuple[str, ...]]:
        found: dict[str, tuple[str, ...]] = {}
        for member in self._members.values():
            for group in member.groups:
                found[group] = (*found.get(group, ()), member.name)
        return found

    @cached_property
    def _modules(self) -> Mapping[str, tuple[str, ...]]:
        found: dict[str, tuple[str, ...]] = {}
        for member in self._members.values():
            for module in member.modules or ():
                found[module] = (*found.get(module, ()), member.name)
        return found
