"""Arguments for which the classes of the launch libraries raise an error when the file is launched.

- Unknown keywords.
- Positional arguments where a keyword is required.
- A file in another format than the one that the class reads.
- Absolute paths as later parts of a joined path, which replace the parts before them.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

from ros_lint.base.suggestions import ask_if_meant, similar_names
from ros_lint.collectors.launch.python.import_checks import is_from_launch
from ros_lint.collectors.launch.python.substitutions import texts
from ros_lint.collectors.launch.python.walker import span_of
from ros_lint.collectors.python.interpreter.recorder import are_unknown
from ros_lint.collectors.python.string_values import callee, dotted
from ros_lint.collectors.python.unbound_names import tried
from ros_lint.collectors.symbolic_text import UNKNOWN
from ros_lint.facts.visibility import Problem

if TYPE_CHECKING:
    from ros_lint.collectors.python.interpreter.values import LaunchObject, Source

_PARAMETERS: Mapping[str, tuple[int, frozenset[str]]] = {
    name: (int(words.split()[0]), frozenset(words.split()[1:]))
    for name, words in {
        "AnyLaunchDescriptionSource": "1 launch_file_path",
        "AppendEnvironmentVariable": "4 name value prepend separator condition",
        "Command": "1 command on_stderr",
        "DeclareLaunchArgument": "1 name default_value description choices condition",
        "EmitEvent": "0 event condition",
        "EnvironmentVariable": "1 name default_value",
        "FindExecutable": "0 name",
        "FindPackageShare": "1 package",
        "GroupAction": "1 actions scoped forwarding launch_configurations condition",
        "IfCondition": "1 predicate_expression",
        "IncludeLaunchDescription": "1 launch_description_source launch_arguments condition",
        "LaunchConfiguration": "1 variable_name default",
        "LoadComposableNodes": "0 composable_node_descriptions target_container condition",
        "LogInfo": "0 msg condition",
        "OnExecutionComplete": "0 target_action on_completion handle_once",
        "OnProcessExit": "0 target_action on_exit handle_once",
        "OnProcessStart": "0 target_action on_start handle_once",
        "OnShutdown": "0 on_shutdown handle_once",
        "OpaqueFunction": "0 function args kwargs condition",
        "ParameterFile": "1 param_file allow_substs",
        "PathJoinSubstitution": "1 substitutions",
        "PushRosNamespace": "1 namespace condition",
        "PythonExpression": "2 expression python_modules",
        "PythonLaunchDescriptionSource": "1 launch_file_path",
        "RegisterEventHandler": "1 event_handler condition",
        "SetEnvironmentVariable": "2 name value condition",
        "SetLaunchConfiguration": "2 name value condition",
        "SetParameter": "2 name value condition",
        "SetRemap": "2 src dst condition",
        "TextSubstitution": "0 text",
        "TimerAction": "0 period actions cancel_on_shutdown condition",
        "UnlessCondition": "1 predicate_expression",
        "UnsetEnvironmentVariable": "1 name condition",
        "UnsetLaunchConfiguration": "1 name condition",
    }.items()
}
"""The maximum number of positional arguments and all keywords, in any distribution.

