"""Facts about source files: the names of other packages' contents, and where they are used."""

from __future__ import annotations

from typing import Literal, NamedTuple

from ros_lint.base.text import Span
from ros_lint.facts.interfaces import InterfaceFile
from ros_lint.facts.manifest import Role
from ros_lint.facts.visibility import Opaque

Via = Literal["package", "cmake", "macro", "target", "include", "import", "interface", "symbol", "launch", "key"]
"""Name space in which a mention is resolved: each kind of name has its own.

Example: the rosdep key ``eigen`` is ``Eigen3`` to find_package() and ``Eigen/`` in an include.
"""

Purpose = Literal["", "export", "interfaces", "plugins", "helper", "tool", "conditional", "unused"]
"""Purpose for which a package is used, as far as a collector knows it; "" is the usual case: code.

* "export": to pass the package on to dependents.
* "interfaces": to generate the code of interfaces.
* "plugins": the used package loads plugins that the package with the script provides.
* "helper": a command of another package of the workspace calls the package.
* "tool": to run a program of the package in the build.
* "conditional": for a part of a model that xacro leaves out unless an argument is passed.
* "unused": for an import whose names the source never uses.
"""


class Mention(NamedTuple):
    """A place with a name that may belong to another package."""

    name: str
    """Name as written: a header, a dotted module, an argument of find_package, a package, ``pkg/Type``."""
    via: Via
    """Kind of the name."""
    span: Span
    """The place."""
    what: str = ""
    """Quotation of the place for a message, if the name alone is not enough."""
    optional: bool = False
    """True if the code works without the package:

    QUIET and X_FOUND, try/except ImportError, __has_include.
    """
    test: bool = False
    """True if the place is known to serve tests only."""
    purpose: Purpose = ""
    """Purpose for which the package is used."""


class Use(NamedTuple):
    """A place that needs another package: a mention with a resolved name. Dependency rules read only uses."""

    package: str
    """The package or rosdep key to declare: the best provider."""
    providers: tuple[str, ...]
    """Each name whose declaration satisfies the use, ``package`` first."""
    role: Role
    """All purposes for which this place needs the package."""
    what: str
    """Quotation of the place for a message: "#include <std_msgs/msg/string.hpp>"."""
    via: Via
    """Kind of the name."""
    optional: bool
    """True if the code works without the package."""
    span: Span
    """The place."""
    certain: bool = True
    """False if the file may be unused: it is not in a target, not installed and not a test."""
    name: str = ""
    """Name at the place, in the name space ``via``: a header path, a module, a name of find_package."""
    conditional: bool = False
    """True if the place is in a part of a model that xacro leaves out unless an argument is passed."""
    unused: bool = False
    """True if the place is an import whose names the source never uses."""


class LookUp(NamedTuple):
    """A file that code looks up in the share directory of a package."""

    package: str
    """Package in whose share directory the file is looked up."""
    path: str
    """Path below share/<package>."""
    span: Span
    """The place."""


class MachinePath(NamedTuple):
    """An absolute or workspace-relative path that other machines do not have.

    It is below a home directory, leads into the sources from the folder above them, or is below ``/opt/ros``.
    """

    path: str
    """Path without a slash at the end.

    Examples: ``/home/jay/ros2_ws/src/robot/config/robot.yaml``, ``src/robot/config/robot.yaml``.
    """
    span: Span
    """The place of the path."""
    is_written: bool = False
    """True if the path is an output: a program opens it for writing, or the name of the variable implies it."""
    relative_to_file: bool = False
    """True if the reader of the path would resolve a relative path from the folder of the file."""
    parameter_default: bool = False
    """True if the path is the default of a parameter that a program declares."""
    generated_from: str = ""
    """The name of the file from which xacro generated the file with the path, "" if its header names none."""
    is_rviz_description: bool = False
    """True if RViz reads the robot description from this path. It opens the path as written, without ``package://``."""

    @property
    def distribution(self) -> str:
        """The distribution of a path below ``/opt/ros``, "" for other paths."""
        return self.path.split("/")[3] if self.path.startswith("/opt/ros/") else ""


class ImportedType(NamedTuple):
    """A message, service or action imported by name in Python: ``from robot.msg import State``."""

    name: str
    """Name as ``robot/msg/State``."""
    span: Span
    """The place of the name."""
    module: Span
    """Span of the module as written.

    The use of the package that provides the module has the same span.
    """


class ParameterFile(NamedTuple):
    """A YAML file, as far as it contains parameters of nodes (rcl_yaml_param_parser)."""

    path: str
    """Path of the file, relative to the base of the run."""
    nodes: tuple[tuple[str, Span], ...]
    """Full names of nodes with parameters, with a leading slash; ``*`` and ``**`` are wildcards.

    Empty if the file has no ``ros__parameters``.
    """
    first: Span
    """Span of the first key."""
    configurations_read: tuple[str, ...] = ()
    """Launch configurations that are substituted if the node's ParameterFile has ``allow_substs``."""


class Registration(NamedTuple):
    """A C++ macro that makes a class loadable: RCLCPP_COMPONENTS_REGISTER_NODE or PLUGINLIB_EXPORT_CLASS."""

    kind: Literal["component", "plugin"]
    """"component" for RCLCPP_COMPONENTS_REGISTER_NODE, "plugin" for PLUGINLIB_EXPORT_CLASS."""
    name: str
    """Class as written, without a leading ``::``."""
    span: Span
    """The place of the class."""
    base: str = ""
    """Base class of a plugin, without a leading ``::``; "" for a component."""


class PluginLoader(NamedTuple):
    """A loader of plugins in C++ with literal arguments (``pluginlib::ClassLoader``)."""

    package: str
    """Package to which plugins are exported."""
    base: str
    """Base class of the plugins, with its namespaces."""
    span: Span
    """Span of the package."""


class FileFacts(NamedTuple):
    """The facts of one source file about other packages."""

    mentions: tuple[Mention, ...] = ()
    opaque: tuple[Opaque, ...] = ()
    registrations: tuple[Registration, ...] = ()
    lookups: tuple[LookUp, ...] = ()
    parameters: ParameterFile | None = None
    optional_modules: tuple[str, ...] = ()
    """Python modules that may be missing: ``try: import a`` with ``except ImportError``.

    Relative modules begin with dots.
    """
    path_additions: tuple[Span, ...] = ()
    """Imports after the file added a folder of the module's name to ``sys.path``."""
    programs: tuple[str, ...] = ()
    """Names of Python files at the end of string literals: a test may start such a file by path."""
    sets_path: bool = False
    """True if the file mentions ``sys.path``, so that modules may be found in more folders."""
    loaders: tuple[PluginLoader, ...] = ()
    types: tuple[ImportedType, ...] = ()
    """Messages, services and actions imported by name."""
    interface: InterfaceFile | None = None
    """Contents of an interface definition, except for IDL."""
