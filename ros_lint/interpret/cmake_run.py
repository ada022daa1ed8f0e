"""A run of a package's CMake scripts: arguments, places, and what comes to light on the way."""

from __future__ import annotations

import posixpath
import re
from bisect import bisect_left
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import Final, NamedTuple

from ros_lint.collectors.cmake_syntax import LITERAL, OPEN, PLAIN, QUOTED, UNQUOTED, Argument, Command
from ros_lint.facts.build import Component, Provided
from ros_lint.facts.sight import Facet, Opaque, Problem
from ros_lint.facts.sources import Mention, Purpose, Via
from ros_lint.interpret.cmake_expand import ExpansionError, expand, template, templates
from ros_lint.interpret.cmake_sources import Helper, Sources
from ros_lint.interpret.cmake_state import MISSING, Frame, Properties, State, Variables
from ros_lint.interpret.cmake_values import ATOM, BINARY, HOLE, MAYBE, PREFIX, SOURCE, split, wild
from ros_lint.knowledge.cmake_commands import SOFT_VARIABLES, UNKNOWN_VARIABLES, VARIABLES
from ros_lint.text import Span
from ros_lint.tree import join as join_path

MOST_STEPS: Final = 50_000
"""Commands that one package may run. The largest real one runs some 3,000."""
DEEPEST: Final = 60
"""Calls within calls. CMake allows 1,000; real packages need less than 20."""
_OF_ROS: Final = frozenset({"ROS_DISTRO", "ROS_VERSION", "ROS_PYTHON_VERSION"})


class InstalledTarget(NamedTuple):
    """A target to install. Its file name is known only when the whole script has run."""

    target: str
    executables: str | None
    """Where an executable goes, None when it is not installed."""
    libraries: str | None
    archives: str | None
    conditional: bool
    span: Span


@lru_cache(maxsize=4096)
def folded(name: str) -> str:
    """Return a name as it is compared with others that are spelt a little differently."""
    return name.replace("_", "").replace("-", "").lower()


@lru_cache(maxsize=4096)
def _source(directory: str, value: str) -> str | None:
    """Return a path relative to the package, given the folder whose script names it."""
    if HOLE in value:
        return None
    if value.startswith(SOURCE):
        rest = value[len(SOURCE) :]
        if rest and not rest.startswith("/"):
            return None
        path = rest.lstrip("/")
    elif value.startswith(("/", "$<")) or not value:
        return None
    else:
        path = join_path(directory, value)
    path = posixpath.normpath(path)
    if path.startswith("../") or path == ".." or "\1" in path:
        return None
    return "" if path == "." else path


@lru_cache(maxsize=1024)
def _destination(value: str) -> str | None:
    """Return an install destination relative to the prefix."""
    if value.startswith(PREFIX):
        value = value[len(PREFIX) :].lstrip("/")
    if HOLE in value or "\1" in value or value.startswith("/") or "$<" in value:
        return None
    path = posixpath.normpath(value) if value else ""
    return "" if path == "." else path


_SIMPLE = re.compile(r"\$\{(\w+)\}")


def _inside(path: str, command: Command, argument: Argument) -> Span:
    """Return the place of an argument without its quotes."""
    _, kind, start, end = argument
    quotes = kind in (QUOTED, LITERAL)
    return command.span(path, start + quotes, end - quotes)


def substituted(text: str, given: Mapping[str, str]) -> str:
    """Return the text of an argument as a macro reads it, given what its parameters hold."""
    return _SIMPLE.sub(lambda reference: given.get(reference[1], reference[0]), text)


class BudgetError(Exception):
    """The script runs longer than any real one."""


