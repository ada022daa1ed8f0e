"""Find the packages of a workspace and their files in one walk over the folders.

The packages are those of ``colcon list``: folders are visited as by colcon-recursive-crawl, and identified by
:mod:`ros_lint.workspace.discovery.identify`. Unlike colcon, the walk also skips build products without a COLCON_IGNORE file.
"""

from __future__ import annotations

import sys
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.base.paths import is_below, join, parent, resolve
from ros_lint.base.questions import Memo
from ros_lint.base.text import file_start, read
from ros_lint.collectors.manifest import collect as manifests
from ros_lint.facts.environment import ROS_2
from ros_lint.facts.manifest import ColconMeta
from ros_lint.workspace.discovery.identify import (
    SIGNS,
    Folder,
    Identity,
    Ignored,
    MetaSettings,
    build_product,
    identify,
    ignored_by_ros,
    ignored_everywhere,
)
from ros_lint.workspace.discovery.repository_lists import ENDINGS
from ros_lint.workspace.target import UnreadFile

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ros_lint.base.questions import Questions
    from ros_lint.base.tree import Entry, Kind, Tree
    from ros_lint.facts.manifest import ColconDepend, ColconSettings, Manifest

SKIPPED_FOLDERS = frozenset((".git", ".hg", ".svn", "node_modules", "__pycache__"))
"""Folders that never contain sources."""

_RELEVANT_NAMES = frozenset((*SIGNS, "package.xml", "manifest.xml", "CMakeLists.txt", "setup.py", "colcon.pkg"))
"""A folder with none of these names is neither a package nor ignored by colcon."""

_BOUNDARY_NAMES = frozenset((*SIGNS, "package.xml"))
"""A subfolder of a package with none of these names is a part of the package."""

_BUILD_SCRIPTS = frozenset(("CMakeLists.txt", "setup.py", "setup.cfg", "pyproject.toml", "Cargo.toml", "build.gradle"))
"""A subfolder with none of these files is not a package of its own, even if it contains a package.xml."""

_CONTEXT = {**ROS_2, "DISABLE_GROUPS_WORKAROUND": "1"}


class Skipped(NamedTuple):
    """A folder that was not visited, with the reason."""

    path: str
    reason: str
    link: bool = False
    """True for a symbolic link that is not followed, because its target is visited elsewhere or is outside the workspace."""


class DiscoveredPackage(NamedTuple):
    """A package of the workspace, before any of its files except package.xml is read."""

    path: str
    """Folder of the package, relative to the base folder of the run; "" is the base folder."""
    name: str
    """Name in ``package.xml``, by which other manifests, rosdep and the ament index refer to the package.

    Without a name in package.xml it is the name that colcon uses.
    """
    colcon_name: str
    """Name printed by ``colcon list``.

    It differs from ``name`` if ``colcon.pkg``, ``colcon.meta``, or the build script of a package without package.xml sets
    another.
    """
    type: str
    """Type as printed by ``colcon list``: ros.ament_cmake, ros.ament_python, cmake, python ..."""
    manifest: Manifest | None
    """The parsed package.xml with the errors in it, even if colcon cannot use it; None if there is none."""
    colcon_depends: tuple[ColconDepend, ...]
    files: tuple[str, ...]
    """Files below the folder of the package, sorted and relative to it, without nested packages and skipped folders."""
    nested: tuple[Manifest, ...]
    """The package.xml files of packages in subfolders, sorted by path.

    Left out are folders with an ignore marker (e.g. AMENT_IGNORE), folders without a build script, and folders that the
    CMakeLists.txt of the outer package adds with add_subdirectory().
    """
    unvisited: tuple[Skipped, ...]
    """Folders, relative to the package, that were not visited. Their files are unknown."""


class Discovery(NamedTuple):
    """The result of a walk over the folders of a workspace. Each tuple is sorted by path."""

    packages: tuple[DiscoveredPackage, ...]
    rejected: tuple[Manifest, ...]
    """The package.xml files that colcon cannot use. Folders that colcon identifies as a package by another file are left out."""
    skipped: tuple[Skipped, ...]
    not_checked: tuple[UnreadFile, ...]
    repository_lists: tuple[str, ...] = ()
    """Files outside of packages that list repositories: ``*.repos``, ``*.rosinstall``, ``.gitmodules``."""
    complete: bool = True
    """False if the walk ended early because there are too many folders."""


class _Visit(NamedTuple):
    """The result of a visit to one folder."""

    entries: Sequence[Entry] = ()
    """The entries whose subfolders are visited."""
    package: DiscoveredPackage | None = None
    rejected: Manifest | None = None
    skipped: Skipped | None = None
    not_checked: tuple[UnreadFile, ...] = ()


def discover(
    tree: Tree,
    roots: Sequence[str],
    context: Mapping[str, str] = _CONTEXT,
    most: int = sys.maxsize,
    questions: Questions | None = None,
) -> Discovery:
    """Return the packages below ``roots`` as ``colcon list --base-paths ROOTS`` finds them in the base folder of the tree.

    ``roots`` are relative to the base folder; "" is the base folder itself. A ``colcon.meta`` is read in the base folder and in
    each root. ``context`` has the values of variables in conditions of package.xml, which may choose a build type.
    At most ``most`` folders outside packages are visited. ``questions`` keeps the answers about single folders; it must always be
    used with equal values of ``context``.
    Folders and files that cannot be read are added to ``not_checked``; no contents of the tree cause an exception.
    """
    return _Walk(tree, context, most, questions or Memo()).run(roots)


