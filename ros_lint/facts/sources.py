"""What source files say about other packages."""

from __future__ import annotations

from typing import Literal, NamedTuple

from ros_lint.base.text import Span
from ros_lint.facts.interfaces import InterfaceFile
from ros_lint.facts.manifest import Role
from ros_lint.facts.visibility import Opaque

Via = Literal["package", "cmake", "macro", "target", "include", "import", "interface", "symbol", "launch", "key"]
"""In which of the name spaces a mention is to be looked up; they differ (reference, section D6 and E3.8)."""

Purpose = Literal["", "export", "interfaces", "plugins", "helper", "tool"]
"""What CMake takes a package for: to hand it on to those who find this one, to generate the code of interfaces, because it
loads the plugins of this one, because a command that another package of the workspace gives has it in itself, or to run a
program of it in the build. Most is for code, and nothing says so."""


class Mention(NamedTuple):
    """A place that names something which may belong to another package."""

    name: str
    """As written: a header path, a dotted module, the argument of find_package, a package name, ``pkg/Type``."""
    via: Via
    span: Span
    what: str = ""
    """How to quote it in a message, when the name alone does not do."""
    optional: bool = False
    """Guarded, so that the package does without: QUIET and X_FOUND, try/except ImportError, __has_include."""
    test: bool = False
    """Known to serve tests only."""
    purpose: Purpose = ""


class Use(NamedTuple):
    """A place that needs another package: a mention whose name has been resolved. Dependency rules read only these."""

    package: str
    """The package or rosdep key to declare for it: the best of the providers."""
    providers: tuple[str, ...]
    """Every name that satisfies the use when it is declared, ``package`` first."""
    role: Role
    """All that it is needed for here."""
    what: str
    """How a message quotes it: "#include <std_msgs/msg/string.hpp>"."""
    via: Via
    optional: bool
    span: Span
    certain: bool = True
    """False where the file may be dead: in no target, not installed, no test."""
    name: str = ""
    """What is named there, as ``via`` says: the path of a header, a module, a name of find_package."""


class LookUp(NamedTuple):
    """A file that is looked up in the share directory of a package."""

    package: str
    path: str
    """Below share/<package>."""
    span: Span


class MachinePath(NamedTuple):
    """A path below the home directory of somebody, into the sources from the folder above them, or into ``/opt/ros``."""

    path: str
    """As ``/home/jay/ros2_ws/src/robot/config/robot.yaml`` or ``src/robot/config/robot.yaml``, without a slash at the end."""
    span: Span
    is_written: bool = False
    """Whether a program opens it to write to it, or what is made goes there by the name of the variable."""
    relative_to_file: bool = False
    """Whether whoever reads it would seek a relative one from the folder of the file."""
    parameter_default: bool = False
    """Whether it is the default of a parameter that a program declares."""

    @property
    def distribution(self) -> str:
        """The distribution that a path into ``/opt/ros`` is of, "" for others."""
        return self.path.split("/")[3] if self.path.startswith("/opt/ros/") else ""


class ImportedType(NamedTuple):
    """A message, service or action by its name in an import of Python: ``from robot.msg import State``."""

    name: str
    """As ``robot/msg/State``."""
    span: Span
    module: Span
    """Of the module as written, where the package has a use of the other one."""


class ParameterFile(NamedTuple):
    """A YAML file, as far as it is one of parameters (rcl_yaml_param_parser)."""

    path: str
    nodes: tuple[tuple[str, Span], ...]
    """Full names of the nodes that it has parameters for, with a leading slash; ``*`` and ``**`` stand for any part. Empty:
    it has no ``ros__parameters`` at all."""
    first: Span
    """Of its first key."""
    configurations_read: tuple[str, ...] = ()
    """Launch configurations that are filled in, if whoever gives it to a node allows that (``allow_substs``)."""


class Registration(NamedTuple):
    """A macro in C++ that makes a class loadable: RCLCPP_COMPONENTS_REGISTER_NODE or PLUGINLIB_EXPORT_CLASS."""

    kind: Literal["component", "plugin"]
    name: str
    """The class as written, without a leading ``::``."""
    span: Span
    base: str = ""
    """Of a plugin: the class that it is loaded as, likewise."""


class PluginLoader(NamedTuple):
    """A loader of plugins in C++ that says in words what it loads (``pluginlib::ClassLoader``)."""

    package: str
    """For which plugins are exported."""
    base: str
    """The class that they are loaded as, with its namespaces."""
    span: Span
    """Of the package."""


class FileFacts(NamedTuple):
    """What one source file says about other packages."""

    mentions: tuple[Mention, ...] = ()
    opaque: tuple[Opaque, ...] = ()
    registrations: tuple[Registration, ...] = ()
    lookups: tuple[LookUp, ...] = ()
    parameters: ParameterFile | None = None
    optional_modules: tuple[str, ...] = ()
    """Python modules that may be missing: ``try: import a`` with ``except ImportError``. Relative ones begin with their dots."""
    path_additions: tuple[Span, ...] = ()
    """Imports of modules after whose names the file adds a folder to those in which modules are sought."""
    programs: tuple[str, ...] = ()
    """Names of Python files that its literals end with: a test starts some of them by path."""
    sets_path: bool = False
    """Whether it speaks of ``sys.path``, so that modules may be sought in more folders."""
    loaders: tuple[PluginLoader, ...] = ()
    types: tuple[ImportedType, ...] = ()
    """Messages, services and actions that it imports by name."""
    interface: InterfaceFile | None = None
    """What a definition of an interface says, but for one in IDL."""
