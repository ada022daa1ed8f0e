"""Evaluate the build scripts (CMakeLists.txt or setup.py) of all packages.

CMake code of a package with CONFIG_EXTRAS runs in its dependents, so such a package is evaluated before its dependents.
"""

from __future__ import annotations

from collections import ChainMap
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from itertools import chain
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.base.by_name import ByName
from ros_lint.base.paths import join
from ros_lint.base.questions import Cell, Memo, Questions, Recorder
from ros_lint.base.questions import same as same_value
from ros_lint.base.text import file_start
from ros_lint.base.tree import Tree
from ros_lint.collectors.cmake import calls as cmake_calls
from ros_lint.collectors.python import top_level_names as python_names
from ros_lint.collectors.setup_py import editable_lists as setup_layout
from ros_lint.collectors.setup_py import editable_texts as setup_texts
from ros_lint.facts.build import BuildScript
from ros_lint.facts.setup_py import PythonModule
from ros_lint.facts.visibility import ALL_FACETS, Opaque
from ros_lint.workspace.build_scripts.files import Executables, text_in, with_files
from ros_lint.workspace.build_scripts.sources import Parts, Surroundings, sources
from ros_lint.workspace.collect import FAILED
from ros_lint.workspace.discovery.discover import DiscoveredPackage
from ros_lint.workspace.side_by_side import workspace_of

if TYPE_CHECKING:
    from ros_lint.collectors.cmake.evaluator.sources import Helper

_PYTHON = ("setup.py", "setup.cfg", "pyproject.toml")


class Evaluation(NamedTuple):
    """The evaluated build scripts of all packages of a workspace for one distribution."""

    packages: Sequence[Parts]
    scripts: Sequence[BuildScript | None]
    """The evaluated script of each package, in the order of ``packages``; None for a package without a build script."""
    helpers: Mapping[str, dict[str, Helper]]
    """The packages with CONFIG_EXTRAS, whose CMake code runs in dependents.

    The keys are the path of the workspace in the repository (``arm_ws``, usually "") and the name of the package.
    """


