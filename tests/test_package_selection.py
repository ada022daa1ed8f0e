"""The options that select packages, compared with colcon, and what a run with them reports and fixes."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from random import Random
from typing import Any

import pytest

from ros_lint.cli.main import main
from tests.packages import manifest_text

COLCON = "import sys; from colcon_core.command import main; sys.exit(main(argv=sys.argv[1:]))"
TAGS = ("depend", "build_depend", "exec_depend", "test_depend", "buildtool_depend", "doc_depend")
NAMES = tuple("abcdefghij")


def write_workspace(random: Random, base: Path) -> None:
    """Write packages with random dependencies on earlier ones. Each has a finding: its build script has a missing file."""
    for number, name in enumerate(NAMES):
        folder = base / random.choice(("", "group")) / name
        folder.mkdir(parents=True)
        others = random.sample(NAMES[:number], min(number, random.choice((0, 1, 1, 2))))
        tags = {other: random.choice(TAGS) for other in others}
        lines = [f"<{tag}>{other}</{tag}>" for other, tag in tags.items()]
        (folder / "package.xml").write_text(manifest_text(name, lines), "utf-8")
        (folder / "CMakeLists.txt").write_text(
            f"cmake_minimum_required(VERSION 3.8)\nproject({name})\nfind_package(ament_cmake REQUIRED)\n"
            "add_executable(node missing.cpp)\nament_package()\n",
            "utf-8",
        )


def colcon(base: Path, arguments: Sequence[str]) -> set[str]:
    command = [sys.executable, "-c", COLCON, "--log-base", os.devnull, "list", "--names-only", *arguments]
    environment = {**os.environ, "ROS_VERSION": "2", "COLCON_DEFAULTS_FILE": os.devnull}
    run = subprocess.run(command, cwd=base, env=environment, capture_output=True, text=True, check=True)
    return set(run.stdout.split())


def reported(base: Path, arguments: Sequence[str], capsys: pytest.CaptureFixture[str]) -> Any:
    main([str(base), "--select", "missing-file", "--format", "json", "--no-cache", *arguments])
    return json.loads(capsys.readouterr().out)


@pytest.mark.parametrize(
    "arguments",
    [
        ["--packages-select", "d", "g"],
        ["--packages-up-to", "h"],
        ["--packages-up-to", "j", "e"],
        ["--packages-above", "a"],
        ["--packages-above", "c", "b"],
        ["--packages-select-regex", "[ab]", "g$"],
        ["--packages-skip", "a", "j", "unknown"],
        ["--packages-up-to", "i", "--packages-above", "a", "--packages-skip", "c"],
        ["--packages-select", "a", "--packages-select-regex", "b"],
    ],
    ids=" ".join,
)
def test_the_same_packages_are_selected_as_by_colcon(
    arguments: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_workspace(Random(str(arguments)), tmp_path)
    expected = colcon(tmp_path, arguments)
    if not expected:
        assert main([str(tmp_path), "--no-cache", *arguments]) == 2
        return
    document = reported(tmp_path, arguments, capsys)
    assert {finding["package"] for finding in document["findings"]} == expected
    assert (document["packages"], document["context_packages"]) == (len(expected), len(NAMES) - len(expected))


def test_options_select_among_the_requested_packages(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_workspace(Random(1), tmp_path)
    (tmp_path / ".git").mkdir()
    folder = next(tmp_path.glob("**/c"))
    document = reported(folder, ["--packages-skip", "a"], capsys)
    assert {finding["package"] for finding in document["findings"]} == {"c"}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--packages-select", "tallker"], "--packages-select: there is no package 'tallker'; did you mean 'talker'?"),
        (["--packages-up-to", "x"], "--packages-up-to: there is no package 'x'"),
        (["--packages-above", "x"], "--packages-above: there is no package 'x'"),
        (["--packages-select-regex", "["], "--packages-select-regex: '[' is not a regular expression: "),
        (["--packages-select-regex", "x"], "no package below . is selected by the options --packages-..."),
    ],
)
@pytest.mark.parametrize("mode", [[], ["--diff"]])
def test_a_selection_without_packages_is_an_error(
    arguments: list[str], message: str, mode: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "talker").mkdir()
    (tmp_path / "talker" / "package.xml").write_text(manifest_text("talker"), "utf-8")
    assert main([str(tmp_path), "--no-cache", *mode, *arguments]) == 2
    assert message in capsys.readouterr().err


def test_an_unknown_package_to_skip_is_a_warning(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_workspace(Random(1), tmp_path)
    assert main([str(tmp_path), "--no-cache", "--packages-skip", "aa"]) == 1
    assert "ros-lint: --packages-skip: there is no package 'aa'" in capsys.readouterr().err


def test_a_package_with_an_unusable_manifest_is_selected_by_its_name(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "arm").mkdir()
    (tmp_path / "arm" / "package.xml").write_text(manifest_text("arm", ["<depend>arm</depend>"]), "utf-8")
    assert main([str(tmp_path), "--no-cache", "--packages-select", "arm", "--format", "concise"]) == 1
    assert "[rejected-manifest]" in capsys.readouterr().out


def test_only_selected_packages_are_fixed(tmp_path: Path) -> None:
    for name in ("arm", "hand"):
        (tmp_path / name).mkdir()
        lines = ["<exec_depend>rclcpp</exec_depend>"] * 2
        (tmp_path / name / "package.xml").write_text(manifest_text(name, lines), "utf-8")
    main([str(tmp_path), "--no-cache", "--select", "redundant-dependency", "--fix", "--packages-select", "arm"])
    counts = [(tmp_path / name / "package.xml").read_text("utf-8").count("<exec_depend>") for name in ("arm", "hand")]
    assert counts == [1, 2]
