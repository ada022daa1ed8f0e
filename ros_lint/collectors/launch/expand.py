"""Expansion of a launch file: the nodes, processes and includes that it starts with given launch arguments.

Each launch file is first evaluated without arguments, into actions whose texts contain special characters for unknown values.
This module replaces the special characters by values, as ``launch`` and ``launch_ros`` do. A condition is true, false or
unknown: an action under an unknown condition is kept and marked as uncertain.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros_lint.base.budget import Budget
from ros_lint.collectors.conditional_text import joined
from ros_lint.collectors.launch.delayed import Delayed, assembled, has_own_environment, has_own_values, next_of, time_of
from ros_lint.collectors.launch.expansion import Argument, Circle, Expansion, Missing, Opened, Raised, Refused, Started, Unset
from ros_lint.collectors.launch.final_parameters import GivenParameter, NodeNames, Texts, final_parameters, of_command_line
from ros_lint.collectors.launch.scope import COMPUTED, Filling, LaunchScope
from ros_lint.collectors.symbolic_text import UNKNOWN, is_node_renaming, is_settled
from ros_lint.facts.launch import OPENED, walk_actions

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from ros_lint.base.text import Span
    from ros_lint.collectors.launch.final_parameters import Contents, FinalParameters
    from ros_lint.facts.launch import LaunchAction, LaunchFile, LaunchValue

_ABSENT = "\0"
"""Stands for a word that a command line may not have. No word contains this character."""
_MAX_DEPTH = 20
_MAX_STARTED = 5_000
_MAX_ACTIONS = 100_000


def expand(
    file: LaunchFile,
    passed: Mapping[str, str],
    files: Callable[[str], LaunchFile | None] = lambda path: None,
    distro: str = "",
    *,
    brief: bool = False,
    contents: Contents | None = None,
    node_name: Callable[[str, str], str] = lambda package, target: "",
) -> Expansion:
    """Return the actions that a launch file starts if it is launched with the arguments ``passed``.

    ``files`` returns an included file by its path, None if there is no such file. A path in an install space begins with a
    placeholder for the install prefix of its package. ``brief`` omits parameters (except parameter files), remappings and the
    arguments of included files, because they take most of the time. ``distro`` is the value of ROS_DISTRO, "" if it is
    unknown. ``contents`` returns a parameter file by its path; without it, the final parameters of nodes are not computed.
    ``node_name`` returns the name that a program or component gives to its node, "" if it is unknown.
    """
    run = _Run(files, brief, contents, node_name, distro)
    run.file(file, {name: (value,) for name, value in passed.items()})
    return Expansion(
        tuple(run.started),
        tuple(run.missing),
        run.complete,
        tuple(run.arguments),
        tuple(run.refused),
        tuple(run.circles),
        tuple(run.variables),
        tuple(run.raised),
        tuple(run.unset),
        tuple(run.opened),
    )


class _Run:
    def __init__(
        self,
        files: Callable[[str], LaunchFile | None],
        brief: bool,
        contents: Contents | None,
        node_name: Callable[[str, str], str],
        distro: str,
    ) -> None:
        self._files = files
        self._brief = brief
        self._contents = contents
        self._node_name = node_name
        self._distro = distro
        self._filling = Filling({"$ROS_DISTRO": (distro,)} if distro else {})
        self._texts = self._filling.texts
        self._open: list[tuple[str, dict[str, Texts]]] = []
        self.started: list[Started] = []
        self.missing: list[Missing] = []
        self.arguments: list[Argument] = []
        self.refused: list[Refused] = []
        self.circles: list[Circle] = []
        self.raised: list[Raised] = []
        self.unset: dict[Unset, None] = {}
        self.opened: dict[Opened, None] = {}
        self.complete = True
        self._may_be_set = False
        """True if something that was not followed may have set any launch configuration."""
        self._budget = Budget(_MAX_ACTIONS)
        self._via: Span | None = None
        self._delayed: list[Delayed] = []
        self._handlers = 0
        self._perhaps: dict[str, Texts] = {}
        """Values of launch configurations that an event sets, while it is unknown whether another event comes before it."""
        self._number = 0
        """The number of actions that were started by the timers and events that are finished."""

    @property
    def variables(self) -> tuple[str, ...]:
        """Environment variables without default that the launch file reads."""
        return tuple(self._filling.variables)

    def file(self, file: LaunchFile, passed: dict[str, Texts]) -> None:
        folder = file.path.rpartition("/")[0]
        self._may_be_set = _may_set_more(file)
        self._open.append((file.path, dict(passed)))
        now = self._actions(file.actions, LaunchScope(passed, (folder or ".",)))
        direct, finished = self.started, []
        while entry := next_of(self._delayed):
            self.started = []
            now = self._later(entry, now)
            self._number += len(self.started)
            finished.append((entry, self.started))
        self.started = assembled(direct, finished)

    def _later(self, entry: Delayed, now: LaunchScope) -> LaunchScope:
        """Expand the actions of a timer or an event, and return the settings in effect after them.

        ``now`` are the settings in effect when it starts, outside of scoped groups. launch keeps the settings of the place of
        a timer since jazzy, and its environment since lyrical. Otherwise, and for events, it uses ``now``.
        """
        self._open, self._via = list(entry.open), entry.via
        scope = entry.scope._replace(later=True)
        if entry.is_timer and has_own_values(self._distro):
            if not has_own_environment(self._distro):
                scope = scope._replace(environment=now.environment)
            self._actions(entry.actions, scope)
            return now
        # A function may have read a configuration before, and put the value into the actions.
        read = {name: entry.scope.values[name] for name in entry.read if name in entry.scope.values}
        inner = scope.after(now)._replace(values={**now.values, **read})
        before = dict(inner.values)
        after = self._actions(entry.actions, inner)
        changed = {name: texts for name, texts in inner.values.items() if before.get(name) != texts}
        if entry.time is not None:
            now.values.update(changed)
            return now.after(after) if entry.scope.certain else now
        for name, texts in changed.items():
            if name in now.values:
                self._set(now, name, texts, certain=False)
            else:
                self._perhaps[name] = tuple(dict.fromkeys((*self._perhaps.get(name, ()), *texts)))
        return now

    def _actions(self, actions: Iterable[LaunchAction], scope: LaunchScope) -> LaunchScope:
        for action in actions:
            scope = self._action(action, scope)
        return scope

    def _action(self, action: LaunchAction, scope: LaunchScope) -> LaunchScope:
        if not self._budget.affords() or self._number + len(self.started) > _MAX_STARTED:
            self.complete = False
            return scope
        self._filling.unset.clear()
        self._filling.unknown.clear()
        truth, when = self._filling.truth(action.conditions, scope)
        self._note_unset(action, scope)
        if truth is False:
            return scope
        outer = scope
        if truth is None:
            why = tuple(dict.fromkeys([*scope.why, *[reason for reason in self._filling.unknown if reason != COMPUTED]]))
            scope = scope._replace(certain=False, when=(*scope.when, *when), why=why)
        match action.kind:
            case "argument":
                self._declare(action, scope)
            case "set":
                for name in self._texts(action.target, scope):
                    self._set(scope, name, self._texts(action.value, scope), scope.certain)
                self._note_unset(action, scope)
            case "unset":
                for name in self._texts(action.target, scope):
                    if scope.certain:
                        scope.values.pop(name, None)
                    elif name in scope.values:
                        self._set(scope, name, (UNKNOWN,), certain=False)
            case "unset_environment":
                names = self._texts(action.target, scope)
                pairs = tuple((name, () if scope.certain else (UNKNOWN,)) for name in names)
                return outer._replace(environment=(*(pair for pair in scope.environment if pair[0] not in names), *pairs))
            case "reset":
                return outer.after(self._reset(action, scope))
            case "reset_environment":
                return outer._replace(environment=tuple((name, (UNKNOWN,)) for name, _ in scope.environment if not scope.certain))
            case "namespace" | "parameter" | "remap" | "environment":
                return outer.after(self._pushed(action, scope))
            case "group":
                return outer.after(self._group(action, scope))
            case "later":
                periods = self._texts(action.value, scope)
                trigger = tuple([f"{period} s" for period in periods]) or self._texts(action.name, scope)
                read = tuple([name for name, _ in action.arguments])
                time = time_of(periods, scope.time)
                snapshot = scope._replace(values=dict(scope.values), trigger=trigger, time=time)
                place, via = len(self.started), self._via
                handler = (tuple(self._open), via, read, action.value is not None, self._handlers)
                self._delayed.append(Delayed(self.started, place, action.children, snapshot, *handler))
                self._handlers += 1
            case "include":
                return outer.after(self._include(action, scope))
            case "read":
                texts = self._texts(action.value, scope)
                self._note_unset(action, scope)
                if action.description == OPENED:
                    self._note_opened(texts, action.span, scope)
            case "raise":
                if scope.certain and not scope.later:
                    self.raised.append(Raised(action.span, action.description))
            case "node" | "component" | "process":
                started = self._start(action, scope)
                if action.children:
                    container = _joined_namespaces(started.namespace, started.name) if started.name else (UNKNOWN,)
                    process = tuple([given for given in self._given(action, scope) if given.is_rule or not given.name])
                    self._actions(action.children, scope._replace(container=container, process=process))
            case _:
                self._actions(action.children, scope)
        return outer

    def _note_unset(self, action: LaunchAction, scope: LaunchScope) -> None:
        """Record the launch configurations without value that were needed since the last call."""
        if scope.certain and not scope.later and not self._may_be_set:
            for name in self._filling.unset:
                self.unset[Unset(name, action.span, scope.include)] = None
        self._filling.unset.clear()

    def _note_opened(self, texts: Texts, span: Span, scope: LaunchScope) -> None:
        """Record that launch, or the launch file, reads the file at the path that ``texts`` are the possible values of."""
        if scope.certain and not scope.later and len(texts) == 1 and is_settled(texts[0]):
            self.opened[Opened(texts[0], span)] = None

    def _declare(self, action: LaunchAction, scope: LaunchScope) -> None:
        for name in self._texts(action.target, scope):
            is_given = name in scope.values
            if not is_given and action.value is None:
                if scope.certain:
                    self.missing.append(Missing(name, action.span, scope.include))
                scope.values[name] = (UNKNOWN,)
                self._filling.required.add(name)
            elif not is_given:
                perhaps = self._perhaps.get(name, ()) if scope.later else ()
                self._set(scope, name, tuple(dict.fromkeys((*self._texts(action.value, scope), *perhaps))), scope.certain)
                self._note_unset(action, scope)
            texts = scope.values[name]
            required = action.value is None
            self.arguments.append(
                Argument(
                    name,
                    texts,
                    action.span,
                    self._depth,
                    is_given,
                    action.choices,
                    action.description,
                    required,
                    computed=not (is_given or required or all(map(is_settled, action.value.texts if action.value else ()))),
                )
            )
            if scope.certain and len(texts) == 1 and is_settled(texts[0]) and self._is_refused(texts[0], action):
                self.refused.append(Refused(name, texts[0], action.choices, action.span))

    @staticmethod
    def _is_refused(value: str, action: LaunchAction) -> bool:
        return bool(action.choices) and all(map(is_settled, action.choices)) and value not in action.choices

    def _set(self, scope: LaunchScope, name: str, texts: Texts, certain: bool) -> None:
        present = scope.values.get(name)
        if certain or present is None:
            scope.values[name] = texts
        else:
            scope.values[name] = tuple(dict.fromkeys((*present, *texts)))

    def _reset(self, action: LaunchAction, scope: LaunchScope) -> LaunchScope:
        """Apply an action such as ResetLaunchConfigurations, and return the scope (the settings in effect) after the action.

        All launch configurations are cleared, then those in the action's arguments are set. Namespaces, parameters and
        remappings are cleared as well, because launch_ros stores them in launch configurations.
        """
        configurations = {name: self._texts(value, scope) for name, value in action.arguments}
        if scope.certain:
            scope.values.clear()
            scope.values.update(configurations)
            return scope._replace(namespace=("",), parameters=(), remappings=())
        for name in scope.values:
            self._set(scope, name, configurations.get(name, (UNKNOWN,)), certain=False)
        return scope._replace(namespace=(*scope.namespace, ""))

    def _pushed(self, action: LaunchAction, scope: LaunchScope) -> LaunchScope:
        """Return the scope after an action that sets a namespace, parameter, remapping or environment variable."""
        texts = self._texts(action.value, scope)
        if action.kind == "namespace":
            return scope._replace(namespace=_joined_namespaces(scope.namespace, texts if scope.certain else (*texts, "")))
        if not scope.certain and action.kind != "parameter":
            texts = (*texts, UNKNOWN)
        names = self._texts(action.target, scope) or ("",)
        self._note_unset(action, scope)
        if action.kind == "remap":
            return scope._replace(remappings=(*scope.remappings, (names, texts)))
        if action.kind == "parameter":
            span, changes = (action.value.span, self._filling.changes(action.value, scope)) if action.value else (None, ())
            given = [GivenParameter(name, texts, span, scope.certain, changes, is_rule=True) for name in names]
            self._note_changed_files(action, given, scope)
            return scope._replace(parameters=(*scope.parameters, *given))
        environment = dict(scope.environment)
        if action.name is None:
            pairs = tuple((name, texts) for name in names)
        else:
            separators = self._texts(dict(action.arguments).get("separator"), scope) or (":",)
            order = -1 if action.name.texts == ("prepend",) else 1
            rows = [(environment.get(name, (UNKNOWN,)), separators, texts)[::order] for name in names]
            pairs = tuple((name, joined(row, "".join)) for name, row in zip(names, rows, strict=True))
        return scope._replace(environment=(*(pair for pair in scope.environment if pair[0] not in names), *pairs))

    def _group(self, action: LaunchAction, scope: LaunchScope) -> LaunchScope:
        """Expand the actions in a group, and return the scope after the group."""
        name = self._texts(action.name, scope)
        inner = scope._replace(values=dict(scope.values)) if action.has_scope else scope
        if action.has_scope and name:
            inner = inner._replace(container=name, process=())
        for configuration, value in action.arguments:
            self._set(inner, configuration, self._texts(value, scope), certain=True)
        self._note_unset(action, scope)
        after = self._actions(action.children, inner)
        return scope if action.has_scope else after

    def _include(self, action: LaunchAction, scope: LaunchScope) -> LaunchScope:
        started = self._start(action, scope)
        for name, value in action.arguments:
            if name:
                self._set(scope, name, self._texts(value, scope), scope.certain)
        path = started.target[0] if len(started.target) == 1 else UNKNOWN
        file = self._files(path) if is_settled(path) else None
        self._may_be_set |= file is None or _may_set_more(file)
        if file is None:
            return scope
        self.started[-1] = started._replace(file=file.path)
        is_repeated = (path, scope.values) in self._open
        if is_repeated and scope.certain:
            self.circles.append(Circle(file.path, action.span))
        if is_repeated or self.circles or len(self._open) > _MAX_DEPTH:
            self.complete = False
            return scope
        self._via = self._via if self._depth else action.span
        self._open.append((path, dict(scope.values)))
        # An included file shares the configurations and the namespace, but not the folder.
        after = self._actions(
            file.actions, scope._replace(folder=(path.rpartition("/")[0],), include=action.span, container=(), process=())
        )
        self._open.pop()
        self._via = self._via if self._depth else None
        return after

    @property
    def _depth(self) -> int:
        return len(self._open) - 1

    def _start(self, action: LaunchAction, scope: LaunchScope) -> Started:
        is_process = action.kind == "process"
        self._filling.unknown.clear()
        if self._brief:
            words_only = tuple([argument for argument in action.arguments if not argument[0]])
            files_only = tuple([argument for argument in action.parameters if not argument[0]])
            action = action._replace(parameters=files_only, remappings=(), arguments=words_only)
        is_node = action.kind in ("node", "component")
        absent = _ABSENT if is_process else ""
        words = tuple([word for name, value in action.arguments if not name and (word := self._word(value, scope, absent))])
        named = [(name, self._texts(value, scope)) for name, value in action.arguments if name]
        given = self._given(action, scope) if is_node else ()
        started = Started(
            action.kind,
            self._texts(action.package, scope),
            joined(words, _command_line) if words and is_process else self._texts(action.target, scope),
            self._texts(action.name, scope),
            _joined_namespaces(scope.namespace, self._texts(action.namespace, scope) or ("",)),
            tuple([(one.name, (*one.texts, UNKNOWN) if one.is_rule and not one.certain else one.texts) for one in given]),
            (
                *(scope.remappings if is_node else ()),
                *((self._texts(a, scope), self._texts(b, scope)) for a, b in action.remappings),
            ),
            tuple(argument for argument in named if not argument[0].startswith("$")),
            scope.certain,
            action.span,
            self._depth,
            scope.container if action.kind == "component" else (),
            (
                *(pair for pair in scope.environment if pair[1] and action.kind in ("node", "process")),
                *((name[1:], texts) for name, texts in named if name.startswith("$")),
            ),
            unknown=tuple(self._filling.unknown),
            when=scope.when,
            why=scope.why,
            later=scope.later,
            trigger=scope.trigger,
            words=() if is_process else words,
            via=self._via,
        )
        self._note_unset(action, scope)
        words_of_files = [self._filling.given("", value, scope) for _, value in action.arguments if value.changes]
        self._note_changed_files(action, (*given, *[word for word in words_of_files if word is not None]), scope)
        if is_node and self._contents is not None:
            started = started._replace(final=self._final(started, given, scope, self._contents))
        self.started.append(started)
        return started

    def _note_changed_files(self, action: LaunchAction, given: Iterable[GivenParameter], scope: LaunchScope) -> None:
        """Record the files that launch reads because it changes them, and the configurations that parameter files need."""
        for one in given:
            if one.name or not one.certain or not any(change.certain for change in one.changes):
                continue
            self._note_opened(one.texts, one.span or action.span, scope)
            if not any(change.certain and change.kind == "substitute" for change in one.changes) or self._contents is None:
                continue
            file = self._contents(one.texts[0]) if len(one.texts) == 1 and is_settled(one.texts[0]) else None
            needed = () if file is None else file.configurations_read
            self._filling.unset.update(dict.fromkeys([name for name in needed if name not in scope.values and name != UNKNOWN]))
        self._note_unset(action, scope)

    def _word(self, value: LaunchValue, scope: LaunchScope, absent: str) -> Texts:
        """Return the possible texts of a word of a command line: () if the word is absent, with ``absent`` if it may be."""
        if not value.conditions:
            return self._texts(value, scope)
        truth, _ = self._filling.truth(value.conditions, scope)
        if truth is False:
            return ()
        return self._texts(value, scope) if truth else (*self._texts(value, scope), absent)

    def _given(self, action: LaunchAction, scope: LaunchScope) -> tuple[GivenParameter, ...]:
        """Return the parameters and parameter files that a node or component gets, in order."""
        own = [self._filling.given(name, value, scope) for name, value in action.parameters]
        return (*scope.parameters, *[given for given in own if given is not None])

    def _final(
        self, started: Started, given: Sequence[GivenParameter], scope: LaunchScope, contents: Contents
    ) -> FinalParameters:
        renamed = any(is_node_renaming(text) for texts in started.words for text in texts)
        names = () if renamed else started.name
        if not renamed and (not names or "" in names) and len(started.package) == len(started.target) == 1:
            own_name = self._node_name(started.package[0], started.target[0])
            names = tuple([name or own_name for name in names or ("",)]) if own_name else names
        node = NodeNames(names, started.namespace, started.target)
        return final_parameters(
            node,
            (*of_command_line(started.words), *given),
            contents,
            lambda text: self._filling.substituted(text, scope),
            scope.process,
            component=started.kind == "component",
        )


def _command_line(words: Sequence[str]) -> str:
    return " ".join([word for word in words if word != _ABSENT])


def _joined_namespaces(outer: Texts, inner: Texts) -> Texts:
    """Return the namespaces ``inner`` below the namespaces ``outer``: ``a`` below ``/b`` -> ``/b/a``.

    An absolute inner namespace replaces the outer namespace (``make_namespace_absolute`` of launch_ros).
    """
    return joined([outer, inner], _joined_namespace)


def _joined_namespace(row: Texts) -> str:
    outer, inner = row
    if inner.startswith("/") or not outer:
        return inner
    return f"{outer.rstrip('/')}/{inner}" if inner else outer


def _may_set_more(file: LaunchFile) -> bool:
    """Return whether a launch file may set configurations at places that are not analysed, apart from files that it includes."""
    if not file.opaque:
        return False
    included = {action.target.span for action in walk_actions(file.actions) if action.kind == "include" and action.target}
    return any(opaque.span not in included for opaque in file.opaque)
