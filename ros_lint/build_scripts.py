"""What several rules about building and installing ask of a package's build script."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ros_lint.facts import Call, Facet, Opaque, Problem
from ros_lint.tree import join
from ros_lint.workspace import Package


def top_file(package: Package) -> str:
    """Return the path of the package's own CMakeLists.txt, relative to the base."""
    return join(package.path, "CMakeLists.txt")


def called(package: Package, *names: str, anywhere: bool = False) -> Iterator[Call]:
    """Yield the calls of commands in the package's own CMakeLists.txt, or ``anywhere`` in its CMake files, in order."""
    if package.script is None:
        return
    top = top_file(package)
    for call in package.script.written:
        if call.name in names and (anywhere or call.path == top):
            yield call


_UNDEFINED = re.compile(r"what the target [^:\s]+ is, is not known")


def hidden(package: Package, facet: Facet) -> tuple[Opaque, ...]:
    """Return what hides a facet, leaving out targets that are installed and that nobody defines: these are mistakes."""
    return tuple(opaque for opaque in package.hidden(facet) if not _UNDEFINED.fullmatch(opaque.reason))


def relative(package: Package, path: str) -> str:
    """Return a path relative to the package."""
    return path.removeprefix(f"{package.path}/") if package.path else path


_PROJECT_NAME = re.compile(r"\$\{(?:PROJECT_NAME|CMAKE_PROJECT_NAME)\}")


def evaluated_name(package: Package, text: str) -> str | None:
    """Return the name that an argument gives, None when it has variables other than that of the project's name."""
    name = _PROJECT_NAME.sub(package.script.name if package.script and package.script.name else package.name, text)
    return None if "$" in name or not name else name


_PATH = re.compile(r"(?:there is no folder |.*\(\) of )?([^\s,]+)")


def missing_path(problem: Problem) -> str:
    """Return the path that a problem about a missing file or folder names, relative to the package."""
    match = _PATH.match(problem.message)
    return match[1] if match else problem.message
