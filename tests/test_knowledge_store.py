"""The folders of data files, and damaged files."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from ros_lint.knowledge import Knowledge, index
from ros_lint.knowledge.store import SHIPPED, KnowledgeError, Table, user_directory


def test_refreshed_data_override_shipped_data(tmp_path: Path) -> None:
    package = index.Released("only_here", "1.0.0", "c", "only_here", {"x": ("rclcpp",)})
    (tmp_path / "jazzy.idx").write_text(index.render_file("jazzy", "", "2030-01-01", [package]))
    known = Knowledge("jazzy", [str(tmp_path)])
    assert list(known.index.names()) == ["only_here"]
    assert known.date == "2030-01-01"
    assert "eigen" in known.rosdep
    assert known.elsewhere("rclcpp") == ("humble", "kilted", "lyrical", "rolling")


def test_the_data_folder_of_the_user_follows_xdg() -> None:
    assert user_directory({"XDG_DATA_HOME": "/data", "HOME": "/home/ada"}) == "/data/ros-lint/index"
    assert user_directory({"XDG_DATA_HOME": "relative", "HOME": "/home/ada"}) == "/home/ada/.local/share/ros-lint/index"


def _damages() -> list[tuple[str, bytes]]:
    complete = Path(SHIPPED, "kilted.idx").read_bytes()
    lines = complete.split(b"\n")
    cuts = random.Random(1).sample(range(1, len(complete) - 1), 20)
    return [
        *((f"cut at {cut}", complete[:cut]) for cut in cuts),
        ("empty", b""),
        ("no head", b"\n".join(lines[1:])),
        ("another head", b"#ros-index 2 distro=kilted packages=1\na\t\tc\n"),
        ("a line missing", b"\n".join(lines[:50] + lines[51:])),
        ("two lines swapped", b"\n".join([*lines[:50], lines[51], lines[50], *lines[52:]])),
        ("binary", bytes(range(256)) * 40),
        ("no UTF-8", complete[:5000] + b"\xff\xfe" + complete[5000:]),
        ("a web page", b"<!DOCTYPE html>\n<html></html>\n"),
    ]


@pytest.mark.parametrize("damage", [data for _, data in _damages()], ids=[name for name, _ in _damages()])
def test_a_damaged_index_is_reported_with_its_path(damage: bytes, tmp_path: Path) -> None:
    path = tmp_path / "kilted.idx"
    path.write_bytes(damage)
    with pytest.raises(KnowledgeError) as raised:
        _ = Knowledge("kilted", [str(tmp_path)]).index
    assert str(path) in str(raised.value)
    assert "index refresh" in str(raised.value) or "format" in str(raised.value)


def test_an_invalid_line_is_reported_with_its_name(tmp_path: Path) -> None:
    (tmp_path / "jazzy.idx").write_text("#ros-index 1 distro=jazzy date=2026-01-01 packages=1\na\t1.0.0\tc\t\tb rclcpp\n")
    (tmp_path / "jazzy.prov").write_text("#ros-provides 1 distro=jazzy packages=1\na\t=\tXY:z\n")
    (tmp_path / "rosdep.tsv").write_text("# key\ta\na\tQ\n")
    known = Knowledge("jazzy", [str(tmp_path)])
    for look_up in (known.index.get, lambda name: known.provided(name, "executables"), known.rosdep.get):
        with pytest.raises(KnowledgeError, match="line of 'a' is invalid"):
            look_up("a")


def test_an_unreadable_index_is_reported_with_its_path(tmp_path: Path) -> None:
    (tmp_path / "jazzy.idx").mkdir()  # no file: what ships is used
    assert Knowledge("jazzy", [str(tmp_path)]).covered
    (tmp_path / "rosdep.tsv").write_text("not a table\n")
    with pytest.raises(KnowledgeError, match="no header line"):
        _ = Knowledge("jazzy", [str(tmp_path)]).rosdep


def test_a_line_may_have_a_single_field() -> None:
    table = Table(["a", "a-b\t1", "ab\t2"])
    assert table.row("a") == ["a"]
    assert table.row("a-b") == ["a-b", "1"]
    assert "ab" in table
    assert "b" not in table
