"""Facts about launch files, before the values of their arguments are known."""

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
    """The possible values of a text in a launch file."""

    texts: tuple[str, ...]
    """The alternatives, at least one.

    Parts that are known only at launch, such as the value of a launch configuration, are marks: characters of the
    private use area. ``launch.is_plain`` returns True for a text without marks.
    """
    span: Span
    """Place of the text."""
    exact: bool = False
    """True if ``span`` covers exactly the only text, without its quotes, so that a fix can replace it."""
    conditions: tuple[LaunchCondition, ...] = ()
    """Conditions of a parameter or parameter file; it is passed only if all of them hold."""
    guards: tuple[tuple[LaunchCondition, ...], ...] = ()
    """For each of ``texts`` the conditions under which it applies; () if no text has conditions."""


class LaunchCondition(NamedTuple):
    """A condition under which an action runs: a text equals a value (or is true), or does not if negated."""

    texts: tuple[str, ...]
    """Alternatives of the text, with the same marks as ``LaunchValue.texts``."""
    equals: str | None
    """The value that the text must equal; None: the text must be true in the sense of IfCondition."""
    wanted: bool = True
    """False if the condition is negated (UnlessCondition)."""


UNSCOPED: Final = "unscoped"
"""The ``name`` of a group whose settings remain in effect after its end (``scoped=False``)."""


class LaunchAction(NamedTuple):
    """An action of a launch file, before the values of launch arguments are known. The kind decides which fields are used."""

    kind: str
    """Kind of the action.

    One of ``argument``, ``set``, ``unset``, ``node``, ``component``, ``include``, ``group``, ``process``, ``namespace``,
    ``remap``, ``parameter``, ``environment``, ``unset_environment``, ``reset`` (of all launch configurations, except those
    in ``arguments``), ``reset_environment``, ``later`` (actions of a timer or an event handler) or ``other``.
    """
    span: Span
    """Place of the action: in Python the whole call, in XML and YAML the name of the element."""
    package: LaunchValue | None = None
    """Package of a node or component."""
    package_span: Span | None = None
    """Place of the package that ``target`` looks up."""
    target: LaunchValue | None = None
    """Main operand of the action, by its kind.

    * ``node``: the executable. ``component``: the class. ``process``: the program.
    * ``include``: the file.
    * ``argument``, ``set``, ``unset``: the name of the launch configuration.
    * ``environment``, ``unset_environment``: the name of the variable.
    * ``remap``: the old name. ``parameter``: the name of the parameter, None for a parameter file.
    """
    value: LaunchValue | None = None
    """Value that the action sets.

    * ``argument``: the default, None if the argument is required.
    * ``set``, ``environment``, ``parameter``: the value. For a parameter file, the file.
    * ``remap``: the new name. ``namespace``: the namespace.
    """
    name: LaunchValue | None = None
    """Name of a node or component; None if the launch file does not set it.

    The alternative "" means that the file may not set it, as in ``name="a" if condition else None``. If unknown keywords
    (``Node(**keywords)``) may set it, its only text is not plain (``launch.is_plain``). The same holds for the namespace.
    """
    namespace: LaunchValue | None = None
    """Namespace of a node or component; None if the action does not set it. See ``name``."""
    arguments: tuple[tuple[str, LaunchValue], ...] = ()
    """Values passed by name.

    For an include, the launch arguments. For a process or node, the words of the command line under "", and further
    options: ``$VARIABLE`` of its environment, ``cwd``, ``prefix``.
    """
    argument_spans: tuple[Span, ...] = ()
    """Places of the names of the arguments of an include: one for each of ``arguments``, or none."""
    choices: tuple[str, ...] = ()
    """Values that an argument accepts; () if it accepts any."""
    parameters: tuple[tuple[str, LaunchValue], ...] = ()
    """Parameters by name.

    A parameter file has the name "". Unknown parameters together have a name that is not plain (``launch.is_plain``).
    """
    remappings: tuple[tuple[LaunchValue, LaunchValue], ...] = ()
    """Remappings of a node or component: old name and new name. Unknown remappings together are a pair that is not plain."""
    conditions: tuple[LaunchCondition, ...] = ()
    """Conditions that must all hold."""
    children: tuple[LaunchAction, ...] = ()
    """Actions inside: of a group, a container, an event handler or a timer."""
    conditional_arguments: tuple[str, ...] = ()
    """Names of arguments that an include gets only under a condition of unknown value."""
    builtin_model: bool = False
    """True if a launch helper of a released package names the executable, so that the helper depends on it."""

    @property
    def has_scope(self) -> bool:
        """True for a group without ``scoped=False``: launch configurations and remappings in it end with the group."""
        return self.kind == "group" and (self.name is None or self.name.texts != (UNSCOPED,))


