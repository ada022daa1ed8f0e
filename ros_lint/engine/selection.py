"""Select the rules to run and the findings to show."""

from __future__ import annotations

import fnmatch
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from ros_lint.analysis.finding import Confidence, Severity
from ros_lint.analysis.rule import Rule
from ros_lint.engine.explanations import without_explained
from ros_lint.engine.registry import matching, unknown_rule_message
from ros_lint.engine.report import EXPLAINED, MINOR, UNSURE, HiddenCount, Issue
from ros_lint.errors import UserError


class SelectionError(UserError):
    """A selector in the settings or on the command line matches no rule."""


class Selection(NamedTuple):
    """The rules to run, and the settings that decide which findings are shown."""

    rules: tuple[Rule, ...]
    named: frozenset[str]
    """Names of the rules that were selected by name or code. Their findings are shown whatever their confidence is."""
    severities: Mapping[str, Severity]
    """The severities that the settings assign, by the name of the rule."""
    pedantic: bool
    """True if findings of low and medium confidence are shown, too."""
    ignores: tuple[tuple[str, frozenset[str]], ...]
    """Pairs of a path pattern and the names of rules whose findings are ignored in matching files."""
    off: tuple[Rule, ...] = ()
    """Rules that are off by default and that the settings do not mention."""
    min_severity: Severity = Severity.INFO
    """The lowest severity of findings to show."""

    def severity(self, issue: Issue) -> Severity:
        """Return the severity of an issue: that in the settings, else that of the issue itself."""
        return self.severities.get(issue.rule.name, issue.severity)

    def is_severe(self, issue: Issue) -> bool:
        """Return whether the severity of an issue is high enough for the issue to be shown."""
        return self.severity(issue) >= self.min_severity

    def ignores_path(self, issue: Issue) -> bool:
        """Return whether the findings of the issue's rule are ignored in the issue's file."""
        name, path = issue.rule.name, issue.finding.span.path
        return any(name in names and matches(path, pattern) for pattern, names in self.ignores)


def check_selectors(rules: Sequence[Rule], selectors: Iterable[str]) -> None:
    """Raise SelectionError if one of ``selectors`` matches none of ``rules``."""
    for selector in selectors:
        _matching(rules, selector)


def select(
    rules: Sequence[Rule],
    *,
    chosen: Sequence[str] = ("default",),
    added: Sequence[str] = (),
    ignored: Sequence[str] = (),
    severities: Mapping[str, str] | None = None,
    per_path: Mapping[str, Sequence[str]] | None = None,
    pedantic: bool = False,
    min_severity: str = "info",
) -> Selection:
    """Return the selection that the settings make among ``rules``. Raises SelectionError for a selector that matches no rule.

    A rule to which the settings assign a severity is selected; a rule with the severity "off" is not.
    """
    selected: set[str] = set()
    selected_by_name: set[str] = set()
    for selector in (*(("all",) if pedantic else chosen), *added):
        names = [rule.name for rule in _matching(rules, selector)]
        selected.update(names)
        if selector not in ("all", "default"):
            selected_by_name.update(names)
    levels: dict[str, Severity] = {}
    declined: set[str] = set()
    for selector, word in (severities or {}).items():
        for rule in _matching(rules, selector):
            if word == "off":
                selected.discard(rule.name)
                declined.add(rule.name)
            else:
                selected.add(rule.name)
                levels[rule.name] = Severity[word.upper()]
    for selector in ignored:
        for rule in _matching(rules, selector):
            selected.discard(rule.name)
            declined.add(rule.name)
    ignores = tuple(
        (pattern, frozenset(rule.name for selector in selectors for rule in _matching(rules, selector)))
        for pattern, selectors in (per_path or {}).items()
    )
    ordered = tuple(rule for rule in rules if rule.name in selected)
    unmentioned = [rule for rule in rules if not rule.default and rule.name not in selected and rule.name not in declined]
    off = tuple(unmentioned) if "default" in chosen else ()
    return Selection(ordered, frozenset(selected_by_name), levels, pedantic, ignores, off, Severity[min_severity.upper()])


def show(issues: Iterable[Issue], selection: Selection) -> tuple[tuple[Issue, ...], tuple[HiddenCount, ...]]:
    """Return the issues to show, with the severities of the settings, and the numbers of hidden issues by reason.

    Issues that are consequences of another shown issue are hidden.
    """
    shown: list[Issue] = []
    unsure: list[Issue] = []
    ignored = minor = 0
    for issue in issues:
        sure = issue.finding.confidence is Confidence.HIGH or selection.pedantic or issue.rule.name in selection.named
        if selection.ignores_path(issue):
            ignored += 1
        elif not selection.is_severe(issue):
            minor += sure
        elif not sure:
            unsure.append(issue)
        elif (severity := selection.severity(issue)) is issue.severity:
            shown.append(issue)
        else:
            shown.append(issue._replace(finding=issue.finding._replace(severity=severity)))
    causes = without_explained(shown, selection.severities)
    hidden = [
        HiddenCount.of(UNSURE, unsure),
        HiddenCount("ignored by per-path-ignores", ignored),
        HiddenCount(MINOR, minor),
        HiddenCount(EXPLAINED, len(shown) - len(causes)),
    ]
    return causes, tuple(entry for entry in hidden if entry.count)


def matches(path: str, pattern: str) -> bool:
    """Return whether a pattern matches a path.

    A pattern without a slash matches the file name, or the name of any folder above it.
    """
    pattern = pattern.rstrip("/")
    if "/" in pattern:
        return fnmatch.fnmatchcase(path, pattern) or fnmatch.fnmatchcase(path, f"{pattern}/*")
    return any(fnmatch.fnmatchcase(part, pattern) for part in path.split("/"))


def _matching(rules: Sequence[Rule], selector: str) -> tuple[Rule, ...]:
    if matching_rules := matching(rules, selector):
        return matching_rules
    raise SelectionError(unknown_rule_message(rules, selector))
