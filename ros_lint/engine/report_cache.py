"""Cache of the last reports of a workspace, in the user's cache folder."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from ros_lint.workspace import cache_files as kept_files
from ros_lint.workspace.fact_cache import SOURCES, digest, files_below, state_of

if TYPE_CHECKING:
    from ros_lint.base.tree import RecordedTree
    from ros_lint.engine.report import Report


_MOST_REPORTS = 8
"""Number of reports kept for a workspace, which may be checked with several sets of options."""


class ReportCache:
    """The last reports of a workspace.

    A report depends on ``asked`` (the options), the state of the files in ``data``, our code and the trees, on nothing
    else.
    """

    def __init__(self, folder: str, base: str, options: str, data: Iterable[str]) -> None:
        self._start = f"{digest(os.path.realpath(base))}-" if folder else ""
        self._folder = folder
        self._file = os.path.join(folder, f"{self._start}{digest(options)}.report") if folder else ""
        own = files_below(SOURCES)
        self._state = state_of([*own, *data]) if folder else ""

    def __bool__(self) -> bool:
        """Return whether reports are cached at all."""
        return bool(self._file)

    def fetch(self, trees: Sequence[RecordedTree]) -> Report | None:
        """Return the report that a run would produce, or None if only a run can determine it."""
        from ros_lint.engine.report import Report  # noqa: PLC0415  (the command has imported it)

        kept = kept_files.load(self._file, self._state) if self._file else None
        if not isinstance(kept, tuple) or len(kept) != 1 + len(trees) or not isinstance(kept[0], Report):
            return None
        report, *answers = kept
        try:
            return report if all(tree.is_unchanged(recorded) for tree, recorded in zip(trees, answers, strict=True)) else None
        except (TypeError, ValueError):  # not a list of queries, paths and answers
            return None

    def store(self, trees: Sequence[RecordedTree], report: Report) -> None:
        """Store a report, without the functions of its rules, with the tree answers that it depends on."""
        if not self._file or report.crashes or not all(tree.steady for tree in trees):
            return
        bare = {rule.name: rule._replace(package=None, workspace=None, suppressions=None) for rule in report.rules}
        issues = tuple([issue._replace(rule=bare[issue.rule.name]) for issue in report.issues])
        answers = ([(query, _bare(answer)) for query, answer in tree.answers.items()] for tree in trees)
        if kept_files.save(self._file, self._state, (report._replace(issues=issues, rules=tuple(bare.values())), *answers)):
            self._clear()

    def _clear(self) -> None:
        """Remove the oldest reports of the workspace."""
        try:
            with os.scandir(self._folder) as entries:
                reports = [(entry.stat().st_mtime_ns, entry.path) for entry in entries if entry.name.startswith(self._start)]
            for _, path in sorted(reports)[:-_MOST_REPORTS]:
                os.unlink(path)
        except OSError:
            return


def _bare(answer: Any) -> Any:
    """Return stamps and directory entries as plain tuples, which are equal to them and load faster."""
    if isinstance(answer, list):
        return [tuple(entry) for entry in answer]
    return tuple(answer) if isinstance(answer, tuple) else answer
