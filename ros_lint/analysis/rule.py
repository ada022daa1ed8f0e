"""The type of a rule: its name, code, documentation and check."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.analysis.finding import Finding, Severity

if TYPE_CHECKING:
    from ros_lint.facts.suppressions import SuppressionUse
    from ros_lint.workspace.model import Package, Workspace


class Rule(NamedTuple):
    """A check with its metadata. Declared once, as ``RULE``, in the module that holds the check.

    Exactly one of ``package``, ``workspace`` and ``suppressions`` is set. Each is a pure generator of findings:
    - ``package`` is called for each package.
    - ``workspace`` is called once.
    - ``suppressions`` is called after all other rules, with the suppression comments and their uses.
    """

    name: str
    code: str
    """``ROS`` and three digits, where the first digit is the group of the rule.

    The groups: 1xx workspace and manifest, 2xx dependencies, 3xx build scripts, 4xx install, 5xx launch, 9xx ros-lint
    itself."""
    summary: str
    """Completes "checks that", lower case, no full stop: "used packages are declared"."""
    severity: Severity
    since: str
    doc: str
    """The module's docstring. Headings: What it finds / Why it matters / How to fix it / Limitations."""
    default: bool = True
    """True if the rule runs unless it is deselected; false if it must be selected."""
    fixable: bool = False
    """True if some of its findings have a fix."""
    package: Callable[[Package, Workspace], Iterable[Finding]] | None = None
    workspace: Callable[[Workspace], Iterable[Finding]] | None = None
    suppressions: Callable[[SuppressionUse], Iterable[Finding]] | None = None
