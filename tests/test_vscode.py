"""The extension for Visual Studio Code."""

import json
import shutil
import subprocess
from pathlib import Path

import pytest

from ros_lint import __version__

FOLDER = Path(__file__).parents[1] / "editors" / "vscode"


def test_the_version_is_that_of_ros_lint() -> None:
    assert json.loads((FOLDER / "package.json").read_text("utf-8"))["version"] == __version__


@pytest.mark.skipif(not shutil.which("node"), reason="node is not installed")
def test_the_extension_starts_the_server() -> None:
    process = subprocess.run(["node", "--test"], cwd=FOLDER, capture_output=True, text=True, timeout=60, check=False)
    assert process.returncode == 0, process.stdout
    assert "# pass 3" in process.stdout
