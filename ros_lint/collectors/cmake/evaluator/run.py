"""A run of a package's CMake scripts: arguments, places, and what comes to light on the way."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Final

from ros_lint.base.text import Span
from ros_lint.collectors.cmake.evaluator.expansion import ExpansionError, expand, substituted, template, templates
from ros_lint.collectors.cmake.evaluator.paths import Paths
from ros_lint.collectors.cmake.evaluator.sources import AROUND, Helper, Sources
from ros_lint.collectors.cmake.evaluator.state import MISSING, Frame, InstalledTarget, Properties, Variables
from ros_lint.collectors.cmake.evaluator.values import ATOM, HOLE, MAYBE, SLOW, effort, kept, split, wild
from ros_lint.collectors.cmake.released_macros import SOFT_VARIABLES, UNKNOWN_VARIABLES
from ros_lint.collectors.cmake.syntax import LITERAL, OPEN, PLAIN, QUOTED, UNQUOTED, Argument, Command, Parsed
from ros_lint.facts.build import REPOSITORIES, Component, InstalledFile
from ros_lint.facts.environment import ROS_2
from ros_lint.facts.sources import Mention, Purpose, Via
from ros_lint.facts.visibility import Facet, Opaque, Problem

MOST_STEPS: Final = 100_000
"""Commands that one package may run. Most real ones run less than 3,000, the largest with all its tests some 93,000."""
DEEPEST: Final = 60
"""Calls within calls. CMake allows 1,000; real packages need less than 20."""
_SHORT: Final = 1024
"""Characters of a value that is read for nothing."""
_OF_ROS: Final = frozenset({"ROS_DISTRO", *ROS_2})


@kept(4096)
def folded(name: str) -> str:
    """Return a name as it is compared with others that are spelt a little differently."""
    return name.replace("_", "").replace("-", "").lower()


def _inside(path: str, command: Command, argument: Argument) -> Span:
    """Return the place of an argument without its quotes."""
    _, kind, start, end = argument
    quotes = kind in (QUOTED, LITERAL)
    return command.span(path, start + quotes, end - quotes)


class Run(Paths):
    """The state of an evaluation and all that it found."""

    def __init__(
        self, sources: Sources, distro: str, helpers: Mapping[str, Helper], foreign: Callable[[Run, str, list[str]], int | None]
    ) -> None:
        super().__init__(sources)
        self.foreign = foreign
        """Carries out a command that neither CMake nor the package defines, given its name and arguments."""
        self.distro = distro
        self.helpers = helpers
        self.steps = 0
        self.unsure = 0
        """How many conditions that may be false lead here."""
        self.unusual = 0
        """How many of them are false unless the user asks for something else."""
        self.testing = False
        self.muted = 0
        self.modules = {
            path[path.rindex("Find") + 4 : -6]: path
            for path in sources.scripts
            if path.endswith(".cmake") and path.rpartition("/")[2].startswith("Find")
        }
        """The package's own find modules, by what they find."""
        self.packages: Properties = Properties()
        """Packages that were found for sure."""
        self.prefixes: dict[str, bool] = {}
        """Beginnings of the names of variables that found packages may have set, and whether each is the name of one.

        pkg-config is told what to call them."""
        self._folded: tuple[str, ...] = ()
        self.open_world = False
        """Whether code that is not in sight has run."""
        self.wild = False
        """Whether that code may have set any variable."""
        self.builds = False
        """Whether that code may have built targets."""
        self.settable: set[str] = set()
        """Variables that the user may set from outside: options and cache entries."""
        self.tested: set[str] = set()
        """Variables of the form X_FOUND or ENV{X} that a condition asks about, whether they are set."""
        self.literals: dict[str, tuple[str, Command, Argument]] = {}
        """Where list elements were written first."""
        self.versions: tuple[int, int] = (3, 0)
        """Up to which CMake the policies are new."""
        self.included: Properties = Properties()
        """Packages of the workspace whose CMake code has run."""
        self.of_index: set[str] = set()
        """Variables that were set to what some package has put into the index."""
        self.loose: dict[str, list[Span]] = {}
        """Where packages are searched without being required."""
        self.generated: set[str] = set()
        self.configured: dict[str, bool] = {}
        """Files that configure_file() puts below the build folder, and whether it does so for sure."""
        self.calls: set[str] = set()
        self.around: list[Parsed] = []
        """Scripts around the package that have run."""
        self.mentions: dict[Mention, None] = {}
        self.opaques: dict[Opaque, None] = {}
        self.problems: dict[Problem, None] = {}
        self.components: list[Component] = []
        self.registered: list[Variables] = []
        """For each of them the scope in which it is registered."""
        self.interfaces: dict[str, None] = {}
        self.python_packages: dict[str, None] = {}
        self.installed: list[InstalledFile] = []
        """Installed files. Those with a source that is not there count if it is generated."""
        self.installed_targets: list[InstalledTarget] = []
        self.exported_sets: dict[str, None] = {}
        """Sets of targets that whoever finds the package has for sure."""
        self.built: list[tuple[str, Properties, Span]] = []
        """Targets in the order of their definition."""
        self.links: dict[str, dict[str, Span]] = {}
        """What targets are linked with, and where that is said."""
        self.headers: dict[str, dict[str, None]] = {}
        """What may give targets their headers."""
        self.missing: list[tuple[str, Span, bool]] = []
        """Files that are named and not there (unless they are generated), and whether that may not matter.

        Folders have a slash at the end."""
        self.undefined: list[tuple[str, Span, bool]] = []
        """Targets that are installed and that nobody defines."""
        self.refused: dict[Problem, None] = {}
        self.given: dict[tuple[str, str], Span] = {}
        """Targets that are given something for sure, each with the command that does so first."""
        self.extras: list[str] = []
        self.templates: dict[str, None] = {}
        """What files for those who find the package are made of, relative to it."""
        self.entered: dict[str, None] = {}
        """Folders below the package whose CMakeLists.txt runs for sure."""
        self.entered_for_tests: dict[str, None] = {}
        """Those whose CMakeLists.txt runs, if it does, while tests are built."""
        self.bundled: dict[str, None] = {}
        """Projects that are built along with the package."""
        self.reaches_out = False
        """Whether headers are taken from folders of the sources outside of the package."""
        self.fetched: dict[str, list[str]] = {}
        """What projects that FetchContent can get are called by where they come from: owner/name and the like."""
        self.ran: dict[str, None] = {}
        """Files and folders that an interpreter runs as tests."""
        self.name = ""
        self.name_span: Span | None = None
        self.version = ""
        self.version_span: Span | None = None
        self.end: Span | None = None
        self.behind: Span | None = None

    # --- variables

    def get(self, name: str) -> str | None:
        """Return a variable, or None when it is not set."""
        for scope in reversed(self.scopes):
            if name in scope:
                value = scope[name]
                if value is not None and name not in self.cache:
                    return self._read(value) if len(value) > _SHORT or self.unpaired else value
                break
        else:
            if name not in self.cache:
                return self.default(name)
        found: str | None = self.found(name)
        return self._read(found) if found else found

    def _read(self, value: str) -> str | None:
        """Count what reading a value takes, and return it as it is in a script where unknown texts may hold brackets."""
        self.charge(len(value))
        if not self.unpaired:
            return value
        self.charge(SLOW * len(value))
        return wild(value)

    def default(self, name: str) -> str | None:
        """Return what a variable holds that no script has set."""
        value = self.brought(name)
        if value is not None:
            return value
        if name in UNKNOWN_VARIABLES:
            return HOLE
        if not self.open_world:
            return None
        if name.endswith("_FOUND") and self.packages.get(name[:-6]) == "1":
            return "1"
        if name in (f"{self.name}_LIBRARIES", f"{self.name}_EXECUTABLES"):
            return HOLE if self.builds else None  # where ament_auto notes what the package builds
        if self.wild and not name.startswith("CMAKE_"):
            return HOLE
        if len(self.prefixes) != len(self._folded):
            self._folded = tuple(map(folded, self.prefixes))
        if folded(name).startswith(self._folded):
            # Folders, which lie elsewhere, and versions are single texts; the others may be lists, or nothing.
            if name.endswith(("_DIR", "_PREFIX")):
                return f"/{ATOM}{name}"
            return f"{ATOM}{name}" if name.endswith("_VERSION") else HOLE
        return None

    def lookup(self, name: str, where: str) -> str:
        """Return what a reference stands for; unset variables are empty."""
        if where == "":
            return self.get(name) or ""
        if where == "CACHE":
            return self.cache.get(name, "")
        value = self.environment.get(name)
        if value is not None:
            return value
        if name in _OF_ROS and self.frames[-1].own:
            self._use_of_ros(name)
        return (self.distro or HOLE) if name == "ROS_DISTRO" else ROS_2.get(name, HOLE)

    def _use_of_ros(self, name: str) -> None:
        """Note a variable that is set where one package is installed, and nowhere else that can be relied on (F2)."""
        command = self.frames[-1].command
        if command is None or command.name == "message":
            return
        if not (command.args and command.args[0][0].startswith("CPACK_")):  # packing is no part of the build
            self.mention("ros_environment", "package", self.here(), f"$ENV{{{name}}}", optional=f"ENV{{{name}}}" in self.tested)

    def is_soft(self, name: str) -> bool:
        """Return whether a user, another platform or another compiler may give a variable another value."""
        return name in self.settable or (name in SOFT_VARIABLES and self.found(name) is MISSING)

    def may_be_set(self, name: str) -> bool:
        """Return whether a user, or code that is out of sight, may have set a variable that looks known."""
        return self.is_soft(name) or (self.open_world and self.found(name) is MISSING and name not in self.places)

    # --- arguments

    def arguments(self, command: Command) -> list[str]:
        """Return the arguments of a command, evaluated and split."""
        values: list[str] = []
        for text, kind, _, _ in command.args:
            if kind == UNQUOTED:
                value = self.evaluated(text)
                if ";" in value:
                    self.charge(effort(value))
                    values += split(value)
                elif value:
                    values.append(value)
            else:
                values.append(self.evaluated(text) if kind == QUOTED else text)
        self.charge(sum(map(len, values)))
        return values

    def firm_arguments(self, command: Command) -> int | None:
        """Return the index of the first argument whose place is not sure, None if all are.

        An unquoted unknown text may be none or several arguments, and an element that may be missing moves those after it.
        """
        count = 0
        for text, kind, _, _ in command.args:
            if kind == UNQUOTED:
                value = self.evaluated(text)
                if HOLE in value or MAYBE in value:
                    return count
                count += len(split(value))
            else:
                count += 1
        return None

    def evaluated(self, text: str) -> str:
        """Return the value of an argument before it is split."""
        given = self.frames[-1].given
        try:
            parts = templates.get(text) or template(text)
            if type(parts) is str:  # the name of a variable, by far the most frequent case
                if given is None or parts not in given:
                    return self.get(parts) or ""
                text = given[parts]
                if "$" not in text and "\\" not in text:
                    return text
                parts = template(text)
            elif given is not None and "${" in text:
                text = substituted(text, given)
                self.charge(len(text))
                parts = template(text)
            if isinstance(parts, str):
                return self.get(parts) or ""
            value = expand(parts, self.lookup)
            self.charge(len(value))
            return value
        except ExpansionError:
            return HOLE

    # --- places

    def where(self, value: str) -> Span:
        """Return the place in the package's own files that best stands for a value of the current command.

        That is an argument that reads so, from the innermost call outwards, then a list element that reads so, then an
        argument that gives the value, then the name of the command.
        """
        own: Frame | None = None
        for frame in reversed(self.frames):
            command = frame.command
            if not frame.own or command is None:
                continue
            own = own or frame
            for argument in command.args:
                if argument[0] == value and argument[1] < OPEN:
                    return _inside(frame.path, command, argument)
        assert own is not None
        frame, command = own, own.command
        assert command is not None
        if value in self.literals:
            return _inside(*self.literals[value])
        if value and frame is self.frames[-1]:
            for text, kind, start, end in command.args:
                if kind in (UNQUOTED, QUOTED) and value in split(self.evaluated(text)):
                    return command.span(frame.path, start, end)
        return command.place(frame.path)

    def remember(self, first: int) -> None:
        """Note where list elements are written: the arguments of the current command from an index on."""
        frame = self.frames[-1]
        if frame.own and frame.command is not None:
            for argument in frame.command.args[first:]:
                if argument[1] in (PLAIN, LITERAL):
                    self.literals.setdefault(argument[0], (frame.path, frame.command, argument))

    def here(self) -> Span:
        """Return the place of the current command in the package's own files."""
        for frame in reversed(self.frames):
            if frame.own and frame.command is not None:
                return frame.command.place(frame.path)
        raise AssertionError("no command of the package runs")

    # --- findings

    def is_bundled(self, name: str) -> bool:
        """Return whether a project of a name is built along with the package."""
        if not self.bundled:
            return False
        name = folded(name)
        return not {folded(bundled) for bundled in self.bundled}.isdisjoint((name, REPOSITORIES.get(name, name)))

    @property
    def conditional(self) -> bool:
        """Return whether what happens now may also not happen."""
        return self.unsure > 0

    def mention(self, name: str, via: Via, span: Span, what: str = "", *, optional: bool = False, purpose: Purpose = "") -> None:
        """Note that a line names a package."""
        if not purpose and self.is_helped() and (via == "cmake" or (via == "target" and span == self.here())):
            purpose = "helper"
        if not self.muted:
            test = self.testing or (bool(self.gained) and self._is_gained(name))
            self.mentions[Mention(name, via, span, what, optional or self.unsure > 0, test, purpose)] = None

    def note_gained(self, name: str, elements: Iterable[str]) -> None:
        """Note what is about to be in a variable only where tests are wanted: what joins a list that is there without them."""
        if not self.testing:
            self.gained.pop(name, None)
        elif before := self.get(name):
            self.gained[name] = self.gained.get(name, frozenset()).union(set(elements).difference(split(before)))

    def _is_gained(self, name: str) -> bool:
        """Whether the current command names something only because a list that it is given was extended for tests."""
        command = self.frames[-1].command
        lists = [variable for variable, elements in self.gained.items() if name in elements]
        return command is not None and any(f"${{{variable}}}" in text for variable in lists for text, *_ in command.args)

    def is_helped(self) -> bool:
        """Whether a command runs that another package of the workspace gives, or a script around the package."""
        for frame in reversed(self.frames):
            if frame.own:
                return False
            provider = frame.procedure.provider if frame.procedure else frame.provider
            if provider == AROUND or provider in self.helpers:
                return True
        return False

    def hide(self, facet: Facet, reason: str, span: Span | None = None, below: str = "", inside: str = "") -> None:
        """Note that something cannot be seen through, where in the prefix it can only be, and in which folder its build is.

        Where the script does not come to unless it is asked to, it hides only what a package may be needed for.
        """
        if self.unusual:
            facet &= Facet.USES
        if facet and not self.muted:
            self.opaques[Opaque(facet, reason, span or self.here(), below=below, inside=inside)] = None

    def problem(self, kind: str, message: str, span: Span, path: str = "") -> None:
        """Note that a command is wrong, if it runs for sure."""
        if not self.muted and not self.unsure:
            self.problems[Problem(kind, message, span, subject=path)] = None


Handler = Callable[[Run, list[str]], "int | None"]
"""What carries out a command: takes evaluated arguments, and returns how it ended; None is NEXT."""
