"""Findings that explain others are shown in place of them."""

from __future__ import annotations

from collections.abc import Iterable

import pytest

from ros_lint.analysis.finding import Confidence, Consequence, Finding, Severity
from ros_lint.analysis.rule import Rule
from ros_lint.base.text import Span
from ros_lint.engine import registry
from ros_lint.engine.explanations import without_explained
from ros_lint.engine.report import EXPLAINED, HiddenCount, Issue
from ros_lint.engine.run import run_rules
from ros_lint.engine.selection import select, show
from tests.one_package import load, loaded

CAUSE, OTHER = (Rule(name, f"T{name}", "s", Severity.WARNING, "1", "") for name in ("cause", "other"))


def issue(rule: Rule, subject: str, *explains: Consequence, package: str = "p", sure: bool = True) -> Issue:
    confidence = Confidence.HIGH if sure else Confidence.MEDIUM
    return Issue(rule, package, Finding("m", Span("f", 1, 1, 1, 1), subject, confidence=confidence, explains=explains))


def names(issues: Iterable[Issue]) -> list[str]:
    return [issue.finding.subject for issue in issues]


def test_a_cause_names_the_findings_that_it_explains() -> None:
    issues = [issue(CAUSE, "a", Consequence("other", "b")), issue(OTHER, "b"), issue(OTHER, "c")]
    cause, unexplained = without_explained(issues)
    assert [(explained.rule, explained.subject) for explained in cause.explained] == [("other", "b")]
    assert unexplained.finding.subject == "c"


def test_an_empty_subject_means_all_findings_of_the_rule_in_the_package() -> None:
    cause = issue(CAUSE, "a", Consequence("other"))
    issues = [cause, issue(OTHER, "b"), issue(OTHER, "c"), issue(OTHER, "d", package="q"), issue(CAUSE, "e")]
    assert names(without_explained(issues)) == ["a", "d", "e"]


def test_a_doubtful_cause_explains_no_certain_finding() -> None:
    cause = issue(CAUSE, "a", Consequence("other"), sure=False)
    assert names(without_explained([cause, issue(OTHER, "b"), issue(OTHER, "c", sure=False)])) == ["a", "b"]


def test_findings_that_only_explain_each_other_stay() -> None:
    issues = [issue(OTHER, "a", Consequence("other", "b")), issue(OTHER, "b", Consequence("other", "a"))]
    assert names(without_explained(issues)) == ["a", "b"]


def test_consequences_of_consequences_are_explained() -> None:
    issues = [issue(CAUSE, "a", Consequence("other", "b")), issue(OTHER, "b", Consequence("other", "c")), issue(OTHER, "c")]
    assert names(without_explained(issues)) == ["a"]


def test_a_cause_is_as_grave_as_what_it_explains_unless_the_settings_decide() -> None:
    grave = issue(OTHER, "b")
    grave = grave._replace(finding=grave.finding._replace(severity=Severity.ERROR))
    issues = [issue(CAUSE, "a", Consequence("other")), grave]
    assert without_explained(issues)[0].severity is Severity.ERROR
    assert without_explained(issues, ["cause"])[0].severity is Severity.WARNING


def test_explained_findings_are_counted_and_a_hidden_cause_explains_nothing() -> None:
    rules = (CAUSE, OTHER)
    issues = [issue(CAUSE, "a", Consequence("other")), issue(OTHER, "b")]
    shown, hidden = show(issues, select(rules, chosen=("all",)))
    assert names(shown) == ["a"]
    assert hidden == (HiddenCount(EXPLAINED, 1),)
    shown, _ = show(issues, select(rules, chosen=("all",), per_path={"f": ["cause"]}))
    assert names(shown) == ["b"]


@pytest.mark.parametrize(("top", "explained"), [("", True), ("ament_export_libraries(robot)\n", False)])
def test_lost_exports_explain_missing_ones_if_nothing_else_is_exported(top: str, explained: bool) -> None:
    files = {"arm/CMakeLists.txt": "ament_export_include_directories(include)\n"}
    (package,) = load(f"add_subdirectory(arm)\n{top}", files).packages
    (rule,) = [rule for rule in registry.load() if rule.name == "export-scope"]
    assert rule.package is not None
    (finding,) = rule.package(package, load("", {}))
    assert bool(finding.explains) is explained


