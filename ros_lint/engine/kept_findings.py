"""The findings of rules from one run to the next, with a digest of each input that the rules have read.

In the next run a rule runs again in a package only if an input that it has read is different. Inputs are the parts of the
loaded workspace (:mod:`ros_lint.workspace.inputs`), so that an edit without an effect on a part has none on the findings.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.analysis.finding import Finding
from ros_lint.base.columns import Codec
from ros_lint.base.questions import ReadSets
from ros_lint.base.recorded_tree import Answers
from ros_lint.engine.kept_values import UNKNOWN, CurrentValues, KeptInput, packed, unpacked
from ros_lint.engine.report import Issue
from ros_lint.engine.run import Results, question_of, results_of
from ros_lint.engine.shared_answers import PREFIX

if TYPE_CHECKING:
    from ros_lint.analysis.rule import Rule
    from ros_lint.base.questions import Cell, Recorder
    from ros_lint.base.recorded_tree import RecordedTree
    from ros_lint.workspace.cache.file import CacheFile
    from ros_lint.workspace.handles import Handles
    from ros_lint.workspace.model import Package, Workspace

    _Computed = dict[str, list[tuple[Cell, Results]]]


RECORD = "findings-"
"""Prefix of the names of records with findings."""

_RULE = "//"
"""Prefix of the place of the findings of a rule for workspaces: its name follows. No path of a package begins with it."""


class _KeptFinding(NamedTuple):
    rule: str
    package: str
    finding: Finding


class _KeptPlace(NamedTuple):
    """The findings of all rules for packages in one package, or those of one rule for the workspace."""

    place: str
    """Path of the package, or ``//`` and the name of the rule."""
    reads: bytes
    """Numbers of the inputs that were read, as an array of 32-bit integers."""
    found: tuple[_KeptFinding, ...]


class _Kept(NamedTuple):
    inputs: tuple[KeptInput, ...]
    """What was read. The number of an input is its index."""
    places: tuple[_KeptPlace, ...]
    machine: Answers
    """The state of the files outside of the workspace that were read, such as those of an underlay."""
    rules: tuple[str, ...]
    """Names of the rules that ran."""


