"""Facts of Python launch files, which are interpreted symbolically and never run.

An action counts only if it is launched: an action that is created but neither returned nor added starts nothing.
"""

from __future__ import annotations

import ast
from contextlib import suppress
from typing import TYPE_CHECKING

from ros_lint.base.budget import BudgetExceeded
from ros_lint.base.python_parser import compile_error
from ros_lint.base.text import Span, Text
from ros_lint.collectors.launch.detect import entries
from ros_lint.collectors.launch.presence_checks import is_guarded_by_presence
from ros_lint.collectors.launch.python.actions import LAUNCHED, walker
from ros_lint.collectors.launch.python.argument_checks import dropped_paths, rejected_arguments
from ros_lint.collectors.launch.python.description_checks import description_problems
from ros_lint.collectors.launch.python.events import readings
from ros_lint.collectors.launch.python.import_checks import misplaced_imports
from ros_lint.collectors.launch.python.library import PACKAGE_SUBSTITUTIONS
from ros_lint.collectors.launch.python.meaning import LaunchLibraries
from ros_lint.collectors.launch.python.newer_features import newer_features
from ros_lint.collectors.launch.python.old_distributions import alternatives_for_old
from ros_lint.collectors.launch.python.runtime_errors import (
    divided_texts,
    misused_substitutions,
    undefined_names,
    wrong_conditions,
    wrong_texts,
)
from ros_lint.collectors.launch.python.substitutions import TextEvaluation, texts
from ros_lint.collectors.launch.references import References
from ros_lint.collectors.python.interpreter.alternatives import alternatives
from ros_lint.collectors.python.interpreter.machine import Machine
from ros_lint.collectors.python.interpreter.values import (
    PERHAPS,
    Conditions,
    Frame,
    Function,
    Modules,
    ProgramRaised,
    Source,
)
from ros_lint.collectors.python.source_errors import NotPythonError
from ros_lint.collectors.python.syntax import read, refusal, span_of
from ros_lint.collectors.symbolic_text import UNKNOWN
from ros_lint.facts.launch import OPENED, LaunchAction, LaunchFile, LaunchValue
from ros_lint.facts.visibility import Facet, Opaque, Problem

_MAX_LENGTH = 250_000
_CONFIGURATIONS = (".launch_configurations", "test_args")
"""Mappings of all launch configurations: that of the launch context, and the one that launch_testing passes to tests."""

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator


def collect(
    source: Text, modules: Modules = lambda name, importer: None, files: Callable[[str], str | None] = lambda path: None
) -> LaunchFile:
    """Return the facts of a Python launch file. Errors in the file are in the result; none raises an exception.

    ``modules`` returns a module of the workspace that the file imports. ``files`` returns the text of a file by its installed
    path, None if there is no such file.
    """
    defined = entries(source.text)
    if len(source.text) > _MAX_LENGTH:
        opaque = Opaque(Facet.USES, "the file is too long to be interpreted", source.span(0, 0))
        return LaunchFile(source.path, "python", opaque=(opaque,), test="launch" not in defined, helper=not defined)
    test, helper = "launch" not in defined and "test" in defined, not defined
    try:
        tree, newer = read(source)
    except NotPythonError as error:
        syntax_refusal = refusal(source, error)
        problems = (syntax_refusal.problem(),) if syntax_refusal.known else ()
        return LaunchFile(source.path, "python", (), (syntax_refusal.opaque(Facet.USES),), problems, test, helper)
    helper = helper or any(_has_required_parameters(node) for node in tree.body)
    interpretation = _Interpretation(source, Machine(modules, files, LaunchLibraries()))
    try:
        interpretation.read(tree, helper)
    except (BudgetExceeded, RecursionError, MemoryError):
        interpretation.stop("interpreting the file takes too many steps")
    interpretation.problems.extend(interpretation.runtime_problems(tree))
    interpretation.forgive_old_keywords(tree)
    references = References(interpretation.actions, interpretation.places())
    interpretation.add_to(references)
    return LaunchFile(
        source.path,
        "python",
        references.all(),
        tuple(references.opaque),
        tuple(dict.fromkeys([*_compile_errors(tree, source)] or [*interpretation.problems, *references.problems])),
        test,
        helper,
        tuple(interpretation.actions),
        tuple(_imports(source, tree)),
        interpretation.configurations_read(),
        tuple(sorted(map(str, interpretation.missing_inputs))),  # the cache accepts only plain str
        version_problems=tuple(dict.fromkeys(interpretation.newer_features(tree))),
        syntax=newer,
    )