From launch 3.7.1 and launch_ros 0.28.
"""

_OTHER_FORMATS: Mapping[str, tuple[str, ...]] = {
    "PythonLaunchDescriptionSource": (".xml", ".yaml", ".yml"),
    "XMLLaunchDescriptionSource": (".py", ".yaml", ".yml"),
    "YAMLLaunchDescriptionSource": (".py", ".xml"),
}
"""The file suffixes that a launch description source cannot read."""


def rejected_arguments(tree: ast.Module, source: Source, launch_objects: Iterable[LaunchObject]) -> Iterator[Problem]:
    """Yield a problem for each argument that the class of a launch object rejects, except in ``try`` blocks."""
    problems = [
        (node, problem)
        for launch_object in launch_objects
        if launch_object.source is source
        for node, problem in _rejected_arguments_of(launch_object)
    ]
    guarded = {inner for node in ast.walk(tree) if isinstance(node, ast.Try) for inner in tried(node)} if problems else set()
    for node, problem in problems:
        if node not in guarded and is_from_launch(tree, node.func):
            yield problem


def _rejected_arguments_of(launch_object: LaunchObject) -> Iterator[tuple[ast.Call, Problem]]:
    node = launch_object.node
    if callee(node) != launch_object.name or are_unknown(launch_object.conditions):
        return
    max_positional, keywords = _PARAMETERS.get(launch_object.name, (len(node.args), None))
    if keywords is not None:
        for keyword in node.keywords:
            if keyword.arg is not None and keyword.arg not in keywords:
                yield node, _unknown_keyword(keyword, keyword.arg, keywords, launch_object)
    if len(node.args) > max_positional and not any(isinstance(argument, ast.Starred) for argument in node.args):
        accepted = (
            "only keyword arguments"
            if not max_positional
            else f"at most {max_positional} positional argument{'s' if max_positional > 1 else ''}"
        )
        yield (
            node,
            Problem(
                "too-many-arguments",
                f"{launch_object.name} accepts {accepted}",
                span_of(node.args[max_positional], launch_object.source),
            ),
        )
    if launch_object.name in _OTHER_FORMATS:
        paths = [text for text in texts(launch_object.get(0, "launch_file_path")) if text]
        if paths and all(path.endswith(_OTHER_FORMATS[launch_object.name]) and not path.endswith(UNKNOWN) for path in paths):
            end = "." + paths[0].rpartition(".")[2]
            message = f"{launch_object.name} does not read {end} files; use AnyLaunchDescriptionSource(...)"
            yield (
                node,
                Problem("other-format", message, span_of(launch_object.written(0, "launch_file_path"), launch_object.source)),
            )


def _unknown_keyword(keyword: ast.keyword, name: str, keywords: frozenset[str], launch_object: LaunchObject) -> Problem:
    completions = sorted(keyword_name for keyword_name in keywords if keyword_name.startswith(f"{name}_"))
    suggestions = completions[:1] or similar_names(name, sorted(keywords), 1, 0.75)
    kind = "misspelt-keyword" if suggestions else "unexpected-keyword"
    question = ask_if_meant([f"{suggestion}=" for suggestion in suggestions])
    return Problem(
        kind, f"{launch_object.name} has no keyword argument '{name}='{question}", span_of(keyword, launch_object.source)
    )


def dropped_paths(tree: ast.Module, source: Source) -> Iterator[Problem]:
    """Yield a problem for the first absolute path that a call joins to another path, because Python drops that other path."""
    if not _SLASH.search(source.text.text):
        return  # because walking the whole tree takes longer
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call):
            continue
        parts = _joined_parts(node)
        place = next((part for part in parts[1:] if _is_absolute(part)), None)
        if isinstance(place, ast.Constant) and not _is_absolute(parts[0]):
            path_text = str(place.value)
            remedy = f"write {path_text.lstrip('/')!r}" if path_text.strip("/") else f"remove {path_text!r}"
            message = f"the path before {path_text!r} is dropped, because {path_text!r} begins with a slash; {remedy}"
            yield Problem("forgotten-path", message, span_of(place, source))


_SLASH = re.compile(r",\s*['\"]/")
"""A text that begins with a slash and follows a comma."""


def _joined_parts(node: ast.Call) -> list[ast.expr]:
    """Return the parts that ``os.path.join(a, b)`` or ``PathJoinSubstitution([a, b])`` joins, [] for any other call."""
    if callee(node) == "PathJoinSubstitution" and node.args and isinstance(node.args[0], (ast.List, ast.Tuple)):
        return node.args[0].elts
    return node.args if dotted(node.func) in ("os.path.join", "path.join") else []


def _is_absolute(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value.startswith("/")
