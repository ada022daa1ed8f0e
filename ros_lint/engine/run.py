"""Run rules over a workspace, and decide what is shown."""

from __future__ import annotations

import fnmatch
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from ros_lint.analysis.rule import Confidence, Rule, Severity
from ros_lint.engine import suppressions as suppress
from ros_lint.engine.registry import matching, no_rule
from ros_lint.engine.report import UNSURE, Crash, Hidden, Issue, RefusalError
from ros_lint.engine.suppressions import Suppression
from ros_lint.knowledge.store import KnowledgeError
from ros_lint.workspace.model import Package, Workspace


class SelectionError(RefusalError):
    """A rule that is asked for and does not exist."""


class Selection(NamedTuple):
    """Which rules run, and what of their findings is shown."""

    rules: tuple[Rule, ...]
    named: frozenset[str]
    """Rules asked for by name: all their findings are shown, however sure."""
    severities: Mapping[str, Severity]
    pedantic: bool
    ignores: tuple[tuple[str, frozenset[str]], ...]
    """Path patterns, each with the names of rules ignored for files that match."""


def select(
    rules: Sequence[Rule],
    *,
    chosen: Sequence[str] = ("default",),
    added: Sequence[str] = (),
    ignored: Sequence[str] = (),
    severities: Mapping[str, str] | None = None,
    per_path: Mapping[str, Sequence[str]] | None = None,
    pedantic: bool = False,
) -> Selection:
    """Return what to run. Raises SelectionError for a name that means no rule.

    A rule whose severity is set in the settings is on, one that is set to off is not.
    """
    on: dict[str, Rule] = {}
    named: set[str] = set()
    for selector in (*(("all",) if pedantic else chosen), *added):
        found = _matching(rules, selector)
        on.update((rule.name, rule) for rule in found)
        if selector not in ("all", "default"):
            named.update(rule.name for rule in found)
    levels: dict[str, Severity] = {}
    for selector, word in (severities or {}).items():
        for rule in _matching(rules, selector):
            if word == "off":
                on.pop(rule.name, None)
            else:
                on[rule.name] = rule
                levels[rule.name] = Severity[word.upper()]
    for selector in ignored:
        for rule in _matching(rules, selector):
            on.pop(rule.name, None)
    ignores = tuple(
        (pattern, frozenset(rule.name for selector in selectors for rule in _matching(rules, selector)))
        for pattern, selectors in (per_path or {}).items()
    )
    ordered = tuple(rule for rule in rules if rule.name in on)
    return Selection(ordered, frozenset(named), levels, pedantic, ignores)


def run(workspace: Workspace, rules: Iterable[Rule]) -> tuple[tuple[Issue, ...], tuple[Crash, ...]]:
    """Return every finding of the rules, sorted by place. A rule that crashes for a package hides nothing else."""
    issues: set[Issue] = set()
    crashes: list[Crash] = []
    for rule in rules:
        for package in workspace.packages if rule.package else (None,):
            try:
                issues.update(_issues(rule, package, workspace))
            except KnowledgeError:
                raise  # no rule can do its job, and the user must act
            except Exception:
                import traceback  # noqa: PLC0415

                crashes.append(Crash(rule.name, package.name if package else "", traceback.format_exc()))
    return tuple(sorted(issues, key=order)), tuple(crashes)


def _issues(rule: Rule, package: Package | None, workspace: Workspace) -> Iterator[Issue]:
    """Yield what a rule finds: in a package, or in the workspace, for rules that look at it as a whole."""
    if rule.package is not None and package is not None:
        for finding in rule.package(package, workspace):
            yield Issue(rule, package.name, finding)
    elif rule.workspace is not None:
        for finding in rule.workspace(workspace):
            yield Issue(rule, finding.package or owner(workspace, finding.span.path), finding)


class Checked(NamedTuple):
    """What rules and comments made of a workspace."""

    issues: tuple[Issue, ...]
    """Sorted by place, suppressed ones left out."""
    suppressed: tuple[Issue, ...]
    crashes: tuple[Crash, ...]


def check(workspace: Workspace, rules: Sequence[Rule], suppressions: Iterable[Suppression], known: Sequence[Rule]) -> Checked:
    """Return what the rules say once comments have been heard. ``known`` are all the rules that a comment can name."""
    heard = tuple(suppressions)
    issues, crashes = run(workspace, rules)
    ran = {rule.name for rule in rules} - {crash.rule for crash in crashes}
    outcome = suppress.apply(issues, heard, known, ran)
    about_comments = [
        Issue(rule, owner(workspace, finding.span.path), finding)
        for rule in rules
        if rule.suppressions
        for finding in rule.suppressions(outcome)
    ]
    spared = suppress.apply(about_comments, heard, known, ran)  # a comment can speak for itself
    kept = tuple(sorted((*outcome.kept, *spared.kept), key=order))
    return Checked(kept, tuple(issue for issue, _ in (*outcome.suppressed, *spared.suppressed)), crashes)


def order(issue: Issue) -> tuple[object, ...]:
    """Return the sort key of issues: by place, then by rule."""
    finding = issue.finding
    return (finding.span, issue.rule.code, finding.message, finding.subject, issue.package)


def show(issues: Iterable[Issue], selection: Selection) -> tuple[tuple[Issue, ...], tuple[Hidden, ...]]:
    """Return what is shown, with the severities of the settings, and how much is hidden and why."""
    shown: list[Issue] = []
    unsure = ignored = 0
    for issue in issues:
        name = issue.rule.name
        sure = issue.finding.confidence is Confidence.HIGH
        if any(name in names and matches(issue.finding.span.path, pattern) for pattern, names in selection.ignores):
            ignored += 1
        elif not (sure or selection.pedantic or name in selection.named):
            unsure += 1
        elif name in selection.severities:
            shown.append(issue._replace(finding=issue.finding._replace(severity=selection.severities[name])))
        else:
            shown.append(issue)
    hidden = [Hidden(UNSURE, unsure), Hidden("ignored by per-path-ignores", ignored)]
    return tuple(shown), tuple(entry for entry in hidden if entry.count)


def matches(path: str, pattern: str) -> bool:
    """Whether a pattern of the settings means a path: one of its folders, the file, or the whole path."""
    pattern = pattern.rstrip("/")
    if "/" in pattern:
        return fnmatch.fnmatchcase(path, pattern) or fnmatch.fnmatchcase(path, f"{pattern}/*")
    return any(fnmatch.fnmatchcase(part, pattern) for part in path.split("/"))


def owner(workspace: Workspace, path: str) -> str:
    """Return the name of the package that a file lies in, or ""."""
    inside = [
        package
        for package in (*workspace.packages, *workspace.unusable)
        if not package.path or path == package.path or path.startswith(f"{package.path}/")
    ]
    return max(inside, key=lambda package: len(package.path)).name if inside else ""


def _matching(rules: Sequence[Rule], selector: str) -> tuple[Rule, ...]:
    if found := matching(rules, selector):
        return found
    raise SelectionError(no_rule(rules, selector))
