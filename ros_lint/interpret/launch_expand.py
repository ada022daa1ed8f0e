"""What a launch file starts when it is launched with some arguments (reference, section G1; ``launch`` and ``launch_ros``).

A launch file is followed once, into actions whose texts still have marks for what is not known; here the marks are
filled in. Conditions have three values: what is taken only perhaps is kept, and said to be so.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ros_lint.collectors.launch_expression import evaluate, means_true
from ros_lint.collectors.launch_text import OWN_FOLDER, UNKNOWN, asked_for, fill, is_settled, joined

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from ros_lint.facts import LaunchAction, LaunchCondition, LaunchFile, LaunchValue
    from ros_lint.text import Span

Texts = tuple[str, ...]

_DEEPEST = 20
_MOST = 5_000


class Started(NamedTuple):
    """A node, a component, a process or an included file, as it is when the launch file runs."""

    kind: str
    """``node``, ``component``, ``process`` or ``include``."""
    package: Texts
    """Alternatives; UNKNOWN in a text for what is not known; empty when there is none."""
    target: Texts
    """The executable, the class, the command line, or the path of the file."""
    name: Texts
    namespace: Texts
    parameters: tuple[tuple[str, Texts], ...]
    remappings: tuple[tuple[Texts, Texts], ...]
    arguments: tuple[tuple[str, Texts], ...]
    certain: bool
    """False when it depends on something that is not known."""
    span: Span
    depth: int
    """How many includes lie between."""


class Missing(NamedTuple):
    """An argument that an included file requires and nobody gives."""

    name: str
    span: Span


class Expansion(NamedTuple):
    """Everything that a launch file starts, in order."""

    started: tuple[Started, ...]
    missing: tuple[Missing, ...]
    complete: bool
    """False when it was cut short, because includes go in a circle or there is too much."""


def expand(
    file: LaunchFile, given: Mapping[str, str], files: Callable[[str], LaunchFile | None] = lambda path: None, distro: str = ""
) -> Expansion:
    """Return what a launch file starts with the arguments given."""
    run = _Run(files, {f"${name}": (value,) for name, value in (("ROS_DISTRO", distro),) if value})
    run.file(file, {name: (value,) for name, value in given.items()})
    return Expansion(tuple(run.started), tuple(run.missing), run.complete)


class _Scope(NamedTuple):
    """What actions see and change. The mappings live on while actions of one scope run."""

    values: dict[str, Texts]
    folder: Texts
    namespace: Texts = ("",)
    certain: bool = True


class _Run:
    def __init__(self, files: Callable[[str], LaunchFile | None], environment: Mapping[str, Texts]) -> None:
        self._files = files
        self._environment = environment
        self._open: list[str] = []
        self.started: list[Started] = []
        self.missing: list[Missing] = []
        self.complete = True

    def file(self, file: LaunchFile, given: dict[str, Texts]) -> None:
        folder = file.path.rpartition("/")[0]
        self._actions(file.actions, _Scope(given, (folder or ".",)))

    def _actions(self, actions: Iterable[LaunchAction], scope: _Scope) -> _Scope:
        for action in actions:
            scope = self._action(action, scope)
        return scope

    def _action(self, action: LaunchAction, scope: _Scope) -> _Scope:
        if len(self.started) > _MOST:
            self.complete = False
            return scope
        truth = self._truth(action.conditions, scope)
        if truth is False:
            return scope
        certain = scope.certain and truth is True
        match action.kind:
            case "argument":
                self._declare(action, scope, certain)
            case "set":
                for name in self.texts(action.target, scope):
                    self._set(scope, name, self.texts(action.value, scope), certain)
            case "namespace":
                pushed = self.texts(action.value, scope)
                if not certain:
                    pushed = (*pushed, "")
                return scope._replace(namespace=_joined_namespaces(scope.namespace, pushed))
            case "group":
                return scope._replace(namespace=self._group(action, scope._replace(certain=certain)))
            case "later":
                self._actions(action.children, scope._replace(values=dict(scope.values), certain=certain))
            case "include":
                return self._include(action, scope, certain)
            case "node" | "component" | "process":
                self._start(action, scope, certain)
                self._actions(action.children, scope._replace(certain=certain))
            case _:
                self._actions(action.children, scope._replace(certain=certain))
        return scope

    def _declare(self, action: LaunchAction, scope: _Scope, certain: bool) -> None:
        for name in self.texts(action.target, scope):
            if name in scope.values:
                continue
            if action.value is None:
                if self._open and certain:
                    self.missing.append(Missing(name, action.span))
                scope.values[name] = (UNKNOWN,)
            else:
                self._set(scope, name, self.texts(action.value, scope), certain)

    def _set(self, scope: _Scope, name: str, texts: Texts, certain: bool) -> None:
        before = scope.values.get(name)
        if certain or before is None:
            scope.values[name] = texts
        else:
            scope.values[name] = tuple(dict.fromkeys((*before, *texts)))

    def _group(self, action: LaunchAction, scope: _Scope) -> Texts:
        """Do what a group does, and return the namespace that holds after it."""
        scoped = action.name is None or action.name.texts != ("unscoped",)
        inner = scope._replace(values=dict(scope.values)) if scoped else scope
        for name, value in action.arguments:
            self._set(inner, name, self.texts(value, scope), certain=True)
        after = self._actions(action.children, inner)
        return scope.namespace if scoped else after.namespace

    def _include(self, action: LaunchAction, scope: _Scope, certain: bool) -> _Scope:
        self._start(action, scope, certain)
        for name, value in action.arguments:
            if name:
                self._set(scope, name, self.texts(value, scope), certain)
        targets = self.texts(action.target, scope)
        if len(targets) != 1 or UNKNOWN in targets[0]:
            return scope
        path = targets[0]
        if path in self._open or len(self._open) > _DEEPEST:
            self.complete = False
            return scope
        file = self._files(path)
        if file is None:
            return scope
        self._open.append(path)
        folder = path.rpartition("/")[0]
        # What is included shares the configurations and the namespace, but not the place that it stands in.
        after = self._actions(file.actions, scope._replace(folder=(folder,), certain=certain))
        self._open.pop()
        return scope._replace(namespace=after.namespace)

    def _start(self, action: LaunchAction, scope: _Scope, certain: bool) -> None:
        command = [value for name, value in action.arguments if not name] if action.kind == "process" else []
        self.started.append(
            Started(
                action.kind,
                self.texts(action.package, scope),
                joined([self.texts(word, scope) for word in command], " ".join) if command else self.texts(action.target, scope),
                self.texts(action.name, scope),
                _joined_namespaces(scope.namespace, self.texts(action.namespace, scope) or ("",)),
                tuple((name, self.texts(value, scope)) for name, value in action.parameters),
                tuple((self.texts(a, scope), self.texts(b, scope)) for a, b in action.remappings),
                tuple((name, self.texts(value, scope)) for name, value in action.arguments if name),
                certain,
                action.span,
                len(self._open),
            )
        )

    def texts(self, value: LaunchValue | None, scope: _Scope) -> Texts:
        """Return what a value is in a scope, () for none."""
        return () if value is None else self._filled(value.texts, scope)

    def _filled(self, texts: Texts, scope: _Scope) -> Texts:
        found: dict[str, None] = {}
        for text in texts:
            if is_settled(text) and OWN_FOLDER not in text:
                found[text] = None
                continue
            for one in fill(text, lambda name: scope.values.get(name) or self._environment.get(name), evaluate):
                found.update(dict.fromkeys(one.replace(OWN_FOLDER, folder) for folder in scope.folder))
        return tuple(found)

    def _truth(self, conditions: Iterable[LaunchCondition], scope: _Scope) -> bool | None:
        """Return whether all conditions hold."""
        result: bool | None = True
        for condition in conditions:
            truth = self._holds(condition, scope)
            if truth is False:
                return False
            if truth is None:
                result = None
        return result

    def _holds(self, condition: LaunchCondition, scope: _Scope) -> bool | None:
        answers: set[bool | None] = set()
        for text in self._filled(condition.texts, scope):
            if asked_for(text):
                answers.add(True)  # the launch file is asked what it does where everything is installed
            elif not is_settled(text):
                answers.add(None)
            elif condition.equals is None:
                answers.add(means_true(text))
            else:
                answers.add(text == condition.equals)
        if len(answers) != 1:
            return None
        answer = answers.pop()
        return None if answer is None else answer is condition.wanted


def _joined_namespaces(outer: Texts, inner: Texts) -> Texts:
    """Return namespaces under others; an absolute one stands for itself (``make_namespace_absolute``)."""
    return joined(
        [outer, inner], lambda row: row[1] if row[1].startswith("/") or not row[0] else "/".join(part for part in row if part)
    )
