"""Check a workspace with the settings of a run: the steps that several commands share."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros_lint.cli.patterns import without_effect
from ros_lint.cli.selected_packages import selected_folders
from ros_lint.engine import registry
from ros_lint.engine.check import ReportContext, check
from ros_lint.engine.selection import Selection, SelectionError, check_selectors, select

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ros_lint.cli.session import Session
    from ros_lint.cli.settings import Settings
    from ros_lint.engine.kept_findings import KeptFindings
    from ros_lint.engine.report import Report
    from ros_lint.workspace.model import Workspace


def check_session(session: Session, kept: KeptFindings | None = None) -> Report:
    """Load the workspace of a session, and return the report about the packages that the settings select.

    ``kept`` has findings of an earlier run, which are used as far as they are valid, and replaced by those of this run.

    Raises SelectionError, PluginError, KnowledgeError, and UsageError for package names that do not exist.
    """
    workspaces = session.loader.load_all()
    folders, warnings = selected_folders(session.settings, session.roots, lambda: workspaces)
    patterns = without_effect(session.settings, session.excluder, session.base, session.roots, workspaces[0])
    recorded = session.loader.recorded if kept is not None else None
    if kept is None or recorded is None:
        return check_workspaces(session, workspaces, folders, (*warnings, *patterns))
    recorder, handles = recorded
    rules = registry.load(session.settings["plugins"])
    kept.restore(handles, rules)
    report = check_workspaces(session, workspaces, folders, (*warnings, *patterns))
    kept.store(recorder, handles, rules)
    return report


def check_workspaces(
    session: Session,
    workspaces: Sequence[Workspace],
    folders: Sequence[str],
    warnings: Sequence[str] = (),
) -> Report:
    """Return the report of the rules that the settings select.

    ``workspaces`` has the loaded workspace once for each distribution. Findings in ``folders`` are reported. ``warnings``
    are added to those of the session. Raises SelectionError, PluginError and KnowledgeError.
    """
    rules = registry.load(session.settings["plugins"])
    jobs = session.settings["jobs"]
    context = ReportContext(rules, session.knowledge.date, tuple(folders), (*session.warnings, *warnings), jobs)
    return check(workspaces, session.loader.suppressions(), selection_of(session.settings), context)


def selection_of(settings: Settings) -> Selection:
    """Return the selection of rules and findings that the settings make. Raises SelectionError and PluginError."""
    rules = registry.load(settings["plugins"])
    per_path = [name for names in settings["per-path-ignores"].values() for name in names]
    for option in ("select", "extend-select", "ignore", "severity", "per-path-ignores", "fix-only"):
        for selector in per_path if option == "per-path-ignores" else settings[option]:
            try:
                check_selectors(rules, (selector,))
            except SelectionError as error:
                place = settings.place(option, selector)
                raise SelectionError(f"{place}: {error}" if place.startswith("--") else f"{place}: {option}: {error}") from error
    return select(
        rules,
        chosen=settings["select"],
        added=settings["extend-select"],
        ignored=settings["ignore"],
        severities=settings["severity"],
        per_path=settings["per-path-ignores"],
        pedantic=settings["pedantic"],
        min_severity=settings["min-severity"],
    )
