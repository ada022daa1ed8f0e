"""The baseline: a file that lists known findings, so that only new findings are shown.

A finding is known by its rule, package and subject, which stay the same when lines and files move. Findings that share
these are counted. If there are more than the file lists, all of them are shown, because the new one cannot be
determined. Bulk suppressions of eslint work the same way.
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

Key = tuple[str, str, str]
"""The name of the rule, the package, the subject."""


_MOST_BYTES = 64 << 20
"""Size limit of the file, enough for half a million findings."""


class BaselineError(UserError):
    """A baseline that cannot be read or written. The message names the file and the remedy."""


class Known(NamedTuple):
    """The entry of findings that share a key."""

    number: int
    sure: bool
    """True if they are shown by default.

    Other findings may be hidden, which does not mean that they are fixed."""


class Baseline(NamedTuple):
    """The contents of a baseline file."""

    folders: tuple[str, ...]
    """The folders that were checked when it was written, relative to the folder of the file."""
    known: Mapping[Key, Known]

    def without(self, report: Report, name: str, folders: Sequence[str]) -> Report:
        """Return a report without the known findings, and with a warning about those that no longer occur.

        ``name`` is the name of the file in messages. ``folders`` are the checked folders: findings in others may still
        occur.
        """
        counts = Counter(map(_key, report.issues))
        shown = tuple([issue for issue in report.issues if counts[_key(issue)] > self._number(_key(issue))])
        hidden = HiddenCount(f"listed in {name}", len(report.issues) - len(shown))
        gone = self._gone(report, counts) if tuple(folders) == self.folders else 0
        return report._replace(
            issues=shown,
            hidden=(*report.hidden, hidden) if hidden.count else report.hidden,
            warnings=(*report.warnings, _about(name, gone)) if gone else report.warnings,
        )

    def _gone(self, report: Report, counts: Mapping[Key, int]) -> int:
        ran = {rule.name for rule in report.rules} - {crash.rule for crash in report.crashes}
        every = all(hidden.reason != UNSURE for hidden in report.hidden)
        judged = {key: known for key, known in self.known.items() if key[0] in ran and (known.sure or every)}
        return sum(max(known.number - counts.get(key, 0), 0) for key, known in judged.items())

    def _number(self, key: Key) -> int:
        return self.known[key].number if key in self.known else 0


def read(path: str) -> Baseline:
    """Return the baseline in a file. Raises BaselineError."""
    import json  # noqa: PLC0415

    try:
        data = json.loads(files.read(path, _MOST_BYTES).decode("utf-8"))
        return Baseline(tuple(map(str, data["folders"])), dict(map(_entry, data["known"])))
    except OSError as error:
        raise BaselineError(f"{path}: {error.strerror or error}; --write-baseline creates the file") from error
    except json.JSONDecodeError as error:
        raise BaselineError(f"{path}:{error.lineno}: not valid JSON: {error.msg}; {_WAY_OUT}") from error
    except (UnicodeDecodeError, KeyError, TypeError, ValueError, AttributeError, RecursionError) as error:
        raise BaselineError(f"{path}: not a baseline file; {_WAY_OUT}") from error


_WAY_OUT = "--write-baseline rewrites it"


def write(path: str, report: Report, folders: Sequence[str]) -> None:
    """Write the findings of a report to a file, atomically. Raises BaselineError."""
    try:
        edits.write(path, text(report, folders).encode("utf-8"))
    except edits.EditError as error:
        raise BaselineError(str(error)) from error


def text(report: Report, folders: Sequence[str]) -> str:
    """Return the baseline of a report: one line for each key, sorted, so that versions merge well."""
    counts = Counter(map(_key, report.issues))
    unsure = {_key(issue) for issue in report.issues if issue.finding.confidence is not Confidence.HIGH}
    known = [_written(key, count, key not in unsure) for key, count in sorted(counts.items())]
    return encode({"folders": list(folders), "known": known}, 2)


def _about(name: str, gone: int) -> str:
    if gone == 1:
        return f"1 finding in {name} no longer occurs; --write-baseline removes it"
    return f"{gone} findings in {name} no longer occur; --write-baseline removes them"


def _key(issue: Issue) -> Key:
    return issue.rule.name, _sayable(issue.package), _sayable(issue.finding.subject)


def _sayable(name: str) -> str:
    """Return a name as it is written in the file: bytes that cannot be decoded are replaced."""
    return name.encode("utf-8", "replace").decode("utf-8")


def _written(key: Key, count: int, sure: bool) -> dict[str, Any]:
    rule, package, subject = key
    return {"rule": rule, "package": package, "subject": subject, "count": count, "sure": sure}


def _entry(written: Mapping[str, Any]) -> tuple[Key, Known]:
    key = str(written["rule"]), str(written["package"]), str(written["subject"])
    count = written["count"]
    if not isinstance(count, int) or not 0 < count <= _MOST_BYTES:
        raise ValueError("no number of findings")
    return key, Known(count, bool(written["sure"]))
