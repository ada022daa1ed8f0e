"""Parameters in parameter files that do not fit the nodes which receive them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.analysis.launch.includes import assigned_configurations, substitute
from ros_lint.analysis.launch.node_programs import NodeProgram, is_closed, started_program, words_of
from ros_lint.analysis.memo import cached_by_package, cached_by_workspace
from ros_lint.base.suggestions import similar_names
from ros_lint.collectors.launch.final_parameters import full_name, matches
from ros_lint.collectors.symbolic_text import is_node_renaming, is_plain, is_settled
from ros_lint.facts.launch import walk_actions
from ros_lint.facts.sources import ANY_PART

if TYPE_CHECKING:
    from ros_lint.analysis.launch.parameter_files import NodeParameterFile
    from ros_lint.facts.sources import DeclaredParameter, FileParameter, ParameterType
    from ros_lint.workspace.model import Package, Workspace


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

    ``uses`` are the places where launch files pass the file. Left out are parameters that may be overridden, in the file or after
    it, and files that a launch file changes.
    """
    for passed in uses:
        program, names = _receiver(passed, workspace)
        if program is None or not names or passed.value.changes or _is_followed_by_a_file(passed):
            continue
        again = _set_again(passed)
        rows: dict[str, list[FileParameter]] = {}
        for parameter in passed.file.parameters:
            if parameter.name not in again and any(matches(parameter.node, name) for name in names):
                rows.setdefault(parameter.name, []).append(parameter)
        declared = program.declared
        patterns = _patterns(declared)
        for name, parameters in rows.items():
            found = declared.get(name) or next((declared[key] for key in patterns if _fits(name, key)), None)
            if found is None or not all(_differ(parameter.type, found.type) for parameter in parameters):
                continue
            for parameter in parameters:
                if all(matches(parameter.node, full) for full in names):
                    yield WrongType(passed, parameter, found, names[0])


def _differ(given: ParameterType, declared: ParameterType) -> bool:
    return "" not in (given, declared) and given != declared


def _is_followed_by_a_file(passed: NodeParameterFile) -> bool:
    """Return whether the action passes another parameter file after the file, which may override its parameters."""
    parameters = passed.action.parameters
    position = next(number for number, (_, value) in enumerate(parameters) if value is passed.value)
    return any(not name for name, _ in parameters[position + 1 :])


def undeclared(uses: Sequence[NodeParameterFile], workspace: Workspace) -> Iterator[Undeclared]:
    """Yield the parameters in a file that no node which receives them declares.

    ``uses`` are all places where launch files of the workspace pass the file. Nothing is yielded about a node whose code is
    not in the workspace, or may declare parameters whose names are computed.
    """
    receivers: list[_Receiver] = []
    given = {parameter.name for parameter in uses[0].file.parameters}
    for passed in uses:
        program, names = _receiver(passed, workspace)
        if program is None or not names or not is_closed(program.package, workspace):
            return
        free = [name for name in program.declared if name not in given]
        words = words_of(program.package, workspace)
        receivers.append(_Receiver(passed, names, words, _patterns(words), free))
    nodes = dict.fromkeys(parameter.node for parameter in uses[0].file.parameters)
    of_node = {node: [row for row in receivers if any(matches(node, name) for name in row.names)] for node in nodes}
    for parameter in uses[0].file.parameters:
        own = of_node[parameter.node]
        if not own or _is_of_every_node(parameter.name):
            continue
        last = parameter.name.rpartition(".")[2]
        if any(parameter.name in row.words or last in row.words or _is_described(parameter.name, row) for row in own):
            continue
        near = similar_names(parameter.name, own[0].free, 1, 0.8)
        yield Undeclared(own[0].passed, parameter, own[0].names[0], near[0] if near else "")


class _Receiver(NamedTuple):
    """A node that receives a parameter file."""

    passed: NodeParameterFile
    names: tuple[str, ...]
    """The names that the node may have."""
    words: frozenset[str]
    """The words in the code of its package, and the parameters that files of generate_parameter_library describe."""
    patterns: tuple[str, ...]
    """The members of ``words`` that contain ANY_PART, such as ``pid.*.p``."""
    free: list[str]
    """The parameters that the node declares and the file does not set."""


def _is_described(name: str, receiver: _Receiver) -> bool:
    """Return whether a file of generate_parameter_library has a parameter, perhaps below a prefix that the code adds."""
    tails = [name[at + 1 :] for at, letter in enumerate(name) if letter == "." and "." in name[at + 1 :]]
    if not receiver.words.isdisjoint(tails):
        return True
    return any(_fits(tail, pattern) for pattern in receiver.patterns for tail in (name, *tails))


def _patterns(names: Iterable[str]) -> tuple[str, ...]:
    """Return the names in which a part may be any name."""
    return tuple([name for name in names if ANY_PART in name])


def _fits(name: str, described: str) -> bool:
    """Return whether a name of a parameter fits a name in which a part may be any name: ``pid.elbow.p`` fits ``pid.*.p``."""
    parts, pattern = name.split("."), described.split(".")
    return len(parts) == len(pattern) and all(wanted in (part, ANY_PART) for part, wanted in zip(parts, pattern, strict=True))


def _is_of_every_node(name: str) -> bool:
    """Return whether rclcpp and rclpy themselves declare a parameter, or a library that any node may use."""
    return name in _OF_EVERY_NODE or name.startswith("qos_overrides.")


_OF_EVERY_NODE = frozenset({"use_sim_time", "start_type_description_service", "diagnostic_updater"})


def _receiver(passed: NodeParameterFile, workspace: Workspace) -> tuple[NodeProgram | None, tuple[str, ...]]:
    """Return the program that receives a parameter file, and the possible full names of its node; () if they are unknown.

    The program is None if it is unknown, is not in the workspace or has several nodes.
    """
    program = started_program(passed.action, workspace)
    words = (text for _, value in passed.action.arguments for text in value.texts)
    if program is None or any(map(is_node_renaming, words)):
        return program, ()
    full = [full_name(space, name) for space in passed.namespaces for name in passed.names or (program.name,)]
    return program, tuple(full) if "" not in passed.names and all(map(is_plain, full)) else ()


def _set_again(passed: NodeParameterFile) -> frozenset[str]:
    """Return the names of the parameters that the action sets outside of the file."""
    return frozenset(name for name, _ in passed.action.parameters if name)


def unmatched_nodes(uses: Sequence[NodeParameterFile], workspace: Workspace) -> Iterator[str]:
    """Yield the node names in a file that no node of the workspace has.

    ``uses`` are all places where launch files of the workspace pass the file. Nothing is yielded if a program that receives
    the file is not in the workspace, because it may start nodes of other names.
    """
    if any(passed.value.changes or started_program(passed.action, workspace) is None for passed in uses):
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
        named = [action.name for action in walk_actions(file.actions) if action.name is not None]
        defaults = {} if all(is_settled(text) for name in named for text in name.texts) else assigned_configurations(file)
        for name in named:
            words.update(substitute(name, defaults))
    return frozenset(words)
