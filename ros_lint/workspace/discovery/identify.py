"""Identify a folder as colcon does: as a package with name and type, as a folder to skip, or as neither.

Source: the identification extensions of colcon-core, colcon-metadata, colcon-ros, colcon-cmake and
colcon-python-setup-py, in the order of their priorities.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ros_lint.base.paths import join
from ros_lint.base.text import Span, Text, file_start, read
from ros_lint.collectors.manifest import conditions
from ros_lint.facts.manifest import ColconSettings
from ros_lint.workspace.target import UnreadFile

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping

    from ros_lint.base.tree import Kind, Tree
    from ros_lint.collectors.colcon.python_project import PythonProject
    from ros_lint.facts.manifest import ColconDepend, Manifest


class Identity(NamedTuple):
    """Name, type and dependencies that colcon determines for a package."""

    name: str
    type: str
    depends: tuple[ColconDepend, ...]


class Ignored(NamedTuple):
    """A folder that colcon skips with its subfolders, and the reason."""

    reason: str


class MetaSettings(NamedTuple):
    """Settings in ``colcon.meta`` files, by the name of a package and by the real path of its folder."""

    by_name: Mapping[str, ColconSettings]
    by_identity: Mapping[str, ColconSettings]

    def of(self, name: str) -> ColconSettings:
        return self.by_name.get(name, NO_SETTINGS)


NO_SETTINGS = ColconSettings("", "", ())
Verdict = Identity | Ignored | None

_IGNORED_EVERYWHERE = ("COLCON_IGNORE", "_order_isolated_packages.py", "_setup_util.py")
_IGNORED_BY_ROS = ("CATKIN_IGNORE", "AMENT_IGNORE")
_PREFIX_SCRIPTS = ("bash", "sh", "zsh", "ps1")
_HOOKS = ("local_setup.dsv", "package.dsv")
"""Files that ament and colcon install next to the package.xml of a package."""
SIGNS = frozenset(
    (
        *_IGNORED_EVERYWHERE,
        *_IGNORED_BY_ROS,
        ".colcon_install_layout",
        ".built_by",
        "colcon_build.rc",
        "CMakeCache.txt",
        "pyvenv.cfg",
        "CACHEDIR.TAG",
        *(f"local_setup.{shell}" for shell in _PREFIX_SCRIPTS),
    )
)
"""A folder with none of these names is neither ignored nor a build product."""


def ignored_everywhere(names: Mapping[str, Kind]) -> str:
    """Return the file name that makes colcon skip a folder even if it is a package, e.g. "COLCON_IGNORE"; "" if there is none.

    ``names`` are the entries of the folder.
    """
    if "COLCON_IGNORE" in names:  # even a dangling link
        return "COLCON_IGNORE"
    return next((name for name in _IGNORED_EVERYWHERE if _exists(names, name)), "")


def ignored_by_ros(names: Mapping[str, Kind]) -> str:
    """Return the file name (CATKIN_IGNORE or AMENT_IGNORE) that makes colcon-ros skip a folder; "" if there is none.

    ``names`` are the entries of the folder.
    """
    return next((name for name in _IGNORED_BY_ROS if _exists(names, name)), "")


def build_product(names: Collection[str]) -> str:
    """Return why a folder is a build product, "" for a source folder. ``names`` are the entries of the folder.

    colcon marks its build products with COLCON_IGNORE. Copies and build products of other tools have no such marker.
    """
    if ".colcon_install_layout" in names:
        return "an install folder: it has .colcon_install_layout"
    if ".built_by" in names or "colcon_build.rc" in names:
        return "a build folder of colcon"
    if "pyvenv.cfg" in names:
        return "a Python virtual environment: it has pyvenv.cfg"
    if "CACHEDIR.TAG" in names:
        return "a cache folder: it has CACHEDIR.TAG"
    if "package.xml" in names:
        hooks = [name for name in _HOOKS if name in names]
        return (
            f"an installed package: it has {hooks[0]}" if hooks and not {"CMakeLists.txt", "setup.py"}.intersection(names) else ""
        )
    if "CMakeCache.txt" in names and "CMakeLists.txt" not in names:
        return "a build folder of CMake: it has CMakeCache.txt"
    if any(f"local_setup.{shell}" in names and f"setup.{shell}" in names for shell in _PREFIX_SCRIPTS):
        return "an install folder: it has setup.* and local_setup.*"
    return ""


def _exists(names: Mapping[str, Kind], name: str) -> bool:
    return names.get(name, "other") != "other"


class Folder:
    """A directory that may be a package. Files that cannot be read are added to ``not_checked``."""

    def __init__(self, tree: Tree, path: str, identity: str, names: Mapping[str, Kind]) -> None:
        self.tree = tree
        self.path = path
        self.identity = identity
        self.names = names
        self.not_checked: list[UnreadFile] = []
        self._texts: dict[str, Text | None] = {}

    def text(self, name: str) -> Text | None:
        """Return the text of a file in the folder, None if it is missing or unreadable."""
        if name not in self._texts:
            self._texts[name] = self.read(join(self.path, name)) if self.names.get(name) == "file" else None
        return self._texts[name]

    def read(self, path: str) -> Text | None:
        """Return the text of a file, None if it cannot be read."""
        try:
            return read(path, self.tree.read(path))
        except OSError as error:
            self.record_unread(path, error.strerror or str(error))
            return None

    def record_unread(self, path: str, reason: str, span: Span | None = None) -> None:
        """Record a file that could not be read."""
        self.not_checked.append(UnreadFile(path, reason, span or file_start(path)))


def build_type(manifest: Manifest, context: Mapping[str, str]) -> str:
    """Return the build type that colcon gives a package, or "" if colcon cannot use its package.xml.

    colcon cannot use a package.xml with an error, a condition with a syntax error, or two build types whose conditions
    are true. If no condition is certainly true, the first build type counts; without any, the build type is catkin.
    """
    if manifest.problems or conditions.problems(manifest):
        return ""
    types = conditions.build_types(manifest, context)
    certain = [name for name, active in types if active]
    if len(certain) > 1:
        return ""
    return (certain or [name for name, _ in types] or ["catkin"])[0]


def identify(folder: Folder, manifest: Manifest | None, settings: MetaSettings, context: Mapping[str, str]) -> Verdict:
    """Return how colcon identifies a folder: as a package, as a folder to skip, or None if it is neither.

    ``context`` has the values of variables in conditions of package.xml.
    """
    if reason := ignored_everywhere(folder.names) or build_product(folder.names):
        return Ignored(reason)
    colcon_pkg = _colcon_pkg(folder)
    by_path = settings.by_identity.get(folder.identity, NO_SETTINGS)
    name = colcon_pkg.name or by_path.name
    kind = colcon_pkg.type or by_path.type or settings.of(name).type
    verdict: Verdict = None
    if name and kind:
        verdict = Identity(name, kind, ())
    elif kind in ("", "ros"):
        verdict = _as_ros(folder, name, manifest, context)
    if verdict is None and kind in ("", "cmake", "python"):
        verdict = _by_script(folder, name, kind)
    if not isinstance(verdict, Identity):
        return verdict
    depends = (*colcon_pkg.depends, *settings.of(verdict.name).depends, *by_path.depends, *verdict.depends)
    if verdict.type == "python" and (project := _setup_cfg(folder) or _setup_py(folder)):
        depends += project.depends
    return verdict._replace(depends=depends)


def _colcon_pkg(folder: Folder) -> ColconSettings:
    text = folder.text("colcon.pkg")
    if text is None:
        return NO_SETTINGS
    from ros_lint.collectors.colcon import metadata as colcon_yaml  # noqa: PLC0415  (few packages have the file)

    try:
        return colcon_yaml.package(text)
    except colcon_yaml.ColconYamlError as error:
        folder.record_unread(text.path, str(error), error.span)
        return NO_SETTINGS


def _as_ros(folder: Folder, name: str, manifest: Manifest | None, context: Mapping[str, str]) -> Verdict:
    if reason := ignored_by_ros(folder.names):
        return Ignored(reason)
    if manifest and (kind := build_type(manifest, context)):
        return Identity(name or manifest.name, f"ros.{kind}", ())
    if manifest and not manifest.problems and conditions.problems(manifest):
        return None  # colcon fails before it looks at CMakeLists.txt or setup.py
    # A rosbuild package must not be identified as a plain CMake package.
    return Ignored("manifest.xml") if _exists(folder.names, "manifest.xml") else None


def _by_script(folder: Folder, name: str, kind: str) -> Verdict:
    cmake = _as_cmake(folder, name) if kind != "python" else None
    if kind == "cmake":
        return cmake
    project = _setup_cfg(folder)
    if cmake and project and name in ("", project.name):
        return Ignored("both CMake and Python could build it, so colcon skips it")
    if cmake:
        return cmake
    project = project or _setup_py(folder)
    if project and project.unknown:
        reason = f"colcon may find a package here, but {project.unknown}"
        folder.record_unread(join(folder.path, "setup.py"), reason)
    if project is None or not project.name or name not in ("", project.name):
        return None
    return Identity(project.name, "python", ())


def _as_cmake(folder: Folder, name: str) -> Identity | None:
    text = folder.text("CMakeLists.txt")
    if text is None:
        return None
    from ros_lint.collectors.colcon import cmake_lists as colcon_cmake  # noqa: PLC0415  (needed only where there is no usable manifest)

    project = colcon_cmake.project(text)
    own_name = project.name or folder.path.rpartition("/")[2]
    if project.toplevel or not (own_name or name):
        return None
    depends = [depend for file in _cmake_files(folder) for depend in colcon_cmake.depends(file)]
    return Identity(name or own_name, "cmake", tuple(depend for depend in depends if depend.name != own_name))


def _cmake_files(folder: Folder) -> Iterator[Text]:
    """Yield each CMake file below the folder, also in nested packages and ignored folders, as colcon-cmake does."""
    todo = [folder.path]
    while todo:
        path = todo.pop()
        try:
            entries = folder.tree.list(path)
        except OSError:
            continue  # recorded by the walk
        for name, kind, link in entries:
            if kind == "file" and (name == "CMakeLists.txt" or name.endswith(".cmake")):
                if text := folder.read(join(path, name)):
                    yield text
            elif kind == "directory" and not link and not name.startswith("."):
                todo.append(join(path, name))


def _setup_cfg(folder: Folder) -> PythonProject | None:
    """Return the project in setup.cfg, None if colcon cannot use the file.

    colcon needs a setup.cfg that sets a name, and a setup.py that need not be run to get the name.
    """
    setup_py, setup_cfg = folder.text("setup.py"), folder.text("setup.cfg")
    if setup_py is None or setup_cfg is None:
        return None
    from ros_lint.collectors.colcon import python_project as colcon_python  # noqa: PLC0415  (needed only where there is no usable manifest)

    project = colcon_python.from_setup_cfg(setup_cfg) if colcon_python.needs_no_run(setup_py) else None
    return project if project and project.name else None


def _setup_py(folder: Folder) -> PythonProject | None:
    setup_py = folder.text("setup.py")
    if setup_py is None:
        return None
    from ros_lint.collectors.colcon import python_project as colcon_python  # noqa: PLC0415  (needed only where there is no usable manifest)

    return colcon_python.from_setup_py(setup_py, folder.text("setup.cfg"), folder.text("pyproject.toml"))
