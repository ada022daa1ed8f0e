"""Run rules over a workspace, and decide what is shown."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from ros_lint.analysis.rule import Rule
from ros_lint.engine import suppressions as suppress
from ros_lint.engine.report import Crash, Issue
from ros_lint.facts.suppressions import Suppression
from ros_lint.knowledge.store import KnowledgeError
from ros_lint.workspace.model import Package, Workspace


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
        for finding in rule.suppressions(outcome.use)
    ]
    spared = suppress.apply(about_comments, heard, known, ran)  # a comment can speak for itself
    kept = tuple(sorted((*outcome.kept, *spared.kept), key=order))
    return Checked(kept, tuple(issue for issue, _ in (*outcome.suppressed, *spared.suppressed)), crashes)


def order(issue: Issue) -> tuple[object, ...]:
    """Return the sort key of issues: by place, then by rule."""
    finding = issue.finding
    return (finding.span, issue.rule.code, finding.message, finding.subject, issue.package)


def owner(workspace: Workspace, path: str) -> str:
    """Return the name of the package that a file lies in, or ""."""
    inside = [
        package
        for package in (*workspace.packages, *workspace.unusable)
        if not package.path or path == package.path or path.startswith(f"{package.path}/")
    ]
    return max(inside, key=lambda package: len(package.path)).name if inside else ""
