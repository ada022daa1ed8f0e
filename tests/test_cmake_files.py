"""Comparison of file(GLOB) and commands for paths with CMake."""

from __future__ import annotations

import random
import shutil
import subprocess
from pathlib import Path

import pytest

import ros_lint.collectors.cmake.evaluate  # noqa: F401  (it registers the commands and blocks)
from ros_lint.base.text import Text
from ros_lint.base.tree import DiskTree
from ros_lint.collectors.cmake.evaluator import flow as cmake_flow
from ros_lint.collectors.cmake.evaluator.run import Run
from ros_lint.collectors.cmake.evaluator.sources import Sources
from ros_lint.collectors.cmake.evaluator.state import CallFrame
from ros_lint.collectors.cmake.evaluator.values import HOLE, TREE, is_fixed
from ros_lint.collectors.cmake.syntax import parse
from ros_lint.workspace.build_scripts.sources import Surroundings

try:
    from cmake import CMAKE_BIN_DIR  # type: ignore[import-not-found, unused-ignore]  # of the wheel on PyPI

    CMAKE = shutil.which("cmake", path=CMAKE_BIN_DIR)
except ImportError:
    CMAKE = shutil.which("cmake")

FILES = (
    "src/a.cpp", "src/b.cpp", "src/b.hpp", "src/sub/c.cpp", "src/sub/deep/d.cpp", "src/a-1.cpp", "src/.hidden.cpp", "src/[x].cpp",
    "launch/a.launch.py", "launch/B.launch.py", "launch/é.launch.py", "a.txt", "b.c.txt", "a b/c.txt", "script",
)  # fmt: skip
OUTSIDE = ("config/a.yaml", "config/deep/b.yaml", "other/src/z.cpp", "top.txt", "pack/x.txt")
"""Files outside of ``package``, the folder of the package."""


def _line(choice: random.Random) -> str:
    pick = choice.choice
    top = pick(("", "", "${CMAKE_CURRENT_SOURCE_DIR}/", "${CMAKE_CURRENT_LIST_DIR}/", "./"))
    patterns = (
        "src/*.cpp", "src/*", "*", "src/[ab].cpp", "src/?.*pp", "src/*/*.cpp", "*/*.cpp", "launch/*.launch.py", "*.txt",
        "src/sub", "src/[!a]*.cpp", "sr?/sub/*", "nothing/*", "src/[a-b]*", "src/../*.txt", "src/a.cpp", "launch/[A-Z]*",
        "../config/*", "../*.txt", "../*/*.yaml", "../other/../package/*.txt", "src/../../other/src/*", "../*", "../pack/x.txt",
        "[z-a]*", "src/[b-a].cpp", "src/[!b-a].cpp", "src/a[--0]1.cpp", "src/*[&&~~b]*p", "*a*.*n*h*y",
        "[]x]*/[[]*", "src/*.c*p*", "launch/?.l*",
    )  # fmt: skip
    paths = (
        "src/a.cpp", "src/sub/c.tar.gz", "/abs/path/x.y.z", "a.txt", ".hidden", "dir.d/file", "../up.txt", "src/./a/../b.cpp",
        "noext", "${CMAKE_CURRENT_SOURCE_DIR}/src/a.cpp", "dir/", "x..y", "", "/", "${CMAKE_CURRENT_SOURCE_DIR}",
        "${CMAKE_CURRENT_SOURCE_DIR}/..", "${CMAKE_CURRENT_SOURCE_DIR}/../package/a.txt",
    )  # fmt: skip
    roll = choice.random()
    if roll < 0.5:
        mode = pick(("GLOB", "GLOB_RECURSE"))
        options = " ".join(
            pick(("", "", option))
            for option in (
                f"LIST_DIRECTORIES {pick(('true', 'false', 'Y', 'off'))}",
                f"RELATIVE {pick(('${CMAKE_CURRENT_SOURCE_DIR}', '${CMAKE_CURRENT_SOURCE_DIR}/src'))}",
            )
        )
        return f'file({mode} V {options} "{top}{pick(patterns)}"{pick(("", f" {chr(34)}{top}{pick(patterns)}{chr(34)}"))})'
    if roll < 0.85:
        mode = pick(("NAME", "NAME_WE", "EXT", "LAST_EXT", "NAME_WLE", "DIRECTORY", "PATH", "ABSOLUTE"))
        base = pick(("", "", " BASE_DIR /base", " BASE_DIR ${CMAKE_CURRENT_SOURCE_DIR}/src")) if mode == "ABSOLUTE" else ""
        return f'get_filename_component(V "{pick(paths)}" {mode}{base})'
    absolute = (
        "${CMAKE_CURRENT_SOURCE_DIR}/src/a.cpp", "${CMAKE_CURRENT_SOURCE_DIR}/b", "${CMAKE_CURRENT_SOURCE_DIR}",
        "${CMAKE_CURRENT_SOURCE_DIR}/../config", "${CMAKE_CURRENT_SOURCE_DIR}/../package",
    )  # fmt: skip
    return f'file(RELATIVE_PATH V "{pick(absolute)}" "{pick(absolute)}")'


