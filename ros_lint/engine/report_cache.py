"""A cache of the last reports of a workspace, which are reused if nothing has changed."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.base.columns import Codec
from ros_lint.base.recorded_tree import Answers
from ros_lint.engine.report import Report
from ros_lint.workspace.cache.file import SOURCES, digest, files_below, state_of

if TYPE_CHECKING:
    from ros_lint.base.recorded_tree import RecordedTree
    from ros_lint.engine.kept_findings import KeptFindings
    from ros_lint.workspace.cache.file import CacheFile

_MOST_REPORTS = 8
"""Maximum number of cached reports of a workspace, because it may be checked with different options in turn."""


class _CachedReport(NamedTuple):
    """A report, and the state of the files and folders on which it depends, as recorded by each file tree of the run."""

    report: Report
    answers: tuple[Answers, ...]


class ReportCache:
    """The last reports of a workspace, stored in its cache file.

    A report depends only on ``options`` (as text), the state of the files in ``data``, the code of ros-lint and the file
    trees.
    """

    def __init__(self, file: CacheFile, options: str, data: Iterable[str]) -> None:
        self._file = file
        self.outdated = False
        """True if :meth:`fetch` has found a report of files that have changed since."""
        if file:
            self._codec: Codec[_CachedReport] = Codec(_CachedReport)
            self._prefix = f"report-{state_of([*files_below(SOURCES), *data], self._codec.schema)}-"
            self._name = self._prefix + digest(options)

    def __bool__(self) -> bool:
        """Return True if the cache is in use, False if it is switched off."""
        return bool(self._file)

    def fetch(self, trees: Sequence[RecordedTree]) -> Report | None:
        """Return the cached report if no file or folder on which it depends has changed since it was stored, else None."""
        cached = self._file.read(lambda name: name == self._name, self._codec).get(self._name) if self._file else None
        if cached is None or len(cached.answers) != len(trees):
            return None
        self.outdated = True
        pairs = list(zip(trees, cached.answers, strict=True))
        try:
            if not all(tree.is_unchanged(answers) for tree, answers in pairs):
                return None
        except ValueError:  # lists of a crafted file have different lengths
            return None
        renewed = [tree.renewed(answers) for tree, answers in pairs]
        if any(renewed):
            answers = tuple([new or old for new, old in zip(renewed, cached.answers, strict=True)])
            self._write(cached._replace(answers=answers))
        return cached.report

    def findings(self, machine: RecordedTree) -> KeptFindings:
        """Return the findings of rules that were kept in an earlier run with the same options.

        ``machine`` has the files outside of the workspace.
        """
        from ros_lint.engine.kept_findings import RECORD, KeptFindings  # noqa: PLC0415  (not needed for a cached report)

        return KeptFindings(self._file, f"{RECORD}{self._name}", machine)

    def store(self, trees: Sequence[RecordedTree], report: Report) -> None:
        """Store a report with the state of the files that were read from ``trees`` in this run.

        The functions of the rules in the report are not stored. Nothing is stored if a rule crashed or a file changed
        during the run.
        """
        if not self._file or report.crashes or not all(tree.steady for tree in trees):
            return
        bare_rules = {rule.name: rule._replace(package=None, workspace=None, suppressions=None) for rule in report.rules}
        issues = tuple([issue._replace(rule=bare_rules[issue.rule.name]) for issue in report.issues])
        bare_report = report._replace(issues=issues, rules=tuple(bare_rules.values()))
        self._write(_CachedReport(bare_report, tuple([tree.answers for tree in trees])))

    def _write(self, cached: _CachedReport) -> None:
        self._file.write({self._name: cached}, self._codec, self._obsolete)

    def _obsolete(self, names: Sequence[str]) -> list[str]:
        """Return the cached reports to delete, by name: those of other ros-lint versions, and the oldest of this version."""
        reports = [name for name in names if name.startswith("report-") and name != self._name]
        current = [name for name in reports if name.startswith(self._prefix)]
        return [name for name in reports if name not in current[1 - _MOST_REPORTS :]]
