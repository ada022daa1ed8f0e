"""What launch files do, before it is known how they are called."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final, Literal, NamedTuple

from ros_lint.base.text import Span
from ros_lint.facts.visibility import NewerSyntax, Opaque, Problem

LAUNCH_LIBRARIES: Final = frozenset({"launch", "launch_ros", "launch_xml", "launch_yaml"})
"""The Python packages of ``ros2 launch`` itself."""

LAUNCH_RUNTIME: Final = LAUNCH_LIBRARIES | {"ament_index_python"}
"""The Python packages that every installation of ``ros2 launch`` has."""


class LaunchValue(NamedTuple):
    """What a text in a launch file can be when it runs."""

    texts: tuple[str, ...]
    """Each alternative, never empty; with the marks of :mod:`ros_lint.collectors.symbolic_text` for what is not known yet."""
    span: Span
    exact: bool = False
    """Whether ``span`` covers the only text and nothing else, so that a fix can put another one there."""
    conditions: tuple[LaunchCondition, ...] = ()
    """Of a parameter or a file of them: what must be so for it to be given. All of them must hold."""


class LaunchCondition(NamedTuple):
    """What must be so for an action to be taken."""

    texts: tuple[str, ...]
    """With the same marks."""
    equals: str | None
    """The text must be this one; None: it must mean true, as IfCondition takes it."""
    wanted: bool = True
    """False: it must not."""


UNSCOPED: Final = "unscoped"
"""The ``name`` of a group that leaves set what is set in it."""


class LaunchAction(NamedTuple):
    """What a launch file does, before it is known how it is called. Which fields count depends on the kind."""

    kind: str
    """``argument``, ``set``, ``node``, ``component``, ``include``, ``group``, ``process``, ``namespace``, ``remap``,
    ``parameter``, ``environment``, ``later`` (what a timer or an event starts), or ``other``."""
    span: Span
    package: LaunchValue | None = None
    package_span: Span | None = None
    """Where a package is written that ``target`` looks up."""
    target: LaunchValue | None = None
    """The executable, class or file; the name of an argument, a configuration or a variable; the command line."""
    value: LaunchValue | None = None
    """The default of an argument, None if it has to be given; what is set or pushed."""
    name: LaunchValue | None = None
    namespace: LaunchValue | None = None
    arguments: tuple[tuple[str, LaunchValue], ...] = ()
    """What is passed to an included file by name; the words that a process or node is given, under "", and what else it is
    given by name: ``$VARIABLE`` of its environment, ``cwd``, ``prefix``."""
    argument_spans: tuple[Span, ...] = ()
    """Where the names of what is passed to an included file stand: one for each of ``arguments``, or none."""
    choices: tuple[str, ...] = ()
    parameters: tuple[tuple[str, LaunchValue], ...] = ()
    """By name; a file under "", any number of parameters that are not known under UNKNOWN."""
    remappings: tuple[tuple[LaunchValue, LaunchValue], ...] = ()
    conditions: tuple[LaunchCondition, ...] = ()
    """All of them must hold; an unknown one has UNKNOWN for its text."""
    children: tuple[LaunchAction, ...] = ()
    conditional_arguments: tuple[str, ...] = ()
    """Names of what is passed to an included file only if something holds of which nothing is known."""
    builtin_model: bool = False
    """Whether a helper of a released package names what is started: that is the need of the package that has the helper."""

    @property
    def has_scope(self) -> bool:
        """Whether what is set in it is put back at its end: a group that does not say otherwise."""
        return self.kind == "group" and (self.name is None or self.name.texts != (UNSCOPED,))


ReferenceKind = Literal["node", "component", "include", "command", "program", "file", "package"]
"""What a launch file names: what it starts or reads, or a package alone. The package of a program is a rosdep key."""


class LaunchReference(NamedTuple):
    """A line of a launch file that names a package, and mostly something in it."""

    kind: ReferenceKind
    package: str
    name: str
    """The executable, the component class, the command of a shell, or a path below share/<package>; "" for a plain look-up of
    the package."""
    span: Span
    """Of the name, or of the package where there is no name."""
    package_span: Span
    conditional: bool = False
    """Under a condition that may be false."""
    exact: bool = True
    """Whether ``span`` covers the name and nothing else, so that a fix can put another one there."""
    package_exact: bool = True
    """The same of ``package_span`` and the package."""
    optional: bool = False
    """Whether the launch file asks first if the package is there, and does without, or names it in some distributions only."""
    from_default: bool = False
    """Whether it holds only as long as nobody gives the arguments of the launch file other values than their defaults."""
    package_from_default: bool = False
    """The same of the package: its name is made of the default of an argument, and stands nowhere as it is."""
    surely_read: bool = False
    """Whether what is started reads this file for certain, so that it cannot be one that is written: parameters, displays."""
    existence_checked: bool = False
    """Whether the launch file asks first if this file is there, and does without."""
    distros: tuple[str, ...] = ()
    """The distributions that come to it, sorted, where a launch file asks which one runs; none if all do."""


class LaunchFile(NamedTuple):
    """A launch file, as far as it can be read without running it."""

    path: str
    language: Literal["python", "xml", "yaml"]
    references: tuple[LaunchReference, ...] = ()
    opaque: tuple[Opaque, ...] = ()
    problems: tuple[Problem, ...] = ()
    test: bool = False
    """Whether it serves tests only: it has generate_test_description() (launch_testing)."""
    helper: bool = False
    """Whether it cannot be launched itself: a Python module that builds actions, without a generate_launch_description() that
    can be called with nothing."""
    actions: tuple[LaunchAction, ...] = ()
    imports: tuple[tuple[str, Span], ...] = ()
    """Modules that a Python launch file imports whenever it is loaded, dotted as written; none if it changes where Python
    looks for them."""
    configurations_read: tuple[str, ...] = ()
    """Launch configurations that it asks for, wherever they go, sorted; with UNKNOWN for any other."""
    missing_inputs: tuple[str, ...] = ()
    """What a Python launch file reads besides itself, and that was not at hand when it was followed: modules, dotted, and
    files by their install path; sorted."""
    substitutes_parameters: bool = False
    """Whether launch configurations are filled into a file of parameters (allow_substs), which can ask for any."""
    version_problems: tuple[Problem, ...] = ()
    """What not every distribution takes; ``kind`` is the first that does."""
    syntax: tuple[NewerSyntax, ...] = ()
    """What not every version of Python reads in a Python launch file."""


def walk_actions(actions: Iterable[LaunchAction]) -> Iterator[LaunchAction]:
    """Yield actions and all those in them."""
    for action in actions:
        yield action
        yield from walk_actions(action.children)


def values_of_action(action: LaunchAction) -> Iterator[tuple[str, Span]]:
    """Yield every text of an action and its conditions with its place, but for those of the actions in it."""
    for value in values(action):
        yield from ((text, value.span) for text in value.texts)
    for condition in action.conditions:
        yield from ((text, action.span) for text in condition.texts)


def values(action: LaunchAction) -> Iterator[LaunchValue]:
    """Yield every text of an action, but for those of the actions in it."""
    for value in (action.package, action.target, action.value, action.name, action.namespace):
        if value is not None:
            yield value
    for _, value in (*action.arguments, *action.parameters):
        yield value
    for pair in action.remappings:
        yield from pair
