"""The formats for other programs, read by these programs or by their grammar, with texts that try to break out of them."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any
from urllib.parse import unquote
from xml.etree import ElementTree

import jsonschema
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ros_lint.analysis.finding import Finding, Severity
from ros_lint.base.text import Span
from ros_lint.cli.main import main
from ros_lint.engine.report import Issue, Report
from ros_lint.reporters import reporter
from ros_lint.reporters.ansi import Style, safe
from tests.packages import manifest_text
from tests.reports import CLEAN, EVERYTHING, NOTHING, REPORTS, UNDECLARED, UNUSED, texts

COLCON = "import sys; from colcon_core.command import main; sys.exit(main(argv=sys.argv[1:]))"
HOSTILE = st.text("ab %;]:,\n\r\t|`*_<>&'\"[](){}#\\\x00\x1b\x85\u202e\ud800\ufffe\uffff/$!=-é", min_size=1, max_size=30)
URL = "https://example.org/rules/{rule}.html"


def rendered(form: str, report: Report) -> str:
    return reporter(form)(report, texts, Style())


def with_hostile(message: str, path: str, package: str) -> Report:
    span = Span(path, 3, 2, 3, 4)
    issues = tuple(
        Issue(rule, package, Finding(message, span, "x", severity=severity))
        for rule, severity in ((UNDECLARED, Severity.ERROR), (UNUSED, Severity.INFO))
    )
    return CLEAN._replace(issues=issues, package_names=(package,))


# --- XML -----------------------------------------------------------------------------------------------------------


@given(HOSTILE, HOSTILE, HOSTILE)
def test_xml_formats_are_well_formed_and_complete(message: str, path: str, package: str) -> None:
    report = with_hostile(message, path, package)
    files = ElementTree.fromstring(rendered("checkstyle", report).encode())
    assert [(error.get("severity"), error.get("line")) for error in files.iter("error")] == [("error", "3"), ("info", "3")]
    suite = ElementTree.fromstring(rendered("junit", report).encode())
    assert suite.tag == "testsuite"
    assert (suite.get("failures"), len(suite.findall("testcase/failure"))) == ("1", 1)
    assert int(suite.get("tests", "")) == len(suite.findall("testcase"))


@pytest.mark.parametrize(
    ("report", "code", "counts"),
    [("everything", 1, (13, 3, 4)), ("clean", 0, (3, 0, 0)), ("nothing", 1, (1, 1, 0))],
)
def test_colcon_test_result_counts_the_cases_of_junit(
    report: str, code: int, counts: tuple[int, int, int], tmp_path: Path
) -> None:
    (tmp_path / "ros_lint.xunit.xml").write_text(rendered("junit", REPORTS[report]), "utf-8")
    arguments = ["--log-base", os.devnull, "test-result", "--all", "--test-result-base", str(tmp_path)]
    run = subprocess.run([sys.executable, "-c", COLCON, *arguments], capture_output=True, text=True, check=False)
    assert tuple(map(int, re.findall(r"\d+", run.stdout.rpartition("Summary:")[2]))) == (*counts, 0)
    assert run.returncode == code


def test_junit_has_a_case_for_each_package_and_group_of_rules() -> None:
    suite = ElementTree.fromstring(rendered("junit", EVERYTHING).encode())
    names = {(case.get("classname"), case.get("name")) for case in suite.findall("testcase")}
    assert {(f"{package}.ros_lint", f"ROS{digit}xx") for package in ("arm", "hand", "talker") for digit in "125"} < names


# --- commands in logs ----------------------------------------------------------------------------------------------


@given(HOSTILE, HOSTILE)
def test_azure_commands_have_the_message_and_the_place(message: str, path: str) -> None:
    """The grammar is that of the agent: properties end at "]", values at ";"."""
    lines = rendered("azure", with_hostile(message, path, "talker")).split("\n")
    command = re.fullmatch(r"##vso\[task\.logissue (?P<properties>[^\]]*)\](?P<message>.*)", lines[0])
    assert command
    properties = dict(pair.split("=", 1) for pair in command["properties"].split(";") if pair)
    assert unquote(properties.pop("sourcepath").replace("%AZP25", "%25"), errors="strict") == safe(path, Style())
    assert properties == {"type": "error", "linenumber": "3", "columnnumber": "2", "code": "ROS201"}
    assert command["message"].replace("%AZP25", "%") == safe(f"{message} [undeclared-dependency]", Style())
    assert not [line for line in lines[1:] if "##vso[" in line]


def test_a_message_of_an_info_is_no_command() -> None:
    report = with_hostile("##vso[task.setvariable variable=x]y", "##vso[task.complete]", "talker")
    assert rendered("azure", report).count("##vso[") == 1  # the command about the error


# --- JSON ----------------------------------------------------------------------------------------------------------

POSITION = {
    "type": "object",
    "properties": {"line": {"type": "integer", "minimum": 1}, "column": {"type": "integer", "minimum": 1}},
    "required": ["line"],
    "additionalProperties": False,
}
RANGE = {
    "type": "object",
    "properties": {"start": POSITION, "end": POSITION},
    "required": ["start"],
    "additionalProperties": False,
}
LOCATION = {
    "type": "object",
    "properties": {"path": {"type": "string", "minLength": 1}, "range": RANGE},
    "required": ["path"],
    "additionalProperties": False,
}
RDJSON = {
    "type": "object",
    "properties": {
        "source": {"type": "object", "properties": {"name": {"type": "string"}, "url": {"type": "string"}}, "required": ["name"]},
        "diagnostics": {
            "type": "array",
            "items": {
                "type": "object",
                "properties": {
                    "message": {"type": "string", "minLength": 1},
                    "location": LOCATION,
                    "severity": {"enum": ["ERROR", "WARNING", "INFO"]},
                    "code": {"type": "object", "properties": {"value": {"type": "string"}, "url": {"type": "string"}}},
                    "suggestions": {
                        "type": "array",
                        "items": {"type": "object", "properties": {"range": RANGE, "text": {"type": "string"}}},
                    },
                    "related_locations": {
                        "type": "array",
                        "items": {"type": "object", "properties": {"message": {"type": "string"}, "location": LOCATION}},
                    },
                },
                "required": ["message", "location"],
                "additionalProperties": False,
            },
        },
    },
    "required": ["source", "diagnostics"],
    "additionalProperties": False,
}
"""The Reviewdog Diagnostic Format: the message DiagnosticResult of proto/rdf/reviewdog.proto."""


@pytest.mark.parametrize("name", REPORTS)
def test_rdjson_is_valid(name: str) -> None:
    jsonschema.validate(json.loads(rendered("rdjson", REPORTS[name])), RDJSON)


def test_columns_of_rdjson_count_bytes() -> None:
    diagnostics = json.loads(rendered("rdjson", EVERYTHING))["diagnostics"]
    foo = next(diagnostic for diagnostic in diagnostics if "declared by way of hand" in diagnostic["message"])
    start = foo["location"]["range"]["start"]
    line = (texts(foo["location"]["path"]) or pytest.fail("no source")).line(start["line"])
    assert line.encode()[start["column"] - 1 :].startswith(b"foo::Bar")


def test_jsonl_has_the_findings_and_the_run_of_json() -> None:
    lines = [json.loads(line) for line in rendered("jsonl", EVERYTHING).splitlines()]
    document = json.loads(rendered("json", EVERYTHING))
    assert [line["type"] for line in lines] == ["finding"] * len(EVERYTHING.issues) + ["run"]
    assert all(line["schema_version"] == document["schema_version"] for line in lines)
    findings = [{key: value for key, value in line.items() if key not in ("type", "schema_version")} for line in lines[:-1]]
    assert findings == document["findings"]
    assert {**lines[-1], "findings": findings} == {**document, "type": "run"}


def test_sarif_describes_only_rules_with_a_result_or_a_crash() -> None:
    def rules(report: Report) -> set[str]:
        return {rule["id"] for rule in json.loads(rendered("sarif", report))["runs"][0]["tool"]["driver"]["rules"]}

    assert rules(CLEAN) == set()
    assert rules(NOTHING) == set()
    assert rules(EVERYTHING._replace(issues=EVERYTHING.issues[:1])) == {EVERYTHING.issues[0].rule.code, "ROS102", "ROS204"}


# --- Markdown ------------------------------------------------------------------------------------------------------


@given(HOSTILE, HOSTILE, HOSTILE)
def test_markdown_tables_have_four_cells_and_no_markup(message: str, path: str, package: str) -> None:
    lines = rendered("markdown", with_hostile(message, path, package)).split("\n")
    rows = [line for line in lines if line.startswith(("| error", "| info"))]
    assert len(rows) == 2
    for row in rows:
        assert len(re.split(r"(?<!\\)(?:\\\\)*\|", row)) == 6
        assert not re.search(r"(?<!\\)(?:\\\\)*[`*<>\[\]#&]", row)
    assert not re.search(r"<(?!/?(?:details|summary|b)\b)", next(line for line in lines if line.startswith("<")))


def test_a_markdown_page_has_at_most_one_megabyte() -> None:
    issues = tuple(Issue(UNUSED, f"package_{number}", Finding("x" * 1000, Span("a", 1, 1, 1, 1), "x")) for number in range(2000))
    page = rendered("markdown", CLEAN._replace(issues=issues))
    assert len(page.encode()) < 1 << 20
    assert re.search(r"^\d+ more findings: see the log\.$", page, re.MULTILINE)


# --- links to the pages of rules -----------------------------------------------------------------------------------


def test_links_lead_to_the_page_of_the_rule() -> None:
    report = EVERYTHING._replace(rule_url=URL)
    page = "https://example.org/rules/dependency-cycle.html"
    assert json.loads(rendered("json", report))["findings"][0]["url"] == page
    assert json.loads(rendered("rdjson", report))["diagnostics"][0]["code"]["url"] == page
    assert f"[dependency-cycle]({page})" in rendered("markdown", report)
    rules = json.loads(rendered("sarif", report))["runs"][0]["tool"]["driver"]["rules"]
    assert rules[0]["helpUri"] == page
    head = "error[ROS102 dependency-cycle]"
    assert f"\x1b]8;;{page}\x1b\\{head}\x1b]8;;\x1b\\" in reporter("text")(report, texts, Style(rule_url=URL))
    assert "\x1b" not in rendered("text", report)


@pytest.mark.parametrize("url", ["rules/", "javascript:{rule}", "https://example.org/", "https://e.org/) [x](https://{rule}"])
def test_a_rule_url_without_a_place_for_the_rule_is_an_error(
    url: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([str(tmp_path), "--rule-url", url]) == 2
    assert "--rule-url: rule-url must be a URL with {rule}" in capsys.readouterr().err


# --- several outputs -----------------------------------------------------------------------------------------------


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    folder = tmp_path / "ws" / "arm"
    folder.mkdir(parents=True)
    (folder / "package.xml").write_text(manifest_text("arm", ["<exec_depend>rclcpp</exec_depend>"] * 2), "utf-8")
    return tmp_path / "ws"


def lint(workspace: Path, *arguments: str) -> int:
    return main([str(workspace), "--no-cache", "--distro", "jazzy", *arguments])


def test_a_run_writes_several_formats(workspace: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    sarif, junit = tmp_path / "out.sarif", tmp_path / "x.xml"
    code = lint(workspace, "--output", f"sarif:{sarif}", "--output", f"junit:{junit}", "--format", "concise")
    assert code == 1
    sys.stdout.flush()
    assert re.search(r"^arm/package.xml:\d+:\d+: error: .*", capfd.readouterr().out.replace(f"{workspace}/", ""), re.MULTILINE)
    assert json.loads(sarif.read_text("utf-8"))["version"] == "2.1.0"
    assert ElementTree.fromstring(junit.read_text("utf-8")).tag == "testsuite"


def test_a_file_without_a_format_replaces_standard_output(
    workspace: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    plain, extra = tmp_path / "out.json", tmp_path / "a:b.md"
    lint(workspace, "--format", "json", "--output", str(plain), "--output", f"markdown:{extra}")
    assert capfd.readouterr().out == ""
    assert json.loads(plain.read_text("utf-8"))["tool"] == "ros-lint"
    assert extra.read_text("utf-8").startswith("## ros-lint\n")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--output", "a", "--output", "b"], "--output: only one file can replace standard output"),
        (["--diff", "--output", "a"], "--diff prints a patch; redirect standard output"),
        (["--diff", "--format", "json"], "--diff prints a patch; redirect standard output"),
    ],
)
def test_contradicting_outputs_are_errors(
    arguments: list[str], message: str, workspace: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert lint(workspace, *arguments) == 2
    assert message in capsys.readouterr().err


def test_a_file_that_cannot_be_written_gives_exit_code_2_and_the_other_outputs(workspace: Path, tmp_path: Path) -> None:
    extra = tmp_path / "x.md"
    code = lint(workspace, "--output", f"sarif:{tmp_path}/no/out.sarif", "--output", f"markdown:{extra}", "--fail-on", "never")
    assert code == 2
    assert extra.exists()


def test_a_format_is_imported_only_if_it_is_chosen(workspace: Path) -> None:
    code = "import sys\nfrom ros_lint.cli.main import main\nmain(sys.argv[1:])\nprint(*sys.modules, file=sys.stderr)"
    run = subprocess.run(
        [sys.executable, "-c", code, str(workspace), "--format", "azure"], capture_output=True, text=True, check=True
    )
    loaded: set[Any] = {name for name in run.stderr.split() if name.startswith("ros_lint.reporters.")}
    assert loaded == {f"ros_lint.reporters.{name}" for name in ("ansi", "azure", "summary")}
