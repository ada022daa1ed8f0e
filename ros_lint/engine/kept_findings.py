"""The findings of rules from one run to the next, with a digest of each input that the rules have read.

In the next run a rule runs again in a package only if an input that it has read is different. Inputs are the parts of the
loaded workspace (:mod:`ros_lint.workspace.inputs`), so that an edit without an effect on a part has none on the findings.
"""

from __future__ import annotations

from array import array
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.analysis.finding import Finding
from ros_lint.base.columns import Codec
from ros_lint.base.questions import ReadSets
from ros_lint.base.recorded_tree import Answers
from ros_lint.engine.report import Issue
from ros_lint.engine.run import Results, question_of, results_of
from ros_lint.engine.shared_answers import PREFIX, SharedAnswers
from ros_lint.workspace.inputs import Inputs, digest

if TYPE_CHECKING:
    from ros_lint.analysis.rule import Rule
    from ros_lint.base.questions import Cell, Recorder
    from ros_lint.base.recorded_tree import RecordedTree
    from ros_lint.workspace.cache.file import CacheFile
    from ros_lint.workspace.handles import Handles
    from ros_lint.workspace.model import Package


RECORD = "findings-"
"""Prefix of the names of records with findings."""

_RULE = "//"
"""Prefix of the place of the findings of a rule for workspaces: its name follows. No path of a package begins with it."""


_UNKNOWN = ""
"""Name of an input that cannot be named. What has read it is never valid."""


class _KeptFinding(NamedTuple):
    rule: str
    package: str
    finding: Finding


class _KeptInput(NamedTuple):
    """A part of the workspace, or an answer that rules share, that was read."""

    name: str
    digest: bytes
    reads: bytes
    """For an answer the numbers of what it has read, otherwise nothing."""


class _KeptPlace(NamedTuple):
    """The findings of all rules for packages in one package, or those of one rule for the workspace."""

    place: str
    """Path of the package, or ``//`` and the name of the rule."""
    reads: bytes
    """Numbers of the inputs that were read, as an array of 32-bit integers."""
    found: tuple[_KeptFinding, ...]


class _Kept(NamedTuple):
    inputs: tuple[_KeptInput, ...]
    """What was read. The number of an input is its index."""
    places: tuple[_KeptPlace, ...]
    machine: Answers
    """The state of the files outside of the workspace that were read, such as those of an underlay."""
    rules: tuple[str, ...]
    """Names of the rules that ran."""


class KeptFindings:
    """Findings in a cache file.

    ``name`` is the name of the record; it depends on the options and on the code of ros-lint. ``machine`` has the files outside
    of the workspace. If one of them has changed since the last run, its findings are not used.
    """

    def __init__(self, file: CacheFile, name: str, machine: RecordedTree) -> None:
        self._file = file
        self._codec: Codec[_Kept] = Codec(_Kept)
        self._name = name
        self._machine = machine
        self._valid: dict[str, _KeptPlace] = {}
        kept = file.read(lambda found: found == name, self._codec).get(name)
        self._kept = kept if kept is not None and _is_consistent(kept) and machine.is_unchanged(kept.machine) else None
        self._current: _Current | None = None

    @property
    def places(self) -> frozenset[str]:
        """The places whose findings are valid: paths of packages, and ``//`` with the name of a rule for workspaces."""
        return frozenset(self._valid)

    def restore(self, handles: Handles, rules: Sequence[Rule]) -> None:
        """Give the findings whose inputs are the same in the newly loaded workspace to the engine, as results of their rules."""
        kept, workspace = self._kept, handles.workspace
        by_name = {rule.name: rule for rule in rules if rule.suppressions is None}
        if kept is None or kept.rules != tuple(sorted(by_name)):
            return
        self._current = _Current(handles)
        changed = self._current.changed(kept.inputs)
        self._valid = {place.place: place for place in kept.places if changed.isdisjoint(_numbers(place.reads))}
        found: dict[tuple[str, str], list[Issue]] = {(path, rule): [] for path in self._valid for rule in by_name}
        for place in self._valid.values():
            for name, owner, finding in place.found:
                found[place.place, name].append(Issue(by_name[name], owner, finding))
        packages = {package.path: package for package in workspace.packages}
        for at, rule, package in _places(by_name.values(), packages):
            if at in self._valid:
                results_of(rule, package, workspace, partial(Results, tuple(found[at, rule.name])))

    def store(self, recorder: Recorder, handles: Handles, rules: Sequence[Rule]) -> None:
        """Keep the findings of this run, without those of a place where a rule has crashed or has read an input without a name.

        Nothing is kept if a file outside of the workspace changed during the run.
        """
        workspace = handles.workspace
        checks = [rule for rule in rules if rule.suppressions is None]
        answers: dict[str, list[tuple[Cell, Results]]] = {}
        for place, rule, package in _places(checks, {package.path: package for package in workspace.packages}):
            question = question_of(rule, package.path if package is not None else None)
            answer = recorder.answered(workspace.memo, question) if place not in self._valid else None
            if answer is not None and isinstance(answer[1], Results):
                answers.setdefault(place, []).append((answer[0], answer[1]))
        known = self._kept.places if self._kept is not None else ()
        if not self._machine.steady or (not answers and len(self._valid) == len(known)):
            return
        current = self._current or _Current(handles)
        names = current.names(recorder)
        sets = ReadSets(names)
        places = [(place.place, self._names(place.reads), place.found) for place in self._valid.values()]
        places += _read_places(answers, names, sets)
        cells = {name: cell for cell, name in names.items() if name.startswith(PREFIX)}
        kept_reads = {kept.name: self._names(kept.reads) for kept in (self._kept.inputs if self._kept is not None else ())}

        def reads_of(name: str) -> list[str]:
            below = sets.of([cells[name]]) if name in cells else None
            return kept_reads.get(name, []) if below is None else [names.get(cell, _UNKNOWN) for cell in below]

        numbers: dict[str, int] = {}
        inputs: list[_KeptInput] = []
        for name, reads in _in_order([name for _, of_place, _ in places for name in of_place], reads_of):
            numbers[name] = len(inputs)
            inputs.append(_KeptInput(name, current.digest(name), _packed(map(numbers.__getitem__, reads))))
        found = [_KeptPlace(place, _packed(map(numbers.__getitem__, of_place)), issues) for place, of_place, issues in places]
        rule_names = tuple(sorted(rule.name for rule in checks))
        record = _Kept(tuple(inputs), tuple(found), self._machine.answers, rule_names)
        self._file.write({self._name: record}, self._codec, lambda names: [name for name in names if name.startswith(RECORD)])

    def _names(self, reads: bytes) -> list[str]:
        inputs = self._kept.inputs if self._kept is not None else ()
        return [inputs[number].name for number in _numbers(reads)]


