"""What a rule is, and what it says."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.analysis.finding import Finding, Severity

if TYPE_CHECKING:
    from ros_lint.facts.suppressions import SuppressionUse
    from ros_lint.workspace.model import Package, Workspace


class Rule(NamedTuple):
    """A check with its papers. Declared once, as ``RULE``, in the file that holds the check.

    Exactly one of ``package``, ``workspace`` and ``suppressions`` is given: a pure generator of findings for one
    package, for all, or about the comments that suppress findings, once all other rules have run.
    """

    name: str
    code: str
    """``ROS`` and three digits: 1xx workspace and manifest, 2xx dependencies, 3xx build scripts, 4xx install, 5xx launch,
    9xx the tool itself."""
    summary: str
    """Completes "checks that", lower case, no full stop: "used packages are declared"."""
    severity: Severity
    since: str
    doc: str
    """The module's docstring with the headings What it finds / Why it matters / How to fix it / Limitations."""
    default: bool = True
    """Whether it runs without being asked for."""
    fixable: bool = False
    """Whether some of its findings carry a fix."""
    package: Callable[[Package, Workspace], Iterable[Finding]] | None = None
    workspace: Callable[[Workspace], Iterable[Finding]] | None = None
    suppressions: Callable[[SuppressionUse], Iterable[Finding]] | None = None
