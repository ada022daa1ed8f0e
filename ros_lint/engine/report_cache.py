"""Cache of the last reports of a workspace, in the user's cache folder."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from ros_lint.workspace import cache_files
from ros_lint.workspace.fact_cache import SOURCES, digest, files_below, state_of

if TYPE_CHECKING:
    from ros_lint.base.tree import RecordedTree
    from ros_lint.engine.report import Report


_MOST_REPORTS = 8
"""Number of reports cached for a workspace, which may be checked with several sets of options."""


class ReportCache:
    """The last reports of a workspace, as files in ``folder``; nothing is cached if ``folder`` is "".

    A report depends on ``options`` (as text), the state of the files in ``data``, the code of ros-lint and the trees,
    and on nothing else. ``base`` is the folder of the workspace.
    """

    def __init__(self, folder: str, base: str, options: str, data: Iterable[str]) -> None:
        self._start = f"{digest(os.path.realpath(base))}-" if folder else ""
        self._folder = folder
        self._file = os.path.join(folder, f"{self._start}{digest(options)}.report") if folder else ""
        source_files = files_below(SOURCES)
        self._state = state_of([*source_files, *data]) if folder else ""

    def __bool__(self) -> bool:
        """Return whether reports are cached at all."""
        return bool(self._file)

    def fetch(self, trees: Sequence[RecordedTree]) -> Report | None:
        """Return the cached report if the trees still give the answers that it depends on, else None."""
        from ros_lint.engine.report import Report  # noqa: PLC0415  (the command has imported it)

        cached = cache_files.load(self._file, self._state) if self._file else None
        if not isinstance(cached, tuple) or len(cached) != 1 + len(trees) or not isinstance(cached[0], Report):
            return None
        report, *answers = cached
        try:
            return report if all(tree.is_unchanged(recorded) for tree, recorded in zip(trees, answers, strict=True)) else None
        except (TypeError, ValueError):  # not a list of queries, paths and answers
            return None

    def store(self, trees: Sequence[RecordedTree], report: Report) -> None:
        """Store a report with the answers of the trees that it depends on.

        The functions of its rules are left out. A report is not stored if a rule crashed or a file changed meanwhile.
        """
        if not self._file or report.crashes or not all(tree.steady for tree in trees):
            return
        bare_rules = {rule.name: rule._replace(package=None, workspace=None, suppressions=None) for rule in report.rules}
        issues = tuple([issue._replace(rule=bare_rules[issue.rule.name]) for issue in report.issues])
        bare_report = report._replace(issues=issues, rules=tuple(bare_rules.values()))
        answers = ([(query, _as_tuples(answer)) for query, answer in tree.answers.items()] for tree in trees)
        if cache_files.save(self._file, self._state, (bare_report, *answers)):
            self._clear()

    def _clear(self) -> None:
        """Remove the oldest reports of the workspace, except for the last ones."""
        try:
            with os.scandir(self._folder) as entries:
                reports = [(entry.stat().st_mtime_ns, entry.path) for entry in entries if entry.name.startswith(self._start)]
            for _, path in sorted(reports)[:-_MOST_REPORTS]:
                os.unlink(path)
        except OSError:
            return


def _as_tuples(answer: Any) -> Any:
    """Return stamps and directory entries as plain tuples, which are equal to them and load faster."""
    if isinstance(answer, list):
        return [tuple(entry) for entry in answer]
    return tuple(answer) if isinstance(answer, tuple) else answer