class _Current:
    """The values in the loaded workspace of what can be read."""

    def __init__(self, handles: Handles) -> None:
        self._inputs = Inputs(handles)
        self._answers = SharedAnswers(handles)
        self._digests: dict[str, bytes] = {}

    def names(self, recorder: Recorder) -> dict[Cell, str]:
        return {**self._inputs.names(), **dict(self._answers.named(recorder))}

    def digest(self, name: str) -> bytes:
        """Return the digest of an input or of a shared answer; b"" if it does not exist."""
        if name not in self._digests:
            self._digests[name] = self._compute(name)
        return self._digests[name]

    def changed(self, inputs: Sequence[_KeptInput]) -> set[int]:
        """Return the numbers of the inputs with another value than in an earlier run.

        An answer is computed again only if something that it has read has another value.
        """
        result: set[int] = set()
        for number, (name, before, reads) in enumerate(inputs):
            below = _numbers(reads)
            if below and before and result.isdisjoint(below):
                self._digests[name] = before
            elif not before or self.digest(name) != before:
                result.add(number)
        return result

    def _compute(self, name: str) -> bytes:
        if name == _UNKNOWN:
            return b""
        if not name.startswith(PREFIX):
            return self._inputs.digest(name)
        try:
            return digest(self._answers.value(name))
        except LookupError:
            return b""


def _in_order(names: Iterable[str], reads_of: Callable[[str], list[str]]) -> Iterator[tuple[str, list[str]]]:
    """Yield each name, and each name that it has read directly or not, with what it has read.

    A name comes after what it has read.
    """
    reads: dict[str, list[str]] = {}
    finished: set[str] = set()
    waiting = list(names)
    while waiting:
        name = waiting[-1]
        if name not in reads:
            reads[name] = reads_of(name)
            waiting += [read for read in reads[name] if read not in finished]
            continue
        waiting.pop()
        if name not in finished:
            finished.add(name)
            yield name, reads[name]


def _places(rules: Iterable[Rule], packages: Mapping[str, Package]) -> Iterator[tuple[str, Rule, Package | None]]:
    """Yield each place of findings with the rule and the package; a rule for workspaces has a place of its own."""
    for rule in rules:
        if rule.package is not None:
            yield from ((path, rule, package) for path, package in packages.items())
        else:
            yield f"{_RULE}{rule.name}", rule, None


def _read_places(
    answers: Mapping[str, Sequence[tuple[Cell, Results]]], names: Mapping[Cell, str], sets: ReadSets
) -> Iterator[tuple[str, list[str], tuple[_KeptFinding, ...]]]:
    """Yield the places of the results that were computed in this run, with the names of what was read and the findings."""
    for place, of_place in answers.items():
        cells = sets.of(answer for answer, _ in of_place)
        if any(results.crashes for _, results in of_place) or not all(cell in names for cell in cells):
            continue
        issues = [issue for _, results in of_place for issue in results.issues]
        found = tuple([_KeptFinding(issue.rule.name, issue.package, issue.finding) for issue in issues])
        yield place, [names[cell] for cell in cells], found


def _is_consistent(kept: _Kept) -> bool:
    """Return whether all numbers and names in a record exist, and inputs come after what they have read.

    This may not be so in a manipulated file.
    """
    try:
        in_order = all(max(_numbers(entry.reads), default=-1) < number for number, entry in enumerate(kept.inputs))
        known = all(max(_numbers(place.reads), default=-1) < len(kept.inputs) for place in kept.places)
    except ValueError:  # not an array of 32-bit integers
        return False
    return in_order and known and {finding.rule for place in kept.places for finding in place.found} <= set(kept.rules)


def _packed(numbers: Iterable[int]) -> bytes:
    return array("I", numbers).tobytes()


def _numbers(reads: bytes) -> array[int]:
    numbers = array("I")
    numbers.frombytes(reads)
    return numbers
