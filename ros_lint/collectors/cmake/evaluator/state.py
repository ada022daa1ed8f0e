"""What a CMake run knows at a moment: variables in scopes, definitions, targets, and the ways a run can branch."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final, NamedTuple

from ros_lint.base.text import Span
from ros_lint.collectors.cmake.evaluator.blocks import Body
from ros_lint.collectors.cmake.evaluator.values import HOLE, LONGEST, SLOW, certainly_set, merge, unpaired
from ros_lint.collectors.cmake.released_macros import VARIABLES
from ros_lint.collectors.cmake.syntax import Command

Exit = int
"""How a piece of script can end: a set of the bits below."""
NEXT: Final = 1
"""The next command follows."""
BREAK: Final = 2
CONTINUE: Final = 4
RETURN: Final = 8
STOP: Final = 16
"""CMake gives up: message(FATAL_ERROR)."""
USUAL: Final = 32
"""Beside NEXT: it is usual that the next command follows."""
TESTS: Final = 64
"""Beside NEXT: the next command follows only where tests are wanted."""


class Variables(dict[str, "str | None"]):
    """The variables of one scope. ``None`` is an unset variable, which hides the one of the outer scope."""

    __slots__ = ()


class BlockVariables(Variables):
    """The variables of a block() with a scope of its own."""

    __slots__ = ()


class Properties(dict[str, str]):
    """What is known of a target, a directory or the whole run: properties by name."""

    __slots__ = ()


class Procedure(NamedTuple):
    """A function or macro."""

    name: str
    macro: bool
    parameters: tuple[str, ...]
    body: Body
    own: bool
    """Whether it stands in a file of the package that is evaluated."""
    path: str
    """Of that file, relative to the base of the run."""
    folder: str
    """Of that file, as CMake would name it."""
    provider: str = ""
    """The package that brings it, when it is not the package's own."""
    counts: bool = True
    """Whether its body may ask for ARGV, ARGC or ARGV0 and so on."""


class Choice(NamedTuple):
    """Several procedures of one name, of which one was defined. ``None``: perhaps none was."""

    procedures: tuple[Procedure | None, ...]
    usual: int | None
    """The index of the one that is defined unless the user asks for another."""


class Change(NamedTuple):
    """What a branch did to one entry of a mapping. ``value`` is MISSING when it removed it."""

    mapping: dict[str, Any]
    key: str
    value: Any


Changes = dict[tuple[int, str], Change]

MISSING: Final = object()
_DEEPEST: Final = 100
"""Branches within branches; all that follows what may leave a body or a loop is one. Real packages need less than 20."""


MOST_CHARACTERS: Final = 1 << 28
"""Characters of values that one package may make and read, what else takes memory or time counted in. Real ones need less
than a million for 1,000 commands."""


class BudgetError(Exception):
    """The script runs longer than any real one, or makes longer texts."""