def manifest(*depends: str) -> str:
    tags = "".join(f"<exec_depend>{name}</exec_depend>" for name in depends)
    return (
        '<package format="3"><name>arm</name><version>1.0.0</version><description>An arm.</description>'
        '<maintainer email="jay@robots.example">Jay</maintainer><license>MIT</license>'
        f"<buildtool_depend>ament_cmake</buildtool_depend>{tags}<export><build_type>ament_cmake</build_type></export></package>"
    )


@pytest.mark.parametrize(
    ("declared", "cause"),
    [("join_state_publisher", "unknown-dependency"), ("tf2_rso", "unknown-dependency"), ("tf", "end-of-life-dependency")],
)
def test_a_wrong_name_explains_that_the_intended_package_is_missing(declared: str, cause: str) -> None:
    used = {"join_state_publisher": "joint_state_publisher"}.get(declared, "tf2_ros")
    files = {
        "arm/package.xml": manifest("launch_ros", declared),
        "arm/CMakeLists.txt": "project(arm)\nfind_package(ament_cmake REQUIRED)\n"
        "install(DIRECTORY launch DESTINATION share/arm)\nament_package()\n",
        "arm/launch/arm.launch.xml": f'<launch><node pkg="{used}" exec="node"/></launch>',
    }
    rules = tuple(rule for rule in registry.load() if rule.name in (cause, "launch-outside-closure"))
    issues, _ = run_rules(loaded(files), rules)
    (issue,) = without_explained(issues)
    assert (issue.rule.name, issue.finding.subject) == (cause, declared)
    assert [(explained.rule, explained.subject) for explained in issue.explained] == [("launch-outside-closure", used)]


def test_a_key_of_an_older_name_explains_that_the_package_is_missing() -> None:
    files = {
        "arm/package.xml": manifest().replace("<export>", "<depend>gz-common5</depend><export>"),
        "arm/CMakeLists.txt": "project(arm)\nfind_package(ament_cmake REQUIRED)\nfind_package(gz-common5 REQUIRED)\n"
        "add_executable(arm arm.cpp)\ntarget_link_libraries(arm gz-common5::gz-common5)\nament_package()\n",
        "arm/arm.cpp": "#include <gz/common/Console.hh>\nint main() {}\n",
    }
    rules = tuple(rule for rule in registry.load() if rule.name in ("unresolvable-key", "undeclared-dependency"))
    issues, _ = run_rules(loaded(files), rules)
    (issue,) = without_explained(issues)
    assert (issue.rule.name, issue.finding.subject) == ("unresolvable-key", "gz-common5")
    assert [explained.subject for explained in issue.explained] == ["gz_common_vendor"]


def test_a_variable_that_is_never_set_explains_missing_exports() -> None:
    files = {
        "arm/package.xml": manifest().replace("<export>", "<depend>nav_msgs</depend><export>"),
        "arm/CMakeLists.txt": "project(arm)\nfind_package(ament_cmake REQUIRED)\nfind_package(nav_msgs REQUIRED)\n"
        "install(DIRECTORY include/ DESTINATION include)\nament_export_include_directories(include)\n"
        "ament_export_dependencies(${ARM_DEPENDS})\nament_package()\n",
        "arm/include/arm/arm.hpp": "#include <nav_msgs/msg/path.hpp>\n",
    }
    rules = tuple(rule for rule in registry.load() if rule.name in ("unset-variable", "unexported-dependency"))
    issues, _ = run_rules(loaded(files), rules)
    (issue,) = without_explained(issues)
    assert (issue.rule.name, issue.finding.subject) == ("unset-variable", "ARM_DEPENDS")
    assert [(explained.rule, explained.subject) for explained in issue.explained] == [("unexported-dependency", "nav_msgs")]


