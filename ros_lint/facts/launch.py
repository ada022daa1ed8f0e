"""Facts about launch files. Values that depend on launch arguments are still unknown."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final, Literal, NamedTuple

from ros_lint.base.text import Span
from ros_lint.facts.visibility import NewerSyntax, Opaque, Problem

LAUNCH_LIBRARIES: Final = frozenset({"launch", "launch_ros", "launch_xml", "launch_yaml"})
"""The Python packages of which ``ros2 launch`` consists."""

LAUNCH_RUNTIME: Final = LAUNCH_LIBRARIES | {"ament_index_python"}
"""The Python packages that exist in every installation of ``ros2 launch``."""


ACCEPTED_PROBLEMS: Final = frozenset({"forgotten-path", "no-slash", "substitution-as-text"})
"""Kinds of problems of a launch file that ``ros2 launch`` does not detect: it starts the file with wrong values."""


OPENED: Final = "file"
"""The ``description`` of a ``read`` action if the text is the path of a file that the launch file opens."""

TIMER: Final = "TimerAction"
"""The ``name`` of a ``later`` action that a timer starts."""


class LaunchValue(NamedTuple):
    """The possible values of a text in a launch file."""

    texts: tuple[str, ...]
    """The alternative texts, at least one.

    Private-use Unicode characters stand for parts that are known only at launch, such as the value of a launch
    configuration. ``launch.is_plain`` returns True for a text without such characters.
    """
    span: Span
    """Place of the text in the launch file."""
    exact: bool = False
    """True if ``span`` covers only this text, without its quotes, and there is one alternative, so that a fix can replace it."""
    conditions: tuple[LaunchCondition, ...] = ()
    """Conditions of a parameter or parameter file. It is passed to the node only if all of them hold."""
    guards: tuple[tuple[LaunchCondition, ...], ...] = ()
    """For each of ``texts`` the conditions under which it is the value; () if no text has conditions."""
    changes: tuple[FileChange, ...] = ()
    """Changes of a parameter file, or of a file in an argument, in order, before the node reads it."""


class FileChange(NamedTuple):
    """A change of the contents of a parameter file before a node reads them, made by launch."""

    kind: Literal["rewrite", "exchange", "replace", "substitute"]
    """Kind of the change.

    * ``rewrite``: values of parameters and keys are replaced (RewrittenYaml of nav2_common).
    * ``exchange``: values that equal a text are replaced (``value_rewrites`` of RewrittenYaml).
    * ``replace``: texts are replaced (ReplaceString of nav2_common).
    * ``substitute``: substitutions such as ``$(var name)`` are performed (``allow_substs``).
    """
    values: tuple[tuple[str, LaunchValue], ...] = ()
    """New values by the name of the parameter, or new values or texts by the old one."""
    keys: tuple[tuple[str, LaunchValue], ...] = ()
    """New keys by the old key."""
    root: LaunchValue | None = None
    """Key that is put above the contents; None for no key."""
    complete: bool = True
    """False if the file is changed in further ways that are unknown."""
    conditions: tuple[LaunchCondition, ...] = ()
    """Conditions of the change. It is made only if all of them hold."""


class LaunchCondition(NamedTuple):
    """A condition under which an action runs: a text equals a value, or is true.

    If ``wanted`` is False, the condition is negated.
    """

    texts: tuple[str, ...]
    """Alternatives of the text, in the form of ``LaunchValue.texts``."""
    equals: str | None
    """The value that the text must equal; None if the text must be true in the sense of IfCondition."""
    wanted: bool = True
    """False if the condition is negated, as by UnlessCondition."""


UNSCOPED: Final = "unscoped"
"""The ``name`` of a group action with ``scoped=False``, whose settings remain in effect after its end."""


class LaunchAction(NamedTuple):
    """An action of a launch file, before the values of launch arguments are known. Its kind decides which fields are used."""

    kind: str
    """Kind of the action.

    One of ``argument``, ``set``, ``unset``, ``node``, ``component``, ``include``, ``group``, ``process``, ``namespace``,
    ``remap``, ``parameter``, ``environment``, ``unset_environment``, ``reset`` (of all launch configurations except those
    in ``arguments``), ``reset_environment``, ``later`` (actions of a timer or an event handler), ``raise`` (of an exception in
    a function that launch calls), ``read`` (of launch configurations or a file by the program itself) or ``other``.
    """
    span: Span
    """Place of the action: in Python the whole call, in XML and YAML the name of the element."""
    package: LaunchValue | None = None
    """Name of the package of a node or component."""
    package_span: Span | None = None
    """Place of the package name in a look-up of the path ``target``; None if ``target`` is not looked up in a package."""
    target: LaunchValue | None = None
    """Main operand of the action, which depends on its kind.

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
    * ``remap``: the new name. ``namespace``: the namespace. ``later``: the period of a timer in seconds.
    * ``read``: a text with the launch configurations, or the path of the file.
    """
    name: LaunchValue | None = None
    """Name of a node or component; None if the launch file does not set the name. For ``later``, the class of the event handler.

    The alternative "" means that the launch file may not set the name, as in ``name="a" if condition else None``. If
    unknown keywords (``Node(**keywords)``) may set the name, its only text is not plain (``launch.is_plain``).
    """
    namespace: LaunchValue | None = None
    """Namespace of a node or component; None if the action does not set it. Alternatives are as in ``name``."""
    arguments: tuple[tuple[str, LaunchValue], ...] = ()
    """Values that the action passes by name.

    * ``include``: the launch arguments.
    * ``later``: the launch configurations that the launch file has read before; ``children`` may contain their values.
    * ``process``, ``node``: the words of the command line under "", and further options: ``$VARIABLE`` for an environment
      variable, ``cwd``, ``prefix``.
    """
    argument_spans: tuple[Span, ...] = ()
    """Places of the names of the launch arguments of an include: one for each of ``arguments``, or () if unknown."""
    choices: tuple[str, ...] = ()
    """Values that a declared launch argument accepts; () if it accepts any value."""
    description: str = ""
    """Description of a declared launch argument, or the message of an exception; "" if there is none or if it is computed."""
    parameters: tuple[tuple[str, LaunchValue], ...] = ()
    """Names and values of the parameters of a node.

    The name of a parameter file is "". A single entry whose name is not plain (``launch.is_plain``) stands for all
    unknown parameters.
    """
    remappings: tuple[tuple[LaunchValue, LaunchValue], ...] = ()
    """Remappings of a node or component: pairs of old and new name.

    All unknown remappings are represented by one pair whose texts are not plain (``launch.is_plain``).
    """
    conditions: tuple[LaunchCondition, ...] = ()
    """Conditions of the action. The action runs only if all of them hold."""
    children: tuple[LaunchAction, ...] = ()
    """Actions inside this action, which is a group, a container, an event handler or a timer."""
    conditional_arguments: tuple[str, ...] = ()
    """Names of launch arguments that an include gets only under a condition whose value is unknown."""
    builtin_model: bool = False
    """True if a function of a released package, called by the launch file, names the executable. That package then needs it."""

    @property
    def has_scope(self) -> bool:
        """True for a group without ``scoped=False``: launch configurations and remappings set in it end with the group."""
        return self.kind == "group" and (self.name is None or self.name.texts != (UNSCOPED,))


ReferenceKind = Literal["node", "component", "include", "command", "program", "file", "package"]
"""Kind of what a launch file refers to. "package" is a reference to a package without an executable or file in it.

