"""The files that git tracks, compared with git itself, and the tree of these files."""

from __future__ import annotations

import hashlib
import json
import os
import random
import subprocess
from pathlib import Path
from typing import Any

import pytest

from ros_lint.base.git_index import Tracked, parse_index, read_index
from ros_lint.base.tracked_tree import TrackedTree
from ros_lint.cli.main import main
from tests.packages import manifest_text

NAMES = ("a", "b.txt", "src", "include", "läufer", "with space", "a" * 150, "x.cpp", "é\n", "CMakeLists.txt")
CMAKE = "cmake_minimum_required(VERSION 3.8)\nproject(arm)\nfind_package(ament_cmake REQUIRED)\n"
CMAKE += "add_executable(node src/node.cpp src/extra.cpp)\ninstall(TARGETS node DESTINATION lib/arm)\nament_package()\n"


def git(folder: Path, *arguments: str) -> bytes:
    identity = ("-c", "user.name=a", "-c", "user.email=a@b.cc", "-c", "init.defaultBranch=main", "-c", "commit.gpgsign=false")
    environment = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
    return subprocess.run(["git", *identity, *arguments], cwd=folder, env=environment, check=True, capture_output=True).stdout


def listed(folder: Path) -> Tracked:
    """Return what git itself lists."""
    entries = [entry.split(b"\t", 1) for entry in git(folder, "ls-files", "-s", "-z").split(b"\0") if entry]
    names = frozenset(os.fsdecode(name) for _, name in entries)
    return Tracked(names, frozenset(os.fsdecode(name) for head, name in entries if head[:6] in (b"120000", b"160000")))


def write_files(folder: Path, seed: int, count: int) -> None:
    chance = random.Random(seed)
    for _ in range(count):
        place = folder.joinpath(*(f"{chance.choice(NAMES)}{chance.randrange(20)}" for _ in range(chance.randint(1, 4))))
        if any(above.is_file() or above.is_symlink() for above in place.parents) or place.exists():
            continue
        place.parent.mkdir(parents=True, exist_ok=True)
        if chance.random() < 0.1:
            place.symlink_to("nowhere")
        else:
            place.write_text("x", "utf-8")


@pytest.mark.parametrize("version", [2, 3, 4])
@pytest.mark.parametrize("form", ["sha1", "sha256"])
def test_the_index_is_read_as_git_does(tmp_path: Path, version: int, form: str) -> None:
    git(tmp_path, "init", "-q", f"--object-format={form}")
    for seed in range(3):
        write_files(tmp_path, seed, 150)
        git(tmp_path, "add", ".")
        (tmp_path / f"later{seed}").touch()
        if version == 3:
            git(tmp_path, "add", "--intent-to-add", f"later{seed}")  # an extended flag
        git(tmp_path, "update-index", "--index-version", str(version))
        assert (tmp_path / ".git" / "index").read_bytes()[7] == version
        assert len(listed(tmp_path).files) > 50
        assert read_index(str(tmp_path), {}) == listed(tmp_path)
        git(tmp_path, "commit", "-q", "-m", "x")  # adds the extension TREE
        assert read_index(str(tmp_path), {}) == listed(tmp_path)


def test_work_trees_submodules_and_other_indexes(tmp_path: Path) -> None:
    main_tree, other = tmp_path / "main", tmp_path / "other"
    for folder in (main_tree, other):
        folder.mkdir()
        git(folder, "init", "-q")
        (folder / f"{folder.name}.txt").touch()
        git(folder, "add", ".")
        git(folder, "commit", "-q", "-m", "x")
    git(main_tree, "-c", "protocol.file.allow=always", "submodule", "add", "-q", str(other), "lib/other")
    git(main_tree, "commit", "-q", "-m", "y")
    assert read_index(str(main_tree), {}) == listed(main_tree)
    assert read_index(str(main_tree), {}).links == {"lib/other"}  # type: ignore[union-attr]
    assert read_index(str(main_tree / "lib" / "other"), {}) == ({"other.txt"}, frozenset())
    git(main_tree, "worktree", "add", "-q", str(tmp_path / "second"))
    (tmp_path / "second" / "new.txt").touch()
    git(tmp_path / "second", "add", "new.txt")
    assert read_index(str(tmp_path / "second"), {}) == listed(tmp_path / "second")
    index = tmp_path / "second" / ".git"
    named = os.path.join(index.read_text("utf-8").removeprefix("gitdir: ").strip(), "index")
    assert read_index(str(main_tree), {"GIT_INDEX_FILE": named}) == listed(tmp_path / "second")


