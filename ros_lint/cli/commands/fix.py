"""``ros-lint --fix`` and ``--diff``: write the fixes that were checked successfully in memory, or print them as a patch."""

from __future__ import annotations

import gc
import sys
from typing import TYPE_CHECKING

from ros_lint.cli.checking import check_workspaces, selection_of
from ros_lint.cli.messages import show
from ros_lint.cli.selected_packages import selected_folders
from ros_lint.engine import edits, registry
from ros_lint.engine.fix_trials import FixTrials
from ros_lint.engine.fixing import fix
from ros_lint.reporters.ansi import harmless

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from ros_lint.cli.session import Session
    from ros_lint.engine.report import Issue, Report


def run(session: Session) -> tuple[Report, int]:
    """Write the fixes (``--fix``) or print them as a patch (``--diff``).

    Return the report of the remaining findings, and the exit code: 2 if a file could not be written, else 0.
    """
    gc.enable()  # the workspace is loaded several times, and the memory of a trial has to be freed
    settings = session.settings
    rules = registry.load(settings["plugins"])
    folders, warnings = selected_folders(settings, session.roots, session.loader.load_all)
    only = {rule.name for selector in settings["fix-only"] for rule in registry.matching(rules, selector)}
    unsafe = settings["unsafe-fixes"]
    trials = FixTrials(
        session.loader, folders, selection_of(settings), rules, unsafe=unsafe, only=only if settings["fix-only"] else None
    )

    def report(changed: Mapping[str, bytes]) -> Report:
        return check_workspaces(session, session.loader.load_all(changed), folders, warnings)

    result = fix(trials)
    for issue, reason in result.skipped:
        show(f"{issue.finding.span}: fix skipped: {reason} [{issue.rule.name}]")
    if settings["diff"]:
        sys.stdout.buffer.write(trials.patch(result.changed))
        sys.stdout.buffer.flush()
        return report({}), 0
    try:
        edits.write_all(session.base, result.changed, session.loader.pinned)
    except edits.EditError as error:
        show(str(error))
        return report({path: result.changed[path] for path in error.written}), 2
    show(_summary(len(result.applied), len(result.changed)))
    if settings["show-fixes"]:
        for line in _listed(result.applied):
            print(f"  {harmless(line)}", file=sys.stderr)
    return report(result.changed), 0


def _listed(applied: Iterable[Issue]) -> list[str]:
    """Return a line for each applied fix, sorted: the edited files, the title of the fix, and the rule."""
    lines = []
    for issue in applied:
        assert issue.finding.fix is not None
        paths = ", ".join(dict.fromkeys(edit.span.path for edit in issue.finding.fix.edits))
        lines.append(f"{paths}: {issue.finding.fix.title} [{issue.rule.name}]")
    return sorted(lines)


def _summary(count: int, files: int) -> str:
    if not count:
        return "nothing to fix"
    return f"fixed {count} finding{'s' * (count != 1)} in {files} file{'s' * (files != 1)}"
