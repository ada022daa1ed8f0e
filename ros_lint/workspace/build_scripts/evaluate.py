"""Evaluate the build scripts (CMakeLists.txt or setup.py) of all packages.

CMake code of a package with CONFIG_EXTRAS runs in its dependents, so such a package is evaluated before its dependents.
"""

from __future__ import annotations

from collections import ChainMap
from collections.abc import Iterator, Mapping, Sequence
from itertools import chain
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.base.by_name import ByName
from ros_lint.base.paths import join
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


def evaluate(tree: Tree, packages: Sequence[Parts], distro: str, earlier: Evaluation | None = None) -> Evaluation:
    """Return the evaluated build scripts of the packages for the distribution ``distro``.

    ``earlier`` is an evaluation of the same packages for another distribution. Its result is reused for each script that does
    not depend on the distribution.
    """
    same = _same_scripts(packages, distro, earlier) if earlier else {}
    if earlier and len(same) == len(packages):
        return Evaluation(packages, [same[number] for number in range(len(packages))], earlier.helpers)
    result: list[BuildScript | None] = [None] * len(packages)
    helpers: dict[str, dict[str, Helper]] = {}
    if earlier and same:
        helpers = {folder: dict(by_name) for folder, by_name in earlier.helpers.items()}
    surroundings = Surroundings(tree)
    in_order = [*_helping(packages), *(number for number, parts in enumerate(packages) if not _helps(parts))]
    for number in in_order:
        parts = packages[number]
        if number in same:
            result[number] = same[number]
            continue
        try:
            if "CMakeLists.txt" in parts.commands and parts.package.type != "ros.ament_python":
                result[number] = with_files(
                    tree, parts.package, parts.commands, _cmake(tree, parts, distro, helpers, surroundings)
                )
            elif script := _python(tree, parts.package):
                result[number] = with_files(tree, parts.package, parts.commands, script)
        except Exception as error:  # a bug in ros-lint that one script triggers must not stop the evaluation of the others
            result[number] = _failed(parts, FAILED.format(f"{type(error).__name__}: {error}"))
    return Evaluation(packages, result, helpers)


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
        elif _helps(parts) or (before is not None and _helps(before)):
            return {}
    return same if scripts.keys() == {parts.package.path for parts in packages} else {}


def _cmake(
    tree: Tree, parts: Parts, distro: str, helpers: dict[str, dict[str, Helper]], surroundings: Surroundings
) -> BuildScript:
    """Return the evaluated CMakeLists.txt of a package.

    A package with CONFIG_EXTRAS is added to ``helpers``, because its CMake code runs in dependents. The keys of ``helpers`` are
    the path of the workspace and the name of the package.
    """
    from ros_lint.collectors.cmake import evaluate as cmake  # noqa: PLC0415
    from ros_lint.collectors.cmake.evaluator.sources import Helper  # noqa: PLC0415
    from ros_lint.collectors.cmake.released_macros import opaque_packages  # noqa: PLC0415

    inputs = sources(tree, parts, surroundings)
    own_helpers = helpers.setdefault(workspace_of(parts.package.path), {})
    visible = ChainMap(own_helpers, *[of_workspace for of_workspace in helpers.values() if of_workspace is not own_helpers])
    script = cmake.evaluate(inputs, distro, visible)
    if script.exports.config_extras and parts.package.name not in opaque_packages():
        own_helpers[parts.package.name] = Helper(inputs, script)
    folder = parts.package.path
    calls = (cmake_calls.collect(join(folder, file), parsed) for file, parsed in sorted(parts.commands.items()))
    return script._replace(commands=script.commands._replace(calls=ByName(chain.from_iterable(calls))))


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


def _helps(parts: Parts) -> bool:
    """Return whether a package has CMake code that runs in its dependents: ament_package(CONFIG_EXTRAS ...)."""
    return any(
        argument[0].startswith("CONFIG_EXTRAS")
        for parsed in parts.commands.values()
        for command in parsed.commands
        if command.name in ("ament_package", "ament_auto_package")
        for argument in command.args
    )


def _helping(packages: Sequence[Parts]) -> Iterator[int]:
    """Yield the indices of packages with CONFIG_EXTRAS, dependencies before their dependents."""
    remaining = {number: parts.package.name for number, parts in enumerate(packages) if _helps(parts)}
    while remaining:
        names = frozenset(remaining.values())
        ready = [number for number, name in remaining.items() if not _needed(packages[number]) & (names - {name})]
        for number in ready or list(remaining):  # packages on a cycle have no correct order
            del remaining[number]
            yield number


def _needed(parts: Parts) -> set[str]:
    return {name for names in parts.depends.values() for name in names}
