"""The result of the expansion of a launch file: what it starts, and why launching it fails."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from ros_lint.base.text import Span
    from ros_lint.collectors.launch.final_parameters import FinalParameters, Texts
    from ros_lint.facts.launch import LaunchCondition


class Started(NamedTuple):
    """A node, component, process or included file that a launch file starts."""

    kind: str
    """The kind of the started action: ``node``, ``component``, ``process`` or ``include``."""
    package: Texts
    """Possible packages, () if there is no package. ``launch.is_plain`` returns False for a text with an unknown part."""
    target: Texts
    """Possible values of the executable, the component class, the command line or the path of the included file."""
    name: Texts
    """Possible names that the launch file gives to the node, () if it sets no name."""
    namespace: Texts
    """Possible full namespaces of the node."""
    parameters: tuple[tuple[str, Texts], ...]
    """Parameters with their possible values, by name. A parameter file has the name ""."""
    remappings: tuple[tuple[Texts, Texts], ...]
    """Remappings: the possible old names and the possible new names."""
    arguments: tuple[tuple[str, Texts], ...]
    """Launch arguments of an include with their possible values, by name."""
    certain: bool
    """False if the action is started under a condition whose truth is unknown."""
    span: Span
    """Place of the action in its launch file."""
    depth: int
    """The number of includes between the launched file and the action."""
    container: Texts = ()
    """The possible full names of the container that loads the component."""
    environment: tuple[tuple[str, Texts], ...] = ()
    """Environment variables that the launch file sets for the node or process, with their possible values."""
    file: str = ""
    """The path of an included file, as :attr:`LaunchFile.path`; "" if the file could not be read."""
    unknown: tuple[str, ...] = ()
    """The reasons why parts of the texts are unknown."""
    when: tuple[LaunchCondition, ...] = ()
    """The conditions of unknown truth around the action; empty if ``certain``."""
    why: tuple[str, ...] = ()
    """The reasons why the conditions in ``when`` are unknown, as clauses of a message."""
    later: bool = False
    """True if a timer or an event starts the action."""
    trigger: Texts = ()
    """The class of the event handler that starts the action, or the possible periods of the timer such as ``5.0 s``."""
    words: tuple[Texts, ...] = ()
    """The command-line arguments of a node, each with its possible values."""
    via: Span | None = None
    """The place of the include in the launched file that leads to this action, None if the launched file contains it."""
    final: FinalParameters | None = None
    """The parameters with which the node or component starts; None if they are not requested."""


class Argument(NamedTuple):
    """A declared launch argument and its possible values in an expansion."""

    name: str
    """Name of the argument."""
    texts: Texts
    """Possible values of the argument."""
    span: Span
    """Place of the declaration."""
    depth: int
    """Number of includes between the launched file and the declaration."""
    given: bool
    """True if the caller or the including file passes the value, False if the value is the default."""
    choices: tuple[str, ...] = ()
    """The values that the argument accepts; () if it accepts any value."""
    description: str = ""
    """The description of the argument; "" if there is none or if it is computed."""
    required: bool = False
    """True if the argument has no default value."""
    computed: bool = False
    """True if the value is a default that depends on other values, such as those of other arguments."""


class Missing(NamedTuple):
    """A declared launch argument that has no default value and to which no value is passed."""

    name: str
    """Name of the argument."""
    span: Span
    """The place of the declaration."""
    include: Span | None = None
    """The place of the include that lacks the argument, None for an argument of the launched file."""


class Refused(NamedTuple):
    """A value of a launch argument that is not among the ``choices`` of the declaration of the argument."""

    name: str
    """Name of the argument."""
    value: str
    """The value that is not accepted."""
    choices: tuple[str, ...]
    """The values that the argument accepts."""
    span: Span
    """The place of the declaration."""


class Circle(NamedTuple):
    """An include of a file that is already being included with equal launch configurations: an endless recursion."""

    path: str
    """The path of the included file, as :attr:`LaunchFile.path`."""
    span: Span
    """The place of the include."""


class Unset(NamedTuple):
    """A launch configuration that an action needs and that has no value when launch executes the action."""

    name: str
    """Name of the launch configuration."""
    span: Span
    """The place of the action."""
    include: Span | None = None
    """The place of the include of the file with the action, None for the launched file."""


class Opened(NamedTuple):
    """A file that a launch file, or launch, certainly opens before it starts any node."""

    path: str
    """The path, in the form of the path of an include."""
    span: Span
    """The place in the launch file that leads to it."""


class Raised(NamedTuple):
    """An exception that a launch file raises on purpose."""

    span: Span
    """The place of the statement that raises it."""
    message: str
    """The message of the exception, "" if it is computed."""


class Expansion(NamedTuple):
    """The result of an expansion: all that a launch file starts, in order, and the errors in its launch arguments."""

    started: tuple[Started, ...]
    """Nodes, components, processes and includes."""
    missing: tuple[Missing, ...]
    """Required arguments without a value."""
    complete: bool
    """False if the expansion stopped early, because includes are cyclic or a limit was exceeded."""
    arguments: tuple[Argument, ...] = ()
    """The arguments in the order of their declarations."""
    refused: tuple[Refused, ...] = ()
    """Values that are not among the choices of their arguments."""
    circles: tuple[Circle, ...] = ()
    """Includes with endless recursion."""
    variables: tuple[str, ...] = ()
    """Environment variables without default that the launch file reads, in order."""
    raised: tuple[Raised, ...] = ()
    """Exceptions that end the launch."""
    unset: tuple[Unset, ...] = ()
    """Launch configurations without value. They are left out if a part that cannot be followed may set them."""
    opened: tuple[Opened, ...] = ()
    """Files that are read during the launch, except launch files."""
