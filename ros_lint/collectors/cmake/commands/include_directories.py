"""The packages whose headers a target can include, determined by its linked libraries and include directories.

Conditional arguments count, too. Therefore, a package that is not in the result provides no headers to the target in any
build.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from ros_lint.collectors.cmake.evaluator.found_packages import folded
from ros_lint.collectors.cmake.evaluator.values import ATOM, HOLE, MAYBE, TREE, elements
from ros_lint.collectors.cmake.released_macros import VISIBILITY
from ros_lint.collectors.cmake.syntax import QUOTED, UNQUOTED

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from ros_lint.collectors.cmake.evaluator.run import Handler, Run
    from ros_lint.collectors.cmake.evaluator.state import Properties

PACKAGE_VARIABLE: Final = re.compile(
    r"\$\{([A-Za-z0-9_+.-]+?)_(?:TARGETS|LIBRARIES|LIBRARY|LIBS|INCLUDE_DIRS?|INCLUDES|DEFINITIONS|LDFLAGS|CFLAGS)\}"
)
"""Pattern of a reference to a variable of a found package, such as ``${foo_LIBRARIES}``. Group 1 is the package name."""

ALL_TARGETS: Final = ""
"""The key, instead of a target name, for arguments of include_directories() and link_libraries() (for all targets)."""

_ANYTHING: Final = HOLE
_NAME = re.compile(r"(?<![\w./+\1-])[A-Za-z_][\w.+-]*(?:::[\w.+-]+)*(?![\w./+:-])")
_NO_ROS_HEADERS: Final = (TREE, f"/{ATOM}build", f"/{ATOM}prefix", "/usr/")
"""Starts of the paths of folders that have no headers of other ROS packages."""


def record_header_sources(run: Run, target: str, args: Iterable[str]) -> None:
    """Record where a target gets headers from: ``args`` are targets, libraries and paths, already evaluated.

    For an argument with an unknown value, the packages of its variables are recorded: ``${foo_LIBRARIES}`` as ``foo::``.
    """
    header_sources = run.results.headers.setdefault(target, {})
    is_complete = True
    for arg in args:
        if _PLAIN.match(arg):  # by far the most frequent case
            header_sources[arg] = None
            continue
        is_complete = is_complete and HOLE not in arg
        for element in elements(arg):
            header_sources.update(dict.fromkeys(_names(run, element.lstrip(MAYBE))))
    if not is_complete:
        header_sources.update(dict.fromkeys(_packages_of_variables(run)))


_PLAIN = re.compile(r"\w[\w:.+-]*\Z")


def record_include_directories(run: Run, target: str, args: Iterable[str]) -> None:
    """Record that a target has the include directories ``args``, which are evaluated arguments of a command."""
    folders = (arg for arg in args if arg not in _NO_FOLDERS and not arg.startswith("$<INSTALL_INTERFACE:"))
    directory = run.path_variables["CMAKE_CURRENT_SOURCE_DIR"]
    record_header_sources(run, target, [f"{directory}/{folder}" if _RELATIVE.match(folder) else folder for folder in folders])


_NO_FOLDERS: Final = VISIBILITY | {"BEFORE", "AFTER", "SYSTEM"}
_RELATIVE = re.compile(r"[\w.]")


def _names(run: Run, arg: str) -> tuple[str, ...]:
    if HOLE in arg:
        return ()
    if "$<" in arg:
        return (_ANYTHING,) if "TARGET_PROPERTY" in arg else tuple(_NAME.findall(arg))
    if arg.startswith("/") or ATOM in arg:
        return () if arg.startswith(_NO_ROS_HEADERS) and not run.paths.is_outside_source(arg) else (_ANYTHING,)
    return (_ANYTHING,) if run.paths.is_outside_source(arg) else (arg,)


def _packages_of_variables(run: Run) -> list[str]:
    """Return the packages whose variables the current command uses: ``${foo_LIBRARIES}`` -> ``foo::``.

    The result contains HOLE, which means any package, if another part of an argument is unknown.
    """
    command = run.frames[-1].command
    names: list[str] = []
    for text, kind, _, _ in command.args if command is not None else ():
        if kind in (UNQUOTED, QUOTED) and HOLE in run.evaluate(text):
            names += [_package(run, match) for match in PACKAGE_VARIABLE.finditer(text)]
            if HOLE in run.evaluate(PACKAGE_VARIABLE.sub("", text)):
                names.append(_ANYTHING)
    return names or [_ANYTHING]


def _package(run: Run, variable: re.Match[str]) -> str:
    """Return ``foo::`` for a reference ``${foo_LIBRARIES}`` to a variable of a found package ``foo``.

    The result is HOLE, which means any package, if no found package has the prefix of the variable, or if the script itself
    sets the variable.
    """
    name = run.packages.with_prefix(variable[1]) if run.normal(variable[0][2:-1]) is None else ""
    return f"{name}::" if name else _ANYTHING


def _headers_of(run: Run, args: list[str]) -> None:
    """Run ``ros_lint_headers_of(target names...)``: record that a target has the include directories of packages."""
    record_header_sources(run, args[0], args[1:])


def _compiler_options(run: Run, args: list[str]) -> None:
    """Record unknown include directories for all targets if an argument is a compiler option such as -I or -isystem."""
    if any(_FOLDER_OPTION.search(arg) for arg in args):
        record_header_sources(run, ALL_TARGETS, [f"/{ATOM}"])


_FOLDER_OPTION = re.compile(r"(?:\A|[\s:;])-(?:I|isystem|include)")
_FLAGS: Final = ("CMAKE_CXX_FLAGS", "CMAKE_C_FLAGS", "CMAKE_CXX_STANDARD_INCLUDE_DIRECTORIES")
_PROPERTIES: Final = frozenset(
    {
        "COMPILE_FLAGS", "COMPILE_OPTIONS", "INCLUDE_DIRECTORIES", "INTERFACE_INCLUDE_DIRECTORIES", "INTERFACE_LINK_LIBRARIES",
        "LINK_LIBRARIES",
    }
)  # fmt: skip


def are_in_flags(run: Run) -> bool:
    """Return whether a variable such as CMAKE_CXX_FLAGS adds include directories (-I, -isystem) to all targets."""
    return any(_FOLDER_OPTION.search(run.get(flags) or "") for flags in _FLAGS)


_MOST_LINKED: Final = 200
"""Maximum number of targets that are followed from one target, directly or transitively."""


def visible_headers(run: Run, name: str, targets: Mapping[str, Properties]) -> tuple[str, ...] | None:
    """Return the names of the packages (and libraries) whose headers the target ``name`` may include, sorted.

    The result is None if the target may include headers of any package, or if more than ``_MOST_LINKED`` targets are linked.
    """
    packages: dict[str, None] = {}
    pending = [name, ALL_TARGETS]
    visited: set[str] = set()
    interfaces = f"{run.paths.sources.name}__"  # prefix of the targets of generated interfaces
    while pending:
        current = pending.pop()
        if current in visited:
            continue
        if len(visited) == _MOST_LINKED:
            return None
        visited.add(current)
        target = targets.get(current)
        if target is not None:
            if target["KIND"] == "imported" or not _PROPERTIES.isdisjoint(target):
                return None
            if target["KIND"] == "alias":
                pending.append(target["ALIASED"])
        elif current not in (name, ALL_TARGETS) and not current.startswith(interfaces):
            owners = _owners(run, current)
            if not owners:
                return None
            packages.update(dict.fromkeys(owners))
        pending += run.results.headers.get(current, ())
        if _ANYTHING in pending:
            return None
    return tuple(sorted(packages))


def _owners(run: Run, name: str) -> tuple[str, ...]:
    """Return the packages to which an imported target or a library may belong; () if it may belong to any package.

    For example, ``BT::behaviortree_cpp`` may belong to behaviortree_cpp.
    """
    space, sign, target_name = name.partition("::")
    if not sign or not target_name:
        return (space,)
    if space in run.packages.prefixes:
        return (space,)
    if target_name in run.packages.prefixes:
        return (space, target_name)
    letters = folded(space)
    return (space,) if any(folded(prefix).startswith(letters) for prefix in run.packages.prefixes) else ()


COMMANDS: Final[Mapping[str, Handler]] = {
    "ros_lint_headers_of": _headers_of,
    "add_compile_options": _compiler_options,
    "add_definitions": _compiler_options,
    "target_compile_options": _compiler_options,
}