class State:
    """Everything that commands write to, with an undo log.

    Branches of an unknown condition are run one after the other, each from the same start, and joined afterwards.
    """

    def __init__(self) -> None:
        self.scopes: list[Variables] = [Variables()]
        self.cache: Properties = Properties()
        self.environment: Properties = Properties()
        self.procedures: dict[str, Procedure | Choice] = {}
        self.targets: dict[str, Properties] = {}
        self.globals: Properties = Properties()
        self.places: dict[str, str] = {}
        """Variables that say where the sources lie, which directory and which file is being run, and where pages go."""
        self.for_tests: dict[str, str] = {}
        """Variables that become true only where tests are wanted, with the value that they get there."""
        self.gained: dict[str, frozenset[str]] = {}
        """Elements that lists have only where tests are wanted, by the variable that holds the list."""
        self.log: list[tuple[dict[str, Any], str, Any]] | None = None
        self._nested = 0
        self.characters = MOST_CHARACTERS
        """How many more may be made and read."""
        self.unpaired = False
        """Whether some value holds a square bracket without its partner, so that unknown texts may hold one too."""

    # --- writing

    def charge(self, size: int) -> None:
        """Count characters that a command makes or reads. Raises BudgetError when there are too many."""
        self.characters -= size
        if self.characters < 0:
            raise BudgetError

    def put(self, mapping: dict[str, Any], key: str, value: Any) -> None:
        """Write an entry; everything that a branch may write goes through here. A text that is too long is unknown."""
        if self.log is not None:
            self.log.append((mapping, key, mapping.get(key, MISSING)))
        if type(value) is str:
            if len(value) > LONGEST:
                value = HOLE
            self.charge(len(value))
            self.notice(value)
        mapping[key] = value

    def notice(self, value: str) -> None:
        """Look for brackets without partners in a value that can be read from now on."""
        if ("[" in value or "]" in value or "\3" in value) and not self.unpaired:
            self.charge(SLOW * len(value))
            self.unpaired = unpaired(value)

    def remove(self, mapping: dict[str, Any], key: str) -> None:
        if key in mapping:
            if self.log is not None:
                self.log.append((mapping, key, mapping[key]))
            del mapping[key]

    def set(self, name: str, value: str | None) -> None:
        """Set a variable of the innermost scope, or unset it."""
        self.put(self.scopes[-1], name, value)

    def set_all(self, values: Mapping[str, str | None]) -> None:
        """Set several variables of the innermost scope; None unsets one."""
        scope = self.scopes[-1]
        if self.log is not None:
            self.log += [(scope, name, scope.get(name, MISSING)) for name in values]
        scope.update(values)
        for value in values.values():
            if value:
                self.charge(len(value))
                self.notice(value)

    def set_outer(self, name: str, value: str | None) -> None:
        """Set a variable of the scope around the innermost (PARENT_SCOPE)."""
        if len(self.scopes) > 1:
            if name not in self.scopes[-1]:  # the inner scope keeps what it saw so far
                seen = self.found(name)
                self.put(self.scopes[-1], name, None if seen is MISSING else seen)
            self.put(self.scopes[-2], name, value)

    def return_to_caller(self, name: str, value: str | None) -> None:
        """Set a variable of the scope that a function is called from, whatever blocks of it are open (return(PROPAGATE))."""
        inner = next((index for index in range(len(self.scopes) - 1, 0, -1) if type(self.scopes[index]) is Variables), 0)
        if inner == len(self.scopes) - 1:
            self.set_outer(name, value)
        elif inner:
            self.put(self.scopes[inner - 1], name, value)

    # --- reading

    def brought(self, name: str) -> str | None:
        """Return what CMake itself sets a variable to, None when it does not, or nobody knows to what."""
        return self.places.get(name) or VARIABLES.get(name)

    def normal(self, name: str) -> str | None:
        """Return a variable as the scopes hold it, without the cache."""
        for scope in reversed(self.scopes):
            if name in scope:
                return scope[name]
        return None

    def found(self, name: str, depth: int | None = None) -> Any:
        """Return a variable as scopes and cache hold it, or MISSING. ``depth`` leaves inner scopes out."""
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
        """Run something, take back all that it wrote, and return how it ended and what it wrote.

        Raises BudgetError where branches are nested too deeply.
        """
        if self._nested > _DEEPEST:
            raise BudgetError
        self._nested += 1
        outer, self.log = self.log, []
        try:
            ended = run()
        finally:
            self._nested -= 1
            log, self.log = self.log, outer
            changes: Changes = {}
            for mapping, key, _ in log:
                slot = (id(mapping), key)
                if slot not in changes:
                    changes[slot] = Change(mapping, key, self._held(mapping, key))
            for mapping, key, old in reversed(log):
                if old is MISSING:
                    mapping.pop(key, None)
                else:
                    mapping[key] = old
        return ended, changes

    def join(self, alternatives: Sequence[Changes], default: int | None = None) -> None:
        """Write what holds after one of several branches, each given by what it changed.

        ``default`` is the index of the branch that is taken unless the user asks for another.
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
                self.put(mapping, key, value)  # of a target that one branch has made, which no other has seen
                continue
            before = self._held(mapping, key)
            values = [changes[slot].value if slot in changes else before for changes in alternatives]
            merged = _merged(mapping, values, default)
            if merged is MISSING:
                self.remove(mapping, key)
            elif merged is not mapping.get(key, MISSING):
                self.put(mapping, key, merged)

    def forget(self, changes: Changes) -> None:
        """Take every value that something changed for unknown from now on."""
        for mapping, key, value in changes.values():
            if isinstance(value, str) or value is None or isinstance(mapping, Variables):
                self.put(mapping, key, HOLE)

    def _held(self, mapping: dict[str, Any], key: str) -> Any:
        """Return an entry; what a scope does not hold itself is taken from the scopes around it, and from CMake."""
        value = mapping.get(key, MISSING)
        if value is MISSING and isinstance(mapping, Variables):
            for depth, scope in enumerate(self.scopes):
                if scope is mapping:
                    outer = self.found(key, depth)
                    return self.brought(key) if outer is MISSING else outer
        return value


def _merged(mapping: Mapping[str, Any], values: Sequence[Any], default: int | None) -> Any:
    first = values[0]
    if all(value is first for value in values):
        return first
    if all(value is None or value is MISSING or isinstance(value, str) for value in values):
        gone = None if isinstance(mapping, Variables) else MISSING
        merged = merge([None if value is MISSING else value for value in values], default)
        return gone if merged is None else merged
    there = [value for value in values if value is not MISSING]
    if isinstance(there[0], (Procedure, Choice)):
        alternatives: list[Procedure | None] = []
        usual = None
        for number, value in enumerate(values):
            options = value.procedures if isinstance(value, Choice) else (None if value is MISSING else value,)
            alternatives += [option for option in options if not any(option is known for known in alternatives)]
            wanted = value.usual if isinstance(value, Choice) else 0
            if number == default and wanted is not None:
                usual = next(at for at, one in enumerate(alternatives) if one is options[wanted])
        return Choice(tuple(alternatives), usual)
    return there[0]


class InstalledTarget(NamedTuple):
    """A target to install. Its file name is known only when the whole script has run."""

    target: str
    executables: str | None
    """Where an executable goes, None when it is not installed."""
    libraries: str | None
    archives: str | None
    conditional: bool
    span: Span
    exported_in: str = ""
    """The set that it is exported in."""
    headers: tuple[tuple[str, str | None], ...] = ()
    """Where headers go that belong to it, by artifact."""


class Frame:
    """A file, function or macro that is being run."""

    __slots__ = ("command", "file", "folder", "given", "own", "path", "procedure", "provider")

    def __init__(self, own: bool, path: str, file: str, procedure: Procedure | None = None, provider: str = "") -> None:
        self.own = own
        self.path = path
        self.file = file
        self.folder = "" if procedure else file.rpartition("/")[0]
        self.procedure = procedure
        self.provider = provider
        self.given: dict[str, str] | None = None
        """What a macro puts in the place of references to its parameters."""
        self.command: Command | None = None
