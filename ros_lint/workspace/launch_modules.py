"""Interpret Python launch files again with the modules and files that they read.

Each launch file is first interpreted alone, which gives a list of its missing inputs. If values stay unknown and the
workspace has the missing inputs, the launch file is interpreted again with them.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.base.paths import join, parent, resolve, strip_folder
from ros_lint.base.text import Text, read
from ros_lint.base.tree import Tree
from ros_lint.collectors.launch.presence_checks import DISTRIBUTIONS
from ros_lint.collectors.launch.python.released_helpers import HELPERS
from ros_lint.collectors.symbolic_text import OWN_FOLDER, UNKNOWN, installed_place
from ros_lint.facts.build import BuildScript
from ros_lint.facts.launch import LaunchAction, LaunchFile, LaunchValue, walk_actions
from ros_lint.workspace.launch_places import with_places
from ros_lint.workspace.side_by_side import own_first

if TYPE_CHECKING:
    from ros_lint.collectors.python.interpreter.values import Module

_MAX_BYTES = 1 << 18


class LaunchPackage(NamedTuple):
    """A package with its launch files, and the files that its launch files may read."""

    name: str
    path: str
    files: Collection[str]
    """Paths of all files, relative to the package."""
    script: BuildScript | None
    launch: tuple[LaunchFile, ...]


def resolve_modules(tree: Tree, packages: Sequence[LaunchPackage]) -> list[tuple[LaunchFile, ...]]:
    """Return the launch files of each package, interpreted again if the workspace has their missing inputs.

    Their references to files beside them name the package (:mod:`ros_lint.workspace.launch_places`).
    """
    if any(_needs_inputs(file) for package in packages for file in package.launch):
        inputs = _InputFinder(tree, packages)
        packages = [
            package._replace(launch=tuple([inputs.with_inputs(file, package) for file in package.launch])) for package in packages
        ]
    return [with_places(package.launch, package.name, package.path, package.files, package.script) for package in packages]


def for_distro(distro: str, file: LaunchFile) -> LaunchFile:
    """Return a launch file without references to packages that apply only to other distributions.

    The launch file is returned unchanged if ``distro`` is not a maintained distribution.
    """
    if distro not in DISTRIBUTIONS or not any(reference.distros for reference in file.references):
        return file
    return file._replace(references=tuple([use for use in file.references if not use.distros or distro in use.distros]))


class _InputFinder:
    """Finds the modules that launch files import, and the sources of installed files that launch files read."""

    def __init__(self, tree: Tree, packages: Sequence[LaunchPackage]) -> None:
        self._tree = tree
        self._by_name: dict[str, list[LaunchPackage]] = {}
        self._by_path = {package.path: package for package in packages}
        self._modules: dict[str, list[LaunchPackage]] = {}
        self._installed: dict[str, dict[str, str]] = {}
        self._parsed_modules: dict[str, Module | None] = {}
        self._on_path: set[str] = set()
        """Modules found in folders that a file adds to ``sys.path``: other modules in these folders can be imported, too."""
        for package in packages:
            self._by_name.setdefault(package.name, []).append(package)
            script = package.script
            for top in dict.fromkeys(name.partition(".")[0] for name in script.products.python_packages) if script else ():
                self._modules.setdefault(top, []).append(package)

    def with_inputs(self, file: LaunchFile, package: LaunchPackage) -> LaunchFile:
        """Return a launch file interpreted with its missing inputs, or unchanged if no missing input is available."""
        text = self._text(file.path) if _needs_inputs(file) else None
        if text is None or not any(
            self._module(name, text) or self._installed_file(name, file, package) for name in file.missing_inputs
        ):
            return file
        from ros_lint.collectors.launch.python import collect as launch_py  # noqa: PLC0415  (few launch files have missing inputs)

        def modules(name: str, importer: Text) -> Module | None:
            path = self._module(name, importer)
            return self._parsed(path) if path else None

        def files(path: str) -> str | None:
            source = self._installed_file(path, file, package)
            content = self._text(source) if source else None
            return None if content is None else content.text

        interpreted = launch_py.collect(text, modules, files)
        if len(interpreted.opaque) > len(file.opaque):
            return file
        # Actions in a module of another package are dependencies of that package.
        references = [use for use in interpreted.references if self._package_of(use.package_span.path) is package]
        return interpreted._replace(references=tuple(references))

    def _text(self, path: str) -> Text | None:
        try:
            data = self._tree.read(path)
        except OSError:
            return None
        return read(path, data) if len(data) <= _MAX_BYTES else None

    def _parsed(self, path: str) -> Module | None:
        """Return a parsed module, None if it is not valid Python. Results are cached, as many launch files share modules."""
        if path not in self._parsed_modules:
            text = self._text(path)
            self._parsed_modules[path] = _parse_module(text) if text else None
        return self._parsed_modules[path]

    # --- modules --------------------------------------------------------------------------------------------------

    def _module(self, name: str, importer: Text) -> str:
        """Return the path of a module that the file ``importer`` imports, "" if the module is ambiguous or missing."""
        package = self._package_of(importer.path)
        if package is None:
            return ""
        dots = len(name) - len(name.lstrip("."))
        module_path = name[dots:].replace(".", "/")
        if dots:
            folder = parent(importer.path)
            for _ in range(dots - 1):
                folder = parent(folder)
            return self._existing(join(folder, module_path) if module_path else folder, package)
        owners = own_first(self._modules.get(module_path.partition("/")[0], []), package.path)
        if package in owners:
            return self._module_of_package(module_path, importer, package)
        if "sys.path" in importer.text or importer.path in self._on_path:
            path = self._module_of_package(module_path, importer, package) or self._module_of_named_package(module_path, importer)
            self._on_path.add(path)
            return path
        return _shortest(owners[0], module_path) if len(owners) == 1 else ""

    def _module_of_package(self, module: str, importer: Text, package: LaunchPackage) -> str:
        return self._existing(join(parent(importer.path), module), package) or _shortest(package, module)

    def _module_of_named_package(self, module: str, importer: Text) -> str:
        """Return the path of a module in another package. The file ``importer`` contains the name of the package in quotes.

        ``importer`` may add the folder of that package to ``sys.path``. The result is "" if no such package has the module, or
        if several have it.
        """
        named = [package for package in self._by_path.values() if _is_quoted(package.name, importer.text)]
        paths = [path for package in named if (path := _shortest(package, module))]
        return paths[0] if len(paths) == 1 else ""

    def _package_of(self, path: str) -> LaunchPackage | None:
        while path:
            path = parent(path)
            if path in self._by_path:
                return self._by_path[path]
        return None

    @staticmethod
    def _existing(module: str, package: LaunchPackage) -> str:
        return next((path for path in _sources(module) if strip_folder(package.path, path) in package.files), "")

    # --- files ----------------------------------------------------------------------------------------------------

    def _installed_file(self, path: str, file: LaunchFile, package: LaunchPackage) -> str:
        """Return the path of the source file that is installed at ``path``; "" unless there is exactly one."""
        if path.startswith(f"{OWN_FOLDER}/"):
            return self._neighbour(path[len(OWN_FOLDER) + 1 :], file, package)
        place = installed_place(path)
        if place is None:
            return ""
        owners = own_first(self._by_name.get(place.package, []), package.path)
        return self._installed_sources(owners[0]).get(place.path, "") if len(owners) == 1 else ""

    def _neighbour(self, path: str, file: LaunchFile, package: LaunchPackage) -> str:
        """Return the source file that a launch file finds at ``path``, relative to its own folder; "" if there is none.

        For an installed launch file, ``path`` starts from the install folder; for any other, from the folder in the sources.
        """
        sources = self._installed_sources(package)
        install_path = next((place for place, source in sources.items() if source == file.path), "")
        if install_path:
            return sources.get(resolve(parent(install_path), path), "")
        source = resolve(parent(file.path), path)
        return source if strip_folder(package.path, source) in package.files else ""

    def _installed_sources(self, package: LaunchPackage) -> dict[str, str]:
        """Return the source of each installed file of a package, by install path."""
        sources = self._installed.get(package.path)
        if sources is None:
            provides = package.script.products.installs if package.script else ()
            sources = {file.path: resolve(package.path, file.source) for file in provides if file.source}
            self._installed[package.path] = sources
        return sources


def _needs_inputs(file: LaunchFile) -> bool:
    """Return whether a launch file contains unknown values that its missing inputs may determine."""
    if not file.missing_inputs or file.helper:
        return False
    if file.opaque or not HELPERS.keys().isdisjoint(file.missing_inputs):
        return True
    return any(
        UNKNOWN in text for action in walk_actions(file.actions) for value in _resolvable_values(action) for text in value.texts
    )


def _resolvable_values(action: LaunchAction) -> Iterator[LaunchValue]:
    """Yield the values of a launch action that name packages, executables and parameter files."""
    yield from (value for value in (action.package, action.target) if value is not None)
    yield from (value for name, value in action.parameters if not name)


def _parse_module(text: Text) -> Module | None:
    from ros_lint.collectors.python.interpreter.values import Module  # noqa: PLC0415  (few launch files have missing inputs)
    from ros_lint.collectors.python.source_errors import NotPythonError  # noqa: PLC0415
    from ros_lint.collectors.python.syntax import parse  # noqa: PLC0415

    try:
        return Module(text, parse(text))
    except NotPythonError:
        return None


def _sources(module: str) -> Iterator[str]:
    yield f"{module}.py"
    yield f"{module}/__init__.py"


def _is_quoted(name: str, text: str) -> bool:
    return f"'{name}'" in text or f'"{name}"' in text


def _shortest(package: LaunchPackage, module: str) -> str:
    """Return the path of a module in the sources of a package: the least nested file of that name, "" if there is none."""
    for name in _sources(module):
        matches = [file for file in package.files if file == name or file.endswith(f"/{name}")]
        if matches:
            return join(package.path, min(matches, key=lambda file: (file.count("/"), file)))
    return ""
