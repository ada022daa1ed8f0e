"""The azure format: a logging command of Azure Pipelines for each finding.

Azure shows them on the page of the run and in the log.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros_lint.analysis.finding import Severity
from ros_lint.reporters.ansi import Style, safe
from ros_lint.reporters.summary import problems, summary

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ros_lint.base.text import Span
    from ros_lint.engine.report import Issue, Report
    from ros_lint.reporters import SourceTexts

_TYPES = {Severity.ERROR: "error", Severity.WARNING: "warning"}
"""Type of issue in Azure Pipelines by severity. There is none for infos, which are printed as plain lines of the log."""


def render(report: Report, texts: SourceTexts, style: Style) -> str:  # noqa: ARG001  (the signature of reporters)
    """Return a logging command for each error and warning, the most severe first, a line for each info, and the summary."""
    ranked = sorted(report.issues, key=lambda issue: -issue.severity)
    lines = [*_problems(report), *(_line(issue) for issue in ranked)]
    return "".join(f"{line}\n" for line in lines) + summary(report, style._replace(color=False))


def command(properties: dict[str, str | int], message: str) -> str:
    """Return a command ``task.logissue``, escaped as the agent expects (azure-pipelines-task-lib, taskcommand.ts)."""
    pairs = "".join(f"{key}={_property(str(value))};" for key, value in properties.items())
    return f"##vso[task.logissue {pairs}]{_data(message)}"


def _data(text: str) -> str:
    return text.replace("%", "%AZP25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data(text).replace("]", "%5D").replace(";", "%3B")


def _line(issue: Issue) -> str:
    finding = issue.finding
    message = safe(f"{finding.message} [{issue.rule.name}]", Style())
    if issue.severity not in _TYPES:
        return _without_command(f"{safe(str(finding.span), Style())}: info: {message}")
    return command({"type": _TYPES[issue.severity], **_place(finding.span), "code": issue.rule.code}, message)


def _without_command(line: str) -> str:
    """Return a line of the log with ``## vso[`` in place of ``##vso[``, so that the agent does not run it as a command."""
    return line.replace("##vso[", "## vso[")


def _place(span: Span) -> dict[str, str | int]:
    return {"sourcepath": safe(span.path, Style()), "linenumber": span.line, "columnnumber": span.column}


def _problems(report: Report) -> Iterator[str]:
    """Yield a command for each problem that makes the run incomplete, such as a crash of a rule."""
    for problem in problems(report):
        severe = problem.severity is Severity.ERROR
        place = _place(problem.span) if problem.span else {}
        message = f"ros-lint: {problem.message}" if severe else problem.message
        yield command({"type": "error" if severe else "warning", **place}, safe(message, Style()))
