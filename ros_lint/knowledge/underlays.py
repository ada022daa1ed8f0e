"""Underlays: the install prefixes that a workspace is built on. They are read without ROS.

The packages of a prefix are listed at once. The contents of a package are read when they are first needed.
"""

from __future__ import annotations

import os
import re
from functools import cached_property
from typing import TYPE_CHECKING

from ros_lint.base.paths import join
from ros_lint.base.text import read as read_text
from ros_lint.base.tree import MachineTree
from ros_lint.collectors.manifest import collect
from ros_lint.knowledge.describe import context, describe
from ros_lint.knowledge.index import RUNTIME, Released
from ros_lint.knowledge.install_prefix import InstallPrefix
from ros_lint.knowledge.provides import NOTHING_KNOWN, Known

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from ros_lint.base.tree import Tree
    from ros_lint.knowledge.provides import ContentKind


_NEEDS_PARSING = re.compile(rb"condition|<!DOCTYPE|<!\[CDATA\[|&|\0")
_IGNORED = re.compile(rb"<!--.*?-->|<\?.*?\?>|<export\b.*?</export\s*>", re.DOTALL)
_TAG = re.compile(rb"<(?:build_export_|buildtool_export_|exec_|run_)?depend\b")
_DEPENDENCY = re.compile(_TAG.pattern + rb"(?:\s[^>]*)?>\s*([\w.+-]+)\s*</")
"""Pattern of a tag for a dependency that also applies to dependents of the package (``RUNTIME``), with the dependency's name."""


class UnderlayError(Exception):
    """The folder is not an install prefix. The message names the folder and suggests a valid one."""


class Installed:
    """A package of an underlay."""

    def __init__(self, name: str, prefix: InstallPrefix, distro: str) -> None:
        self.name = name
        self.prefix = prefix
        self._distro = distro

    @cached_property
    def released(self) -> Released | None:
        """Version and dependencies of the package from ``share/<package>/package.xml``, None if unknown.

        For a package without a manifest, such as a plain CMake project, the dependencies are the run-time dependencies
        that colcon or ament recorded.
        """
        path = f"share/{self.name}/package.xml"
        data = self.prefix.read(path)
        if data is not None:
            manifest = collect.collect(read_text(path, data))
            if manifest.name:
                return describe(manifest, context(self._distro))._replace(name=self.name, repository=self.name)
        recorded = self.prefix.recorded_dependencies(self.name)
        return None if recorded is None else Released(self.name, "", "?", self.name, {"x": recorded})

    @cached_property
    def runtime(self) -> tuple[str, ...] | None:
        """The run-time and exported dependencies of the package, sorted; None if unknown.

        Simple manifests are not fully parsed, because only these names are needed of hundreds of manifests.
        """
        data = self.prefix.read(f"share/{self.name}/package.xml")
        if data is not None and not _NEEDS_PARSING.search(data):
            text = _IGNORED.sub(b"", data)
            names = _DEPENDENCY.findall(text)
            if len(names) == len(_TAG.findall(text)):
                return tuple(sorted({name.decode() for name in names}))
        return None if self.released is None else self.released.on(RUNTIME)

    @cached_property
    def groups(self) -> tuple[str, ...]:
        """Dependency groups that the package is a member of, including ``rosidl_interface_packages``."""
        return self.released.groups if self.released else ()

    def known(self, kind: ContentKind) -> Known:
        """Return the names of one kind, such as executables, that the package provides.

        The list of Python modules is never complete, because the modules of develop installs are outside the prefix.
        Programs (files in bin) are known only if the prefix has a single package.
        """
        prefix = self.prefix
        match kind:
            case "executables":
                names, broken = prefix.executables(self.name)
                return Known(names, broken, complete=True)
            case "launch":
                return Known(prefix.launch_files(self.name), complete=True)
            case "components":
                return Known(prefix.components(self.name), complete=True)
            case "plugins":
                return Known(prefix.plugins(self.name), complete=True)
            case "interfaces":
                return Known(prefix.interfaces(self.name), complete=True)
            case "modules":
                return Known(tuple(name for name, owners in prefix.modules.items() if owners == (self.name,)))
            case "programs":
                return Known(prefix.programs, complete=True) if prefix.single else NOTHING_KNOWN

    @cached_property
    def share_files(self) -> Known:
        """Paths of the files in share/<package>, relative to share/<package>."""
        return Known(self.prefix.share_files(self.name), complete=True)


