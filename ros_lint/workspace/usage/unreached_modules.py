"""Find installed Python modules that no program, launch file, script or test of their package imports, even indirectly."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

from ros_lint.base.auxiliary_files import TEST_FOLDERS
from ros_lint.base.paths import folders_of, join
from ros_lint.base.text import Text
from ros_lint.base.tree import Tree, text_of
from ros_lint.collectors.python.imported_paths import imported_paths
from ros_lint.collectors.python.source_errors import NotPythonError, TooDeepError
from ros_lint.collectors.python.syntax import parse
from ros_lint.facts.sources import Use
from ros_lint.workspace.usage.package_files import PackageSource

_PROGRAMS = ("lib/", "bin/")


ImportedModules = Callable[[str], Mapping[str, frozenset[str]]]
"""A function that returns, for a top-level module, the full names of the modules that packages import, by path of the package."""


def imported_modules(source: PackageSource) -> Mapping[str, frozenset[str]]:
    """Return the names of the modules that a package imports, by top-level module."""
    names = {mention.name for facts in source.facts.values() for mention in facts.mentions if mention.via == "import"}
    by_top: dict[str, list[str]] = {}
    for name in sorted(names):
        by_top.setdefault(name.partition(".")[0], []).append(name)
    return {top: frozenset(of_top) for top, of_top in by_top.items()}


def unreached_modules(tree: Tree, source: PackageSource, uses: Iterable[Use], imported: ImportedModules) -> frozenset[str]:
    """Return the modules that contain an import of ``uses``, but that no started file of the package imports, even indirectly.

    Paths are relative to the package. Started files are entry points, installed programs, launch files, tests, and Python files
    outside of the installed Python packages. Reached files are the started files, the files that they import, and the modules
    that other packages import, see ``imported``. The result contains only modules that cannot be imported if:

    - no file is started by name, as in a library,
    - a reached file computes names of imported modules,
    - a reached file cannot be read.
    """
    tops = frozenset([name.partition(".")[0] for name in source.built.products.python_packages])
    modules = [file for file in source.files if file.endswith(".py") and _top(file) in tops]
    importing = {use.span.path for use in uses if use.via == "import"}
    candidates = [module for module in modules if join(source.path, module) in importing]
    started = frozenset(_started(source, modules)) if candidates else frozenset()
    if started.issuperset(candidates):
        return frozenset()
    outside = [file for file in source.files if file.endswith(".py") and _top(file) not in tops and file != "setup.py"]
    starts = [*started, *outside, *_imported_elsewhere(modules, tops, source.path, imported)]
    reached = _reached(tree, source, starts) if started else None
    if reached is None:
        reached = started.union([module for module in candidates if _is_importable(tree, source, module)])
    return frozenset(candidates) - reached


def _is_importable(tree: Tree, source: PackageSource, module: str) -> bool:
    """Return whether Python 3 can import the file ``module``.

    It cannot if the path contains a dash, or if the source has the syntax of Python 2, such as ``print x``.
    """
    if not all(part.isidentifier() for part in module.removesuffix(".py").split("/")):
        return False
    text = text_of(tree, join(source.path, module))
    try:
        parse(text or Text(module, ""))
    except TooDeepError:
        return True
    except NotPythonError:
        return False
    return True


def _top(file: str) -> str:
    return file.removeprefix("src/").partition("/")[0].removesuffix(".py")


def _started(source: PackageSource, modules: Sequence[str]) -> Iterator[str]:
    """Yield the started modules: entry points, programs, launch files, tests, and modules whose file name is in a string."""
    script = source.built
    yield from (module.path for module in script.python.entry_point_modules)
    yield from (file.source for file in script.products.installs if file.path.startswith(_PROGRAMS) and not file.importable)
    launched = {launch.path for launch in source.launch}
    named = {name for facts in source.facts.values() for name in facts.programs}
    for module in modules:
        name = module.rpartition("/")[2]
        is_test = name.startswith("test_") or name.endswith("_test.py") or not TEST_FOLDERS.isdisjoint(module.split("/"))
        if is_test or name == "__main__.py" or name in named or join(source.path, module) in launched:
            yield module


def _imported_elsewhere(modules: Iterable[str], tops: frozenset[str], own: str, imported: ImportedModules) -> Iterator[str]:
    """Yield the modules that packages import, except for the package at ``own``.

    ``import robot`` counts for all modules of ``robot``.
    """
    names = {name.replace(".", "/") for top in tops for path, of_path in imported(top).items() if path != own for name in of_path}
    prefixes = tuple([f"{name}{end}" for name in names for end in ("/", ".")])
    yield from (module for module in modules if module.removeprefix("src/").startswith(prefixes)) if prefixes else ()


def _reached(tree: Tree, source: PackageSource, starts: Iterable[str]) -> frozenset[str] | None:
    """Return the files ``starts`` with all Python files that they import, even indirectly; None if the imports are not known."""
    files = frozenset([file for file in source.files if file.endswith(".py")])
    by_import = _by_import(files)
    reached: set[str] = set()
    pending = [start for start in starts if start in files]
    while pending:
        file = pending.pop()
        if file in reached:
            continue
        reached.add(file)
        text = text_of(tree, join(source.path, file))
        imported = imported_paths(text, file) if text is not None else None
        if imported is None:
            return None
        pending += [module for path in imported for module in by_import.get(path, ())]
        pending += [init for folder in folders_of(file) if (init := f"{folder}/__init__.py") in files]
    return frozenset(reached)


def _by_import(files: Iterable[str]) -> Mapping[str, Sequence[str]]:
    """Return, for each path that an import may contain, the files to which the import may refer.

    ``src/robot/arm.py`` is the file of ``robot/arm``, of ``arm`` and of ``robot/*``.
    """
    result: dict[str, list[str]] = {}
    for file in files:
        stem = file.removesuffix(".py").removesuffix("/__init__")
        for path in (stem, f"{stem.rpartition('/')[0]}/*"):
            parts = path.split("/")
            for start in range(len(parts)):
                result.setdefault("/".join(parts[start:]), []).append(file)
    return result
