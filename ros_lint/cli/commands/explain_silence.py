"""``ros-lint why A B --explain-silence``: explain why the dependency rules report nothing about the dependency of A on B."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from ros_lint.analysis.dependencies.explain import RULES, explain
from ros_lint.analysis.finding import Confidence
from ros_lint.engine import registry
from ros_lint.engine.explanations import without_explained
from ros_lint.engine.report import Issue
from ros_lint.workspace.model import Package, Workspace


def run(workspace: Workspace, name: str, dependency: str) -> tuple[str, str, int]:
    """Return standard output, standard error and the exit code: 2 if the workspace has no package ``name``, else 0.

    The output explains why the rules report nothing about ``dependency``, a package or rosdep key, in the package ``name``.
    """
    packages = workspace.called(name)
    if not packages:
        return "", f"ros-lint: the workspace has no package '{name}'\n", 2
    lines: list[str] = []
    for package in packages:
        seen = workspace.seen_from(package)
        issues = _issues(package, seen)
        lines += explain(package, seen, dependency, _reported(issues, dependency))
        lines += _causes(issues, dependency)
    return "".join(f"{line}\n" for line in lines), "", 0


def _issues(package: Package, workspace: Workspace) -> list[Issue]:
    """Return the findings of the rules in ``RULES``, which this command explains, in a package."""
    rules = [rule for rule in registry.load() if rule.name in RULES and rule.package is not None]
    return [Issue(rule, package.name, finding) for rule in rules if rule.package for finding in rule.package(package, workspace)]


def _reported(issues: Iterable[Issue], name: str) -> Mapping[str, Confidence]:
    """Return the names of the rules that report the dependency ``name``, each with the highest confidence of its findings."""
    result: dict[str, Confidence] = {}
    for issue in issues:
        if issue.finding.subject == name:
            result[issue.rule.name] = max(issue.finding.confidence, result.get(issue.rule.name, Confidence.LOW))
    return result


def _causes(issues: Sequence[Issue], name: str) -> Iterator[str]:
    """Yield a line for each finding about the dependency ``name`` that is hidden as a consequence of another finding."""
    for issue in without_explained(issues):
        for explained in issue.explained:
            if explained.subject == name:
                yield f"{explained.rule}: not shown, because the finding about '{issue.finding.subject}' explains it"
