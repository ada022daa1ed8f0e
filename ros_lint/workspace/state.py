"""What a loader holds of a workspace for one distribution: during one load, or from each load to the next."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.base.paths import parent
from ros_lint.base.questions import Cell, Memo, Questions, Recorder
from ros_lint.base.tree import Tree
from ros_lint.knowledge.providers import importable_modules
from ros_lint.knowledge.world import Member, World, renew
from ros_lint.workspace.handles import Handles
from ros_lint.workspace.join import Join, ReadPackage
from ros_lint.workspace.reading import Reading, declared_by, kinds
from ros_lint.workspace.target import TargetDistro

if TYPE_CHECKING:
    from ros_lint.facts.manifest import Manifest
    from ros_lint.facts.repositories import ExpectedRepositories
    from ros_lint.knowledge import Knowledge
    from ros_lint.knowledge.underlays import Underlay
    from ros_lint.workspace.discovery.discover import DiscoveredPackage
    from ros_lint.workspace.model import Declared


class DistroData(NamedTuple):
    """A distribution to check for, with the data about its packages."""

    target: TargetDistro
    knowledge: Knowledge
    underlays: tuple[Underlay, ...] = ()


class State:
    """The packages of a workspace for one distribution, as read and joined. With a ``recorder`` it is for several loads."""

    def __init__(self, tree: Tree, data: DistroData, recorder: Recorder | None = None) -> None:
        self.data = data
        self.touched: set[str] = set()
        """Paths of files that may have changed since the packages were read."""
        self.questions: Questions = recorder.scope() if recorder else Memo()
        self.reading = Reading(tree, data.target, recorder)
        self.handles = Handles(recorder) if recorder else None
        self._packages: Sequence[DiscoveredPackage] = ()
        self._of_packages = Cell()
        self._tree = tree
        self._recorder = recorder
        self._hidden: Mapping[str, frozenset[str]] = {}
        self._views: dict[str | None, tuple[World, Join]] = {}
        self._members: dict[str, tuple[ReadPackage, Member]] = {}

    @property
    def found(self) -> Sequence[DiscoveredPackage]:
        """The found packages."""
        if self._recorder:
            self._recorder.note(self._of_packages)
        return self._packages

    def take(self, packages: Sequence[DiscoveredPackage]) -> None:
        """Take the found packages. An equal sequence must be the same object."""
        if packages is not self._packages:
            self._packages = packages
            if self._recorder:
                self._recorder.change([self._of_packages])

    def touched_packages(self) -> frozenset[str]:
        """Return the folders of the packages that contain touched files, and forget these files."""
        folders = {package.path for package in self._packages} if self.touched else set()
        result = set()
        for path in self.touched:
            folder = parent(path)
            while folder and folder not in folders:
                folder = parent(folder)
            result.add(folder)
        self.touched = set()
        return frozenset(result)

    def begin(self, hidden: Mapping[str, frozenset[str]]) -> None:
        """Begin to join. ``hidden`` is the result of ``hidden_namesakes``. If it has changed, all packages are joined again."""
        if hidden != self._hidden:
            self._hidden = hidden
            self._views = {}
            self.handles = Handles(self._recorder) if self._recorder else None

    def view(
        self,
        folder: str | None,
        visible: Sequence[ReadPackage],
        rejected: Sequence[Manifest],
        awaited: ExpectedRepositories,
    ) -> tuple[World, Join]:
        """Return the look-ups and the join of the ``visible`` packages.

        They are the packages that are visible in the workspace at ``folder``; None means in the repository.
        """
        members = tuple(self._all_members(visible, rejected))
        known = self._views.get(folder)
        if known is None:
            world = World(members, self.data.underlays, self.data.knowledge, awaited, self._recorder)
            known = self._views[folder] = world, Join(self._tree, world, self._recorder)
        else:
            renew(known[0], members, awaited)
        known[1].renew(visible)
        return known

    def _all_members(self, read_packages: Sequence[ReadPackage], rejected: Sequence[Manifest]) -> Iterator[Member]:
        for read_package in read_packages:
            path = read_package.discovered.path
            known = self._members.get(path)
            if known is None or known[0] is not read_package:
                known = self._members[path] = read_package, _member_of(read_package)
            yield known[1]
        for manifest in rejected:
            if manifest.name:
                yield _member(manifest.name, manifest, declared_by(manifest, self.data.target))


def _member_of(read_package: ReadPackage) -> Member:
    package, script = read_package.discovered, read_package.script
    modules = importable_modules(script, package.files) if script else None
    return _member(package.name, package.manifest, read_package.declared)._replace(modules=modules)


def _member(name: str, manifest: Manifest | None, declared: Sequence[Declared]) -> Member:
    groups = tuple(d.name for d in declared if d.depend.tag == "member_of_group")
    return Member(name, manifest.version if manifest else "", kinds(declared), groups)
