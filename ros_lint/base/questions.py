"""Remembered answers: pure functions whose results are kept, and found again as long as nothing that they read has changed.

A :class:`Memo` keeps each answer for one run. A :class:`Recorder` also records what each answer has read: inputs
(:class:`Cell`) and other answers. After a change of inputs, an answer is computed again only if something that it has read is
different. An answer that is computed again with an equal result stops the change (early cut-off, as in salsa).
"""

from __future__ import annotations

from collections.abc import Callable, Container, Hashable, Iterable, Iterator, Mapping
from typing import Any, Protocol, TypeVar, cast

T = TypeVar("T")
V = TypeVar("V")


class Questions(Protocol):
    """Answers by question. A question is a hashable value, usually a function with its arguments."""

    def ask(self, question: Hashable, answer: Callable[[], T]) -> T:
        """Return the answer to a question. ``answer`` computes it if it is not known. It must be a pure function."""


class Memo:
    """Answers that are kept as long as the object, without a record of what they have read."""

    __slots__ = ("_answers",)

    def __init__(self) -> None:
        self._answers: dict[Hashable, Any] = {}

    def ask(self, question: Hashable, answer: Callable[[], T]) -> T:
        # Not in an exception handler: the traceback of an exception in ``answer`` would begin with the missing key.
        if question not in self._answers:
            self._answers[question] = answer()
        return cast("T", self._answers[question])


class Cell:
    """An input that answers can read, such as a field of a package. Two cells are never equal."""

    __slots__ = ("readers",)

    def __init__(self) -> None:
        self.readers: dict[_Answer, None] = {}
        """The answers that have read the cell."""


_FEW = 1000
"""Number of answers below which none is forgotten."""

_CURRENT, _SUSPECT, _OUTDATED = 0, 1, 2
"""States of an answer: valid; valid unless an answer that it has read changes; invalid."""


class _Answer(Cell):
    """The answer to a question. Other answers can read it."""

    __slots__ = ("compute", "question", "reads", "state", "value")

    def __init__(self, question: Hashable, compute: Callable[[], object]) -> None:
        super().__init__()
        self.question = question
        self.compute = compute
        self.value: object = None
        self.reads: dict[Cell, None] = {}
        self.state = _OUTDATED


class Recorder:
    """Answers with a record of what they have read.

    :meth:`change` is called between two runs. Values that answers read must not change while an answer is computed.
    """

    def __init__(self) -> None:
        self._answers: dict[Hashable, _Answer] = {}
        self._roots: dict[Cell, None] = {}
        """The answers of this run that were asked outside of a computation."""
        self._needed = 0
        """The number of answers after the last removal of those that are not needed."""
        self.reads: dict[Cell, None] | None = None
        """The reads of the current computation so far, in order; None outside of a computation."""

    def begin(self) -> None:
        """Begin a run. Once the answers have doubled, forget those that the last run has not read, directly or indirectly."""
        if len(self._answers) > 2 * self._needed + _FEW:
            needed = set(self._roots)
            waiting = list(needed)
            while waiting:
                cell = waiting.pop()
                new = cell.reads.keys() - needed if isinstance(cell, _Answer) else ()
                needed.update(new)
                waiting += new
            for answer in [answer for answer in self._answers.values() if answer not in needed]:
                self._forget(answer)
            self._needed = len(self._answers)
        self._roots = {}

    def scope(self) -> Questions:
        """Return a collection of answers of its own: the same question in another scope is another question."""
        return _Scope(self)

    def note(self, cell: Cell) -> None:
        """Record that the answer that is being computed reads a cell."""
        if self.reads is not None:
            self.reads[cell] = None

    def ask(self, question: Hashable, answer: Callable[[], T]) -> T:
        found = self._answers.get(question)
        if found is None:
            found = _Answer(question, answer)
            found.value = self._compute(found)
            found.state = _CURRENT
            self._answers[question] = found
        elif found.state:
            found.compute = answer
            self._renew(found)
        (self._roots if self.reads is None else self.reads)[found] = None
        return cast("T", found.value)

    def answered(self, scope: Questions, question: Hashable) -> tuple[Cell, object] | None:
        """Return the answer to a question of a scope, and its value; None if the question was not asked."""
        answer = self._answers.get((scope, question))
        return (answer, answer.value) if answer is not None else None

    def answers(self, scope: Questions) -> Iterator[tuple[Any, Cell, object]]:
        """Yield each question of a scope, its answer and its value."""
        for question, answer in self._answers.items():
            if isinstance(question, tuple) and question[0] is scope:
                yield question[1], answer, answer.value

    def change(self, cells: Iterable[Cell]) -> None:
        """Record that the values of some inputs have changed since they were read."""
        suspects: list[_Answer] = []
        for cell in cells:
            for reader in cell.readers:
                if reader.state == _CURRENT:
                    suspects.append(reader)
                reader.state = _OUTDATED
        while suspects:
            for reader in suspects.pop().readers:
                if reader.state == _CURRENT:
                    reader.state = _SUSPECT
                    suspects.append(reader)

    def _renew(self, found: _Answer) -> None:
        """Make an answer valid: compute it again if something that it has read has changed."""
        if found.state == _SUSPECT:
            for read in found.reads:
                if isinstance(read, _Answer) and read.state:
                    try:
                        self._renew(read)
                    except Exception:  # the error is raised again if the question is still asked
                        found.state = _OUTDATED
                if found.state == _OUTDATED:
                    break
            else:
                found.state = _CURRENT
                return
        value = self._compute(found)
        found.state = _CURRENT
        if not same(found.value, value):
            found.value = value
            for reader in found.readers:
                reader.state = _OUTDATED

    def _compute(self, found: _Answer) -> object:
        """Return a newly computed answer, and record what it has read."""
        outer, self.reads = self.reads, {}
        try:
            value = found.compute()
        except BaseException:
            if outer is not None:
                outer.update(self.reads)  # the question that asks this one depends on the failure
            self._forget(found)
            raise
        else:
            for cell in found.reads:
                if cell not in self.reads:
                    cell.readers.pop(found, None)
            for cell in self.reads:
                cell.readers[found] = None
            found.reads = self.reads
            return value
        finally:
            self.reads = outer

    def _forget(self, found: _Answer) -> None:
        self._answers.pop(found.question, None)
        for cell in found.reads:
            cell.readers.pop(found, None)
        for reader in found.readers:
            reader.state = _OUTDATED


