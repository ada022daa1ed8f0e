"""The state of a run of CMake scripts: scopes of variables, functions and targets. Changes of a branch can be undone."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final, NamedTuple

from ros_lint.base.budget import Budget, BudgetExceeded
from ros_lint.base.text import Span
from ros_lint.collectors.cmake.evaluator.blocks import Body
from ros_lint.collectors.cmake.evaluator.values import HOLE, LONGEST, SLOW, certainly_set, is_unpaired, merge
from ros_lint.collectors.cmake.released_macros import VARIABLES
from ros_lint.collectors.cmake.syntax import Command

Exit = int
"""A set of bits: the ways in which a part of a script may end, such as NEXT | RETURN."""
NEXT: Final = 1
"""Bit of an Exit: the part ends normally, and the next command runs."""
BREAK: Final = 2
CONTINUE: Final = 4
RETURN: Final = 8
STOP: Final = 16
"""Bit of an Exit: CMake stops with an error, such as message(FATAL_ERROR)."""
BY_DEFAULT: Final = 32
"""Bit of an Exit that is set together with NEXT: with default options, the next command runs."""
IF_TESTING: Final = 64
"""Bit of an Exit that is set together with NEXT: the next command runs only if tests are enabled (BUILD_TESTING)."""


class Variables(dict[str, "str | None"]):
    """The variables of one scope, by name. The value None is an unset variable, which hides the variable of an outer scope."""

    __slots__ = ()


class BlockVariables(Variables):
    """The variables of a block() that has its own scope."""

    __slots__ = ()


class Properties(dict[str, str]):
    """The known properties of a target or of the project (GLOBAL), by name. Also used for the cache and the environment."""

    __slots__ = ()


class Procedure(NamedTuple):
    """A function or macro that a script defines."""

    name: str
    macro: bool
    parameters: tuple[str, ...]
    body: Body
    own: bool
    """True if a file of the evaluated package has the definition."""
    path: str
    """The path of the file with the definition, relative to the root folder of the workspace."""
    folder: str
    """The folder of the file with the definition, as the value of CMAKE_CURRENT_LIST_DIR."""
    provider: str = ""
    """The name of the package that defines the function or macro, "" for the evaluated package."""
    counts: bool = True
    """True if the body may read the arguments by number: ARGV, ARGC, ARGV0 and so on."""


class Choice(NamedTuple):
    """Several definitions of one function or macro name, each in another branch of the script.

    An entry None in ``procedures`` means that the name may be undefined.
    """

    procedures: tuple[Procedure | None, ...]
    by_default: int | None
    """The index in ``procedures`` of the definition that exists with default options, None if there is no such definition."""


class Change(NamedTuple):
    """A change of one entry of a mapping by a branch of a script.

    ``value`` is the new value, MISSING if the branch removed the entry.
    """

    mapping: dict[str, Any]
    key: str
    value: Any


Changes = dict[tuple[int, str], Change]

MISSING: Final = object()
_MOST_NESTED: Final = 100
"""Maximum depth of nested branches. Real packages need less than 20.

The commands after a command that may return or break count as a branch, too."""


MOST_STEPS: Final = 100_000
"""Maximum number of commands that one package may run.

Most real packages run less than 3,000, the largest about 93,000."""
MOST_CHARACTERS: Final = 1 << 26
"""Maximum number of characters of values that the scripts of one package may write and read.

