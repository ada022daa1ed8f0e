"""The command ``ros-lint cache`` lists and removes the results of earlier runs."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from ros_lint.base.columns import Codec
from ros_lint.cli.main import main
from ros_lint.workspace.cache.file import CacheFile

ROOT = Path(__file__).parents[1]
CODEC: Codec[str] = Codec(str)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path / "cache" / "ros-lint"


def add(folder: Path, name: str, age: float = 0, *, broken: bool = False) -> Path:
    """Create a workspace with cached results that were used some days ago."""
    workspace = folder.parent.parent / name
    workspace.mkdir(parents=True)
    cache = CacheFile(str(folder), str(workspace))
    cache.write({"facts": "x" * 300_000}, CODEC, lambda names: ())
    if broken:
        Path(cache._path).write_bytes(b"x")
    os.utime(cache._path, (time.time() - age * 86400,) * 2)
    return Path(cache._path)


def printed(capsys: pytest.CaptureFixture[str], *arguments: str, code: int = 0) -> str:
    assert main(["cache", *arguments]) == code
    output = capsys.readouterr()
    return output.out + output.err


def test_workspaces_are_listed(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert printed(capsys, "info") == f"{folder}: 0 workspaces, 0.0 MB (limit 1024.0 MB)\n"
    add(folder, "a")
    add(folder, "old\x1b[31m\n", 3)
    add(folder, "broken", 5, broken=True)
    (folder.parent.parent / "old\x1b[31m\n").rmdir()
    (folder / "other").write_bytes(b"not ours")
    base = folder.parent.parent
    lines = printed(capsys, "info").splitlines()
    assert lines[0] == f"{folder}: 3 workspaces, 0.6 MB (limit 1024.0 MB)"
    today = time.strftime("%Y-%m-%d", time.gmtime())
    assert lines[1].split() == [f"{base}/a", "0.3", "MB", today]
    assert lines[2].startswith(f"  {base}/old\\x1b[31m\\x0a ")
    assert lines[2].endswith("  gone")
    assert lines[3].startswith("  unreadable file ")


def test_workspaces_are_listed_as_json(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, broken = add(folder, "a"), add(folder, "b\udcff", 400, broken=True)
    assert json.loads(printed(capsys, "info", "--format", "json")) == {
        "folder": str(folder),
        "bytes": file.stat().st_size + 1,
        "limit": 1 << 30,
        "workspaces": [
            {
                "path": str(folder.parent.parent / "a"),
                "exists": True,
                "file": str(file),
                "bytes": file.stat().st_size,
                "used": time.strftime("%Y-%m-%d", time.gmtime()),
            },
            {
                "path": None,
                "exists": False,
                "file": str(broken),
                "bytes": 1,
                "used": time.strftime("%Y-%m-%d", time.gmtime(broken.stat().st_mtime)),
            },
        ],
    }


def test_results_are_removed(folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    assert printed(capsys, "clean") == "removed the cached results of 0 workspaces, 0.0 MB\n"
    files = {name: add(folder, name) for name in ("a", "b", "b/c", "bd")}
    files["bd"].write_bytes(b"x")
    (folder / "other").write_bytes(b"not ours")
    (folder / "a.cache.1-1.tmp").write_bytes(b"")
    os.utime(folder / "a.cache.1-1.tmp", (0, 0))
    monkeypatch.chdir(folder.parent.parent / "b")
    assert printed(capsys, "clean", ".", "../nowhere") == "removed the cached results of 2 workspaces, 0.6 MB\n"
    assert sorted(folder.iterdir()) == sorted([files["a"], files["bd"], folder / "other"])
    assert printed(capsys, "clean") == "removed the cached results of 2 workspaces, 0.3 MB\n"
    assert list(folder.iterdir()) == [folder / "other"]


def test_a_folder_that_cannot_be_read_is_an_error(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder.parent.mkdir()
    folder.write_bytes(b"")
    for action in ("info", "clean"):
        assert printed(capsys, action, code=2) == f"ros-lint: '{folder}': Not a directory\n"


def test_without_a_home_there_is_no_cache(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    for name in ("XDG_CACHE_HOME", "HOME", "USERPROFILE"):
        monkeypatch.delenv(name, raising=False)
    for action in ("info", "clean"):
        assert "there is no cache folder, because neither XDG_CACHE_HOME nor HOME is set" in printed(capsys, action, code=2)


def test_a_home_that_does_not_exist_is_not_created(tmp_path: Path) -> None:
    home = tmp_path / "nonexistent"
    environment = {"PATH": os.environ["PATH"], "HOME": str(home)}
    command = [sys.executable, "-m", "ros_lint", str(ROOT / "fixtures" / "workspaces" / "demo")]
    process = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    assert process.returncode == 1, process.stderr
    assert not home.exists()


@pytest.mark.parametrize("arguments", [["--help"], ["info", "--help"], ["clean", "--help"]])
def test_help_describes_the_command(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["cache", *arguments])
    assert ended.value.code == 0
    assert {"clean": "workspaces whose results are removed", "info": "output format"}.get(
        arguments[0], "remove cached results"
    ) in capsys.readouterr().out
