"""The output of the reporters, compared with files (tests/golden, rewritten by ``pytest --bless``) and other implementations."""

from __future__ import annotations

import json
import re
from collections import Counter
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from hypothesis import given
from hypothesis import strategies as st

import ros_lint.reporters
from ros_lint.analysis.finding import Severity
from ros_lint.base.text import Span, Text, read
from ros_lint.engine.report import OFF, HiddenCount, Report
from ros_lint.reporters import FORMATS, reporter, sarif, statistics
from ros_lint.reporters.ansi import Style, glyph, safe
from ros_lint.reporters.fingerprint import line_hashes
from ros_lint.reporters.frames import Mark, frame
from ros_lint.reporters.github import command
from ros_lint.reporters.text import render_issues
from ros_lint.workspace.target import UnreadFile
from tests.reports import ARM, CLEAN, EVERYTHING, ISSUES, REPORTS, SOURCES, texts

GOLDEN = Path(__file__).parent / "golden"
NARROW = Style(width=100, fixes=True)
OUTPUTS = [
    *((f"{name}.{form}", name, form, Style()) for name in REPORTS for form in FORMATS),
    ("narrow.text", "everything", "text", NARROW),
    ("color.text", "everything", "text", NARROW._replace(color=True)),
    ("color.concise", "everything", "concise", Style(color=True)),
    ("ascii.text", "everything", "text", NARROW._replace(ascii=True)),
]


@pytest.mark.parametrize(("file", "name", "form", "style"), OUTPUTS, ids=[output[0] for output in OUTPUTS])
def test_the_output_equals_the_golden_file(file: str, name: str, form: str, style: Style, request: pytest.FixtureRequest) -> None:
    actual = reporter(form)(REPORTS[name], texts, style)
    if request.config.getoption("bless"):
        (GOLDEN / file).write_text(actual, "utf-8", newline="")
    with (GOLDEN / file).open(encoding="utf-8", newline="") as file_:
        assert actual == file_.read()


def test_an_unknown_format_raises_an_error() -> None:
    with pytest.raises(KeyError):
        reporter("word")


@pytest.mark.parametrize("form", FORMATS)
def test_control_characters_are_escaped_in_every_format(form: str) -> None:
    actual = reporter(form)(EVERYTHING, texts, NARROW)
    assert not re.search("[\x00-\x09\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\ud800-\udfff]", actual)
    assert actual.endswith("\n")
    assert actual.encode("utf-8")


@pytest.mark.parametrize("form", FORMATS)
def test_findings_in_unreadable_files_are_shown(form: str) -> None:
    actual = reporter(form)(EVERYTHING, lambda path: None, NARROW)
    for issue in ISSUES:
        assert issue.rule.name in actual or issue.rule.code in actual
        assert issue.finding.message.split()[0] in actual


def test_ascii_output_has_ascii_characters_only() -> None:
    for form in ("text", "concise"):
        assert reporter(form)(EVERYTHING, texts, NARROW._replace(ascii=True)).isascii()


def test_colours_do_not_change_the_text() -> None:
    for form in ("text", "concise"):
        colored = reporter(form)(EVERYTHING, texts, NARROW._replace(color=True))
        assert re.sub(r"\x1b\[[0-9;]*m", "", colored) == reporter(form)(EVERYTHING, texts, NARROW)


# --- text ----------------------------------------------------------------------------------------------------------


def test_a_problem_matcher_parses_the_concise_format() -> None:
    lines = reporter("concise")(EVERYTHING, texts, Style()).split("\n")
    result = [m for line in lines if (m := re.match(r"^(.+?):(\d+):(\d+): (error|warning|info): (.+) \[([a-z-]+)\]$", line))]
    assert [(m[1], int(m[2]), int(m[3]), m[4], m[6]) for m in result] == [
        (i.finding.span.path, i.finding.span.line, i.finding.span.column, str(i.severity), i.rule.name) for i in ISSUES
    ]


def test_issues_alone_have_no_summary() -> None:
    actual = render_issues(ISSUES, texts)
    assert actual.count("\n\n") == len(ISSUES) - 1
    assert "Found" not in actual


