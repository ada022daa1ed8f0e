"""
## What it finds

Entry points whose target does not exist:

- The module does not exist in the package.
- The module does not define the function.
- The target names only a module, without `:function`.

## Why it matters

The build succeeds, but the installed program stops with ModuleNotFoundError or ImportError when it is started.

## How to fix it

Write `name = package.module:function` with names that exist. The message suggests a module or function with a similar name, and
names a file that Python cannot import because of its name (`my-node.py`). The fix writes the suggested module.

## Limitations

Not reported:

- Modules of other packages. Exceptions: this package has a module of the same name in its own Python package, or the other
  package is in the workspace, is fully analysed and has no such module.
- Missing functions in modules that use `import *`, define `__getattr__` or cannot be read: they may define any name.
- Modules that are generated during the build, and missing modules if a file of the package cannot be read.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from ros_lint.api import (
    BuildScript,
    Edit,
    EntryPoint,
    Facet,
    Finding,
    Fix,
    Package,
    PythonModule,
    Related,
    Rule,
    Severity,
    Workspace,
    build,
    cached_by_package,
    names,
)


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.built
    for entry in script.products.entry_points:
        if target := build.entry_point_target(entry):
            yield from _lacking(package, script, entry, *target, workspace)


def _lacking(
    package: Package, script: BuildScript, entry: EntryPoint, name: str, attribute: str | None, workspace: Workspace
) -> Iterator[Finding]:
    """Yield the finding for an entry point if its module ``name``, or the function ``attribute`` of the module, does not exist.

    ``attribute`` is None for an entry point without ``:function``. Such an entry point is reported if it is for a program.
    """
    runs = entry.group in ("console_scripts", "gui_scripts")
    module, defined = _entry_point_modules(package, workspace).get(name, (None, frozenset()))
    if attribute is None:
        missing = list(_no_module(package, entry, name, "main", workspace)) if runs and module is None else []
        if missing:
            yield missing[0]._replace(fix=None)  # a correct module name alone would not repair the entry
        elif runs:
            remedy = f"write {name}:main"
            if module is not None and not module.open and "main" not in defined:
                remedy = f"'{module.path}' has no 'main': define it and {remedy}, or remove the entry point"
            yield Finding(f"entry point '{entry.name}' names a module but no function; {remedy}", entry.span, entry.name)
        return
    if module is None:
        yield from _no_module(package, entry, name, attribute, workspace)
        return
    first = attribute.partition(".")[0]
    if not module.open and first not in defined and f"{name}.{first}" not in script.products.python_packages:
        near = names.similar_names(first, defined, 1, 0.7)
        hint = names.ask_if_meant(near) or "; define it, or remove the entry point"
        yield Finding(
            f"entry point '{entry.name}': '{module.path}' does not define '{first}'{hint}",
            entry.span,
            entry.name,
            (Related(f"{module.path} does not define '{first}'", package.start_of(module.path)),),
        )


@cached_by_package
def _entry_point_modules(package: Package, _: Workspace) -> Mapping[str, tuple[PythonModule, frozenset[str]]]:
    """Return the modules in the sources that entry points name, each with the names that it defines, by name."""
    return {module.name: (module, frozenset(module.names)) for module in reversed(package.built.python.entry_point_modules)}


@cached_by_package
def _targets(package: Package, _: Workspace) -> frozenset[str]:
    return frozenset([entry.target for entry in package.built.products.entry_points])


_MOST_SIMILAR = 10
"""Maximum number of similar modules of which one is suggested."""


class _Modules(NamedTuple):
    """The Python modules in the sources of a package."""

    tops: frozenset[str]
    """The names of the Python packages without a parent package."""
    all: tuple[str, ...]
    """The names with dots, sorted. missing-python-module checks that they are installed."""
    by_rest: Mapping[str, Sequence[str]]
    """The names with dots by what follows the first dot."""
    not_importable: tuple[str, ...]
    """The paths of files that Python cannot import because of their names."""


@cached_by_package
def _modules(package: Package, _: Workspace) -> _Modules:
    packages = package.built.products.python_packages
    tops = frozenset([module.partition(".")[0] for module in packages])
    files = [file for file in package.files if file.endswith(".py") and file.partition("/")[0] in tops]
    not_importable = dict.fromkeys(file for file in files if not all(map(str.isidentifier, file[:-3].split("/"))))
    importable = {file[:-3].replace("/", ".") for file in files if file not in not_importable}
    modules = tuple(sorted(module for module in importable.union(packages) if "." in module))
    by_rest: dict[str, list[str]] = {}
    for module in modules:
        by_rest.setdefault(module.partition(".")[2], []).append(module)
    return _Modules(tops, modules, by_rest, tuple(not_importable))


def _no_module(package: Package, entry: EntryPoint, name: str, function: str, workspace: Workspace) -> Iterator[Finding]:
    """Yield the finding for an entry point ``name:function`` whose module is not in the sources.

    Nothing is yielded if the module may belong to another package, or may be generated.
    """
    script = package.script
    if script is None or name in script.products.python_packages or package.hidden(Facet.PYTHON) or workspace.unread(package):
        return
    modules = _modules(package, workspace)
    tops = modules.tops
    own, _, rest = name.partition(".")
    hint = "; add it, or remove the entry point"
    taken = _targets(package, workspace)  # no suggestion makes two programs the same

    def meant(candidates: Iterable[str]) -> list[str]:
        # Modules in folders that are not Python packages are no suggestions, because setup.py does not install them.
        return [
            module
            for module in candidates
            if taken.isdisjoint((module, f"{module}:{function}")) and _is_in_package(module, name, script, package.files)
        ]

    similar = names.similar_names(name, modules.all, _MOST_SIMILAR, 0.9)
    near = [module for module in meant(similar) if _is_slip(name, module)][:1]
    if own not in tops and own != package.name and not names.similar_names(own, [*tops, package.name], 1, 0.85):
        # In a copied package, entry points may still have the old package name before an existing module.
        near = meant(modules.by_rest.get(rest, ()))
        if not _lacks(workspace, own, name) and (not near or workspace.world.by_import(own).known):
            return
    if near:
        hint = names.ask_if_meant(near)
    elif unusable := names.similar_names(f"{name.replace('.', '/')}.py", modules.not_importable, 1, 0.9):
        hint = f"; Python cannot import '{unusable[0]}' because of its name: rename it to {name.rpartition('.')[2]}.py"
    fix = _fix(entry, name, near[0] if near else "")
    yield Finding(f"entry point '{entry.name}': module '{name}' does not exist{hint}", entry.span, entry.name, fix=fix)


def _is_slip(name: str, module: str) -> bool:
    """Return whether ``name`` is a plausible typo of ``module``: the words in which the two names differ resemble each other."""
    in_name, in_module = set(_WORDS.split(name)), set(_WORDS.split(module))
    only_in_name, only_in_module = " ".join(sorted(in_name - in_module)), " ".join(sorted(in_module - in_name))
    return not only_in_name or not only_in_module or bool(names.similar_names(only_in_name, [only_in_module]))


_WORDS = re.compile(r"[._]")


def _is_in_package(module: str, wanted: str, script: BuildScript, files: Sequence[str]) -> bool:
    """Return whether ``module`` is in the same folder as the module ``wanted``, or in the folder of a Python package."""
    above = module.rpartition(".")[0]
    if above == wanted.rpartition(".")[0] or above in script.products.python_packages:
        return True
    return f"{above.replace('.', '/')}/__init__.py" in files


def _lacks(workspace: Workspace, top: str, name: str) -> bool:
    """Return whether a fully analysed package of the workspace has the Python package ``top`` without the module ``name``."""
    owners = [package for package in workspace.packages if package.name == top and top in package.built.products.python_packages]
    path = name.replace(".", "/")
    return bool(owners) and not any(
        owner.hidden(Facet.PYTHON)
        or workspace.unread(owner)
        or name in owner.built.products.python_packages
        or any(f"/{file}".endswith((f"/{path}.py", f"/{path}/__init__.py")) for file in owner.files)
        for owner in owners
    )


def _fix(entry: EntryPoint, wrong: str, right: str) -> Fix | None:
    """Return the fix that replaces the module name ``wrong`` of an entry point by ``right``.

    None if ``right`` is "", or the entry point is not a string on one line.
    """
    inner = entry.span.inner(f"{entry.name} = {entry.target}")
    if not right or inner is None:
        return None
    start = inner.column + len(f"{entry.name} = ")
    return Fix(f"write '{right}'", (Edit(inner._replace(column=start, end_column=start + len(wrong)), right),), safe=False)


RULE = Rule(
    name="entry-point-target",
    code="ROS406",
    summary="entry points name functions that exist",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
