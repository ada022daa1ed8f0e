"""Interpret Python launch files again with the modules and files that they read.

Each launch file is first interpreted alone, which gives a list of its missing inputs. If values stay unknown and the
workspace has the missing inputs, the launch file is interpreted again with them.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

from ros_lint.base.paths import join, parent, resolve, strip_folder
from ros_lint.base.questions import Cell, Memo, Questions, RecordedMapping, Recorder, same
from ros_lint.base.text import Text, read
from ros_lint.base.tree import Tree
from ros_lint.collectors.launch.presence_checks import DISTRIBUTIONS
from ros_lint.collectors.launch.python.released_helpers import HELPERS
from ros_lint.collectors.symbolic_text import OWN_FOLDER, UNKNOWN, installed_place
from ros_lint.facts.build import BuildScript, InstalledFile
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


def for_distro(distro: str, file: LaunchFile) -> LaunchFile:
    """Return a launch file without references to packages that apply only to other distributions.

    The launch file is returned unchanged if ``distro`` is not a maintained distribution.
    """
    if distro not in DISTRIBUTIONS or not any(reference.distros for reference in file.references):
        return file
    return file._replace(references=tuple([use for use in file.references if not use.distros or distro in use.distros]))


class _Source(NamedTuple):
    """The part of a package that the launch files of other packages may read."""

    name: str
    path: str
    files: Collection[str]
    """Paths of all files, relative to the package."""
    installs: tuple[InstalledFile, ...]

    @classmethod
    def of(cls, package: LaunchPackage) -> _Source:
        return cls(package.name, package.path, package.files, package.script.products.installs if package.script else ())


class LaunchModules:
    """Finds the modules that launch files import, and the sources of installed files that launch files read.

    With a ``recorder``, a launch file is interpreted again only if something that it has read has changed.
    """

    def __init__(self, tree: Tree, recorder: Recorder | None = None) -> None:
        self._tree = tree
        self._recorder = recorder
        self._questions: Questions = recorder.scope() if recorder else Memo()
        self._packages: dict[str, LaunchPackage] = {}
        self._cells: dict[str, Cell] = {}
        self._by_path: Mapping[str, _Source] = {}
        self._by_name: Mapping[str, tuple[_Source, ...]] = {}
        self._modules: Mapping[str, tuple[_Source, ...]] = {}
        if recorder:
            self._recorded = [RecordedMapping[Any](recorder) for _ in range(3)]
            self._by_path, self._by_name, self._modules = self._recorded

    def resolve(self, packages: Sequence[LaunchPackage]) -> list[tuple[LaunchFile, ...]]:
        """Return the launch files of each package, interpreted again if the workspace has their missing inputs.

        Their references to files beside them name the package (:mod:`ros_lint.workspace.launch_places`).
        """
        sources = {package.path: _Source.of(package) for package in packages}
        by_name: dict[str, tuple[_Source, ...]] = {}
        modules: dict[str, tuple[_Source, ...]] = {}
        for package in packages:
            source, script = sources[package.path], package.script
            by_name[package.name] = (*by_name.get(package.name, ()), source)
            for top in dict.fromkeys(name.partition(".")[0] for name in script.products.python_packages) if script else ():
                modules[top] = (*modules.get(top, ()), source)
        if self._recorder is None:
            self._by_path, self._by_name, self._modules = sources, by_name, modules
            self._packages = {package.path: package for package in packages}
        else:
            by_path, names, tops = self._recorded
            changed = [*by_path.update(sources), *names.update(by_name), *tops.update(modules)]
            for package in packages:
                before = self._packages.get(package.path)
                self._packages[package.path] = package
                cell = self._cells.setdefault(package.path, Cell())
                if before and (before.launch or package.launch) and not same(before, package):
                    changed.append(cell)
            self._recorder.change(changed)
        return [self._questions.ask(("launch", package.path), partial(self._launch, package.path)) for package in packages]

    def _launch(self, path: str) -> tuple[LaunchFile, ...]:
        if self._recorder:
            self._recorder.note(self._cells[path])
        name, _, files, script, launch = self._packages[path]
        if any(map(_needs_inputs, launch)):
            launch = tuple([self._with_inputs(file, path) for file in launch])
        return with_places(launch, name, path, files, script)

    def _with_inputs(self, file: LaunchFile, folder: str) -> LaunchFile:
        """Return a launch file interpreted with its missing inputs, or unchanged if no missing input is available."""
        text = self._text(file.path) if _needs_inputs(file) else None
        if text is None:
            return file
        package = self._by_path[folder]
        on_path: set[str] = set()
        names = file.missing_inputs
        if not any(self._module(name, text, on_path) or self._installed_file(name, file, package) for name in names):
            return file
        from ros_lint.collectors.launch.python import collect as launch_py  # noqa: PLC0415  (few launch files have missing inputs)

        def modules(name: str, importer: Text) -> Module | None:
            path = self._module(name, importer, on_path)
            return self._parsed(path) if path else None

        def files(path: str) -> str | None:
            source = self._installed_file(path, file, package)
            content = self._text(source) if source else None
            return None if content is None else content.text

        interpreted = launch_py.collect(text, modules, files)
        if len(interpreted.opaque) > len(file.opaque) and _count(interpreted) <= _count(file):
            return file
        # Actions in a module of another package are dependencies of that package.
        references = [use for use in interpreted.references if self._folder_of(use.package_span.path) == folder]
        return interpreted._replace(references=tuple(references))

    def _text(self, path: str) -> Text | None:
        try:
            data = self._tree.read(path)
        except OSError:
            return None
        return read(path, data) if len(data) <= _MAX_BYTES else None

    def _parsed(self, path: str) -> Module | None:
        """Return a parsed module, None if it is not valid Python. Results are cached, as many launch files share modules."""
        return self._questions.ask(("module", path), lambda: _parse_module(text) if (text := self._text(path)) else None)

    # --- modules --------------------------------------------------------------------------------------------------

    def _module(self, name: str, importer: Text, on_path: set[str]) -> str:
        """Return the path of a module that the file ``importer`` imports, "" if the module is ambiguous or missing.

        ``on_path`` are the modules found in folders that a file adds to ``sys.path``: other modules in these folders can be
        imported, too. A found module is added to it.
        """
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
        owners = own_first(self._modules.get(module_path.partition("/")[0], ()), package.path)
        if package in owners:
            return self._module_of_package(module_path, importer, package)
        if "sys.path" in importer.text or importer.path in on_path:
            path = self._module_of_package(module_path, importer, package) or self._module_of_named_package(module_path, importer)
            on_path.add(path)
            return path
        return _shortest(owners[0], module_path) if len(owners) == 1 else ""

    def _module_of_package(self, module: str, importer: Text, package: _Source) -> str:
        return self._existing(join(parent(importer.path), module), package) or _shortest(package, module)

    def _module_of_named_package(self, module: str, importer: Text) -> str:
        """Return the path of a module in another package. The file ``importer`` contains the name of the package in quotes.

        ``importer`` may add the folder of that package to ``sys.path``. The result is "" if no such package has the module, or
        if several have it.
        """
        named = [package for package in self._by_path.values() if _is_quoted(package.name, importer.text)]
        paths = [path for package in named if (path := _shortest(package, module))]
        return paths[0] if len(paths) == 1 else ""

    def _package_of(self, path: str) -> _Source | None:
        folder = self._folder_of(path)
        return None if folder is None else self._by_path[folder]

    def _folder_of(self, path: str) -> str | None:
        """Return the folder of the package that contains a file, None if no package contains it."""
        while path:
            path = parent(path)
            if path in self._by_path:
                return path
        return None

    @staticmethod
    def _existing(module: str, package: _Source) -> str:
        return next((path for path in _sources(module) if strip_folder(package.path, path) in package.files), "")

    # --- files ----------------------------------------------------------------------------------------------------

    def _installed_file(self, path: str, file: LaunchFile, package: _Source) -> str:
        """Return the path of the source file that is installed at ``path``; "" unless there is exactly one."""
        if path.startswith(f"{OWN_FOLDER}/"):
            return self._neighbour(path[len(OWN_FOLDER) + 1 :], file, package)
        place = installed_place(path)
        if place is None:
            return ""
        owners = own_first(self._by_name.get(place.package, ()), package.path)
        return self._installed_sources(owners[0]).get(place.path, "") if len(owners) == 1 else ""

    def _neighbour(self, path: str, file: LaunchFile, package: _Source) -> str:
        """Return the source file that a launch file finds at ``path``, relative to its own folder; "" if there is none.

        For an installed launch file, ``path`` starts from the install folder; for any other, from the folder in the sources.
        """
        sources = self._installed_sources(package)
        install_path = next((place for place, source in sources.items() if source == file.path), "")
        if install_path:
            return sources.get(resolve(parent(install_path), path), "")
        source = resolve(parent(file.path), path)
        return source if strip_folder(package.path, source) in package.files else ""

    def _installed_sources(self, package: _Source) -> dict[str, str]:
        """Return the source of each installed file of a package, by install path."""
        return self._questions.ask(("installed sources", package.path), lambda: self._find_installed_sources(package.path))

    def _find_installed_sources(self, folder: str) -> dict[str, str]:
        return {file.path: resolve(folder, file.source) for file in self._by_path[folder].installs if file.source}


def _count(file: LaunchFile) -> int:
    """Return the number of actions in a launch file."""
    return sum(1 for _ in walk_actions(file.actions))


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
    """Yield the values of a launch action, except the values of parameters and the texts of substitutions in conditions."""
    values = (action.package, action.target, action.name, action.namespace, action.value)
    yield from (value for value in values if value is not None)
    yield from (value for name, value in action.parameters if not name)
    yield from (value for _, value in action.arguments)


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


def _shortest(package: _Source, module: str) -> str:
    """Return the path of a module in the sources of a package: the least nested file of that name, "" if there is none."""
    for name in _sources(module):
        matches = [file for file in package.files if file == name or file.endswith(f"/{name}")]
        if matches:
            return join(package.path, min(matches, key=lambda file: (file.count("/"), file)))
    return ""
