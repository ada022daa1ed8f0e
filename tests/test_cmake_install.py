"""Comparison of install() with CMake: paths and executable bits of the installed files."""

from __future__ import annotations

import os
import random
import shutil
import subprocess
from pathlib import Path

import pytest

from ros_lint.base.text import Text
from ros_lint.base.tree import DiskTree
from ros_lint.collectors.cmake.evaluate import evaluate
from ros_lint.collectors.cmake.evaluator.sources import Sources
from ros_lint.collectors.cmake.syntax import parse
from ros_lint.workspace.build_scripts.sources import Surroundings

FILES = {
    "CMakeLists.txt": False,
    "launch/a.launch.py": False,
    "launch/b.launch.xml": True,
    "launch/sub/c.launch.py": False,
    "launch/sub/deep/d.py": True,
    "launch/__pycache__/a.pyc": False,
    "config/a.yaml": False,
    "config/b.yml": False,
    "config/old/a.yaml": False,
    "config/config/a.yaml": True,
    "scripts/run": True,
    "scripts/tool.py": True,
    "scripts/lib.py": False,
    "meshes/x.stl": False,
    "a b/c d.txt": False,
    "top.py": True,
    "../shared/a.yaml": False,
    "../shared/sub/tool.py": True,
    "../shared/sub/c.launch.py": False,
    "../more.py": True,
}
"""Files, and whether they have the executable bit."""

_FOLDERS = (
    "launch",
    "launch/",
    "config",
    "config/",
    "launch/sub",
    "launch/sub/",
    "scripts",
    "scripts/",
    "./config",
    "launch/../config",
    ".",
    "meshes",
    "made",
    "made/sub/",
    "../shared",
    "../shared/",
    "${CMAKE_CURRENT_SOURCE_DIR}/../shared/sub",
    "../p/config",
    "launch/../../shared/sub/",
)
_FILES = (
    "top.py", "scripts/run", "scripts/lib.py", "config/a.yaml", "launch/sub/c.launch.py", '"a b/c d.txt"', "./top.py",
    "../more.py", "../shared/a.yaml",
)  # fmt: skip
_PATTERNS = (
    "*.py",
    "*.yaml",
    "*.launch.*",
    "sub",
    "__pycache__",
    "*",
    "[ab]*",
    "?.yaml",
    "config/a.yaml",
    "sub/*",
    "old",
    "deep",
    "d.py",
    "*.y*ml",
    "launch",
    "[!a]*.py",
)
_REGEXES = (".*\\\\.py$", "/sub/", "a\\\\.(yaml|launch)", "config/[^/]*$", "^/.*launch", "\\\\.xml")


_MADE = """
file(WRITE made/written.txt "")
file(WRITE made/sub/written.py "")
file(COPY config/a.yaml meshes/x.stl DESTINATION ${CMAKE_CURRENT_SOURCE_DIR}/made/sub)
file(WRITE before.txt "")
file(RENAME ${CMAKE_CURRENT_SOURCE_DIR}/before.txt ${CMAKE_CURRENT_SOURCE_DIR}/made/renamed.yaml)
"""
"""Commands that generate files in the sources."""


def _rule(choice: random.Random, number: int) -> str:
    some = choice.choice
    place = some(("", "/x", "/x/y", "/./x", "/x/../z"))
    destination = f"DESTINATION {some(('', '${CMAKE_INSTALL_PREFIX}/'))}r{number}{place}"
    roll = choice.random()
    if roll < 0.3:
        files = " ".join(choice.sample(_FILES, choice.randint(1, 3)))
        words = [some(("FILES", "PROGRAMS")), files, destination]
        if choice.random() < 0.2:
            words = [some(("FILES", "PROGRAMS")), some(_FILES), destination, "RENAME new.name"]
        if choice.random() < 0.2:
            words.append(some(("PERMISSIONS OWNER_READ OWNER_EXECUTE", "PERMISSIONS OWNER_READ OWNER_WRITE")))
        if choice.random() < 0.2:
            words[1] += " missing.txt" if not any("RENAME" in word for word in words) else ""
            words.append("OPTIONAL")
        if choice.random() < 0.1:
            words.insert(1, words[0])  # CMake accepts the repeated word
        return f"install({' '.join(words)})"
    words = ["DIRECTORY", " ".join(choice.sample(_FOLDERS, choice.randint(1, 2))), destination]
    words.append(
        some(
            (
                "",
                "",
                "USE_SOURCE_PERMISSIONS",
                "FILE_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE",
                "MESSAGE_NEVER",
                "OPTIONAL",
            )
        )
    )
    if choice.random() < 0.35:
        words.append("FILES_MATCHING")
    for _ in range(choice.choice((0, 0, 1, 1, 2, 3)) or ("FILES_MATCHING" in words)):
        kind = f'PATTERN "{some(_PATTERNS)}"' if choice.random() < 0.75 else f'REGEX "{some(_REGEXES)}"'
        words.append(f"{kind} {some(('', 'EXCLUDE', 'EXCLUDE', 'PERMISSIONS OWNER_READ OWNER_EXECUTE'))}")
    return f"install({' '.join(words)})"


try:
    from cmake import CMAKE_BIN_DIR  # type: ignore[import-not-found, unused-ignore]  # of the wheel on PyPI

    CMAKE = shutil.which("cmake", path=CMAKE_BIN_DIR)
except ImportError:
    CMAKE = shutil.which("cmake")


