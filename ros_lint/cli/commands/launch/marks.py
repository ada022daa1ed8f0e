"""Find actions in launch files whose package, executable or component class does not exist, to mark them in the output."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from ros_lint.analysis.finding import Confidence, Severity
from ros_lint.base.text import Span
from ros_lint.engine import registry
from ros_lint.engine.run import run_rules
from ros_lint.facts.launch import walk_actions

if TYPE_CHECKING:
    from ros_lint.facts.launch import LaunchAction, LaunchFile
    from ros_lint.workspace.model import Workspace

Marks = Mapping[Span, tuple[str, ...]]
"""Messages about missing packages, executables and classes, by the span of the action that names them."""

_RULES = ("launch-unknown-package", "launch-unknown-executable", "launch-unknown-component")
_KINDS = ("node", "component", "process")


def marks_of(workspace: Workspace, files: Iterable[LaunchFile]) -> Marks:
    """Return the messages of ``ros-lint check`` about a missing package, executable or class, by the span of the action."""
    rules = [rule for rule in registry.load() if rule.name in _RULES]
    issues, _ = run_rules(workspace, rules)
    by_path: dict[str, list[tuple[Span, str]]] = {}
    for issue in issues:
        if issue.severity is Severity.ERROR and issue.finding.confidence is Confidence.HIGH:
            span = issue.finding.span
            by_path.setdefault(span.path, []).append((span, issue.finding.message))
    marks: dict[Span, tuple[str, ...]] = {}
    for file in files:
        errors = by_path.get(file.path, ())
        for action in walk_actions(file.actions) if errors else ():
            if action.kind in _KINDS and (messages := [text for span, text in errors if _names(action, span)]):
                marks[action.span] = tuple(messages)
    return marks


def _names(action: LaunchAction, span: Span) -> bool:
    """Return whether the text at ``span`` is the package, the executable or the class of an action."""
    places = [action.package_span, *(value.span for value in (action.package, action.target) if value is not None)]
    return any(place is not None and place.covers(span) for place in places)
