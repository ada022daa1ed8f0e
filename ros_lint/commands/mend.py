"""``--fix`` and ``--diff``: make the edits of fixes, each proven on the model before it is kept (docs/architecture.md, fixes).

A fix is kept when the workspace with it, loaded and checked anew, no longer has its finding and has no finding that was
not there before: so none that closes a cycle, names an unknown key or makes a manifest unusable is ever written.
"""

from __future__ import annotations

import gc
import sys
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from ros_lint import edits, engine, registry
from ros_lint.commands import check
from ros_lint.opening import Opened
from ros_lint.report import Issue, Report
from ros_lint.rule import Confidence
from ros_lint.text import Text, read

_MOST_ROUNDS = 100
"""Fixes make way for others, and of those that are at odds one is made a round. No workspace needs as many."""


class Mended(NamedTuple):
    """What came of mending."""

    changed: Mapping[str, bytes]
    """New content by path."""
    made: tuple[Issue, ...]
    withheld: tuple[tuple[Issue, str], ...]
    """Issues whose fix was not made, and why."""


def run(opened: Opened, selection: engine.Selection) -> tuple[Report, int]:
    """Show or make the fixes. Returns the report of what is left, and 2 when files could not be written."""
    gc.enable()  # the workspace is loaded again and again, and what is left of the last time has to go
    mended = mend(opened, selection)
    for issue, reason in mended.withheld:
        print(f"ros-lint: {issue.finding.span}: not mended, {reason} [{issue.rule.name}]", file=sys.stderr)
    if opened.settings["diff"]:
        sys.stdout.write(diff(opened, mended.changed))
        sys.stdout.flush()
        return check.check(opened, opened.loader.load(), selection), 0
    code = 0
    try:
        edits.write_all(opened.base, mended.changed)
        print(f"ros-lint: {_told(len(mended.made), len(mended.changed))}", file=sys.stderr)
    except edits.EditError as error:
        print(f"ros-lint: {error}", file=sys.stderr)
        return check.check(opened, opened.loader.load(), selection), 2
    return check.check(opened, opened.loader.load(mended.changed), selection), code


def _told(count: int, files: int) -> str:
    if not count:
        return "nothing to mend"
    return f"mended {count} finding{'s' * (count != 1)} in {files} file{'s' * (files != 1)}"


def mend(opened: Opened, selection: engine.Selection) -> Mended:
    """Return every fix of the selected rules that can be proven, nothing written."""
    proof = _Proof(opened, selection)
    changed: dict[str, bytes] = {}
    made: list[Issue] = []
    withheld: dict[str, tuple[Issue, str]] = {}
    helped = False
    for _ in range(_MOST_ROUNDS):
        before = proof.issues(changed)
        wanted = [issue for issue in proof.fixable(before) if issue.identity not in withheld]
        chosen = edits.choose(issue.finding.fix for issue in wanted if issue.finding.fix)
        group = [issue for issue in wanted if issue.finding.fix in chosen]
        if group and (alone := proof.culprits(changed, before, group)) is not None:
            withheld.update((issue.identity, (issue, reason)) for issue, reason in alone.items())
            group = [issue for issue in group if issue not in alone]
            while len(group) > 1 and proof.complaint(changed, before, group):
                group = group[: len(group) // 2]  # fixes that are at odds with each other; the rest has its turn next
        if not group:
            if not (withheld and helped):
                break
            withheld, helped = {}, False  # what was made since may be what they waited for
            continue
        changed = proof.applied(changed, group)
        made += group
        helped = True
    return Mended(changed, tuple(made), tuple(withheld.values()))


def diff(opened: Opened, changed: Mapping[str, bytes]) -> str:
    """Return the changes as one patch."""
    from ros_lint.patch import unified  # noqa: PLC0415

    parts = []
    for path, data in sorted(changed.items()):
        before = opened.loader.text(path)
        parts.append(unified(path, before.text if before else None, read(path, data).text))
    return "".join(parts)


class _Proof:
    """Loads and checks a workspace with changes, and says what is wrong with them."""

    def __init__(self, opened: Opened, selection: engine.Selection) -> None:
        self._opened = opened
        self._selection = selection
        self._every = registry.load(opened.settings["plugins"])
        self._rules = tuple(rule for rule in self._every if rule.default or rule in selection.rules)

    def issues(self, changed: Mapping[str, bytes]) -> tuple[Issue, ...]:
        loader = self._opened.loader
        workspace = loader.load(changed)
        return engine.check(workspace, self._rules, loader.suppressions(changed), self._every).issues

    def fixable(self, issues: Sequence[Issue]) -> list[Issue]:
        """Return the issues that are shown and carry a fix of the wanted kind."""
        shown, _ = engine.show([issue for issue in issues if issue.rule in self._selection.rules], self._selection)
        unsafe = self._opened.settings["unsafe-fixes"]
        return [issue for issue in shown if issue.finding.fix and (issue.finding.fix.safe or unsafe)]

    def applied(self, changed: Mapping[str, bytes], group: Sequence[Issue]) -> dict[str, bytes]:
        texts = edits.apply((issue.finding.fix for issue in group if issue.finding.fix), lambda path: self._text(changed, path))
        return {**changed, **edits.encode(texts, lambda path: self._text(changed, path))}

    def complaint(self, changed: Mapping[str, bytes], before: Sequence[Issue], group: Sequence[Issue]) -> str:
        """Return what is wrong with the fixes of a group, or ""."""
        try:
            new = self.applied(changed, group)
        except edits.EditError as error:
            return str(error)
        had = Counter(issue.identity for issue in before)
        after = self.issues(new)
        has = Counter(issue.identity for issue in after)
        for issue in after:
            # What is less than certain, or asked for only, may change: a need that was undeclared can become a transitive one.
            serious = issue.rule.default and issue.finding.confidence is Confidence.HIGH
            if serious and has[issue.identity] > had[issue.identity]:
                return f"because then {issue.finding.message}"
        if any(has[issue.identity] >= had[issue.identity] for issue in group):
            return "because the fix does not help"
        return ""

    def culprits(
        self, changed: Mapping[str, bytes], before: Sequence[Issue], group: Sequence[Issue]
    ) -> dict[Issue, str] | None:
        """Return the issues whose fixes are to blame for a complaint, each with its own; None when there is none.

        Halves are tried before single fixes: most groups are large, and few of their fixes to blame.
        """
        complaint = self.complaint(changed, before, group)
        if not complaint:
            return None
        if len(group) == 1:
            return {group[0]: complaint}
        middle = len(group) // 2
        halves = (self.culprits(changed, before, group[:middle]), self.culprits(changed, before, group[middle:]))
        return {issue: reason for half in halves if half for issue, reason in half.items()}

    def _text(self, changed: Mapping[str, bytes], path: str) -> Text:
        if path in changed:
            return read(path, changed[path])
        return edits.text_of(self._opened.loader.tree, path)