@pytest.mark.skipif(CMAKE is None, reason="cmake is not installed")
def test_installed_files_equal_those_of_cmake(tmp_path: Path) -> None:
    choice = random.Random(4)
    rules = [_rule(choice, number) for number in range(600)]
    script = "cmake_minimum_required(VERSION 3.16)\nproject(p NONE)\n" + _MADE + "\n".join(rules) + "\n"
    folder = tmp_path / "tree" / "p"
    folder.mkdir(parents=True)
    for path, executable in FILES.items():
        place = folder / path
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text("")
        place.chmod(0o755 if executable else 0o644)
    (folder / "CMakeLists.txt").write_text(script)
    prefix = tmp_path / "prefix"
    assert CMAKE is not None
    command = [CMAKE, "-S", str(folder), "-B", str(tmp_path / "b"), f"-DCMAKE_INSTALL_PREFIX={prefix}"]
    ran = subprocess.run(command, check=False, capture_output=True, text=True)
    assert not ran.returncode, ran.stderr[:2000]
    subprocess.run([CMAKE, "--install", str(tmp_path / "b")], check=True, capture_output=True)
    real = {
        os.path.relpath(os.path.join(above, name), prefix): bool(os.stat(os.path.join(above, name)).st_mode & 0o100)
        for above, _, names in os.walk(prefix)
        for name in names
    }

    parsed = {"CMakeLists.txt": parse(Text("p/CMakeLists.txt", script))}
    executables = frozenset(path for path, executable in FILES.items() if executable)
    outside = Surroundings(DiskTree(str(tmp_path / "tree"))).of("p")
    package_files = sorted(path for path in FILES if not path.startswith("../"))
    result = evaluate(Sources("p", "p", package_files, parsed, executables, outside=outside))
    installed = {provided.path: provided.program for provided in result.products.installs}
    assert not result.opaque
    assert not any(provided.conditional for provided in result.products.installs)
    differing = {path.partition("/")[0] for path in installed.keys() ^ real.keys()}
    differing |= {path.partition("/")[0] for path in installed.keys() & real.keys() if installed[path] != real[path]}
    shown = [
        (rules[int(rule[1:])], sorted(path for path in installed.keys() ^ real.keys() if path.startswith(f"{rule}/")))
        for rule in differing
    ]
    assert not shown, shown[:5]
    assert len(real) > 1500


_HEADERS = ("include/a/a.hpp", "include/a/sub/b.hpp", "src/c.hpp")
_OF_TARGETS = """
add_library(one INTERFACE)
target_sources(one INTERFACE FILE_SET HEADERS BASE_DIRS include FILES include/a/a.hpp include/a/sub/b.hpp)
install(TARGETS one RUNTIME DESTINATION bin FILE_SET HEADERS DESTINATION one/include)
add_library(two INTERFACE)
target_sources(two INTERFACE FILE_SET own TYPE HEADERS BASE_DIRS include src FILES include/a/a.hpp
               INTERFACE FILE_SET HEADERS BASE_DIRS ${CMAKE_CURRENT_SOURCE_DIR}/src FILES src/c.hpp)
target_sources(two INTERFACE FILE_SET own FILES src/c.hpp)
install(TARGETS two FILE_SET own FILE_SET HEADERS DESTINATION two)
add_library(three INTERFACE)
target_sources(three INTERFACE FILE_SET HEADERS FILES src/c.hpp)
install(TARGETS three FILE_SET HEADERS DESTINATION three)
add_library(four INTERFACE)
set_target_properties(four PROPERTIES PUBLIC_HEADER "include/a/a.hpp;src/c.hpp" PRIVATE_HEADER src/c.hpp)
install(TARGETS four PUBLIC_HEADER DESTINATION four)
"""


@pytest.mark.skipif(CMAKE is None, reason="cmake is not installed")
def test_installed_headers_of_targets_equal_those_of_cmake(tmp_path: Path) -> None:
    script = f"cmake_minimum_required(VERSION 3.23)\nproject(p NONE)\n{_OF_TARGETS}"
    folder = tmp_path / "p"
    for path in _HEADERS:
        place = folder / path
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text("")
    (folder / "CMakeLists.txt").write_text(script)
    prefix = tmp_path / "prefix"
    assert CMAKE is not None
    command = [CMAKE, "-S", str(folder), "-B", str(tmp_path / "b"), f"-DCMAKE_INSTALL_PREFIX={prefix}"]
    ran = subprocess.run(command, check=False, capture_output=True, text=True)
    assert not ran.returncode, ran.stderr[:2000]
    subprocess.run([CMAKE, "--install", str(tmp_path / "b")], check=True, capture_output=True)
    real = {os.path.relpath(os.path.join(above, name), prefix) for above, _, names in os.walk(prefix) for name in names}

    parsed = {"CMakeLists.txt": parse(Text("p/CMakeLists.txt", script))}
    result = evaluate(Sources("p", "p", sorted(_HEADERS), parsed, frozenset()))
    assert {provided.path for provided in result.products.installs} == real
    assert len(real) == 8
    assert not result.opaque


def test_unknown_headers_of_a_file_set_hide_the_libraries() -> None:
    script = "add_library(one INTERFACE)\ntarget_sources(one INTERFACE FILE_SET HEADERS FILES ${GENERATED})\n"
    script += "install(TARGETS one FILE_SET HEADERS)\n"
    parsed = {"CMakeLists.txt": parse(Text("p/CMakeLists.txt", f"project(p)\nfile(READ a.txt GENERATED)\n{script}"))}
    result = evaluate(Sources("p", "p", ["a.txt"], parsed, frozenset()))
    assert any("headers of the target 'one'" in opaque.reason for opaque in result.opaque)
