"""Targets and programs of a build script: whether they are built, installed and run."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence

from ros_lint.analysis.build.commands import evaluated_name, opaque_except_undefined_targets
from ros_lint.analysis.memo import cached_by_package
from ros_lint.base.auxiliary_files import is_auxiliary
from ros_lint.collectors.suffixes import HEADERS
from ros_lint.facts.build import BuildScript, InstalledFile
from ros_lint.facts.cmake import BuildTarget, Call
from ros_lint.facts.sources import Registration
from ros_lint.facts.visibility import Facet
from ros_lint.workspace.model import Package, Workspace


def programs_built(script: BuildScript) -> Iterator[BuildTarget]:
    """Yield the executable targets of a build script, without targets for tests.

    A target is for tests if it is only built for tests, or if its name contains "test".
    """
    for target in script.products.targets:
        if target.kind == "executable" and not target.test and "test" not in target.name:
            yield target


def is_optional_target(package: Package, target: BuildTarget) -> bool:
    """Return whether only some builds compile the sources of a target, or whether the target belongs to examples or tests."""
    conditional = bool(target.sources) and set(target.sources) == set(target.optional_sources)
    return conditional or is_auxiliary(package.relative(target.span.path))


def installed_to_bin_only(package: Package, name: str) -> bool:
    """Return whether CMake builds a program called ``name``, or whether a Python package installs ``bin/<name>``.

    Callers have checked that ``lib/<package>`` does not contain the program. If the result is True, another rule reports
    the program.
    """
    script = package.script
    if script is None:
        return False
    if package.builds_with == "ament_cmake":
        return any(target.name == name for target in programs_built(script))
    return any(provided.path == f"bin/{name}" for provided in script.products.installs)


_CLIENTS = frozenset({"rclcpp", "rclcpp_lifecycle", "rclcpp_action", "rclcpp_components"})


_RUNS = frozenset({"add_custom_command", "add_custom_target"})


def may_run_built(script: BuildScript) -> bool:
    """Return whether a custom command of the build may run a program that the package builds.

    The custom commands that rosidl generates for interfaces do not count.
    """
    calls = (
        [call.name for call in script.commands.calls]
        if "rosidl_generate_interfaces" in script.commands.names
        else script.commands.names
    )
    return not _RUNS.isdisjoint(calls)


def files_using_client_library(package: Package) -> frozenset[str]:
    """Return the C++ files that include rclcpp or a library that extends it. Paths are relative to the package."""
    return frozenset(package.relative(use.span.path) for use in package.uses if use.via == "include" and use.package in _CLIENTS)


def node_targets(package: Package) -> frozenset[str]:
    """Return the names of the executables that are nodes: one of their files includes rclcpp or a library that extends it.

    The files of an executable are its sources, and each header of the package with the file stem of a source.
    """
    files = files_using_client_library(package)
    return frozenset(
        target.name
        for target in package.built.products.targets
        if target.kind == "executable" and (not files.isdisjoint(target.sources) or has_header(target, files))
    )


def has_header(target: BuildTarget, files: Iterable[str]) -> bool:
    """Return whether one of the files is a header with the file stem of a source of the target: ``node.hpp`` for ``node.cpp``."""
    stems = {stem(source) for source in target.sources}
    return any(file.endswith(HEADERS) and stem(file) in stems for file in files)


def stem(path: str) -> str:
    """Return the name of a file without its folder and without everything from the first dot: ``src/a.b.cpp`` -> ``a``."""
    return path.rpartition("/")[2].partition(".")[0]


@cached_by_package
def library_calls(package: Package, _: Workspace) -> Mapping[str, Sequence[Call]]:
    """Return the calls of add_library() and ament_auto_add_library(), in order, by the name of the library that they create."""
    calls: dict[str, list[Call]] = {}
    for call in package.calls("add_library", "ament_auto_add_library", anywhere=True):
        if call.args and (name := evaluated_name(package, call.texts[0])):
            calls.setdefault(name, []).append(call)
    return calls


def is_declared_shared(package: Package, workspace: Workspace, name: str) -> bool:
    """Return whether an unconditional command that creates the library ``name`` contains SHARED or MODULE."""
    calls = library_calls(package, workspace).get(name, ())
    return any(not call.blocks and not {"SHARED", "MODULE"}.isdisjoint(call.texts) for call in calls)


def library_registering(package: Package, registration: Registration) -> str:
    """Return the name of the library target whose sources register a class, "" if no library compiles the source.

    Libraries that are only built for tests do not count.
    """
    path = package.relative(registration.span.path)
    for target in package.built.products.targets:
        if target.kind == "library" and not target.test and path in target.sources:
            return target.name
    return ""


def installs_built(script: BuildScript) -> bool:
    """Return whether the package may install a program or library that it builds.

    Libraries that rosidl generates do not count.
    """
    built = (
        provided.path for provided in script.products.installs if provided.target or provided.path.startswith(("lib/", "bin/"))
    )
    return not all(_GENERATED in path for path in built)


_GENERATED = "__rosidl_"
"""Part of the names of all libraries that rosidl generates, and of no others."""


def install_arguments(package: Package) -> frozenset[str]:
    """Return the arguments of all calls of install(). A target that is not among them is not installed."""
    texts = {text for call in package.calls("install", anywhere=True) for text in call.texts}
    return frozenset([name for text in texts if (name := evaluated_name(package, text))])


def libraries_elsewhere(package: Package, endings: tuple[str, ...]) -> dict[str, InstalledFile]:
    """Return the libraries that every build installs only into ``lib/<package>`` or outside of ``lib``.

    The keys are the names of the targets, the values are the first installed file of each target. Only installed files
    with one of the endings, such as ".so", count.
    """
    places: dict[str, list[InstalledFile]] = {}
    for provided in package.built.products.installs:
        if provided.target and provided.path.endswith(endings):
            places.setdefault(provided.target, []).append(provided)
    program_folder = f"lib/{package.name}/"
    return {
        name: files[0]
        for name, files in places.items()
        if all(
            (place.path.startswith(program_folder) or not place.path.startswith("lib/")) and not (place.conditional or place.test)
            for place in files
        )
    }


def never_installed_nodes(package: Package) -> frozenset[str]:
    """Return the names of the node executables of a package that installs none of its programs and libraries.

    The result is empty if a custom command may run a program during the build, because that program needs no installation,
    or if the installation cannot be fully analysed.
    """
    script = package.script
    if (
        script is None
        or opaque_except_undefined_targets(package, Facet.EXECUTABLES)
        or installs_built(script)
        or may_run_built(script)
    ):
        return frozenset()
    return node_targets(package).intersection(target.name for target in programs_built(script))


def partly_installed_nodes(package: Package) -> frozenset[str]:
    """Return the names of the node executables that are not installed although another node of the package is installed.

    Left out are:
    - tests, examples and benchmarks, by the name of the target or the folder of a source,
    - nodes that are built under a condition,
    - all nodes if a custom command may run a program during the build.
    """
    script = package.script
    if script is None or opaque_except_undefined_targets(package, Facet.EXECUTABLES) or may_run_built(script):
        return frozenset()
    nodes = node_targets(package)
    installed = {provided.target for provided in script.products.installs if provided.target}
    if nodes.isdisjoint(installed):
        return frozenset()
    left_out = nodes - installed - install_arguments(package)
    return frozenset(
        target.name
        for target in programs_built(script)
        if target.name in left_out and not is_optional_target(package, target) and not _is_aside(target)
    )


_ASIDE = re.compile(r"(?:^|_)(?:bench\w*|demo|dummy|example|mock|perf\w*|sample|try|tutorial)s?(?:_|$)|test", re.IGNORECASE)


def _is_aside(target: BuildTarget) -> bool:
    return bool(_ASIDE.search(target.name)) or any(is_auxiliary(source) for source in target.sources)
