"""Facts about source files: places with names that belong to other packages, such as includes and imports."""

from __future__ import annotations

from typing import Final, Literal, NamedTuple

from ros_lint.base.text import Span
from ros_lint.facts.interfaces import InterfaceFile
from ros_lint.facts.manifest import Role
from ros_lint.facts.visibility import Opaque, Problem

Via = Literal["package", "cmake", "macro", "target", "include", "import", "interface", "symbol", "launch", "key"]
"""Kind of a name that may belong to another package. Each kind has its own way to find the package of a name.

Example: the library of the rosdep key ``eigen`` has the name ``Eigen3`` in find_package() and ``Eigen/`` in an include.
"""

Purpose = Literal["", "export", "interfaces", "plugins", "helper", "tool", "conditional", "unused"]
"""Purpose for which a place uses a package, if a collector recognizes it. "" is the usual case: the code uses the package.

* "export": to pass the package on to dependents.
* "interfaces": to generate code for messages, services or actions.
* "plugins": the used package loads plugins that this package provides.
* "helper": a command of another package of the workspace calls the package.
* "tool": to run a program of the package in the build.
* "conditional": for a part of a robot model that xacro leaves out unless an argument is passed.
* "unused": for an import whose names the source never uses.
"""


class Mention(NamedTuple):
    """A place with a name that may belong to another package, e.g. an ``#include``."""

    name: str
    """Name as written: a header, a dotted module, an argument of find_package, a package, ``pkg/Type``."""
    via: Via
    """Kind of the name: include, import and so on."""
    span: Span
    """Place of the name."""
    what: str = ""
    """Text for messages that quotes the place; "" if the name alone is enough."""
    optional: bool = False
    """True if the code works without the package, because of QUIET and X_FOUND, try/except ImportError or __has_include."""
    test: bool = False
    """True if the place certainly serves tests only."""
    purpose: Purpose = ""
    """Purpose for which the package is used."""


class Use(NamedTuple):
    """A place that needs another package: a Mention whose name was resolved to packages. Dependency rules read only uses."""

    package: str
    """The package or rosdep key that is best to declare for the use."""
    providers: tuple[str, ...]
    """All packages and rosdep keys of which one must be declared. ``package`` is the first."""
    role: Role
    """All purposes for which the place needs the package."""
    what: str
    """Text for messages that quotes the place: "#include <std_msgs/msg/string.hpp>"."""
    via: Via
    """Kind of the name at the place: include, import and so on."""
    optional: bool
    """True if the code works without the package."""
    span: Span
    """Place of the name."""
    certain: bool = True
    """False if the file with the place may be unused: it is not in a target, not installed and not a test."""
    name: str = ""
    """Name at the place, of the kind ``via``: a header path, a module, an argument of find_package()."""
    conditional: bool = False
    """True if the place is in a part of a robot model that xacro leaves out unless an argument is passed."""
    unused: bool = False
    """True if the place is an import whose names the source never uses."""


class LookUp(NamedTuple):
    """A file that code searches for in the share directory of a package."""

    package: str
    """Package in whose share directory the file is searched for."""
    path: str
    """Path below share/<package>."""
    span: Span
    """Place of the look-up in the code."""


class MachinePath(NamedTuple):
    """An absolute or workspace-relative path in a source that does not exist on other machines.

    It is below a home directory, is a relative path into the ``src`` folder of the workspace, or is below ``/opt/ros``.
    """

    path: str
    """Path without a slash at the end.

    Examples: ``/home/jay/ros2_ws/src/robot/config/robot.yaml``, ``src/robot/config/robot.yaml``.
    """
    span: Span
    """Place of the path in the source."""
    is_written: bool = False
    """True if the path is an output: a program opens it for writing, or the name of the variable suggests writing."""
    relative_to_file: bool = False
    """True if the program that reads the path resolves a relative path from the folder of the file with the path."""
    parameter_default: bool = False
    """True if the path is the default value of a node parameter that the code declares."""
    generated_from: str = ""
    """Name of the file from which xacro generated the file with the path, "" if no header of xacro names one."""
    is_rviz_description: bool = False
    """True if RViz reads the robot description from this path. It opens the path as written, without ``package://``."""

    @property
    def distribution(self) -> str:
        """The distribution of a path below ``/opt/ros``, "" for other paths."""
        return self.path.split("/")[3] if self.path.startswith("/opt/ros/") else ""


class ImportedType(NamedTuple):
    """A message, service or action type that Python code imports by name: ``from robot.msg import State``."""

    name: str
    """Name of the type, as ``robot/msg/State``."""
    span: Span
    """Place of the name in the import."""
    module: Span
    """Place of the module name as written. The Use of the package that provides the module has the same span."""


ParameterType = Literal["bool", "integer", "double", "string", "bool_array", "integer_array", "double_array", "string_array", ""]
"""Type of a parameter in the words of rclcpp; "" if it is unknown, as for a list without elements."""