def test_infos_of_one_rule_and_package_are_one_block() -> None:
    end = next(issue for issue in ISSUES if issue.finding.subject == "end")
    foo = next(issue for issue in ISSUES if issue.finding.subject == "foo")
    std_msgs = next(issue for issue in ISSUES if issue.finding.subject == "std_msgs")
    fix = std_msgs.finding.fix
    assert fix is not None
    info = foo._replace(finding=foo.finding._replace(severity=Severity.INFO, fix=fix))
    unsafe = end._replace(finding=end.finding._replace(fix=fix._replace(safe=False)))
    assert render_issues([info, std_msgs, end, unsafe], texts).split("\n\n")[0] == (
        "info[ROS203 transitive-dependency]: 3 findings; expected: what is used is declared itself\n"
        " --> ws/talker/src/talker.cpp:2:43: foo is declared by way of hand only (medium confidence)\n"
        " --> ws/talker/src/talker.cpp:5:1: the end\n"
        " --> ws/talker/src/talker.cpp:5:1: the end\n"
        "  = fix: 1 of them (--fix)\n"
        "  = fix: 1 of them (--fix --unsafe-fixes, may change behaviour)"
    )
    assert render_issues([info, info], texts, NARROW).count(fix.edits[0].text.strip()) == 1


def test_only_infos_of_one_rule_and_package_are_one_block() -> None:
    end = next(issue for issue in ISSUES if issue.finding.subject == "end")
    argument = next(issue for issue in ISSUES if issue.finding.subject == "x")
    warning = end._replace(finding=end.finding._replace(severity=Severity.WARNING))
    assert "findings of" not in render_issues([end, argument, end._replace(package="arm"), warning, warning], texts)


def test_packages_with_errors_come_first_and_so_do_errors_in_a_package() -> None:
    warning = next(issue for issue in ISSUES if issue.severity is Severity.WARNING)
    error = warning._replace(finding=warning.finding._replace(severity=Severity.ERROR, message="the error"))
    info = warning._replace(finding=warning.finding._replace(severity=Severity.INFO, message="the info"))
    shown = EVERYTHING._replace(issues=(info._replace(package="a"), info, warning, error))
    lines = reporter("text")(shown, texts, Style()).splitlines()
    order = [f"{warning.package}: 3 findings", "error[", "warning[", "info[", "a: 1 finding", "info["]
    assert [line for line in lines if line.startswith(tuple(order))] == [
        next(line for line in lines if line.startswith(start)) for start in order
    ]


def test_a_quiet_style_has_findings_and_no_summary() -> None:
    for form in ("text", "concise"):
        loud, quiet = (reporter(form)(EVERYTHING, texts, Style(summary=wanted)) for wanted in (True, False))
        assert loud.startswith(quiet)
        assert loud[len(quiet) :].startswith("Found ")


def test_statistics_count_the_findings_of_each_rule() -> None:
    table = statistics.render(EVERYTHING, texts, Style(summary=False)).splitlines()
    counts = Counter((issue.rule.name, str(issue.severity)) for issue in ISSUES)
    rows = [line.split() for line in table]
    assert {(name, severity): int(number) for number, severity, _, name, *_ in rows} == counts
    assert [int(number) for number, *_ in rows] == sorted(counts.values(), reverse=True)
    fixable = Counter((issue.rule.name, str(issue.severity)) for issue in ISSUES if issue.finding.fix)
    assert {(name, severity): int(number) for _, severity, _, name, number, _ in rows} == {key: fixable[key] for key in counts}
    assert statistics.render(CLEAN, texts, Style()).startswith("No problems found")


@pytest.mark.parametrize("form", ["text", "concise", "github"])
def test_what_pedantic_adds_is_counted_by_rule(form: str) -> None:
    got = reporter(form)(EVERYTHING, texts, Style())
    assert "10 more findings with --pedantic: transitive-dependency 6, undeclared-dependency 3, dead-group 1" in got
    many = HiddenCount(OFF, 8, tuple((f"rule-{n}", 2 if n < 2 else 1) for n in range(6)))
    got = reporter(form)(EVERYTHING._replace(hidden=(many,)), texts, Style())
    assert "8 more findings with --pedantic: rule-0 2, rule-1 2, rule-2 1, rule-3 1, rule-4 1, other rules 1" in got


