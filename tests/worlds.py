"""Worlds of a few packages, and an installed prefix."""

from __future__ import annotations

from pathlib import Path

from ros_lint.knowledge import Knowledge
from ros_lint.knowledge import underlays as underlay
from ros_lint.knowledge.world import Member, World


def world(*members: Member, distro: str = "jazzy", prefixes: tuple[str, ...] = ()) -> World:
    return World(members, underlay.read(prefixes), Knowledge(distro))


def member(name: str, version: str = "1.0.0", groups: tuple[str, ...] = (), **kinds: tuple[str, ...]) -> Member:
    return Member(name, version, kinds, groups)


def write_prefix(tmp_path: Path) -> str:
    manifest = (
        "<package format='3'><name>{0}</name><version>{1}</version><description>d</description>"
        "<maintainer email='a@robots.example'>A</maintainer><license>A</license>{2}</package>"
    )
    for name, version, depends in (
        ("rclcpp", "99.0.0", "<depend>private_base</depend>"),
        ("private_base", "1.0.0", "<exec_depend>std_msgs</exec_depend>"),
        ("private_tool", "1.0.0", "<exec_depend>rclcpp</exec_depend><depend>rclpy</depend>"),
    ):
        (tmp_path / "share" / name).mkdir(parents=True)
        (tmp_path / "share" / name / "package.xml").write_text(manifest.format(name, version, depends))
        (tmp_path / "include" / name / name).mkdir(parents=True)
        (tmp_path / "include" / name / name / f"{name}.hpp").touch()
    (tmp_path / "lib/private_tool").mkdir(parents=True)
    (tmp_path / "lib/private_tool/tool").touch(0o755)
    return str(tmp_path)
