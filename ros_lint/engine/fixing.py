"""``--fix`` and ``--diff``: make the edits of fixes, each proven on the model before it is kept (docs/architecture.md, fixes).

A fix is kept when the workspace with it, loaded and checked anew, no longer has its finding and has no finding that was
not there before, unless fixes that are made along with it take that away again: what a launch file needs is told once the
file is installed. So none that closes a cycle, names an unknown key or makes a manifest unusable is ever written.
"""

from __future__ import annotations

import gc
import sys
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from typing import NamedTuple

from ros_lint.analysis.finding import Confidence
from ros_lint.base.diff import line_before, unified_bytes
from ros_lint.base.paths import join
from ros_lint.base.text import Span, Text, read
from ros_lint.cli.session import Session
from ros_lint.engine import edits, registry
from ros_lint.engine import run as engine
from ros_lint.engine.check import check
from ros_lint.engine.report import Issue, Report
from ros_lint.engine.selection import Selection, show
from ros_lint.workspace.model import Workspace
from ros_lint.workspace.writable import Writable

_MOST_ROUNDS = 100
"""Fixes make way for others, and of those that are at odds one is made a round. No workspace needs as many."""


class Mended(NamedTuple):
    """What came of mending."""

    changed: Mapping[str, bytes]
    """New content by path."""
    made: tuple[Issue, ...]
    withheld: tuple[tuple[Issue, str], ...]
    """Issues whose fix was not made, at their place in the files as they are, and why."""


def run(opened: Session, selection: Selection) -> tuple[Report, int]:
    """Show or make the fixes. Returns the report of what is left, and 2 when files could not be written."""
    gc.enable()  # the workspace is loaded again and again, and what is left of the last time has to go
    proof = _Proof(opened, selection)
    mended = _mended(proof)
    for issue, reason in mended.withheld:
        print(f"ros-lint: {issue.finding.span}: fix skipped: {reason} [{issue.rule.name}]", file=sys.stderr)
    if opened.settings["diff"]:
        sys.stdout.buffer.write(diff(opened, mended.changed))
        sys.stdout.buffer.flush()
        return check(opened, proof.trial({}).workspace, selection), 0
    try:
        edits.write_all(opened.base, mended.changed, opened.loader.held)
        print(f"ros-lint: {_told(len(mended.made), len(mended.changed))}", file=sys.stderr)
    except edits.EditError as error:
        print(f"ros-lint: {error}", file=sys.stderr)
        written = {path: mended.changed[path] for path in error.written}
        return check(opened, proof.trial(written).workspace, selection), 2
    return check(opened, proof.trial(mended.changed).workspace, selection), 0


def _told(count: int, files: int) -> str:
    if not count:
        return "nothing to fix"
    return f"fixed {count} finding{'s' * (count != 1)} in {files} file{'s' * (files != 1)}"


def mend(opened: Session, selection: Selection) -> Mended:
    """Return every fix of the selected rules that can be proven, nothing written."""
    return _mended(_Proof(opened, selection))


def _mended(proof: _Proof) -> Mended:
    changed: Mapping[str, bytes] = {}
    made: list[Issue] = []
    for _ in range(_MOST_ROUNDS):
        done = _Round(proof, changed)
        done.run()
        changed = done.changed
        made += done.made
        if not done.made:
            break  # else what was made may be what others waited for
    return Mended(changed, tuple(made), (*done.withheld.values(), *proof.refused(changed)))