@pytest.mark.parametrize("form", ["text", "concise", "github"])
def test_long_lists_are_shortened_with_a_note(form: str) -> None:
    entries = tuple(UnreadFile(f"file {n}", "gone", None) for n in range(30))
    actual = reporter(form)(EVERYTHING._replace(not_checked=entries), texts, Style())
    assert "and 20 more; --format json lists all of them" in actual


def flat(source: Text, span: Span, style: Style = Style(width=60)) -> tuple[str, str]:  # noqa: B008
    """Return the source row of a mark in one line, and what stands over the carets, in columns."""
    rows, _ = frame([Mark(span, "", "error", "^")], lambda path: source, style)
    head, carets = rows[-2], rows[-1]
    assert re.fullmatch(r" *\| +\^+", carets)
    shown = head.partition(" | ")[2] if " | " in head else head.partition(" |")[2]
    columns = "".join(c + "\0" * (glyph(c, False)[1] - 1) if glyph(c, False)[1] else "" for c in shown)
    offset = head.index("|") + 2
    return shown, columns[carets.index("^") - offset : carets.rindex("^") + 1 - offset].replace("\0", "")


@pytest.mark.parametrize(
    ("line", "words", "over"),
    [
        ("abc def", "def", "def"),
        ("\ta\tb", "b", "b"),
        ("日本 x", "x", "x"),
        ("日本 x", "本", "本"),
        ("e\u0301e\u0301 x", "x", "x"),
        ("\x1b[31m x", "x", "x"),
        ("\u202eabc\u202c x", "x", "x"),
        ("caf\udce9 x", "x", "x"),
        ("ᄒ\u1161\u11ab x", "x", "x"),
        ("😀👍 x", "x", "x"),
        ("-" * 500 + "x" + "-" * 500, "x", "x"),
        ("日" * 500 + "x" + "本" * 500, "x", "x"),
        ("abc", "", ""),
    ],
)
def test_carets_are_below_the_marked_words(line: str, words: str, over: str) -> None:
    source = Text("a", f"before\n{line}\nafter")
    start = source.text.index(words or "c\n") + (1 if not words else 0)
    assert flat(source, source.span(start, start + len(words)))[1] == over


def test_characters_are_escaped() -> None:
    shown = [safe(text, Style()) for text in ("\udce9", "\x9b", "\u202e", "\U000e0041", "ä", "a\tb")]
    assert shown == ["\\xe9", "\\x9b", "\\u202e", "\\U000e0041", "ä", "a    b"]
    assert safe("ä\uffff\U00010000", Style(ascii=True)) == "\\xe4\\uffff\\U00010000"


def framed(lines: list[str], *places: tuple[int, int, int, int], width: int = 60) -> list[str]:
    """Return the rows of a frame, without the one that names the file."""
    marks = [Mark(Span("a", *place), f"label {number}", "error", "^") for number, place in enumerate(places)]
    return frame(marks, lambda path: Text("a", "\n".join(lines)), Style(width=width))[0][2:]


def test_one_line_between_two_places_is_shown_and_more_are_not() -> None:
    assert framed(["a", "b", "c", "d", "e", "f"], (1, 1, 1, 2), (3, 1, 3, 2), (6, 1, 6, 2)) == [
        *("1 | a", "  | ^ label 0", "2 | b", "3 | c", "  | ^ label 1", "... |", "6 | f", "  | ^ label 2"),
    ]


def test_places_of_several_lines_have_a_bar() -> None:
    assert framed(["a b", "c", "d", "  e", "f", "g"], (1, 3, 2, 2), (4, 3, 6, 1)) == [
        *("1 |   a b", "  |  ___^", "2 | | c", "  | |_^ label 0"),
        *("3 |   d", "4 | /   e", "5 | | f", "  | |_^ label 1"),
    ]


def test_overlapping_places_are_shown_separately() -> None:
    assert framed(["a b", "c", "d", "e"], (1, 1, 3, 2), (2, 1, 4, 2)) == [
        *("1 | / a b", "2 | | c", "  | | ^ label 1", "3 | | d", "  | |_^ label 0"),
    ]