ReferenceKind = Literal["node", "component", "include", "command", "program", "file", "package"]
"""Kind of the thing that a launch file names and starts or reads; "package" is a package without anything in it.

For "program", the package is a rosdep key.
"""


class LaunchReference(NamedTuple):
    """A place in a launch file that names a package, and mostly something in it."""

    kind: ReferenceKind
    """Kind of the thing that the file names."""
    package: str
    """Name of the package."""
    name: str
    """Name of the thing in the package, "" for a plain look-up of the package.

    An executable, a component class, a command of a shell, or a path below share/<package>.
    """
    span: Span
    """Span of the name, or of the package if there is no name."""
    package_span: Span
    """Place of the name of the package."""
    conditional: bool = False
    """True if the action is under a condition that may be false."""
    exact: bool = True
    """True if ``span`` covers exactly the name, so that a fix can replace it."""
    package_exact: bool = True
    """True if ``package_span`` covers exactly the package, so that a fix can replace it."""
    optional: bool = False
    """True if the launch file works without the package.

    It checks first that the package exists, or names it in some distributions only.
    """
    from_default: bool = False
    """True if the reference holds only with the default values of the launch arguments."""
    package_from_default: bool = False
    """True if the name of the package is composed from the default of an argument, so it is not literal."""
    surely_read: bool = False
    """True if the started program certainly reads the file: parameters, RViz configurations.

    Such a file cannot be an output.
    """
    existence_checked: bool = False
    """True if the launch file checks first that the file exists, and works without it."""
    fallback_for: tuple[tuple[str, str], ...] = ()
    """Files whose absence the launch file checks first, as package and path below its share directory.

    The reference is used only if they do not exist.
    """
    distros: tuple[str, ...] = ()
    """Distributions in which the reference is reached, sorted, if the launch file checks ROS_DISTRO.

    Empty if it is reached in all distributions.
    """


class LaunchFile(NamedTuple):
    """A launch file, as far as it is known without running it."""

    path: str
    """Path of the file, relative to the base of the run."""
    language: Literal["python", "xml", "yaml"]
    """Front end of launch that reads the file."""
    references: tuple[LaunchReference, ...] = ()
    """Packages, executables and files that the file names."""
    opaque: tuple[Opaque, ...] = ()
    """Places that could not be evaluated."""
    problems: tuple[Problem, ...] = ()
    """Errors for which launch rejects the file."""
    test: bool = False
    """True if the file serves tests only: it has generate_test_description() (launch_testing)."""
    helper: bool = False
    """True if the file cannot be launched itself.

    It is a Python module that builds actions, but it has no generate_launch_description() that can be called
    without arguments.
    """
    actions: tuple[LaunchAction, ...] = ()
    """Actions at the top level of the file, in order. ``launch.walk_actions`` also yields those in groups."""
    imports: tuple[tuple[str, Span], ...] = ()
    """Dotted names of modules that a Python launch file imports whenever it is loaded.

    Empty if the file changes ``sys.path``.
    """
    configurations_read: tuple[str, ...] = ()
    """Launch configurations that the file reads, sorted. A name that is not plain means: any other, too."""
    missing_inputs: tuple[str, ...] = ()
    """Inputs of a Python launch file that were not available when ros-lint interpreted it, sorted.

    Modules are dotted names, files are install paths.
    """
    substitutes_parameters: bool = False
    """True if launch configurations are substituted in a parameter file (allow_substs).

    The parameter file can read any configuration.
    """
    version_problems: tuple[Problem, ...] = ()
    """Problems that only older distributions have; ``kind`` is the first distribution without the problem."""
    syntax: tuple[NewerSyntax, ...] = ()
    """Constructs in a Python launch file that older versions of Python reject."""


def walk_actions(actions: Iterable[LaunchAction]) -> Iterator[LaunchAction]:
    """Yield actions and, recursively, their child actions."""
    for action in actions:
        yield action
        yield from walk_actions(action.children)


def values_of_action(action: LaunchAction) -> Iterator[tuple[str, Span]]:
    """Yield each text of an action and of its conditions with its span, without child actions."""
    for value in values(action):
        yield from ((text, value.span) for text in value.texts)
    for condition in action.conditions:
        yield from ((text, action.span) for text in condition.texts)


def values(action: LaunchAction) -> Iterator[LaunchValue]:
    """Yield each value of an action, without child actions."""
    for value in (action.package, action.target, action.value, action.name, action.namespace):
        if value is not None:
            yield value
    for _, value in (*action.arguments, *action.parameters):
        yield value
    for pair in action.remappings:
        yield from pair
