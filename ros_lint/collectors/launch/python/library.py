"""Models of the functions and classes of the launch libraries, and of path functions, for the symbolic interpreter.

A model computes the result of a call from the arguments and records which packages and files the call uses.
"""

from __future__ import annotations

import ast
import posixpath
import re
from collections.abc import Mapping
from itertools import pairwise
from typing import TYPE_CHECKING

from ros_lint.collectors import symbolic_text
from ros_lint.collectors.conditional_text import joined
from ros_lint.collectors.launch.python.substitutions import conditions_of
from ros_lint.collectors.python.interpreter.alternatives import alternatives, union
from ros_lint.collectors.python.interpreter.builtins import FUNCTIONS
from ros_lint.collectors.python.interpreter.calls import LibraryCall, Rule, nothing, unknown, unknown_text
from ros_lint.collectors.python.interpreter.methods import items
from ros_lint.collectors.python.interpreter.operations import INSTALLED, text_of
from ros_lint.collectors.python.interpreter.path_calls import PATH_FUNCTIONS, new_path, on_path
from ros_lint.collectors.python.interpreter.values import (
    FilePath,
    Guarded,
    LaunchObject,
    LibraryName,
    Method,
    Unknown,
    Value,
    argument_of,
    environment,
    written,
)
from ros_lint.collectors.python.methods import CONSTANTS
from ros_lint.collectors.symbolic_text import UNKNOWN, presence
from ros_lint.facts.launch import LaunchCondition

if TYPE_CHECKING:
    from ros_lint.collectors.python.interpreter.protocol import Interpreter
    from ros_lint.collectors.python.interpreter.values import Frame, Source


PACKAGE_SUBSTITUTIONS = frozenset({"FindPackage", "FindPackagePrefix", "FindPackageShare"})
"""Substitutions that look up the package in their first argument."""


def call_library(
    machine: Interpreter,
    callee: str | Method,
    arguments: list[Value],
    keywords: dict[str, Value],
    node: ast.Call,
    frame: Frame,
) -> Value:
    """Return the result of a call of a library function, or of a method of a library object."""
    if isinstance(callee, Method):
        call = LibraryCall(machine, callee.name, arguments, keywords, node, frame)
        return _of_path(call, callee.owner) if isinstance(callee.owner, FilePath) else _method(call, callee.owner)
    call = LibraryCall(machine, callee, arguments, keywords, node, frame)
    last = callee.rpartition(".")[2]
    model = _MODELS_BY_NAME.get(callee) or (
        _MODELS_BY_LAST_PART.get(last) if not callee.startswith(("os.", "builtins.")) else None
    )
    if model is not None:
        return model(call)
    if last[:1].isupper():
        return _create(call, last)
    machine.escape([arguments, keywords])
    if "package" in keywords and "executable" in keywords:
        _create(call, "Node").escaped = True  # the keywords suggest a function that creates a node
    return Unknown("" if callee.partition(".")[0] in _STANDARD else f"{last}() cannot be followed")


def _create(call: LibraryCall, name: str) -> LaunchObject:
    launch_object = LaunchObject(name, call.arguments, call.keywords, call.node, call.frame.source)
    launch_object.conditions = call.machine.conditions
    call.machine.made.append(launch_object)
    if name == "LaunchDescription":
        entities = launch_object.get(0, "initial_entities")
        entity_list = items(call.machine, entities) if entities is not None else []
        launch_object.entities = entity_list if entity_list is not None else [entities]
    elif name in PACKAGE_SUBSTITUTIONS:
        _note(call, launch_object.get(0, "package"), launch_object.written(0, "package"), eager=False)
    elif name == "ExecutableInPackage":
        _note(call, launch_object.get(1, "package"), launch_object.written(1, "package"), eager=False)
    elif name == "Command":
        _note_command(call, launch_object)
    elif name in ("MoveItConfigsBuilder", "ParameterBuilder"):
        _note_builder(call, launch_object)
    return launch_object


def _note_command(call: LibraryCall, launch_object: LaunchObject) -> None:
    """Record that a Command of launch uses the package xacro, if it runs xacro. Only the first such Command is recorded."""
    command, expression = launch_object.get(0, "command"), launch_object.written(0, "command")
    if any(text.partition(" ")[0] == "xacro" for text in call.machine.texts(command)):
        first = expression.elts[0] if isinstance(expression, (ast.List, ast.Tuple)) and expression.elts else expression
        call.machine.named.setdefault("xacro", (first, call.frame.source))


