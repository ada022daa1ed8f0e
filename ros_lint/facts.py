"""What collectors find out: plain frozen values. No file is read here and nothing is looked up.

They are named tuples because a workspace has a hundred thousand of them: they start, are made, travel between
processes and are cached in half the time that frozen dataclasses take. The cache loads no class but those of this
module and of :mod:`ros_lint.text`.
"""

from __future__ import annotations

from bisect import bisect_right
from enum import Flag, auto
from typing import Literal, NamedTuple

from ros_lint.text import Span


class Facet(Flag):
    """A side of a package that something opaque can hide."""

    USES = auto()
    """Which packages it needs."""
    EXECUTABLES = auto()
    """What lands in lib/<package> and in bin."""
    SHARE = auto()
    """What lands in share/<package>: launch files, parameters, models."""
    PYTHON = auto()
    """Which Python modules it offers."""
    LIBRARIES = auto()
    """Libraries, headers, CMake packages and targets."""
    INTERFACES = auto()
    """Messages, services, actions."""
    COMPONENTS = auto()
    """Component and plugin classes."""


ANYTHING = Facet.USES | Facet.EXECUTABLES | Facet.SHARE | Facet.PYTHON | Facet.LIBRARIES | Facet.INTERFACES | Facet.COMPONENTS


class Opaque(NamedTuple):
    """A place that could not be seen through. A rule that claims absence keeps silent about what it hides."""

    hides: Facet
    reason: str
    """A clause without subject, such as "include() of ${name} cannot be followed"."""
    span: Span


class Problem(NamedTuple):
    """Something that makes a file wrong for the tools that read it."""

    kind: str
    """A short stable name, such as "unknown-tag"."""
    message: str
    span: Span


# --- package.xml ---------------------------------------------------------------------------------------------------


class Element(NamedTuple):
    """An element of a manifest that is no dependency: a child of ``<package>`` or of ``<export>``."""

    tag: str
    text: str
    attributes: tuple[tuple[str, str], ...]
    span: Span
    text_span: Span

    def get(self, attribute: str, default: str = "") -> str:
        return dict(self.attributes).get(attribute, default)


class Depend(NamedTuple):
    """A dependency element of a manifest, ``group_depend``, ``member_of_group``, ``conflict`` and ``replace`` included."""

    name: str
    tag: str
    condition: str
    """The text of the attribute, "" when there is none and " " when it is empty, which fails to parse. REP 149."""
    versions: tuple[tuple[str, str], ...]
    """Such as ("version_gte", "1.2.0")."""
    span: Span
    name_span: Span
    close: int = 0
    """Length of the end tag in code points, 0 when there is none or when it runs over a line end."""


class Manifest(NamedTuple):
    """A ``package.xml``, as far as it can be read. With problems, colcon takes it for no package."""

    path: str
    format: int
    name: str
    version: str
    elements: tuple[Element, ...]
    depends: tuple[Depend, ...]
    exports: tuple[Element, ...]
    problems: tuple[Problem, ...]
    name_span: Span
    end: Span
    """The empty span just before ``</package>``, where an element can be added."""
    begin: Span | None = None
    """The empty span just after ``<package ...>``; None when there is no such element."""
    format_span: Span | None = None
    """The value of the attribute ``format``; None when it has none, which means 1."""
    asides: tuple[Span, ...] = ()
    """Whatever else stands directly in ``<package>``: comments, instructions, stray text."""
    strays: tuple[Span, ...] = ()
    """Those of ``asides`` that are text."""
    indent: str = "  "
    """The white space before a child of ``<package>``."""
    newline: str = "\n"


# --- sources -------------------------------------------------------------------------------------------------------

Via = Literal["package", "cmake", "macro", "target", "include", "import", "interface", "symbol", "launch", "key"]
"""In which of the name spaces a mention is to be looked up; they differ (reference, section D6 and E3.8)."""


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


class LookUp(NamedTuple):
    """A file that is looked up in the share directory of a package."""

    package: str
    path: str
    """Below share/<package>."""
    span: Span


class ParameterFile(NamedTuple):
    """A YAML file, as far as it is one of parameters (rcl_yaml_param_parser)."""

    path: str
    nodes: tuple[tuple[str, Span], ...]
    """Full names of the nodes that it has parameters for, with a leading slash; ``*`` and ``**`` stand for any part. Empty:
    it has no ``ros__parameters`` at all."""
    first: Span
    """Of its first key."""
    asks: tuple[str, ...] = ()
    """Launch configurations that are filled in, if whoever gives it to a node allows that (``allow_substs``)."""


