"""The summary after the findings: the numbers of findings and hidden findings, and what was not analysed."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.analysis.finding import Severity
from ros_lint.base.suggestions import and_list
from ros_lint.reporters.ansi import Style, paint, safe

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from ros_lint.base.text import Span
    from ros_lint.engine.report import Crash, HiddenCount, Issue, Report
    from ros_lint.workspace.target import UnreadFile

_LISTED = 10
"""Maximum number of entries of a list that are shown; the json format has all of them."""

_NAMED = 5
"""Maximum number of packages or rules that a sentence names; others are only counted."""

_FEW = 10
"""Number of findings up to which the numbers for each rule are not printed."""


DEFAULT_PATH = "package.xml"
"""Path for problems without a place, in formats that require a path."""


class Problem(NamedTuple):
    """A reason why a run is incomplete, e.g. a crash of a rule."""

    severity: Severity
    """ERROR if the problem makes the exit code 2, else INFO."""
    message: str
    span: Span | None = None


def problems(report: Report) -> Iterator[Problem]:
    """Yield the problems that make a run incomplete: a workspace without packages, crashes of rules, and unchecked files."""
    if not report.packages:
        yield Problem(Severity.ERROR, "no package found, so nothing was checked")
    for crash in report.crashes:
        yield Problem(Severity.ERROR, f"a rule failed: {crashed(crash)}")
    for entry in report.not_checked:
        yield Problem(Severity.INFO, f"not checked: {unread_file(entry)}", entry.span)


def by_package(issues: Iterable[Issue]) -> list[tuple[str, list[Issue]]]:
    """Return pairs of a package and its issues: errors first, then warnings, then infos.

    Packages are sorted by the severity of their most severe issue, then by its place.
    """
    packages: dict[str, list[Issue]] = {}
    for issue in sorted(issues, key=lambda issue: -issue.severity):
        packages.setdefault(issue.package, []).append(issue)
    return sorted(packages.items(), key=lambda item: (-item[1][0].severity, item[1][0].finding.span))


def summary(report: Report, style: Style) -> str:
    """Return the summary as one or more lines; "" if ``style`` has no summary."""
    return "".join(f"{line}\n" for line in _lines(report, style)) if style.summary else ""


def count(number: int, noun: str) -> str:
    """Return a number with its noun in singular or plural: "1 error", "2 errors"."""
    return f"{number} {noun}{'' if number == 1 else 's'}"


def name_or_count(names: Sequence[str], noun: str = "packages") -> str:
    """Return names as a list.

    If there are many, return their number and the first of them: "12 packages (talker, listener ...)".
    """
    if len(names) <= _NAMED:
        return and_list(names)
    return f"{len(names)} {noun} ({', '.join(names[:_NAMED])} ...)"


def limits(report: Report) -> Iterator[str]:
    """Yield sentences for the summary, without full stop.

    They are about distributions that the repository is also built for, hidden findings, and parts that were not analysed.
    """
    if proposed := _proposed_distros(report):
        yield proposed
    more: Counter[str] = Counter()
    for hidden in report.hidden:
        more.update(dict(hidden.rules))
    if more:
        by_rule = [f"{name} {number}" for name, number in more.most_common(_NAMED)]
        if others := sum(number for _, number in more.most_common()[_NAMED:]):
            by_rule.append(f"other rules {others}")
        yield f"{count(more.total(), 'more finding')} with --pedantic: {', '.join(by_rule)}"
    if kinds := [hidden_findings(hidden) for hidden in report.hidden if not hidden.rules]:
        yield f"Hidden: {'; '.join(kinds)}"
    if report.not_cloned:
        names = sorted({name for uncloned in report.not_cloned for name in uncloned.names})
        more_lists = f" and {count(len(report.not_cloned) - 1, 'other file')}" if len(report.not_cloned) > 1 else ""
        why = "Their packages are unknown, not missing"
        yield f"Not cloned here: {name_or_count(names, 'repositories')} ({report.not_cloned[0].path}{more_lists}). {why}"
    if report.ros1:
        verb = "is a package" if len(report.ros1) == 1 else "are packages"
        yield f"Not analysed, because only ROS 2 is supported: {name_or_count(report.ros1)} {verb} of ROS 1 (build type catkin)"
    if report.blind_spots:
        facets: dict[tuple[str, ...], list[str]] = {}
        for spot in report.blind_spots:
            facets.setdefault(spot.packages, []).append(spot.what)
        list_of_spots = "; ".join(f"{and_list(what)} of {name_or_count(packages)}" for packages, what in facets.items())
        why = "Checks for missing things were skipped there; 'ros-lint explain-package NAME' lists the places"
        yield f"Not fully analysed: {list_of_spots}. {why}"


def _proposed_distros(report: Report) -> str:
    """Return a sentence that proposes the distributions that the repository is built for.

    Return "" if the run was for one of these distributions, or if no file of the repository names a distribution.
    """
    if report.target.distro in [named.distro for named in report.named_distros]:
        return ""
    named = [named for named in report.named_distros if named.indexed]
    places = and_list([f"{known.distro} ({known.path}:{known.line})" for known in named or report.named_distros])
    if named:
        return f"This repository builds for {places}: pass --distro {','.join(known.distro for known in named)}"
    return f"This repository builds for {places}, which has no package index here" if places else ""


def hidden_findings(hidden: HiddenCount) -> str:
    """Return the number of hidden findings and the reason why they are hidden: "2 findings suppressed by comments"."""
    return f"{count(hidden.count, 'finding')} {hidden.reason}"


def unread_file(entry: UnreadFile) -> str:
    """Return a text about an unchecked file or part of a file: its place, and the reason why it was not checked."""
    span = entry.span
    if span is None or span.path == entry.what:
        return f"{entry.what}: {entry.reason}"
    return f"{span.path if span[1:3] == (1, 1) else span}: {entry.what}: {entry.reason}"


def crashed(crash: Crash) -> str:
    """Return a text about a crash: the rule, its plugin, the package and the error.

    "unused-dependency for talker: KeyError: 'a'".
    """
    plugin = f" of the plugin '{crash.plugin}'" if crash.plugin else ""
    return f"{crash.rule}{plugin}{f' for {crash.package}' if crash.package else ''}: {crash.error}"


def _lines(report: Report, style: Style) -> Iterator[str]:
    yield _verdict(report, style)
    if report.context_packages:
        total = report.packages + report.context_packages
        others = "the other is" if report.context_packages == 1 else "the others are"
        yield f"Checked {report.packages} of {total} packages; {others} context."
    yield from _by_rule(report, style)
    fixes = {"--fix": report.fixable(safe=True), "--fix --unsafe-fixes": report.fixable(safe=False)}
    if any(fixes.values()):
        yield f"Fixable: {and_list([f'{number} with {how}' for how, number in fixes.items() if number])}."
    for sentence in limits(report):
        yield f"{safe(sentence, style)}."
    if report.not_checked:
        yield f"Not checked: {count(len(report.not_checked), 'item')}"
        yield from _shortened([unread_file(entry) for entry in report.not_checked], style)
    if report.crashes:
        yield paint(style, "error", f"{count(len(report.crashes), 'check')} failed. {safe(_fault(report), style)}")
        yield from _shortened([crashed(crash) for crash in report.crashes], style)
        yield from (f"  {safe(line, style)}" for line in report.crashes[0].traceback.rstrip().split("\n"))


def _fault(report: Report) -> str:
    """Return the sentence that asks to report the crashes: to the authors of ros-lint or of the plugins."""
    plugins = dict.fromkeys(crash.plugin for crash in report.crashes)
    owners = [f"the plugin '{plugin}'" if plugin else f"ros-lint {report.version}" for plugin in plugins]
    addressee = "" if "" in plugins else " to its author" if len(owners) == 1 else " to their authors"
    return f"This is a bug in {and_list(owners)}; please report it{addressee}:"


_TITLES = {Severity.ERROR: "Errors", Severity.WARNING: "Warnings", Severity.INFO: "Info"}


def _by_rule(report: Report, style: Style) -> Iterator[str]:
    """Yield a line for each severity with the number of findings of each rule. Yield nothing if there are few findings."""
    if len(report.issues) <= _FEW:
        return
    for severity, title in _TITLES.items():
        numbers = Counter(issue.rule.name for issue in report.issues if issue.severity is severity)
        if numbers:
            counted = ", ".join(f"{number} {name}" for name, number in numbers.most_common())
            yield f"{paint(style, str(severity), title)}: {counted}."


def _verdict(report: Report, style: Style) -> str:
    data = f"; package index of {report.data_date}" if report.data_date else ""
    origin = report.target.source if report.target.explicit else f"assumed: {report.target.source}; set with --distro"
    target = f"for {and_list(report.target.distros)} ({origin}){data}"
    if not report.packages:
        return f"{paint(style, 'error', 'No package found')}, so nothing was checked {target}."
    numbers = {severity: report.count(severity) for severity in (Severity.ERROR, Severity.WARNING, Severity.INFO)}
    counts = [paint(style, str(level), _level_count(number, level)) for level, number in numbers.items() if number]
    verdict = f"Found {and_list(counts)}" if counts else paint(style, "good", "No problems found")
    return f"{verdict} in {count(report.packages, 'package')} {target}."


def _level_count(number: int, severity: Severity) -> str:
    return f"{number} info" if severity is Severity.INFO else count(number, str(severity))


def _shortened(entries: Sequence[str], style: Style) -> Iterator[str]:
    yield from (f"  {safe(entry, style)}" for entry in entries[:_LISTED])
    if len(entries) > _LISTED:
        yield f"  and {len(entries) - _LISTED} more; --format json lists all of them"