class Run(State):
    """The state of an evaluation and all that it found."""

    def __init__(
        self, sources: Sources, distro: str, helpers: Mapping[str, Helper], foreign: Callable[[Run, str, list[str]], int | None]
    ) -> None:
        super().__init__()
        self.foreign = foreign
        """Carries out a command that neither CMake nor the package defines, given its name and arguments."""
        self.sources = sources
        self.distro = distro
        self.helpers = helpers
        self.files = frozenset(sources.files)
        self.frames: list[Frame] = []
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
        self.prefixes: dict[str, None] = {}
        """Beginnings of the names of variables that found packages may have set."""
        self._folded: tuple[str, ...] = ()
        self.open_world = False
        """Whether code that is not in sight has run."""
        self.wild = False
        """Whether that code may have set any variable."""
        self.settable: set[str] = set()
        """Variables that the user may set from outside: options and cache entries."""
        self.tested: set[str] = set()
        """Variables of the form X_FOUND or ENV{X} that a condition asks about, whether they are set."""
        self.literals: dict[str, tuple[str, Command, Argument]] = {}
        """Where list elements were written first."""
        self.places: dict[str, str] = {}
        """Variables that follow the directory and the file that is being run."""
        self.versions: tuple[int, int] = (3, 0)
        """Up to which CMake the policies are new."""
        self.included: Properties = Properties()
        """Packages of the workspace whose CMake code has run."""
        self.loose: dict[str, list[Span]] = {}
        """Where packages are searched without being required."""
        self.generated: set[str] = set()
        self.configured: dict[str, bool] = {}
        """Files that configure_file() puts below the build folder, and whether it does so for sure."""
        self.calls: set[str] = set()
        self.mentions: dict[Mention, None] = {}
        self.opaques: dict[Opaque, None] = {}
        self.problems: dict[Problem, None] = {}
        self.components: list[Component] = []
        self.registered: list[Variables] = []
        """For each of them the scope in which it is registered."""
        self.interfaces: dict[str, None] = {}
        self.python_packages: dict[str, None] = {}
        self.installed: list[Provided] = []
        """Installed files. Those with a source that is not there count if it is generated."""
        self.installed_targets: list[InstalledTarget] = []
        self.built: list[tuple[str, Properties, Span]] = []
        """Targets in the order of their definition."""
        self.links: dict[str, dict[str, Span]] = {}
        """What targets are linked with, and where that is said."""
        self.missing: list[tuple[str, Span, bool]] = []
        """Files that are named and not there (unless they are generated), and whether that may not matter."""
        self.undefined: list[tuple[str, Span, bool]] = []
        """Targets that are installed and that nobody defines."""
        self.directories: list[str] = [""]
        """The folder whose CMakeLists.txt runs, relative to the package; outer ones before it."""
        self.extras: list[str] = []
        self.templates: dict[str, None] = {}
        """What files for those who find the package are made of, relative to it."""
        self.entered: dict[str, None] = {}
        """Folders below the package whose CMakeLists.txt runs for sure."""
        self.bundled: dict[str, None] = {}
        """Projects that are built along with the package."""
        self.fetched: dict[str, list[str]] = {}
        """What projects that FetchContent can get are called by where they come from: owner/name and the like."""
        self.ran: dict[str, None] = {}
        """Files and folders that an interpreter runs as tests."""
        self.name = ""
        self.name_span: Span | None = None
        self.version = ""
        self.version_span: Span | None = None
        self.end: Span | None = None

    # --- variables

    def get(self, name: str) -> str | None:
        """Return a variable, or None when it is not set."""
        for scope in reversed(self.scopes):
            if name in scope:
                value = scope[name]
                if value is not None and name not in self.cache:
                    return wild(value) if self.unpaired else value
                break
        else:
            if name not in self.cache:
                return self.default(name)
        found: str | None = self.found(name)
        return wild(found) if self.unpaired else found

    def default(self, name: str) -> str | None:
        """Return what a variable holds that no script has set."""
        value = self.places.get(name)
        if value is None:
            value = VARIABLES.get(name)
        if value is not None:
            return value
        if name in UNKNOWN_VARIABLES:
            return HOLE
        if not self.open_world:
            return None
        if name.endswith("_FOUND") and self.packages.get(name[:-6]) == "1":
            return "1"
        if self.wild and not name.startswith("CMAKE_"):
            return HOLE
        if len(self.prefixes) != len(self._folded):
            self._folded = tuple(map(folded, self.prefixes))
        if folded(name).startswith(self._folded):
            # Folders and versions are single texts; the others may be lists, or nothing.
            return f"{ATOM}{name}" if name.endswith(("_DIR", "_VERSION", "_PREFIX")) else HOLE
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
        match name:
            case "ROS_DISTRO":
                return self.distro or HOLE
            case "ROS_VERSION":
                return "2"
            case "ROS_PYTHON_VERSION":
                return "3"
        return HOLE

    def _use_of_ros(self, name: str) -> None:
        """Note a variable that is set where one package is installed, and nowhere else that can be relied on (F2)."""
        command = self.frames[-1].command
        if command is not None and command.name != "message":
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
                    values += split(value)
                elif value:
                    values.append(value)
            else:
                values.append(self.evaluated(text) if kind == QUOTED else text)
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
                parts = template(substituted(text, given))
            return (self.get(parts) or "") if isinstance(parts, str) else expand(parts, self.lookup)
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

    def at_home(self) -> bool:
        """Return whether the current command stands in a file of the package."""
        return self.frames[-1].own

    # --- paths

    @property
    def directory(self) -> str:
        return self.directories[-1]

    def source(self, value: str) -> str | None:
        """Return a path relative to the package, or None for one that lies elsewhere or is not known."""
        return _source(self.directories[-1], value)

    def destination(self, value: str) -> str | None:
        """Return an install destination relative to the prefix, or None when it is not known or lies elsewhere."""
        return _destination(value)

    def build(self, value: str) -> str | None:
        """Return a path relative to the build folder of the package, None for one that lies elsewhere or is not known."""
        if HOLE in value or not (value.startswith(f"{BINARY}/") or value == BINARY):
            return None
        path = posixpath.normpath(value[len(BINARY) :].lstrip("/"))
        return None if path.startswith("..") or ATOM in path else path.removeprefix(".")

    def is_folder(self, path: str) -> bool:
        """Return whether the package has such a folder, with a file in it."""
        return not path or bool(self.below(path)) or self.is_unseen(path)

    def is_unseen(self, path: str) -> bool:
        """Return whether a path lies in a folder whose files are not listed."""
        return any(path == folder or path.startswith(f"{folder}/") for folder in self.sources.unseen)

    def below(self, path: str) -> Sequence[str]:
        """Return the files below a folder, sorted."""
        files = self.sources.files
        if not path:
            return files
        start = bisect_left(files, f"{path}/")
        return files[start : bisect_left(files, f"{path}0", start)]  # the character after the slash is the zero

    def enter_directory(self, path: str) -> None:
        """Make a folder of the package the current one."""
        self.directories.append(path)
        self._place_directory()

    def leave_directory(self) -> None:
        self.directories.pop()
        self._place_directory()

    def _place_directory(self) -> None:
        self.places["CMAKE_CURRENT_SOURCE_DIR"] = join_path(SOURCE, self.directory).rstrip("/")
        self.places["CMAKE_CURRENT_BINARY_DIR"] = join_path(BINARY, self.directory).rstrip("/")

    def enter_file(self, frame: Frame) -> None:
        """Run a file from now on."""
        self.frames.append(frame)
        self.place_file()

    def place_file(self) -> None:
        """Set the variables that name the file that is being run."""
        for frame in reversed(self.frames):
            if frame.procedure is None:
                self.places["CMAKE_CURRENT_LIST_FILE"] = frame.file
                self.places["CMAKE_CURRENT_LIST_DIR"] = frame.folder
                break

    # --- findings

    def is_bundled(self, name: str) -> bool:
        """Return whether a project of a name is built along with the package."""
        return bool(self.bundled) and folded(name) in {folded(bundled) for bundled in self.bundled}

    @property
    def conditional(self) -> bool:
        """Return whether what happens now may also not happen."""
        return self.unsure > 0

    def mention(self, name: str, via: Via, span: Span, what: str = "", *, optional: bool = False, purpose: Purpose = "") -> None:
        """Note that a line names a package."""
        if not self.muted:
            self.mentions[Mention(name, via, span, what, optional or self.unsure > 0, self.testing, purpose)] = None

    def hide(self, facet: Facet, reason: str, span: Span | None = None) -> None:
        """Note that something cannot be seen through.

        Where the script does not come to unless it is asked to, it hides only what a package may be needed for.
        """
        if self.unusual:
            facet &= Facet.USES
        if facet and not self.muted:
            self.opaques[Opaque(facet, reason, span or self.here())] = None

    def problem(self, kind: str, message: str, span: Span) -> None:
        """Note that a command is wrong, if it runs for sure."""
        if not self.muted and not self.unsure:
            self.problems[Problem(kind, message, span)] = None


Handler = Callable[[Run, list[str]], "int | None"]
"""What carries out a command: takes evaluated arguments, and returns how it ended; None is NEXT."""