def _compile_errors(tree: ast.Module, source: Text) -> Iterator[Problem]:
    """Yield the errors of the Python compiler in a file, such as a repeated keyword argument."""
    if (error := compile_error(tree)) is not None:
        from ros_lint.collectors.python.compile_errors import misplaced  # noqa: PLC0415  (few launch files have any)

        yield from misplaced(error, tree, source)


def _has_required_parameters(node: ast.stmt) -> bool:
    """Return whether a statement defines generate_launch_description() with required parameters.

    A file with such a function is a helper of other launch files, because launch calls the function without arguments.
    """
    if not isinstance(node, ast.FunctionDef) or node.name != "generate_launch_description" or node.decorator_list:
        return False
    parameters = node.args
    return len(parameters.posonlyargs) + len(parameters.args) > len(parameters.defaults) or None in parameters.kw_defaults


def _imports(text: Text, tree: ast.Module) -> Iterator[tuple[str, Span]]:
    """Yield the modules that a source imports at its top level without a condition, each with its span.

    Nothing is yielded if the source contains ``sys.path``, because it may change where modules are found.
    """
    if "sys.path" in text.text:
        return
    for statement in tree.body:
        if isinstance(statement, ast.Import):
            yield from ((alias.name, span_of(text, alias)) for alias in statement.names)
        elif isinstance(statement, ast.ImportFrom):
            yield "." * statement.level + (statement.module or ""), span_of(text, statement)