def test_a_damaged_or_incomplete_index_is_unknown(tmp_path: Path) -> None:
    assert read_index(str(tmp_path), {}) is None
    git(tmp_path, "init", "-q")
    assert read_index(str(tmp_path), {}) is None
    write_files(tmp_path, 1, 20)
    git(tmp_path, "add", ".")
    place = tmp_path / ".git" / "index"
    data = place.read_bytes()
    assert parse_index(data) is not None
    assert parse_index(data[:-20] + bytes(20)) == parse_index(data)  # index.skipHash
    for cut in range(len(data)):
        assert parse_index(data[:cut]) is None
        content = data[:cut]
        with_checksum = content + hashlib.sha1(content, usedforsecurity=False).digest()
        assert parse_index(with_checksum) is None or cut == len(data) - 20
    assert parse_index(data[:30] + b"x" + data[31:]) is None
    git(tmp_path, "update-index", "--split-index")
    assert read_index(str(tmp_path), {}) is None
    place.unlink()
    os.mkfifo(place)
    assert read_index(str(tmp_path), {}) is None


def test_the_tree_has_tracked_files_and_other_repositories_only(tmp_path: Path) -> None:
    git(tmp_path, "init", "-q")
    for name in ("src/a.cpp", "deps/robot/.git/x", "deps/robot/b.cpp", "deps/notes.txt", "scratch/c.cpp", "real/d.cpp"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    (tmp_path / "link").symlink_to("real")
    git(tmp_path, "add", "src", "link")
    (tmp_path / "src" / "new.cpp").touch()
    tracked = read_index(str(tmp_path), {})
    assert tracked is not None
    tree = TrackedTree(str(tmp_path), (str(tmp_path),), tracked)
    names = {folder: [entry.name for entry in tree.list(folder)] for folder in ("", "src", "deps", "deps/robot", "link")}
    assert names == {
        "": ["deps", "link", "src"],
        "src": ["a.cpp"],
        "deps": ["robot"],
        "deps/robot": [".git", "b.cpp"],
        "link": ["d.cpp"],
    }
    assert tree.read("deps/robot/b.cpp") == tree.read("link/d.cpp") == b""
    for path in ("src/new.cpp", "scratch/c.cpp", "deps/notes.txt"):
        assert tree.is_untracked(path)
        with pytest.raises(FileNotFoundError):
            tree.read(path)
        with pytest.raises(FileNotFoundError):
            tree.stamp(path)
    assert not any(map(tree.is_untracked, ("src/a.cpp", "src/nowhere.cpp", "deps/robot/b.cpp", "../x")))


def test_a_hook_checks_what_git_tracks(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.delenv("GIT_INDEX_FILE", raising=False)
    root = tmp_path / "repository"
    (root / "arm" / "src").mkdir(parents=True)
    git(root, "init", "-q")
    (root / "arm" / "package.xml").write_text(manifest_text("arm", ["<buildtool_depend>ament_cmake</buildtool_depend>"]), "utf-8")
    (root / "arm" / "CMakeLists.txt").write_text(CMAKE, "utf-8")
    (root / "arm" / "src" / "node.cpp").write_text("int main() {}\n", "utf-8")
    git(root, "add", ".")
    (root / "arm" / "src" / "extra.cpp").touch()
    (root / "scratch").mkdir()
    (root / "scratch" / "package.xml").write_text("<package", "utf-8")

    def findings() -> list[Any]:
        main([str(root), "--format", "json", "--distro", "jazzy"])
        return [(finding["rule"], finding["message"]) for finding in json.loads(capsys.readouterr().out)["findings"]]

    message = "'src/extra.cpp' exists, but git does not track it, so a clone lacks it; run git add"
    assert [rule for rule, _ in findings()] == ["rejected-manifest"]
    monkeypatch.setenv("PRE_COMMIT", "1")
    assert findings() == [("missing-file", message)]
    assert findings() == [("missing-file", message)]
    git(root, "add", "arm")
    assert findings() == []
    git(root, "rm", "-q", "--cached", "arm/src/extra.cpp")
    (root / "arm" / "src" / "extra.cpp").unlink()
    assert ["git" in message for _, message in findings()] == [False]
    (root / ".git" / "index").write_bytes(b"DIRC")
    assert [rule for rule, _ in findings()] == ["missing-file", "rejected-manifest"]