PARAMETERS_KEY: Final = "ros__parameters"
"""The key in a parameter file above the parameters of a node, and below the name of the node."""
ANY_NODE: Final = "/**"
"""The name in a parameter file that stands for any node."""
ANY_PART: Final = "*"
"""The part of the name of a declared parameter, such as ``pid.*.p``, that stands for any name."""


class FileParameter(NamedTuple):
    """A parameter of a node in a parameter file."""

    node: str
    """Name of the node as rcl stores it: the keys above ``ros__parameters``, joined by slashes."""
    name: str
    """Name of the parameter, with dots between nested keys."""
    text: str
    """The value as written, without quotes; a list as ``[1, 2]``."""
    type: ParameterType
    """Type that rcl_yaml_param_parser derives from the notation of the value."""
    span: Span
    """Place of the last key of the name."""


class ParameterFile(NamedTuple):
    """A YAML file with parameters of nodes, as read by rcl_yaml_param_parser."""

    path: str
    """Path of the file, relative to the base folder of the run."""
    nodes: tuple[tuple[str, Span], ...]
    """Full names of the nodes with parameters, with a leading slash, and their places; ``*`` and ``**`` are wildcards.

    Empty if the file has no key ``ros__parameters``.
    """
    first: Span
    """Place of the first key."""
    configurations_read: tuple[str, ...] = ()
    """Names of the launch configurations that launch substitutes if the node's ParameterFile has ``allow_substs``."""
    parameters: tuple[FileParameter, ...] = ()
    """The parameters of all nodes, in order. A parameter can occur several times."""
    refusals: tuple[Problem, ...] = ()
    """Reasons why rcl_yaml_param_parser refuses the file, so that a node that reads the file stops."""


class DeclaredParameter(NamedTuple):
    """A declaration of a parameter of a node: a call in C++ or Python code, or a key in a file of generate_parameter_library."""

    name: str
    """Name of the parameter. Parts of it may be :data:`ANY_PART`."""
    type: ParameterType
    """Type that values of the parameter must have; "" if it is unknown, or if the type may change (``dynamic_typing``)."""
    span: Span
    """Place of the name."""


class NodeCode(NamedTuple):
    """The nodes and parameters in a C++ or Python file, or in a YAML file of generate_parameter_library."""

    path: str
    """Path of the file, relative to the base folder of the run."""
    names: tuple[str, ...] = ()
    """Names that the file gives to nodes, as in ``Node("driver")``."""
    declared: tuple[DeclaredParameter, ...] = ()
    """Parameters that the file declares with a literal name."""
    words: tuple[str, ...] = ()
    """String literals in the file that may be names of parameters or parts of them, sorted."""
    complete: bool = True
    """False if the file may declare parameters whose names are computed, or accepts parameters that are not declared."""
    topics: tuple[str, ...] | None = ()
    """Names of the topics, services and actions that the file creates, sorted; None if some of them are computed."""


class Registration(NamedTuple):
    """A C++ macro call that makes a class loadable: RCLCPP_COMPONENTS_REGISTER_NODE or PLUGINLIB_EXPORT_CLASS."""

    kind: Literal["component", "plugin"]
    """"component" for RCLCPP_COMPONENTS_REGISTER_NODE, "plugin" for PLUGINLIB_EXPORT_CLASS."""
    name: str
    """Name of the class as written, without a leading ``::``."""
    span: Span
    """Place of the class name."""
    base: str = ""
    """Base class of a plugin, without a leading ``::``; "" for a component."""


class PluginLoader(NamedTuple):
    """An object in C++ that loads plugins, created with literal arguments (``pluginlib::ClassLoader``)."""

    package: str
    """Package that declares the base class, to which other packages export plugins."""
    base: str
    """Name of the base class of the plugins, with its namespaces."""
    span: Span
    """Place of the package name."""


class FileFacts(NamedTuple):
    """All facts of one source file that concern other packages."""

    mentions: tuple[Mention, ...] = ()
    opaque: tuple[Opaque, ...] = ()
    registrations: tuple[Registration, ...] = ()
    lookups: tuple[LookUp, ...] = ()
    parameters: ParameterFile | None = None
    optional_modules: tuple[str, ...] = ()
    """Python modules that may be missing, because the file imports them in ``try`` with ``except ImportError``.

    Relative names begin with dots.
    """
    path_additions: tuple[Span, ...] = ()
    """Places of imports after code that adds a folder with the name of the module to ``sys.path``."""
    programs: tuple[str, ...] = ()
    """Names of Python files at the end of string literals, because a test may start such a file by its path."""
    sets_path: bool = False
    """True if the file mentions ``sys.path``, so that its imports may find modules in further folders."""
    loaders: tuple[PluginLoader, ...] = ()
    types: tuple[ImportedType, ...] = ()
    """Message, service and action types that the file imports by name."""
    nodes: NodeCode | None = None
    """Nodes and parameters in the file if it is C++ or Python code with nodes or parameters, else None."""
    interface: InterfaceFile | None = None
    """Contents of the file if it is a .msg, .srv or .action file, else None."""
