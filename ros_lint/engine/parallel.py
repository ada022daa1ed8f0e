"""Run the rules in several processes, if a workspace has many packages.

The results become answers of the workspace (:mod:`ros_lint.base.questions`), where :mod:`ros_lint.engine.run` finds them.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.base.paths import is_below_any
from ros_lint.base.processes import available_cores, call_all, can_copy
from ros_lint.base.questions import Memo
from ros_lint.base.recorded_tree import RecordedTree
from ros_lint.engine.report import Issue
from ros_lint.engine.run import Results, results_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from ros_lint.analysis.finding import Finding
    from ros_lint.analysis.rule import Rule
    from ros_lint.base.recorded_tree import Queries
    from ros_lint.engine.report import Crash
    from ros_lint.workspace.model import Package, Workspace

_PACKAGES_PER_PROCESS = 30
"""Number of packages for each process: with fewer packages, starting the process costs more than it saves."""

_MAX_PROCESSES = 8
"""The largest number of processes if the user asks for no number."""

_PARTS_PER_PROCESS = 16
"""Number of parts of the packages for each process, so that all processes end at about the same time."""

_MOST_PARTS = 500
"""The largest number of parts of the packages."""


class _Part(NamedTuple):
    """Rules that one process runs: in some packages, or if ``packages`` is (None,), in the workspace."""

    workspace: Workspace
    rules: tuple[Rule, ...]
    packages: Sequence[Package | None]


class _Sent(NamedTuple):
    """The results of a rule without the rule, because functions cannot be sent to another process."""

    findings: tuple[tuple[str, Finding], ...]
    crashes: tuple[Crash, ...]

    def of(self, rule: Rule) -> Results:
        return Results(tuple([Issue(rule, package, finding) for package, finding in self.findings]), self.crashes)


def run_in_processes(workspaces: Sequence[Workspace], rules: Sequence[Rule], folders: Sequence[str], jobs: int) -> None:
    """Run rules in several processes, rules about packages only for the packages below ``folders``.

    ``jobs`` is the number of processes; 0 means that it depends on the number of packages. Rules whose data cannot be read have
    no results.
    """
    if not can_copy() or not all(isinstance(workspace.memo, Memo) for workspace in workspaces):
        return
    checked = [
        (workspace, [package for package in workspace.packages if is_below_any(package.path, folders) and not package.is_ros1])
        for workspace in workspaces
    ]
    packages = sum(len(chosen) for _, chosen in checked)
    wanted = min(jobs, packages) if jobs else min(_MAX_PROCESSES, packages // _PACKAGES_PER_PROCESS)
    processes = min(wanted, available_cores())
    if processes < 2:
        return
    size = -(-packages // min(_PARTS_PER_PROCESS * processes, _MOST_PARTS))
    parts = [part for workspace, chosen in checked for part in _parts(workspace, chosen, rules, size)]
    trees = dict.fromkeys([underlay.tree for workspace in workspaces for underlay in workspace.world.underlays])
    recorded = [tree for tree in trees if isinstance(tree, RecordedTree)]
    for tree in recorded:
        tree.new_queries()  # this process has all earlier ones

    def run_part(number: int) -> tuple[list[_Sent], list[Queries]]:
        return _run(parts[number]), [tree.new_queries() for tree in recorded]

    for number, (results, queries) in call_all(run_part, len(parts), processes).items():
        for (rule, package), sent in zip(_runs(parts[number]), results, strict=True):
            results_of(rule, package, parts[number].workspace, partial(sent.of, rule))
        for tree, asked in zip(recorded, queries, strict=True):
            tree.add(asked)


def _parts(workspace: Workspace, packages: Sequence[Package], rules: Sequence[Rule], size: int) -> Iterator[_Part]:
    """Yield each rule for workspaces, because they take longest, and all other rules for ``size`` packages at a time."""
    yield from (_Part(workspace, (rule,), (None,)) for rule in rules if rule.workspace)
    of_packages = tuple([rule for rule in rules if rule.package])
    yield from (_Part(workspace, of_packages, packages[at : at + size]) for at in range(0, len(packages), size))


def _runs(part: _Part) -> Iterator[tuple[Rule, Package | None]]:
    return ((rule, package) for package in part.packages for rule in part.rules)


def _run(part: _Part) -> list[_Sent]:
    results = [results_of(rule, package, part.workspace) for rule, package in _runs(part)]
    return [_Sent(tuple([(issue.package, issue.finding) for issue in found.issues]), found.crashes) for found in results]
