"""Evaluation of the texts and conditions of a launch action, given the values of the launch configurations."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.collectors.launch.expressions import evaluate, means_true
from ros_lint.collectors.launch.final_parameters import FilledChange, GivenParameter, Texts
from ros_lint.collectors.symbolic_text import (
    OWN_FOLDER,
    UNKNOWN,
    configurations,
    fill,
    is_settled,
    named_in,
    open_arguments,
    package_of_presence,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from ros_lint.base.text import Span
    from ros_lint.facts.launch import FileChange, LaunchCondition, LaunchValue


COMPUTED = "it is computed in a way that ros-lint cannot follow"
"""The reason why a text is unknown if no argument or environment variable is the reason."""


class LaunchScope(NamedTuple):
    """The launch configurations and other settings, such as the namespace, that are in effect for an action.

    ``values`` is a mutable dictionary: an action changes it for all later actions of the group or file. For a change of
    another field, an action creates a new LaunchScope for the later actions.
    """

    values: dict[str, Texts]
    folder: Texts
    namespace: Texts = ("",)
    certain: bool = True
    parameters: tuple[GivenParameter, ...] = ()
    remappings: tuple[tuple[Texts, Texts], ...] = ()
    environment: tuple[tuple[str, Texts], ...] = ()
    """Environment variables with their possible values, by name; an unset variable has no values."""
    container: Texts = ()
    process: tuple[GivenParameter, ...] = ()
    """The parameters of the container around a component, which are those of its process."""
    when: tuple[LaunchCondition, ...] = ()
    why: tuple[str, ...] = ()
    """Reasons why the conditions in ``when`` are unknown, as clauses of a message."""
    later: bool = False
    trigger: Texts = ()
    """What starts an action that is not started at once, as in :class:`Started`."""
    time: float | None = 0.0
    """The time in seconds after the start of the launch, None if it is unknown because an event comes before."""
    include: Span | None = None
    """The place of the include action that includes the current file, None for the launched file."""

    def after(self, inner: LaunchScope) -> LaunchScope:
        """Return this scope with the namespace, parameters, remappings and environment of ``inner``.

        ``inner`` is the scope after an action that ran in this scope.
        """
        return self._replace(
            namespace=inner.namespace,
            parameters=inner.parameters,
            remappings=inner.remappings,
            environment=inner.environment,
        )


class Filling:
    """Replaces launch configurations and environment variables in texts by their values in a scope.

    ``environment`` has the environment variables that have one value in all scopes, by name with a leading dollar sign.
    """

    def __init__(self, environment: Mapping[str, Texts]) -> None:
        self._environment = environment
        self.unknown: dict[str, None] = {}
        """Reasons why parts of the evaluated texts are unknown, since this dictionary was last cleared."""
        self.required: set[str] = set()
        """Names of launch arguments that have no default and no value."""
        self.variables: dict[str, None] = {}
        """Environment variables without default that evaluated texts need and that nothing sets."""
        self.unset: dict[str, None] = {}
        """Launch configurations without value and default that evaluated texts need, since this dictionary was last cleared."""

    def texts(self, value: LaunchValue | None, scope: LaunchScope) -> Texts:
        """Return the possible texts of a value in a scope, () if ``value`` is None."""
        if value is None:
            return ()
        if not value.guards:
            return self._filled(value.texts, scope)
        pairs = zip(value.texts, value.guards, strict=True)
        possible = tuple([text for text, guards in pairs if self.may_hold(guards, scope)])
        return self._filled(possible or value.texts, scope)

    def _filled(self, texts: Texts, scope: LaunchScope) -> Texts:
        if len(texts) == 1 and is_settled(texts[0]) and OWN_FOLDER not in texts[0]:
            return texts
        results: dict[str, None] = {}
        for text in texts:
            if is_settled(text) and OWN_FOLDER not in text:
                results[text] = None
                continue
            for filled in self._fill(text, scope):
                if OWN_FOLDER in filled:
                    results.update(dict.fromkeys([filled.replace(OWN_FOLDER, folder) for folder in scope.folder]))
                else:
                    results[filled] = None
                if UNKNOWN in filled:
                    self.unknown.update(dict.fromkeys(self._reasons(text, scope)))
                    if len(texts) == 1:
                        self.unset.update(dict.fromkeys(self._unset_in(text, scope)))
        return tuple(results)

    def _fill(self, text: str, scope: LaunchScope) -> Texts:
        names = named_in(text)
        if names is None:
            return fill(text, lambda name: self._value(name, scope), evaluate)
        return _filled_with(text, names, tuple([self._value(name, scope) for name in names]))

    def _value(self, name: str, scope: LaunchScope) -> Texts | None:
        if not name.startswith("$"):
            return scope.values.get(name)
        changed = dict(scope.environment)
        return changed[name[1:]] or None if name[1:] in changed else self._environment.get(name)

    def _reasons(self, text: str, scope: LaunchScope) -> Iterator[str]:
        """Yield the reasons why the text of a value is unknown in a scope, as clauses of a message."""
        for name, has_default, _ in configurations(text):
            value = self._value(name, scope)
            if name.startswith("$"):
                if value is None and not has_default:
                    self.variables[name[1:]] = None
                    yield f"the environment variable '{name[1:]}' is not known"
            elif value == (UNKNOWN,) and name in self.required:
                yield f"the argument '{name}' has no default; {name}:=VALUE decides it"
            elif value == (UNKNOWN,):
                yield f"the argument '{name}' is not known"
            elif value is None and not has_default:
                yield f"the launch configuration '{name}' is not set"
        if UNKNOWN in text:
            yield COMPUTED

    def _unset_in(self, text: str, scope: LaunchScope) -> Iterator[str]:
        """Yield the launch configurations in a text that have no value in a scope, and no default in the text."""
        for name, has_default, _ in configurations(text):
            if not has_default and not name.startswith("$") and is_settled(name) and name not in scope.values:
                yield name

    def given(self, name: str, value: LaunchValue, scope: LaunchScope) -> GivenParameter | None:
        """Return a parameter or parameter file (``name`` "") of a node in a scope, None if its conditions do not hold."""
        if not self.may_hold(value.conditions, scope):
            return None
        certain = not value.conditions or self.truth(value.conditions, scope)[0] is True
        unset = dict(self.unset)
        texts = self.texts(value, scope)
        if not certain:
            self.unset = unset
        return GivenParameter(name, texts, value.span, certain, self.changes(value, scope))

    def changes(self, value: LaunchValue, scope: LaunchScope) -> tuple[FilledChange, ...]:
        """Return the changes of a parameter file in a scope, in order."""
        return tuple([self._change(change, scope) for change in value.changes if self.may_hold(change.conditions, scope)])

    def _change(self, change: FileChange, scope: LaunchScope) -> FilledChange:
        values, keys = (tuple([(old, self.texts(new, scope)) for old, new in pairs]) for pairs in (change.values, change.keys))
        certain = not change.conditions or self.truth(change.conditions, scope)[0] is True
        return FilledChange(change.kind, values, keys, self.texts(change.root, scope), change.complete, certain)

    def substituted(self, text: str, scope: LaunchScope) -> Texts:
        """Return the possible results of the substitutions in a text, in the syntax of XML launch files."""
        from ros_lint.collectors.launch.markup.substitutions import symbolic  # noqa: PLC0415  (few parameter files have substitutions)

        return self._filled(symbolic(text), scope)

    def may_hold(self, conditions: Iterable[LaunchCondition], scope: LaunchScope) -> bool:
        """Return whether all conditions may hold in a scope: none of them is false.

        In contrast to :meth:`truth`, the attributes ``unknown`` and ``unset`` do not change.
        """
        reasons, unset = dict(self.unknown), dict(self.unset)
        truth, _ = self.truth(conditions, scope)
        self.unknown, self.unset = reasons, unset
        return truth is not False

    def truth(self, conditions: Iterable[LaunchCondition], scope: LaunchScope) -> tuple[bool | None, tuple[LaunchCondition, ...]]:
        """Return whether all conditions hold in a scope (None if unknown), and the conditions whose truth is unknown.

        In conditions with open arguments, the other launch configurations are replaced by their values.
        """
        unknown: list[LaunchCondition] = []
        for condition in conditions:
            truth = self._holds(condition, scope)
            if truth is False:
                return False, ()
            if truth is None:
                filled = self._filled(condition.texts, scope)
                is_open = any(map(open_arguments, filled))
                unknown.append(condition._replace(texts=filled) if is_open else condition)
        return (None if unknown else True), tuple(unknown)

    def _holds(self, condition: LaunchCondition, scope: LaunchScope) -> bool | None:
        answers: set[bool | None] = set()
        for text in self._filled(condition.texts, scope):
            if package_of_presence(text):
                answers.add(True)  # the expansion assumes that everything is installed
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


@lru_cache(maxsize=8_192)
def _filled_with(text: str, names: Texts, values: tuple[Texts | None, ...]) -> Texts:
    """Return the possible texts of ``text`` with the possible values ``values`` for the configurations ``names``.

    The result is cached, because texts and values recur in files that are often included.
    """
    return fill(text, dict(zip(names, values, strict=True)).get, evaluate)