class Scripts:
    """Evaluates the build scripts of packages for the distribution ``distro``.

    With a ``recorder``, a script is evaluated again only if something that its evaluation has read has changed.
    """

    def __init__(self, tree: Tree, distro: str, recorder: Recorder | None = None) -> None:
        self._tree = tree
        self._distro = distro
        self._recorder = recorder
        self._questions: Questions = recorder.scope() if recorder else Memo()
        self._surroundings = Surroundings(tree, self._questions)
        self._parts: dict[str, Parts] = {}
        self._cells: dict[str, Cell] = {}
        self._order: list[str] = []
        self._of_order = Cell()
        self._of_helpers: dict[str, Cell] = {}
        """The input for each name of a package with CONFIG_EXTRAS."""
        self._helpers: dict[str, dict[str, Helper]] = {}
        self._last: dict[str, tuple[Parts, Helper]] = {}
        """The packages with CONFIG_EXTRAS, by path."""

    def evaluate(self, packages: Sequence[Parts], earlier: Evaluation | None = None) -> Evaluation:
        """Return the evaluated build scripts of the packages.

        ``earlier`` is an evaluation of the same packages for another distribution. Its result is reused for each script that does
        not depend on the distribution.
        """
        same = _same_scripts(packages, self._distro, earlier) if earlier else {}
        if earlier and len(same) == len(packages):
            return Evaluation(packages, [same[number] for number in range(len(packages))], earlier.helpers)
        result: list[BuildScript | None] = [None] * len(packages)
        self._helpers = {}
        if earlier and same:
            self._helpers = {folder: dict(by_name) for folder, by_name in earlier.helpers.items()}
        helping = list(_helping(packages))
        self._begin(packages, [packages[number].package.path for number in helping])
        in_order = [*helping, *(number for number, parts in enumerate(packages) if not parts.helps)]
        for number in in_order:
            parts = packages[number]
            if number in same:
                result[number] = same[number]
                continue
            path = parts.package.path
            if parts.of_cmake:
                self._helpers.setdefault(workspace_of(path), {})
            result[number], helper = self._questions.ask(("script", path), partial(self._evaluate, path))
            if parts.helps:
                self._keep(parts, helper)
        return Evaluation(packages, result, self._helpers)

    def _begin(self, packages: Sequence[Parts], order: list[str]) -> None:
        """Take the new parts of the packages, and the ``order`` of the packages with CONFIG_EXTRAS."""
        changed = []
        for parts in packages:
            path = parts.package.path
            before = self._parts.get(path)
            if before is not parts and not (before and same_value(before, parts)):
                self._parts[path] = parts
                changed.append(self._cells.setdefault(path, Cell()))
        if order != self._order:
            self._order = order
            changed.append(self._of_order)
        gone = self._last.keys() - set(order)
        changed += [self._of_helper(self._last.pop(path)[0].package.name) for path in gone]
        if self._recorder:
            self._recorder.change(changed)

    def _keep(self, parts: Parts, helper: Helper | None) -> None:
        """Make the CMake code of a package with CONFIG_EXTRAS visible in the packages that are evaluated after it."""
        package = parts.package
        parts = self._parts[package.path]
        before = self._last.pop(package.path, None)
        if before and helper and before[0] is parts and same_value(before[1].script, helper.script):
            helper = before[1]
        elif self._recorder and (before or helper):
            self._recorder.change([self._of_helper(package.name)])
        if helper:
            self._last[package.path] = parts, helper
            self._helpers[workspace_of(package.path)][package.name] = helper

    def _of_helper(self, name: str) -> Cell:
        return self._of_helpers.setdefault(name, Cell())

    def _evaluate(self, path: str) -> tuple[BuildScript | None, Helper | None]:
        """Return the evaluated script of the package at ``path``, and the package itself if its CMake code runs in dependents."""
        parts = self._parts[path]
        if self._recorder:
            self._recorder.note(self._cells[path])
            if parts.helps:
                self._recorder.note(self._of_order)
        helper: Helper | None = None
        try:
            if parts.of_cmake:
                script, helper = self._cmake(parts)
                return with_files(self._tree, parts.package, parts.commands, script), helper
            python = _python(self._tree, parts.package)
            return with_files(self._tree, parts.package, parts.commands, python) if python else None, None
        except Exception as error:  # a bug in ros-lint that one script triggers must not stop the evaluation of the others
            return _failed(parts, FAILED.format(f"{type(error).__name__}: {error}")), helper

    def _cmake(self, parts: Parts) -> tuple[BuildScript, Helper | None]:
        from ros_lint.collectors.cmake import evaluate as cmake  # noqa: PLC0415
        from ros_lint.collectors.cmake.evaluator.sources import Helper  # noqa: PLC0415
        from ros_lint.collectors.cmake.released_macros import opaque_packages  # noqa: PLC0415

        inputs = sources(self._tree, parts, self._surroundings)
        script = cmake.evaluate(inputs, self._distro, self._visible_from(parts.package))
        helps = script.exports.config_extras and parts.package.name not in opaque_packages()
        helper = Helper(inputs, script) if helps else None
        folder = parts.package.path
        calls = (cmake_calls.collect(join(folder, file), parsed) for file, parsed in sorted(parts.commands.items()))
        return script._replace(commands=script.commands._replace(calls=ByName(chain.from_iterable(calls)))), helper

    def _visible_from(self, package: DiscoveredPackage) -> Mapping[str, Helper]:
        """Return the packages with CONFIG_EXTRAS that a package can find, by name. Look-ups are recorded."""
        own_helpers = self._helpers[workspace_of(package.path)]
        others = [of_workspace for of_workspace in self._helpers.values() if of_workspace is not own_helpers]
        visible: Mapping[str, Helper] = ChainMap(own_helpers, *others)
        return _RecordedHelpers(visible, self._recorder, self._of_helper) if self._recorder else visible

    def variable_values(self, package: str, path: str, line: int, variable: str, *, assigned: bool) -> tuple[str | None, ...]:
        """Return the values of a CMake variable at a line of a file of the package at the path ``package``.

        See :func:`ros_lint.collectors.cmake.variable_values.values_at`. The result is () for a package without a CMakeLists.txt.
        """
        from ros_lint.collectors.cmake.variable_values import values_at  # noqa: PLC0415

        parts = self._parts.get(package)
        if parts is None or not parts.of_cmake:
            return ()
        inputs = sources(self._tree, parts, self._surroundings)
        return values_at(inputs, self._distro, self._visible_from(parts.package), path, line, variable, assigned=assigned)


