"""The gitlab format: a Code Quality report for merge requests (docs.gitlab.com)."""

from __future__ import annotations

import hashlib
from collections import Counter
from typing import TYPE_CHECKING, Any

from ros_lint.analysis.finding import Severity
from ros_lint.base.json_text import encode
from ros_lint.reporters.summary import crashed, told

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ros_lint.engine.report import Report
    from ros_lint.reporters import Texts
    from ros_lint.reporters.ansi import Style

_LEVELS = {Severity.ERROR: "critical", Severity.WARNING: "major", Severity.INFO: "info"}


def render(report: Report, texts: Texts, style: Style) -> str:  # noqa: ARG001  (the signature of reporters)
    """Return an entry for each finding, and for each problem that made the run incomplete."""
    return encode([*_findings(report), *_problems(report)], 1)


def _findings(report: Report) -> Iterator[dict[str, Any]]:
    # GitLab merges entries with the same fingerprint, so repeated ones of a file are numbered.
    seen: Counter[str] = Counter()
    for issue in report.issues:
        finding = issue.finding
        same = f"{issue.identity}/{finding.span.path}"
        seen[same] += 1
        name = f"{issue.rule.name} ({issue.rule.code})"
        yield _entry(f"{same}/{seen[same]}", name, finding.message, _LEVELS[issue.severity], finding.span.path, finding.span.line)


def _problems(report: Report) -> Iterator[dict[str, Any]]:
    folder = report.workspace or _NOWHERE
    if not report.packages:
        yield _entry("no package", "ros-lint", "no package found, so nothing was checked", "blocker", folder, 1)
    for crash in report.crashes:
        yield _entry(f"{crash.rule}/{crash.package}", "ros-lint", f"a rule failed: {crashed(crash)}", "blocker", folder, 1)
    for entry in report.not_checked:
        path, line = (entry.span.path, entry.span.line) if entry.span else (folder, 1)
        yield _entry(f"not checked/{path}/{entry.what}", "ros-lint", told(entry), "info", path, line)


_NOWHERE = "package.xml"
"""The file of entries without a place, because GitLab requires one."""


def _entry(same: str, name: str, description: str, severity: str, path: str, line: int) -> dict[str, Any]:
    return {
        "description": description,
        "check_name": name,
        "fingerprint": hashlib.sha256(same.encode("utf-8", "replace")).hexdigest(),
        "severity": severity,
        "location": {"path": path, "lines": {"begin": line}},
    }
