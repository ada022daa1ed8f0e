"""The gitlab format: a Code Quality report for merge requests (docs.gitlab.com)."""

from __future__ import annotations

import hashlib
from collections import Counter
from typing import TYPE_CHECKING, Any

from ros_lint.analysis.finding import Severity
from ros_lint.base.json_text import encode
from ros_lint.reporters.summary import crashed, unread_file

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ros_lint.engine.report import Report
    from ros_lint.reporters import SourceTexts
    from ros_lint.reporters.ansi import Style

_LEVELS = {Severity.ERROR: "critical", Severity.WARNING: "major", Severity.INFO: "info"}


def render(report: Report, texts: SourceTexts, style: Style) -> str:  # noqa: ARG001  (the signature of reporters)
    """Return a JSON list with an entry for each finding, and for each problem that makes the run incomplete."""
    return encode([*_findings(report), *_problems(report)], 1)


def _findings(report: Report) -> Iterator[dict[str, Any]]:
    # GitLab merges entries with the same fingerprint, so issues of one identity are numbered in each file.
    counts: Counter[str] = Counter()
    for issue in report.issues:
        finding = issue.finding
        identity = f"{issue.identity}/{finding.span.path}"
        counts[identity] += 1
        name, level, span = f"{issue.rule.name} ({issue.rule.code})", _LEVELS[issue.severity], finding.span
        yield _entry(f"{identity}/{counts[identity]}", name, finding.message, level, span.path, span.line)


def _problems(report: Report) -> Iterator[dict[str, Any]]:
    folder = report.workspace or _DEFAULT_PATH
    if not report.packages:
        yield _entry("no package", "ros-lint", "no package found, so nothing was checked", "blocker", folder, 1)
    for crash in report.crashes:
        yield _entry(f"{crash.rule}/{crash.package}", "ros-lint", f"a rule failed: {crashed(crash)}", "blocker", folder, 1)
    for entry in report.not_checked:
        path, line = (entry.span.path, entry.span.line) if entry.span else (folder, 1)
        yield _entry(f"not checked/{path}/{entry.what}", "ros-lint", unread_file(entry), "info", path, line)


_DEFAULT_PATH = "package.xml"
"""Path for entries without a place, because GitLab requires a path."""


def _entry(identity: str, name: str, description: str, severity: str, path: str, line: int) -> dict[str, Any]:
    return {
        "description": description,
        "check_name": name,
        "fingerprint": hashlib.sha256(identity.encode("utf-8", "replace")).hexdigest(),
        "severity": severity,
        "location": {"path": path, "lines": {"begin": line}},
    }
