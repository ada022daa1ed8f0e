"""Launch files with one mistake each, made from the table of signatures, and their correct twins."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from ros_lint.collectors.launch.python.import_checks import MODULES_BY_NAME
from ros_lint.collectors.launch.python.signatures import Signature, all_signatures

_OTHER_MODULES = {"LaunchDescription": "launch", "LaunchDescriptionSource": "launch"}


def _with_imports(body: str) -> str:
    """Return a launch file that returns ``body``, with the imports of the classes in it."""
    modules = {name: MODULES_BY_NAME[name][0] for name in MODULES_BY_NAME} | _OTHER_MODULES
    names = sorted(set(re.findall(r"\b[A-Z]\w+", body)) & modules.keys())
    imports = "".join(f"from {modules[name]} import {name}\n" for name in names)
    head = f"from launch.events import Shutdown as ShutdownEvent\n{imports}"
    return f"{head}\n\ndef generate_launch_description():\n    return {body}\n"


_VALUES: Mapping[str, str] = {
    "actions": "[LogInfo(msg='a')]",
    "cmd": "['ls']",
    "composable_node_descriptions": "[ComposableNode(package='demo_nodes_cpp', plugin='demo_nodes_cpp::Talker')]",
    "condition": "'true'",
    "entities": "[LogInfo(msg='a')]",
    "event": "ShutdownEvent()",
    "event_handler": "OnShutdown(on_shutdown=[])",
    "function": "lambda *values, **names: []",
    "input_values": "'{a: 1}'",
    "length": "'1'",
    "level": "'info'",
    "launch_description_source": "LaunchDescriptionSource(LaunchDescription())",
    "on_completion": "[LogInfo(msg='a')]",
    "on_exit": "[LogInfo(msg='a')]",
    "on_shutdown": "[LogInfo(msg='a')]",
    "on_start": "[LogInfo(msg='a')]",
    "period": "1.0",
    "predicate_expression": "'true'",
    "expression": "'1'",
    "substitutions": "['a']",
    "target_container": "'/c'",
    "value": "'true'",
    "path": "'/dev/null'",
    "left": "'true'",
    "right": "'true'",
    "executable": "'talker'",
    "package": "'demo_nodes_cpp'",
}
_NEEDED: Mapping[str, Mapping[str, str]] = {
    "ComposableNodeContainer": {"package": "'demo_nodes_cpp'"},
    "DeclareBooleanLaunchArgument": {"default_value": "'true'"},
    "DeclareLaunchArgument": {"default_value": "'a'"},
    "EnvironmentVariable": {"default_value": "'a'"},
    "ForEachVar": {"default_value": "'a'"},
    "ForLoopIndex": {"default_value": "'a'"},
    "IfElseSubstitution": {"if_value": "'a'"},
    "Node": {"package": "'demo_nodes_cpp'"},
}
"""Further arguments without which an object cannot be launched."""
_WRONG: Mapping[str, tuple[str, ...]] = {
    "text": ("5", "LogInfo(msg='a')"),
    "texts": ("['a', 5]",),
    "float": ("5",),
    "parameters": ("{'a': 1}", "[5]", "[{'a': []}]"),
    "remappings": ("[('a', 5)]", "[('a', 'b', 'c')]"),
    "entities": ("5",),
}
_SKIPPED = frozenset(
    [
        "AnyLaunchDescriptionSource",
        "Command",
        "ContainerSubstitution",
        "Executable",
        "ExecutableInPackage",
        "ExecuteLocal",
        "FindExecutable",
        "FindPackage",
        "ForLoopIndex",
        "FrontendLaunchDescriptionSource",
        "LaunchDescriptionSource",
        "LeftRightLogicalSubstitution",
        "LifecycleNode",
        "LifecycleTransition",
        "LocalSubstitution",
        "LogInterface",
        "NodeActionExtension",
        "OnActionEventBase",
        "OnExecutionComplete",
        "OnIncludeLaunchDescription",
        "OnProcessExit",
        "OnProcessStart",
        "OnStateTransition",
        "OpaqueCoroutine",
        "Parameter",
        "PopEnvironment",
        "PopLaunchConfigurations",
        "PushRosNamespace",
        "PythonLaunchDescriptionSource",
        "ROSTimer",
        "RosTimer",
        "SetUseSimTime",
        "SharedLogSpecificParse",
        "UnregisterEventHandler",
    ]
)
"""Classes that launch files do not use directly, or that need a running ROS."""


class Mistake(NamedTuple):
    """A launch file with one mistake, and the same file without it."""

    name: str
    wrong: str
    right: str


def mistakes() -> Iterator[Mistake]:
    """Yield files for each class: without each required keyword, with a misspelt one, with a wrong type for each keyword."""
    for name, signature in all_signatures().items():
        if name in _SKIPPED:
            continue
        required = {word: _VALUES.get(word, "'a'") for word in signature.required} | _NEEDED.get(name, {})
        right = _file(name, required, signature)
        for word in signature.required:
            rest = {key: value for key, value in required.items() if key != word}
            yield Mistake(f"{name}_without_{word}", _file(name, rest, signature), right)
        for word in list(signature.kinds)[:6]:
            yield Mistake(f"{name}_misspelt_{word}", _file(name, {**required, f"{word}x": "'a'"}, signature), right)
        for word, kind in signature.kinds.items():
            for number, value in enumerate(_WRONG.get(kind, ())):
                yield Mistake(f"{name}_wrong_{word}_{number}", _file(name, {**required, word: value}, signature), right)


def _file(name: str, keywords: Mapping[str, str], signature: Signature) -> str:
    made = f"{name}({', '.join(f'{word}={value}' for word, value in keywords.items())})"
    if "condition" in signature.kinds and name not in ("IfElseSubstitution", "ComposableLifecycleNode", "ComposableNode"):
        return _with_imports(f"LaunchDescription([{made}])")
    if name == "LaunchDescription":
        return _with_imports(made)
    if name.startswith("On"):
        made = f"RegisterEventHandler({made})"
    elif name in ("ComposableLifecycleNode", "ComposableNode"):
        made = f"LoadComposableNodes(target_container='/c', composable_node_descriptions=[{made}])"
    elif name in ("ParameterFile", "ParameterValue"):
        inner = made if name == "ParameterFile" else f"{{'a': {made}}}"
        made = f"Node(package='demo_nodes_cpp', executable='talker', parameters=[{inner}])"
    elif "Condition" in name or name.startswith("LaunchConfiguration"):
        made = f"LogInfo(msg='a', condition={made})" if name != "LaunchConfiguration" else f"LogInfo(msg={made})"
    else:
        made = f"LogInfo(msg={made})"
    if name == "LaunchConfiguration":
        return _with_imports(f"LaunchDescription([SetLaunchConfiguration('a', 'b'), {made}])")
    return _with_imports(f"LaunchDescription([{made}])")