class FileFacts(NamedTuple):
    """What one source file says about other packages."""

    path: str
    mentions: tuple[Mention, ...] = ()
    opaque: tuple[Opaque, ...] = ()
    problems: tuple[Problem, ...] = ()
    registrations: tuple[Registration, ...] = ()
    look_ups: tuple[LookUp, ...] = ()
    parameters: ParameterFile | None = None
    caught: tuple[str, ...] = ()
    """Python modules that may be missing: ``try: import a`` with ``except ImportError``."""
    added: tuple[Span, ...] = ()
    """Imports of modules after whose names the file adds a folder to those in which modules are sought."""


class Role(Flag):
    """What a package is needed for."""

    BUILD = auto()
    EXPORT = auto()
    """To build against this package: its public headers and exported targets."""
    EXEC = auto()
    TEST = auto()
    TOOL = auto()
    """To run on the build machine."""


ROLES = {
    "depend": Role.BUILD | Role.EXPORT | Role.EXEC,
    "build_depend": Role.BUILD,
    "buildtool_depend": Role.TOOL,
    "build_export_depend": Role.EXPORT,
    "buildtool_export_depend": Role.TOOL | Role.EXPORT,
    "exec_depend": Role.EXEC,
    "run_depend": Role.EXPORT | Role.EXEC,
    "test_depend": Role.TEST,
}
"""What each dependency tag gives (REP 127, 140, 149; reference, section A1.4). Other tags give nothing."""


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
    sure: bool = True
    """False where the file may be dead: in no target, not installed, no test."""


# --- what else colcon reads ----------------------------------------------------------------------------------------


class ColconDepend(NamedTuple):
    """An ordering edge that colcon takes from elsewhere than the manifest: colcon.pkg, colcon.meta or a plain script."""

    name: str
    role: Role
    span: Span


class ColconSettings(NamedTuple):
    """What a ``colcon.pkg``, or an entry of a ``colcon.meta``, sets for a package."""

    name: str
    """"" when it sets none."""
    type: str
    """"" when it sets none."""
    depends: tuple[ColconDepend, ...]


class ColconMeta(NamedTuple):
    """A ``colcon.meta``."""

    path: str
    by_name: tuple[tuple[str, ColconSettings], ...]
    by_path: tuple[tuple[str, ColconSettings], ...]
    """Paths as written, relative to the file."""


# --- build scripts: CMakeLists.txt and setup.py in the same words --------------------------------------------------


class Target(NamedTuple):
    """An executable or a library that CMake builds."""

    name: str
    kind: Literal["executable", "library", "interface", "other"]
    sources: tuple[str, ...]
    """Relative to the package."""
    test: bool
    span: Span
    links: tuple[tuple[str, Span], ...] = ()
    """What it is linked with for sure, by name, each with the place that says so."""
    optional: tuple[str, ...] = ()
    """Those of its sources that are not compiled in every build: all of them where it is not built in every one."""
    whole: bool = True
    """Whether all of its sources are known."""


class Provided(NamedTuple):
    """A file that the package installs."""

    path: str
    """Relative to the install prefix: ``lib/<package>/talker``, ``share/<package>/launch/a.launch.py``."""
    source: str
    """Relative to the package, "" when it is built or generated."""
    program: bool
    """Whether it is installed with the executable bit."""
    conditional: bool
    """Whether it depends on something that is not known."""
    span: Span
    target: str = ""
    """The CMake target that builds it."""
    test: bool = False
    """Whether it is installed only where tests are wanted."""


class Component(NamedTuple):
    """A class that can be loaded into a component container (rclcpp_components)."""

    name: str
    conditional: bool
    span: Span


class EntryPoint(NamedTuple):
    """An entry point of a Python distribution."""

    group: str
    name: str
    target: str
    """``module:attribute``."""
    span: Span