def _note_builder(call: LibraryCall, launch_object: LaunchObject) -> None:
    """Record that a builder of moveit_configs_utils looks up its package while the launch file is loaded.

    Without ``package_name``, MoveItConfigsBuilder looks up ``<robot_name>_moveit_config``.
    """
    position = 2 if launch_object.name == "MoveItConfigsBuilder" else 0
    package = launch_object.get(position, "package_name")
    if package is not None:
        _note(call, package, launch_object.written(position, "package_name"), eager=True)
    elif position:
        robots = launch_object.get(0, "robot_name")
        names = tuple(f"{robot.value}_moveit_config" for robot in alternatives(robots) if isinstance(robot.value, str))
        for name in names:
            _note(call, name, launch_object.written(0, "robot_name"), eager=True)


def package_of_builder(builder: LaunchObject) -> str:
    """Return the name of the package that a builder of moveit_configs_utils looks up, "" if it is unknown.

    Without ``package_name``, MoveItConfigsBuilder looks up ``<robot_name>_moveit_config``.
    """
    of_robots = builder.name == "MoveItConfigsBuilder"
    package, robot = builder.get(2 if of_robots else 0, "package_name"), builder.get(0, "robot_name")
    if package is None and of_robots and isinstance(robot, str):
        package = f"{robot}_moveit_config"
    return package if isinstance(package, str) and symbolic_text.is_plain(package) else ""


def _of_path(call: LibraryCall, owner: FilePath) -> Value:
    """Return the result of a method of a path that accesses the file system, such as ``exists()`` or ``read_text()``."""
    match call.name:
        case "resolve" | "absolute" | "expanduser":
            return owner
        case "open" | "read_text" | "read_bytes":
            return call.machine.open_file(owner.text, call.node, call.frame.source)
        case "exists" | "is_file":
            return call.machine.ask((owner.text,))
        case "write_text" | "write_bytes":
            call.machine.ask((owner.text,))  # the file need not exist before
    return Unknown(f"{call.name}() of a path")


def member_of_library(name: str, node: ast.AST, source: Source) -> Value:
    """Return the value of a dotted name of a library, such as ``launch.actions.TimerAction``."""
    if name == "sys.executable" and isinstance(node, ast.expr):
        return written(UNKNOWN, node, source)
    return CONSTANTS.get(name) or LibraryName(name)


def attribute_of_library(owner: LaunchObject, name: str) -> Value:
    """Return the value of the attribute ``name`` of an object of the launch libraries."""
    match owner.name, name:
        case "LaunchDescription", "entities":
            return owner.entities
        case "DeclareLaunchArgument", "name":
            return owner.get(0, "name")
        case "MoveItConfigsBuilder", "package_path" if package := package_of_builder(owner):
            return FilePath(symbolic_text.share(package))
    return Method(owner, name)


_FILE_POSITIONS: Mapping[str, int] = {
    "file_parameter": 1,
    "joint_limits": 0,
    "moveit_cpp": 0,
    "pilz_cartesian_limits": 0,
    "robot_description": 0,
    "robot_description_kinematics": 0,
    "robot_description_semantic": 0,
    "trajectory_execution": 0,
    "xacro_parameter": 1,
    "yaml": 0,
}
"""By method of a builder of moveit_configs_utils: the position of the argument with the file that the method reads.

``sensors_3d`` is omitted, because it checks whether the file exists.
"""


def _note_built(call: LibraryCall, owner: LaunchObject) -> None:
    """Record the file that a method of a builder of moveit_configs_utils reads while the launch file is loaded.

    The path of the file is relative to the share folder of the package that the builder looks up.
    """
    position = _FILE_POSITIONS.get(call.name)
    if position is None or call.machine.guarded or owner.name not in ("MoveItConfigsBuilder", "ParameterBuilder"):
        return
    package, file = package_of_builder(owner), call.get(position, "file_path")
    if not package or not isinstance(file, (str, FilePath)):
        return
    expression = argument_of(call.node, position, "file_path")
    for path in text_of(file):
        full_path = posixpath.join(symbolic_text.share(package), path)
        call.machine.opened.append((full_path, expression, call.frame.source, call.machine.conditions))