_NOTHING = _Kept((), (), Answers(), ())


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
        kept = file.read(lambda found: found == name, self._codec).get(name, _NOTHING)
        self._kept = kept if _is_consistent(kept) and machine.is_unchanged(kept.machine) else _NOTHING
        self._current: CurrentValues | None = None

    @property
    def places(self) -> frozenset[str]:
        """The places whose findings are valid: paths of packages, and ``//`` with the name of a rule for workspaces."""
        return frozenset(self._valid)

    def restore(self, handles: Handles, rules: Sequence[Rule]) -> None:
        """Give the findings whose inputs are the same in the newly loaded workspace to the engine, as results of their rules."""
        by_name = {rule.name: rule for rule in rules if rule.suppressions is None}
        if self._kept.rules != tuple(sorted(by_name)):
            return
        self._current = CurrentValues(handles)
        changed = self._current.changed(self._kept.inputs)
        self._valid = {place.place: place for place in self._kept.places if changed.isdisjoint(unpacked(place.reads))}
        found: dict[tuple[str, str], list[Issue]] = {(path, rule): [] for path in self._valid for rule in by_name}
        for place in self._valid.values():
            for name, owner, finding in place.found:
                found[place.place, name].append(Issue(by_name[name], owner, finding))
        for at, rule, package in _places(by_name.values(), handles.workspace.packages):
            if at in self._valid:
                results_of(rule, package, handles.workspace, partial(Results, tuple(found[at, rule.name])))

    def store(self, recorder: Recorder, handles: Handles, rules: Sequence[Rule]) -> None:
        """Keep the findings of this run, without those of a place where a rule has crashed or has read an input without a name.

        Nothing is kept if a file outside of the workspace changed during the run.
        """
        checks = [rule for rule in rules if rule.suppressions is None]
        computed = self._computed(recorder, handles.workspace, checks)
        if not self._machine.steady or (not computed and len(self._valid) == len(self._kept.places)):
            return
        current = self._current or CurrentValues(handles)
        names = current.names(recorder)
        sets = ReadSets(names)
        places = [_Place(place.place, self._names(place.reads), place.found) for place in self._valid.values()]
        places += _read_places(computed, names, sets)
        reads_of = self._reads_of(names, sets)
        numbers: dict[str, int] = {}
        inputs: list[KeptInput] = []
        for name, reads in _in_order([name for place in places for name in place.reads], reads_of):
            numbers[name] = len(inputs)
            inputs.append(KeptInput(name, current.digest(name), packed(map(numbers.__getitem__, reads))))
        record = _Kept(
            inputs=tuple(inputs),
            places=tuple([_KeptPlace(at, packed(map(numbers.__getitem__, reads)), found) for at, reads, found in places]),
            machine=self._machine.answers,
            rules=tuple(sorted(rule.name for rule in checks)),
        )
        self._file.write({self._name: record}, self._codec, lambda names: [name for name in names if name.startswith(RECORD)])

    def _computed(self, recorder: Recorder, workspace: Workspace, rules: Iterable[Rule]) -> _Computed:
        """Return the results that were computed in this run, by place, each with its answer."""
        computed: _Computed = {}
        for place, rule, package in _places(rules, workspace.packages):
            question = question_of(rule, package.path if package is not None else None)
            answer = recorder.answered(workspace.memo, question) if place not in self._valid else None
            if answer is not None and isinstance(answer[1], Results):
                computed.setdefault(place, []).append((answer[0], answer[1]))
        return computed

    def _names(self, reads: bytes) -> list[str]:
        return [self._kept.inputs[number].name for number in unpacked(reads)]

    def _reads_of(self, names: Mapping[Cell, str], sets: ReadSets) -> Callable[[str], list[str]]:
        """Return a function that returns what an answer has read, in this run or else in the last; [] for an input."""
        answers = {name: cell for cell, name in names.items() if name.startswith(PREFIX)}
        earlier = {kept.name: kept.reads for kept in self._kept.inputs}

        def reads_of(name: str) -> list[str]:
            if name in answers:
                return [names.get(cell, UNKNOWN) for cell in sets.of([answers[name]])]
            return self._names(earlier.get(name, b""))

        return reads_of


class _Place(NamedTuple):
    """The findings of a place, as in :class:`_KeptPlace`, with the names of what was read."""

    place: str
    reads: list[str]
    found: tuple[_KeptFinding, ...]


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


def _places(rules: Iterable[Rule], packages: Sequence[Package]) -> Iterator[tuple[str, Rule, Package | None]]:
    """Yield each place of findings with the rule and the package; a rule for workspaces has a place of its own."""
    for rule in rules:
        if rule.package is not None:
            yield from ((package.path, rule, package) for package in packages)
        else:
            yield f"{_RULE}{rule.name}", rule, None


def _read_places(computed: _Computed, names: Mapping[Cell, str], sets: ReadSets) -> Iterator[_Place]:
    """Yield the places of computed results, unless a rule has crashed there or has read an input without a name."""
    for place, results in computed.items():
        cells = sets.of(answer for answer, _ in results)
        if any(of_rule.crashes for _, of_rule in results) or not all(cell in names for cell in cells):
            continue
        issues = [issue for _, of_rule in results for issue in of_rule.issues]
        found = tuple([_KeptFinding(issue.rule.name, issue.package, issue.finding) for issue in issues])
        yield _Place(place, [names[cell] for cell in cells], found)


def _is_consistent(kept: _Kept) -> bool:
    """Return whether all numbers and names in a record exist, and inputs come after what they have read.

    This may not be so in a manipulated file.
    """
    try:
        in_order = all(max(unpacked(entry.reads), default=-1) < number for number, entry in enumerate(kept.inputs))
        known = all(max(unpacked(place.reads), default=-1) < len(kept.inputs) for place in kept.places)
    except ValueError:  # not an array of 32-bit integers
        return False
    return in_order and known and {finding.rule for place in kept.places for finding in place.found} <= set(kept.rules)