def test_only_lines_that_are_too_long_are_shortened() -> None:
    room = 60 - len("1 | ")
    for length, complete in ((room, True), (room + 1, False)):
        line = "x" * (length - 1) + "y"
        row, carets = framed([line], (1, length, 1, length + 1))
        assert (row == f"1 | {line}") is complete
        assert row[carets.index("^")] == "y"
    assert framed(["x" * 200], (1, 1, 1, 2))[0] == f"1 | {'x' * (room - 3)}..."
    assert framed(["x" * 200 + "y"], (1, 201, 1, 202))[0] == f"1 | ...{'x' * 20}y"


LINES = st.text(st.sampled_from("ab \t日e\u0301\x1b\u202e\udce9😀\u200d-"), max_size=90)


@given(st.lists(LINES, min_size=1, max_size=12), st.data())
def test_frames_of_random_marks_fit_the_width(lines: list[str], data: st.DataObject) -> None:
    source = Text("a", "\n".join(lines))
    offsets = st.integers(0, len(source.text))
    marks = []
    for _ in range(data.draw(st.integers(1, 4))):
        start, end = sorted((data.draw(offsets), data.draw(offsets)))
        marks.append(Mark(source.span(start, end), data.draw(st.sampled_from(["", "label"])), "error", "^"))
    rows, _ = frame(marks, lambda path: source, Style(width=60))
    assert sum("label" in row for row in rows) == sum(bool(mark.label) for mark in marks)
    for row in rows:
        assert sum(glyph(character, False)[1] for character in row.removesuffix(" label")) <= 62
        assert not re.search("[\x00-\x1f\u202e\ud800-\udfff]", row)


def test_spans_beyond_the_end_of_the_file_are_limited() -> None:
    source = Text("a", "x\ny")
    for span in (Span("a", 1, 1, 9, 9), Span("a", 1, 9, 1, 12), Span("a", 9, 1, 9, 2), Span("a", 2, 2, 2, 2)):
        rows, _ = frame([Mark(span, "label", "error", "^")], lambda path: source, Style())
        assert sum("label" in row for row in rows) == 1


# --- json ----------------------------------------------------------------------------------------------------------

SCHEMA = json.loads(Path(ros_lint.reporters.__file__).with_name("report.schema.json").read_text("utf-8"))


def strict(schema: Any) -> Any:
    """Return a schema that allows no key it does not name, whatever comes with a later release."""
    if isinstance(schema, dict):
        closed = {"unevaluatedProperties": False} if "properties" in schema and schema is not SCHEMA["$defs"]["place"] else {}
        return {key: strict(value) for key, value in schema.items()} | closed
    return [strict(entry) for entry in schema] if isinstance(schema, list) else schema


@pytest.mark.parametrize("name", REPORTS)
def test_json_is_valid_for_its_schema(name: str) -> None:
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    document = json.loads(reporter("json")(REPORTS[name], texts, Style()))
    jsonschema.validate(document, strict(SCHEMA), jsonschema.Draft202012Validator)


@pytest.mark.parametrize(
    ("key", "value"), [("schema_version", 2), ("packages", -1), ("findings", [{}]), ("summary", {}), ("more", 1)]
)
def test_the_schema_rejects_invalid_reports(key: str, value: object) -> None:
    document = json.loads(reporter("json")(EVERYTHING, texts, Style())) | {key: value}
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(document, strict(SCHEMA), jsonschema.Draft202012Validator)


def keys(schema: Any) -> set[str]:
    if isinstance(schema, list):
        return set().union(*map(keys, schema))
    if not isinstance(schema, dict):
        return set()
    return set(schema.get("properties", ())).union(*map(keys, schema.values()))


def test_every_key_is_in_the_docs() -> None:
    docs = (Path(__file__).parent.parent / "docs" / "output.md").read_text("utf-8")
    section = docs.partition("## json\n")[2].partition("\n## ")[0]
    assert keys(SCHEMA) <= set(re.findall(r"`([a-z0-9_]+)`", section))


