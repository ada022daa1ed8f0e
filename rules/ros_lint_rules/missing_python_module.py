"""
## What it finds

Python modules that are in the sources but not installed where they are imported.

In an `ament_python` package:

- A sub-package that the list `packages=[package_name]` omits.
- A folder with the module of an entry point, or with a module that an installed module imports, if the list `packages` omits
  the folder, or `find_packages()` omits it because it has no `__init__.py`.
- A module of an entry point that imports a neighbouring module by its bare name. Both modules are installed in a Python
  package, so the import needs the name of that Python package.

In any package:

- A program that imports a module next to it in the sources, if the module is not installed next to the program.

In an `ament_cmake` package:

- A Python package with the name of the package, if nothing of it is installed. The confidence is high if it has a `setup.cfg` for
  `ament_python_install_package()` or another workspace package imports it, otherwise medium.

One rule reports all of them, because each import fails for the same reason: the module is not installed where Python looks for
it.

## Why it matters

The import works in the source folder and after `colcon build --symlink-install`, but fails everywhere else with
ModuleNotFoundError. The bare import of a neighbouring module works only if the file is started by hand.

## How to fix it

- Write `packages=find_packages(exclude=['test'])`, or list the sub-package: `packages=[package_name, package_name + '.sub']`. The
  fix extends the list. Add a missing `__init__.py` yourself.
- For a program, make the module part of a Python package (`ament_python_install_package()`), or install it next to the program.
- For a neighbouring module, write `from package_name.module import name`.
- In `CMakeLists.txt`, call `ament_python_install_package(${PROJECT_NAME})`. The fix adds this.

## Limitations

Not reported:

- Tests, folders without modules, and modules that `data_files` installs elsewhere.
- Lists in `packages` that cannot be evaluated.
- Imports of programs, if another package or library provides a module of that name.
- Neighbouring modules of an entry point, if a module of the Python package changes `sys.path`.
- The Python package of an `ament_cmake` package, if it has a single module, or if the package generates interfaces or builds a
  module of that name.

Reported with medium confidence:

- Folders that are imported only by modules without an entry point.
- Imports of programs that change `sys.path`.
- Imports, if a file of the package cannot be read.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator
from itertools import chain
from typing import NamedTuple

from ros_lint.api import (
    BuildScript,
    Confidence,
    EditableList,
    Facet,
    Finding,
    Fix,
    Package,
    Related,
    Rule,
    Severity,
    Span,
    UninstalledImport,
    Workspace,
    edits,
    files,
    first_related,
)

_FIND = "find_package(ament_cmake_python REQUIRED)"
_APART = frozenset({"test", "tests", "testing", "launch", "doc", "docs", "example", "examples", "scripts", "resource", "build"})


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    yield from _beside_programs(package, workspace)
    yield from _of_cmake(package, workspace)
    script = package.script
    if script is None or package.builds_with != "ament_python" or package.hidden(Facet.PYTHON):
        return
    slot = edits.setup_py.slot(script, "packages")
    as_data = {provided.source.rpartition("/")[0] for provided in script.products.installs if provided.source.endswith(".py")}
    reported: set[str] = set()
    imports = _uninstalled_imports(package, workspace)
    for lack in chain(_unlisted(package, script, slot, as_data), _of_entry_points(script), _imported(imports, as_data)):
        if lack.name not in reported:
            reported.add(lack.name)
            remedy = _remedy(package, lack.folder, lack.name, slot)
            yield Finding(
                f"{lack.message}{remedy or _TO_LIST}",
                lack.span,
                lack.name,
                fix=None if remedy else _fix(slot, lack.name, package.name),
                confidence=Confidence.HIGH if lack.sure else Confidence.MEDIUM,
            )


_TO_LIST = "; add it to the option 'packages' of setup()"
"""The remedy for a folder with an __init__.py that setup.py does not install."""


class _Lack(NamedTuple):
    """A Python package that setup.py does not install, and what the finding about it says."""

    name: str
    folder: str
    message: str
    span: Span
    sure: bool = True


def _unlisted(package: Package, script: BuildScript, slot: EditableList | None, as_data: Container[str]) -> Iterator[_Lack]:
    """Yield the sub-packages that setup.py does not install, although it installs the Python package around them.

    Left out are the folders ``as_data``, whose Python files are installed as data.
    """
    installed = script.products.python_packages
    place = slot.end if slot else (script.project.name_span or files.file_start(script.path))
    for name, folder in _packages(package):
        inside = name.rpartition(".")[0] in installed and f"{folder}/__init__.py" in package.files
        if inside and name not in installed and folder not in as_data:
            message = f"the Python package '{name}' is not installed"
            yield _Lack(name, folder, message, place)


def _of_entry_points(script: BuildScript) -> Iterator[_Lack]:
    """Yield the Python packages that setup.py does not install, although they contain modules of entry points."""
    for module in script.python.entry_point_modules:
        inside = module.name.rpartition(".")[0]
        if inside and not {module.name, inside}.intersection(script.products.python_packages):
            entry = next(entry for entry in script.products.entry_points if entry.module == module.name)
            message = f"entry point '{entry.name}' needs '{module.path}', but the package '{inside}' is not installed"
            yield _Lack(inside, module.path.rpartition("/")[0], message, entry.span)


def _imported(imports: Iterable[UninstalledImport], as_data: Container[str]) -> Iterator[_Lack]:
    """Yield the Python sub-packages of ``imports`` that setup.py does not install, although installed modules import them.

    Left out are the folders ``as_data``, whose Python files are installed as data.
    """
    for item in imports:
        folder, name = item.source.rstrip("/"), item.module
        if "." in name and folder not in as_data:
            message = f"'{item.program}' imports from '{item.source}', but the package '{name}' is not installed"
            yield _Lack(name, folder, message, item.span, item.sure)


def _uninstalled_imports(package: Package, workspace: Workspace) -> Iterator[UninstalledImport]:
    """Yield the imports of modules that are not installed. All are uncertain if an unreadable file may change sys.path."""
    unread = workspace.unread(package)
    yield from (item._replace(sure=False) if unread else item for item in package.uninstalled_imports)


def _remedy(package: Package, folder: str, name: str, slot: EditableList | None) -> str:
    """Return the end of the message that says how to make ``folder`` a Python package; "" if it has an ``__init__.py``."""
    if f"{folder}/__init__.py" in package.files:
        return ""
    return f"; add {folder}/__init__.py" + (
        f" and add '{name}' to the option 'packages' of setup()" if slot else ""
    )  # find_packages() finds the folder then


def _beside_programs(package: Package, workspace: Workspace) -> Iterator[Finding]:
    """Yield findings for modules that are not installed next to the program that imports them."""
    if package.hidden(Facet.PYTHON | Facet.EXECUTABLES | Facet.SHARE):
        return
    own = {module.partition(".")[0] for module in package.built.products.python_packages}
    reported: set[str] = set()
    for item in _uninstalled_imports(package, workspace):
        module = item.module
        if "." in module or module in own or workspace.world.by_import(module).known or item.source in reported:
            continue
        reported.add(item.source)
        place, slash, _ = item.program.rpartition("/")
        why = f"is not installed to {place}, where Python looks for it; install it there"
        if not slash:
            why = f"is installed as '{item.program.rpartition('.')[0]}.{module}'; import it by that name"
        yield Finding(
            f"'{item.program}' imports '{module}', but '{item.source}' {why}",
            item.span,
            item.source,
            confidence=Confidence.HIGH if item.sure else Confidence.MEDIUM,
        )


def _of_cmake(package: Package, workspace: Workspace) -> Iterator[Finding]:
    """Yield a finding if an ament_cmake package has a Python package with its own name, but installs none of the modules."""
    script = package.script
    hidden = package.hidden(Facet.PYTHON | Facet.EXECUTABLES | Facet.SHARE)
    if script is None or package.builds_with != "ament_cmake" or hidden or script.commands.insertion is None:
        return
    if script.products.interfaces or any(module.partition(".")[0] == package.name for module in script.products.python_packages):
        return  # the module of this name is generated or built
    paths = frozenset(package.files)
    folder = next((f for f in (package.name, f"src/{package.name}") if f"{f}/__init__.py" in paths), "")
    modules = [file for file in package.files if file.startswith(f"{folder}/") and file.endswith(".py")] if folder else []
    if len(modules) < 2 or not paths.isdisjoint(p.source for p in script.products.installs if p.source.startswith(f"{folder}/")):
        return
    users = [
        (other, use)
        for other in workspace.packages
        for use in other.uses
        if use.via == "import" and use.package == package.name != other.name and not use.optional and use.certain
    ]
    why = f", but '{users[0][0].name}' imports it" if users else ""
    inner = "" if folder == package.name else f" PACKAGE_DIR {folder}"
    call = f"ament_python_install_package(${{PROJECT_NAME}}{inner})"
    yield Finding(
        f"the Python package '{folder}/' is not installed{why}; add {call}",
        script.commands.insertion,
        folder,
        first_related(Related(f"'{package.name}' is imported by '{other.name}' here", use.span) for other, use in users),
        Fix.of(f"install '{folder}/'", edits.cmake.at_end(script, f"{_FIND}\n{call}"), safe=False),
        Confidence.HIGH if users or f"{folder}/setup.cfg" in paths else Confidence.MEDIUM,
        None if users else Severity.WARNING,
    )


def _packages(package: Package) -> Iterator[tuple[str, str]]:
    """Yield the folders of modules that may be Python packages: the dotted name and the path (``robot.sub``, ``robot/sub``)."""
    folders = {file.rpartition("/")[0] for file in package.files if file.endswith(".py") and "/" in file}
    for folder in sorted(folders):
        parts = folder.removeprefix("src/").split("/")
        if all(part.isidentifier() for part in parts) and _APART.isdisjoint(parts):
            yield ".".join(parts), folder


def _fix(slot: EditableList | None, name: str, package: str) -> Fix | None:
    if slot is None:
        return None
    inside = name.startswith(f"{package}.")
    element = (
        edits.setup_py.joined(slot, package, "", name.removeprefix(package)) if inside else edits.setup_py.quoted(slot, name)
    )
    return Fix(f"add '{name}' to the option 'packages' of setup()", (edits.setup_py.add(slot, element),))


RULE = Rule(
    name="missing-python-module",
    code="ROS409",
    summary="all Python packages in the sources are installed",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
