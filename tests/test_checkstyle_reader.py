"""The checkstyle format, read by go-checkstyle, which is the reader of reviewdog.

On Debian: ``apt-get install golang-go golang-github-haya14busa-go-checkstyle-dev``. The tests are skipped without it.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest

from ros_lint.analysis.finding import Finding, Severity
from ros_lint.base.text import Span
from ros_lint.engine.report import Issue, Report
from ros_lint.reporters import reporter
from ros_lint.reporters.ansi import Style, safe
from tests.reports import CLEAN, EVERYTHING, UNDECLARED, texts

GO_PATH = Path("/usr/share/gocode")
LIBRARY = "github.com/haya14busa/go-checkstyle/checkstyle"
PROGRAM = f"""
package main

import (
	"encoding/json"
	"encoding/xml"
	"os"

	"{LIBRARY}"
)

func main() {{
	decoder := xml.NewDecoder(os.Stdin)
	var results []checkstyle.Result
	for {{
		var result checkstyle.Result
		if decoder.Decode(&result) != nil {{
			break
		}}
		results = append(results, result)
	}}
	json.NewEncoder(os.Stdout).Encode(results)
}}
"""
HOSTILE = "<error line=\"1\"/>]]>&amp; 'a'\n\tb \u202e é \U0001f916"

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not shutil.which("go"), reason="go is not installed"),
    pytest.mark.skipif(not (GO_PATH / "src" / LIBRARY).exists(), reason="go-checkstyle is not installed"),
]
Entry = tuple[str, int, int, str, str, str]


@pytest.fixture(scope="module")
def reader(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A program that writes what go-checkstyle reads as JSON."""
    folder = tmp_path_factory.mktemp("reader")
    (folder / "main.go").write_text(PROGRAM, "utf-8")
    environment = {**os.environ, "GO111MODULE": "off", "GOPATH": str(GO_PATH), "GOCACHE": str(folder / "cache")}
    subprocess.run(["go", "build", "-o", "reader", "main.go"], cwd=folder, env=environment, check=True, timeout=300)
    return folder / "reader"


def read(reader: Path, report: Report) -> list[Entry]:
    xml = reporter("checkstyle")(report, texts, Style())
    run = subprocess.run([str(reader)], input=xml.encode(), stdout=subprocess.PIPE, check=True, timeout=60)
    (result,) = json.loads(run.stdout)
    return sorted(
        (file["Name"], error["Line"], error["Column"], error["Severity"], error["Message"], error["Source"])
        for file in result["Files"]
        for error in file["Errors"]
    )


def entry(issue: Issue) -> Entry:
    span, rule = issue.finding.span, issue.rule
    message = safe(f"{issue.finding.message} ({rule.code})", Style())
    return span.path, span.line, span.column, str(issue.severity), message, f"ros-lint.{rule.name}"


def test_the_reader_of_reviewdog_finds_every_finding(reader: Path) -> None:
    findings = [found for found in read(reader, EVERYTHING) if found[-1] != "ros-lint"]
    assert findings == sorted(entry(issue) for issue in EVERYTHING.issues)


def test_the_reader_of_reviewdog_returns_hostile_texts(reader: Path) -> None:
    issue = Issue(UNDECLARED, "arm", Finding(HOSTILE, Span('a "<b>"/x y.cpp', 3, 2, 3, 4), "x", severity=Severity.ERROR))
    assert read(reader, CLEAN._replace(issues=(issue,))) == [entry(issue)]