class ReadSets:
    """Finds what answers have read: inputs and other answers of a collection, directly or through further answers."""

    def __init__(self, named: Container[Cell]) -> None:
        self._named = named
        self._members: list[Cell] = []
        self._known: dict[Cell, int] = {}
        """The members of the collection below each answer outside of it, as a set of bits."""

    def of(self, answers: Iterable[Cell]) -> list[Cell]:
        """Return the members of the collection that some answers have read, and all inputs that are not in the collection."""
        bits = 0
        for answer in answers:
            for read in answer.reads if isinstance(answer, _Answer) else ():
                bits |= self._below(read)
        digits = bin(bits)[:1:-1]
        found: list[Cell] = []
        number = digits.find("1")
        while number >= 0:
            found.append(self._members[number])
            number = digits.find("1", number + 1)
        return found

    def _below(self, start: Cell) -> int:
        waiting = [start]
        while waiting and start not in self._known:
            current = waiting[-1]
            if current in self._known:
                pass
            elif current in self._named or not isinstance(current, _Answer):
                self._known[current] = 1 << len(self._members)
                self._members.append(current)
            elif missing := [read for read in current.reads if read not in self._known]:
                waiting += missing
                continue
            else:
                bits = 0
                for read in current.reads:
                    bits |= self._known[read]
                self._known[current] = bits
            waiting.pop()
        return self._known[start]


class _Scope:
    """The answers of a recorder to the questions about one object."""

    __slots__ = ("_recorder",)

    def __init__(self, recorder: Recorder) -> None:
        self._recorder = recorder

    def ask(self, question: Hashable, answer: Callable[[], T]) -> T:
        return self._recorder.ask((self, question), answer)


def same(first: object, second: object) -> bool:
    """Return whether two values are equal, including the order of the entries of mappings in them."""
    return first is second or (first == second and _in_same_order(first, second))


_PLAIN = frozenset((str, int, bool, bytes, type(None)))


def _in_same_order(first: Any, second: Any) -> bool:
    if first is second or first.__class__ in _PLAIN:
        return True
    if isinstance(first, Mapping):
        return list(first) == list(second) and all(_in_same_order(value, second[key]) for key, value in first.items())
    if isinstance(first, (tuple, list)):
        return all(map(_in_same_order, first, second))
    return True


class RecordedMapping(Mapping[str, V]):
    """A mapping whose look-ups are recorded. The look-up of a missing key is recorded, too."""

    def __init__(self, recorder: Recorder) -> None:
        self._recorder = recorder
        self._values: Mapping[str, V] = {}
        self._cells: dict[str, Cell] = {}
        self._presence: dict[str, Cell] = {}
        self._keys = Cell()
        self._all = Cell()

    def update(self, values: Mapping[str, V]) -> Iterator[Cell]:
        """Replace the contents, and yield the cells that have changed."""
        before, self._values = self._values, values
        for key, cell in self._cells.items():
            if (key in before) != (key in values) or (key in values and not same(before[key], values[key])):
                yield cell
        for key, cell in self._presence.items():
            if (key in before) != (key in values):
                yield cell
        if list(before) != list(values):
            yield self._keys
            yield self._all
        elif any(not same(before[key], value) for key, value in values.items()):
            yield self._all

    def cells(self) -> Iterator[tuple[str, Cell]]:
        """Yield the inputs that have been read. The text names the part of the mapping, for :meth:`part`."""
        yield from [(f"value {key}", cell) for key, cell in self._cells.items()]
        yield from [(f"presence {key}", cell) for key, cell in self._presence.items()]
        yield from (("keys", self._keys), ("all", self._all))

    def part(self, name: str) -> object:
        """Return the part of the mapping that :meth:`cells` has named."""
        kind, _, key = name.partition(" ")
        match kind:
            case "value":
                return (self._values[key],) if key in self._values else ()
            case "presence":
                return key in self._values
            case "keys":
                return list(self._values)
        return dict(self._values)

    def __getitem__(self, key: str) -> V:
        if self._recorder.reads is not None:
            self._recorder.reads[_cell(self._cells, key)] = None
        return self._values[key]

    def __contains__(self, key: object) -> bool:
        if self._recorder.reads is not None and isinstance(key, str):
            self._recorder.reads[_cell(self._presence, key)] = None
        return key in self._values

    def __iter__(self) -> Iterator[str]:
        self._recorder.note(self._keys)
        return iter(self._values)

    def __len__(self) -> int:
        self._recorder.note(self._keys)
        return len(self._values)

    def values(self) -> Any:
        self._recorder.note(self._all)
        return self._values.values()

    def items(self) -> Any:
        self._recorder.note(self._all)
        return self._values.items()


def _cell(cells: dict[str, Cell], key: str) -> Cell:
    cell = cells.get(key)
    if cell is None:
        cell = cells[key] = Cell()
    return cell
