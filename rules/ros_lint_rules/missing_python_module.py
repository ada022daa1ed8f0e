"""
## What it finds

Python packages in the sources of an `ament_python` package that are not installed: a sub-package that a written list
`packages=[package_name]` leaves out, and the folder of an entry point, or one that its module imports from, that is
not listed, or that `find_packages()` passes over because it has no `__init__.py`. And programs of any package that
import a module which lies beside them in the sources, and not where they are installed; the module of an entry point
is installed in its Python package, and so must name this when it imports its neighbours. And the Python package of an
`ament_cmake` package, called as it is, of which nothing is installed: the confidence is high if it has a `setup.cfg`
for `ament_python_install_package()`, or another package of the workspace imports it, else medium.

## Why it matters

The import works in the source folder and with `colcon build --symlink-install`, and fails everywhere else with
ModuleNotFoundError. That of an entry point's neighbour works where its file is started by hand, and nowhere else.

## How to fix it

`packages=find_packages(exclude=['test'])`, or name the sub-package: `packages=[package_name, package_name + '.sub']`. The
fix adds it to the list. A folder without `__init__.py` needs one, too. For a program, make the module part of a Python package
(`ament_python_install_package()`), or install it beside the program. For a neighbour, `from package_name.module import name`.
In `CMakeLists.txt`: `ament_python_install_package(${PROJECT_NAME})`, which the fix adds.

## Limitations

For tests, for folders without modules, for those whose modules `data_files` puts elsewhere, and where `packages`
cannot be evaluated. Of a folder that only modules import from which no entry point names, the confidence is medium.
About what a program imports, where anybody else offers a module of that name; the confidence is medium where the
program changes `sys.path`, or a file of the package cannot be read. About the neighbours of an entry point's module,
where any module of the Python package changes `sys.path`. About the Python package of an `ament_cmake` package that
has a single module, and where the package makes interfaces, or builds what is imported by this name.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator
from itertools import chain
from typing import NamedTuple

from ros_lint.api import (
    BuildScript,
    Confidence,
    Facet,
    Finding,
    Fix,
    LeftBehind,
    Package,
    Related,
    Rule,
    Severity,
    Slot,
    Span,
    Workspace,
    beginning,
    cmake_edits,
    setup_edits,
    several,
)

_FIND = "find_package(ament_cmake_python REQUIRED)"
_APART = frozenset({"test", "tests", "testing", "launch", "doc", "docs", "example", "examples", "scripts", "resource", "build"})


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    yield from _beside_programs(package, workspace)
    yield from _of_cmake(package, workspace)
    script = package.script
    if script is None or package.builds_with != "ament_python" or package.hidden(Facet.PYTHON):
        return
    slot = setup_edits.slot(script, "packages")
    beside = {provided.source.rpartition("/")[0] for provided in script.provides if provided.source.endswith(".py")}
    told: set[str] = set()
    left = _left_behind(package, workspace)
    for lack in chain(_left_out(package, script, slot, beside), _of_entry_points(script), _imported(left, beside)):
        if lack.name not in told:
            told.add(lack.name)
            way = _way(package, lack.folder, lack.name, slot)
            yield Finding(
                f"{lack.says}{way}",
                lack.span,
                lack.name,
                fix=None if way else _fix(slot, lack.name, package.name),
                confidence=Confidence.HIGH if lack.sure else Confidence.MEDIUM,
            )


class _Lack(NamedTuple):
    """A Python package that setup.py does not install."""

    name: str
    folder: str
    says: str
    span: Span
    sure: bool = True


def _left_out(package: Package, script: BuildScript, slot: Slot | None, beside: Container[str]) -> Iterator[_Lack]:
    """Yield the packages below one that is installed. Modules ``beside`` others that data_files has are put elsewhere."""
    installed = script.python_packages
    place = slot.end if slot else (script.name_span or beginning(script.path))
    for name, folder in _packages(package):
        inside = name.rpartition(".")[0] in installed and f"{folder}/__init__.py" in package.files
        if inside and name not in installed and folder not in beside:
            yield _Lack(name, folder, f"the Python package {name} is not installed; add it to packages", place)


def _of_entry_points(script: BuildScript) -> Iterator[_Lack]:
    """Yield the packages with modules that entry points name."""
    for module in script.modules:
        inside = module.name.rpartition(".")[0]
        if inside and not {module.name, inside}.intersection(script.python_packages):
            entry = next(entry for entry in script.entry_points if entry.module == module.name)
            says = f"{entry.name} needs {module.path}, and {inside} is not among the packages that are installed"
            yield _Lack(inside, module.path.rpartition("/")[0], says, entry.span)


def _imported(left_behind: Iterable[LeftBehind], beside: Container[str]) -> Iterator[_Lack]:
    """Yield the packages that modules import which are installed."""
    for left in left_behind:
        folder, name = left.source.rstrip("/"), left.module
        if "." in name and folder not in beside:
            says = f"{left.program} imports what lies in {left.source}, and {name} is not among the packages that are installed"
            yield _Lack(name, folder, says, left.span, left.sure)


def _left_behind(package: Package, workspace: Workspace) -> Iterator[LeftBehind]:
    """Yield what is imported and not installed. A file that cannot be read may say where else modules are sought."""
    unread = workspace.unread(package)
    yield from (left._replace(sure=False) if unread else left for left in package.left_behind)


def _way(package: Package, folder: str, name: str, slot: Slot | None) -> str:
    """Return how a message goes on that says what makes a folder a Python package, "" if it is one."""
    if f"{folder}/__init__.py" in package.files:
        return ""
    return f"; add {folder}/__init__.py" + (f", and {name} to packages" if slot else "")  # find_packages() finds it by itself


def _beside_programs(package: Package, workspace: Workspace) -> Iterator[Finding]:
    """Speak of modules that are not installed where the program is that imports them."""
    if package.hidden(Facet.PYTHON | Facet.EXECUTABLES | Facet.SHARE):
        return
    own = {module.partition(".")[0] for module in package.built.python_packages}
    told: set[str] = set()
    for left in _left_behind(package, workspace):
        module = left.module
        if "." in module or module in own or workspace.world.by_import(module).known or left.source in told:
            continue
        told.add(left.source)
        place, slash, _ = left.program.rpartition("/")
        there = f"is not installed to {place}, where Python looks for it"
        if not slash:
            there = f"is installed as {left.program.rpartition('.')[0]}.{module}; import it by that name"
        yield Finding(
            f"{left.program} imports {module}, and {left.source} {there}",
            left.span,
            left.source,
            confidence=Confidence.HIGH if left.sure else Confidence.MEDIUM,
        )


def _of_cmake(package: Package, workspace: Workspace) -> Iterator[Finding]:
    """Speak of the Python package of an ament_cmake package that is not installed, nor any of its modules."""
    script = package.script
    hidden = package.hidden(Facet.PYTHON | Facet.EXECUTABLES | Facet.SHARE)
    if script is None or package.builds_with != "ament_cmake" or hidden or script.end is None:
        return
    if script.interfaces or any(module.partition(".")[0] == package.name for module in script.python_packages):
        return  # what is imported under this name is generated, or built
    files = frozenset(package.files)
    folder = next((f for f in (package.name, f"src/{package.name}") if f"{f}/__init__.py" in files), "")
    modules = [file for file in package.files if file.startswith(f"{folder}/") and file.endswith(".py")] if folder else []
    if len(modules) < 2 or not files.isdisjoint(p.source for p in script.provides if p.source.startswith(f"{folder}/")):
        return
    users = [
        (other, use)
        for other in workspace.packages
        for use in other.uses
        if use.via == "import" and use.package == package.name != other.name and not use.optional and use.sure
    ]
    why = f", and {users[0][0].name} imports it" if users else ""
    inner = "" if folder == package.name else f" PACKAGE_DIR {folder}"
    call = f"ament_python_install_package(${{PROJECT_NAME}}{inner})"
    yield Finding(
        f"the Python package {folder}/ is not installed{why}; add {call}",
        script.end,
        folder,
        several(Related("imported here", use.span) for _, use in users),
        Fix.of(f"install {folder}/", cmake_edits.at_end(script, f"{_FIND}\n{call}"), safe=False),
        Confidence.HIGH if users or f"{folder}/setup.cfg" in files else Confidence.MEDIUM,
        None if users else Severity.WARNING,
    )


def _packages(package: Package) -> Iterator[tuple[str, str]]:
    """Yield the folders with modules that may be Python packages, by dotted name."""
    folders = {file.rpartition("/")[0] for file in package.files if file.endswith(".py") and "/" in file}
    for folder in sorted(folders):
        parts = folder.removeprefix("src/").split("/")
        if all(part.isidentifier() for part in parts) and _APART.isdisjoint(parts):
            yield ".".join(parts), folder


def _fix(slot: Slot | None, name: str, package: str) -> Fix | None:
    if slot is None:
        return None
    inside = name.startswith(f"{package}.")
    element = setup_edits.joined(slot, package, "", name.removeprefix(package)) if inside else setup_edits.quoted(slot, name)
    return Fix(f"add {name} to packages", (setup_edits.add(slot, element),))


RULE = Rule(
    name="missing-python-module",
    code="ROS409",
    summary="every Python package of the sources must be installed",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
