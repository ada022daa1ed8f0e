"""Similar names, compared with a search by brute force."""

from __future__ import annotations

import random
import re
from itertools import pairwise

import pytest

from ros_lint.knowledge import Knowledge
from ros_lint.knowledge.spelling import Spelling, near_names


def _edits(name: str) -> set[str]:
    """Return every name one letter away, by brute force."""
    letters = "abcdefghijklmnopqrstuvwxyz_-0123456789"
    splits = [(name[:at], name[at:]) for at in range(len(name) + 1)]
    result = {a + b[1:] for a, b in splits if b}
    result |= {a + b[1] + b[0] + b[2:] for a, b in splits if len(b) > 1}
    result |= {a + c + b[1:] for a, b in splits if b for c in letters}
    result |= {a + c + b for a, b in splits for c in letters}
    return result - {name}


def test_slips_equal_those_found_by_brute_force() -> None:
    names = [name for name in Knowledge("jazzy").index.names() if len(name) > 12][::40]
    spelling = Spelling(names)
    chance = random.Random(7)
    for name in names:
        for wrong in chance.sample(sorted(_edits(name)), 25):
            expected = {other for other in _edits(wrong) if other in names}
            assert {*spelling.one_slip(wrong)} <= expected
            if name not in spelling.one_slip(wrong):
                # Digits, dashes and words of few letters are no matter of a slip.
                at = next(i for i in range(len(name) + 1) if name[: i + 1] != wrong[: i + 1])
                changed = name[at : at + 1] + wrong[at : at + 1]
                words = re.findall("[a-z]+", f"{name} {wrong}")
                assert not changed.isalpha() or any(len(word) < 5 for word in words), (name, wrong)


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        ("laser_filter", "laser_filters"),
        ("geometry_msg", "geometry_msgs"),
        ("buildin_interfaces", "builtin_interfaces"),
        ("rivz_default_plugins", "rviz_default_plugins"),
    ],
)
def test_a_name_with_one_wrong_letter_is_found(wrong: str, right: str) -> None:
    assert Spelling(Knowledge("jazzy").index.names()).one_slip(wrong) == (right,)


def test_the_same_words_in_another_order_are_nearest() -> None:
    names = ["ament_cmake", "ament_cmake_auto", "ament_cmake_ros"]
    assert Spelling(names).near("ament_auto_cmake") == ("ament_cmake_auto", "ament_cmake")


@pytest.mark.parametrize("name", ["python3-pcl", "lcm", "mrpt2", "camera_2", "rclcpp"])
def test_short_words_and_digits_are_no_slips(name: str) -> None:
    assert Spelling(["python3-pil", "icm", "mrpt1", "camera_1", "rclcpp"]).one_slip(name) == ()


def test_no_two_known_names_differ_by_swapped_letters() -> None:
    """Why words of four letters will do for it."""
    names = {*Knowledge("jazzy").index.names(), *Knowledge("jazzy").rosdep.names()}
    for name in names:
        for at, (left, right) in enumerate(pairwise(name)):
            if left != right and left.isalpha() and right.isalpha():
                assert f"{name[:at]}{right}{left}{name[at + 2 :]}" not in names


def test_dashes_and_capitals_are_ignored() -> None:
    assert Spelling(["cv_bridge", "turtlebot3_fake_node"]).same("cv-bridge") == ("cv_bridge",)
    assert Spelling(["cv_bridge", "turtlebot3_fake_node"]).same("turtlebot3_fakenode") == ("turtlebot3_fake_node",)
    assert Spelling(["ament_cmake_copyright", "rclcpp"]).near("ament_cmake_lint_copyright") == ("ament_cmake_copyright",)


@pytest.mark.parametrize(
    ("name", "names", "wanted"),
    [
        ("orca_description", ["ur_description", "leo_description"], []),
        ("description", ["ur_description", "leo_description"], []),
        ("launch/rviz.launch.py", ["launch/gps.launch.py", "launch/rviz2.launch.py"], ["launch/rviz2.launch.py"]),
        ("tower_and_pan_tilt_control", ["tower_pan_tilt_control", "chassis_pan_tilt_control"], ["tower_pan_tilt_control"]),
        ("small_house_world", ["small_warehouse_world"], ["small_warehouse_world"]),
        ("follow_waypoints_server", ["follow_waypoints", "follow_waypoints_deg"], ["follow_waypoints"]),
        ("icar_description", ["flir_camera_description", "car_description"], ["car_description"]),
        ("rmoss_interfaces", ["ros_gz_interfaces", "ros_snapd_interfaces"], []),
        ("robot_apriltags", ["cam_robot_april_tag"], ["cam_robot_april_tag"]),
    ],
)
def test_near_names_exclude_unrelated_words(name: str, names: list[str], wanted: list[str]) -> None:
    assert near_names(name, names, 3, 0.6) == wanted


def test_a_name_of_several_lines_resembles_no_other() -> None:
    spelling = Spelling(["a\nb", "cv_bridge"])
    assert spelling.same("cv-bridge") == ("cv_bridge",)
    assert spelling.near("cv_bridges") == ("cv_bridge",)
