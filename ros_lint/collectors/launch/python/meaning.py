"""Models of the launch libraries and of related libraries for the symbolic interpreter of Python."""

from __future__ import annotations

import ast

from ros_lint.base.budget import Budget
from ros_lint.collectors.launch.expressions import evaluate
from ros_lint.collectors.launch.python.library import attribute_of_library, call_library, member_of_library, subscript_library
from ros_lint.collectors.launch.python.released_helpers import HELPERS, helper
from ros_lint.collectors.launch.python.substitutions import CONDITIONS, SUBSTITUTIONS, TextEvaluation, is_text, texts
from ros_lint.collectors.python.interpreter.protocol import Interpreter
from ros_lint.collectors.python.interpreter.recorder import How
from ros_lint.collectors.python.interpreter.values import Frame, LaunchObject, Method, Source, Value
from ros_lint.collectors.symbolic_text import fill
from ros_lint.facts.launch import LAUNCH_RUNTIME

_DESCRIBED = LAUNCH_RUNTIME | {
    "launch_param_builder",
    "launch_pytest",
    "launch_testing",
    "launch_testing_ros",
    "moveit_configs_utils",
    "xacro",
    "yaml",
}
"""Libraries whose functions have models in ros-lint.

The source files of these libraries are not interpreted, even if the workspace contains them, because they need a running
launch system.
"""


class LaunchLibraries:
    """The models of the launch libraries.

    The methods are those of :class:`ros_lint.collectors.python.interpreter.protocol.Library`.
    """

    def describes(self, module: str) -> bool:
        return module in _DESCRIBED

    def model(self, module: str, at: ast.stmt) -> ast.Module | None:
        return helper(module, at) if module in HELPERS else None

    def member(self, name: str, node: ast.AST, source: Source) -> Value:
        return member_of_library(name, node, source)

    def is_substitution(self, name: str) -> bool:
        return name in SUBSTITUTIONS

    def call(
        self,
        interpreter: Interpreter,
        callee: str | Method,
        arguments: list[Value],
        keywords: dict[str, Value],
        node: ast.Call,
        frame: Frame,
    ) -> Value:
        return call_library(interpreter, callee, arguments, keywords, node, frame)

    def attribute(self, owner: LaunchObject, name: str) -> Value:
        return attribute_of_library(owner, name)

    def subscript(self, interpreter: Interpreter, owner: Value, key: Value) -> Value:
        return subscript_library(interpreter, owner, key)

    def texts(self, value: Value, budget: Budget) -> tuple[str, ...]:
        return texts(value, TextEvaluation(budget))

    def with_defaults(self, interpreter: Interpreter, text: str) -> tuple[str, ...]:
        defaults = {
            str(name): texts(default)
            for launch_object in interpreter.made
            if launch_object.name == "DeclareLaunchArgument"
            if (default := launch_object.get(1, "default_value")) is not None
            for name in texts(launch_object.get(0, "name"))
        }
        return fill(text, defaults.get, evaluate)

    def misuse(self, launch_object: LaunchObject, how: How) -> How | None:
        if how == "tested" and launch_object.name in CONDITIONS:
            return "combined"
        return how if is_text(launch_object) else None