class Call(NamedTuple):
    """A command of a CMake file as it is written, not evaluated; only those that rules and fixes ask for."""

    name: str
    """In lower case."""
    path: str
    args: tuple[tuple[str, int, int, int], ...]
    """As :data:`ros_lint.collectors.cmake_syntax.Argument`: text, kind, and offsets of the whole argument."""
    start: int
    end: int
    """Offset after the closing parenthesis."""
    line: int
    column: int
    breaks: tuple[int, ...]
    """Offsets at which further lines of the command begin."""
    blocks: tuple[str, ...]
    """What it stands in, from outside: "if", "foreach", "while", "function", "macro"."""
    test: bool
    """Whether one of the conditions asks if tests are wanted."""

    @property
    def texts(self) -> tuple[str, ...]:
        """The arguments, without quotes."""
        return tuple([argument[0] for argument in self.args])

    @property
    def place(self) -> Span:
        """The name."""
        return Span(self.path, self.line, self.column, self.line, self.column + len(self.name))

    @property
    def whole(self) -> Span:
        return Span(self.path, self.line, self.column, *self._position(self.end))

    @property
    def close(self) -> Span:
        """The empty span before the closing parenthesis."""
        return Span(self.path, *self._position(self.end - 1), *self._position(self.end - 1))

    def span(self, index: int) -> Span:
        """Return the place of an argument, quotes included."""
        _, _, start, end = self.args[index]
        return Span(self.path, *self._position(start), *self._position(end))

    def _position(self, offset: int) -> tuple[int, int]:
        passed = bisect_right(self.breaks, offset)
        if passed:
            return self.line + passed, offset - self.breaks[passed - 1] + 1
        return self.line, self.column + offset - self.start


class PythonModule(NamedTuple):
    """A module of the package's own that an entry point names."""

    name: str
    """Dotted."""
    path: str
    """Relative to the package."""
    names: tuple[str, ...]
    """What it defines or imports at its top level, sorted."""
    open: bool
    """Whether it may have further names."""


class PluginClass(NamedTuple):
    """A class that a plugin description lists (pluginlib; reference, section C5.8)."""

    name: str
    """By which it is looked up."""
    type: str
    base: str
    span: Span
    """Of the type."""


class PluginLibrary(NamedTuple):
    """A ``<library>`` of a plugin description."""

    path: str
    span: Span
    """Of the path, or of the element that has none."""
    classes: tuple[PluginClass, ...]


class PluginFile(NamedTuple):
    """A plugin description file."""

    path: str
    """Relative to the package."""
    libraries: tuple[PluginLibrary, ...]
    span: Span
    """Of its root element."""


class Registration(NamedTuple):
    """A macro in C++ that makes a class loadable: RCLCPP_COMPONENTS_REGISTER_NODE or PLUGINLIB_EXPORT_CLASS."""

    kind: Literal["component", "plugin"]
    name: str
    """The class as written, without a leading ``::``."""
    base: str
    """The base class of a plugin, "" for a component."""
    span: Span


class ScriptFile(NamedTuple):
    """A script that may be meant to be started."""

    path: str
    """Relative to the package."""
    shebang: str
    """The interpreter line without ``#!``, "" when there is none."""
    carriage_return: bool
    """Whether that line ends with a carriage return, so that nothing can run it."""
    main: bool
    """Whether it runs something when it is started: ``if __name__ == "__main__"``, or a language other than Python."""
    executable: bool
    """Whether the source has the executable bit."""


class Slot(NamedTuple):
    """A list in ``setup.py`` that a fix can add an element to."""

    option: str
    """``data_files``, ``packages`` or ``console_scripts``."""
    end: Span
    """The empty span after the last element, and after the comma behind it and its comment if there is a comma."""
    comma: bool
    """Whether there is one."""
    indent: str | None
    """The white space before the last element where it stands on a line of its own, else None."""
    size: int
    """How many elements there are."""
    variable: str = ""
    """A variable that holds the name of the package, if setup.py has one."""
    glob: str = ""
    """By which name setup.py calls glob.glob, "" if it does not import it."""


class WrittenText(NamedTuple):
    """A place in ``setup.py`` or ``setup.cfg`` that a fix can change a text at."""

    kind: Literal["glob", "gap", "section", "option"]
    """The pattern of a glob, or what it ends with; where a comma between two texts is missing, most likely; a section of
    ``setup.cfg``, or its last line; or an option."""
    text: str
    """The name of a section, "" for the last line; ``section.name`` of an option."""
    span: Span
    """Of the text without its quotes; of the value of an option; of others, empty, and at the end of the line."""


