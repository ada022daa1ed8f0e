"""Check a workspace: from rules and suppressions to a report."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros_lint import __version__
from ros_lint.engine import registry
from ros_lint.engine import run as engine
from ros_lint.engine.report import BlindSpot, HiddenCount, Report
from ros_lint.engine.selection import Selection, show

if TYPE_CHECKING:
    from ros_lint.cli.session import Session
    from ros_lint.workspace.model import Workspace


def check(opened: Session, workspace: Workspace, selection: Selection) -> Report:
    """Return what the selected rules say of a workspace, suppressions and settings respected."""
    known = registry.load(opened.settings["plugins"])
    checked = engine.check(workspace, selection.rules, opened.loader.suppressions(), known)
    shown, hidden = show(checked.issues, selection)
    if checked.suppressed:
        hidden = (*hidden, HiddenCount("suppressed by comments", len(checked.suppressed)))
    return Report(
        issues=shown,
        rules=selection.rules,
        packages=len(workspace.packages) + len(workspace.unusable),
        target=workspace.target,
        data_date=opened.knowledge.date,
        version=__version__,
        hidden=hidden,
        not_checked=workspace.not_checked,
        unseen=_unseen(workspace),
        crashes=checked.crashes,
        workspace=opened.roots[0] if len(opened.roots) == 1 else "",
        warnings=opened.warnings,
    )


def _unseen(workspace: Workspace) -> tuple[BlindSpot, ...]:
    from ros_lint.facts.visibility import Facet  # noqa: PLC0415

    words = {
        Facet.USES: "used dependencies",
        Facet.EXECUTABLES: "executables",
        Facet.SHARE: "installed share files",
        Facet.PYTHON: "Python modules",
        Facet.LIBRARIES: "libraries",
        Facet.INTERFACES: "interfaces",
        Facet.COMPONENTS: "components",
    }
    blind = {
        word: tuple([package.name or package.path for package in workspace.packages if package.hidden(facet)])
        for facet, word in words.items()
    }
    return tuple(BlindSpot(word, packages) for word, packages in blind.items() if packages)
