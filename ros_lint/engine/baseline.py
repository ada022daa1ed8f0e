"""The baseline: a file that lists known findings, so that only new findings are shown.

A finding is identified by its rule, package and subject, which do not change when lines and files move. The file has the
number of findings with the same rule, package and subject. If a run has more than this number, all of them are shown,
because it cannot be determined which are new. Bulk suppressions of eslint work in the same way.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from ros_lint.analysis.finding import Confidence
from ros_lint.base import files
from ros_lint.base.json_text import encode
from ros_lint.engine import edits
from ros_lint.engine.report import UNSURE, HiddenCount, Issue, Report
from ros_lint.errors import UserError

FindingKey = tuple[str, str, str]
"""The name of the rule, the package and the subject of a finding. The subject is what the finding is about, e.g. a dependency."""


_MOST_BYTES = 64 << 20
"""Size limit of a baseline file in bytes, enough for half a million findings."""


class BaselineError(UserError):
    """A baseline file cannot be read or written. The message names the file and a remedy."""


class KnownFindings(NamedTuple):
    """The number of known findings with the same rule, package and subject."""

    number: int
    sure: bool
    """True if all these findings have high confidence, so that every run shows them.

    If False, a later run may hide some of them, so their absence does not mean that they were fixed.
    """


class Baseline(NamedTuple):
    """The contents of a baseline file."""

    folders: tuple[str, ...]
    """The folders that were checked when the file was written, relative to the folder of the file."""
    known: Mapping[FindingKey, KnownFindings]

    def hide_known(self, report: Report, name: str, folders: Sequence[str], where: str = "listed in") -> Report:
        """Return a report without the known findings, and with a warning about known findings that no longer occur.

        ``name`` is the name of the baseline file in messages, and ``where`` the words before it, such as "listed in". ``folders``
        are the checked folders. If they differ from the folders in the baseline file, there is no warning, because the known
        findings may still occur in folders that were not checked.
        """
        counts = Counter(map(_key, report.issues))
        shown = tuple([issue for issue in report.issues if counts[_key(issue)] > self._number(_key(issue))])
        hidden = HiddenCount(f"{where} {name}", len(report.issues) - len(shown))
        gone = self._count_gone(report, counts) if tuple(folders) == self.folders else 0
        return report._replace(
            issues=shown,
            hidden=(*report.hidden, hidden) if hidden.count else report.hidden,
            warnings=(*report.warnings, _gone_warning(name, gone)) if gone else report.warnings,
        )

    def _count_gone(self, report: Report, counts: Mapping[FindingKey, int]) -> int:
        ran = {rule.name for rule in report.rules} - {crash.rule for crash in report.crashes}
        all_shown = all(hidden.reason != UNSURE for hidden in report.hidden)
        comparable = {key: known for key, known in self.known.items() if key[0] in ran and (known.sure or all_shown)}
        return sum(max(known.number - counts.get(key, 0), 0) for key, known in comparable.items())

    def _number(self, key: FindingKey) -> int:
        return self.known[key].number if key in self.known else 0


def of(report: Report) -> Baseline:
    """Return a baseline of the findings of a report. Its ``folders`` are empty."""
    return Baseline((), {key: KnownFindings(number, sure=True) for key, number in Counter(map(_key, report.issues)).items()})


def read(path: str) -> Baseline:
    """Return the baseline in a JSON file. Raises BaselineError if the file cannot be read or is not a baseline."""
    import json  # noqa: PLC0415

    try:
        data = json.loads(files.read(path, _MOST_BYTES).decode("utf-8"))
        return Baseline(tuple(map(str, data["folders"])), dict(map(_entry, data["known"])))
    except OSError as error:
        raise BaselineError(f"{path}: {error.strerror or error}; --write-baseline creates the file") from error
    except json.JSONDecodeError as error:
        raise BaselineError(f"{path}:{error.lineno}: not valid JSON: {error.msg}; {_REMEDY}") from error
    except (UnicodeDecodeError, KeyError, TypeError, ValueError, AttributeError, RecursionError) as error:
        raise BaselineError(f"{path}: not a baseline file; {_REMEDY}") from error


_REMEDY = "--write-baseline rewrites it"


def write(path: str, report: Report, folders: Sequence[str]) -> None:
    """Write the findings of a report to a baseline file, atomically. Raises BaselineError if the file cannot be written."""
    try:
        edits.write(path, text(report, folders).encode("utf-8"))
    except edits.EditError as error:
        raise BaselineError(str(error)) from error


def text(report: Report, folders: Sequence[str]) -> str:
    """Return the text of the baseline file for the findings of a report.

    It has one line for each combination of rule, package and subject, sorted, so that git can merge versions of the file.
    """
    counts = Counter(map(_key, report.issues))
    unsure = {_key(issue) for issue in report.issues if issue.finding.confidence is not Confidence.HIGH}
    entries = [_as_json(key, count, key not in unsure) for key, count in sorted(counts.items())]
    return encode({"folders": list(folders), "known": entries}, 2)


def _gone_warning(name: str, gone: int) -> str:
    if gone == 1:
        return f"1 finding in {name} no longer occurs; --write-baseline removes it"
    return f"{gone} findings in {name} no longer occur; --write-baseline removes them"


def _key(issue: Issue) -> FindingKey:
    return issue.rule.name, _encodable(issue.package), _encodable(issue.finding.subject)


def _encodable(name: str) -> str:
    """Return a name that JSON can represent: lone surrogates, which represent undecodable bytes, become "?"."""
    return name.encode("utf-8", "replace").decode("utf-8")


def _as_json(key: FindingKey, count: int, sure: bool) -> dict[str, Any]:
    rule, package, subject = key
    return {"rule": rule, "package": package, "subject": subject, "count": count, "sure": sure}


def _entry(entry: Mapping[str, Any]) -> tuple[FindingKey, KnownFindings]:
    key = str(entry["rule"]), str(entry["package"]), str(entry["subject"])
    count = entry["count"]
    if not isinstance(count, int) or not 0 < count <= _MOST_BYTES:
        raise ValueError("invalid number of findings")
    return key, KnownFindings(count, bool(entry["sure"]))
