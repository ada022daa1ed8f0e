"""Read an install prefix: a folder such as /opt/ros/jazzy, with the folders that ament, colcon and setuptools create.

A missing or unreadable file raises no error, because an incomplete prefix is still useful.
"""

from __future__ import annotations

import os
import re
from functools import cached_property
from typing import TYPE_CHECKING

from ros_lint.base.paths import join
from ros_lint.collectors.launch import detect

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from ros_lint.base.tree import Kind, Tree

_INDEX = "share/ament_index/resource_index"
_PLUGINS = "__pluginlib__plugin"
_LIBRARIES = (".a", ".la", ".pyc")
_LIBRARY = re.compile(r"\.so(\.\d+)*$|\.dylib$|\.dll$")
_LAUNCH_CONTENT = {
    ".py": re.compile(rb"^(?:async )?def generate_launch_description\b", re.MULTILINE),
    ".xml": re.compile(rb"\A(?:\xef\xbb\xbf)?(?:\s|<\?[^?]*(?:\?(?!>)[^?]*)*\?>|<!--[^-]*(?:-(?!->)[^-]*)*-->)*<launch[\s/>]"),
    ".yaml": re.compile(rb"\A(?:#.*\n|---.*\n|\s)*launch:"),
}
_LAUNCH_CONTENT[".yml"] = _LAUNCH_CONTENT[".yaml"]
_CONFIGURATION = re.compile(r"(.+)(?:Config|-config)\.cmake")
"""Pattern of the file with which find_package() finds a CMake package in config mode, e.g. "rclcppConfig.cmake"."""
_OTHER_SUFFIXES = (".egg-info", ".dist-info", ".pth", ".egg-link")


