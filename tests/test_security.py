"""The promises of docs/security.md: each has a test that exists, and those without another place are here."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
DEMO = ROOT / "fixtures" / "workspaces" / "demo"
PAGE = (ROOT / "docs" / "security.md").read_text("utf-8")
_NAME = re.compile(r"`(test_\w+\.py)::(test_\w+)`")


def test_each_promise_has_a_test_that_exists() -> None:
    rows = [line for line in PAGE.splitlines() if line.startswith("| ") and not line.startswith("| input ")]
    assert rows
    assert [row for row in rows if not _NAME.search(row)] == []
    for file, name in _NAME.findall(PAGE):
        tree = ast.parse((ROOT / "tests" / file).read_text("utf-8"))
        assert name in {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}, f"{file}::{name}"


_WITHOUT_NETWORK = """
import os, sys
def refuse(event, arguments):
    if event.startswith("socket.") or event in ("subprocess.Popen", "os.exec", "os.system", "os.posix_spawn"):
        print("refused", event, arguments, file=sys.stderr, flush=True)
        os._exit(9)
sys.addaudithook(refuse)
from ros_lint.cli.main import main
sys.exit(main(sys.argv[1:]))
"""


@pytest.mark.slow
@pytest.mark.parametrize("arguments", [("--pedantic",), ("--pedantic", "--diff", "--unsafe-fixes"), ("--format", "sarif")])
def test_a_check_uses_no_network(arguments: tuple[str, ...]) -> None:
    command = [sys.executable, "-c", _WITHOUT_NETWORK, str(DEMO), "--distro", "jazzy", "--jobs", "1", "--no-cache", *arguments]
    process = subprocess.run(command, capture_output=True, text=True, check=False)
    assert process.returncode in (0, 1), process.stderr


@pytest.mark.slow
def test_the_refusal_of_sockets_works() -> None:
    code = _WITHOUT_NETWORK.replace("from ros_lint.cli.main import main", "import socket; socket.socket()")
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, check=False).returncode == 9


@pytest.mark.slow
@pytest.mark.parametrize(
    "text",
    [
        'output = "../stolen"\nfix = true\n',
        'baseline = "../stolen"\nwrite-baseline = true\n',
        'baseline = "../stolen"\n',
        "fix = true\nunsafe-fixes = true\n",
    ],
)
def test_a_configuration_writes_nothing(tmp_path: Path, text: str) -> None:
    folder = tmp_path / "ws" / "a"
    folder.mkdir(parents=True)
    manifest = (
        '<package format="3"><name>a</name><version>0.1.0</version><description>d</description>'
        '<maintainer email="a@b.org">A</maintainer><license>MIT</license><depend>rclcpp</depend><depend>rclcpp</depend></package>'
    )
    (folder / "package.xml").write_text(manifest)
    (tmp_path / "ws" / "ros-lint.toml").write_text(text)
    command = [sys.executable, "-m", "ros_lint", str(tmp_path / "ws"), "--no-cache", "--distro", "jazzy", "--jobs", "1"]
    subprocess.run(command, capture_output=True, check=False)
    assert sorted(path.name for path in tmp_path.rglob("*") if path.is_file()) == ["package.xml", "ros-lint.toml"]
    assert (folder / "package.xml").read_text() == manifest
