"""Patterns of .gitignore files, compared with git."""

from __future__ import annotations

import random
import shutil
import subprocess
from pathlib import Path

import pytest

from ros_lint.base.gitignore import is_ignored, patterns
from ros_lint.base.tree import MemoryTree
from ros_lint.workspace.discovery.ignore_files import find_ignores

NAMES = ("a", "b.so", "lib", "ab", "x y", "-", "é", "]b", "&")
PIECES = (
    "a", "b.so", "*", "**", "?", "*.so", "lib", "[ab]", "[!a]b", "a*", "ab", r"x\ y", "[a-c]*", "[z-a]", "[l-a]ib",
    "[a-\\\\]", "[--0]", "[&&a]", "[~~]",
    "[[:alpha:]]b", "[[:none:]]", "[]]b", "[", "a[", "*b*", "*[.b]*o", "??", "a\\", r"x\ y ", "[^a]", "[/a]b",
)  # fmt: skip


def _line(choice: random.Random) -> str:
    body = "/".join(choice.choice(PIECES) for _ in range(choice.choice((1, 1, 2, 3))))
    return choice.choice(("", "", "", "!")) + choice.choice(("", "", "/")) + body + choice.choice(("", "", "/"))


@pytest.mark.skipif(not shutil.which("git"), reason="there is no git")
def test_patterns_match_the_same_paths_as_in_git(tmp_path: Path) -> None:
    subprocess.run(["git", "init", "-q", tmp_path], check=True)
    choice = random.Random(20261121)
    paths = {"/".join(choice.choice(NAMES) for _ in range(choice.choice((1, 2, 3, 4)))) for _ in range(80)}
    for path in paths | {"lib"}:
        (tmp_path / path).mkdir(parents=True, exist_ok=True)
    for _ in range(120):
        files = {"": [_line(choice) for _ in range(choice.choice((1, 2, 4)))], "lib": [_line(choice)]}
        for folder, lines in files.items():
            (tmp_path / folder / ".gitignore").write_text("# not this\n\n" + "\n".join(lines) + "\n", "utf-8")
        command = ["git", "check-ignore", "--stdin", "-z", "--no-index"]
        asked = "\0".join(paths).encode()
        output = subprocess.run(command, cwd=tmp_path, input=asked, capture_output=True, check=False).stdout.decode()
        given = [pattern for folder, lines in files.items() for pattern in patterns(folder, "\n".join(lines))]
        assert {path for path in paths if is_ignored(given, path)} == set(filter(None, output.split("\0"))), files


def test_the_last_of_equal_lines_counts() -> None:
    assert [pattern.glob for pattern in patterns("", "a\nb/c\na\n")] == ["b/c", "**/a"]
    assert is_ignored(tuple(patterns("", "a\n!a\na")), "a")
    assert not is_ignored(tuple(patterns("", "!a\na\n!a")), "a")


def test_ignore_files_are_read_above_packages_and_in_them() -> None:
    tree = MemoryTree(
        {".gitignore": "*.so\n", "src/.gitignore": "!keep.so\n", "src/arm/.gitignore": "/made\n", "x/.gitignore": "*\n"}
    )
    given = find_ignores(tree, [("src/arm", (".gitignore", "a.cpp"))]).patterns
    assert is_ignored(given, "src/arm/lib/a.so")
    assert not is_ignored(given, "src/arm/lib/keep.so")
    assert is_ignored(given, "src/arm/made/a.yaml")
    assert not is_ignored(given, "src/arm/sub/made")
    assert not is_ignored((), "src/arm/made/a.yaml")
