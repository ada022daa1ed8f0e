"""Links that lead out of a workspace: their text is not shown, and nothing is written where they lead."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from ros_lint.base.tree import LEADS_OUT, DiskTree
from tests.test_bad_input import GOOD, lint, package, rules, script_package

pytestmark = pytest.mark.slow

SECRET = "the_secret_line"
FORMATS = ("text", "sarif")
"""Those that show lines of files."""
LAUNCH = """import os
from launch import LaunchDescription
from launch_ros.actions import Node
from ament_index_python.packages import get_package_share_directory


def generate_launch_description():
    name = open(os.path.join(get_package_share_directory('robot'), 'config', 'c.yaml')).read()
    return LaunchDescription([Node(package='robot', executable=name)])
"""
OTHERS = {
    "package.xml": GOOD.format("robot").replace("  <export>", f"  <depend>{SECRET}</depend>\n  <export>"),
    "CMakeLists.txt": f"project(robot)\nfind_package(ament_cmake)\nfind_package(sensor_msgs) # {SECRET}\nament_package()\n",
    "helpers.cmake": f"find_package(sensor_msgs REQUIRED)  # {SECRET}\n",
    "setup.py": f"import sensor_msgs  # {SECRET}\n",
    "src/a.cpp": f"#include <nav_msgs/msg/path.hpp>  // {SECRET}\n",
    "config/c.yaml": SECRET,
}


def shown(folder: Path) -> str:
    """Return all that is said of a workspace."""
    return "".join(ran.text + ran.err for form in FORMATS for ran in [lint(folder, "--pedantic", "--format", form, text=True)])


@pytest.mark.parametrize("file", OTHERS)
def test_what_lies_elsewhere_is_not_shown(tmp_path: Path, file: str) -> None:
    robot = package(tmp_path / "ws" / "robot", "robot")
    (robot / "launch").mkdir()
    (robot / "launch" / "a.launch.py").write_text(LAUNCH)
    with (robot / "CMakeLists.txt").open("a") as script:
        script.write("install(DIRECTORY launch config DESTINATION share/${PROJECT_NAME})\ninclude(helpers.cmake)\n")
    place = robot / file
    place.parent.mkdir(exist_ok=True)
    place.unlink(missing_ok=True)
    (tmp_path / "elsewhere").write_text(OTHERS[file])
    place.write_text(OTHERS[file])
    assert SECRET in shown(tmp_path / "ws"), "the same in the workspace is shown"
    place.unlink()
    place.symlink_to("../../elsewhere" if "/" not in file else "../../../elsewhere")
    assert SECRET not in shown(tmp_path / "ws")
    not_checked = {entry["what"]: entry["reason"] for entry in lint(tmp_path / "ws").out["not_checked"]}
    assert not_checked == {f"robot/{file}": LEADS_OUT}


def linked_package(tmp_path: Path) -> Path:
    """Make a workspace with one package of its own, and one that is a link to a checkout elsewhere."""
    package(tmp_path / "ws" / "src" / "own", "own")
    linked = package(tmp_path / "checkouts" / "linked", "linked")
    (tmp_path / "ws" / "src" / "linked").symlink_to(linked)
    return linked


def test_a_linked_package_is_checked_and_not_written(tmp_path: Path) -> None:
    linked = linked_package(tmp_path)
    before = (linked / "package.xml").read_bytes()
    ran = lint(tmp_path / "ws")
    assert (ran.out["packages"], ran.out["not_checked"]) == (2, [])
    assert rules(ran, "src/linked/") == rules(ran, "src/own/") == ["undeclared-dependency"]
    for flag in ("--diff", "--fix"):
        ran = lint(tmp_path / "ws", flag, text=True)
        reason = "'src/linked/package.xml' is outside the folders to check"
        assert f"src/linked/CMakeLists.txt:4:14: fix skipped: {reason} [undeclared-dependency]" in ran.err
        assert "b/src/linked" not in ran.text
    assert (linked / "package.xml").read_bytes() == before
    assert "sensor_msgs" in (tmp_path / "ws" / "src" / "own" / "package.xml").read_text()
    assert sorted(path.name for path in linked.iterdir()) == ["CMakeLists.txt", "package.xml"]


def test_a_linked_package_that_is_asked_for_is_written(tmp_path: Path) -> None:
    linked = linked_package(tmp_path)
    assert lint(tmp_path / "ws" / "src" / "linked", "--fix").code == 0
    assert "sensor_msgs" in (linked / "package.xml").read_text()


@pytest.mark.parametrize("what", ["ws", "src"])
def test_a_workspace_behind_a_link_is_written(tmp_path: Path, what: str) -> None:
    package(tmp_path / "real" / "robot", "robot")
    if what == "ws":
        (tmp_path / "ws").symlink_to("real")
    else:
        (tmp_path / "ws").mkdir()
        (tmp_path / "ws" / "src").symlink_to(tmp_path / "real")
    ran = lint(tmp_path / "ws" if what == "ws" else tmp_path / "ws" / "src", "--fix")
    assert (ran.code, ran.out["packages"]) == (0, 1)
    assert "sensor_msgs" in (tmp_path / "real" / "robot" / "package.xml").read_text()


def test_a_linked_manifest_is_not_written(tmp_path: Path) -> None:
    robot = package(tmp_path / "ws" / "robot", "robot")
    elsewhere = tmp_path / "elsewhere.xml"
    (robot / "package.xml").rename(elsewhere)
    (robot / "package.xml").symlink_to(elsewhere)
    before = elsewhere.read_bytes()
    ran = lint(tmp_path / "ws", "--fix")
    assert [(entry["what"], entry["reason"]) for entry in ran.out["not_checked"]] == [("robot/package.xml", LEADS_OUT)]
    assert elsewhere.read_bytes() == before


def test_a_fix_does_not_create_a_file_elsewhere(tmp_path: Path) -> None:
    script_package(tmp_path / "ws" / "robot")
    (tmp_path / "ws" / "robot" / "setup.cfg").symlink_to("../../setup.cfg")
    ran = lint(tmp_path / "ws", "--fix")
    assert "fix skipped: 'robot/setup.cfg' is outside the folders to check" in ran.err
    assert not (tmp_path / "setup.cfg").exists()


def test_a_file_with_two_names_is_not_written(tmp_path: Path) -> None:
    package(tmp_path / "first", "first")
    second = package(tmp_path / "second", "second")
    (second / "CMakeLists.txt").unlink()
    (second / "CMakeLists.txt").symlink_to("../first/CMakeLists.txt")
    before = (tmp_path / "first" / "CMakeLists.txt").read_bytes()
    for _ in range(2):
        ran = lint(tmp_path, "--fix", "--unsafe-fixes")
        reason = "'first/CMakeLists.txt' and 'second/CMakeLists.txt' are the same file"
        assert f"fix skipped: {reason} [name-mismatch]" in ran.err
        assert (tmp_path / "first" / "CMakeLists.txt").read_bytes() == before
    assert "nothing to fix" in ran.err
    assert "sensor_msgs" in (second / "package.xml").read_text(), "which is a file of its own"


def test_links_within_the_workspace_are_read_and_written(tmp_path: Path) -> None:
    robot = package(tmp_path / "robot", "robot")
    (tmp_path / "shared").mkdir()
    (robot / "package.xml").rename(tmp_path / "shared" / "robot.xml")
    (robot / "package.xml").symlink_to("../shared/robot.xml")
    ran = lint(tmp_path, "--fix")
    assert (ran.code, ran.out["not_checked"]) == (0, [])
    assert (robot / "package.xml").is_symlink()
    assert "sensor_msgs" in (tmp_path / "shared" / "robot.xml").read_text()


def test_where_links_may_lead(tmp_path: Path) -> None:
    for name in ("ws/src/p", "repository/linked/config", "repository/shared", "two"):
        (tmp_path / name).mkdir(parents=True)
    for name in ("ws/shared", "ws/src/p/a", "repository/linked/config/a", "repository/shared/a", "two/a", "outside"):
        (tmp_path / name).write_text(name)
    (tmp_path / "ws" / "src" / "linked").symlink_to(tmp_path / "repository" / "linked")
    links = {
        "ws/src/p/in": "../../shared",
        "ws/src/p/chain": "in",
        "ws/src/p/two": "../../../two/a",
        "ws/src/p/out": "../../../outside",
        "ws/src/p/in_linked": "../../../repository/linked/config/a",
        "ws/src/p/loop": "loop",
        "ws/src/p/broken": "nowhere",
        "repository/linked/in": "config/a",
        "repository/linked/config/up": "../../shared/a",
        "repository/linked/config/back": "../../../ws/shared",
        "repository/linked/config/out": "../../../outside",
    }
    for place, target in links.items():
        (tmp_path / place).symlink_to(target)

    def readable(tree: DiskTree) -> set[str]:
        found = set()
        for path in ("src/p", "src/linked", "src/linked/config"):
            for entry in tree.list(path):
                try:
                    found |= {f"{path}/{entry.name}"} if tree.read(f"{path}/{entry.name}") else set()
                except OSError:
                    continue
        return found

    own = {"src/p/a", "src/p/in", "src/p/chain"}
    linked = {"src/linked/in", "src/linked/config/a", "src/linked/config/back"}
    base = str(tmp_path / "ws")
    assert readable(DiskTree(base)) == own | linked
    assert readable(DiskTree(base, (base, str(tmp_path / "two")))) == own | linked | {"src/p/two"}
    (tmp_path / "repository" / ".git").mkdir()
    assert readable(DiskTree(base)) == own | linked | {"src/linked/config/up"}
    (tmp_path / "again").symlink_to(base)
    assert readable(DiskTree(str(tmp_path / "again"))) == own | linked | {"src/linked/config/up"}


def test_two_workspaces_do_not_open_what_lies_around_them(tmp_path: Path) -> None:
    for name in ("first", "second"):
        package(tmp_path / name, name)
    (tmp_path / "elsewhere").write_text("find_package(nav_msgs REQUIRED)\n")
    (tmp_path / "first" / "a.cmake").symlink_to("../elsewhere")
    (tmp_path / "first" / "b.cmake").symlink_to("../second/CMakeLists.txt")
    ran = lint(tmp_path / "first", tmp_path / "second")
    assert [entry["what"] for entry in ran.out["not_checked"]] == ["first/a.cmake"]
    (tmp_path / ".git").mkdir()
    assert lint(tmp_path / "first", tmp_path / "second").out["not_checked"] == []


def not_checked(cache: Path, *folders: Path) -> list[str]:
    """Return what is not checked in a run that keeps what it reads."""
    command = [sys.executable, "-m", "ros_lint", *map(str, folders), "--format", "json"]
    done = subprocess.run(command, capture_output=True, check=False, env={**os.environ, "XDG_CACHE_HOME": str(cache)})
    return [entry["what"] for entry in json.loads(done.stdout)["not_checked"]]


def test_a_kept_report_knows_where_links_lead(tmp_path: Path) -> None:
    robot = package(tmp_path / "ws" / "robot", "robot")
    for place in (tmp_path / "elsewhere", tmp_path / "ws" / "inside"):
        place.write_text("find_package(nav_msgs REQUIRED)\n")

    for target, expected in (("../../elsewhere", ["robot/a.cmake"]), ("../inside", []), ("../../elsewhere", ["robot/a.cmake"])):
        (robot / "a.cmake").unlink(missing_ok=True)
        (robot / "a.cmake").symlink_to(target)
        assert [not_checked(tmp_path / "cache", tmp_path / "ws") for _ in range(2)] == [expected, expected]


def test_what_is_kept_depends_on_where_links_may_lead(tmp_path: Path) -> None:
    for name in ("first", "second"):
        package(tmp_path / "ws" / name, name)
    (tmp_path / "ws" / "shared").write_text("find_package(nav_msgs REQUIRED)\n")
    (tmp_path / "ws" / "first" / "a.cmake").symlink_to("../shared")
    both = [tmp_path / "ws" / "first", tmp_path / "ws" / "second"]
    for name, wide_first in (("a", True), ("b", False)):
        runs = [((tmp_path / "ws",), []), (both, ["first/a.cmake"])]
        for folders, expected in runs if wide_first else reversed(runs):
            assert not_checked(tmp_path / name, *folders) == expected
