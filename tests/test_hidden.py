"""What a report says of the findings that it does not show."""

from typing import Any

import pytest

from ros_lint.base.tree import MemoryTree
from ros_lint.engine import registry
from ros_lint.engine.check import ReportContext, check
from ros_lint.engine.report import MINOR, OFF, BlindSpot, HiddenCount, Report
from ros_lint.engine.selection import select
from ros_lint.workspace.loader import Loader
from ros_lint.workspace.target import TargetDistro
from tests.packages import manifest_text

CMAKE = """cmake_minimum_required(VERSION 3.8)
project(talker)
find_package(ament_cmake REQUIRED)
find_package(rclcpp REQUIRED)
link_directories(lib){comment}
add_executable(talker talker.cpp)
target_link_libraries(talker rclcpp::rclcpp)
install(TARGETS talker DESTINATION lib/talker)
ament_package()
"""


TOOL = ["<buildtool_depend>ament_cmake</buildtool_depend>"]


def report(comment: str = "", **settings: Any) -> Report:
    """Return the report on a package that calls link_directories()."""
    files = {
        "talker/package.xml": manifest_text("talker", [*TOOL, "<depend>rclcpp</depend>"]),
        "talker/CMakeLists.txt": CMAKE.format(comment=comment),
        "talker/talker.cpp": "#include <rclcpp/rclcpp.hpp>\nint main() { rclcpp::shutdown(); }\n",
    }
    loader = Loader(MemoryTree(files), ("",), TargetDistro("jazzy", "--distro", True))
    rules = registry.load()
    return check(loader.load_all(), loader.suppressions(), select(rules, **settings), ReportContext(rules, "", ("",), ()))


def test_findings_of_rules_that_are_off_are_counted() -> None:
    assert HiddenCount(OFF, 1, (("link-directories", 1),)) in report().hidden
    assert "link-directories" not in {issue.rule.name for issue in report().issues}


def test_findings_below_the_lowest_severity_are_hidden_and_counted_once() -> None:
    everything = report(pedantic=True)
    assert {str(issue.severity) for issue in everything.issues} == {"warning"}
    assert report(pedantic=True, min_severity="warning").issues == everything.issues
    errors = report(pedantic=True, min_severity="error")
    assert errors.issues == ()
    assert HiddenCount(MINOR, len(everything.issues)) in errors.hidden
    raised = report(pedantic=True, min_severity="error", severities={"link-directories": "error"})
    assert [issue.rule.name for issue in raised.issues] == ["link-directories"]
    assert report(min_severity="error").hidden == ()


@pytest.mark.parametrize(
    "settings",
    [
        {"ignored": ("link-directories",)},
        {"severities": {"link-directories": "off"}},
        {"added": ("link-directories",)},
        {"chosen": ("undeclared-dependency",)},
        {"per_path": {"CMakeLists.txt": ("link-directories",)}},
        {"pedantic": True},
    ],
    ids=str,
)
def test_findings_of_rules_that_the_settings_mention_are_not_counted(settings: dict[str, Any]) -> None:
    assert OFF not in [hidden.reason for hidden in report(**settings).hidden]


def test_suppressed_findings_of_rules_that_are_off_are_not_counted() -> None:
    assert not report("  # ros-lint: ignore[link-directories] soon").hidden


@pytest.mark.parametrize("explicit", [True, False])
def test_a_report_has_what_was_checked_and_what_was_hidden(explicit: bool) -> None:
    script = "project({0})\nfind_package({1} REQUIRED)\ninclude(${{UNHEARD_OF}}/all.cmake)\n"
    files = {
        ".github/workflows/ci.yaml": "jobs:\n  build:\n    env:\n      ROS_DISTRO: humble\n",
        "src/odd/package.xml": "<package",
    }
    for path, tool in (
        ("src/arm", "ament_cmake"),
        ("src/leg", "ament_cmake"),
        ("old/base", "catkin"),
        ("more/lib", "ament_cmake"),
    ):
        name = path.rpartition("/")[2]
        files[f"{path}/package.xml"] = manifest_text(name, [TOOL[0].replace("ament_cmake", tool)], tool)
        files[f"{path}/CMakeLists.txt"] = script.format(name, tool)
    loader = Loader(MemoryTree(files), ("",), TargetDistro("jazzy", "test", explicit))
    rules = registry.load()
    found = check(loader.load_all(), (), select(rules), ReportContext(rules, "2026-01-02", ("src", "old"), ("careful",)))
    hidden = ("used dependencies", "executables", "installed share files", "Python modules", "libraries", "interfaces")
    assert found.blind_spots == tuple(
        BlindSpot(what, ("arm", "leg")) for what in (*hidden, "components", "exported dependencies")
    )
    assert found.ros1 == ("base",)
    assert (found.packages, found.context_packages) == (4, 1)
    assert found.package_names == ("arm", "base", "leg", "src/odd")
    assert [named.distro for named in found.named_distros] == ([] if explicit else ["humble"])
    assert (found.workspace, found.data_date, found.warnings) == ("", "2026-01-02", ("careful",))
    assert [(issue.rule.name, issue.package) for issue in found.issues] == [("rejected-manifest", "")]
