"""Run rules on a workspace, and apply suppression comments to the findings."""

from __future__ import annotations

from collections.abc import Callable, Container, Hashable, Iterable, Iterator, Sequence
from functools import partial
from typing import NamedTuple

from ros_lint.analysis.finding import Finding
from ros_lint.analysis.rule import Rule
from ros_lint.base.paths import is_below_any
from ros_lint.base.text import Span
from ros_lint.engine.merge import merge
from ros_lint.engine.report import Crash, Issue
from ros_lint.engine.suppressions import apply_suppressions
from ros_lint.facts.suppressions import Suppression
from ros_lint.knowledge.store import KnowledgeError
from ros_lint.workspace.model import Package, Workspace

EVERYWHERE = ("",)
"""The value of ``folders`` for a run that reports all findings."""


def run_rules(
    workspace: Workspace, rules: Iterable[Rule], folders: Sequence[str] = EVERYWHERE
) -> tuple[tuple[Issue, ...], tuple[Crash, ...]]:
    """Return all findings of the rules about packages and files below ``folders``, sorted by place, and the crashes.

    Packages of ROS 1 have no findings, because the rules are for ROS 2. If a rule crashes for one package, its findings in other
    packages and the findings of other rules are still returned.
    """
    places = tuple(folders)
    results = [
        workspace.memo.ask((rule.name, rule.package or rule.workspace, places), partial(_in_folders, rule, workspace, places))
        for rule in rules
    ]
    issues = {issue for of_rule in results for issue in of_rule.issues}
    return tuple(sorted(issues, key=sort_key)), tuple([crash for of_rule in results for crash in of_rule.crashes])


class Results(NamedTuple):
    """The findings of a rule. If the rule crashed in a package, only the findings there before the crash are known."""

    issues: tuple[Issue, ...]
    crashes: tuple[Crash, ...] = ()


class _Checked(NamedTuple):
    """The part of a workspace whose findings are reported."""

    packages: tuple[Package, ...]
    names: frozenset[str]
    """The names of the packages, and of folders with an unusable package.xml."""


def _in_folders(rule: Rule, workspace: Workspace, folders: tuple[str, ...]) -> Results:
    """Return the findings of a rule about packages and files below ``folders``."""
    checked = workspace.memo.ask(("checked", folders), partial(_find_checked, workspace, folders))
    if rule.package is None:
        found = results_of(rule, None, workspace)
        return found._replace(issues=tuple([issue for issue in found.issues if _is_about(issue, checked.names, folders)]))
    results = [results_of(rule, package, workspace) for package in checked.packages]
    return Results(
        tuple([issue for of_package in results for issue in of_package.issues]),
        tuple([crash for of_package in results for crash in of_package.crashes]),
    )


def _find_checked(workspace: Workspace, folders: tuple[str, ...]) -> _Checked:
    packages = [package for package in workspace.packages if is_below_any(package.path, folders) and not package.is_ros1]
    unusable = [package for package in workspace.unusable if is_below_any(package.path, folders)]
    return _Checked(tuple(packages), frozenset([package.name for package in (*packages, *unusable)]))


def results_of(
    rule: Rule, package: Package | None, workspace: Workspace, computed: Callable[[], Results] | None = None
) -> Results:
    """Return the results of a rule in ``package``; if ``package`` is None, those of a rule for whole workspaces.

    ``computed`` returns the results if another process has computed them.
    """
    question = question_of(rule, package.path if package else None)
    return workspace.memo.ask(question, computed or partial(_results, rule, package, workspace))


def question_of(rule: Rule, path: str | None) -> Hashable:
    """Return the question for the results of a rule in the package at ``path``; None is the whole workspace."""
    return (rule.name, rule.package, path) if path is not None else (rule.name, rule.workspace)


def _results(rule: Rule, package: Package | None, workspace: Workspace) -> Results:
    found: list[Issue] = []
    try:
        found.extend(_issues(rule, package, workspace))
    except KnowledgeError:
        raise  # no rule can run, and the user must act
    except Exception:
        import traceback  # noqa: PLC0415

        return Results(tuple(found), (Crash(rule.name, package.name if package else "", traceback.format_exc()),))
    return Results(tuple(found))


