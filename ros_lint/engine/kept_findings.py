"""The findings of rules from one run to the next, with a digest of each input that the rules have read.

In the next run a rule runs again in a package only if an input that it has read is different. Inputs are the parts of the
loaded workspace (:mod:`ros_lint.workspace.inputs`), so that an edit without an effect on a part has none on the findings.
"""

from __future__ import annotations

from array import array
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import partial
from itertools import chain
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.analysis.finding import Finding
from ros_lint.base.columns import Codec
from ros_lint.base.recorded_tree import Answers
from ros_lint.engine.report import Issue
from ros_lint.engine.run import Results, question_of, results_of
from ros_lint.workspace.inputs import DIGEST_SIZE, Inputs

if TYPE_CHECKING:
    from ros_lint.analysis.rule import Rule
    from ros_lint.base.questions import Cell, Recorder
    from ros_lint.base.recorded_tree import RecordedTree
    from ros_lint.workspace.cache.file import CacheFile
    from ros_lint.workspace.handles import Handles
    from ros_lint.workspace.model import Package


PREFIX = "findings-"
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
    inputs: tuple[str, ...]
    """Names of inputs. The number of an input is its index."""
    digests: bytes
    """The digests of the inputs."""
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
        self._inputs: Inputs | None = None

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
        inputs = self._inputs = Inputs(handles)
        changed = {
            number
            for number, name in enumerate(kept.inputs)
            if inputs.digest(name) != kept.digests[number * DIGEST_SIZE : (number + 1) * DIGEST_SIZE]
        }
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
        inputs = self._inputs or Inputs(handles)
        listed: dict[str, int] = {}
        places = [*self._renumbered(listed), *_read_places(answers, inputs.names(), recorder, listed)]
        digests = b"".join(map(inputs.digest, listed))
        rule_names = tuple(sorted(rule.name for rule in checks))
        kept = _Kept(tuple(listed), digests, tuple(places), self._machine.answers, rule_names)
        self._file.write({self._name: kept}, self._codec, lambda names: [name for name in names if name.startswith(PREFIX)])

    def _renumbered(self, listed: dict[str, int]) -> Iterator[_KeptPlace]:
        """Yield the valid places with the numbers of ``listed``, to which their inputs are added."""
        names = self._kept.inputs if self._kept is not None else ()
        used = frozenset(chain.from_iterable(_numbers(place.reads) for place in self._valid.values()))
        numbers = [listed.setdefault(name, len(listed)) if number in used else 0 for number, name in enumerate(names)]
        for place in self._valid.values():
            yield place._replace(reads=_packed(map(numbers.__getitem__, _numbers(place.reads))))


def _places(rules: Iterable[Rule], packages: Mapping[str, Package]) -> Iterator[tuple[str, Rule, Package | None]]:
    """Yield each place of findings with the rule and the package; a rule for workspaces has a place of its own."""
    for rule in rules:
        if rule.package is not None:
            yield from ((path, rule, package) for path, package in packages.items())
        else:
            yield f"{_RULE}{rule.name}", rule, None


def _read_places(
    answers: Mapping[str, Sequence[tuple[Cell, Results]]], names: Mapping[Cell, str], recorder: Recorder, listed: dict[str, int]
) -> Iterator[_KeptPlace]:
    """Yield the places of the results that were computed in this run. The names of their inputs are added to ``listed``."""
    numbers: dict[Cell, int] = {}
    known: dict[Cell, int] = {}
    for path, of_place in answers.items():
        cells = _members(recorder.inputs_of([answer for answer, _ in of_place], numbers, known), numbers)
        if any(results.crashes for _, results in of_place) or not all(cell in names for cell in cells):
            continue
        reads = [listed.setdefault(names[cell], len(listed)) for cell in cells]
        issues = [issue for _, results in of_place for issue in results.issues]
        found = tuple([_KeptFinding(issue.rule.name, issue.package, issue.finding) for issue in issues])
        yield _KeptPlace(path, _packed(reads), found)


def _is_consistent(kept: _Kept) -> bool:
    """Return whether all numbers and names in a record exist. They may not if the file was manipulated."""
    try:
        reads = {number for place in kept.places for number in _numbers(place.reads)}
    except ValueError:  # not an array of 32-bit integers
        return False
    found = {finding.rule for place in kept.places for finding in place.found}
    sizes = len(kept.digests) == len(kept.inputs) * DIGEST_SIZE and max(reads, default=-1) < len(kept.inputs)
    return sizes and found <= set(kept.rules)


def _packed(numbers: Iterable[int]) -> bytes:
    return array("I", numbers).tobytes()


def _numbers(reads: bytes) -> array[int]:
    numbers = array("I")
    numbers.frombytes(reads)
    return numbers


def _members(bits: int, numbers: Mapping[Cell, int]) -> list[Cell]:
    digits = bin(bits)[:1:-1]
    return [cell for cell, number in numbers.items() if number < len(digits) and digits[number] == "1"]
