"""The report of a run: the findings, the numbers of hidden findings, and the files and packages that were not analysed."""

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
    """A finding that is not shown, because it is the consequence of another finding."""

    rule: str
    """Name of the rule that reported the finding."""
    subject: str
    message: str
    span: Span


class Issue(NamedTuple):
    """A finding with its rule and the package that has to change; the package is "" if no package contains the place."""

    rule: Rule
    package: str
    finding: Finding
    explained: tuple[ExplainedFinding, ...] = ()
    """Findings that are not shown, because they are consequences of this finding."""
    distros: tuple[str, ...] = ()
    """The distributions of ROS with the finding; () if all distributions of the run have it."""
    other_messages: tuple[tuple[str, str], ...] = ()
    """Pairs of a distribution and its message, for distributions with another message than that of ``finding``."""

    @property
    def severity(self) -> Severity:
        return self.finding.severity or self.rule.severity

    @property
    def identity(self) -> str:
        """Code of the rule, package and subject as one text.

        It does not change when lines move; several issues can have the same text.
        """
        return f"{self.rule.code}/{self.package}/{self.finding.subject}"


UNSURE = "of lower confidence (shown with --pedantic)"
EXPLAINED = "explained by other findings"
OFF = "of rules that are off (shown with --pedantic)"
MINOR = "of lower severity than --min-severity"


def page_url(rule_url: str, rule: Rule) -> str:
    """Return the URL of the documentation page of a rule, given a URL with ``{rule}`` in place of the name.

    Return "" if ``rule_url`` is "", or for a rule of a plugin.
    """
    return rule_url.replace("{rule}", rule.name) if rule.code.startswith("ROS") else ""


class HiddenCount(NamedTuple):
    """The number of findings that are hidden for one reason.

    ``reason`` continues a sentence after "2 findings", e.g. :data:`UNSURE`.
    """

    reason: str
    count: int  # type: ignore[assignment]  # a tuple counts things as well
    rules: tuple[tuple[str, int], ...] = ()
    """For findings that ``--pedantic`` shows, each rule with its number of findings, sorted by name; () for other findings."""

    @classmethod
    def of(cls, reason: str, issues: Iterable[Issue]) -> HiddenCount:
        """Return the total number of ``issues`` and the number for each rule, with the reason why they are hidden."""
        rules = Counter(issue.rule.name for issue in issues)
        return cls(reason, rules.total(), tuple(sorted(rules.items())))


class BlindSpot(NamedTuple):
    """A kind of contents, such as executables, that could not be fully analysed in some packages."""

    what: str
    """Name of the kind of contents for messages: "executables"."""
    packages: tuple[str, ...]
    """The names of the packages, in the order of the workspace."""


class Crash(NamedTuple):
    """An exception that a rule raised. ``package`` is the name of the checked package, "" if the rule checked the workspace."""

    rule: str
    package: str
    traceback: str
    plugin: str = ""
    """Name and version of the plugin with the rule; "" for a rule of ros-lint."""

    @property
    def error(self) -> str:
        """The last line of the traceback: type and message."""
        return self.traceback.strip().rpartition("\n")[2]


class Report(NamedTuple):
    """The result of a run. The same input gives the same report on every machine."""

    issues: tuple[Issue, ...]
    """The findings to show, sorted by span, rule code and message."""
    rules: tuple[Rule, ...]
    """The rules that ran, sorted by code."""
    packages: int
    """Number of checked packages; 0 if no package was found."""
    target: TargetDistro
    """The distribution of ROS for which the packages were checked, with the other ones if there are several."""
    data_date: str
    """The date of the package index, as YYYY-MM-DD."""
    version: str
    """The version of ros-lint."""
    hidden: tuple[HiddenCount, ...] = ()
    not_checked: tuple[UnreadFile, ...] = ()
    blind_spots: tuple[BlindSpot, ...] = ()
    not_cloned: tuple[UnclonedRepositories, ...] = ()
    """Repositories that the workspace lists but that are not cloned.

    Their packages are unknown, so they do not count as missing.
    """
    crashes: tuple[Crash, ...] = ()
    workspace: str = ""
    """The checked folder, relative to the base folder of the run; "" for the base folder itself, or if there are several."""
    named_distros: tuple[NamedDistro, ...] = ()
    """The distributions that the repository is built for, judging by its files; () if the user chose the distribution."""
    context_packages: int = 0
    """Number of packages outside the checked folders. They were read, but their findings are not reported."""
    ros1: tuple[str, ...] = ()
    """The names of packages of ROS 1, in the order of the workspace. Their dependencies and build scripts are not analysed."""
    warnings: tuple[str, ...] = ()
    """Warnings about the command line and the settings, which are printed to standard error."""
    package_names: tuple[str, ...] = ()
    """The names of the checked packages, sorted."""
    rule_url: str = ""
    """URL of the documentation of a rule, with ``{rule}`` in place of its name; "" if reports contain no links."""

    def url_of(self, rule: Rule) -> str:
        """Return the URL of the documentation page of a rule; "" if reports contain no links, or for a rule of a plugin."""
        return page_url(self.rule_url, rule)

    def count(self, severity: Severity) -> int:
        """Return the number of issues with a severity."""
        return sum(issue.severity is severity for issue in self.issues)

    def fixable(self, *, safe: bool) -> int:
        """Return the number of issues with a fix: with a safe fix if ``safe`` is True, otherwise with an unsafe fix."""
        return sum(issue.finding.fix is not None and issue.finding.fix.safe is safe for issue in self.issues)
