"""The type of a rule: its name, code, documentation and check."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.analysis.finding import Finding, Severity

if TYPE_CHECKING:
    from ros_lint.facts.suppressions import SuppressionUse
    from ros_lint.workspace.model import Package, Workspace


class Rule(NamedTuple):
    """A check with its metadata. The module that contains the check assigns it to ``RULE``.

    Exactly one of ``package``, ``workspace`` and ``suppressions`` is set, to a pure function that yields findings.
    """

    name: str
    """Name in kebab case, as users write it in settings and suppressions: "missing-file"."""
    code: str
    """Unique short name: capital letters, then digits: "ACME001".

    The letters belong to one plugin, so that codes of two plugins never collide; a second plugin that uses them is an error.
    The codes of ros-lint are ``ROS`` and three digits: 1xx workspace and manifest, 2xx dependencies, 3xx build scripts,
    4xx install, 5xx launch, 9xx ros-lint itself.
    """
    summary: str
    """The end of a sentence that begins with "checks that", in lower case, without a full stop: "used packages are declared"."""
    severity: Severity
    """Severity of the findings of the rule, unless a finding overrides it."""
    since: str
    """Version of ros-lint, or of the plugin, that introduced the rule: "0.2"."""
    doc: str
    """Documentation in Markdown: ``__doc__``, the docstring of the module.

    Its headings are: What it finds, Why it matters, How to fix it, Limitations. SARIF reports contain it, and
    ``ros-lint rule NAME`` prints it.
    """
    default: bool = True
    """True if the rule runs unless it is deselected; false if it must be selected."""
    fixable: bool = False
    """True if some of the rule's findings have a fix."""
    package: Callable[[Package, Workspace], Iterable[Finding]] | None = None
    """The check of a package. It is called once for each package."""
    workspace: Callable[[Workspace], Iterable[Finding]] | None = None
    """The check of a workspace. It is called once for each run."""
    suppressions: Callable[[SuppressionUse], Iterable[Finding]] | None = None
    """The check of suppression comments. It is called after all other rules."""
