"""One run for several distributions: merged findings, fixes that hold in all of them, settings and commands."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from ros_lint.analysis.finding import Confidence, Consequence, Finding, Fix, Severity
from ros_lint.analysis.rule import Rule
from ros_lint.base.edit import Edit
from ros_lint.base.text import Span
from ros_lint.base.tree import MemoryTree
from ros_lint.cli.main import main
from ros_lint.engine.explanations import without_explained
from ros_lint.engine.fix_trials import Trial
from ros_lint.engine.fix_trials import _new_findings as new_findings
from ros_lint.engine.fix_trials import _unresolved as unresolved
from ros_lint.engine.merge import merge
from ros_lint.engine.report import Issue
from ros_lint.knowledge import Knowledge
from ros_lint.testing import Case, loader_of, read_cases
from ros_lint.workspace.build_scripts import evaluate as build_scripts
from ros_lint.workspace.loader import Loader
from ros_lint.workspace.state import DistroData
from ros_lint.workspace.target import TargetDistro

RULE = Rule("r", "ROS999", "s", Severity.ERROR, "0.1", "", package=lambda package, workspace: ())
FIRST, SECOND = (Fix("t", (Edit(Span("f", 1, 1, 1, 1), text),)) for text in ("a", "b"))


def issue(subject: str = "s", message: str = "m", fix: Fix | None = None, rule: Rule = RULE, **other: Any) -> Issue:
    return Issue(rule, "p", Finding(message, Span("f", 1, 1, 1, 2), subject, fix=fix, **other))


def merged(*by_distro: list[Issue]) -> list[Issue]:
    return list(merge(list(zip(("humble", "jazzy", "kilted"), by_distro, strict=False))))


def test_a_finding_of_all_distributions_stays_as_it_is() -> None:
    assert merged([issue(fix=FIRST)], [issue(fix=FIRST)]) == [issue(fix=FIRST)]
    assert merged([issue()]) == [issue()]


def test_a_finding_of_some_distributions_names_them() -> None:
    (only,) = merged([], [issue()], [])
    assert (only.finding.message, only.distros) == ("m (reported only for jazzy)", ("jazzy",))
    (only,) = merged([issue()], [], [issue()])
    assert (only.finding.message, only.distros) == ("m (reported only for humble and kilted)", ("humble", "kilted"))


def test_a_message_that_differs_is_kept_beside_the_first() -> None:
    (both,) = merged([issue(message="through a")], [issue(message="through b")])
    assert (both.finding.message, both.distros) == ("through a (reported also for jazzy)", ())
    assert both.other_messages == (("jazzy", "through b"),)


@pytest.mark.parametrize(
    "other",
    [issue(subject="t"), issue(confidence=Confidence.MEDIUM), issue(severity=Severity.INFO)],
    ids=["subject", "confidence", "severity"],
)
def test_findings_that_differ_are_not_merged(other: Issue) -> None:
    assert [i.distros for i in merged([issue()], [other])] == [("humble",), ("jazzy",)]


def test_the_number_of_equal_findings_is_the_largest_of_the_distributions() -> None:
    assert [i.distros for i in merged([issue(), issue(message="n")], [issue()])] == [(), ("humble",)]


@pytest.mark.parametrize(
    ("fixes", "result"),
    [
        ([FIRST, FIRST], FIRST),
        ([FIRST, SECOND], FIRST._replace(safe=False)),
        ([FIRST, FIRST._replace(safe=False)], FIRST._replace(safe=False)),
        ([FIRST, None], None),
        ([None, FIRST], None),
    ],
    ids=["equal", "different", "unsafe in one", "none in the second", "none in the first"],
)
def test_a_fix_is_safe_if_all_distributions_have_it(fixes: list[Fix | None], result: Fix | None) -> None:
    ((both,),) = [merged(*([issue(fix=fix)] for fix in fixes))]
    assert both.finding.fix == result


def test_a_fix_of_some_distributions_is_unsafe() -> None:
    (only,) = merged([issue(fix=FIRST)], [])
    assert only.finding.fix == FIRST._replace(safe=False)


def test_a_fix_is_safe_if_other_distributions_have_it_for_another_rule() -> None:
    other = issue(fix=FIRST, rule=RULE._replace(name="o", code="ROS998"))
    assert [(i.distros, i.finding.fix) for i in merged([issue(fix=FIRST)], [other])] == [
        (("humble",), FIRST),
        (("jazzy",), FIRST),
    ]


def test_a_cause_explains_findings_only_where_it_holds() -> None:
    cause, consequence = issue("cause", explains=(Consequence("r", "s"),)), issue()
    assert [i.finding.subject for i in without_explained(merged([cause, consequence], [cause, consequence]))] == ["cause"]
    assert len(without_explained(merged([cause, consequence], [consequence]))) == 2
    assert [i.finding.subject for i in without_explained(merged([cause, consequence], [cause]))] == ["cause"]
    assert [i.finding.subject for i in without_explained(merged([cause, consequence], [issue("cause")]))] == ["cause"]
    assert len(without_explained(merged([cause, consequence], [issue("cause"), consequence]))) == 2


# --- loading


def load_all(files: dict[str, str], monkeypatch: pytest.MonkeyPatch) -> tuple[Any, list[str]]:
    """Return the workspaces for humble and jazzy, and the folders of the packages whose CMakeLists.txt is evaluated."""
    evaluated: list[str] = []
    evaluate = build_scripts.Scripts._cmake

    def record(scripts: Any, parts: Any) -> Any:
        evaluated.append(f"{parts.package.name} {scripts._distro}")
        return evaluate(scripts, parts)

    monkeypatch.setattr(build_scripts.Scripts, "_cmake", record)
    first, second = (TargetDistro(*pair, others=(other,)) for *pair, other in (("humble", "", "jazzy"), ("jazzy", "", "humble")))
    loader = Loader(MemoryTree(files), ("",), first, others=[DistroData(second, Knowledge("jazzy"))])
    return loader.load_all(), evaluated


def package(name: str, cmake: str, export: str = "<build_type>ament_cmake</build_type>") -> dict[str, str]:
    manifest = (
        f'<package format="3"><name>{name}</name><version>1.0.0</version><description>d</description>'
        f'<maintainer email="a@b.org">A</maintainer><license>MIT</license><export>{export}</export></package>'
    )
    return {f"{name}/package.xml": manifest, f"{name}/CMakeLists.txt": f"project({name})\n{cmake}\nament_package()\n"}


CASES = [
    case
    for source in sorted((Path(__file__).parent.parent / "fixtures").glob("*.md"))
    for case in read_cases(source)
    if any("ROS_DISTRO" in text for text in case.files.values())
]


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.source.stem}: {case.title}")
def test_the_packages_are_those_of_separate_runs(case: Case) -> None:
    tree = case.tree()
    together = loader_of(tree, case._replace(distros=("humble", "jazzy"))).load_all()
    for distro, workspace in zip(("humble", "jazzy"), together, strict=True):
        alone = loader_of(tree, case._replace(distros=(distro,))).load()
        assert (workspace.packages, workspace.not_checked) == (alone.packages, alone.not_checked)


READS = 'set(distro $ENV{ROS_DISTRO})\nif(distro STREQUAL "humble")\n  add_library(old old.cpp)\nendif()'


def test_a_script_is_evaluated_again_only_if_it_reads_the_distribution(monkeypatch: pytest.MonkeyPatch) -> None:
    workspaces, evaluated = load_all({**package("a", "add_library(new new.cpp)"), **package("b", READS)}, monkeypatch)
    assert evaluated == ["a humble", "b humble", "b jazzy"]
    humble, jazzy = ([workspace.by_name[name][0].script for name in "ab"] for workspace in workspaces)
    assert humble[0] is jazzy[0]
    assert humble[1] != jazzy[1]


def test_all_scripts_are_evaluated_again_if_the_code_of_a_helper_differs(monkeypatch: pytest.MonkeyPatch) -> None:
    helper = {**package("a", READS), "a/a-extras.cmake": "set(A 1)"}
    helper["a/CMakeLists.txt"] = helper["a/CMakeLists.txt"].replace(
        "ament_package()", "ament_package(CONFIG_EXTRAS a-extras.cmake)"
    )
    _, evaluated = load_all({**helper, **package("b", "find_package(a REQUIRED)")}, monkeypatch)
    assert evaluated == ["a humble", "b humble", "a jazzy", "b jazzy"]


def test_packages_are_found_for_each_distribution_if_a_condition_chooses_the_build_type(monkeypatch: pytest.MonkeyPatch) -> None:
    export = (
        '<build_type condition="$ROS_DISTRO == humble">ament_cmake</build_type>'
        '<build_type condition="$ROS_DISTRO == jazzy">cmake</build_type>'
    )
    workspaces, evaluated = load_all(package("a", "", export), monkeypatch)
    assert [workspace.packages[0].type for workspace in workspaces] == ["ros.ament_cmake", "ros.cmake"]
    assert evaluated == ["a humble", "a jazzy"]


# --- runs

MANIFEST = """<?xml version="1.0"?>
<package format="3">
  <name>robot</name>
  <version>1.0.0</version>
  <description>d</description>
  <maintainer email="a@robots.example">a</maintainer>
  <license>Apache-2.0</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <depend condition="$ROS_DISTRO == humble">sensor_msgs</depend>
  <export><build_type>ament_cmake</build_type></export>