For "program", the package is a rosdep key.
"""


BESIDE: Final = ""
"""The package of a reference to a file that is named from the folder of the launch file (``$(dirname)``, ``__file__``).

The name is then the path relative to that folder. Only collectors return such references:
``workspace.launch_places`` replaces them by references to the package of the launch file.
"""


class LaunchReference(NamedTuple):
    """A place in a launch file that refers to a package, and mostly to an executable, class or file of the package."""

    kind: ReferenceKind
    """Kind of what the place refers to."""
    package: str
    """Name of the package."""
    name: str
    """Name of the executable, class, command or file in the package; "" for a look-up of the package alone.

    A file is a path below share/<package>.
    """
    span: Span
    """Place of the name, or of the package if there is no name."""
    package_span: Span
    """Place of the package name."""
    conditional: bool = False
    """True if the reference is used only under a condition that may be false."""
    exact: bool = True
    """True if ``span`` covers exactly the name, so that a fix can replace the text."""
    package_exact: bool = True
    """True if ``package_span`` covers exactly the package name, so that a fix can replace the text."""
    optional: bool = False
    """True if the launch file works without the package.

    The launch file checks first whether the package exists, or refers to it for some distributions only.
    """
    from_default: bool = False
    """True if the reference exists only with the default values of the launch arguments."""
    package_from_default: bool = False
    """True if the package name is composed from the default of a launch argument, so the file does not contain it literally."""
    surely_read: bool = False
    """True if the started program certainly reads the file (parameters or RViz configuration), so it is not an output file."""
    existence_checked: bool = False
    """True if the launch file checks first whether the file exists, and works without it."""
    fallback_for: tuple[tuple[str, str], ...] = ()
    """Files whose existence the launch file checks first, as pairs of package and path below share/<package>.

    The reference is used only if these files do not exist.
    """
    distros: tuple[str, ...] = ()
    """Distributions of ROS in which the reference is used, sorted, if the launch file checks ROS_DISTRO.

    () means all distributions.
    """


class LaunchFile(NamedTuple):
    """The contents of a launch file that are known without running it."""

    path: str
    """Path of the file, relative to the base folder of the run."""
    language: Literal["python", "xml", "yaml"]
    """Language of the file, which decides how launch reads it."""
    references: tuple[LaunchReference, ...] = ()
    """Packages, executables and files that the file refers to."""
    opaque: tuple[Opaque, ...] = ()
    """Parts of the file that ros-lint could not evaluate."""
    problems: tuple[Problem, ...] = ()
    """Errors because of which launch rejects the file."""
    test: bool = False
    """True if the file serves tests only, because it has generate_test_description() (launch_testing)."""
    helper: bool = False
    """True if the file cannot be launched itself.

    It is a Python module that creates actions for other launch files, but has no generate_launch_description() without
    required parameters.
    """
    actions: tuple[LaunchAction, ...] = ()
    """Actions at the top level of the file, in order. ``launch.walk_actions`` also yields the actions inside them."""
    imports: tuple[tuple[str, Span], ...] = ()
    """Dotted names of the modules that a Python launch file always imports, with their places.

    Empty if the file changes ``sys.path``.
    """
    configurations_read: tuple[str, ...] = ()
    """Names of the launch configurations that the file reads, sorted.

    A name that is not plain (``launch.is_plain``) means that the file may read further, unknown configurations.
    """
    missing_inputs: tuple[str, ...] = ()
    """Inputs of a Python launch file that did not exist when ros-lint interpreted the file, sorted.

    An input is the dotted name of a module, or the install path of a file.
    """
    substitutes_parameters: bool = False
    """True if the file substitutes launch configurations in a parameter file (``allow_substs``).

    Such a parameter file can read any launch configuration.
    """
    version_problems: tuple[Problem, ...] = ()
    """Problems in older distributions only. ``kind`` is the first distribution without the problem."""
    syntax: tuple[NewerSyntax, ...] = ()
    """Constructs in a Python launch file that older versions of Python reject."""


def walk_actions(actions: Iterable[LaunchAction]) -> Iterator[LaunchAction]:
    """Yield ``actions`` and, recursively, the actions inside each of them."""
    for action in actions:
        yield action
        yield from walk_actions(action.children)


def values_of_action(action: LaunchAction) -> Iterator[tuple[str, Span]]:
    """Yield each text of an action and of its conditions, with its place. The actions inside it are left out."""
    for value in values(action):
        yield from ((text, value.span) for text in value.texts)
    for condition in action.conditions:
        yield from ((text, action.span) for text in condition.texts)


def values(action: LaunchAction) -> Iterator[LaunchValue]:
    """Yield each LaunchValue of an action. The actions inside it are left out."""
    for value in (action.package, action.target, action.value, action.name, action.namespace):
        if value is not None:
            yield value
    for _, value in (*action.arguments, *action.parameters):
        yield value
    for pair in action.remappings:
        yield from pair
