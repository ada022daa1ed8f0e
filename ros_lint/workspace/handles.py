"""Packages and workspaces whose reads are recorded, for sessions that check a workspace again after changes.

A handle stands for the package at a path, or for the workspace, from one load to the next. Rules hold handles in remembered
answers, so a handle must not be replaced: :meth:`Handles.renew` gives it the newly loaded value, and notes the parts that differ.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from ros_lint.base.questions import Cell, RecordedMapping, Recorder, same
from ros_lint.workspace.model import Package, Workspace, packages_by_name


class PackageHandle(Package):
    """The package at a path. Each field that an answer reads is recorded as an input of the answer."""

    def __new__(cls, package: Package, recorder: Recorder) -> PackageHandle:
        handle = super().__new__(cls, *package)
        handle.recorder = recorder
        handle.now = handle.loaded = package
        handle.cells = [Cell() for _ in Package._fields]
        return handle

    recorder: Recorder
    now: Package
    """The package as last loaded."""
    loaded: Package
    """An equal package, the object that was loaded."""
    cells: list[Cell]
    """The input for each field of the package."""

    def renew(self, package: Package) -> Iterator[Cell]:
        """Replace the package, and yield the cells of the fields that differ. Equal values are not replaced."""
        if package is self.loaded:
            return
        self.loaded = package
        values: list[object] = list(self.now)
        for index, value in enumerate(package):
            if not same(values[index], value):
                values[index] = value
                yield self.cells[index]
        self.now = Package._make(values)

    def __iter__(self) -> Iterator[Any]:
        for cell in self.cells:
            self.recorder.note(cell)
        return iter(self.now)

    def __repr__(self) -> str:
        """Return a text that is the same in each run. The fields of the package are inputs of their own."""
        return f"PackageHandle({self.now.path!r})"

    def __eq__(self, other: object) -> bool:
        return self is other

    def __hash__(self) -> int:
        return id(self)


def _field(index: int) -> property:
    def read(handle: PackageHandle) -> object:
        reads = handle.recorder.reads
        if reads is not None:
            reads[handle.cells[index]] = None
        return handle.now[index]

    return property(read)


for _index, _name in enumerate(Package._fields):
    setattr(PackageHandle, _name, _field(_index))


_READ = ("packages", "unusable", "not_checked", "source_lists", "named_distros", "_ignores", "_untracked", "_views")
"""The attributes of a workspace that differ between loads. The target is constant, and the world records what is read."""


class WorkspaceHandle(Workspace):
    """A workspace. Each attribute that an answer reads is recorded as an input of the answer."""

    def __init__(self, plain: Workspace, recorder: Recorder) -> None:
        self._recorder = recorder
        self.cells = {name: Cell() for name in _READ}
        self.now: dict[str, object] = {}
        self.recorded_names = RecordedMapping[tuple[Package, ...]](recorder)
        self.world = plain.world
        self.target = plain.target
        self.memo = recorder.scope()
        self._by_name = self.recorded_names

    def renew(self, values: dict[str, object], packages: tuple[PackageHandle, ...]) -> Iterator[Cell]:
        """Replace the attributes, and yield the cells of those that differ."""
        yield from list(self.recorded_names.update(packages_by_name(packages)))
        for name, value in values.items():
            if name not in self.now or not same(self.now[name], value):
                self.now[name] = value
                yield self.cells[name]


def _attribute(name: str) -> property:
    def read(handle: WorkspaceHandle) -> object:
        handle._recorder.note(handle.cells[name])
        return handle.now[name]

    return property(read)


for _name in _READ:
    setattr(WorkspaceHandle, _name, _attribute(_name))


class Handles:
    """The handles of the workspace for one distribution, and of its packages, from one load to the next."""

    def __init__(self, recorder: Recorder) -> None:
        self._recorder = recorder
        self.packages: dict[tuple[bool, str], PackageHandle] = {}
        """The handles by path. The first part of the key is True for a package, and False for an unusable package.xml."""
        self._workspaces: dict[str | None, WorkspaceHandle] = {}

    def renew(self, plain: Workspace) -> WorkspaceHandle:
        """Return the handle of the workspace, with the newly loaded values."""
        changed: list[Cell] = []
        groups = ((True, plain.packages), (False, plain.unusable))
        # The handle of a package that is gone is kept, because remembered answers may still hold it when the package is back.
        for usable, packages in groups:
            for package in packages:
                handle = self.packages.get((usable, package.path))
                if handle is None:
                    self.packages[usable, package.path] = PackageHandle(package, self._recorder)
                else:
                    changed += handle.renew(package)
        views = {folder: self._renewed(folder, view, {}, changed) for folder, view in plain._views.items()}
        result = self._renewed(None, plain, views, changed)
        self._recorder.change(changed)
        return result

    @property
    def workspace(self) -> WorkspaceHandle:
        """The handle of the whole workspace."""
        return self._workspaces[None]

    def _renewed(
        self, folder: str | None, plain: Workspace, views: Mapping[str, Workspace], changed: list[Cell]
    ) -> WorkspaceHandle:
        handle = self._workspaces.get(folder)
        if handle is None:
            handle = self._workspaces[folder] = WorkspaceHandle(plain, self._recorder)
        values: dict[str, object] = {name: getattr(plain, name) for name in _READ}
        packages = tuple([self.packages[True, package.path] for package in plain.packages])
        values["packages"] = packages
        values["unusable"] = tuple([self.packages[False, package.path] for package in plain.unusable])
        values["_views"] = views
        changed += handle.renew(values, packages)
        return handle
