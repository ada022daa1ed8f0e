"""State of a CMake run: variables in scopes, definitions and targets, with an undo log for branches."""

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
"""The exits of a piece of a script: a set of the bits below."""
NEXT: Final = 1
"""The next command follows."""
BREAK: Final = 2
CONTINUE: Final = 4
RETURN: Final = 8
STOP: Final = 16
"""CMake stops with an error, such as message(FATAL_ERROR)."""
BY_DEFAULT: Final = 32
"""Together with NEXT: with default options, the next command follows."""
IF_TESTING: Final = 64
"""Together with NEXT: the next command follows only if tests are enabled."""


class Variables(dict[str, "str | None"]):
    """The variables of one scope, by name. ``None`` is an unset variable; it hides a variable of an outer scope."""

    __slots__ = ()


class BlockVariables(Variables):
    """The variables of a block() that has its own scope."""

    __slots__ = ()


class Properties(dict[str, str]):
    """The known properties of a target, a directory or the whole run, by name."""

    __slots__ = ()


class Procedure(NamedTuple):
    """A defined function or macro."""

    name: str
    macro: bool
    parameters: tuple[str, ...]
    body: Body
    own: bool
    """True if a file of the evaluated package defines it."""
    path: str
    """The path of the file that defines it, relative to the base of the run."""
    folder: str
    """The folder of that file, as CMake names it."""
    provider: str = ""
    """The package that defines it, "" for the evaluated package."""
    counts: bool = True
    """True if its body may read ARGV, ARGC, ARGV0 and so on."""


class Choice(NamedTuple):
    """Functions or macros of one name that different branches define. ``None`` among them: possibly none is defined."""

    procedures: tuple[Procedure | None, ...]
    by_default: int | None
    """The index of the procedure that is defined with default options."""


class Change(NamedTuple):
    """A change of one entry of a mapping by a branch.

    ``value`` is MISSING if the branch removed the entry.
    """

    mapping: dict[str, Any]
    key: str
    value: Any


Changes = dict[tuple[int, str], Change]

MISSING: Final = object()
_MOST_NESTED: Final = 100
"""Greatest depth of nested branches.

The commands after a possible return() or break() also form a branch.

Real packages need less than 20."""


MOST_STEPS: Final = 100_000
"""Commands that one package may run. Most real packages run less than 3,000, the largest about 93,000."""
MOST_CHARACTERS: Final = 1 << 26
"""Characters of values that the scripts of one package may write and read.

Other work that costs memory or time is converted into characters. Real packages need less than a million for 1,000 commands."""


