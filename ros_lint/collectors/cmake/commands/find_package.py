"""Commands that name packages, such as find_package() and target_link_libraries()."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Final

from ros_lint.base.suggestions import shorten_list
from ros_lint.base.text import Span
from ros_lint.collectors.cmake.commands.include import include_of_package, include_own
from ros_lint.collectors.cmake.commands.include_directories import (
    ALL_TARGETS,
    PACKAGE_VARIABLE,
    record_header_sources,
    record_include_directories,
)
from ros_lint.collectors.cmake.evaluator.run import Handler, Run
from ros_lint.collectors.cmake.evaluator.values import ATOM, HOLE, OTHER_PACKAGE, TREE, is_known, mark_maybe, split, strip_mark
from ros_lint.collectors.cmake.released_macros import VISIBILITY
from ros_lint.collectors.cmake.syntax import QUOTED, UNQUOTED
from ros_lint.facts.sources import Purpose
from ros_lint.facts.visibility import ALL_FACETS, Facet, Problem

_NAMESPACED_TARGET = re.compile(r"(?<!\w)(?<!::)[A-Za-z_][\w.+-]*::[\w.+:-]*\w")


_SHARED_LIBRARIES: Final = frozenset({"ament_cmake_ros", "ament_cmake_ros_core"})
"""Packages that set BUILD_SHARED_LIBS to ON when they are found (ament_cmake_ros: build_shared_libs.cmake)."""
_BUILD_TOOL: Final = "ament_cmake"
_OF_ROS_1: Final = frozenset({"catkin", "roscpp"})
"""Packages of ROS 1 that scripts for both ROS versions search for. A build for ROS 2 does not find them."""
_FOUND_DECLARED: Final = f"{ATOM}found-build-depends"
"""The value that stands for all packages that ament_auto_find_build_dependencies() finds.

A target that is linked with this value does not certainly use any of these packages."""
_PYTHON: Final = frozenset({"Python", "Python3"})
"""Packages that find the Python interpreter, which always exists.