def _note(call: LibraryCall, package: Value, at: ast.expr, eager: bool) -> None:
    source = call.frame.source
    for alternative in alternatives(package):
        node, place_source = getattr(alternative.value, "node", at), getattr(alternative.value, "source", source)
        if isinstance(alternative.value, str):
            call.machine.look_up(str(alternative.value), node, place_source, eager, alternative.conditions)
        elif isinstance(alternative.value, LaunchObject):
            for text in call.machine.texts(alternative.value):
                call.machine.named.setdefault(text, (at, source))


_ADD_METHODS = frozenset({"add_action", "add_entity", "append"})


def _method(call: LibraryCall, owner: LaunchObject) -> Value:
    machine, name = call.machine, call.name
    if name in _ADD_METHODS and owner.name == "LaunchDescription":
        machine.budget.step()
        owner.entities.append(machine.guard(call.get(0, "action", "entity")))
        return None
    if name == "extend" and owner.name == "LaunchDescription":
        owner.entities += [machine.guard(item) for item in call.items(0) or [call.get(0)]]
        return None
    if name in ("perform", "toxml", "toprettyxml"):
        return _read(call, machine.texts(owner))
    if name == "find" and owner.name in PACKAGE_SUBSTITUTIONS:
        return (_share if owner.name == "FindPackageShare" else _prefix)(call)
    if name == "evaluate":
        conditions = conditions_of(owner)
        return Unknown("a condition", conditions[0] if len(conditions) == 1 else None)
    if owner.name.endswith("Builder"):
        _note_built(call, owner)
        owner.keywords.update({f"{name}.{key}": value for key, value in call.keywords.items()})
        owner.keywords.update({f"{name}.{index}": value for index, value in enumerate(call.arguments)})
        return owner
    machine.escape([owner, call.arguments, call.keywords])
    return Unknown(f"{name}() of {owner.name}")


def _share(call: LibraryCall) -> Value:
    package = call.get(0, "package_name", "package")
    _note(call, package, call.node.args[0] if call.node.args else call.node, eager=True)
    return call.result(joined([call.texts(0, "package_name", "package")], lambda row: symbolic_text.share(row[0])))


def _share_path(call: LibraryCall) -> Value:
    paths = _share(call)
    return union(Guarded(FilePath(str(path.value)), path.conditions) for path in alternatives(paths))


def _prefix(call: LibraryCall) -> Value:
    package = call.get(0, "package_name", "package")
    _note(call, package, call.node.args[0] if call.node.args else call.node, eager=True)
    return call.result(joined([call.texts(0, "package_name", "package")], lambda row: symbolic_text.prefix(row[0])))


def _variable(call: LibraryCall) -> Value:
    default = call.get(1, "default")
    names = call.texts(0, "key")
    if call.machine.sets(names):
        return union(call.machine.variable(name) for name in names)
    # ROS_DISTRO is set wherever something is launched; any other variable may be missing.
    if default is None and call.name != "os.environ" and names != ("ROS_DISTRO",):
        return Unknown("an environment variable")
    defaults = call.texts(1, "default") if default is not None else (None,)
    return call.result(tuple(environment(name, value) for name in names for value in defaults))


def _has_resource(call: LibraryCall) -> Value:
    return _is_installed(call.texts(1, "resource_name"))


def _is_installed(names: tuple[str, ...]) -> Value:
    symbolic = presence(names[0] if len(names) == 1 else UNKNOWN)
    return Unknown("whether something is installed", LaunchCondition((symbolic,), None))


def _exists(call: LibraryCall) -> Value:
    return call.machine.ask(call.texts(0, "path"))


def _first_argument(call: LibraryCall) -> Value:
    return call.get(0)


def _perform(position: int) -> Rule:
    return lambda call: _read(call, call.machine.texts(call.get(position)))


def _read(call: LibraryCall, texts: tuple[str, ...]) -> Value:
    """Return the result of a call that reads launch configurations at once."""
    call.machine.note_read(texts, call.node, call.frame.source)
    return call.result(texts)


def _configuration(call: LibraryCall) -> Value:
    default = call.get(1)
    defaults = call.texts(1) if default is not None else (None,)
    found = tuple(symbolic_text.configuration(name, value) for name in call.texts(0) for value in defaults)
    call.machine.note_read(found)
    return call.result(found)