class Underlay:
    """An install prefix, or the install prefixes of all packages of one workspace. ``packages`` are sorted by name.

    Their files are read from ``tree`` when they are first needed.
    """

    def __init__(self, root: str, prefixes: Sequence[InstallPrefix], tree: Tree, distro: str = "") -> None:
        self.root = root
        self.tree = tree
        self._prefixes = tuple(prefixes)
        packages: dict[str, Installed] = {}
        for prefix in prefixes:
            for name in prefix.packages:
                packages.setdefault(name, Installed(name, prefix, distro))
        self.packages: Mapping[str, Installed] = dict(sorted(packages.items()))

    def headers(self, path: str) -> tuple[str, ...]:
        """Return the packages that install a header, sorted. ``path`` is the path in ``#include <path>``."""
        return tuple(sorted({owner for prefix in self._prefixes for owner in prefix.header_owners(path)}))

    def modules(self, module: str) -> tuple[str, ...]:
        """Return the packages that install a top-level Python module, sorted."""
        return tuple(sorted({owner for prefix in self._prefixes for owner in prefix.modules.get(module, ())}))

    def cmake(self, name: str) -> tuple[str, ...]:
        """Return the packages that install the configuration file of the CMake package ``name``, sorted."""
        return tuple(sorted(self._cmake.get(name, ())))

    @cached_property
    def _cmake(self) -> Mapping[str, set[str]]:
        owners: dict[str, set[str]] = {}
        for prefix in self._prefixes:
            for name, owner in prefix.cmake_names():
                owners.setdefault(name, set()).add(owner)
        return owners


def read(prefixes: Sequence[str], distro: str = "", base: str = "", machine: Tree | None = None) -> tuple[Underlay, ...]:
    """Return the underlays in ``prefixes``, in the given order. If several underlays have a package, the first one counts.

    Each of ``prefixes`` is one of these folders; any other folder raises UnderlayError:

    * an install prefix such as ``/opt/ros/jazzy``,
    * the ``install`` folder of a workspace, in the merged or the isolated layout,
    * the folder of one package in an ``install`` folder, as in AMENT_PREFIX_PATH,
    * a workspace with an ``install`` folder.

    Conditions in manifests are evaluated for the distribution ``distro``. ``base`` is the folder of the analysed
    workspace: its own ``install`` folder is left out, because it was built from the analysed packages. ``machine`` is a
    tree of files by absolute path; by default all files of this machine.
    """
    roots = [os.path.abspath(place) for place in prefixes]
    tree = machine or MachineTree()
    return tuple(in_tree(tree, root, distro) for root in roots if not (base and _belongs_to(tree, root, base)))


def in_tree(tree: Tree, root: str, distro: str = "") -> Underlay:
    """Return the underlay in the folder ``root`` of a tree of files.

    Raises UnderlayError if ``root`` is none of the folders that :func:`read` accepts.
    """
    return Underlay(root, tuple(_prefixes(tree, root)), tree, distro)


def _prefixes(tree: Tree, root: str) -> Iterator[InstallPrefix]:
    """Yield the install prefixes in a folder, see :func:`read`. Raises UnderlayError if there is none."""
    try:
        names = [entry.name for entry in tree.list(root) if entry.kind == "directory"]
    except OSError as error:
        raise UnderlayError(f"underlay {root} cannot be read: {error.strerror}") from error
    prefix = InstallPrefix(tree, root)
    layout = prefix.layout
    if prefix.packages == (os.path.basename(root),):
        yield prefix.marked_single()
        return
    if prefix.packages or layout == "merged":
        yield prefix
        return
    children = [child for child in (InstallPrefix(tree, join(root, name)) for name in names) if child.packages]
    if children and (layout == "isolated" or all(os.path.basename(child.root) in child.packages for child in children)):
        # colcon creates a prefix for each package.
        yield from (child.marked_single() for child in children)
    elif layout != "isolated":
        if "install" in names:
            yield from _prefixes(tree, join(root, "install"))
        elif not prefix.indexed:
            raise UnderlayError(
                f"underlay {root} is not an install prefix: it has no share/<package>/package.xml; "
                "use the folder that contains setup.bash, such as /opt/ros/jazzy or install"
            )
        else:
            yield prefix


def _belongs_to(tree: Tree, root: str, base: str) -> bool:
    prefix, base = tree.identity(root), tree.identity(base)
    if _is_below(prefix, base):
        return True
    for install in (prefix, os.path.dirname(prefix)):
        if _has_file(tree, f"{install}/.colcon_install_layout") and _is_below(base, os.path.dirname(install)):
            return True
    return False


def _has_file(tree: Tree, path: str) -> bool:
    try:
        tree.read(path)
    except OSError:
        return False
    return True


def _is_below(path: str, folder: str) -> bool:
    return path == folder or path.startswith(f"{folder.rstrip('/')}/")
