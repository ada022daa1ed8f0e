"""A process of ros-lint loads no module from the current folder."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import ros_lint
import ros_lint_rules
from ros_lint.cli import start

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parent.parent
DEMO = ROOT / "fixtures" / "workspaces" / "demo"
OTHERS = ("libcst", "lxml", "networkx", "ros_lint_rules", "tomli", "yaml")
PLACES = [str(Path(module.__path__[0]).parent) for module in (ros_lint, ros_lint_rules)]


@pytest.fixture
def script(tmp_path: Path) -> Path:
    """The console script as installers write it."""
    entry = re.search(r'^ros-lint = "(.*):(.*)"$', (ROOT / "pyproject.toml").read_text(), re.MULTILINE)
    assert entry
    path = tmp_path / "bin" / "ros-lint"
    path.parent.mkdir()
    path.write_text(f"import sys\nfrom {entry[1]} import {entry[2]}\nif __name__ == '__main__':\n    sys.exit({entry[2]}())\n")
    return path


@pytest.mark.parametrize("jobs", ["1", "2"])
@pytest.mark.parametrize("empty", ["", ".", "FOLDER"])
def test_the_console_script_loads_no_module_of_the_current_folder(
    script: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, empty: str, jobs: str
) -> None:
    """What Python loads to get to the script is out of reach."""
    folder = tmp_path / "folder"
    folder.mkdir()
    rest = [*PLACES, *filter(os.path.isabs, os.environ.get("PYTHONPATH", "").split(os.pathsep))]
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([empty.replace("FOLDER", str(folder)), *rest]))
    (script.parent / "bare").write_text("import sys\nprint(*sys.modules)\n")
    bare = subprocess.run([sys.executable, script.parent / "bare"], capture_output=True, text=True, cwd=folder, check=True)
    for name in {*sys.stdlib_module_names, *OTHERS}.difference(bare.stdout.split()):
        (folder / f"{name}.py").write_text("open(__file__ + '.loaded', 'w').close()\nraise SystemExit(3)\n")
    arguments = [str(DEMO), "--distro", "jazzy", "--no-cache", "--pedantic", "--jobs", jobs]
    process = subprocess.run([sys.executable, script, *arguments], capture_output=True, text=True, cwd=folder, check=False)
    assert sorted(path.name for path in folder.glob("*.loaded")) == []
    assert process.returncode == 1, process.stderr


def test_the_current_folder_is_removed_from_the_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "here").mkdir()
    (tmp_path / "link").symlink_to("here")
    here, link, other = (str(tmp_path / name) for name in ("here", "link", "other"))
    monkeypatch.chdir(here)
    monkeypatch.delenv("PYTHONSAFEPATH", raising=False)
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(["", other, here, link, "."]))
    monkeypatch.setattr(sys, "path", ["", other, here, link, f"{here}/lib"])
    start.leave_current_folder()
    assert sys.path == [other, f"{here}/lib"]
    assert (os.environ["PYTHONPATH"], os.environ["PYTHONSAFEPATH"]) == (other, "1")


def test_a_current_folder_with_ros_lint_comes_last(monkeypatch: pytest.MonkeyPatch) -> None:
    home = os.path.dirname(os.path.dirname(os.path.realpath(start.__file__)))
    monkeypatch.chdir(home)
    monkeypatch.setenv("PYTHONSAFEPATH", "")
    monkeypatch.setattr(sys, "path", [home, "/elsewhere"])
    start.leave_current_folder()
    assert sys.path == ["/elsewhere", home]


def test_a_deleted_current_folder_raises_no_error(tmp_path: Path) -> None:
    code = (
        "import os, sys; os.rmdir(os.getcwd()); sys.argv = ['ros-lint', '--version']; from ros_lint.cli.start import run; run()"
    )
    (tmp_path / "gone").mkdir()
    process = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=tmp_path / "gone", check=False)
    assert (process.returncode, process.stdout) == (0, f"ros-lint {ros_lint.__version__}\n"), process.stderr
