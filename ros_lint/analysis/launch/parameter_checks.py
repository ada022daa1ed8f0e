"""Parameters in parameter files that do not fit the nodes which receive them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.analysis.launch.node_programs import NodeProgram, is_closed, node_program, words_of
from ros_lint.analysis.memo import cached_by_package, cached_by_workspace
from ros_lint.base.suggestions import similar_names
from ros_lint.collectors.launch.final_parameters import matches
from ros_lint.collectors.symbolic_text import is_node_renaming, is_plain
from ros_lint.facts.launch import walk_actions

if TYPE_CHECKING:
    from ros_lint.analysis.launch.parameter_files import NodeParameterFile
    from ros_lint.facts.sources import DeclaredParameter, FileParameter
    from ros_lint.workspace.model import Package, Workspace

_ANY = frozenset({"/**", "**"})


class WrongType(NamedTuple):
    """A parameter in a parameter file whose type differs from the type that the node declares."""

    passed: NodeParameterFile
    """The place where a launch file passes the parameter file to the node."""
    parameter: FileParameter
    """The parameter in the file."""
    declared: DeclaredParameter
    """The declaration in the code of the node."""
    node: str
    """Name of the node."""


class Undeclared(NamedTuple):
    """A parameter in a parameter file that the node which receives it does not declare."""

    passed: NodeParameterFile
    """The place where a launch file passes the parameter file to the node."""
    parameter: FileParameter
    """The parameter in the file."""
    node: str
    """Name of the node."""
    meant: str
    """A parameter of a similar name that the node declares and the file does not set, "" if there is none."""


def wrong_types(uses: Iterable[NodeParameterFile], workspace: Workspace) -> Iterator[WrongType]:
    """Yield the parameters in a file whose types differ from the declarations of the nodes that receive the file.

    ``uses`` are the places where launch files pass the file. Parameters that a launch file changes or sets again are left out.
    """
    for passed in uses:
        program = _program(passed, workspace)
        names = full_names(passed, program) if program is not None else ()
        if program is None or not names or passed.value.changes:
            continue
        declared = program.declared
        again = _set_again(passed)
        for parameter in passed.file.parameters:
            found = declared.get(parameter.name)
            if (
                found is not None
                and "" not in (found.type, parameter.type)
                and found.type != parameter.type
                and parameter.name not in again
                and all(parameter.node in _ANY or matches(parameter.node, name) for name in names)
            ):
                yield WrongType(passed, parameter, found, names[0])


def undeclared(uses: Sequence[NodeParameterFile], workspace: Workspace) -> Iterator[Undeclared]:
    """Yield the parameters in a file that no node which receives them declares.

    ``uses`` are all places where launch files of the workspace pass the file. Nothing is yielded about a node whose code is
    not in the workspace, or may declare parameters whose names are computed.
    """
    receivers: list[tuple[NodeParameterFile, NodeProgram, tuple[str, ...]]] = []
    for passed in uses:
        program = _program(passed, workspace)
        names = full_names(passed, program) if program is not None else ()
        if program is None or not names or not is_closed(program.package, workspace):
            return
        receivers.append((passed, program, names))
    for parameter in uses[0].file.parameters:
        own = [row for row in receivers if any(matches(parameter.node, name) for name in row[2])]
        if not own or is_of_every_node(parameter.name):
            continue
        words = [word for _, program, _ in own for word in words_of(program.package, workspace)]
        if parameter.name in words or parameter.name.rpartition(".")[2] in words:
            continue
        passed, program, names = own[0]
        given = {other.name for other in passed.file.parameters}
        near = similar_names(parameter.name, [name for name in program.declared if name not in given], 1, 0.8)
        yield Undeclared(passed, parameter, names[0], near[0] if near else "")


def is_of_every_node(name: str) -> bool:
    """Return whether rclcpp and rclpy themselves declare a parameter, or a library that any node may use."""
    return name in _OF_EVERY_NODE or name.startswith("qos_overrides.")


_OF_EVERY_NODE = frozenset({"use_sim_time", "start_type_description_service", "diagnostic_updater"})


def full_names(passed: NodeParameterFile, program: NodeProgram | None) -> tuple[str, ...]:
    """Return the possible full names of a node that receives a parameter file, () if they are unknown."""
    words = (text for _, value in passed.action.arguments for text in value.texts)
    names = passed.names or ((program.name,) if program is not None and program.name else ())
    if not names or "" in names or any(map(is_node_renaming, words)):
        return ()
    full = [f"/{space.strip('/')}/{name}".replace("//", "/") for space in passed.namespaces for name in names]
    return tuple(full) if all(map(is_plain, full)) else ()


def _program(passed: NodeParameterFile, workspace: Workspace) -> NodeProgram | None:
    """Return the program that receives a parameter file; None if it is unknown, is not in the workspace or has several nodes."""
    package, target = passed.action.package, passed.action.target
    if package is None or target is None or len(package.texts) != 1 or len(target.texts) != 1:
        return None
    program = node_program(workspace, package.texts[0], target.texts[0])
    return program if program is not None and program.name else None


def _set_again(passed: NodeParameterFile) -> frozenset[str]:
    """Return the names of the parameters that the action sets outside of the file."""
    return frozenset(name for name, _ in passed.action.parameters if name)


def unmatched_nodes(uses: Sequence[NodeParameterFile], workspace: Workspace) -> Iterator[str]:
    """Yield the node names in a file that no node of the workspace has.

    ``uses`` are all places where launch files of the workspace pass the file. Nothing is yielded if a program that receives
    the file is not in the workspace, because it may start nodes of other names.
    """
    if any(passed.value.changes or _program(passed, workspace) is None for passed in uses):
        return
    known = _names_of_nodes(workspace)
    for name, _ in uses[0].file.nodes:
        last = name.rpartition("/")[2]
        if "*" not in last and last not in known:
            yield name


@cached_by_workspace
def _names_of_nodes(workspace: Workspace) -> frozenset[str]:
    """Return all texts that may be names of nodes: those in launch files, and the string literals in code."""
    return frozenset().union(*[_names_in_package(package, workspace) for package in workspace.packages])


@cached_by_package
def _names_in_package(package: Package, _: Workspace) -> frozenset[str]:
    words = {word for code in package.node_code for word in (*code.words, *code.names)}
    for file in package.launch:
        for action in walk_actions(file.actions):
            words.update(action.name.texts if action.name is not None else ())
    return frozenset(words)