class _Walk:
    def __init__(self, tree: Tree, context: Mapping[str, str], most: int, questions: Questions) -> None:
        self._tree = tree
        self._context = context
        self._most = most
        self._questions = questions
        self._base = tree.identity("")
        self._places: tuple[str, ...] = ()

    def run(self, roots: Sequence[str]) -> Discovery:
        self._places = tuple(dict.fromkeys(("", *roots)))
        _, not_checked = self._meta_settings()
        visited: set[str] = set()
        visits: list[_Visit] = []
        links: list[Skipped] = []
        lists: list[str] = []
        for root in roots:
            self._crawl(root, visited, visits, links, lists)
        rejected = [visit.rejected for visit in visits if visit.rejected]
        not_checked = (*not_checked, *(item for visit in visits for item in visit.not_checked))
        return Discovery(
            tuple(sorted([visit.package for visit in visits if visit.package], key=lambda package: package.path)),
            tuple(sorted(rejected, key=lambda manifest: manifest.path)),
            tuple(sorted([*links, *(visit.skipped for visit in visits if visit.skipped)])),
            tuple(sorted(not_checked, key=lambda item: (item.span or file_start(""), item.what))),
            tuple(sorted(lists)),
            len(visited) <= self._most,
        )

    def _crawl(self, root: str, visited: set[str], visits: list[_Visit], links: list[Skipped], lists: list[str]) -> None:
        todo = [(root, self._tree.identity(root))]
        while todo and len(visited) <= self._most:
            path, identity = todo.pop()
            if identity in visited:
                continue  # already visited on another path; as in colcon, the first path in name order counts
            visited.add(identity)
            visit = self._questions.ask(("visit", path, identity, self._places), partial(self._visit, path, identity))
            visits.append(visit)
            for name, kind, link in reversed(visit.entries):
                if kind == "file" and name.endswith(ENDINGS):
                    lists.append(join(path, name))
                elif kind == "directory" and not name.startswith(".") and name not in SKIPPED_FOLDERS:
                    child = join(path, name)
                    target = self._tree.identity(child) if link else join(identity, name)
                    if link and target != self._base and is_below(self._base, target):
                        # colcon would crawl everything around the workspace, up to the whole disk.
                        links.append(Skipped(child, "a link to a folder that contains the workspace", link=True))
                    else:
                        todo.append((child, target))

    def _visit(self, path: str, identity: str) -> _Visit:
        """Identify a folder as colcon does. The subfolders of packages and of ignored folders are not visited."""
        try:
            entries = self._tree.list(path)
        except OSError as error:
            return _Visit(not_checked=(UnreadFile.of(path, error),))
        names = {name: kind for name, kind, _ in entries}
        settings, _ = self._meta_settings()
        if _RELEVANT_NAMES.isdisjoint(names) and identity not in settings.by_identity:
            return _Visit(entries)
        folder = Folder(self._tree, path, identity, names)
        text = folder.text("package.xml")
        manifest = manifests.collect(text) if text else None
        verdict = identify(folder, manifest, settings, self._context)
        not_checked = tuple(folder.not_checked)
        if isinstance(verdict, Ignored):
            return _Visit(skipped=Skipped(path, verdict.reason), not_checked=not_checked)
        if not isinstance(verdict, Identity):
            return _Visit(entries, rejected=manifest, not_checked=not_checked)
        files = _PackageFiles(self._tree, path, (self._base, identity))
        files.gather(entries, identity)
        package = DiscoveredPackage(
            path,
            manifest.name if manifest and manifest.name else verdict.name,
            verdict.name,
            verdict.type,
            manifest,
            verdict.depends,
            tuple(sorted(files.files)),
            tuple(sorted(files.nested, key=lambda nested: nested.path)),
            tuple(sorted(files.unvisited)),
        )
        return _Visit(package=package, not_checked=(*not_checked, *files.not_checked))

    def _meta_settings(self) -> tuple[MetaSettings, tuple[UnreadFile, ...]]:
        return self._questions.ask(("colcon.meta", self._places), self._read_meta)

    def _read_meta(self) -> tuple[MetaSettings, tuple[UnreadFile, ...]]:
        by_name: dict[str, ColconSettings] = {}
        by_identity: dict[str, ColconSettings] = {}
        not_checked: list[UnreadFile] = []
        for place in self._places:
            meta = self._meta(place)
            if isinstance(meta, UnreadFile):
                not_checked.append(meta)
            if not isinstance(meta, ColconMeta):
                continue
            by_name.update(meta.by_name)
            folder = parent(meta.path)
            for path, values in meta.by_path:
                by_identity[self._tree.identity(resolve(folder, path))] = values
        return MetaSettings(by_name, by_identity), tuple(not_checked)

    def _meta(self, place: str) -> ColconMeta | UnreadFile | None:
        path = join(place, "colcon.meta")
        try:
            kinds = {name: kind for name, kind, _ in self._tree.list(place)}
        except OSError:
            return None  # recorded by the crawl
        if kinds.get("colcon.meta") == "directory":
            path = join(path, "colcon.meta")
        elif kinds.get("colcon.meta") != "file":
            return None
        from ros_lint.collectors.colcon import metadata as colcon_yaml  # noqa: PLC0415  (few workspaces have the file)

        try:
            return colcon_yaml.meta(read(path, self._tree.read(path)))
        except FileNotFoundError:
            return None  # colcon.meta is a folder that contains no colcon.meta
        except OSError as error:
            return UnreadFile.of(path, error)
        except colcon_yaml.ColconYamlError as error:
            return UnreadFile(path, str(error), error.span)


