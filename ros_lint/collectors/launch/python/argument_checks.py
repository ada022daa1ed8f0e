"""Arguments for which the classes of the launch libraries raise an error when the file is launched.

- Unknown keywords, and required keywords that are missing.
- A value of a type that the class rejects.
- Positional arguments where a keyword is required.
- A file in another format than the class reads.
- Absolute paths as later parts of a joined path, which replace the parts before them.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

from ros_lint.base.suggestions import ask_if_meant, similar_names
from ros_lint.collectors.launch.expressions import means_true
from ros_lint.collectors.launch.python.import_checks import ACTIONS, is_from_launch
from ros_lint.collectors.launch.python.signatures import Signature, all_signatures
from ros_lint.collectors.launch.python.substitutions import texts
from ros_lint.collectors.launch.python.walker import span_of
from ros_lint.collectors.python.interpreter.recorder import are_unknown
from ros_lint.collectors.python.interpreter.values import LaunchObject
from ros_lint.collectors.python.string_values import callee, dotted
from ros_lint.collectors.python.unbound_names import tried
from ros_lint.collectors.symbolic_text import UNKNOWN, is_plain
from ros_lint.facts.visibility import Problem

if TYPE_CHECKING:
    from ros_lint.collectors.python.interpreter.values import Source

_NODES = frozenset({"ComposableNode", "ComposableNodeContainer", "LifecycleNode", "Node"})
"""Classes whose unknown keywords are reported by :mod:`ros_lint.collectors.launch.python.nodes`, not by this module."""
_OTHER_FORMATS: Mapping[str, tuple[str, ...]] = {
    "PythonLaunchDescriptionSource": (".xml", ".yaml", ".yml"),
    "XMLLaunchDescriptionSource": (".py", ".yaml", ".yml"),
    "YAMLLaunchDescriptionSource": (".py", ".xml"),
}
"""By launch description source: the suffixes of files that it cannot read."""


def rejected_arguments(tree: ast.Module, source: Source, launch_objects: Iterable[LaunchObject]) -> Iterator[Problem]:
    """Yield a problem for each argument that a launch class rejects, except in ``try`` blocks.

    ``launch_objects`` are the objects of launch classes that the interpretation of the file created.
    """
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
    signature = all_signatures().get(launch_object.name)
    if signature is None or not signature.closed:
        return
    keywords, max_positional = frozenset(signature.kinds), signature.most_positional
    if launch_object.name not in _NODES:
        for keyword in node.keywords:
            if keyword.arg is not None and keyword.arg not in keywords:
                yield node, _unknown_keyword(keyword, keyword.arg, keywords, launch_object)
    if missing := _missing_arguments(node, signature):
        message = f"{launch_object.name}() needs {' and '.join([f'{name}=' for name in missing])}"
        yield node, Problem("missing-argument", message, span_of(node.func, launch_object.source))
    if wrong := _wrong_type(launch_object):
        yield node, wrong
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


def _missing_arguments(node: ast.Call, signature: Signature) -> list[str]:
    """Return the required keywords that a call does not set.

    The result is empty if ``*`` or ``**`` may set the keywords. It is also empty if the call has an invalid argument, because
    this argument may be meant for a required keyword.
    """
    given = {keyword.arg for keyword in node.keywords}
    if len(node.args) > signature.most_positional or not given <= signature.kinds.keys():
        return []  # another problem
    if any(isinstance(argument, ast.Starred) for argument in node.args):
        return []
    positional = list(signature.kinds)[: min(len(node.args), signature.most_positional)]
    return [name for name in signature.required if name not in given and name not in positional]


def _wrong_type(launch_object: LaunchObject) -> Problem | None:
    """Return a problem for an argument that the class rejects because of the argument's type, None if there is none."""
    name = launch_object.name
    if name in ("TimerAction", "ROSTimer", "RosTimer"):
        period = launch_object.get(-1, "period")
        if isinstance(period, int):
            message = f"'period' of {name} must be a float or a substitution; write {float(period)} instead of {period}"
            return Problem("wrong-type", message, span_of(launch_object.written(-1, "period"), launch_object.source))
    if name in _NODES and isinstance(launch_object.get(-1, "parameters"), dict):
        message = f"'parameters' of {name} must be a list; write [{{...}}]"
        return Problem("wrong-type", message, span_of(launch_object.written(-1, "parameters"), launch_object.source))
    for key, empty in _empty_lists(launch_object.written(-1, "parameters")) if name in _NODES else ():
        message = f"the parameter {key} is an empty list, whose type launch cannot determine; omit the parameter"
        return Problem("wrong-type", message, span_of(empty, launch_object.source))
    if name in ("IfCondition", "UnlessCondition"):
        word = launch_object.get(0, "predicate_expression")
        if isinstance(word, str) and is_plain(word) and means_true(word) is None:
            message = f"{name} does not accept '{word}'; pass 'true', 'false', '1', '0' or a substitution"
            return Problem("wrong-type", message, span_of(launch_object.written(0, "predicate_expression"), launch_object.source))
    if name == "LaunchDescription":
        entities = launch_object.get(0, "initial_entities")
        if isinstance(entities, LaunchObject) and entities.name in ACTIONS:
            message = f"LaunchDescription needs a list; write [{entities.name}(...)]"
            return Problem("wrong-type", message, span_of(launch_object.written(0, "initial_entities"), launch_object.source))
    return None


def _empty_lists(parameters: ast.expr) -> Iterator[tuple[str, ast.expr]]:
    """Yield the keys and values of the empty lists that the source ``[{'a': []}]`` of the parameters of a node contains."""
    for element in parameters.elts if isinstance(parameters, ast.List) else ():
        if isinstance(element, ast.Dict):
            for key, value in zip(element.keys, element.values, strict=True):
                if isinstance(key, ast.Constant) and isinstance(value, (ast.List, ast.Tuple)) and not value.elts:
                    yield repr(key.value), value


def _unknown_keyword(keyword: ast.keyword, name: str, keywords: frozenset[str], launch_object: LaunchObject) -> Problem:
    completions = sorted(keyword_name for keyword_name in keywords if keyword_name.startswith(f"{name}_"))
    suggestions = completions[:1] or similar_names(name, sorted(keywords), 1, 0.75)
    kind = "misspelt-keyword" if suggestions else "unexpected-keyword"
    question = ask_if_meant([f"{suggestion}=" for suggestion in suggestions])
    return Problem(
        kind, f"{launch_object.name} has no keyword argument '{name}='{question}", span_of(keyword, launch_object.source)
    )


def dropped_paths(tree: ast.Module, source: Source) -> Iterator[Problem]:
    """Yield a problem for the first absolute path that a call joins to another path: Python drops the path before it."""
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
"""Pattern of a comma and a string literal that begins with a slash."""


def _joined_parts(node: ast.Call) -> list[ast.expr]:
    """Return the parts that ``os.path.join(a, b)`` or ``PathJoinSubstitution([a, b])`` joins, [] for any other call."""
    if callee(node) == "PathJoinSubstitution" and node.args and isinstance(node.args[0], (ast.List, ast.Tuple)):
        return node.args[0].elts
    return node.args if dotted(node.func) in ("os.path.join", "path.join") else []


def _is_absolute(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value.startswith("/")
