"""The summary at the end of text output: counts, hidden findings and what was not analysed."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from ros_lint.analysis.finding import Severity
from ros_lint.reporters.ansi import Style, paint, safe

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from ros_lint.engine.report import Crash, HiddenCount, Report
    from ros_lint.workspace.target import UnreadFile

_LISTED = 10
"""Number of entries of a list to show; the json format has all."""

_NAMED = 5
"""Number of packages or rules to name in a sentence; the others are only counted."""

_FEW = 10
"""Number of findings that need no table of rules."""


def summary(report: Report, style: Style) -> str:
    """Return the summary: one or more lines."""
    return "".join(f"{line}\n" for line in _lines(report, style))


def count(number: int, noun: str) -> str:
    """Return a number with its noun in singular or plural: "1 error", "2 errors"."""
    return f"{number} {noun}{'' if number == 1 else 's'}"


def and_list(words: Sequence[str]) -> str:
    """Return words as a list in a sentence: "a, b and c"."""
    return " and ".join(filter(None, (", ".join(words[:-1]), *words[-1:])))


def some(packages: Sequence[str]) -> str:
    """Return the names of packages, shortened to a number if there are many."""
    return and_list(packages) if len(packages) <= _NAMED else count(len(packages), "package")


def blind_spots(report: Report) -> Iterator[str]:
    """Yield sentences without a full stop about everything that was not analysed or not shown."""
    more: Counter[str] = Counter()
    for hidden in report.hidden:
        more.update(dict(hidden.rules))
    if more:
        by_rule = [f"{name} {number}" for name, number in more.most_common(_NAMED)]
        if others := sum(number for _, number in more.most_common()[_NAMED:]):
            by_rule.append(f"other rules {others}")
        yield f"{more.total()} more with --pedantic: {', '.join(by_rule)}"
    if kinds := [hidden_findings(hidden) for hidden in report.hidden if not hidden.rules]:
        yield f"Hidden: {'; '.join(kinds)}"
    if report.unseen:
        sides: dict[tuple[str, ...], list[str]] = {}
        for unseen in report.unseen:
            sides.setdefault(unseen.packages, []).append(unseen.what)
        told_of = "; ".join(f"{and_list(what)} of {some(packages)}" for packages, what in sides.items())
        why = "Checks for missing things were skipped there; 'ros-lint explain-package NAME' lists the places"
        yield f"Not fully analysed: {told_of}. {why}"


def hidden_findings(hidden: HiddenCount) -> str:
    """Return the number of hidden findings, with the reason."""
    return f"{count(hidden.count, 'finding')} {hidden.reason}"


def told(entry: UnreadFile) -> str:
    """Return the place that was not checked, with the reason."""
    span = entry.span
    if span is None or span.path == entry.what:
        return f"{entry.what}: {entry.reason}"
    return f"{span.path if span[1:3] == (1, 1) else span}: {entry.what}: {entry.reason}"


def crashed(crash: Crash) -> str:
    """Return a sentence about a crash: the rule, the package and the error."""
    return f"{crash.rule}{f' for {crash.package}' if crash.package else ''}: {crash.error}"


def _lines(report: Report, style: Style) -> Iterator[str]:
    yield _verdict(report, style)
    yield from _by_rule(report, style)
    fixes = {"--fix": report.fixable(safe=True), "--fix --unsafe-fixes": report.fixable(safe=False)}
    if any(fixes.values()):
        yield f"Fixable: {and_list([f'{number} with {how}' for how, number in fixes.items() if number])}."
    for sentence in blind_spots(report):
        yield f"{safe(sentence, style)}."
    if report.not_checked:
        yield f"Not checked: {count(len(report.not_checked), 'item')}"
        yield from _listed([told(entry) for entry in report.not_checked], style)
    if report.crashes:
        fault = f"This is a bug in ros-lint {report.version}; please report it:"
        yield paint(style, "error", f"{count(len(report.crashes), 'check')} failed. {fault}")
        yield from _listed([crashed(crash) for crash in report.crashes], style)
        yield from (f"  {safe(line, style)}" for line in report.crashes[0].traceback.rstrip().split("\n"))


_TITLES = {Severity.ERROR: "Errors", Severity.WARNING: "Warnings", Severity.INFO: "Info"}


def _by_rule(report: Report, style: Style) -> Iterator[str]:
    """Yield a table of rules by number of findings, if there are many findings."""
    if len(report.issues) <= _FEW:
        return
    for severity, title in _TITLES.items():
        numbers = Counter(issue.rule.name for issue in report.issues if issue.severity is severity)
        if numbers:
            counted = ", ".join(f"{number} {name}" for name, number in numbers.most_common())
            yield f"{paint(style, str(severity), title)}: {counted}."


def _verdict(report: Report, style: Style) -> str:
    data = f"; package index of {report.data_date}" if report.data_date else ""
    chosen = report.target.source if report.target.explicit else f"assumed: {report.target.source}; set with --distro"
    world = f"for {report.target.distro} ({chosen}){data}"
    if not report.packages:
        return f"{paint(style, 'error', 'No package found')}, so nothing was checked {world}."
    numbers = {severity: report.count(severity) for severity in (Severity.ERROR, Severity.WARNING, Severity.INFO)}
    counts = [paint(style, str(level), _of_level(number, level)) for level, number in numbers.items() if number]
    verdict = f"Found {and_list(counts)}" if counts else paint(style, "good", "No problems found")
    return f"{verdict} in {count(report.packages, 'package')} {world}."


def _of_level(number: int, severity: Severity) -> str:
    return f"{number} info" if severity is Severity.INFO else count(number, str(severity))


def _listed(entries: Sequence[str], style: Style) -> Iterator[str]:
    yield from (f"  {safe(entry, style)}" for entry in entries[:_LISTED])
    if len(entries) > _LISTED:
        yield f"  and {len(entries) - _LISTED} more; --format json lists all of them"