class InstallPrefix:
    """An install prefix at the path ``root`` of a tree. ``single`` is True if all its files belong to one package."""

    def __init__(self, tree: Tree, root: str, *, single: bool = False) -> None:
        self._tree = tree
        self.root = root
        self.single = single

    def marked_single(self) -> InstallPrefix:
        """Return this prefix, with ``single`` True if it contains exactly one package."""
        return InstallPrefix(self._tree, self.root, single=len(self.packages) == 1)

    def read(self, path: str) -> bytes | None:
        """Return the bytes of the file at a path relative to the prefix, None if it cannot be read."""
        try:
            return self._tree.read(join(self.root, path))
        except OSError:
            return None

    @property
    def layout(self) -> str:
        """Layout of the prefix as recorded by colcon: "isolated" or "merged"; "" if colcon recorded none."""
        return (self.read(".colcon_install_layout") or b"").decode("ascii", "replace").strip()

    @property
    def indexed(self) -> bool:
        """True if the prefix has an ament index, even an empty one."""
        return self._exists("share/ament_index")

    @cached_property
    def packages(self) -> tuple[str, ...]:
        """Names of the packages with a manifest or with an entry in the index of ament or colcon, sorted."""
        names = {name for name, _ in self._list("share") if self._exists(f"share/{name}/package.xml")}
        names.update(name for name, _ in self._list(f"{_INDEX}/packages"))
        names.update(name for name, _ in self._list("share/colcon-core/packages"))
        return tuple(sorted(names))

    def recorded_dependencies(self, package: str) -> tuple[str, ...] | None:
        """Return the run-time dependencies of a package as recorded by ament or colcon in the build, sorted; None without record.

        The record of ament includes test dependencies.
        """
        by_ament = f"{_INDEX}/package_run_dependencies/{package}"
        by_colcon = f"share/colcon-core/packages/{package}"
        for path, separator in ((by_ament, ";"), (by_colcon, ":")):
            data = self.read(path)
            if data is not None:
                return tuple(sorted(filter(None, data.decode("utf-8", "replace").strip().split(separator))))
        return None

    def executables(self, package: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """Return the names of the executables in lib/<package>, and the names of broken links in this folder, each sorted.

        Subfolders are left out, because launch_ros does not search them.
        """
        executables, broken = [], []
        for name, kind in self._list(f"lib/{package}"):
            if name.endswith(_LIBRARIES) or _LIBRARY.search(name) or kind == "directory":
                continue
            if kind == "other":
                broken.append(name)
            elif self._is_executable(f"lib/{package}/{name}"):
                executables.append(name)
        return tuple(executables), tuple(broken)

    @property
    def programs(self) -> tuple[str, ...]:
        """Names of the files in bin, sorted."""
        return tuple(name for name, kind in self._list("bin") if kind == "file")

    def share_files(self, package: str) -> tuple[str, ...]:
        """Return the paths of the files in share/<package>, relative to share/<package>, sorted."""
        return tuple(sorted(self._walk(f"share/{package}", "")))

    def launch_files(self, package: str) -> tuple[str, ...]:
        """Return the paths of the launch files in share/<package>, relative to share/<package>, sorted.

        A launch file is recognized by a name that ``ros2 launch`` completes, or by its contents.
        """
        return tuple(path for path in self.share_files(package) if self._is_launch(package, path))

    def components(self, package: str) -> tuple[str, ...]:
        """Return the classes of a package that can be loaded into a component container, sorted."""
        lines = self._resource("rclcpp_components", package)
        return tuple(sorted({line.partition(";")[0].strip() for line in lines} - {""}))

    def interfaces(self, package: str) -> tuple[str, ...]:
        """Return the interfaces of a package as msg/Name, srv/Name or action/Name, sorted."""
        names = set()
        for line in self._resource("rosidl_interfaces", package):
            name, _, suffix = line.strip().rpartition(".")
            # srv/Name_Request.msg is generated from srv/Name.srv.
            if suffix in (name.partition("/")[0], "idl"):
                names.add(name)
        return tuple(sorted(names))

    def plugins(self, package: str) -> tuple[str, ...]:
        """Return the pluginlib plugins of a package as base=class, sorted. ``class`` is the look-up name of the plugin."""
        plugins: set[str] = set()
        for resource, _ in self._list(_INDEX):
            if resource.endswith(_PLUGINS):
                for path in self._resource(resource, package):
                    base = resource.removesuffix(_PLUGINS)
                    plugins.update(f"{base}={name}" for name in self._plugin_classes(path.strip()))
        return tuple(sorted(plugins))

    @cached_property
    def modules(self) -> Mapping[str, tuple[str, ...]]:
        """The packages of each installed top-level Python module, by the name of the module; () if the package is unknown."""
        owners: dict[str, tuple[str, ...]] = {}
        for folder in self._python_folders():
            entries = self._list(folder)
            owner_of = self._egg_owners(folder, [name for name, _ in entries])
            for name, kind in entries:
                module = name.partition(".")[0]
                if not module.isidentifier() or module == "__pycache__" or name.endswith(_OTHER_SUFFIXES):
                    continue
                if kind == "file" and not name.endswith((".py", ".so")):
                    continue
                if self.single:
                    owners[module] = self.packages
                elif module in self.packages:
                    owners[module] = (module,)
                else:
                    owners[module] = owner_of.get(module, ())
        return owners

    def header_owners(self, path: str) -> tuple[str, ...]:
        """Return the packages that install the header ``path`` in include/ or include/<package>/."""
        first = path.partition("/")[0]
        if self.single:
            (package,) = self.packages
            return (package,) if any(self._exists(f"include/{folder}{path}") for folder in ("", f"{package}/")) else ()
        # Most packages are named like the folder of their headers; other headers are searched for in all folders.
        if first in self.packages and any(self._exists(f"include/{folder}{path}") for folder in (f"{first}/", "")):
            return (first,)
        return tuple(name for name in self._include_folders.get(first, ()) if self._exists(f"include/{name}/{path}"))

    def cmake_names(self) -> Iterator[tuple[str, str]]:
        """Yield pairs of the name of an installed CMake package and the ROS package that installs it."""
        for package in self.packages:
            places = [f"share/{package}/cmake"]
            if self.single:
                places += [f"{folder}/{name}" for folder in ("lib/cmake", "share/cmake") for name, _ in self._list(folder)]
            matches = [_CONFIGURATION.fullmatch(name) for place in places for name, _ in self._list(place)]
            yield from ((match[1], package) for match in matches if match is not None)

    @cached_property
    def _include_folders(self) -> Mapping[str, tuple[str, ...]]:
        """For each name of a folder in include/<package>/, the packages that have such a folder."""
        owners: dict[str, tuple[str, ...]] = {}
        for package, kind in self._list("include"):
            if kind == "directory" and package in self.packages:
                for name, _ in self._list(f"include/{package}"):
                    owners[name] = (*owners.get(name, ()), package)
        return owners

    def _egg_owners(self, folder: str, names: list[str]) -> Mapping[str, tuple[str, ...]]:
        by_name = {name.lower().replace("-", "_"): name for name in self.packages}
        owners = {}
        for name in names:
            if name.endswith((".egg-info", ".dist-info")):
                owner = by_name.get(name.partition("-")[0].removesuffix(".egg-info").lower().replace("-", "_"))
                listed = self.read(f"{folder}/{name}/top_level.txt")
                if owner and listed:
                    owners.update(dict.fromkeys(listed.decode("utf-8", "replace").split(), (owner,)))
        return owners

    def _python_folders(self) -> list[str]:
        folders = []
        for lib in ("lib", "local/lib"):
            for name, kind in self._list(lib):
                if kind == "directory" and name.startswith("python3"):
                    folders += [f"{lib}/{name}/{site}" for site in ("site-packages", "dist-packages")]
        return folders

    def _plugin_classes(self, path: str) -> Iterator[str]:
        from ros_lint.collectors.resources.plugin_descriptions import roots  # noqa: PLC0415  (few runs look at plugins)

        text = (self.read(path) or b"").decode("utf-8", "replace")
        for element in (inner for root in roots(text) for inner in root.walk()):
            if element.tag == "class":
                name = element.attributes.get("name") or element.attributes.get("type")
                if name:
                    yield name

    def _is_launch(self, package: str, path: str) -> bool:
        if path.endswith(detect.LAUNCH_FILE_NAMES):
            return True
        content = _LAUNCH_CONTENT.get(os.path.splitext(path)[1])
        if content is None or path == "package.xml":
            return False
        return bool(content.search(self.read(f"share/{package}/{path}") or b""))

    def _resource(self, kind: str, package: str) -> list[str]:
        data = self.read(f"{_INDEX}/{kind}/{package}")
        return data.decode("utf-8", "replace").splitlines() if data else []

    def _walk(self, folder: str, inside: str, above: frozenset[object] = frozenset()) -> Iterator[str]:
        identity = self._tree.identity(join(self.root, folder))
        if identity in above:
            return  # a link to a parent folder
        for name, kind in self._list(folder):
            if kind == "directory":
                yield from self._walk(f"{folder}/{name}", f"{inside}{name}/", above | {identity})
            else:
                yield f"{inside}{name}"

    def _list(self, path: str) -> list[tuple[str, Kind]]:
        """Return pairs of the name and kind of each entry of a folder, sorted; [] if the folder is missing."""
        try:
            return [(name, kind) for name, kind, _ in self._tree.list(join(self.root, path))]
        except OSError:
            return []

    def _exists(self, path: str) -> bool:
        try:
            self._tree.stamp(join(self.root, path))
        except OSError:
            return False
        return True

    def _is_executable(self, path: str) -> bool:
        try:
            return self._tree.stamp(join(self.root, path)).executable
        except OSError:
            return False