class _PackageFiles:
    """Collects the files of one package, the packages nested in it, and the folders that are not visited."""

    def __init__(self, tree: Tree, package: str, roots: tuple[str, ...]) -> None:
        self._tree = tree
        self._package = package
        self._roots = roots
        self._linked: set[str] = set()
        self._marked: list[str] = []
        self.files: list[str] = []
        self.nested: list[Manifest] = []
        self.unvisited: list[Skipped] = []
        self.not_checked: list[UnreadFile] = []

    def gather(self, entries: Sequence[Entry], identity: str) -> None:
        """Collect the files below the package folder, which has these ``entries`` and the real path ``identity``.

        A link to a folder is followed if its target is below the package folder or the base folder of the tree. If several
        links have the same target, the target is visited once.
        """
        todo: list[tuple[str, Sequence[Entry], str, tuple[str, ...]]] = [("", entries, identity, ())]
        while todo:
            folder, entries, identity, link_folders = todo.pop()
            prefix = f"{folder}/" if folder else ""
            for name, kind, link in entries:
                if kind == "file":
                    self.files.append(prefix + name)
                if kind != "directory" or name in SKIPPED_FOLDERS:
                    continue
                child, child_link_folders = prefix + name, (*link_folders, identity) if link else link_folders
                child_identity = self._tree.identity(join(self._package, child)) if link else f"{identity}/{name}"
                if link and (reason := self._not_followed(child_identity, child_link_folders)):
                    self.unvisited.append(Skipped(child, reason, link=True))
                elif child_entries := self._enter(child):
                    todo.append((child, child_entries, child_identity, child_link_folders))

    def _enter(self, child: str) -> list[Entry] | None:
        path = join(self._package, child)
        try:
            entries = self._tree.list(path)
        except OSError as error:
            self.not_checked.append(UnreadFile.of(path, error))
            self.unvisited.append(Skipped(child, "it cannot be read"))
            return None
        if _BOUNDARY_NAMES.isdisjoint([entry[0] for entry in entries]):
            return entries
        names = {name: kind for name, kind, _ in entries}
        reason = ignored_everywhere(names) or build_product(names)
        if not reason and (mark := ignored_by_ros(names)):
            # The marker concerns package discovery and linters; the build of this package ignores it.
            reason = mark if "package.xml" in names else ""
            self._marked.append(child)
        if not reason and self._is_nested(child, names):
            reason = "a package of its own"
            if not any(is_below(child, marked) for marked in self._marked):
                self._add_nested(join(path, "package.xml"))
        if not reason:
            return entries
        self.unvisited.append(Skipped(child, reason))
        return None

    def _is_nested(self, child: str, names: Mapping[str, Kind]) -> bool:
        """Return whether a subfolder is a package of its own, rather than a part of the build of the outer package."""
        if names.get("package.xml") != "file" or _BUILD_SCRIPTS.isdisjoint(names):
            return False
        from ros_lint.collectors.colcon import cmake_lists as colcon_cmake  # noqa: PLC0415  (few packages have another one inside)

        parts = child.split("/")
        for depth in range(len(parts)):
            path = join(self._package, "/".join((*parts[:depth], "CMakeLists.txt")))
            try:
                subdirectories = colcon_cmake.subdirectories(read(path, self._tree.read(path)))
            except OSError:
                continue  # usually the folder has no CMakeLists.txt
            if "/".join(parts[depth:]) in subdirectories:
                return False
        return True

    def _add_nested(self, path: str) -> None:
        try:
            self.nested.append(manifests.collect(read(path, self._tree.read(path))))
        except OSError as error:
            self.not_checked.append(UnreadFile.of(path, error))

    def _not_followed(self, target: str, link_folders: tuple[str, ...]) -> str:
        """Return why a link to a folder is not followed, "" if it is followed.

        ``link_folders`` are the real paths of folders with links: the folder that contains this link, and the folders of the
        links that were followed to get there.
        """
        if any(is_below(folder, target) for folder in link_folders):
            return "a link to a folder that contains it"
        if not any(is_below(target, folder) for folder in self._roots):
            return "a link that leads out of the workspace"
        if len(link_folders) > 1 and target in self._linked:
            return "a link to a folder that another link already leads to"
        self._linked.add(target)
        return ""
