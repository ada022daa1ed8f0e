"""Convert the findings of a checked project to diagnostics and code actions of the Language Server Protocol."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from lsprotocol import types

from ros_lint.analysis.finding import Severity
from ros_lint.base.text import Text, read
from ros_lint.engine import edits

if TYPE_CHECKING:
    from ros_lint.base.text import Span
    from ros_lint.cli.commands.lsp.positions import Positions
    from ros_lint.cli.commands.lsp.project import Snapshot
    from ros_lint.engine.report import Issue

_SEVERITIES = {
    Severity.ERROR: types.DiagnosticSeverity.Error,
    Severity.WARNING: types.DiagnosticSeverity.Warning,
    Severity.INFO: types.DiagnosticSeverity.Information,
}


def uri_of(base: str, path: str) -> str:
    """Return the URI of a path that is relative to ``base``."""
    return Path(os.path.join(base, path)).as_uri()


def diagnostics(snapshot: Snapshot, positions: Positions) -> dict[str, list[types.Diagnostic]]:
    """Return the diagnostics for the findings of a checked workspace (snapshot), by the URI of their file."""
    result: dict[str, list[types.Diagnostic]] = {}
    for issue in snapshot.report.issues:
        result.setdefault(uri_of(snapshot.base, issue.finding.span.path), []).append(_diagnostic(snapshot, issue, positions))
    return result


def _diagnostic(snapshot: Snapshot, issue: Issue, positions: Positions) -> types.Diagnostic:
    finding = issue.finding

    def location(span: Span) -> types.Location:
        return types.Location(uri_of(snapshot.base, span.path), positions.range(span))

    return types.Diagnostic(
        positions.range(finding.span),
        finding.message,
        severity=_SEVERITIES[issue.severity],
        code=issue.rule.code,
        source="ros-lint",
        tags=[types.DiagnosticTag.Unnecessary] if _only_removes(issue) else None,
        related_information=[types.DiagnosticRelatedInformation(location(r.span), r.message) for r in finding.related] or None,
        data={"rule": issue.rule.name},
    )


def _only_removes(issue: Issue) -> bool:
    """Return whether the fix of an issue only removes one piece of text. An editor then shows the finding as unnecessary code."""
    fix = issue.finding.fix
    return fix is not None and all(not edit.text for edit in fix.edits) and len(fix.edits) == 1


def code_actions(
    snapshot: Snapshot, positions: Positions, path: str, first: int, last: int, only: Sequence[str]
) -> Iterator[types.CodeAction]:
    """Yield the fixes of the findings in the lines ``first`` to ``last`` of a file, and actions that fix many findings at once.

    ``only`` has the kinds of actions that the client requests, () for all. An action that fixes many findings has no edit
    yet. Its ``data`` has the name of the rule, "" for all rules.
    """
    issues = [issue for issue in snapshot.report.issues if issue.finding.fix and issue.finding.span.path == path]
    here = [issue for issue in issues if issue.finding.span.line <= last and issue.finding.span.end_line >= first]
    if _wants(only, types.CodeActionKind.QuickFix):
        for issue in here:
            yield _quick_fix(snapshot, positions, issue)
        for rule in dict.fromkeys(issue.rule.name for issue in here):
            if sum(_is_safe(issue) and issue.rule.name == rule for issue in snapshot.report.issues) > 1:
                title = f"Fix all findings of '{rule}' in the workspace"
                yield types.CodeAction(title, types.CodeActionKind.QuickFix, data={"rule": rule})
    if _wants(only, types.CodeActionKind.SourceFixAll) and any(map(_is_safe, snapshot.report.issues)):
        yield types.CodeAction("Make all safe fixes in the workspace", types.CodeActionKind.SourceFixAll, data={"rule": ""})


def _quick_fix(snapshot: Snapshot, positions: Positions, issue: Issue) -> types.CodeAction:
    fix = issue.finding.fix
    assert fix is not None
    new_texts = edits.apply([fix], lambda path: snapshot.text(path) or Text(path, ""))
    title = f"{fix.title[:1].upper()}{fix.title[1:]}"
    return types.CodeAction(
        title if fix.safe else f"{title} (may change behaviour)",
        types.CodeActionKind.QuickFix,
        diagnostics=[_diagnostic(snapshot, issue, positions)],
        is_preferred=fix.safe or None,
        edit=_workspace_edit(snapshot, positions, new_texts),
    )


def _is_safe(issue: Issue) -> bool:
    return issue.finding.fix is not None and issue.finding.fix.safe


def _wants(only: Sequence[str], kind: str) -> bool:
    return not only or any(kind == wanted or kind.startswith(f"{wanted}.") for wanted in only)


def workspace_edit(snapshot: Snapshot, positions: Positions, changed: Mapping[str, bytes]) -> types.WorkspaceEdit:
    """Return the edit that replaces the contents of files by ``changed``, the new contents by path."""
    return _workspace_edit(snapshot, positions, {path: read(path, data).text for path, data in changed.items()})


def _workspace_edit(snapshot: Snapshot, positions: Positions, texts: Mapping[str, str]) -> types.WorkspaceEdit:
    return types.WorkspaceEdit(
        changes={uri_of(snapshot.base, path): [positions.change(path, text)] for path, text in texts.items()}
    )
