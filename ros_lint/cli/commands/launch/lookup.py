"""Find launch files by path or by package, in the workspace or in an underlay."""

from __future__ import annotations

import posixpath
import re
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.analysis.launch.includes import AcceptedArguments, include_resolver
from ros_lint.analysis.launch.node_programs import node_name
from ros_lint.analysis.launch.parameter_files import parameter_contents
from ros_lint.analysis.launch.tags import with_added_tags
from ros_lint.base.paths import resolve, strip_folder
from ros_lint.base.suggestions import did_you_mean, similar_names
from ros_lint.base.text import read
from ros_lint.cli.session import UsageError
from ros_lint.collectors.file_types import kind_of
from ros_lint.collectors.resources.parameter_files import collect as collect_parameters
from ros_lint.collectors.symbolic_text import configurations, installed, installed_place, is_plain, share
from ros_lint.facts.launch import values, walk_actions
from ros_lint.facts.visibility import Facet
from ros_lint.workspace.collect import collect

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ros_lint.base.tree import Tree
    from ros_lint.facts.launch import LaunchFile
    from ros_lint.facts.sources import ParameterFile
    from ros_lint.workspace.model import Package, Workspace


_LAUNCH_FILE = re.compile(r"[._]launch\.(?:py|xml|ya?ml)\Z")
"""Pattern of the names of launch files in an underlay: ``robot.launch.py``, ``robot_launch.xml``."""


class Absent(NamedTuple):
    """The reason why a launch file was not read."""

    reason: str
    certain: bool
    """True if the launch file certainly does not exist when the workspace is launched."""