class _Interpretation:
    """The interpretation of one launch file, from its syntax tree to its actions."""

    def __init__(self, text: Text, machine: Machine) -> None:
        self._machine = machine
        self._source = Source(text)
        self._walker = walker(machine, self._source)
        self.actions: list[LaunchAction] = []
        self._opaque: list[Opaque] = []

    @property
    def missing_inputs(self) -> set[str]:
        return self._machine.wanted

    @property
    def problems(self) -> list[Problem]:
        return self._walker.problems

    def runtime_problems(self, tree: ast.Module) -> Iterator[Problem]:
        yield from undefined_names(tree, self._source, self._machine.unbound)
        yield from misused_substitutions(tree, self._source, self._machine.misused)
        yield from divided_texts(tree, self._source, self._machine.divided)
        yield from wrong_texts(tree, self._source, self._machine.made)
        yield from wrong_conditions(tree, self._source, self._machine.made)
        yield from rejected_arguments(tree, self._source, self._machine.made)
        yield from description_problems(tree, self._source)
        yield from dropped_paths(tree, self._source)
        yield from misplaced_imports(tree, self._source)

    def forgive_old_keywords(self, tree: ast.Module) -> None:
        """Drop the problems of removed keywords that the file uses only in distributions which have these keywords."""
        if any(problem.kind == "removed-keyword" for problem in self.problems):
            old = list(alternatives_for_old(tree, self._source.text))
            self.problems[:] = [
                problem
                for problem in self.problems
                if problem.kind != "removed-keyword" or not any(span.covers(problem.span) for span in old)
            ]

    def newer_features(self, tree: ast.Module) -> Iterator[Problem]:
        return newer_features(tree, self._source, self._machine.made)

    def read(self, tree: ast.Module, helper: bool) -> None:
        frame = self._machine.run(tree, self._source)
        for name in ("generate_launch_description", "generate_test_description"):
            function = frame.names.get(name)
            if isinstance(function, Function):
                result = self._call(function, name, frame)
                opened = readings(self._machine.opened, (), OPENED)
                started = self._walker.actions(result)
                self.actions += [*opened, *self._walker.actions(self._machine.variables), *started]
                if function.changed:
                    place = span_of(self._source.text, function.node)
                    self._opaque.append(Opaque(Facet.USES, f"the decorator of {name}() cannot be followed", place))
        if helper:
            for name, function in list(frame.names.items()):
                if isinstance(function, Function) and function.frame is frame:
                    self._call(function, name, frame)
        self._add_escaped(all_objects=helper)

    def _call(self, function: Function, name: str, frame: Frame) -> object:
        call = ast.Call(ast.Name(name), [], [])
        ast.copy_location(call, function.node)
        try:
            return self._machine.call(function, [], {}, call, frame)
        except ProgramRaised:
            self.stop(f"{name}() raises an exception")
            return None

    def configurations_read(self) -> tuple[str, ...]:
        """Return the names of the launch configurations that the file reads, sorted.

        UNKNOWN is among the names if the file may read further configurations, for example with a computed name.
        """
        evaluation = TextEvaluation()
        names = {
            str(name)
            for launch_object in self._machine.made
            if launch_object.name.startswith("LaunchConfig")  # includes LaunchConfigAsBool of nav2_common
            for name in texts(launch_object.get(0, "variable_name", "launch_configuration_name"), evaluation)
        }
        if self._machine.borrows or any(word in self._source.text.text for word in _CONFIGURATIONS):
            names.add(UNKNOWN)
        return tuple(sorted(names))

    def _mark_optional(self, references: References) -> None:
        """Mark the references to a package as optional if the file can be loaded without the package.

        A look-up of a missing package while the file is loaded stops the file, unless the exception is caught or a condition
        tests for the package.
        """
        optional = {package: True for package, *_ in self._machine.looked_up if package not in self._machine.lazily}
        for package, _, _, conditions in self._machine.looked_up:
            if not is_guarded_by_presence(conditions):
                optional.pop(package, None)
        references.mark_optional(optional)

    def places(self) -> dict[str, Span]:
        """Return the span of the first look-up of each package, by package name."""
        return {package: self._walker.look_up_span(package) for package in self._machine.named}

    def stop(self, reason: str) -> None:
        """Record that the interpretation stopped early. From then on, every created object may be launched."""
        at = self._machine.stopped_at
        self._opaque.append(Opaque(Facet.USES, reason, span_of(at[1].text, at[0]) if at else self._source.text.span(0, 0)))
        self._machine.grant()
        with suppress(BudgetExceeded, RecursionError, MemoryError):
            self._add_escaped(all_objects=True)

    def _add_escaped(self, all_objects: bool) -> None:
        """Add the actions of the objects of launch classes that were passed to unknown code, because this may launch them.

        ``all_objects`` adds the actions of all objects of launch classes that are not launched otherwise.
        """
        for launch_object in self._machine.made:
            if not launch_object.seen and (launch_object.escaped or all_objects) and launch_object.name in LAUNCHED:
                self.actions += self._walker.actions(launch_object, (PERHAPS,))

    def add_to(self, references: References) -> None:
        """Add the files and packages that the launch file reads while it is loaded, and the places that cannot be evaluated.

        They are added to ``references``.
        """
        for path, node, source, conditions in self._machine.opened:
            if source is self._source:
                references.note_opened(self._walker.text(path, node, source), conditions)
        self._mark_optional(references)
        references.mark_fallbacks(self._machine.fallbacks)
        references.mark_guarded(path for paths in self._machine.asked.values() for path in paths)
        for package, node, source, conditions in self._machine.looked_up:
            value = self._walker.text(package, node, source)
            if value.texts == (package,):
                references.note_look_up(package, value, conditions)
        for package, value, conditions in self._passed_look_ups():
            references.note_passed(package, value, conditions)
        for reason, span in self._walker.unknown_launches:
            references.hide(f"the launched actions are not known: {reason}", span)
        for what, call, source in self._machine.cut_off:
            references.hide(f"the file contains {what}", span_of(source.text, call))
        for opaque in self._opaque:
            references.opaque[opaque] = None

    def _passed_look_ups(self) -> Iterator[tuple[str, LaunchValue, Conditions]]:
        """Yield the packages of substitutions that code outside of the interpretation gets, with place and conditions.

        Such code probably builds an action with the substitution, so that launch looks up the package.
        """
        for launch_object in self._machine.made:
            if launch_object.escaped and launch_object.name in PACKAGE_SUBSTITUTIONS:
                for alternative in alternatives(launch_object.get(0, "package"), launch_object.conditions):
                    name = alternative.value
                    if isinstance(name, str) and name in self._machine.named:
                        yield str(name), self._walker.text(str(name), *self._machine.named[name]), alternative.conditions
