"""Which rules run, which findings are shown, and what a report counts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import pytest

from ros_lint.analysis.finding import Confidence, Consequence, Finding, Severity
from ros_lint.analysis.rule import Rule
from ros_lint.base.text import Span
from ros_lint.base.tree import MemoryTree
from ros_lint.engine.check import ReportContext, check
from ros_lint.engine.report import EXPLAINED, MINOR, OFF, UNSURE, HiddenCount, Issue, Report
from ros_lint.engine.run import run_rules
from ros_lint.engine.selection import Selection, SelectionError, check_selectors, matches, select, show
from ros_lint.workspace.loader import Loader
from ros_lint.workspace.model import Package, Workspace
from ros_lint.workspace.target import TargetDistro
from tests.packages import manifest_text


def rule(name: str, code: str, *, default: bool = True, **checks: Any) -> Rule:
    return Rule(name, code, "s", Severity.WARNING, "0.1", "", default=default, **checks)


RULES = (rule("one", "ROS101"), rule("two", "ROS102"), rule("three", "ROS201", default=False), rule("mine", "ROSX101"))


def names(selection: Selection) -> str:
    return " ".join(one.name for one in selection.rules)


# --- rules ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("settings", "selected", "named", "off"),
    [
        ({}, "one two mine", "", "three"),
        ({"chosen": ("all",)}, "one two three mine", "", ""),
        ({"chosen": ("two", "one")}, "one two", "one two", ""),
        ({"chosen": ("ROS1",)}, "one two", "one two", ""),
        ({"chosen": ("ROS",)}, "one two three", "one three two", ""),
        ({"chosen": ("ROS201",)}, "three", "three", ""),
        ({"added": ("three",)}, "one two three mine", "three", ""),
        ({"ignored": ("one", "three")}, "two mine", "", ""),
        ({"ignored": ("ROS1",)}, "mine", "", "three"),
        ({"pedantic": True}, "one two three mine", "", ""),
        ({"pedantic": True, "chosen": ("one",)}, "one two three mine", "", ""),
        ({"severities": {"three": "error"}}, "one two three mine", "", ""),
        ({"severities": {"three": "off", "one": "off"}}, "two mine", "", ""),
        ({"severities": {"three": "error"}, "ignored": ("three",)}, "one two mine", "", ""),
    ],
)
def test_the_settings_select_rules(settings: dict[str, Any], selected: str, named: str, off: str) -> None:
    selection = select(RULES, **settings)
    assert (names(selection), " ".join(sorted(selection.named))) == (selected, named)
    assert " ".join(one.name for one in selection.off) == off


@pytest.mark.parametrize(
    "settings",
    [{"chosen": ("on",)}, {"added": ("ROS3",)}, {"ignored": ("x",)}, {"severities": {"x": "off"}}, {"per_path": {"*": ["x"]}}],
)
def test_a_selector_that_matches_no_rule_is_an_error(settings: dict[str, Any]) -> None:
    with pytest.raises(SelectionError, match="unknown rule"):
        select(RULES, **settings)
    with pytest.raises(SelectionError, match="unknown rule 'x'"):
        check_selectors(RULES, ["one", "x"])
    check_selectors(RULES, ["one", "ROS2", "all", "default"])


@pytest.mark.parametrize(
    ("pattern", "matching"),
    [
        ("*.py", ["src/a/setup.py", "setup.py"]),
        ("a", ["src/a/setup.py", "src/a/b/c.txt"]),
        ("b/", ["src/a/b/c.txt"]),
        ("src/a", ["src/a/setup.py", "src/a/b/c.txt"]),
        ("src/*/setup.py", ["src/a/setup.py"]),
        ("a/b", []),
        ("SETUP.PY", []),
    ],
)
def test_a_pattern_without_a_slash_matches_names_and_folders(pattern: str, matching: list[str]) -> None:
    assert [path for path in ("src/a/setup.py", "src/a/b/c.txt", "setup.py") if matches(path, pattern)] == matching


# --- findings ------------------------------------------------------------------------------------------------------


def issue(of: Rule, path: str = "p/a.py", **finding: Any) -> Issue:
    return Issue(of, "p", Finding("m", Span(path, 1, 1, 1, 2), finding.pop("subject", "s"), **finding))


def test_hidden_findings_are_counted_by_reason() -> None:
    one, two, three, _ = RULES
    unsure = issue(two, confidence=Confidence.MEDIUM)
    settings: dict[str, Any] = {"per_path": {"gen": ["one"]}, "min_severity": "warning", "severities": {"three": "info"}}
    issues = [
        issue(one),
        issue(one, "p/gen/a.py"),
        unsure,
        issue(one, confidence=Confidence.LOW),
        issue(two, severity=Severity.INFO),
        issue(two, severity=Severity.INFO, confidence=Confidence.LOW),
        issue(three),
    ]
    shown, hidden = show(issues, select(RULES, **settings))
    assert shown == (issues[0],)
    assert hidden == (
        HiddenCount(UNSURE, 2, (("one", 1), ("two", 1))),
        HiddenCount("ignored by per-path-ignores", 1),
        HiddenCount(MINOR, 2),
    )
    assert show([unsure], select(RULES, chosen=("two",)))[0] == (unsure,)
    assert show([unsure], select(RULES, pedantic=True)) == ((unsure,), ())


def test_the_severity_of_the_settings_replaces_that_of_the_finding() -> None:
    selection = select(RULES, severities={"one": "error"})
    ((shown,), _) = show([issue(RULES[0], severity=Severity.INFO)], selection)
    assert shown.severity is Severity.ERROR
    ((shown,), _) = show([issue(RULES[1], severity=Severity.INFO)], selection)
    assert shown.severity is Severity.INFO


def test_explained_findings_are_counted() -> None:
    cause = issue(RULES[0], explains=(Consequence("two", "s"),))
    shown, hidden = show([cause, issue(RULES[1]), issue(RULES[1], confidence=Confidence.LOW)], select(RULES, chosen=("ROS",)))
    assert [[explained.rule for explained in one.explained] for one in shown] == [["two", "two"]]
    assert hidden == (HiddenCount(EXPLAINED, 2),)


# --- reports -------------------------------------------------------------------------------------------------------


def loaded(**manifests: str) -> Sequence[Workspace]:
    files = {f"{name.replace('__', '/')}/package.xml": text for name, text in manifests.items()}
    return Loader(MemoryTree(files), ("",), TargetDistro("jazzy", "test")).load_all()


TWO = {"a__p": manifest_text("p"), "b__q": manifest_text("q")}


def of_packages(package: Package, _: Workspace) -> Iterator[Finding]:
    yield Finding(f"of {package.name}", Span(f"{package.path}/package.xml", 1, 1, 1, 2), package.name)


def of_workspace(workspace: Workspace) -> Iterator[Finding]:
    yield Finding("of q", Span("a/p/package.xml", 2, 1, 2, 2), "x", package="q")
    yield Finding("in p", Span("a/p/package.xml", 3, 1, 3, 2), "x")
    yield Finding("elsewhere", Span("README", 1, 1, 1, 2), "x")


@pytest.mark.parametrize(
    ("folders", "expected"),
    [
        (("",), {"of p": "p", "of q": "q", "in p": "p", "elsewhere": ""}),
        (("a",), {"of p": "p", "in p": "p"}),
        (("b",), {"of q": "q"}),
        (("README",), {"elsewhere": ""}),
    ],
)
def test_findings_are_those_about_the_requested_folders(folders: tuple[str, ...], expected: dict[str, str]) -> None:
    (workspace,) = loaded(**TWO)
    rules = (rule("one", "ROS101", package=of_packages), rule("two", "ROS102", workspace=of_workspace))
    issues, crashes = run_rules(workspace, rules, folders)
    assert ({issue.finding.message: issue.package for issue in issues}, crashes) == (expected, ())
    assert [issue.finding.span for issue in issues] == sorted(issue.finding.span for issue in issues)
    assert len(issues) == len(expected) + (folders in {("",), ("b",)})  # two rules find "of q"


def report_of(workspaces: Sequence[Workspace], *rules: Rule, folders: tuple[str, ...] = ("",), **settings: Any) -> Report:
    return check(workspaces, (), select(rules, **settings), ReportContext(rules, "2026-01-01", folders, ("careful",)))


def test_a_report_counts_the_packages_of_the_requested_folders() -> None:
    workspaces = loaded(**TWO, c="<package><name>r</name></package>")
    report = report_of(workspaces, *RULES)
    assert (report.packages, report.context_packages, report.workspace, report.package_names) == (3, 0, "", ("p", "q", "r"))
    report = report_of(workspaces, *RULES, folders=("a",))
    assert (report.packages, report.context_packages, report.workspace, report.package_names) == (1, 2, "a", ("p",))
    report = report_of(workspaces, *RULES, folders=("a", "b"))
    assert (report.packages, report.context_packages, report.workspace, report.package_names) == (2, 1, "", ("p", "q"))
    assert (report.data_date, report.warnings, [one.name for one in report.rules]) == (
        "2026-01-01",
        ("careful",),
        ["one", "two", "mine"],
    )


def test_a_crash_of_a_rule_hides_no_finding_of_another() -> None:
    def crashing(package: Package, _: Workspace) -> Iterator[Finding]:
        if package.name == "q":
            raise ValueError("no q")
        yield from of_packages(package, _)

    report = report_of(loaded(**TWO), rule("one", "ROS101", package=crashing), rule("two", "ROS102", package=of_packages))
    assert [(issue.rule.name, issue.package) for issue in report.issues] == [("one", "p"), ("two", "p"), ("two", "q")]
    assert [(crash.rule, crash.package, crash.error, crash.plugin) for crash in report.crashes] == [
        ("one", "q", "ValueError: no q", "")
    ]


def test_findings_of_rules_that_are_off_are_counted_as_they_would_be_shown() -> None:
    rules = (rule("one", "ROS101"), rule("two", "ROS102", default=False, package=of_packages))
    assert report_of(loaded(**TWO), *rules).hidden == (HiddenCount(OFF, 2, (("two", 2),)),)
    assert report_of(loaded(**TWO), *rules, per_path={"a": ["two"]}).hidden == (HiddenCount(OFF, 1, (("two", 1),)),)
    assert report_of(loaded(**TWO), *rules, min_severity="error").hidden == ()
    assert report_of(loaded(**TWO), *rules, chosen=("one",)).hidden == ()