def _xacro_output(call: LibraryCall) -> Value:
    """Return the result of ``xacro.process_file()`` and similar functions: the output of xacro."""
    return _create(call, "Command") if call.arguments else unknown(call)


def _writes_file(position: int) -> Rule:
    """Return the model of a function that writes the file in its argument at ``position``.

    The file is recorded like a file whose existence the launch file tests, because it need not exist before.
    """

    def model(call: LibraryCall) -> Value:
        call.machine.ask(call.texts(position))
        return unknown(call)

    return model


_OUTPUT = re.compile(r"(?:>|\s-o\s)\s*(\S+)")


def _runs_command(call: LibraryCall) -> Value:
    """Return the result of a function that runs a command line: an unknown value.

    The output file, after ``>`` or ``-o``, is recorded like a file whose existence the launch file tests, because it need not
    exist before.
    """
    words = call.items(0)
    if words is None:
        call.machine.ask(tuple([path for command in call.texts(0) for path in _OUTPUT.findall(command)]))
    else:
        for option, path in pairwise(words):
            if "-o" in call.machine.texts(option):
                call.machine.ask(call.machine.texts(path))
    call.machine.escape([call.arguments, call.keywords])
    return Unknown("")


def subscript_library(machine: Interpreter, owner: Value, key: Value) -> Value:
    """Return the value of ``owner[key]``, such as ``os.environ["A"]`` or ``context.launch_configurations["a"]``."""
    if isinstance(owner, LibraryName):
        if owner.name == "os.environ":
            return union(machine.variable(name) for name in text_of(key))
        if owner.name == "context.launch_configurations":
            configurations = [symbolic_text.configuration(name) for name in text_of(key)]
            machine.note_read(configurations)
            return union(configurations)
    if isinstance(owner, (Unknown, LibraryName)):
        return Unknown("an element of an unknown value")
    machine.escape(owner)
    return Unknown("an element of an unknown value")


_STANDARD = frozenset(
    {
        "os", "sys", "shutil", "subprocess", "time", "random", "math", "json", "re", "tempfile", "datetime", "socket",
        "logging", "builtins", "platform", "getpass", "glob", "collections", "itertools", "functools", "string", "yaml",
        "numpy", "psutil", "argparse", "hashlib", "uuid", "stat", "signal", "threading", "warnings", "inspect", "ast",
    }
)  # fmt: skip
"""Modules whose functions never return an object that can be launched."""


_MODELS_BY_NAME: Mapping[str, Rule] = {
    **FUNCTIONS,
    **PATH_FUNCTIONS,
    **dict.fromkeys(("os.path.abspath", "os.path.realpath", "os.path.expanduser", "os.path.expandvars"), on_path(str)),
    "os.path.exists": _exists,
    "os.path.isfile": _exists,
    "os.getenv": _variable,
    "os.environ.get": _variable,
    "os.getcwd": unknown_text,
    "os.makedirs": nothing,
    "pathlib.Path.cwd": lambda call: FilePath(UNKNOWN),
    "pathlib.Path.home": lambda call: FilePath(UNKNOWN),
    "context.launch_configurations.get": _configuration,
    "context.perform_substitution": _perform(0),
    f"{INSTALLED}.keys": lambda call: LibraryName(INSTALLED),
    f"{INSTALLED}.get": lambda call: _is_installed(call.texts(0)),
    "xacro.process_file": _xacro_output,
    "xacro.process": _xacro_output,
    "xacro.open_output": _writes_file(0),
    **dict.fromkeys(("shutil.copy", "shutil.copy2", "shutil.copyfile"), _writes_file(1)),
    **{f"subprocess.{name}": _runs_command for name in ("Popen", "call", "check_call", "check_output", "getoutput", "run")},
    "os.system": _runs_command,
}

_MODELS_BY_LAST_PART: Mapping[str, Rule] = {
    "get_package_share_directory": _share,
    "get_package_share_path": _share_path,
    "get_package_prefix": _prefix,
    "get_packages_with_prefixes": lambda call: LibraryName(INSTALLED),
    "get_resources": lambda call: LibraryName(INSTALLED),
    "get_search_paths": lambda call: LibraryName(INSTALLED),
    "has_resource": _has_resource,
    "perform_substitutions": _perform(1),
    "normalize_to_list_of_substitutions": _first_argument,
    "Path": new_path,
}