@pytest.mark.skipif(CMAKE is None, reason="cmake is not installed")
def test_files_and_paths_equal_those_of_cmake(tmp_path: Path) -> None:
    choice = random.Random(5)
    lines = list(dict.fromkeys(_line(choice) for _ in range(800)))
    tree = tmp_path / "tree"
    folder = tree / "package"
    for path in (*(folder / path for path in FILES), *(tree / path for path in OUTSIDE)):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("")
    script = tmp_path / "script.cmake"
    dumps = "\n".join(f'set(V)\n{line}\nfile(APPEND "${{OUT}}" "{number} ${{V}}\\n")' for number, line in enumerate(lines))
    script.write_text(
        f"cmake_minimum_required(VERSION 3.20)\nset(CMAKE_CURRENT_LIST_DIR ${{CMAKE_CURRENT_SOURCE_DIR}})\n{dumps}\n"
    )
    out = tmp_path / "out.txt"
    assert CMAKE is not None
    ran = subprocess.run([CMAKE, f"-DOUT={out}", "-P", str(script)], cwd=folder, capture_output=True, text=True, check=False)
    assert not ran.returncode, ran.stderr[:2000]
    real = dict(line.split(" ", 1) for line in out.read_text().splitlines())

    wrong = []
    unknown = 0
    outside = Surroundings(DiskTree(str(tree))).of("package")
    for number, line in enumerate(lines):
        run = Run(Sources("p", "package", sorted(FILES), {}, outside=outside), "", {}, lambda *_: None)
        run.policy_version = (3, 20)
        cmake_flow.run_file(run, parse(Text("x", line)).commands, CallFrame(True, "", run.paths.absolute("CMakeLists.txt")))
        value = run.get("V") or ""
        unknown += HOLE in value
        if is_fixed(value) and value.replace(TREE, str(tree)) != real[str(number)]:
            wrong.append((line, value, real[str(number)]))
    assert not wrong, "\n".join(map(str, wrong[:12]))
    assert unknown < len(lines) / 20


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        (r'get_filename_component(V "/x\\y\\..\\z" ABSOLUTE)', "/x/z"),
        (r'get_filename_component(V "y\\z" ABSOLUTE BASE_DIR "/a\\b")', "/a/b/y/z"),
        (r'set(A "a\;b")' '\nget_filename_component(V "/x/${A}" REALPATH)', "/x/a/;b"),
        (r'file(REAL_PATH "/x\\y" V)', HOLE),  # depends on policy CMP0152
    ],
)
def test_a_backslash_separates_folders_in_absolute_paths(line: str, expected: str) -> None:
    run = Run(Sources("p", "", (), {}), "", {}, lambda *_: None)
    cmake_flow.run_file(run, parse(Text("x", line)).commands, CallFrame(True, "", run.paths.absolute("CMakeLists.txt")))
    assert run.get("V") == expected
