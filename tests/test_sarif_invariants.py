"""SARIF files meet the requirements of code scanning, and each check detects its defect."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from ros_lint.base.text import Span, Text
from ros_lint.cli.main import main
from ros_lint.reporters import sarif
from ros_lint.reporters.ansi import Style
from tests.reports import ISSUES, REPORTS, SOUND, SOURCES, texts
from tests.sarif_checks import changed, complaints

GOLDEN = Path(__file__).parent / "golden"


@pytest.mark.parametrize("name", REPORTS)
def test_golden_files_are_valid(name: str) -> None:
    text = (GOLDEN / f"{name}.sarif").read_text("utf-8")
    assert complaints(text, SOURCES.get) == []


@pytest.mark.parametrize("number", range(len(ISSUES)))
def test_reports_with_a_single_finding_are_valid(number: int) -> None:
    text = sarif.render(SOUND._replace(issues=ISSUES[number : number + 1]), texts, Style())
    assert complaints(text, SOURCES.get) == []


@pytest.mark.parametrize("column", [1, 500, 2990])
def test_a_part_of_a_long_line_is_quoted(column: int) -> None:
    source = Text("long", "x" * 3000 + "\n" + "y" * 3000)
    finding = ISSUES[0].finding._replace(span=Span("long", 1, column, 1, column + 5), related=(), fix=None, steps=False)
    text = sarif.render(SOUND._replace(issues=(ISSUES[0]._replace(finding=finding),)), lambda path: source, Style())
    assert complaints(text, lambda path: source.text.encode()) == []
    physical = json.loads(text)["runs"][0]["results"][0]["locations"][0]["physicalLocation"]
    assert 100 < len(physical["contextRegion"]["snippet"]["text"]) < 1000


def test_the_output_of_a_run_is_valid(tmp_path: Path) -> None:
    shutil.copytree(Path(__file__).parent.parent / "fixtures" / "workspaces" / "demo", tmp_path / "ws")
    (tmp_path / "ws" / ".git").mkdir()
    output = tmp_path / "found.sarif"
    assert main([str(tmp_path / "ws"), "--distro", "jazzy", "--pedantic", "--format", "sarif", "--output", str(output)]) == 1

    def tree(path: str) -> bytes | None:
        place = tmp_path / "ws" / path
        return place.read_bytes() if place.is_file() else None

    assert complaints(output.read_text("utf-8"), tree) == []
    results = json.loads(output.read_text("utf-8"))["runs"][0]["results"]
    assert {"ROS103", "ROS201", "ROS502"} <= {result["ruleId"] for result in results}


DOCUMENT: dict[str, Any] = json.loads((GOLDEN / "sound.sarif").read_text("utf-8"))
RESULT, RULE, DRIVER = "runs.0.results.0", "runs.0.tool.driver.rules.0", "runs.0.tool.driver"
REGION = f"{RESULT}.locations.0.physicalLocation.region"
DEFECTS = [
    ("version", "2.0.0", "schema"),
    ("runs.0.columnKind", "utf8", "schema"),
    (f"{REGION}.startLine", 0, "schema"),
    ("$schema", "https://example.org/", "$schema"),
    ("runs.0.automationDetails", None, "category"),
    ("runs.0.columnKind", "utf16CodeUnits", "columnKind"),
    ("runs.0.invocations.0.executionSuccessful", False, "unsuccessful"),
    ("runs.0.originalUriBaseIds.%SRCROOT%.uri", "file:///home/x/", "absolute path"),
    ("runs.0.originalUriBaseIds.%SRCROOT%.uri", "https://x/", "differs from machine to machine"),
    ("runs.0.versionControlProvenance", None, "versionControlProvenance"),
    (f"{DRIVER}.semanticVersion", "1.0", "semanticVersion"),
    (f"{DRIVER}.informationUri", None, "informationUri"),
    (f"{DRIVER}.notifications.0.help", None, "help"),
    ("runs.0.invocations.0.toolExecutionNotifications.0.descriptor.index", 4, "descriptor"),
    ("runs.0.invocations.0.toolExecutionNotifications.0.message.text", "no stop", "full stop"),
    (f"{RULE}.properties.security-severity", "5.0", "security-severity"),
    (f"{RULE}.properties.precision", "sure", "precision"),
    (f"{RULE}.properties.problem|severity", "note", "problem.severity"),
    (f"{RULE}.properties.tags", [f"t{n}" for n in range(11)], "tags"),
    (f"{RULE}.shortDescription.text", "x" * 1024 + ".", "shortDescription"),
    (f"{RULE}.fullDescription.text", "no stop", "fullDescription"),
    (f"{RULE}.name", "with space", "id or name"),
    (f"{RULE}.help", None, "help"),
    (f"{RULE}.helpUri", "relative", "helpUri"),
    (f"{RULE}.defaultConfiguration", None, "level"),
    (f"{RULE}.id", "ROS201", "two rules of one id"),
    (f"{RESULT}.ruleIndex", 1, "ruleIndex"),
    (f"{RESULT}.kind", "pass", "kind and level"),
    (f"{RESULT}.suppressions", [{"kind": "inSource"}], "GitHub shows it as open"),
    (f"{RESULT}.message.text", "See [it](7).", "links {7}"),
    (f"{RESULT}.message.text", "a [b] c.", "unescaped bracket"),
    (f"{RESULT}.message.text", "a", "full stop"),
    (f"{RESULT}.locations.0.physicalLocation.artifactLocation.uriBaseId", "ROOT", "uriBaseId"),
    (f"{RESULT}.locations.0.physicalLocation.artifactLocation.uri", "/a", "uri"),
    (f"{RESULT}.locations.0.physicalLocation.artifactLocation.uri", "a b", "uri"),
    (f"{RESULT}.locations.0.physicalLocation.artifactLocation.uri", "gone", "not there"),
    (f"{RESULT}.relatedLocations.0.physicalLocation.artifactLocation.uri", "ö", "uri"),
    (f"{RESULT}.codeFlows.0.threadFlows.0.locations.0.location.message.text", "x", "full stop"),
    (f"{REGION}.endLine", 5, "several lines"),
    (f"{REGION}.startColumn", 4, "snippet"),
    (f"{REGION}.snippet", None, "snippet"),
    (f"{REGION}.endColumn", 300, "columns"),
    (f"{RESULT}.locations.0.physicalLocation.contextRegion", None, "contextRegion"),
    (f"{RESULT}.locations.0.physicalLocation.contextRegion.startLine", 5, "not around it"),
    (f"{RESULT}.locations.0.physicalLocation.contextRegion.snippet.text", "other", "contextRegion"),
    (f"{RESULT}.partialFingerprints", {}, "one alert"),
    (f"{RESULT}.partialFingerprints.primaryLocationLineHash", "0:1", "fingerprint"),
    ("runs.0.results.1", DOCUMENT["runs"][0]["results"][0], "one alert"),
]


@pytest.mark.parametrize(("path", "value", "complaint"), DEFECTS, ids=[f"{path}={value!r:.20}" for path, value, _ in DEFECTS])
def test_defects_in_results_are_detected(path: str, value: object, complaint: str) -> None:
    result = complaints(changed(DOCUMENT, path, value), SOURCES.get)
    assert any(complaint in line for line in result)


def test_defects_in_the_file_are_detected() -> None:
    text = json.dumps(DOCUMENT)
    assert complaints("\ufeff" + text, SOURCES.get) == ["byte order mark"]
    assert complaints(text.replace('"version": "2.1.0"', '"version": "2.1.0", "x": NaN', 1), SOURCES.get)[0] == "constant NaN"
    assert "category" in complaints(json.dumps({**DOCUMENT, "runs": DOCUMENT["runs"] * 2}), SOURCES.get)


def test_fixes_equal_the_edits() -> None:
    results = DOCUMENT["runs"][0]["results"]
    fixes = [fix for result in results for fix in result.get("fixes", [])]
    expected = [issue.finding.fix for issue in SOUND.issues if issue.finding.fix]
    assert [fix["properties"]["safe"] for fix in fixes] == [fix.safe for fix in expected]
    for actual, fix in zip(fixes, expected, strict=True):
        replacements = [
            (change["artifactLocation"]["uri"], tuple(part["deletedRegion"].values()), part["insertedContent"]["text"])
            for change in actual["artifactChanges"]
            for part in change["replacements"]
        ]
        assert replacements == [(edit.span.path, edit.span[1:], edit.text) for edit in fix.edits]


def test_steps_are_a_code_flow() -> None:
    (flow,) = [result["codeFlows"] for result in DOCUMENT["runs"][0]["results"] if "codeFlows" in result]
    lines = [step["location"]["physicalLocation"]["region"]["startLine"] for step in flow[0]["threadFlows"][0]["locations"]]
    assert lines == [4, 3]
