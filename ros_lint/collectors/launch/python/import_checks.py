"""Names that a Python launch file imports from the wrong module of the launch libraries."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from ros_lint.collectors.launch.python.walker import span_of
from ros_lint.facts.launch import LAUNCH_LIBRARIES
from ros_lint.facts.visibility import Problem

if TYPE_CHECKING:
    from ros_lint.collectors.python.interpreter.values import Source
    from ros_lint.collectors.python.syntax import Node

_MODULES: Mapping[str, frozenset[str]] = {
    module: frozenset(names.split())
    for module, names in {
        "launch.action": "Action",
        "launch.actions": """AppendEnvironmentVariable DeclareBooleanLaunchArgument DeclareLaunchArgument EmitEvent ExecuteLocal
            ExecuteProcess ForEach ForLoop GroupAction IncludeLaunchDescription Log LogDebug LogError LogInfo LogWarning
            OpaqueCoroutine OpaqueFunction PopEnvironment PopLaunchConfigurations PushEnvironment PushLaunchConfigurations
            RegisterEventHandler ReplaceEnvironmentVariables ResetEnvironment ResetLaunchConfigurations SetEnvironmentVariable
            SetLaunchConfiguration Shutdown TimerAction UnregisterEventHandler UnsetEnvironmentVariable
            UnsetLaunchConfiguration""",
        "launch.conditions": "IfCondition LaunchConfigurationEquals LaunchConfigurationNotEquals UnlessCondition",
        "launch.event_handlers": """OnActionEventBase OnExecutionComplete OnIncludeLaunchDescription OnProcessExit OnProcessIO
            OnProcessStart OnShutdown""",
        "launch.launch_description_sources": """AnyLaunchDescriptionSource FrontendLaunchDescriptionSource
            PythonLaunchDescriptionSource""",
        "launch.substitution": "Substitution",
        "launch.substitutions": """AllSubstitution AndSubstitution AnonName AnySubstitution Command EnvironmentVariable
            EqualsSubstitution FileContent FindExecutable ForEachVar ForLoopIndex IfElseSubstitution LaunchConfiguration
            LaunchLogDir LocalSubstitution NotEqualsSubstitution NotSubstitution OrSubstitution PathJoinSubstitution
            PathSubstitution PythonExpression StringJoinSubstitution TextSubstitution ThisLaunchFile ThisLaunchFileDir""",
        "launch_ros.actions": """ComposableNodeContainer LifecycleNode LifecycleTransition LoadComposableNodes Node
            PushROSNamespace PushRosNamespace RosTimer ROSTimer SetParameter SetParametersFromFile SetROSLogDir SetRemap
            SetUseSimTime""",
        "launch_ros.descriptions": "ComposableLifecycleNode ComposableNode ParameterFile ParameterValue",
        "launch_ros.substitutions": "ExecutableInPackage FindPackage FindPackagePrefix FindPackageShare",
    }.items()
}
"""By module: its public names in any ROS distribution, if launch files use the names.

From launch 1.0.14 to 3.10.0 and launch_ros 0.19.14 to 0.30.1.
"""
ACTIONS = _MODULES["launch.actions"] | _MODULES["launch_ros.actions"]
MODULES_BY_NAME: Mapping[str, tuple[str, ...]] = {
    name: tuple(module for module, names in _MODULES.items() if name in names) for names in _MODULES.values() for name in names
}


# A pattern that begins with letters is searched fast; the lookbehind is tested only at the matches.
_QUALIFIED = re.compile(r"launch(?<!\wlaunch)((?:_ros)?\.[a-z_]+)\.([A-Z]\w+)")


def misplaced_imports(tree: ast.Module, source: Source) -> Iterator[Problem]:
    """Yield a problem for each name that a launch file imports from the wrong module of the launch libraries."""
    for node in tree.body:
        if isinstance(node, ast.ImportFrom) and node.module is not None and not node.level:
            for alias in node.names:
                yield from _misplaced_import(node.module, alias.name, alias, source)
    if not any(_is_misplaced(f"launch{module}", name) for module, name in _QUALIFIED.findall(source.text.text)):
        return  # because walking the whole tree takes longer than everything else
    imported = _imported(tree)
    for node_inside in ast.walk(tree):
        if (
            isinstance(node_inside, ast.Attribute)
            and node_inside.attr in MODULES_BY_NAME
            and isinstance(node_inside.value, ast.Attribute)
        ):
            root = node_inside.value.value
            if isinstance(root, ast.Name) and root.id in imported:
                yield from _misplaced_import(f"{root.id}.{node_inside.value.attr}", node_inside.attr, node_inside, source)


def _misplaced_import(module: str, name: str, node: Node, source: Source) -> Iterator[Problem]:
    if _is_misplaced(module, name):
        yield Problem(
            "stray-name",
            f"'{module}' has no '{name}'; import it from {' or '.join(map(repr, MODULES_BY_NAME[name]))}",
            span_of(node, source),
        )


def _is_misplaced(module: str, name: str) -> bool:
    return name in MODULES_BY_NAME and module in _MODULES and module not in MODULES_BY_NAME[name]


def _imported(tree: ast.Module) -> frozenset[str]:
    """Return the launch libraries that a source imports without an alias.

    A library is omitted if the source assigns another value to its name.
    """
    imported: set[str] = set()
    rebound: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            imported.update(alias.name.partition(".")[0] for alias in node.names if alias.asname is None)
        elif isinstance(node, ast.arg):
            rebound.add(node.arg)
        elif isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load):
            rebound.add(node.id)
    return frozenset({"launch", "launch_ros"} & imported - rebound)


def is_from_launch(tree: ast.Module, function: ast.expr) -> bool:
    """Return whether a called function is imported from a launch library or qualified: ``launch.actions.LogInfo``."""
    root = function
    while isinstance(root, ast.Attribute):
        root = root.value
    if not isinstance(root, ast.Name):
        return False
    if root is not function:
        return root.id.startswith("launch")
    return any(
        isinstance(node, ast.ImportFrom)
        and not node.level
        and (node.module or "").partition(".")[0] in LAUNCH_LIBRARIES
        and any(root.id == (alias.asname or alias.name) for alias in node.names)
        for node in ast.walk(tree)
    )