Their component Development finds headers and libraries, which need a dependency."""


def find_package(run: Run, args: list[str]) -> int | None:
    """Run ``find_package(name [version] [QUIET] [REQUIRED] ...)``: record that the package is mentioned and found."""
    name, certain = strip_mark(args[0]) if args else ("", True)
    if not is_known(name):
        run.open_world = True
        if _may_be_package_name(name):
            run.hide(Facet.USES, "the package of find_package() is unknown")
        return None
    if (run.get(f"{name}_DIR") or "").startswith(f"{TREE}/") and not run.muted:
        run.results.bundled_projects[name] = None  # the script sets X_DIR to a folder of the sources
    required = "REQUIRED" in args
    module = (
        run.packages.find_modules.get(name)
        if run.packages.find_modules and "CONFIG" not in args and "NO_MODULE" not in args
        else None
    )
    span = run.place_of(args[0]) if name else run.current_place()
    # A package can also pass the name to a helper.
    is_own_search = run.runs_own_code() or (run.runs_helper_code() and span != run.current_place())
    if name and module is None and is_own_search and not run.is_bundled(name):
        optional = not certain or ("QUIET" in args and not required)
        run.add_mention(name, "cmake", span, optional=optional)
        if name in _PYTHON and any(arg.startswith("Development") for arg in args):
            run.add_mention(f"{name}/Development", "cmake", span, f"find_package({name} ... Development)", optional=optional)
        if not required and not run.muted:
            run.packages.optional_finds.setdefault(name, []).append(span)
            if certain and "QUIET" in args and not run.conditional:
                run.packages.quiet_finds.add(span)
        if (
            name == run.paths.sources.name
            and required
            and certain
            and not (run.muted or run.uncertain_conditions or run.normal(f"{name}_DIR"))
        ):
            message = (
                f"find_package({name}) searches for this package itself, which is not installed yet; link its targets instead"
            )
            run.results.errors[Problem("no-package", message, span, subject=name)] = None
    mark_found(run, name, required=required and certain)
    if module is not None and all(frame.file != run.paths.absolute(module) for frame in run.frames):
        return include_own(run, module)
    return None


def _may_be_package_name(name: str) -> bool:
    """Return whether a partly known name may be the name of a ROS package: False if it has upper case (REP 144)."""
    return not any(letter.isupper() for letter in name)


def mark_found(run: Run, name: str, *, required: bool) -> None:
    """Record that a package is found. The variables of the package become unknown.

    If the package is in the workspace, its CMake code (CONFIG_EXTRAS) runs, too.
    """
    if name in _OF_ROS_1 and not required and name not in run.helpers:
        run.set(f"{name}_FOUND", "0")
        return
    # Scripts for several build tools test whether ament_cmake is found. It is, if package.xml declares it for the build.
    if required or (name == _BUILD_TOOL and name in run.paths.sources.build_depends):
        run.put(run.packages.certain, name, "1")
        if run.normal(f"{name}_FOUND") is not None:
            run.set(f"{name}_FOUND", "1")
    else:
        run.set(f"{name}_FOUND", HOLE)
    run.open_world = True
    run.packages.prefixes[name] = True
    if name in _SHARED_LIBRARIES and run.get("BUILD_SHARED_LIBS") is None:
        run.put(run.cache, "BUILD_SHARED_LIBS", "ON")
        run.settable.add("BUILD_SHARED_LIBS")
    helper = run.helpers.get(name)
    if helper is None or name == run.paths.sources.name:
        return
    run.set(f"{name}_DIR", f"{OTHER_PACKAGE}{name}/share/{name}/cmake")
    if name in run.packages.included:
        return
    run.put(run.packages.included, name, "1")
    for source in helper.script.exports.config_extras:
        if source in helper.sources.scripts:
            include_of_package(run, name, source)
        else:
            run.skipped_include = True
            run.hide(Facet.USES | Facet.EXPORTS, f"the CMake code of '{name}' was not found")


def _find_all(run: Run, args: list[str]) -> None:
    """Find the dependencies that package.xml declares for the build, or those for tests, as find_package() would.

    This is the command ``ros_lint_find(build|test)`` in ros_macros.cmake, which has ros-lint's models of ROS macros.
    """
    names = run.paths.sources.test_depends
    if args[:1] == ["build"]:
        names = run.paths.sources.build_depends
        run.set(f"{run.get('PROJECT_NAME') or ''}_FOUND_BUILD_DEPENDS", _FOUND_DECLARED)
    run.open_world = True
    run.packages.prefixes.update(dict.fromkeys(names, True))
    packages = run.packages.certain
    for name in names:
        if name not in packages:
            run.put(packages, name, "1")
        if name in run.helpers or name in _SHARED_LIBRARIES:
            mark_found(run, name, required=True)


_NO_PACKAGES: Final = VISIBILITY | {"SYSTEM"}
_PURPOSES: Final[Mapping[str, Purpose]] = {"-": "", "export": "export", "interfaces": "interfaces", "plugins": "plugins"}


def _packages_used(run: Run, args: list[str]) -> None:
    """Record that the evaluated package uses the packages ``names``, given the arguments ``purpose command names...``.

    The purpose is "export", "interfaces", "plugins", or "-" for none of these. The command is a text for messages, see
    :func:`_quotation`. The arguments are those of ``ros_lint_uses()`` in ros_macros.cmake, ros-lint's models of ROS macros.
    """
    purpose = _PURPOSES[args[0]]
    certainly: dict[str, Span] = {}
    for arg in args[2:]:
        name, certain = strip_mark(arg)
        if name in _NO_PACKAGES:
            continue
        if name == _FOUND_DECLARED and purpose == "interfaces":
            # Rosdep keys among the dependencies are not found.
            _packages_used(run, [*args[:2], *map(mark_maybe, run.paths.sources.build_depends)])
        if HOLE in name:
            if _may_be_package_name(name):
                exports = Facet.EXPORTS if purpose in ("export", "interfaces") else Facet(0)
                run.hide(Facet.USES | exports, "the name of a package is unknown")
        elif is_known(name) and not run.is_bundled(name):
            if certain:
                certainly[name] = run.place_of(arg)
            quotation = _quotation(args[1], name)
            run.add_mention(name, "target", run.place_of(arg), quotation, optional=not certain, purpose=purpose)
    if certainly and not (run.muted or run.uncertain_conditions):
        _note_impossible_packages(run, args[1].partition(" ")[0], certainly)


def _quotation(how: str, name: str) -> str:
    """Return a CMake command as text for messages, with the package ``name`` as its last argument.

    ``how`` is the command with its first arguments, or "-" for an empty result. Example: "ament_target_dependencies ..." and
    "rclcpp" give ``ament_target_dependencies(... rclcpp)``.
    """
    command, _, words = how.partition(" ")
    return "" if how == "-" else f"{command}({words} {name})".replace("( ", "(")


def _note_impossible_packages(run: Run, command: str, places: Mapping[str, Span]) -> None:
    """Record errors for the arguments that a command such as ament_target_dependencies() rejects as packages.

    These arguments are targets (``a::b``) and the package itself. ``places`` has the place of each argument.
    """
    targets = [name for name in places if "::" in name] if command.startswith("ament_") else []
    if targets:
        is_single = len(targets) == 1
        if command == "ament_target_dependencies":
            remedy = f"link {'it' if is_single else 'them'} with target_link_libraries()"
        else:
            remedy = "write the name of its package" if is_single else "write the names of their packages"
        detail = f"{shorten_list(targets)} {'is a target' if is_single else 'are targets'}; {remedy}"
        _add_error(run, command, detail, places[targets[0]], targets[0])
    own_name = run.paths.sources.name
    names_itself = own_name in places and command == "ament_target_dependencies"
    if names_itself and own_name not in run.packages.certain and run.normal(f"{own_name}_FOUND") is None:
        detail = f"'{own_name}' is this package; link its targets with target_link_libraries()"
        _add_error(run, command, detail, places[own_name], own_name)


def _add_error(run: Run, command: str, detail: str, span: Span, name: str) -> None:
    message = f"{command}() expects packages found by find_package(), but {detail}"
    run.results.errors[Problem("no-package", message, span, subject=name)] = None


def _target_uses(run: Run, args: list[str]) -> None:
    """Record that a target uses the packages ``names``, given the arguments ``how target names...``.

    ``how`` is the text of the command for messages, such as ``"ament_target_dependencies ..."``. The arguments are those of
    ``ros_lint_target_uses()`` in ros_macros.cmake, ros-lint's models of ROS macros.
    """
    _note_modified_target(run, args[0].partition(" ")[0], args[1:2])
    names = [name for name in args[2:] if name not in _NO_PACKAGES]
    record_header_sources(
        run, args[1] if len(args) > 1 else ALL_TARGETS, [name if HOLE in name else f"{name}::" for name in names]
    )
    _packages_used(run, ["-", args[0], *args[2:]])


def _note_modified_target(run: Run, command: str, args: list[str]) -> None:
    """Record that a command modifies a target.

    Nothing is recorded if the command may not run, or runs only if tests are enabled.
    """
    name, certain = strip_mark(args[0]) if args else ("", False)
    if certain and not (run.muted or run.uncertain_conditions or run.testing) and is_known(name) and "::" not in name:
        run.results.modified_targets.setdefault((name, command), run.current_place())


def _pkg_config(run: Run, args: list[str]) -> None:
    if not args or HOLE in args[0]:
        return
    run.open_world = True
    run.packages.prefixes.setdefault(args[0], False)
    run.set(f"{args[0]}_FOUND", "1" if "REQUIRED" in args else HOLE)


def link(run: Run, args: list[str]) -> None:
    """Record the packages whose targets or variables are arguments of a command such as target_link_libraries()."""
    for arg in args[1:]:
        if "::" not in arg:
            continue
        plain, certain = strip_mark(arg)
        for name in [plain] if is_known(plain) and "$" not in plain else _NAMESPACED_TARGET.findall(plain):
            space, _, target_name = name.partition("::")
            if (
                name in run.targets
                or space in (run.results.project.name, run.paths.sources.name)
                or _is_target_of(run, space, target_name)
            ):
                continue
            run.add_mention(name, "target", run.place_of(arg), optional=not certain)
    if not run.runs_own_code():
        return
    frame = run.frames[-1]
    command = frame.command
    if command is None:
        return
    for text, kind, start, end in command.args:
        if (kind != UNQUOTED and kind != QUOTED) or "_" not in text:  # noqa: PLR1714  (this is fast)
            continue
        for match in PACKAGE_VARIABLE.finditer(text):
            if match[1] in run.paths.sources.name or match[1] == "PROJECT_NAME":
                continue
            package = run.packages.with_prefix(match[1])
            if package and run.packages.prefixes[package]:  # False for pkg-config, where the script chooses the prefix
                place = command.span(frame.path, start, end) if frame.own else run.current_place()
                run.add_mention(package, "target", place, match[0])


def _target_include_directories(run: Run, args: list[str]) -> None:
    record_include_directories(run, args[0] if args else ALL_TARGETS, args[1:])
    _include_directories(run, args)


def _all_include_directories(run: Run, args: list[str]) -> None:
    record_include_directories(run, ALL_TARGETS, args)
    _include_directories(run, args)


def _include_directories(run: Run, args: list[str]) -> None:
    link(run, args)
    run.results.includes_outside_package = run.results.includes_outside_package or any(map(run.paths.is_outside_source, args))


def _link_all(run: Run, args: list[str]) -> None:
    """Run ``link_libraries(names...)``: record the packages of the libraries, because all later targets are linked to them."""
    record_header_sources(run, ALL_TARGETS, args)
    link(run, args)


def _is_target_of(run: Run, space: str, target_name: str) -> bool:
    """Return whether the target ``space::target_name`` has a known origin, so that it does not imply a package ``space``.

    The origin is the project ``space``, if the build of the package also builds this project (for example with FetchContent),
    or the package ``target_name``, if find_package() found this package but no package ``space``.
    """
    return run.is_bundled(space) or (space not in run.packages.prefixes and target_name in run.packages.prefixes)


_LINK_WORDS: Final = VISIBILITY | {"LINK_PRIVATE", "LINK_PUBLIC", "LINK_INTERFACE_LIBRARIES", "debug", "optimized", "general"}


def _link_libraries(run: Run, args: list[str]) -> None:
    """Run ``target_link_libraries(target [PRIVATE|PUBLIC|INTERFACE] names...)``: record the libraries of the target."""
    link(run, args)
    record_header_sources(run, args[0] if args else ALL_TARGETS, [arg for arg in args[1:] if arg not in _LINK_WORDS])
    _note_modified_target(run, "target_link_libraries", args)
    if run.muted or not args or run.uncertain_conditions or (run.testing and "TEST" not in run.targets.get(args[0], ())):
        return
    span = run.current_place()
    links = run.results.links.setdefault(args[0], {})
    for arg in args[1:]:
        links.setdefault(arg, span)


def _hide(run: Run, args: list[str]) -> None:
    """Record which facts about the package are incomplete, and why, given the arguments ``facets reason``.

    ``facets`` has the names of kinds of facts (``Facet``), such as EXECUTABLES; ANYTHING means all. The arguments are those of
    ``ros_lint_hide()`` in ros_macros.cmake, ros-lint's models of ROS macros.
    """
    facet = Facet(0)
    for name in split(args[0]):
        facet |= ALL_FACETS if name == "ANYTHING" else Facet[name]
    run.hide(facet, args[1])


COMMANDS: Final[dict[str, Handler]] = {
    "find_package": find_package,
    "find_dependency": find_package,
    "pkg_check_modules": _pkg_config,
    "pkg_search_module": _pkg_config,
    "target_link_libraries": _link_libraries,
    "target_include_directories": _target_include_directories,
    "include_directories": _all_include_directories,
    "link_libraries": _link_all,
    "ros_lint_find": _find_all,
    "ros_lint_uses": _packages_used,
    "ros_lint_target_uses": _target_uses,
    "ros_lint_hide": _hide,
}