Other work that costs memory or time is converted into characters. Real packages need less than a million characters for 1,000
commands."""


class State:
    """All data that CMake commands write, with a log that can undo the changes of a branch.

    The branches of an if() with an unknown condition run one after the other, each from the state before the if(). Then the
    states after the branches are merged into one state.
    """

    def __init__(self) -> None:
        self.scopes: list[Variables] = [Variables()]
        self.cache: Properties = Properties()
        self.environment: Properties = Properties()
        self.procedures: dict[str, Procedure | Choice] = {}
        self.targets: dict[str, Properties] = {}
        self.globals: Properties = Properties()
        self.path_variables: dict[str, str] = {}
        """Values of the variables with paths: the source folder, the current directory and file, and CMAKE_INSTALL_DOCDIR."""
        self.test_switches: dict[str, str] = {}
        """Names of variables that are true only if tests are enabled, each with the value of the variable in that case."""
        self.test_elements: dict[str, frozenset[str]] = {}
        """By the variable of a list: the elements that the list has only if tests are enabled."""
        self.log: list[tuple[dict[str, Any], str, Any]] | None = None
        self._nested = 0
        self.budget = Budget(MOST_STEPS, MOST_CHARACTERS)
        self.has_unpaired_brackets = False
        """True if some value has an unpaired square bracket. In this case, an unknown text may have an unpaired bracket, too."""

    # --- writing

    def put(self, mapping: dict[str, Any], key: str, value: Any) -> None:
        """Set ``mapping[key]`` to ``value``, and log the old value, so that the changes of a branch can be undone.

        Code that runs in a branch must write with this method. A text of more than 2^20 characters becomes unknown (HOLE).
        """
        if self.log is not None:
            self.log.append((mapping, key, mapping.get(key, MISSING)))
        if type(value) is str:
            if len(value) > LONGEST:
                value = HOLE
            self.budget.charge(len(value))
            self.note_brackets(value)
        mapping[key] = value

    def note_brackets(self, value: str) -> None:
        """Set ``has_unpaired_brackets`` if ``value``, which was written to a variable, may have an unpaired square bracket."""
        if ("[" in value or "]" in value or "\3" in value) and not self.has_unpaired_brackets:
            self.budget.charge(SLOW * len(value))
            self.has_unpaired_brackets = is_unpaired(value)

    def remove(self, mapping: dict[str, Any], key: str) -> None:
        if key in mapping:
            if self.log is not None:
                self.log.append((mapping, key, mapping[key]))
            del mapping[key]

    def set(self, name: str, value: str | None) -> None:
        """Set a variable of the innermost scope to a value; None unsets the variable."""
        self.put(self.scopes[-1], name, value)

    def set_all(self, values: Mapping[str, str | None]) -> None:
        """Set several variables of the innermost scope; the value None unsets a variable."""
        scope = self.scopes[-1]
        if self.log is not None:
            self.log += [(scope, name, scope.get(name, MISSING)) for name in values]
        scope.update(values)
        for value in values.values():
            if value:
                self.budget.charge(len(value))
                self.note_brackets(value)

    def set_parent(self, name: str, value: str | None) -> None:
        """Set a variable of the scope that encloses the innermost one, as set(PARENT_SCOPE) does; None unsets the variable."""
        if len(self.scopes) > 1:
            if name not in self.scopes[-1]:  # the inner scope keeps the value that it had
                value_before = self.value_or_missing(name)
                self.put(self.scopes[-1], name, None if value_before is MISSING else value_before)
            self.put(self.scopes[-2], name, value)

    def return_to_caller(self, name: str, value: str | None) -> None:
        """Set a variable in the scope of the caller of the current function, as return(PROPAGATE) does.

        The current command may be in a block() of the function.
        """
        scope_index = next((index for index in range(len(self.scopes) - 1, 0, -1) if type(self.scopes[index]) is Variables), 0)
        if scope_index == len(self.scopes) - 1:
            self.set_parent(name, value)
        elif scope_index:
            self.put(self.scopes[scope_index - 1], name, value)

    # --- reading

    def builtin_value(self, name: str) -> str | None:
        """Return the value of a variable that CMake itself sets, None if CMake sets none or the value is unknown."""
        return self.path_variables.get(name) or VARIABLES.get(name)

    def normal(self, name: str) -> str | None:
        """Return the value of a variable in the scopes, ignoring the cache; None if the variable is not set."""
        for scope in reversed(self.scopes):
            if name in scope:
                return scope[name]
        return None

    def value_or_missing(self, name: str, depth: int | None = None) -> Any:
        """Return the value of a variable in the scopes or the cache, MISSING if the variable is not set.

        ``depth`` is the number of scopes to search, from the outermost one; None searches all scopes.
        """
        scopes = self.scopes if depth is None else self.scopes[:depth]
        for scope in reversed(scopes):
            if name in scope:
                value = scope[name]
                if value is None:
                    return self.cache.get(name)
                if name in self.cache and not certainly_set(value):
                    return merge([value, self.cache[name]])
                return value
        return self.cache.get(name, MISSING)

    # --- branching

    def branch(self, run: Callable[[], Exit]) -> tuple[Exit, Changes]:
        """Call ``run``, which runs a branch, and undo its changes. Return how the branch may end (Exit), and its changes.

        Raises BudgetExceeded if branches are nested too deeply.
        """
        if self._nested > _MOST_NESTED:
            raise BudgetExceeded
        self._nested += 1
        outer_log, self.log = self.log, []
        try:
            exits = run()
        finally:
            self._nested -= 1
            log, self.log = self.log, outer_log
            changes: Changes = {}
            for mapping, key, _ in log:
                slot = (id(mapping), key)
                if slot not in changes:
                    changes[slot] = Change(mapping, key, self._visible_value(mapping, key))
            for mapping, key, value in reversed(log):
                if value is MISSING:
                    mapping.pop(key, None)
                else:
                    mapping[key] = value
        return exits, changes

    def join(self, alternatives: Sequence[Changes], default: int | None = None) -> None:
        """Change this state to the merged state after several branches, of which one runs, given the changes of each branch.

        ``default`` is the index of the branch that runs with default options, None if there is no such branch.
        """
        if len(alternatives) == 1:
            for change in alternatives[0].values():
                if change.value is MISSING:
                    self.remove(change.mapping, change.key)
                else:
                    self.put(change.mapping, change.key, change.value)
            return
        slots = {slot: change for changes in alternatives for slot, change in changes.items()}
        fresh = {id(change.value) for change in slots.values() if isinstance(change.value, Properties)}
        for slot, (mapping, key, value) in slots.items():
            if id(mapping) in fresh and value is not MISSING:
                self.put(mapping, key, value)  # property of a target that only this branch creates
                continue
            value_before = self._visible_value(mapping, key)
            values = [changes[slot].value if slot in changes else value_before for changes in alternatives]
            merged = _merged(mapping, values, default)
            if merged is MISSING:
                self.remove(mapping, key)
            elif merged is not mapping.get(key, MISSING):
                self.put(mapping, key, merged)

    def forget(self, changes: Changes) -> None:
        """Set each entry that ``changes`` has, such as a variable, to an unknown value (HOLE)."""
        for mapping, key, value in changes.values():
            if isinstance(value, str) or value is None or isinstance(mapping, Variables):
                self.put(mapping, key, HOLE)

    def _visible_value(self, mapping: dict[str, Any], key: str) -> Any:
        """Return an entry of a mapping, MISSING if there is none.

        If the mapping is a scope without the variable ``key``, the outer scopes, the cache and the built-in values are
        searched.
        """
        value = mapping.get(key, MISSING)
        if value is MISSING and isinstance(mapping, Variables):
            for depth, scope in enumerate(self.scopes):
                if scope is mapping:
                    outer_value = self.value_or_missing(key, depth)
                    return self.builtin_value(key) if outer_value is MISSING else outer_value
        return value


def _merged(mapping: Mapping[str, Any], values: Sequence[Any], default: int | None) -> Any:
    first = values[0]
    if all(value is first for value in values):
        return first
    if all(value is None or value is MISSING or isinstance(value, str) for value in values):
        unset = None if isinstance(mapping, Variables) else MISSING
        merged = merge([None if value is MISSING else value for value in values], default)
        return unset if merged is None else merged
    definitions = [value for value in values if value is not MISSING]
    if isinstance(definitions[0], (Procedure, Choice)):
        alternatives: list[Procedure | None] = []
        chosen_index = None
        for number, value in enumerate(values):
            options = value.procedures if isinstance(value, Choice) else (None if value is MISSING else value,)
            alternatives += [option for option in options if not any(option is known for known in alternatives)]
            default_index = value.by_default if isinstance(value, Choice) else 0
            if number == default and default_index is not None:
                chosen_index = next(at for at, procedure in enumerate(alternatives) if procedure is options[default_index])
        return Choice(tuple(alternatives), chosen_index)
    return definitions[0]


class InstalledTarget(NamedTuple):
    """A target of install(TARGETS). The name of its file is known only after the whole script has run."""

    target: str
    executables: str | None
    """The install destination of the target if the target is an executable, None if executables are not installed."""
    libraries: str | None
    archives: str | None
    conditional: bool
    span: Span
    exported_in: str = ""
    """The name of the export set of the target (EXPORT), "" if there is none."""
    headers: tuple[tuple[str, str | None], ...] = ()
    """Pairs of an artifact keyword of install(), such as "PUBLIC_HEADER", and its destination."""
    undefined: bool = False
    """True if the target is certainly not defined when install() runs. CMake looks for the target at this time."""


class CallFrame:
    """An active file, function or macro: one entry of the call stack of a run."""

    __slots__ = ("command", "file", "folder", "macro_arguments", "own", "path", "procedure", "provider")

    def __init__(self, own: bool, path: str, file: str, procedure: Procedure | None = None, provider: str = "") -> None:
        self.own = own
        self.path = path
        self.file = file
        self.folder = "" if procedure else file.rpartition("/")[0]
        self.procedure = procedure
        self.provider = provider
        self.macro_arguments: dict[str, str] | None = None
        """Values of the parameters of a macro, by the name of the parameter; None outside of macros."""
        self.command: Command | None = None
