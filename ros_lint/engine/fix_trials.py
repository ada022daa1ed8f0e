"""Try fixes in memory: load and check the workspace with the changed files, without writing them."""

from __future__ import annotations

from collections import Counter
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.analysis.finding import Confidence
from ros_lint.base.diff import line_before, unified_bytes
from ros_lint.base.paths import is_below_any, join
from ros_lint.base.text import Span, Text, read
from ros_lint.engine import edits
from ros_lint.engine.fixing import Regression
from ros_lint.engine.run import find_issues
from ros_lint.engine.selection import Selection, show
from ros_lint.workspace.writable import Writable

if TYPE_CHECKING:
    from collections.abc import Container, Iterable, Mapping, Sequence

    from ros_lint.analysis.rule import Rule
    from ros_lint.engine.report import Issue
    from ros_lint.workspace.loader import Loader

_MOST_TRIALS = 2
"""Number of trials to keep besides the first one, because the result of a successful trial is needed again immediately."""

DistroIdentity = tuple[str, str]
"""A distribution, and the identity (rule, package and subject) of an issue in it."""


class Trial(NamedTuple):
    """The issues of the workspace with changed files."""

    changed: Mapping[str, bytes]
    """The new contents of the changed files, by path."""
    distros: tuple[str, ...]
    """The distributions of the run."""
    issues: tuple[Issue, ...]

    def identity_counts(self) -> Counter[DistroIdentity]:
        """Return the number of issues for each pair of a distribution and an identity (rule, package and subject)."""
        return self._counts(self.issues)

    def serious_counts(self) -> Counter[DistroIdentity]:
        """Return the counts of :meth:`identity_counts` for the issues in :attr:`serious` only."""
        return self._counts(self.serious)

    def _counts(self, issues: Iterable[Issue]) -> Counter[DistroIdentity]:
        return Counter(identity for issue in issues for identity in self.identities(issue))

    @property
    def serious(self) -> list[Issue]:
        """The issues with high confidence of rules that are on by default."""
        return [issue for issue in self.issues if issue.rule.default and issue.finding.confidence is Confidence.HIGH]

    def identities(self, issue: Issue) -> list[DistroIdentity]:
        """Return pairs of a distribution and the identity of an issue: one pair for each distribution with the issue.

        The identity is the rule, the package and the subject of the issue.
        """
        return [(distro, issue.identity) for distro in issue.distros or self.distros]