def test_json_contains_the_whole_report() -> None:
    document = json.loads(reporter("json")(EVERYTHING, texts, Style()))
    for result, issue in zip(document["findings"], ISSUES, strict=True):
        finding = issue.finding
        assert (result["rule"], result["code"], result["package"]) == (issue.rule.name, issue.rule.code, issue.package)
        assert Span(*(result[key] for key in Span._fields)) == finding.span
        assert (result["message"], result["subject"], result["steps"]) == (finding.message, finding.subject, finding.steps)
        assert [(r["message"], Span(*(r[key] for key in Span._fields))) for r in result["related"]] == list(finding.related)
        assert (result["fix"] is None) is (finding.fix is None)
        if finding.fix:
            edits = [(Span(*(e[key] for key in Span._fields)), e["text"]) for e in result["fix"]["edits"]]
            assert (result["fix"]["title"], result["fix"]["safe"], edits) == (
                finding.fix.title,
                finding.fix.safe,
                [(edit.span, edit.text) for edit in finding.fix.edits],
            )
    assert document["summary"] == {"error": 3, "warning": 7, "info": 2, "fixable": 1, "unsafely_fixable": 1}


def test_json_has_one_finding_per_line() -> None:
    lines = reporter("json")(EVERYTHING, texts, Style()).splitlines()
    assert sum('"code": ' in line for line in lines) == len(ISSUES)


# --- github --------------------------------------------------------------------------------------------------------

COMMANDS = json.loads((GOLDEN / "workflow_commands.json").read_text("utf-8"))


@pytest.mark.parametrize("case", COMMANDS, ids=range(len(COMMANDS)))
def test_workflow_commands_are_those_of_actions_core(case: dict[str, Any]) -> None:
    """The lines were printed by @actions/core 3.0.1."""
    assert command(case["level"], case["properties"], case["message"]) == case["line"]


def commands(report: Report) -> list[str]:
    return [line for line in reporter("github")(report, texts, Style()).split("\n") if line.startswith("::")]


def test_the_most_severe_annotations_come_first() -> None:
    levels = [line[2:].partition(" ")[0] for line in commands(EVERYTHING._replace(not_checked=(), crashes=()))]
    assert levels == sorted(levels, key=("error", "warning", "notice").index)


def test_annotations_that_github_does_not_show_are_announced() -> None:
    issue = next(issue for issue in ISSUES if issue.severity is Severity.WARNING)
    for number, announced in ((10, False), (11, True)):
        lines = commands(EVERYTHING._replace(issues=(issue,) * number, not_checked=(), crashes=()))
        assert len(lines) == number + announced
        assert ("11 warnings" in lines[-1]) is announced


def test_a_finding_cannot_inject_a_workflow_command() -> None:
    hostile = ISSUES[0].finding._replace(message="x\n::error::y\r::warning::z")
    lines = reporter("github")(EVERYTHING._replace(issues=(ISSUES[0]._replace(finding=hostile),)), texts, Style())
    assert not re.search(r"^::error::y|^::warning::z", lines.replace("\r", "\n"), re.MULTILINE)


# --- gitlab --------------------------------------------------------------------------------------------------------

PLACE = {"type": "object", "required": ["begin"], "properties": {"begin": {"type": "integer", "minimum": 1}}}
TEXT = {"type": "string", "minLength": 1}
QUALITY = {
    "type": "array",
    "items": {
        "type": "object",
        "required": ["description", "check_name", "fingerprint", "severity", "location"],
        "properties": {
            "description": TEXT,
            "check_name": TEXT,
            "fingerprint": TEXT,
            "severity": {"enum": ["info", "minor", "major", "critical", "blocker"]},
            "location": {
                "type": "object",
                "required": ["path", "lines"],
                "properties": {"path": {**TEXT, "pattern": "^(?![./])"}, "lines": PLACE},
            },
        },
    },
}
"""What the documentation of GitLab asks of a report of code quality."""


def quality(report: Report) -> list[dict[str, Any]]:
    entries: list[dict[str, Any]] = json.loads(reporter("gitlab")(report, texts, Style()))
    return entries


@pytest.mark.parametrize("name", REPORTS)
def test_gitlab_fingerprints_are_unique_and_the_report_is_valid(name: str) -> None:
    entries = quality(REPORTS[name])
    jsonschema.validate(entries, QUALITY)
    assert len({entry["fingerprint"] for entry in entries}) == len(entries)


def test_findings_keep_their_fingerprints_when_lines_move() -> None:
    moved = tuple(
        issue._replace(finding=issue.finding._replace(span=issue.finding.span._replace(line=issue.finding.span.line + 7)))
        for issue in ISSUES
    )
    before, after = (quality(EVERYTHING._replace(issues=issues)) for issues in (ISSUES, moved))
    assert [entry["fingerprint"] for entry in before] == [entry["fingerprint"] for entry in after]