class BuildScript(NamedTuple):
    """What the build of a package does: evaluated from CMakeLists.txt and what it includes, or from setup.py and setup.cfg."""

    path: str
    name: str = ""
    """As project() or setup(name=) gives it; "" when not known."""
    name_span: Span | None = None
    version: str = ""
    version_span: Span | None = None
    mentions: tuple[Mention, ...] = ()
    targets: tuple[Target, ...] = ()
    provides: tuple[Provided, ...] = ()
    components: tuple[Component, ...] = ()
    entry_points: tuple[EntryPoint, ...] = ()
    python_packages: tuple[str, ...] = ()
    """Importable modules and packages that it installs, dotted."""
    interfaces: tuple[str, ...] = ()
    """Generated interfaces, as ``msg/Name``."""
    calls: tuple[str, ...] = ()
    """Names of the CMake commands that ran, in lower case, sorted, each once."""
    opaque: tuple[Opaque, ...] = ()
    problems: tuple[Problem, ...] = ()
    end: Span | None = None
    """Where an install rule can be added: an empty span before ament_package(), or None."""
    extras: tuple[str, ...] = ()
    """CMake files, relative to the package, whose code runs in every package that finds this one (CONFIG_EXTRAS)."""
    written: tuple[Call, ...] = ()
    """Commands of its CMake files as they stand there, file by file: those that rules and fixes ask for."""
    modules: tuple[PythonModule, ...] = ()
    """Modules that its entry points name."""
    plugins: tuple[PluginFile, ...] = ()
    """Its plugin descriptions."""
    slots: tuple[Slot, ...] = ()
    named: tuple[tuple[str, Span], ...] = ()
    """Resources that it does not install, each with a place where a text of the package names it in its folder."""
    files: tuple[ScriptFile, ...] = ()
    """Scripts that it installs to lib/<package> or bin, and those that lie beside them or in folders for scripts."""
    inputs: tuple[str, ...] = ()
    """Resources that it does not install and that its CMake files name all the same: what it is built from. Folders of
    them end with a slash."""
    texts: tuple[WrittenText, ...] = ()
    entered: tuple[str, ...] = ()
    """Folders below the package whose CMakeLists.txt is part of every build, relative to it."""
    handed_on: tuple[tuple[Mention, bool], ...] = ()
    """Packages that the CMake files for those who find this one search, and whether they do so under no condition."""
    untaken: tuple[Span, ...] = ()
    """Where packages are searched that need not be there, and of which nothing is taken."""
    bundled: tuple[str, ...] = ()
    """Projects that are built along with the package, by name: fetched ones, and those of its own folders."""
    runs: tuple[str, ...] | None = None
    """Files and folders that are run as tests by an interpreter, relative to the package, "" for any; None where nobody
    knows."""


# --- launch files --------------------------------------------------------------------------------------------------


class LaunchValue(NamedTuple):
    """What a text in a launch file can be when it runs."""

    texts: tuple[str, ...]
    """Each alternative, never empty; with the marks of :mod:`ros_lint.collectors.launch_text` for what is not known yet."""
    span: Span
    exact: bool = False
    """Whether ``span`` covers the only text and nothing else, so that a fix can put another one there."""


class LaunchCondition(NamedTuple):
    """What must be so for an action to be taken."""

    texts: tuple[str, ...]
    """With the same marks."""
    equals: str | None
    """The text must be this one; None: it must mean true, as IfCondition takes it."""
    wanted: bool = True
    """False: it must not."""


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
    choices: tuple[str, ...] = ()
    parameters: tuple[tuple[str, LaunchValue], ...] = ()
    """By name; a file under "", any number of parameters that are not known under UNKNOWN."""
    remappings: tuple[tuple[LaunchValue, LaunchValue], ...] = ()
    conditions: tuple[LaunchCondition, ...] = ()
    """All of them must hold; an unknown one has UNKNOWN for its text."""
    children: tuple[LaunchAction, ...] = ()


class LaunchReference(NamedTuple):
    """A line of a launch file that names a package, and mostly something in it."""

    kind: Literal["node", "component", "include", "command", "file", "package"]
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
    """Whether the launch file asks first if the package is there, and does without."""
    by_default: bool = False
    """Whether it holds only as long as nobody gives the arguments of the launch file other values than their defaults."""
    package_by_default: bool = False
    """The same of the package: its name is made of the default of an argument, and stands nowhere as it is."""


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
    """Whether it cannot be launched itself: a Python module without generate_launch_description() that builds actions."""
    actions: tuple[LaunchAction, ...] = ()
    imports: tuple[tuple[str, Span], ...] = ()
    """Modules that a Python launch file imports whenever it is loaded, dotted as written; none if it changes where Python
    looks for them."""
    asks: tuple[str, ...] = ()
    """Launch configurations that it asks for, wherever they go, sorted; with UNKNOWN for any other."""
    wants: tuple[str, ...] = ()
    """What a Python launch file reads besides itself, and that was not at hand when it was followed: modules, dotted, and
    files by their install path; sorted."""
    fills: bool = False
    """Whether launch configurations are filled into a file of parameters (allow_substs), which can ask for any."""
    newer: tuple[Problem, ...] = ()
    """What not every distribution takes; ``kind`` is the first that does."""