class LaunchFileLookup:
    """Finds launch files. It stores the included files that it has read, and the reasons why others could not be read."""

    def __init__(self, workspace: Workspace, tree: Tree) -> None:
        self._workspace = workspace
        self._tree = tree
        self._sources = {file.path: with_added_tags(file, workspace) for package in workspace.packages for file in package.launch}
        self._includes = include_resolver(workspace)
        self._results: dict[str, LaunchFile | Absent] = {}
        self._parameters: dict[str, ParameterFile | None] = {}

    @property
    def followed(self) -> tuple[LaunchFile, ...]:
        """The included files that were read, in the order of reading."""
        return tuple(file for file in self._results.values() if not isinstance(file, Absent))

    def accepted_arguments(self, file: LaunchFile) -> AcceptedArguments:
        """Return the launch arguments that a launch file, and the files of the workspace that it includes, accept."""
        return self._includes.takes(file)

    def used(self, file: LaunchFile) -> frozenset[str]:
        """Return the names of the launch configurations that ``file``, or an included file that was read so far, uses."""
        result: set[str] = set()
        for launch_file in (file, *self.followed):
            for action in walk_actions(launch_file.actions):
                texts = [text for value in values(action) for text in value.texts]
                texts += [text for condition in action.conditions for text in condition.texts]
                result.update(name for text in texts for name, *_ in configurations(text))
        return frozenset(result)

    def absent(self, path: str) -> Absent | None:
        """Return the reason why the included file at ``path`` could not be read; None if it was read or never requested."""
        result = self._results.get(path)
        return result if isinstance(result, Absent) else None

    # --- the file that is launched --------------------------------------------------------------------------------

    def source_file(self, path: str) -> LaunchFile:
        """Return the launch file at a path that is relative to the base folder.

        Raises UsageError if the file cannot be read or is not a launch file.
        """
        launch_file = self._sources.get(path) or self._read(path)
        return self._launchable(launch_file, path)

    def installed_file(self, package: str, name: str) -> tuple[LaunchFile, str]:
        """Return the launch file ``name`` that a package installs, and its install path.

        Like ``ros2 launch`` (ros2launch/api), this searches all folders below share/<package>. Raises UsageError if there
        is not exactly one file of this name.
        """
        packages = self._workspace.by_name.get(package, ())
        installed_package = self._workspace.world.installed(package)
        if packages:
            paths = [path for candidate in packages for path in _share_files(candidate)]
        elif installed_package is not None:
            paths = list(installed_package.share_files.names)
        else:
            raise UsageError(self._no_package(package))
        matches = sorted({path for path in paths if path.rpartition("/")[2] == name})
        if len(matches) > 1:
            paths_text = ", ".join(matches)
            raise UsageError(f"'{package}' installs several files '{name}', so ros2 launch rejects the name: {paths_text}")
        if not matches:
            raise UsageError(self._no_file(packages, package, name, paths))
        path = f"{share(package)}/{matches[0]}"
        launch_file = self.included(path)
        return self._launchable(launch_file or self._results[path], f"{package}/{matches[0]}"), path

    def installed_files(self, package: str) -> list[tuple[str, str]]:
        """Return the launch files that a package installs, each with its file name and its place.

        The place is the source file, or for a package of an underlay the path below the share folder. Raises UsageError if
        there is no such package, or if it installs no launch file.
        """
        packages = self._workspace.by_name.get(package, ())
        installed_package = self._workspace.world.installed(package)
        if packages:
            installs = [(owner, provided) for owner in packages for provided in owner.built.products.installs if provided.source]
            sources = {resolve(owner.path, provided.source): provided.path for owner, provided in installs}
            files = [(path.rpartition("/")[2], source) for source, path in sources.items() if source in self._sources]
        elif installed_package is not None:
            names = installed_package.share_files.names
            files = [(name.rpartition("/")[2], name) for name in names if _LAUNCH_FILE.search(name)]
        else:
            raise UsageError(f"{package}: no such file, and {self._no_package(package)}")
        if not files:
            raise UsageError(f"'{package}' installs no launch file")
        return sorted(files)

    def _launchable(self, result: LaunchFile | Absent, path: str) -> LaunchFile:
        if isinstance(result, Absent):
            raise UsageError(f"{path}: {result.reason}")
        if result.helper:
            raise UsageError(f"{path}: not a launch file: it has no generate_launch_description() without parameters")
        return result

    def _no_package(self, package: str) -> str:
        if self._workspace.world.is_package(package):
            return f"'{package}' is neither in the workspace nor in an underlay; --underlay PREFIX adds an install prefix"
        return f"there is no package '{package}'{did_you_mean(self._workspace.world.suggest(package))}"

    def _no_file(self, packages: Sequence[Package], package: str, name: str, paths: Sequence[str]) -> str:
        for owner in packages:
            source = next((file.path for file in owner.launch if file.path.rpartition("/")[2] == name), "")
            if source:
                return (
                    f"'{package}' has {strip_folder(owner.path, source)}, but does not install it; use 'ros-lint launch {source}'"
                )
        names = sorted({path.rpartition("/")[2] for path in paths if "launch" in path})
        hint = did_you_mean(similar_names(name, names)) or f"; available: {', '.join(names) or 'none'}"
        return f"'{package}' does not install a launch file '{name}'{hint}"

    # --- files that are included ----------------------------------------------------------------------------------

    def included(self, path: str) -> LaunchFile | None:
        """Return the launch file at the path in an include; None if it cannot be read, see :meth:`absent`."""
        result = self._results.get(path)
        if result is None:
            result = self._results[path] = self._find(path)
        return None if isinstance(result, Absent) else result

    def _find(self, path: str) -> LaunchFile | Absent:
        places = list(installed(path))
        if places:
            return self._in_package(places[0].package, places[0].path)
        if path.startswith("/"):
            return Absent("it is outside the workspace", certain=False)
        path = posixpath.normpath(path)
        return self._sources.get(path) or self._read(path)

    def _in_package(self, package: str, path: str) -> LaunchFile | Absent:
        packages = self._workspace.by_name.get(package, ())
        name = path.removeprefix(f"share/{package}/")
        for candidate in packages:
            for provided in candidate.built.products.installs:
                if provided.path == path:
                    if not provided.source:
                        return Absent("it is generated when the package is built", certain=False)
                    source = resolve(candidate.path, provided.source)
                    return self._sources.get(source) or self._read(source)
        if packages:
            if any(candidate.script is None or candidate.hidden(Facet.SHARE, path) for candidate in packages):
                return Absent(f"'{package}' may install it in a way that cannot be analysed", certain=False)
            return Absent(f"'{package}' does not install '{name}'", certain=True)
        installed_package = self._workspace.world.installed(package)
        if installed_package is None:
            return Absent(self._no_package(package), certain=False)
        data = installed_package.prefix.read(path)
        if data is None:
            return Absent(f"'{package}' in the underlay has no '{name}'", certain=True)
        return self._collected(f"{installed_package.prefix.root}/{path}", data)

    def _read(self, path: str) -> LaunchFile | Absent:
        try:
            data = self._tree.read(path)
        except (FileNotFoundError, NotADirectoryError):
            return Absent("no such file", certain=True)
        except OSError as error:
            return Absent(f"it cannot be read: {error.strerror or error}", certain=False)
        return self._collected(path, data)

    def missing(self, path: str) -> str:
        """Return the reason why a file that a launch file opens certainly does not exist, "" if it may exist."""
        place = installed_place(path)
        if place is None:
            return "no such file" if is_plain(path) and not path.startswith("/") and self._is_missing(path) else ""
        packages = self._workspace.by_name.get(place.package, ())
        for candidate in packages:
            if candidate.script is None or candidate.hidden(Facet.SHARE, place.path):
                return ""
            for provided in candidate.built.products.installs:
                if provided.path == place.path:
                    source = resolve(candidate.path, provided.source) if provided.source else ""
                    return f"{source}: no such file" if source and self._is_missing(source) else ""
        if not packages or not place.path or not is_plain(place.path):
            return ""
        return f"'{place.package}' does not install '{place.path.removeprefix(f'share/{place.package}/')}'"

    def _is_missing(self, path: str) -> bool:
        try:
            self._tree.stamp(path)
        except (FileNotFoundError, NotADirectoryError):
            return True
        except OSError:
            return False
        return False

    # --- parameter files ------------------------------------------------------------------------------------------

    def parameters(self, path: str) -> ParameterFile | None:
        """Return the parameter file at a path in a launch file; None if it is not in the workspace or an underlay."""
        if path not in self._parameters:
            self._parameters[path] = parameter_contents(self._workspace)(path) or self._read_parameters(path)
        return self._parameters[path]

    def node_name(self, package: str, target: str) -> str:
        """Return the name that a program or component of the workspace gives to its node, "" if it is unknown."""
        return node_name(self._workspace, package, target)

    def _read_parameters(self, path: str) -> ParameterFile | None:
        place = installed_place(path)
        if place is not None:
            installed_package = self._workspace.world.installed(place.package)
            if place.package in self._workspace.by_name or installed_package is None:
                return None
            data = installed_package.prefix.read(place.path)
            return collect_parameters(read(f"{installed_package.prefix.root}/{place.path}", data)) if data is not None else None
        try:
            return collect_parameters(read(path, self._tree.read(path))) if not path.startswith("/") else None
        except OSError:
            return None

    def _collected(self, path: str, data: bytes) -> LaunchFile | Absent:
        kind = kind_of(path)
        launch = collect(read(path, data), kind).launch if kind is not None else None
        return launch if launch is not None else Absent("not a ROS 2 launch file", certain=True)


def _share_files(package: Package) -> list[str]:
    share_folder = f"share/{package.name}/"
    return [file.path[len(share_folder) :] for file in package.built.products.installs if file.path.startswith(share_folder)]
