"""Where a name resolves that is to be declared."""

from __future__ import annotations

import pytest

from ros_lint.analysis.dependencies.remedy import availability_remark, naming_fix, remedy
from ros_lint.base.edit import Edit
from ros_lint.base.text import file_start
from ros_lint.base.tree import MemoryTree
from ros_lint.facts.manifest import Role
from ros_lint.knowledge.underlays import in_tree
from ros_lint.workspace.loader import Loader
from ros_lint.workspace.model import Workspace
from ros_lint.workspace.target import TargetDistro
from tests.packages import manifest_text

EDIT = Edit(file_start("robot/package.xml"), "<depend>x</depend>")


def workspace(distro: str, *, told: bool) -> Workspace:
    """Return a workspace with the package robot, over an underlay with the package dolly."""
    files = {
        "robot/package.xml": manifest_text("robot"),
        "opt/COLCON_IGNORE": "",
        "opt/share/dolly/package.xml": manifest_text("dolly"),
    }
    tree = MemoryTree(files)
    return Loader(tree, ("",), TargetDistro(distro, "test", told), underlays=[in_tree(tree, "opt", distro)]).load()


@pytest.mark.parametrize(
    ("name", "stated", "assumed"),
    [
        ("rclcpp", "", ""),
        ("eigen", "", ""),
        ("robot", "", ""),
        ("dolly", "", ""),
        ("clearpath_config", "", " (available only in humble, jazzy)"),
        ("gz_math_vendor", "", " (not available in humble)"),
        ("python3-utm", "", " (not available in humble)"),
        ("gazebo", " (not available in jazzy, only in humble)", " (not available in jazzy, only in humble)"),
        (
            "turtlesim_msgs",
            " (not available in jazzy, only in kilted, lyrical, rolling)",
            " (not available in jazzy, only in kilted, lyrical, rolling)",
        ),
        ("acme_core", " (not released in any active distribution)", " (not released in any active distribution)"),
        ("ros1_bridge", " (not released in any active distribution)", " (not released in any active distribution)"),
    ],
)
def test_a_name_resolves_where_it_is_stated_or_everywhere(name: str, stated: str, assumed: str) -> None:
    for told, remark in ((True, stated), (False, assumed)):
        found = workspace("jazzy", told=told)
        assert availability_remark(found, name) == remark
        fix = naming_fix(found, name, "declare it", EDIT)
        assert fix is not None
        assert fix.safe is (not remark)


def test_a_fix_is_unsafe_if_the_repository_builds_for_a_distribution_without_the_name() -> None:
    tree = MemoryTree({"robot/package.xml": manifest_text("robot"), ".gitlab-ci.yml": "image: ros:jazzy\n"})
    found = Loader(tree, ("",), TargetDistro("humble", "test")).load()
    assert availability_remark(found, "gazebo_ros") == " (not available in jazzy, for which this repository builds, too)"
    fixes = [naming_fix(found, name, "declare it", EDIT) for name in ("gazebo_ros", "rclcpp")]
    assert [fix and fix.safe for fix in fixes] == [False, True]


def test_a_tag_for_other_distributions_has_a_condition_and_no_fix() -> None:
    for told in (True, False):
        found = workspace("jazzy", told=told)
        newer, older = (remedy(found.packages[0], found, name, Role.EXEC) for name in ("turtlesim_msgs", "gazebo_ros"))
        assert newer.written.startswith('<exec_depend condition="$ROS_DISTRO != humble and $ROS_DISTRO != jazzy">turtlesim_msgs')
        condition = '<exec_depend condition="$ROS_DISTRO == humble">'
        assert older.written == f"{condition}gazebo_ros</exec_depend>, because jazzy has no 'gazebo_ros'"
        assert [newer.fix, older.fix] == [None, None]
        assert newer.conditional
        assert older.conditional


def test_a_condition_needs_format_3() -> None:
    old = manifest_text("robot").replace('format="3"', 'format="2"')
    for text, remark in ((old, " (a condition needs format 3 of package.xml)"), (manifest_text("robot"), "")):
        loaded = Loader(MemoryTree({"robot/package.xml": text}), ("",), TargetDistro("jazzy", "test")).load()
        _, _, end = remedy(loaded.packages[0], loaded, "gazebo_ros", Role.EXEC).written.partition("</exec_depend>")
        assert end == f"{remark}, because jazzy has no 'gazebo_ros'"


def test_what_is_unsafe_anyway_stays_so() -> None:
    fix = naming_fix(workspace("jazzy", told=True), "rclcpp", "declare it", EDIT, safe=False)
    assert fix is not None
    assert not fix.safe
    assert naming_fix(workspace("jazzy", told=True), "rclcpp", "declare it") is None


def test_a_distribution_without_data() -> None:
    found = workspace("foxy", told=True)
    remarks = [availability_remark(found, name) for name in ("robot", "dolly", "eigen", "rclcpp")]
    assert remarks == ["", "", "", " (there are no data about foxy)"]
