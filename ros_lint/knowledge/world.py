"""The world that a workspace lives in: its own packages, underlays, and what is known of the released distributions.

Names are answered from the top: workspace, then underlay, then the index of the distribution; the first that has a
package hides the others, as it does when everything is installed (reference, section B4.3).
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
"""Names of system packages with shared libraries: they end with a version. Headers are in others."""

Resolution = Literal["known", "elsewhere", "end-of-life", "unknown", "unknowable"]
"""What a declared name is: a package or key; a package of other distributions only; one of distributions at their end of
life only; nothing that anybody knows; or nobody can tell, because there is no index of the distribution."""


class Member(NamedTuple):
    """A package of the workspace, as far as the world needs to know it."""

    name: str
    version: str
    depends: Mapping[str, tuple[str, ...]]
    """Declared names by letter, conditions that are false left out: b build, t buildtool, e build_export, u
    buildtool_export, x exec, s test, d doc, G groups (:data:`ros_lint.facts.manifest.DEPENDENCY_KINDS`)."""
    groups: tuple[str, ...] = ()
    """That it is a member of."""
    modules: tuple[str, ...] | None = None
    """Top-level Python modules that it offers, None where they are not known."""


class World:
    """Answers questions about names. Reads data files and underlays when first asked; may then raise KnowledgeError.

    Of two members with one name the first counts; of two underlays that have a package, the first.
    """

    def __init__(
        self,
        members: Iterable[Member],
        underlays: Sequence[Underlay],
        knowledge: Knowledge,
        awaited: ExpectedRepositories = NOTHING_AWAITED,
    ) -> None:
        self.underlays = tuple(underlays)
        self.knowledge = knowledge
        self.awaited = awaited
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
        """Return where a package is taken from, or None when no layer has it."""
        if name in self._members:
            return "workspace"
        if name in self._installed:
            return "underlay"
        return "index" if name in self.knowledge.index else None

    def is_package(self, name: str) -> bool:
        """Return whether any layer has a package."""
        return self._look_up(name)[0]

    def is_key(self, name: str) -> bool:
        """Return whether a name is a rosdep key, whatever platform it resolves on."""
        return self._look_up(name)[1]

    def only_runs(self, name: str) -> bool:
        """Return whether a name is a key for shared libraries without what is needed to build against them."""
        if not name.startswith("lib") or self.is_package(name):
            return False
        key = self.knowledge.rosdep.get(name)
        return key is not None and bool(key.apt) and all(map(_SHARED.match, key.apt))

    def standing(self, name: str) -> Resolution:
        """Return what a declared name is."""
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
        """Return what does here what a package did in ROS 1, or ""."""
        successor = self.knowledge.names.successor(name)
        return successor if self.is_package(successor) else ""

    def is_declared(self, name: str) -> bool:
        """Return whether a package of the workspace declares a name, in whatever tag."""
        return name in self._declared

    @cached_property
    def _declared(self) -> frozenset[str]:
        return frozenset([name for one in self._members.values() for names in one.depends.values() for name in names])

    def version(self, name: str) -> str | None:
        """Return the version of a package where it is taken from, or None."""
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
        """Return a package of the underlays, also when the workspace hides it, or None."""
        return self._installed.get(name)

    def depends(self, name: str, kinds: Iterable[str]) -> tuple[str, ...] | None:
        """Return what a package depends on, sorted: None when nobody knows. ``kinds`` are letters, see Member."""
        member = self._members.get(name)
        if member is not None:
            return tuple(sorted({other for kind in kinds for other in member.depends.get(kind, ())}))
        released = self.released(name)
        return released.on(kinds) if released is not None and released.described else None

    def dependents_below(self, name: str) -> tuple[str, ...]:
        """Return the packages of the underlays that need a package at run time or to build against, sorted.

        Those that the workspace hides are left out.
        """
        found = []
        for other, installed in self._installed.items():
            released = None if other in self._members else installed.released
            if released is not None and any(name in released.depends.get(kind, ()) for kind in RUNTIME):
                found.append(other)
        return tuple(sorted(found))

    def closure(self, names: Iterable[str]) -> Closure:
        """Return everything that comes along with declared names, these included (reference, section E3.3).

        Followed are build_export, buildtool_export and exec dependencies, and from packages of the workspace those
        members of groups that are in the workspace, too. A key brings the keys that its system package depends on.
        """
        return self._reach.closure(names)

    def closure_without(self, names: Iterable[str], package: str, gone: Container[str]) -> Closure:
        """Return the closure of names as it would be if a package did not bring some of the others itself."""
        return self._reach.closure_without(names, package, gone)

    def path(self, starts: Iterable[str], goal: str) -> tuple[str, ...]:
        """Return a shortest chain by which a name comes along with one of others, both ends included, or ()."""
        return self._reach.path(starts, goal)

    def group_members(self, group: str) -> tuple[str, ...]:
        """Return the members of a group in every layer, sorted."""
        found = set(self._members_of.get(group, ()))
        found.update(name for name, installed in self._installed.items() if group in installed.groups)
        found.update(self.knowledge.index.members(group))
        return tuple(sorted(found))

    # --- what packages provide ------------------------------------------------------------------------------------

    def executables(self, name: str) -> Known:
        """Return the names in lib/<package>.

        For packages of the workspace nothing is known here, as in all of these.
        """
        return self._known(name, "executables")

    def lacks(self, name: str, offer: Offer, wanted: str, *, everywhere: bool) -> bool:
        """Return whether a package is known not to offer something, with ``everywhere`` in no distribution that has it."""
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
        """Return all that a package may have of interfaces, as msg/Name, with ``everywhere`` in any distribution that has it.

        So it is, too, where nothing is known of the distribution itself. Of one that nothing is known of, the newest one and
        those before tell: what was added to it is still there. Empty where nobody knows them all.
        """
        key = (name, everywhere)
        if key not in self._interfaces:
            own = self._known(name, "interfaces")
            known = [own]
            if name not in self._members and (everywhere or own == NOTHING_KNOWN):
                known += self.knowledge.known_elsewhere(name, "interfaces")
            whole = known[-1].complete and all(one.complete and one.possible for one in known if one != NOTHING_KNOWN)
            self._interfaces[key] = frozenset([each for one in known for each in one.possible]) if whole else frozenset()
        return self._interfaces[key]

    def python_modules(self, name: str) -> Known:
        """Return the top-level Python modules. Interface packages have one of their own name.

        One that is so only in other distributions may have it: people import from turtlesim what turtlesim_msgs has now.
        """
        known = self._known(name, "modules")
        released = self.released(name) if self.layer(name) in ("underlay", "index") else None
        if released is None or name in known.names:
            return known
        if released.interfaces:
            return known._replace(names=(*known.names, name))
        if known.complete and any(one.possible for one in self.knowledge.known_elsewhere(name, "interfaces")):
            return known._replace(maybe=(*known.maybe, name))
        return known

    # --- names that are none of packages --------------------------------------------------------------------------

    def exports_targets(self, name: str) -> bool:
        """Return whether a package that is released is known to export all that it offers to CMake as targets."""
        released = self.released(name)
        return released is not None and (released.interfaces or self.knowledge.names.exports_targets(name))

    def by_cmake(self, name: str) -> Providers:
        """Return who provides the argument of find_package (reference, sections C2a and C2b)."""
        key = ("cmake", name)
        if key not in self._remembered:
            self._remembered[key] = providers.by_cmake(self, name)
        return self._remembered[key]

    def by_macro(self, package: str) -> Providers:
        """Return who provides the macros of a package: what a vendor package stands for has them, too."""
        key = ("macro", package)
        if key not in self._remembered:
            self._remembered[key] = providers.by_macro(self, package)
        return self._remembered[key]

    def by_include(self, header: str) -> Providers:
        """Return who provides a header, by its path as written between the brackets (reference, section E3.8).

        Headers of the workspace are known by their packages' names only: who has the files looks there first.
        """
        key = ("include", header)
        if key not in self._remembered:
            self._remembered[key] = providers.by_include(self, header)
        return self._remembered[key]

    def by_folder(self, folder: str) -> Providers:
        """Return who provides the headers below a folder that tells its package by its name alone."""
        key = ("folder", folder)
        if key not in self._remembered:
            self._remembered[key] = providers.by_folder(self, folder)
        return self._remembered[key]

    def by_import(self, module: str) -> Providers:
        """Return who provides a Python module, which may be dotted (reference, section D6)."""
        key = ("import", module)
        if key not in self._remembered:
            self._remembered[key] = providers.by_import(self, module)
        return self._remembered[key]

    def offering(self, module: str) -> tuple[str, ...]:
        """Return the packages of the workspace that offer a Python module: by their word, else by their name."""
        found = self._modules.get(module, ())
        member = self._members.get(module)
        if not found and member is not None and (member.modules is None or GROUP in member.groups):
            return (module,)
        return found

    def where_else(self, name: str) -> tuple[str, ...]:
        """Return the other distributions that have a package, oldest first."""
        return self.knowledge.elsewhere(name)

    def meant(self, name: str, *, python: bool = False) -> Suggestion | None:
        """Return what an unknown name must mean, or None when there is any doubt: good enough for a fix.

        ``python`` says whether it is needed to run Python code.
        """
        key = (name, python)
        if key not in self._meant:
            self._meant[key] = providers.meant(self, name, python=python)
        return self._meant[key]

    def suggest(self, name: str, *, python: bool = False) -> tuple[str, ...]:
        """Return packages and keys that resemble an unknown name, nearest first, at most three."""
        key = (name, python)
        if key not in self._near:
            self._near[key] = providers.near(self, name, python=python)
        return self._near[key]

    @cached_property
    def spelling(self) -> Spelling:
        """Return every name of a package or key, to find near ones."""
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