class State:
    """All data that commands write, with an undo log.

    The branches of an unknown condition run one after the other, each from the same initial state, and are then joined.
    """

    def __init__(self) -> None:
        self.scopes: list[Variables] = [Variables()]
        self.cache: Properties = Properties()
        self.environment: Properties = Properties()
        self.procedures: dict[str, Procedure | Choice] = {}
        self.targets: dict[str, Properties] = {}
        self.globals: Properties = Properties()
        self.path_variables: dict[str, str] = {}
        """Variables for places: the source folder, the current directory and file, CMAKE_INSTALL_DOCDIR."""
        self.test_switches: dict[str, str] = {}
        """Variables that are true only if tests are enabled, with the value that they then have."""
        self.test_elements: dict[str, frozenset[str]] = {}
        """Elements that a list has only if tests are enabled, by the variable of the list."""
        self.log: list[tuple[dict[str, Any], str, Any]] | None = None
        self._nested = 0
        self.budget = Budget(MOST_STEPS, MOST_CHARACTERS)
        self.has_unpaired_brackets = False
        """True if some value has an unpaired square bracket, because unknown texts may then have one too."""

    # --- writing

    def put(self, mapping: dict[str, Any], key: str, value: Any) -> None:
        """Set ``mapping[key]`` to ``value``, and record the old value, so that the effects of a branch can be undone.

        A branch writes only with this method. A text that is too long becomes HOLE.
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
        """Set ``has_unpaired_brackets`` if a value that was written to a variable may have an unpaired square bracket."""
        if ("[" in value or "]" in value or "\3" in value) and not self.has_unpaired_brackets:
            self.budget.charge(SLOW * len(value))
            self.has_unpaired_brackets = is_unpaired(value)

    def remove(self, mapping: dict[str, Any], key: str) -> None:
        if key in mapping:
            if self.log is not None:
                self.log.append((mapping, key, mapping[key]))
            del mapping[key]

    def set(self, name: str, value: str | None) -> None:
        """Set a variable of the innermost scope, or unset it."""
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
        """Set a variable of the scope that encloses the innermost one (PARENT_SCOPE)."""
        if len(self.scopes) > 1:
            if name not in self.scopes[-1]:  # the inner scope keeps the value that it had
                value_before = self.value_or_missing(name)
                self.put(self.scopes[-1], name, None if value_before is MISSING else value_before)
            self.put(self.scopes[-2], name, value)

    def return_to_caller(self, name: str, value: str | None) -> None:
        """Set a variable of the caller's scope, even from a block() in the function (return(PROPAGATE))."""
        scope_index = next((index for index in range(len(self.scopes) - 1, 0, -1) if type(self.scopes[index]) is Variables), 0)
        if scope_index == len(self.scopes) - 1:
            self.set_parent(name, value)
        elif scope_index:
            self.put(self.scopes[scope_index - 1], name, value)

    # --- reading

    def builtin_value(self, name: str) -> str | None:
        """Return the value that CMake itself gives a variable, None if it sets none or the value is unknown."""
        return self.path_variables.get(name) or VARIABLES.get(name)

    def normal(self, name: str) -> str | None:
        """Return the value of a variable in the scopes, ignoring the cache."""
        for scope in reversed(self.scopes):
            if name in scope:
                return scope[name]
        return None

    def value_or_missing(self, name: str, depth: int | None = None) -> Any:
        """Return the value of a variable in the scopes and the cache, or MISSING.

        Only the outermost ``depth`` scopes are searched, by default all.
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
        """Call ``run``, which runs a branch, undo the changes that it made, and return its possible exits and its changes.

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
        """Write the state after one of several branches ran, given the changes of each branch.

        ``default`` is the index of the branch that runs with default options.
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
        """Set every entry that ``changes`` contain to an unknown value."""
        for mapping, key, value in changes.values():
            if isinstance(value, str) or value is None or isinstance(mapping, Variables):
                self.put(mapping, key, HOLE)

    def _visible_value(self, mapping: dict[str, Any], key: str) -> Any:
        """Return an entry of a mapping, MISSING if there is none.

        If the mapping is a scope that does not set the variable ``key``, the outer scopes and CMake's defaults are searched.
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
    """A target of install(TARGETS). Its file name is known only after the whole script has run."""

    target: str
    executables: str | None
    """The destination if the target is an executable, None if executables are not installed."""
    libraries: str | None
    archives: str | None
    conditional: bool
    span: Span
    exported_in: str = ""
    """The export set of the target."""
    headers: tuple[tuple[str, str | None], ...] = ()
    """Destinations of the headers of the target, by artifact."""
    undefined: bool = False
    """True if the target is certainly not defined where install() is called, which is when CMake looks for it."""


class CallFrame:
    """A file, function or macro that is being run."""

    __slots__ = ("command", "file", "folder", "macro_arguments", "own", "path", "procedure", "provider")

    def __init__(self, own: bool, path: str, file: str, procedure: Procedure | None = None, provider: str = "") -> None:
        self.own = own
        self.path = path
        self.file = file
        self.folder = "" if procedure else file.rpartition("/")[0]
        self.procedure = procedure
        self.provider = provider
        self.macro_arguments: dict[str, str] | None = None
        """Texts that replace references to the parameters of a macro."""
        self.command: Command | None = None