</package>
"""
CMAKE = """cmake_minimum_required(VERSION 3.20)
project(robot)
find_package(ament_cmake REQUIRED)
find_package(gazebo_ros REQUIRED)
find_package(rclcpp REQUIRED)
find_package(sensor_msgs REQUIRED)
add_executable(robot src/robot.cpp)
target_link_libraries(robot gazebo_ros::gazebo_ros rclcpp::rclcpp sensor_msgs::sensor_msgs__rosidl_typesupport_cpp)
install(TARGETS robot DESTINATION lib/${PROJECT_NAME})
ament_package()
"""
BOTH = ("--distro", "humble,jazzy")
FINDINGS = {
    "gazebo_ros": (["humble"], "because jazzy has no 'gazebo_ros' (reported only for humble)"),
    "rclcpp": (["humble", "jazzy"], "add <depend>rclcpp</depend>"),
    "sensor_msgs": (["jazzy"], "widen the condition (reported only for jazzy)"),
}


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "robot"
    (folder / "src").mkdir(parents=True)
    (folder / "package.xml").write_text(MANIFEST)
    (folder / "CMakeLists.txt").write_text(CMAKE)
    (folder / "src" / "robot.cpp").write_text(
        "#include <rclcpp/rclcpp.hpp>\n#include <sensor_msgs/msg/image.hpp>\n#include <gazebo_ros/node.hpp>\nint main() {}\n"
    )
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.delenv("ROS_DISTRO", raising=False)
    return folder


def run(*arguments: str, code: int = 1) -> int:
    result = main(["robot", *arguments])
    assert result == code
    return result


def report(capsys: pytest.CaptureFixture[str], *arguments: str, code: int = 1) -> Any:
    capsys.readouterr()
    run("--format", "json", *arguments, code=code)
    return json.loads(capsys.readouterr().out)


@pytest.mark.parametrize("flags", [BOTH, ("--distro", "humble", "--distro", "jazzy")], ids=str)
def test_findings_have_the_distributions_in_which_they_hold(
    robot: Path, capsys: pytest.CaptureFixture[str], flags: tuple[str, ...]
) -> None:
    document = report(capsys, *flags)
    assert (document["distro"], document["distros"], document["distro_source"]) == ("humble", ["humble", "jazzy"], "--distro")
    assert {finding["subject"]: finding["distros"] for finding in document["findings"]} == {
        subject: distros for subject, (distros, _) in FINDINGS.items()
    }
    assert all(finding["message"].endswith(FINDINGS[finding["subject"]][1]) for finding in document["findings"])
    assert report(capsys, *flags) == document  # from the cache


@pytest.mark.parametrize("form", ["text", "concise", "sarif", "github", "gitlab"])
def test_every_format_names_the_distributions(robot: Path, capsys: pytest.CaptureFixture[str], form: str) -> None:
    run(*BOTH, "--format", form)
    text = capsys.readouterr().out
    assert "(reported only for humble)" in text
    assert "(reported only for jazzy)" in text
    if form == "sarif":
        (sarif,) = json.loads(text)["runs"]
        assert sarif["properties"]["distros"] == ["humble", "jazzy"]
        distros = {result["properties"]["subject"]: result["properties"]["distros"] for result in sarif["results"]}
        assert distros == {subject: distros for subject, (distros, _) in FINDINGS.items()}
    elif form != "gitlab":
        assert "for humble and jazzy (--distro)" in text


def test_the_exit_code_is_that_of_all_findings(robot: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (robot / "package.xml").write_text(MANIFEST.replace("  <export>", "  <depend>rclcpp</depend>\n  <export>"))
    (robot / "CMakeLists.txt").write_text(
        CMAKE.replace("find_package(gazebo_ros REQUIRED)\n", "").replace(" gazebo_ros::gazebo_ros", "")
    )
    source = robot / "src" / "robot.cpp"
    source.write_text(source.read_text().replace("#include <gazebo_ros/node.hpp>\n", ""))
    run("--distro", "humble", code=0)
    run("--distro", "jazzy", code=1)
    run(*BOTH, code=1)


def test_fixes_hold_in_all_distributions_and_are_written_once(robot: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = {distro: {f["subject"] for f in report(capsys, "--distro", distro)["findings"]} for distro in ("humble", "jazzy")}
    run(*BOTH, "--fix")
    assert "fixed 1 finding in 1 file" in capsys.readouterr().err
    manifest = (robot / "package.xml").read_text()
    assert "<depend>rclcpp</depend>" in manifest
    assert "gazebo_ros" not in manifest
    run(*BOTH, "--fix", "--unsafe-fixes")
    assert "nothing to fix" in capsys.readouterr().err
    assert (robot / "package.xml").read_text() == manifest
    for distro, subjects in before.items():
        assert {finding["subject"] for finding in report(capsys, "--distro", distro)["findings"]} == subjects - {"rclcpp"}


def test_the_proposed_condition_resolves_the_finding(robot: Path, capsys: pytest.CaptureFixture[str]) -> None:
    tag = '<depend condition="$ROS_DISTRO == humble">gazebo_ros</depend>'
    (finding,) = [f for f in report(capsys, *BOTH)["findings"] if f["subject"] == "gazebo_ros"]
    assert (f"add {tag}" in finding["message"], finding["fix"]) == (True, None)
    (robot / "package.xml").write_text(MANIFEST.replace("  <export>", f"  {tag}\n  <export>"))
    assert {f["subject"] for f in report(capsys, *BOTH)["findings"]} == {"rclcpp", "sensor_msgs"}


def trial(*issues: Issue) -> Trial:
    workspace: Any = SimpleNamespace(target=TargetDistro("humble", "--distro", others=("jazzy",)))
    return Trial({}, workspace.target.distros, issues)


def test_a_finding_that_a_fix_causes_in_another_distribution_is_new() -> None:
    only, both = issue()._replace(distros=("jazzy",)), issue()
    assert new_findings(trial(only), trial(both), ()) == [both]
    assert new_findings(trial(only), trial(only), ()) == []
    assert new_findings(trial(both), trial(only), ()) == []


def test_a_fix_has_to_resolve_its_finding_in_all_distributions() -> None:
    only, both = issue()._replace(distros=("jazzy",)), issue()
    assert unresolved(trial(both), trial(only), [both]) == [both]
    assert unresolved(trial(both), trial(), [both]) == []


def test_a_suppression_is_unused_only_if_it_is_in_all_distributions(robot: Path, capsys: pytest.CaptureFixture[str]) -> None:
    source = (robot / "src" / "robot.cpp").read_text()
    comment = "image.hpp>  // ros-lint: ignore[undeclared-dependency] the image of jazzy has it"
    (robot / "src" / "robot.cpp").write_text(source.replace("image.hpp>", comment))
    by_distro = {distro: {f["rule"] for f in report(capsys, "--distro", distro)["findings"]} for distro in ("humble", "jazzy")}
    assert by_distro == {"humble": {"undeclared-dependency", "unused-suppression"}, "jazzy": {"undeclared-dependency"}}
    document = report(capsys, *BOTH)
    assert {finding["rule"] for finding in document["findings"]} == {"undeclared-dependency"}
    assert [hidden["count"] for hidden in document["hidden"] if hidden["reason"] == "suppressed by comments"] == [1]


def test_the_baseline_hides_findings_of_all_distributions(robot: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run(*BOTH, "--baseline", "known.json", "--write-baseline", code=0)
    run(*BOTH, "--baseline", "known.json", code=0)
    assert "no longer occur" not in capsys.readouterr().err


def test_the_settings_can_list_distributions(robot: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (robot / "ros-lint.toml").write_text('distro = ["humble", "jazzy"]')
    document = report(capsys)
    assert (document["distros"], document["distro_source"]) == (["humble", "jazzy"], "ros-lint.toml")
    assert report(capsys, "--distro", "jazzy")["distros"] == ["jazzy"]
    (robot / "ros-lint.toml").write_text('distro = ["humble", "humble"]')
    assert report(capsys)["distros"] == ["humble"]
    (robot / "ros-lint.toml").write_text("distro = []")
    assert report(capsys, code=1)["distro_source"] == "newest LTS"


@pytest.mark.parametrize("origin", ["--distro", "ros-lint.toml:2"])
def test_an_unknown_name_is_an_error(robot: Path, capsys: pytest.CaptureFixture[str], origin: str) -> None:
    (robot / "ros-lint.toml").write_text('distro = ["humble",\n  "jazy"]')
    run(*(("--distro", "humble,jazy") if origin == "--distro" else ()), code=2)
    assert f"{origin}: unknown distribution 'jazy'; did you mean 'jazzy'?" in capsys.readouterr().err


@pytest.mark.parametrize(
    "command",
    [
        ("why", "robot", "rclcpp", "-C", "robot"),
        ("explain-package", "robot", "-C", "robot"),
        ("overlay", "robot"),
        ("order", "robot"),
        ("graph", "robot"),
    ],
    ids=lambda command: command[0],
)
def test_commands_answer_for_one_distribution(robot: Path, capsys: pytest.CaptureFixture[str], command: tuple[str, ...]) -> None:
    assert main([*command, *BOTH]) == 2
    message = "--distro: this command answers for one distribution, not for humble and jazzy; use --distro humble"
    assert capsys.readouterr().err == f"ros-lint: {message}\n"
    (robot / "ros-lint.toml").write_text('distro = ["humble", "jazzy"]')
    main(list(command))
    warning = "ros-lint.toml: distro lists humble and jazzy; the answer is for humble (set with --distro)"
    assert capsys.readouterr().err.startswith(f"ros-lint: {warning}\n")
    main([*command, "--distro", "jazzy"])
    assert "the answer is for" not in capsys.readouterr().err