class _Round:
    """Makes what can be made, in groups as large as possible, each on top of those before."""

    def __init__(self, proof: _Proof, changed: Mapping[str, bytes]) -> None:
        self._proof = proof
        self._parts: list[frozenset[str]] = []
        self.changed = changed
        self.made: list[Issue] = []
        self.withheld: dict[str, tuple[Issue, str]] = {}

    def run(self) -> None:
        self._later(self._proof.fixable(self.changed))
        while self._parts:
            self._try(self._parts.pop())

    def _try(self, part: frozenset[str]) -> None:
        """Make some of the fixes, and leave the rest for later in smaller parts.

        Most groups are large, and few of their fixes to blame for a complaint. So those stand back that it is about. If all
        is well without them, one that has a complaint of its own needs no trial; what cannot be told apart is halved.
        """
        wanted = [issue for issue in self._proof.fixable(self.changed) if issue.identity in part]  # where they are by now
        fixes = edits.choose(issue.finding.fix for issue in wanted if issue.finding.fix)
        group = [issue for issue in wanted if issue.finding.fix in fixes]
        self._later(issue for issue in wanted if issue not in group)
        complaints = self._proof.complaints(self.changed, group)
        blamed = _blamed(group, complaints)
        others = [issue for issue in group if issue not in blamed]
        names = list(dict.fromkeys(issue.identity for issue in group))
        if not complaints:
            self._make(group)
        elif blamed and others and self._proof.complaints(self.changed, others):
            self._later(blamed)
            self._later(others)
        elif blamed and (others or all(blamed.values())):
            self._withhold({issue: reason for issue, reason in blamed.items() if reason})
            self._make(others)
            self._later(issue for issue, reason in blamed.items() if not reason)
        elif len(names) == 1:
            self._withhold(dict.fromkeys(group, complaints[0].reason))
        else:
            first = frozenset(names[: len(names) // 2])
            self._parts += [frozenset(names) - first, first]

    def _later(self, issues: Iterable[Issue]) -> None:
        if names := frozenset(issue.identity for issue in issues):
            self._parts.append(names)

    def _make(self, group: Sequence[Issue]) -> None:
        self.changed = self._proof.applied(self.changed, group)
        self.made += group

    def _withhold(self, reasons: Mapping[Issue, str]) -> None:
        for issue, reason in reasons.items():
            self.withheld[issue.identity] = (self._proof.as_it_is(self.changed, issue), reason)


def diff(opened: Session, changed: Mapping[str, bytes]) -> bytes:
    """Return the changes as one patch."""
    return b"".join(unified_bytes(path, opened.loader.held.get(path), data) for path, data in sorted(changed.items()))


class _Trial(NamedTuple):
    """A workspace with changes, and what the rules say of it."""

    changed: Mapping[str, bytes]
    workspace: Workspace
    issues: tuple[Issue, ...]


class _Complaint(NamedTuple):
    """Something that is wrong with fixes: in which package, and with which dependency, file or executable."""

    reason: str
    package: str | None = None
    subject: str | None = None

    def suspects(self, group: Sequence[Issue]) -> list[Issue]:
        """Return the issues whose fixes come into question first: what is missing has been removed, or is to be added twice."""
        here = [issue for issue in group if issue.package == self.package]
        same = [issue for issue in group if issue.finding.subject == self.subject]
        both = [issue for issue in here if issue in same]
        return both or [issue for issue in here if _only_removes(issue)] or same or here


def _only_removes(issue: Issue) -> bool:
    fix = issue.finding.fix
    return fix is not None and not any(edit.text.strip() for edit in fix.edits)


def _blamed(group: Sequence[Issue], complaints: Iterable[_Complaint]) -> Mapping[Issue, str]:
    """Return the issues that complaints are about, with the reason where one of them is about no other issue, else ""."""
    found: dict[Issue, str] = {}
    for complaint in complaints:
        suspects = complaint.suspects(group)
        for issue in suspects:
            reason = complaint.reason if len(suspects) == 1 else ""
            found[issue] = found.get(issue, "") or reason
    return found


def _edited(issue: Issue) -> Iterable[str]:
    """Return the files that the fix of an issue edits."""
    fix = issue.finding.fix
    return dict.fromkeys(edit.span.path for edit in fix.edits) if fix else ()


_MOST_TRIALS = 2
"""That are remembered beside the workspace as it is: what passed is asked for again at once, what failed is not."""


def _worse(had: Counter[str], after: Sequence[Issue]) -> list[Issue]:
    """Return the findings that were not there before.

    What is less than certain, or asked for only, may change: a need that was undeclared can become a transitive one.
    """
    has = Counter(issue.identity for issue in after)
    serious = [issue for issue in after if issue.rule.default and issue.finding.confidence is Confidence.HIGH]
    return [issue for issue in serious if has[issue.identity] > had[issue.identity]]


def _idle(had: Counter[str], after: Sequence[Issue], group: Sequence[Issue]) -> list[Issue]:
    """Return those of a group whose fixes do not help."""
    has = Counter(issue.identity for issue in after)
    return [issue for issue in group if has[issue.identity] >= had[issue.identity]]


class _Proof:
    """Loads and checks a workspace with changes, and says what is wrong with them."""

    def __init__(self, opened: Session, selection: Selection) -> None:
        self._opened = opened
        self._selection = selection
        self._every = registry.load(opened.settings["plugins"])
        self._rules = tuple(rule for rule in self._every if rule.default or rule in selection.rules)
        self._trials: list[_Trial] = []
        self._met: set[str] = set()
        """Files that fixes would edit: their bytes are held from then on, if they are there."""

    @cached_property
    def _writable(self) -> Writable:
        workspace = self.trial({}).workspace
        manifests = [package.manifest.path for package in workspace.unusable if package.manifest]
        own = [join(package.path, file) for package in workspace.packages for file in package.files]
        return Writable(self._opened.loader.tree, self._opened.roots, [*own, *manifests])

    def trial(self, changed: Mapping[str, bytes]) -> _Trial:
        for trial in self._trials:
            if trial.changed == changed:
                return trial
        loader = self._opened.loader
        workspace = loader.load(changed)
        issues = engine.check(workspace, self._rules, loader.suppressions(changed), self._every).issues
        trial = _Trial(changed, workspace, issues)
        self._trials = [*self._trials[:1], *self._trials[1:][1 - _MOST_TRIALS :], trial]
        return trial

    def fixable(self, changed: Mapping[str, bytes]) -> list[Issue]:
        """Return the issues that are shown and carry a fix of the wanted kind, which may be written.

        Places of edits are true of one state of a file only. So the files that are to be edited are held, and looked at anew.
        """
        while True:
            issues = [issue for issue in self._with_fix(changed) if not self._refusal(issue)]
            new = {path for issue in issues for path in _edited(issue)} - self._met
            if not new:
                return issues
            self._met |= new
            self._opened.loader.hold(new)
            self._trials.clear()

    def refused(self, changed: Mapping[str, bytes]) -> list[tuple[Issue, str]]:
        """Return the issues whose fixes must not be written, and why."""
        issues = self._with_fix(changed)
        return [(self.as_it_is(changed, issue), reason) for issue in issues if (reason := self._refusal(issue))]

    def _refusal(self, issue: Issue) -> str:
        return next(filter(None, map(self._writable.refusal, _edited(issue))), "")

    def _with_fix(self, changed: Mapping[str, bytes]) -> list[Issue]:
        issues = [issue for issue in self.trial(changed).issues if issue.rule in self._selection.rules]
        shown, _ = show(issues, self._selection)
        unsafe = self._opened.settings["unsafe-fixes"]
        return [issue for issue in shown if issue.finding.fix and (issue.finding.fix.safe or unsafe)]

    def applied(self, changed: Mapping[str, bytes], group: Iterable[Issue]) -> dict[str, bytes]:
        texts = edits.apply((issue.finding.fix for issue in group if issue.finding.fix), lambda path: self._text(changed, path))
        return {**changed, **edits.encode(texts, lambda path: self._text(changed, path))}

    def complaints(self, changed: Mapping[str, bytes], group: Sequence[Issue]) -> tuple[_Complaint, ...]:
        """Return what is wrong with the fixes of a group, nothing if they can be made."""
        if not group:
            return ()
        try:
            new = self.applied(changed, group)
        except edits.EditError as error:
            return (_Complaint(str(error)),)
        had = Counter(issue.identity for issue in self.trial(changed).issues)
        after = self.trial(new).issues
        idle = _idle(had, after, group)
        worse = _worse(had, after)
        if worse and not idle and self._goes_on(had, new, group, worse):
            return ()
        found = [
            _Complaint(f"it would cause a new finding: {issue.finding.message}", issue.package, issue.finding.subject)
            for issue in worse
        ]
        found += [_Complaint("it does not resolve the finding", issue.package, issue.finding.subject) for issue in idle]
        return tuple(found)

    def _goes_on(self, had: Counter[str], changed: Mapping[str, bytes], group: Sequence[Issue], worse: Sequence[Issue]) -> bool:
        """Whether all that the fixes of a group bring to light can be mended in the next round, and all is well then."""
        names = {issue.identity for issue in worse}
        wanted = [issue for issue in self.fixable(changed) if issue.identity in names]
        fixes = [issue.finding.fix for issue in wanted if issue.finding.fix]
        if {issue.identity for issue in wanted} != names or len(edits.choose(fixes)) < len(fixes):
            return False
        try:
            after = self.trial(self.applied(changed, wanted)).issues
        except edits.EditError:
            return False
        return not _worse(had, after) and not _idle(had, after, group)

    def as_it_is(self, changed: Mapping[str, bytes], issue: Issue) -> Issue:
        """Return an issue of a workspace with changes at its place in the files as they are."""
        span = issue.finding.span
        if span.path not in changed:
            return issue
        before = edits.text_of(self._opened.loader.tree, span.path).text
        after = self._text(changed, span.path).text
        line, end = (line_before(before, after, number) for number in (span.line, span.end_line))
        place = Span(span.path, line, span.column, max(line, end), span.end_column)
        return issue._replace(finding=issue.finding._replace(span=place))

    def _text(self, changed: Mapping[str, bytes], path: str) -> Text:
        if path in changed:
            return read(path, changed[path])
        return edits.text_of(self._opened.loader.tree, path)
