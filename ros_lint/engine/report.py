"""The report of a run: findings, hidden findings and what was not analysed."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, NamedTuple

# The cache derives the encoding of a report from these annotations, so the types are imported in each run.
from ros_lint.analysis.finding import Finding, Severity
from ros_lint.analysis.rule import Rule
from ros_lint.base.text import Span
from ros_lint.facts.repositories import UnclonedRepositories
from ros_lint.workspace.target import NamedDistro, TargetDistro, UnreadFile

if TYPE_CHECKING:
    from collections.abc import Iterable


class ExplainedFinding(NamedTuple):
    """A finding that is not shown, because another finding explains it."""

    rule: str
    """The name of its rule."""
    subject: str
    message: str
    span: Span


class Issue(NamedTuple):
    """A finding with its rule and the name of the package that has to change; "" if no package contains the place."""

    rule: Rule
    package: str
    finding: Finding
    explained: tuple[ExplainedFinding, ...] = ()
    """Findings that are not shown, because this finding explains them."""
    distros: tuple[str, ...] = ()
    """The distributions that have the finding; () if all distributions of the run have it."""
    other_messages: tuple[tuple[str, str], ...] = ()
    """Pairs of a distribution and its message, for distributions whose message differs from that of the finding."""

    @property
    def severity(self) -> Severity:
        return self.finding.severity or self.rule.severity

    @property
    def identity(self) -> str:
        """Rule, package and subject as one text. It stays the same when lines move; several issues may share it."""
        return f"{self.rule.code}/{self.package}/{self.finding.subject}"


UNSURE = "of lower confidence (shown with --pedantic)"
EXPLAINED = "explained by other findings"
OFF = "of rules that are off (shown with --pedantic)"
MINOR = "of lower severity than --min-severity"


def page_url(rule_url: str, rule: Rule) -> str:
    """Return the URL of the page of a rule from the URL with ``{rule}``; "" if that is "", and for rules of plugins."""
    return rule_url.replace("{rule}", rule.name) if rule.code.startswith("ROS") else ""


class HiddenCount(NamedTuple):
    """Number of findings that are hidden.

    ``reason`` continues a sentence after "2 findings", as :data:`UNSURE` does.
    """

    reason: str
    count: int  # type: ignore[assignment]  # a tuple counts things as well
    rules: tuple[tuple[str, int], ...] = ()
    """The rules of findings that ``--pedantic`` shows, each with its number, sorted by name; () for other findings."""

    @classmethod
    def of(cls, reason: str, issues: Iterable[Issue]) -> HiddenCount:
        """Return the counts of the issues, in total and for each rule, with the reason why they are hidden."""
        rules = Counter(issue.rule.name for issue in issues)
        return cls(reason, rules.total(), tuple(sorted(rules.items())))


class BlindSpot(NamedTuple):
    """Something that could not be fully analysed in some packages."""

    what: str
    """The facet of the packages in words: "executables"."""
    packages: tuple[str, ...]
    """The names of the packages, in the order of the workspace."""


class Crash(NamedTuple):
    """An exception that a rule raised for one package, or for the workspace if ``package`` is ""."""

    rule: str
    package: str
    traceback: str
    plugin: str = ""
    """Name and version of the plugin that has the rule; "" for a rule of ros-lint."""

    @property
    def error(self) -> str:
        """The last line of the traceback: type and message."""
        return self.traceback.strip().rpartition("\n")[2]


class Report(NamedTuple):
    """The result of a run. The same input gives the same report on any machine."""

    issues: tuple[Issue, ...]
    """The findings to show, sorted by span, code and message."""
    rules: tuple[Rule, ...]
    """The rules that ran, sorted by code."""
    packages: int
    """Number of packages checked; 0 if no package was found."""
    target: TargetDistro
    """The distribution of the run, with the others if there are several."""
    data_date: str
    """The date of the package index, as YYYY-MM-DD."""
    version: str
    """The version of ros-lint."""
    hidden: tuple[HiddenCount, ...] = ()
    not_checked: tuple[UnreadFile, ...] = ()
    blind_spots: tuple[BlindSpot, ...] = ()
    not_cloned: tuple[UnclonedRepositories, ...] = ()
    """Repositories in lists of the workspace that are not cloned: their packages are unknown, not missing."""
    crashes: tuple[Crash, ...] = ()
    workspace: str = ""
    """The checked folder, relative to the base as all paths are; "" for the base itself."""
    named_distros: tuple[NamedDistro, ...] = ()
    """The distributions that the repository builds for; () if the user chose the distribution of the run."""
    context_packages: int = 0
    """Number of packages that were only read to check the others. Their findings are not reported."""
    ros1: tuple[str, ...] = ()
    """The names of packages of ROS 1, whose dependencies and build scripts are not analysed, in the order of the workspace."""
    warnings: tuple[str, ...] = ()
    """Warnings about the command line and settings, which are printed to standard error."""
    package_names: tuple[str, ...] = ()
    """The names of the checked packages, sorted."""
    rule_url: str = ""
    """URL of the page of a rule, with ``{rule}`` in place of its name; "" if there are no links."""

    def url_of(self, rule: Rule) -> str:
        """Return the URL of the page of a rule; "" if there are no links, and for rules of plugins."""
        return page_url(self.rule_url, rule)

    def count(self, severity: Severity) -> int:
        """Return the number of issues with a severity."""
        return sum(issue.severity is severity for issue in self.issues)

    def fixable(self, *, safe: bool) -> int:
        """Return the number of issues with a safe fix (``safe`` true), or with an unsafe fix."""
        return sum(issue.finding.fix is not None and issue.finding.fix.safe is safe for issue in self.issues)