# --- sarif: see also test_sarif_invariants.py ----------------------------------------------------------------------

HASHES = json.loads((GOLDEN / "line_hashes.json").read_text("utf-8"))


@pytest.mark.parametrize("case", HASHES, ids=lambda case: case["name"])
def test_line_hashes_are_those_of_microsoft(case: dict[str, Any]) -> None:
    """The hashes were computed by Sarif.Multitool 5.7.0 (rewrite --insert RollingHashPartialFingerprints)."""
    source = read(case["name"], case["bytes"].encode("latin-1"))
    expected = range(1, len(case["hashes"]) + 1)
    assert list(line_hashes(source, expected).values()) == case["hashes"]
    assert line_hashes(source, [expected[-1]]) == {expected[-1]: case["hashes"][-1]}
    assert line_hashes(source, [expected[-1] + 1]) == {}


def run_of(report: Report) -> dict[str, Any]:
    run: dict[str, Any] = json.loads(reporter("sarif")(report, texts, Style()))["runs"][0]
    return run


def test_sarif_keeps_the_most_severe_results(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sarif, "_RESULTS", 4)
    complete = run_of(EVERYTHING._replace(issues=ISSUES))
    assert [result["level"] for result in complete["results"]].count("error") == 2
    assert len(complete["results"]) == 4
    notes = complete["invocations"][0]["toolExecutionNotifications"]
    assert notes[-1]["message"]["text"] == "7 results of the lowest severity are left out, because GitHub accepts at most 4."


def test_two_findings_of_a_rule_in_a_line_are_one_result() -> None:
    issues = tuple(issue for issue in ISSUES if issue.rule.name == "undeclared-dependency")
    (result,) = run_of(EVERYTHING._replace(issues=issues))["results"]
    assert len(issues) == 2
    assert "rclcpp is used" in result["message"]["text"]
    assert "Also [std_msgs is used, but package.xml does not declare it](1)." in result["message"]["text"]
    assert result["relatedLocations"][0]["physicalLocation"]["region"]["startColumn"] == 41
    assert result["partialFingerprints"]["rosLint/v1"] == "ROS201/talker/rclcpp ROS201/talker/std_msgs"
    assert len(result["fixes"]) == 1


def test_a_fix_of_several_findings_in_a_line_is_listed_once() -> None:
    issues = [issue for issue in ISSUES if issue.rule.name == "undeclared-dependency"]
    (fix,) = [issue.finding.fix for issue in issues if issue.finding.fix]
    both = tuple(issue._replace(finding=issue.finding._replace(fix=fix)) for issue in issues)
    (result,) = run_of(EVERYTHING._replace(issues=both))["results"]
    assert len(result["fixes"]) == 1


@pytest.mark.parametrize(
    ("version", "semantic"),
    [("1.2.3", "1.2.3"), ("1.2", "1.2.0"), ("1.2.3rc1", "1.2.3-rc1"), ("1.2.3.dev4+gabc", "1.2.3-dev4.gabc"), ("x", "0.0.0-x")],
)
def test_versions_are_converted_to_semantic_versions(version: str, semantic: str) -> None:
    driver = run_of(EVERYTHING._replace(version=version))["tool"]["driver"]
    assert (driver["version"], driver["semanticVersion"]) == (version, semantic)


def test_a_moved_line_keeps_its_fingerprint() -> None:
    issue = next(issue for issue in ISSUES if issue.finding.span.path == ARM)
    span = issue.finding.span
    moved = issue._replace(finding=issue.finding._replace(span=span._replace(line=span.line + 1, end_line=span.end_line + 1)))
    pushed = read(ARM, SOURCES[ARM].replace(b"\r\n<package", b"\r\n<!-- new -->\r\n<package"))
    before = run_of(EVERYTHING._replace(issues=(issue,)))["results"][0]["partialFingerprints"]
    after = json.loads(sarif.render(EVERYTHING._replace(issues=(moved,)), lambda path: pushed, Style()))["runs"][0]
    assert after["results"][0]["partialFingerprints"] == before