class _RecordedHelpers(Mapping[str, "Helper"]):
    """The visible packages with CONFIG_EXTRAS, by name. Each look-up is recorded."""

    def __init__(self, helpers: Mapping[str, Helper], recorder: Recorder, cell: Callable[[str], Cell]) -> None:
        self._helpers = helpers
        self._recorder = recorder
        self._cell = cell

    def __getitem__(self, name: str) -> Helper:
        self._recorder.note(self._cell(name))
        return self._helpers[name]

    def __contains__(self, name: object) -> bool:
        self._recorder.note(self._cell(str(name)))
        return name in self._helpers

    def __iter__(self) -> Iterator[str]:
        raise NotImplementedError("the evaluation looks up names only")

    def __len__(self) -> int:
        raise NotImplementedError("the evaluation looks up names only")


def _same_scripts(packages: Sequence[Parts], distro: str, earlier: Evaluation) -> dict[int, BuildScript | None]:
    """Return the evaluated scripts of ``earlier`` that are valid for ``distro``, too, by the index of the package.

    The result is empty if a package with CONFIG_EXTRAS has to be evaluated again, because its CMake code runs in dependents.
    """
    scripts = {parts.package.path: (parts, script) for parts, script in zip(earlier.packages, earlier.scripts, strict=True)}
    same: dict[int, BuildScript | None] = {}
    for number, parts in enumerate(packages):
        before, script = scripts.get(parts.package.path, (None, None))
        if parts == before and (script is None or script.distros is None or distro in script.distros):
            same[number] = script
        elif parts.helps or (before is not None and before.helps):
            return {}
    return same if scripts.keys() == {parts.package.path for parts in packages} else {}


def _failed(parts: Parts, reason: str) -> BuildScript:
    path = join(parts.package.path, "CMakeLists.txt" if "CMakeLists.txt" in parts.commands else "setup.py")
    opaque = Opaque(ALL_FACETS, reason, file_start(path), unchecked=True)
    return BuildScript(path, opaque=(opaque,), distros=frozenset())


def _python(tree: Tree, package: DiscoveredPackage) -> BuildScript | None:
    if not {"setup.py", "setup.cfg"}.intersection(package.files) or package.type not in ("ros.ament_python", "python"):
        return None
    from ros_lint.collectors.setup_py import evaluate as setup_py  # noqa: PLC0415

    setup, config, project = texts_read = [text_in(tree, package, file) for file in _PYTHON]
    script = setup_py.evaluate(package.name, package.path, package.files, setup, config, project, Executables(tree, package))
    slots = setup_layout.collect(setup, package.name) if setup else ()
    texts = setup_texts.collect(setup) if setup else ()
    unread = [
        join(package.path, file) for file, text in zip(_PYTHON, texts_read, strict=True) if not text and file in package.files
    ]
    opaque = [Opaque(ALL_FACETS, "the file cannot be read", file_start(path)) for path in unread]
    return script._replace(
        python=script.python._replace(
            editable_lists=slots,
            editable_texts=(*script.python.editable_texts, *texts),
            entry_point_modules=tuple(_modules(tree, package, script)),
        ),
        opaque=(*script.opaque, *opaque),
    )


def _modules(tree: Tree, package: DiscoveredPackage, script: BuildScript) -> Iterator[PythonModule]:
    """Yield the modules of the package that are named by its entry points, e.g. ``my_package/node.py``."""
    files = frozenset(package.files)
    for name in dict.fromkeys(entry.module for entry in script.products.entry_points):
        stem = name.replace(".", "/")
        ends = (f"{stem}.py", f"{stem}/__init__.py")
        path = next((f"{top}{end}" for end in ends for top in ("", "src/") if f"{top}{end}" in files), None)
        path = path or next((file for file in package.files if file.endswith(tuple(f"/{end}" for end in ends))), None)
        text = text_in(tree, package, path) if path else None
        if path and text:
            yield python_names.collect(name, path, text)


def _helping(packages: Sequence[Parts]) -> Iterator[int]:
    """Yield the indices of packages with CONFIG_EXTRAS, dependencies before their dependents."""
    remaining = {number: parts.package.name for number, parts in enumerate(packages) if parts.helps}
    while remaining:
        names = frozenset(remaining.values())
        ready = [number for number, name in remaining.items() if not _needed(packages[number]) & (names - {name})]
        for number in ready or list(remaining):  # packages on a cycle have no correct order
            del remaining[number]
            yield number


def _needed(parts: Parts) -> set[str]:
    return {name for names in parts.depends.values() for name in names}