def test_a_misspelt_configuration_explains_that_the_argument_is_unused() -> None:
    files = {
        "arm/package.xml": manifest(),
        "arm/CMakeLists.txt": "project(arm)\nfind_package(ament_cmake REQUIRED)\n"
        "install(DIRECTORY launch DESTINATION share/arm)\nament_package()\n",
        "arm/launch/arm.launch.xml": '<launch><arg name="thruster_gain" default="1"/><arg name="colour" default="red"/>'
        '<node pkg="arm" exec="arm" args="$(var thrustr_gain)"/></launch>',
    }
    rules = tuple(rule for rule in registry.load() if rule.name in ("launch-undeclared-configuration", "launch-unused-argument"))
    issues, _ = run_rules(loaded(files), rules)
    unused, misspelt = sorted(without_explained(issues), key=lambda issue: issue.finding.subject)
    assert (unused.finding.subject, misspelt.finding.subject) == ("colour", "thrustr_gain")
    assert [(explained.rule, explained.subject) for explained in misspelt.explained] == [
        ("launch-unused-argument", "thruster_gain")
    ]


@pytest.mark.parametrize(("declared", "cause"), [("std_msg", "unknown-dependency"), ("actionlib", "end-of-life-dependency")])
def test_a_wrong_name_explains_that_it_is_unused(declared: str, cause: str) -> None:
    files = {
        "arm/package.xml": manifest().replace("<export>", f"<build_depend>{declared}</build_depend><export>"),
        "arm/CMakeLists.txt": "project(arm)\nfind_package(ament_cmake REQUIRED)\nadd_executable(arm arm.cpp)\n"
        "install(TARGETS arm DESTINATION lib/arm)\nament_package()\n",
        "arm/arm.cpp": "int main() {}\n",
    }
    rules = tuple(rule for rule in registry.load() if rule.name in (cause, "unused-dependency"))
    issues, _ = run_rules(loaded(files), rules)
    (issue,) = without_explained(issues)
    assert issue.rule.name == cause
    assert [explained.rule for explained in issue.explained] == ["unused-dependency"]


def test_an_unused_find_package_explains_that_its_tag_does_not_cover_the_export() -> None:
    files = {
        "arm/package.xml": manifest().replace("<export>", "<build_depend>std_msgs</build_depend><export>"),
        "arm/CMakeLists.txt": "project(arm)\nfind_package(ament_cmake REQUIRED)\nfind_package(std_msgs REQUIRED)\n"
        "add_library(arm arm.cpp)\nament_target_dependencies(arm std_msgs)\ninstall(TARGETS arm DESTINATION lib)\n"
        "ament_export_dependencies(std_msgs)\nament_package()\n",
        "arm/arm.cpp": "int zero() { return 0; }\n",
    }
    rules = tuple(rule for rule in registry.load() if rule.name in ("unused-find-package", "wrong-dependency-kind"))
    issues, _ = run_rules(loaded(files), rules)
    (issue,) = without_explained(issues)
    assert issue.rule.name == "unused-find-package"
    assert [(explained.rule, explained.subject) for explained in issue.explained] == [("wrong-dependency-kind", "std_msgs")]


def test_a_remapping_to_its_own_name_explains_that_the_argument_is_unused() -> None:
    files = {
        "arm/package.xml": manifest("launch_ros"),
        "arm/CMakeLists.txt": "project(arm)\nfind_package(ament_cmake REQUIRED)\n"
        "install(DIRECTORY launch DESTINATION share/arm)\nament_package()\n",
        "arm/launch/arm.launch.xml": '<launch><arg name="in/a" default="a"/>'
        '<node pkg="tf2_ros" exec="x"><remap from="in/a" to="in/a"/></node></launch>',
    }
    names_of_rules = ("remap-no-effect", "launch-unused-argument")
    issues, _ = run_rules(loaded(files), tuple(rule for rule in registry.load() if rule.name in names_of_rules))
    (issue,) = without_explained(issues)
    assert issue.rule.name == "remap-no-effect"
    assert [(explained.rule, explained.subject) for explained in issue.explained] == [("launch-unused-argument", "in/a")]
