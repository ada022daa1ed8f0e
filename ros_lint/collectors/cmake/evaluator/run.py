"""The state of a run of CMake scripts, with functions that evaluate arguments, locate values and record results."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Final

from ros_lint.base.text import Span
from ros_lint.collectors.cmake.evaluator.expansion import ExpansionError, expand, substituted, template, templates
from ros_lint.collectors.cmake.evaluator.found_packages import FoundPackages, folded
from ros_lint.collectors.cmake.evaluator.paths import Paths
from ros_lint.collectors.cmake.evaluator.results import Results
from ros_lint.collectors.cmake.evaluator.sources import OUTSIDE, Helper, Sources
from ros_lint.collectors.cmake.evaluator.state import MISSING, CallFrame, State, Variables
from ros_lint.collectors.cmake.evaluator.values import ATOM, HOLE, MAYBE, SLOW, split, split_cost, with_unpaired_holes
from ros_lint.collectors.cmake.released_macros import CONFIGURABLE_VARIABLES, UNKNOWN_VARIABLES
from ros_lint.collectors.cmake.syntax import LITERAL, OPEN, PLAIN, QUOTED, UNQUOTED, Argument, Command, ParsedScript
from ros_lint.facts.build import REPOSITORIES
from ros_lint.facts.cmake import CommandPlace
from ros_lint.facts.environment import ROS_2
from ros_lint.facts.sources import Mention, Purpose, Via
from ros_lint.facts.visibility import Facet, Opaque, Problem

DEEPEST: Final = 60
"""Maximum depth of nested calls. CMake allows 1,000; real packages need less than 20."""
_MANY_ARGUMENTS: Final = 16
"""Number of arguments from which the arguments of a command are indexed, because an index is then faster than a search."""
_SHORT: Final = 1024
"""Maximum length of a value, in characters, that is read without a charge to the budget of the run."""
_OF_ROS: Final = frozenset({"ROS_DISTRO", *ROS_2})


def _inside(path: str, command: Command, argument: Argument) -> Span:
    """Return the span of an argument in its file, without the quotes of the argument."""
    _, kind, start, end = argument
    quotes = kind in (QUOTED, LITERAL)
    return command.span(path, start + quotes, end - quotes)


class Run(State):
    """A run of the CMake scripts of a package: variables, the call stack, and whether the current command certainly runs."""

    def __init__(
        self,
        sources: Sources,
        distro: str,
        helpers: Mapping[str, Helper],
        run_external_command: Callable[[Run, str, list[str]], int | None],
    ) -> None:
        super().__init__()
        self.paths = Paths(sources, self.path_variables)
        self.packages = FoundPackages(sources.scripts)
        self.results = Results()
        self.run_external_command = run_external_command
        """A function that runs a command that neither CMake nor the package defines, given the run, the name and arguments."""
        self.distro = distro
        self.same_distros: frozenset[str] | None = None
        """The ROS distributions for which the results are equal; None if no command has depended on the distribution so far."""
        self.helpers = helpers
        self.frames: list[CallFrame] = []
        """The active files, functions and macros, outermost first: the call stack."""
        self.uncertain_conditions = 0
        """Number of conditions around the current command that may be false."""
        self.non_default_conditions = 0
        """Number of conditions around the current command that are false with default options."""
        self.testing = False
        """True if the current command runs only if tests are enabled (BUILD_TESTING)."""
        self.muted = 0
        """Number of loops around the current command that are in their first round.

        A loop with an unknown number of rounds is run twice. Its first round records no results."""
        self.open_world = False
        """True if code that cannot be read has run, such as the config file of a package that is not in the workspace."""
        self.any_variable_may_be_set = False
        """True if code that cannot be read has run and may have set any variable."""
        self.skipped_include = False
        """True if a file of include() or of a found package was not read."""
        self.may_define_targets = False
        """True if code that cannot be read has run and may have defined targets."""
        self.settable: set[str] = set()
        """Names of the variables that the user may set on the command line: options and cache entries."""
        self.tested_variables: set[str] = set()
        """Names of the form X_FOUND or ENV{X} that some condition tests."""
        self.index_variables: set[str] = set()
        """Names of the variables with a value from the ament index, where any package may register the value."""
        self.literal_places: dict[str, tuple[str, Command, Argument]] = {}
        """The first place in the scripts of each text that is a list element, by the text."""
        self.policy_version: tuple[int, int] = (3, 0)
        """The version of CMake up to which policies behave as NEW (cmake_minimum_required)."""
        self.fetched_projects: dict[str, list[str]] = {}
        """By project name in FetchContent_Declare(): the names in its download address, such as the owner and the repository."""
        self.command_names: set[str] = set()
        """Names, in lower case, of the commands that have run."""
        self.outside_scripts: list[ParsedScript] = []
        """Scripts that have run and are not in the package."""
        self.export_scopes: list[tuple[Variables, CommandPlace]] = []
        """The calls of ament_export_...() in the package that certainly run, each with the scope of variables around it."""
        self.package_scopes: list[Variables] = []
        """The scopes of variables that are visible where ament_package() runs."""
        self.component_scopes: list[Variables] = []
        """The scope of variables in which each component is registered, in the order of ``results.components``."""

        self._indexed: tuple[Command, Mapping[str, Sequence[Argument]]] | None = None
        """The command with many arguments that was indexed last, and its arguments by their text."""
        self._evaluated: tuple[Command, int, Mapping[str, Argument]] | None = None
        """The command whose values were indexed last, the steps left at that time, and its arguments by element."""

    # --- variables

    def get(self, name: str) -> str | None:
        """Return the value of a variable, None if it is not set."""
        for scope in reversed(self.scopes):
            if name in scope:
                value = scope[name]
                if value is not None and name not in self.cache:
                    return self._read(value) if len(value) > _SHORT or self.has_unpaired_brackets else value
                break
        else:
            if name not in self.cache:
                return self.implicit_value(name)
        result: str | None = self.value_or_missing(name)
        return self._read(result) if result else result

    def _read(self, value: str) -> str | None:
        """Return the value of a variable as a script reads it, and charge its length to the budget of the run.

        Each HOLE (an unknown text) becomes an UNPAIRED_HOLE if values may have unpaired square brackets.
        """
        self.budget.charge(len(value))
        if not self.has_unpaired_brackets:
            return value
        self.budget.charge(SLOW * len(value))
        return with_unpaired_holes(value)

    def implicit_value(self, name: str) -> str | None:
        """Return the value of a variable that no script has set: a built-in value, or HOLE, which means any text.

        The result is None if the variable is certainly not set.
        """
        value = self.builtin_value(name)
        if value is not None:
            return value
        if name in UNKNOWN_VARIABLES:
            return HOLE
        if not self.open_world:
            return None
        if name.endswith("_FOUND") and self.packages.certain.get(name[:-6]) == "1":
            return "1"
        if name in (f"{self.results.project.name}_LIBRARIES", f"{self.results.project.name}_EXECUTABLES"):
            return HOLE if self.may_define_targets else None  # ament_auto stores the targets of the package in these variables
        if self.any_variable_may_be_set and not name.startswith("CMAKE_"):
            return HOLE
        if self.packages.may_set(name):
            # Folders (outside of the package) and versions are single texts. Other variables may be lists, or unset.
            if name.endswith(("_DIR", "_PREFIX")):
                return f"/{ATOM}{name}"
            return f"{ATOM}{name}" if name.endswith("_VERSION") else HOLE
        return None

    def lookup(self, name: str, space: str) -> str:
        """Return the value of ``${name}``, or of ``$CACHE{name}`` or ``$ENV{name}`` for the space "CACHE" or "ENV".

        The value of an unset variable is "".
        """
        if space == "":
            return self.get(name) or ""
        if space == "CACHE":
            return self.cache.get(name, "")
        value = self.environment.get(name)
        if value is not None:
            return value
        if name in _OF_ROS and self.frames[-1].own:
            self._use_of_ros(name)
        if name != "ROS_DISTRO":
            return ROS_2.get(name, HOLE)
        self.depend_on_distro(frozenset({self.distro}))
        return self.distro or HOLE

    def depend_on_distro(self, distros: frozenset[str]) -> None:
        """Record that the results of a command hold only for ``distros``, a set that contains the ROS distribution of the run."""
        self.same_distros = distros if self.same_distros is None else self.same_distros & distros

    def _use_of_ros(self, name: str) -> None:
        """Record that the package uses ros_environment, which sets the environment variable ``name``, such as ROS_DISTRO."""
        command = self.frames[-1].command
        if command is None or command.name == "message":
            return
        if not (command.args and command.args[0][0].startswith("CPACK_")):  # CPack runs after the build
            self.add_mention(
                "ros_environment",
                "package",
                self._place_of(f"$ENV{{{name}}}"),
                f"$ENV{{{name}}}",
                optional=f"ENV{{{name}}}" in self.tested_variables,
            )

    def _place_of(self, reference: str) -> Span:
        """Return the place of a variable reference, such as ``${name}``, in the current command.

        If no argument has the reference, the result is the place of the command.
        """
        frame = self.frames[-1]
        command = frame.command
        if command is None or not frame.own:
            return self.current_place()
        for text, kind, start, _ in command.args:
            at = text.find(reference)
            if at >= 0:
                begin = start + at + (0 if kind == UNQUOTED else 1)
                return command.span(frame.path, begin, begin + len(reference))
        return self.current_place()

    def is_configurable(self, name: str) -> bool:
        """Return whether the user, the platform or the compiler determines the value of a variable."""
        return name in self.settable or (name in CONFIGURABLE_VARIABLES and self.value_or_missing(name) is MISSING)

    def may_be_set(self, name: str) -> bool:
        """Return whether the user, or code that cannot be read, may set a variable that no script of the run has set."""
        if self.is_configurable(name):
            return True
        return self.open_world and self.value_or_missing(name) is MISSING and name not in self.path_variables

    # --- arguments

    def arguments(self, command: Command) -> list[str]:
        """Return the arguments of a command after references are replaced and unquoted arguments are split at semicolons."""
        values: list[str] = []
        for text, kind, _, _ in command.args:
            if kind == UNQUOTED:
                value = self.evaluate(text)
                if ";" in value:
                    self.budget.charge(split_cost(value))
                    values += split(value)
                elif value:
                    values.append(value)
            else:
                values.append(self.evaluate(text) if kind == QUOTED else text)
        self.budget.charge(sum(map(len, values)))
        return values

    def first_uncertain_argument(self, command: Command) -> int | None:
        """Return the index of the first evaluated argument whose position is uncertain, None if all positions are certain.

        An unquoted unknown text may be any number of arguments. A list element that may be missing shifts later arguments.
        """
        count = 0
        for text, kind, _, _ in command.args:
            if kind == UNQUOTED:
                value = self.evaluate(text)
                if HOLE in value or MAYBE in value:
                    return count
                count += len(split(value))
            else:
                count += 1
        return None

    def evaluate(self, text: str) -> str:
        """Return the value of an argument after its references are replaced, before it is split at semicolons."""
        arguments = self.frames[-1].macro_arguments
        try:
            parts = templates.get(text) or template(text)
            if type(parts) is str:  # the name of a variable, by far the most frequent case
                if arguments is None or parts not in arguments:
                    return self.get(parts) or ""
                text = arguments[parts]
                if "$" not in text and "\\" not in text:
                    return text
                parts = template(text)
            elif arguments is not None and "${" in text:
                text = substituted(text, arguments)
                self.budget.charge(len(text))
                parts = template(text)
            if isinstance(parts, str):
                return self.get(parts) or ""
            value = expand(parts, self.lookup)
            self.budget.charge(len(value))
            return value
        except ExpansionError:
            return HOLE

    # --- files

    def runs_own_code(self) -> bool:
        """Return whether the current command is in a file of the package, or in a workspace script outside of the package."""
        frame = self.frames[-1]
        return frame.own or (frame.procedure.provider if frame.procedure else frame.provider) == OUTSIDE

    def enter_file(self, frame: CallFrame) -> None:
        """Begin to run a file: ``frame``, the entry of the file, becomes the top of the call stack."""
        self.frames.append(frame)
        self.place_file()

    def place_file(self) -> None:
        """Set CMAKE_CURRENT_LIST_FILE and CMAKE_CURRENT_LIST_DIR for the innermost file of the call stack."""
        for frame in reversed(self.frames):
            if frame.procedure is None:
                self.path_variables["CMAKE_CURRENT_LIST_FILE"] = frame.file
                self.path_variables["CMAKE_CURRENT_LIST_DIR"] = frame.folder
                break

    # --- places

    def place_of(self, value: str) -> Span:
        """Return the best place in the package's own files for a value of the current command: the first of

        1. an argument whose text is the value, from the innermost call outwards
        2. a list element, in any command, whose text is the value
        3. an argument of the current command that evaluates to the value
        4. the name of the current command
        """
        innermost: CallFrame | None = None
        for frame in reversed(self.frames):
            command = frame.command
            if not frame.own or command is None:
                continue
            innermost = innermost or frame
            for argument in self._arguments_with(value, command):
                if argument[0] == value and argument[1] < OPEN:
                    return _inside(frame.path, command, argument)
        assert innermost is not None
        frame, command = innermost, innermost.command
        assert command is not None
        if value in self.literal_places:
            return _inside(*self.literal_places[value])
        if value and frame is self.frames[-1] and (found := self._arguments_by_element(command).get(value)):
            return command.span(frame.path, found[2], found[3])
        return command.place(frame.path)

    def _arguments_by_element(self, command: Command) -> Mapping[str, Argument]:
        """Return the arguments of the current command by the elements of their values; the first argument of each element."""
        if self._evaluated is None or self._evaluated[0] is not command or self._evaluated[1] != self.budget.steps:
            by_element: dict[str, Argument] = {}
            for argument in command.args:
                if argument[1] in (UNQUOTED, QUOTED):
                    for element in split(self.evaluate(argument[0])):
                        by_element.setdefault(element, argument)
            self._evaluated = command, self.budget.steps, by_element
        return self._evaluated[2]

    def _arguments_with(self, text: str, command: Command) -> Iterable[Argument]:
        """Return the arguments of a command that may have the text ``text``. A long command is indexed for this."""
        if len(command.args) < _MANY_ARGUMENTS:
            return command.args
        if self._indexed is None or self._indexed[0] is not command:
            by_text: dict[str, list[Argument]] = {}
            for argument in command.args:
                by_text.setdefault(argument[0], []).append(argument)
            self._indexed = command, by_text
        return self._indexed[1].get(text, ())

    def note_literals(self, first: int) -> None:
        """Record the places of the arguments of the current command from index ``first`` on, which are list elements."""
        frame = self.frames[-1]
        if frame.own and frame.command is not None:
            for argument in frame.command.args[first:]:
                if argument[1] in (PLAIN, LITERAL):
                    self.literal_places.setdefault(argument[0], (frame.path, frame.command, argument))

    def current_place(self) -> Span:
        """Return the place of the innermost active command that is in a file of the package."""
        for frame in reversed(self.frames):
            if frame.own and frame.command is not None:
                return frame.command.place(frame.path)
        raise AssertionError("no command of the package runs")

    # --- findings

    def is_bundled(self, name: str) -> bool:
        """Return whether the build of the package also builds the project ``name``, for example with FetchContent."""
        if not self.results.bundled_projects:
            return False
        name = folded(name)
        return not {folded(bundled) for bundled in self.results.bundled_projects}.isdisjoint((name, REPOSITORIES.get(name, name)))

    @property
    def conditional(self) -> bool:
        """Return whether it is uncertain that the current command runs."""
        return self.uncertain_conditions > 0

    def add_mention(
        self, name: str, via: Via, span: Span, quotation: str = "", *, optional: bool = False, purpose: Purpose = ""
    ) -> None:
        """Record that the package mentions another package, or a target or macro of another package, at a place.

        ``via`` is the kind of the name, such as "target". ``quotation`` is the text for messages, such as "ros2 run tf2", or
        "" if the name is sufficient.
        """
        if not purpose and self.runs_helper_code() and (via == "cmake" or (via == "target" and span == self.current_place())):
            purpose = "helper"
        if not self.muted:
            test = self.testing or (bool(self.test_elements) and self._is_test_element(name))
            mention = Mention(name, via, span, quotation, optional or self.uncertain_conditions > 0, test, purpose)
            self.results.mentions[mention] = None

    def note_test_elements(self, name: str, elements: Iterable[str]) -> None:
        """Record ``elements`` that a command adds to the list ``name`` only if tests are enabled.

        Nothing is recorded if the list is empty or not set before the branch for tests.
        """
        if not self.testing:
            self.test_elements.pop(name, None)
        elif value := self.get(name):
            self.test_elements[name] = self.test_elements.get(name, frozenset()).union(set(elements).difference(split(value)))

    def _is_test_element(self, name: str) -> bool:
        """Return whether ``name`` is an argument of the current command only in builds with tests.

        That is the case if it is an element that a branch for tests, such as ``if(BUILD_TESTING)``, added to a list.
        """
        command = self.frames[-1].command
        lists = [variable for variable, elements in self.test_elements.items() if name in elements]
        return command is not None and any(f"${{{variable}}}" in text for variable in lists for text, *_ in command.args)

    def runs_helper_code(self) -> bool:
        """Return whether the current code belongs to another package of the workspace, or is a script outside of the package."""
        for frame in reversed(self.frames):
            if frame.own:
                return False
            provider = frame.procedure.provider if frame.procedure else frame.provider
            if provider == OUTSIDE or provider in self.helpers:
                return True
        return False

    def hide(self, facet: Facet, reason: str, span: Span | None = None, below: str = "", inside: str = "") -> None:
        """Record that some code cannot be evaluated, and which facts about the package are incomplete for this reason.

        ``facet`` has the kinds of these facts, such as its executables. ``reason`` is a clause for messages. ``below`` limits
        the incomplete facts to a folder of the install prefix, ``inside`` to the build of a source folder. If the code does
        not run with default options, only the uses and exports of packages count as incomplete.
        """
        if self.non_default_conditions:
            facet &= Facet.USES | Facet.EXPORTS
        if facet and not self.muted:
            self.results.opaques[Opaque(facet, reason, span or self.current_place(), below=below, inside=inside)] = None

    def add_problem(self, kind: str, message: str, span: Span, path: str = "") -> None:
        """Record an error of a command, if the command certainly runs."""
        if not self.muted and not self.uncertain_conditions:
            self.results.problems[Problem(kind, message, span, subject=path)] = None


Handler = Callable[[Run, list[str]], "int | None"]
"""A function that runs a CMake command, given the run and the evaluated arguments.

It returns how the command may end (Exit), None if it ends normally."""
