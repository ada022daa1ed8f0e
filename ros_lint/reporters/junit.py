"""The junit format, for test reports. It is read by ``colcon test-result``, GitLab, Jenkins and Azure Pipelines.

A test case stands for a group of rules (ROS1xx, ROS2xx ...) in one package. It fails if the group has an error or a
warning in the package. Infos do not fail it; they are listed in its output. As in the files of ament, the root is a
single ``testsuite``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros_lint.analysis.finding import Severity
from ros_lint.reporters.summary import count, problems
from ros_lint.reporters.xml_text import start, text

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ros_lint.analysis.rule import Rule
    from ros_lint.engine.report import Issue, Report
    from ros_lint.reporters import SourceTexts
    from ros_lint.reporters.ansi import Style

_GROUP_DIGITS = 2
"""Number of final digits of a rule's code that do not matter for the group of the rule."""


def render(report: Report, texts: SourceTexts, style: Style) -> str:  # noqa: ARG001  (the signature of reporters)
    """Return a test suite with a test case for each package and group of rules, and one for each error of the run."""
    issues: dict[tuple[str, str], list[Issue]] = {}
    groups = sorted({_group(rule) for rule in report.rules})
    for package in report.package_names:
        issues.update({(package, group): [] for group in groups})
    for issue in report.issues:
        issues.setdefault((issue.package, _group(issue.rule)), []).append(issue)
    cases = [_case(package, group, members) for (package, group), members in issues.items()]
    failures = sum(any(map(_fails, members)) for members in issues.values())
    severe = [problem for problem in problems(report) if problem.severity is Severity.ERROR]
    cases += [
        f"{start('testcase', classname='ros_lint', name=f'run {number}', time='0')}\n"
        f"{start('error', message=problem.message, type='error')}</error>\n</testcase>\n"
        for number, problem in enumerate(severe, 1)
    ]
    unread = [problem.message for problem in problems(report) if problem.severity is not Severity.ERROR]
    output = f"<system-out>{text(chr(10).join(unread))}</system-out>\n" if unread else ""
    suite = start("testsuite", name="ros_lint", tests=len(cases), failures=failures, errors=len(severe), skipped=0, time="0")
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{suite}\n{"".join(cases)}{output}</testsuite>\n'


def _group(rule: Rule) -> str:
    return f"{rule.code[:-_GROUP_DIGITS]}{'x' * _GROUP_DIGITS}"


def _fails(issue: Issue) -> bool:
    return issue.severity is not Severity.INFO


def _case(package: str, group: str, issues: Sequence[Issue]) -> str:
    opening = start("testcase", classname=f"{package or 'outside_packages'}.ros_lint", name=group, time="0")
    failing = [issue for issue in issues if _fails(issue)]
    infos = [issue for issue in issues if not _fails(issue)]
    parts: list[str] = []
    if failing:
        message = _line(failing[0]) if len(failing) == 1 else count(len(failing), "finding")
        parts.append(f"{start('failure', message=message, type=str(failing[0].severity))}{_lines(failing)}</failure>\n")
    if infos:
        parts.append(f"<system-out>{_lines(infos)}</system-out>\n")
    return f"{opening}\n{''.join(parts)}</testcase>\n" if parts else f"{opening}</testcase>\n"


def _lines(issues: Sequence[Issue]) -> str:
    return "\n".join(text(_line(issue).replace("\n", " ")) for issue in issues)


def _line(issue: Issue) -> str:
    return f"{issue.finding.span}: {issue.severity}: {issue.finding.message} [{issue.rule.name}]"