def _issues(rule: Rule, package: Package | None, workspace: Workspace) -> Iterator[Issue]:
    """Yield the findings of a rule in ``package``; if ``package`` is None, those of a rule for whole workspaces."""
    if rule.package is not None and package is not None:
        for finding in rule.package(package, workspace.seen_from(package)):
            yield Issue(rule, package.name, _with_place(finding))
    elif rule.workspace is not None:
        for finding in map(_with_place, rule.workspace(workspace)):
            yield Issue(rule, finding.package or owning_package(workspace, finding.span.path), finding)


def _with_place(finding: object) -> Finding:
    """Return the object that a rule has yielded if it is a finding with a place, else raise TypeError.

    This is checked because plugins need not be type-checked.
    """
    if not isinstance(finding, Finding):
        raise TypeError(f"a rule must yield Finding, not {type(finding).__name__}")
    if not isinstance(finding.span, Span):
        raise TypeError(f"the span of a Finding must be a Span, not {type(finding.span).__name__}")
    return finding


def _is_about(issue: Issue, names: Container[str], folders: Sequence[str]) -> bool:
    """Return whether an issue of a rule for workspaces is about one of the packages ``names``, or in a file below ``folders``."""
    finding = issue.finding
    return finding.package in names if finding.package else is_below_any(finding.span.path, folders)


class CheckedIssues(NamedTuple):
    """The issues of a workspace after suppression comments were applied."""

    issues: tuple[Issue, ...]
    """The issues that are not suppressed, sorted by place."""
    suppressed: tuple[Issue, ...]
    crashes: tuple[Crash, ...]


def find_issues(
    workspaces: Sequence[Workspace],
    rules: Sequence[Rule],
    suppressions: Iterable[Suppression],
    all_rules: Sequence[Rule],
    folders: Sequence[str] = EVERYWHERE,
) -> CheckedIssues:
    """Return the issues of ``rules`` about packages and files below ``folders``, with suppression comments applied.

    ``workspaces`` has the workspace once for each distribution of the run. Their issues are merged, so a suppression
    counts as unused only if it is unused in all of them. ``all_rules`` are the rules that suppression comments may name.
    """
    comments = tuple(suppressions)
    results = [run_rules(workspace, rules, folders) for workspace in workspaces]
    issues = merge([(workspace.target.distro, result[0]) for workspace, result in zip(workspaces, results, strict=True)])
    crashes = tuple(dict.fromkeys([crash for result in results for crash in result[1]]))
    ran = {rule.name for rule in rules} - {crash.rule for crash in crashes}
    outcome = apply_suppressions(sorted(issues, key=sort_key), comments, all_rules, ran)
    about_comments = [
        Issue(rule, _owning_package(workspaces, finding.span.path), finding)
        for rule in rules
        if rule.suppressions
        for finding in rule.suppressions(outcome.use)
        if is_below_any(finding.span.path, folders)
    ]
    about_outcome = apply_suppressions(about_comments, comments, all_rules, ran)  # a comment can suppress findings about itself
    kept = tuple(sorted((*outcome.kept, *about_outcome.kept), key=sort_key))
    return CheckedIssues(kept, tuple(issue for issue, _ in (*outcome.suppressed, *about_outcome.suppressed)), crashes)


def _owning_package(workspaces: Iterable[Workspace], path: str) -> str:
    return next(filter(None, (owning_package(workspace, path) for workspace in workspaces)), "")


def sort_key(issue: Issue) -> tuple[object, ...]:
    """Return the key by which issues are sorted: by place, then by rule."""
    finding = issue.finding
    return (finding.span, issue.rule.code, finding.message, finding.subject, issue.package)


def owning_package(workspace: Workspace, path: str) -> str:
    """Return the name of the package that contains a file, "" if there is none."""
    owner = workspace.owner(path)
    return owner.name if owner else ""