class FixTrials:
    """Tries fixes on the workspace of a loader. It implements :class:`ros_lint.engine.fixing.Trials`.

    Only files below ``roots`` are changed. ``rules`` are all rules, including those that are not selected. If ``unsafe``
    is True, fixes that may change the behaviour of programs are tried as well. ``only`` are the names of the rules whose
    fixes are tried, None for all rules.
    """

    def __init__(
        self,
        loader: Loader,
        roots: Sequence[str],
        selection: Selection,
        rules: Sequence[Rule],
        *,
        unsafe: bool = False,
        only: Container[str] | None = None,
    ) -> None:
        self._loader = loader
        self._roots = roots
        self._selection = selection
        self._rules = rules
        self._run = tuple(rule for rule in rules if rule.default or rule in selection.rules)
        self._unsafe = unsafe
        self._only = only
        self._trials: list[Trial] = []
        self._files_to_edit: set[str] = set()
        """Paths of the files that fixes edit. The loader keeps their bytes as first read."""

    @cached_property
    def _writable(self) -> Writable:
        workspaces = self._loader.load_all()
        manifests = [package.manifest.path for space in workspaces for package in space.unusable if package.manifest]
        package_files = [join(package.path, file) for space in workspaces for package in space.packages for file in package.files]
        return Writable(self._loader.tree, self._roots, list(dict.fromkeys([*package_files, *manifests])))

    def trial(self, changed: Mapping[str, bytes]) -> Trial:
        """Return the issues of the workspace with the contents ``changed`` of files (by path)."""
        for trial in self._trials:
            if trial.changed == changed:
                return trial
        workspaces = self._loader.load_all(changed)
        issues = find_issues(workspaces, self._run, self._loader.suppressions(), self._rules).issues
        trial = Trial(changed, workspaces[0].target.distros, issues)
        self._trials = [*self._trials[:1], *self._trials[1:][1 - _MOST_TRIALS :], trial]
        return trial

    def patch(self, changed: Mapping[str, bytes]) -> bytes:
        """Return a unified diff from the files as read to the contents ``changed``."""
        return b"".join(unified_bytes(path, self._loader.pinned.get(path), data) for path, data in sorted(changed.items()))

    def fixable(self, changed: Mapping[str, bytes]) -> list[Issue]:
        """Return the issues to show whose fixes can be applied.

        These are the safe fixes, and the unsafe fixes if they are selected, that edit only files which may be changed.

        Spans of edits are valid only for one version of a file. Therefore the loader keeps the bytes of the files to
        edit, and the workspace is checked again with these bytes.
        """
        while True:
            issues = [issue for issue in self._fixable_issues(changed) if not self._refusal(issue)]
            new = {path for issue in issues for path in _edited_files(issue)} - self._files_to_edit
            if not new:
                return issues
            self._files_to_edit |= new
            self._loader.pin(new)
            self._trials.clear()

    def refused(self, changed: Mapping[str, bytes]) -> list[tuple[Issue, str]]:
        issues = self._fixable_issues(changed)
        return [(self.original(changed, issue), reason) for issue in issues if (reason := self._refusal(issue))]

    def applied(self, changed: Mapping[str, bytes], group: Iterable[Issue]) -> dict[str, bytes]:
        texts = edits.apply((issue.finding.fix for issue in group if issue.finding.fix), lambda path: self._text(changed, path))
        return {**changed, **edits.encode(texts, lambda path: self._text(changed, path))}

    def regressions(self, changed: Mapping[str, bytes], group: Sequence[Issue]) -> tuple[Regression, ...]:
        if not group:
            return ()
        try:
            new = self.applied(changed, group)
        except edits.EditError as error:
            return (Regression(str(error)),)
        before = self.trial(changed)
        after = self.trial(new)
        unresolved = _unresolved(before, after, group)
        new_findings = _new_findings(before, after, group)
        if new_findings and not unresolved and self._recovers_next_round(before, new, group, new_findings):
            return ()
        regressions = [
            Regression(f"it would cause a new finding: {issue.finding.message}", issue.package, issue.finding.subject)
            for issue in new_findings
        ]
        regressions += [
            Regression("it does not resolve the finding", issue.package, issue.finding.subject) for issue in unresolved
        ]
        return tuple(regressions)

    def original(self, changed: Mapping[str, bytes], issue: Issue) -> Issue:
        span = issue.finding.span
        if span.path not in changed:
            return issue
        before = edits.text_of(self._loader.tree, span.path).text
        after = self._text(changed, span.path).text
        line, end = (line_before(before, after, number) for number in (span.line, span.end_line))
        place = Span(span.path, line, span.column, max(line, end), span.end_column)
        return issue._replace(finding=issue.finding._replace(span=place))

    def _refusal(self, issue: Issue) -> str:
        """Return the reason why a file that the fix of an issue edits must not be changed, "" if all its files may be changed."""
        return next(filter(None, map(self._writable.refusal, _edited_files(issue))), "")

    def _fixable_issues(self, changed: Mapping[str, bytes]) -> list[Issue]:
        """Return the issues to show that have a safe fix, or an unsafe fix if unsafe fixes are selected."""
        issues = [issue for issue in self.trial(changed).issues if issue.rule in self._selection.rules]
        if self._only is not None:
            issues = [issue for issue in issues if issue.rule.name in self._only]
        issues = [issue for issue in issues if is_below_any(issue.finding.span.path, self._roots)]
        shown, _ = show(issues, self._selection)
        return [issue for issue in shown if issue.finding.fix and (issue.finding.fix.safe or self._unsafe)]

    def _recovers_next_round(
        self, before: Trial, changed: Mapping[str, bytes], group: Sequence[Issue], new_findings: Sequence[Issue]
    ) -> bool:
        """Return whether fixes of the next round resolve all new findings that the fixes of ``group`` cause."""
        names = {issue.identity for issue in new_findings}
        issues = [issue for issue in self.fixable(changed) if issue.identity in names]
        fixes = [issue.finding.fix for issue in issues if issue.finding.fix]
        if {issue.identity for issue in issues} != names or len(edits.choose(fixes)) < len(fixes):
            return False
        try:
            after = self.trial(self.applied(changed, issues))
        except edits.EditError:
            return False
        return not _new_findings(before, after, group) and not _unresolved(before, after, group)

    def _text(self, changed: Mapping[str, bytes], path: str) -> Text:
        if path in changed:
            return read(path, changed[path])
        return edits.text_of(self._loader.tree, path)


def _edited_files(issue: Issue) -> Iterable[str]:
    """Return the paths of the files that the fix of an issue edits."""
    fix = issue.finding.fix
    return dict.fromkeys(edit.span.path for edit in fix.edits) if fix else ()


def _new_findings(before: Trial, after: Trial, group: Sequence[Issue]) -> list[Issue]:
    """Return the findings that the fixes of ``group`` cause in any distribution.

    Only findings with high confidence, of rules that are on by default, count. A finding also counts if its confidence becomes
    high, because it was not shown before: any finding in a package with a safe fix, or one about the subject of a fix in any
    package.
    """
    earlier, count = before.identity_counts(), after.identity_counts()
    earlier_serious, serious = before.serious_counts(), after.serious_counts()
    packages = {issue.package for issue in group if issue.finding.fix and issue.finding.fix.safe}
    subjects = {issue.finding.subject for issue in group}

    def is_new(issue: Issue, name: DistroIdentity) -> bool:
        if count[name] > earlier[name]:
            return True
        is_near = issue.package in packages or issue.finding.subject in subjects
        return is_near and serious[name] > earlier_serious[name]

    return [issue for issue in after.serious if any(is_new(issue, name) for name in after.identities(issue))]


def _unresolved(before: Trial, after: Trial, group: Sequence[Issue]) -> list[Issue]:
    """Return the issues of ``group`` that still exist after their fixes in at least one of their distributions."""
    earlier, count = before.identity_counts(), after.identity_counts()
    return [issue for issue in group if any(count[name] >= earlier[name] for name in after.identities(issue))]
