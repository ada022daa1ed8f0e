"""The distributions that a repository builds for."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from ros_lint.base.tree import MemoryTree
from ros_lint.engine.report import Report
from ros_lint.reporters.summary import limits
from ros_lint.workspace.discovery.named_distros import named_distros
from ros_lint.workspace.loader import Loader
from ros_lint.workspace.target import NamedDistro, TargetDistro
from tests.packages import manifest_text

KNOWN = {"foxy": False, "humble": True, "jazzy": True, "lyrical": True, "rolling": True}
CI = ".github/workflows/ci.yaml"


def named(files: Mapping[str, str], roots: tuple[str, ...] = ("",)) -> list[tuple[str, str, int]]:
    return [place[:3] for place in named_distros(MemoryTree(files), roots, KNOWN)]


@pytest.mark.parametrize(
    ("path", "text", "distros"),
    [
        ("Dockerfile", "FROM ros:humble\n", {"humble": 1}),
        ("Dockerfile.arm", "FROM --platform=$P osrf/ros:humble-desktop AS base\nRUN ls\n", {"humble": 1}),
        ("docker/Dockerfile", "ARG ROS_DISTRO=jazzy\nFROM ros:${ROS_DISTRO}-ros-base\n", {"jazzy": 1}),
        ("Dockerfile", "FROM ubuntu:22.04\nRUN apt-get install -y ros-humble-rviz2\n", {"humble": 2}),
        ("Dockerfile", "FROM ubuntu:24.04\nRUN . /opt/ros/jazzy/setup.sh\n", {"jazzy": 2}),
        (CI, "jobs:\n  a:\n    strategy:\n      matrix:\n        ros_distro: [humble, 'jazzy']\n", {"humble": 5, "jazzy": 5}),
        (CI, "env:\n  ROS_DISTRO: humble  # not rolling\n", {"humble": 2}),
        (CI, "matrix:\n  ros_distribution:\n    - humble\n    - jazzy\n  os:\n    - rolling\n", {"humble": 3, "jazzy": 4}),
        (CI, "include:\n  - {ROS_DISTRO: rolling, ROS_REPO: main}\n", {"rolling": 2}),
        (CI, "container: rostooling/setup-ros-docker:ubuntu-jammy-ros-humble-ros-base-latest\n", {"humble": 1}),
        (CI, "with:\n  required-ros-distributions: ${{ matrix.ros_distro }}\n# ROS_DISTRO: foxy\n", {}),
        (CI, "on: {push: {branches: [humble]}}\n", {}),
        (".gitlab-ci.yml", "image: ros:foxy\n", {"foxy": 1}),
        # Lists of repositories name the branches of other repositories.
        ("deps.rosinstall", "- git: {local-name: a, uri: https://robots.example/a.git, version: humble}\n", {}),
        ("a.repos", "repositories:\n  a: {type: git, url: https://robots.example/a.git, version: humble}\n", {}),
        (".devcontainer/devcontainer.json", '{\n  "image": "ros:jazzy",\n  // "x": "ros:foxy"\n}\n', {"jazzy": 2}),
        (".devcontainer/Dockerfile", "FROM althack/ros2:humble-dev\nENV ROS_DISTRO humble\n", {"humble": 2}),
        ("README.md", "# Robot\n![ROS 2](https://img.shields.io/badge/ROS2-Humble-blue)\n", {"humble": 2}),
        ("README.md", "Works on humble.\n", {}),
        ("README.md", "# Robot\nNeeds ROS 2 Jazzy.\nInstall ROS2 (jazzy) first.\n", {"jazzy": 2}),
        ("README.md", "ロボットのROS2-Humble, for ROS 2 **Humble**\n", {"humble": 1}),
        ("README.md", "For ROS 2 Humble. A port to ROS 2 Jazzy is planned.\n", {}),
        ("README.md", "The ROS 2 package of rolling robots, with ROS humble beginnings and microROS Jazzy\n", {"humble": 1}),
        ("notes.yaml", "ros_distro: humble\n", {}),
    ],
)
def test_files_name_distributions(path: str, text: str, distros: Mapping[str, int]) -> None:
    assert named({path: text}) == [(distro, path, line) for distro, line in distros.items()]


def test_a_readme_counts_only_if_no_other_file_names_a_distribution() -> None:
    readme = {"README.md": "![](https://img.shields.io/badge/ROS2-jazzy-blue)\n"}
    assert named({**readme, "Dockerfile": "FROM ros:humble\n"}) == [("humble", "Dockerfile", 1)]
    assert named(readme) == [("jazzy", "README.md", 1)]


@pytest.mark.parametrize(
    ("branch", "places"),
    [
        ("humble", [("humble", ".git/HEAD", 1)]),
        ("jazzy-devel", [("jazzy", ".git/HEAD", 1)]),
        ("feature/humble", []),
        ("humbler", []),
        ("main", []),
    ],
)
def test_the_branch_counts_only_if_no_file_names_a_distribution(branch: str, places: list[tuple[str, str, int]]) -> None:
    head = {".git/HEAD": f"ref: refs/heads/{branch}\n"}
    assert named(head) == places
    assert named({**head, "Dockerfile": "FROM ros:rolling\n"}) == [("rolling", "Dockerfile", 1)]


def test_only_a_bounded_number_of_small_files_is_read() -> None:
    assert named({"Dockerfile": "#" * (1 << 16) + "\nFROM ros:humble\n"}) == []
    files = {f".github/workflows/{number:03}.yml": "a: b\n" for number in range(40)}
    assert named({**files, ".github/workflows/z.yml": "ROS_DISTRO: humble\n"}) == []


def test_files_of_the_roots_are_read() -> None:
    assert named({"src/arm/Dockerfile": "FROM ros:humble\n"}, ("src/arm",)) == [("humble", "src/arm/Dockerfile", 1)]


def test_the_named_distributions_are_known_even_if_the_user_chose_one() -> None:
    tree = MemoryTree({"arm/package.xml": manifest_text("arm"), "Dockerfile": "FROM ros:humble\nRUN ls /opt/ros/foxy\n"})
    places = (NamedDistro("humble", "Dockerfile", 1), NamedDistro("foxy", "Dockerfile", 2, indexed=False))
    assert Loader(tree, ("",), TargetDistro("lyrical", "newest LTS", explicit=False)).load().named_distros == places
    assert Loader(tree, ("",), TargetDistro("lyrical", "--distro")).load().named_distros == places


@pytest.mark.parametrize(
    ("places", "sentence"),
    [
        (
            [NamedDistro("humble", CI, 12)],
            f"This repository builds for humble ({CI}:12): pass --distro humble",
        ),
        (
            [NamedDistro("humble", "a", 1), NamedDistro("jazzy", "b", 2), NamedDistro("foxy", "c", 3, indexed=False)],
            "This repository builds for humble (a:1) and jazzy (b:2): pass --distro humble,jazzy",
        ),
        (
            [NamedDistro("foxy", "c", 3, indexed=False)],
            "This repository builds for foxy (c:3), which has no package index here",
        ),
        ([NamedDistro("lyrical", "a", 1), NamedDistro("jazzy", "b", 2)], None),
        ([], None),
    ],
)
def test_the_summary_proposes_the_named_distributions(places: list[NamedDistro], sentence: str | None) -> None:
    target = TargetDistro("lyrical", "newest LTS", explicit=False)
    report = Report((), (), 1, target, "", "0.1", named_distros=tuple(places))
    assert next(limits(report), None) == sentence
