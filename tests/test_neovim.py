"""The language server in Neovim, which runs without a terminal."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("pygls", reason="pygls is not installed")

pytestmark = [pytest.mark.slow, pytest.mark.skipif(shutil.which("nvim") is None, reason="Neovim is not installed")]

_DEMO = Path(__file__).parents[1] / "fixtures/workspaces/demo"
_SCRIPT = Path(__file__).parent / "neovim.lua"


def test_neovim_shows_a_finding_applies_its_fix_and_jumps_to_a_definition(tmp_path: Path) -> None:
    workspace = (tmp_path / "demo").resolve()
    shutil.copytree(_DEMO, workspace)
    server = [sys.executable, "-m", "ros_lint", "lsp", "--distro", "jazzy", "--no-cache", "--isolated"]
    environment = {
        **os.environ,
        "SERVER": json.dumps(server),
        "WORKSPACE": str(workspace),
        "RESULT": str(tmp_path / "result.json"),
        "HOME": str(tmp_path),
        "XDG_STATE_HOME": str(tmp_path / "state"),
        "XDG_DATA_HOME": str(tmp_path / "data"),
    }
    command = ["nvim", "--headless", "-u", "NONE", "-i", "NONE", "-n", "-c", f"luafile {_SCRIPT}", "-c", "cquit!"]
    done = subprocess.run(command, env=environment, cwd=workspace, capture_output=True, text=True, timeout=300, check=False)
    assert not done.returncode, done.stderr
    result = json.loads((tmp_path / "result.json").read_text("utf-8"))
    assert [message for message in result["diagnostics"] if "sensor_msgs" in message]
    assert "  <depend>sensor_msgs</depend>" in result[f"{workspace}/src/rover_driver/package.xml"]
    assert not (workspace / "src/rover_driver/package.xml").read_text("utf-8").count("sensor_msgs"), "the editor has not saved"
    path, line = result["definition"]
    assert (os.path.relpath(path, workspace), line) == (
        "src/rover_mission/CMakeLists.txt",
        "add_executable(mission_server src/mission_server.cpp)",
    )
