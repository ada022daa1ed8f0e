"""The jsonl format, for programs that read line by line: a JSON object for each finding, and one for the run."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros_lint.base.json_text import encode
from ros_lint.reporters.json_report import SCHEMA_VERSION, document

if TYPE_CHECKING:
    from ros_lint.engine.report import Report
    from ros_lint.reporters import SourceTexts
    from ros_lint.reporters.ansi import Style


def render(report: Report, texts: SourceTexts, style: Style) -> str:  # noqa: ARG001  (the signature of reporters)
    """Return a line for each finding, with ``"type": "finding"``, and a last line for the run, with ``"type": "run"``."""
    run = document(report)
    findings = run.pop("findings")
    lines = [{"type": "finding", "schema_version": SCHEMA_VERSION, **finding} for finding in findings]
    return "".join(encode(line, 0) for line in [*lines, {"type": "run", **run}])
