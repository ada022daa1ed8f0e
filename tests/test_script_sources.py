"""What lies around a package and is named by its CMake scripts, as far as it lies in the tree."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

from ros_lint.base.tree import DiskTree, MemoryTree, Tree
from ros_lint.facts.build import BuildScript
from ros_lint.workspace.loader import Loader
from ros_lint.workspace.target import TargetDistro
from tests.packages import manifest_text

HEAD = "cmake_minimum_required(VERSION 3.8)\nproject(p)\nfind_package(ament_cmake REQUIRED)\n"


def script_of(tree: Tree, path: str = "p") -> BuildScript:
    (package,) = Loader(tree, (path,), TargetDistro("jazzy", "test")).load().packages
    assert package.script is not None
    return package.script


def run(lines: str, files: Mapping[str, str], executable: frozenset[str] = frozenset()) -> BuildScript:
    """Return what the script of a package in ws/p comes to, given other files by their paths."""
    own = {"ws/p/package.xml": manifest_text("p"), "ws/p/CMakeLists.txt": HEAD + lines, "ws/p/own.yaml": ""}
    return script_of(MemoryTree({**own, **files}, executable), "ws/p")


def installed(script: BuildScript) -> dict[str, str]:
    """Return the sources of what is installed for sure, by where it is; that the script is seen through is part of it."""
    assert not script.opaque
    assert not script.problems
    return {one.path: one.source for one in script.products.installs if not one.conditional}


CONFIG = {"ws/config/a.yaml": "", "ws/config/deep/b.yaml": "", "ws/config/c.txt": ""}
BOTH = {"share/p/config/a.yaml": "../config/a.yaml", "share/p/config/deep/b.yaml": "../config/deep/b.yaml"}
ALL = {**BOTH, "share/p/config/c.txt": "../config/c.txt"}
ONE = {"share/p/a.yaml": "../config/a.yaml"}
MODULE = {"lib/python/site-packages/deep/b.yaml": "../config/deep/b.yaml"}
UP = "get_filename_component(up {})\ninstall(DIRECTORY ${{up}}/config DESTINATION share/p)"


@pytest.mark.parametrize(
    ("lines", "expected"),
    [
        ("install(DIRECTORY ../config DESTINATION share/p)", ALL),
        ("install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/../config/ DESTINATION share/p/config)", ALL),
        ("install(DIRECTORY ../../ws/config DESTINATION share/${PROJECT_NAME})", ALL),
        ('install(DIRECTORY ../config DESTINATION share/p FILES_MATCHING PATTERN "*.yaml")', BOTH),
        ("install(FILES ../config/a.yaml DESTINATION share/p)", ONE),
        ("install(FILES ../p/own.yaml DESTINATION share/p)", {"share/p/own.yaml": "own.yaml"}),
        ("file(GLOB found ../config/*.yaml)\ninstall(FILES ${found} DESTINATION share/p)", ONE),
        (UP.format("${CMAKE_CURRENT_SOURCE_DIR} DIRECTORY"), ALL),
        (UP.format(".. ABSOLUTE"), ALL),
        ("if(EXISTS ${CMAKE_SOURCE_DIR}/../config)\ninstall(DIRECTORY ../config DESTINATION share/p)\nendif()", ALL),
        ("if(IS_DIRECTORY ${CMAKE_SOURCE_DIR}/../config)\ninstall(DIRECTORY ../config DESTINATION share/p)\nendif()", ALL),
        ("ament_python_install_package(deep PACKAGE_DIR ../config/deep)", MODULE),
    ],
)
def test_files_around_a_package_are_installed_with_it(lines: str, expected: dict[str, str]) -> None:
    assert installed(run(lines, CONFIG)) == expected


def test_a_folder_may_hold_the_package_itself() -> None:
    # CMake takes what is behind the last slash for the name of the folder, so these lie in share/p/x/..
    script = run('install(DIRECTORY .. DESTINATION share/p/x FILES_MATCHING PATTERN "*.yaml")', CONFIG)
    assert installed(script) == {**BOTH, "share/p/p/own.yaml": "own.yaml"}


def test_a_folder_keeps_its_name_where_it_is_known() -> None:
    lines = "install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} DESTINATION share/q)"
    assert installed(run(f"{lines[:-1]} FILES_MATCHING PATTERN *.yaml)", {})) == {"share/q/p/own.yaml": "own.yaml"}
    at_the_base = {"package.xml": manifest_text("p"), "CMakeLists.txt": HEAD + lines, "own.yaml": ""}
    script = script_of(MemoryTree(at_the_base), "")
    assert (script.products.installs, [opaque.below for opaque in script.opaque]) == ((), ["share/q"])


def test_programs_keep_their_permissions() -> None:
    files = {"ws/scripts/run.py": "", "ws/scripts/data.py": ""}
    lines = "install(DIRECTORY ../scripts/ DESTINATION lib/p USE_SOURCE_PERMISSIONS)"
    script = run(lines, files, frozenset({"ws/scripts/run.py"}))
    assert {one.path: one.program for one in script.products.installs} == {"lib/p/run.py": True, "lib/p/data.py": False}


INSTALL = "install(DIRECTORY {} DESTINATION share/p)\n"
OURS = INSTALL.format('"${CMAKE_CURRENT_SOURCE_DIR}/../config"')
FUNCTION = f"function(install_all)\n{OURS}endfunction()\n"
LIB = "ws/lib/CMakeLists.txt"
DEEP = "ws/lib/deep/CMakeLists.txt"


@pytest.mark.parametrize(
    ("lines", "files"),
    [
        ("include(../cmake/x.cmake)", {"ws/cmake/x.cmake": OURS}),
        ("include(../cmake/x.cmake)\ninstall_all()", {"ws/cmake/x.cmake": FUNCTION}),
        ("include(${CMAKE_CURRENT_SOURCE_DIR}/../cmake/x.cmake OPTIONAL)", {"ws/cmake/x.cmake": OURS}),
        ("list(APPEND CMAKE_MODULE_PATH ${CMAKE_SOURCE_DIR}/../cmake)\ninclude(x)", {"ws/cmake/x.cmake": OURS}),
        (
            "include(../cmake/x.cmake)",
            {"ws/cmake/x.cmake": "include(${CMAKE_CURRENT_LIST_DIR}/deep/y.cmake)\n", "ws/cmake/deep/y.cmake": OURS},
        ),
        ("add_subdirectory(../lib lib)", {LIB: "project(lib)\n" + INSTALL.format("${PROJECT_SOURCE_DIR}/../config")}),
        (
            "add_subdirectory(../lib lib)",
            {LIB: "add_subdirectory(deep)\n", DEEP: INSTALL.format("../../config")},
        ),
    ],
)
def test_scripts_around_a_package_run_as_its_own(lines: str, files: Mapping[str, str]) -> None:
    assert installed(run(lines, {**CONFIG, **files})) == ALL


def test_a_folder_is_built_where_the_script_says() -> None:
    inner = "configure_file(a.in made/b.yaml)\ninstall(DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/made DESTINATION share/p)\n"
    lines = "add_subdirectory(../lib deep/lib)\ninstall(DIRECTORY ${CMAKE_BINARY_DIR}/deep DESTINATION share/q)"
    script = run(lines, {LIB: inner})
    assert {one.path for one in script.products.installs} == {"share/p/made/b.yaml", "share/q/deep/lib/made/b.yaml"}


def test_what_a_script_around_a_package_needs_is_reported_where_it_is_included() -> None:
    files = {"ws/cmake/x.cmake": "find_package(std_msgs REQUIRED)\ntarget_link_libraries(a ${std_msgs_LIBRARIES})\n"}
    script = run("add_library(a a.cpp)\ninclude(../cmake/x.cmake)", files)
    found = [(mention.name, mention.via, mention.span.path, mention.span.line) for mention in script.mentions]
    assert ("std_msgs", "cmake", "ws/p/CMakeLists.txt", 5) in found
    assert {path for _, _, path, _ in found} == {"ws/p/CMakeLists.txt"}


@pytest.mark.parametrize(
    "lines",
    [
        "install(DIRECTORY ../../../config DESTINATION share/p)",
        "install(DIRECTORY ../nowhere DESTINATION share/p)",
        "install(DIRECTORY ../.git DESTINATION share/p)",
        "ament_python_install_package(deep PACKAGE_DIR ../nowhere)",
        "include(../nowhere.cmake)",
        "include(../broken.cmake)",
        "add_subdirectory(../config x)",
        "add_subdirectory(../../.. x)",
    ],
)
def test_what_is_not_in_sight_hides(lines: str) -> None:
    script = run(lines, {**CONFIG, "ws/.git/a": "", "ws/broken.cmake": "set(a"})
    assert script.opaque
    assert not script.problems


def test_a_link_out_of_the_tree_is_not_followed(tmp_path: Path) -> None:
    package = tmp_path / "tree" / "p"
    for path in ("out/config/a.yaml", "tree/in/config/a.yaml", "tree/p/package.xml"):
        (tmp_path / path).parent.mkdir(parents=True)
        (tmp_path / path).write_text(manifest_text("p"))
    (tmp_path / "tree" / "link").symlink_to(tmp_path / "out")
    (tmp_path / "tree" / "kept").symlink_to("in")
    for folder, paths in (("kept", {"share/p/config/a.yaml"}), ("link", set())):
        (package / "CMakeLists.txt").write_text(HEAD + INSTALL.format(f"../{folder}/config"))
        script = script_of(DiskTree(str(tmp_path / "tree")))
        assert ({one.path for one in script.products.installs}, bool(script.opaque)) == (paths, not paths)


def test_a_script_that_is_a_link_out_of_the_tree_is_not_read(tmp_path: Path) -> None:
    (tmp_path / "tree" / "p").mkdir(parents=True)
    (tmp_path / "out.cmake").write_text(INSTALL.format("x"))
    (tmp_path / "tree" / "x.cmake").symlink_to(tmp_path / "out.cmake")
    (tmp_path / "tree" / "p" / "package.xml").write_text(manifest_text("p"))
    (tmp_path / "tree" / "p" / "CMakeLists.txt").write_text(f"{HEAD}include(../x.cmake)\n")
    assert script_of(DiskTree(str(tmp_path / "tree"))).opaque


def test_around_a_package_that_is_reached_by_a_link_nothing_is_known(tmp_path: Path) -> None:
    (tmp_path / "real" / "p").mkdir(parents=True)
    (tmp_path / "ws" / "config").mkdir(parents=True)
    (tmp_path / "ws" / "config" / "a.yaml").write_text("")
    (tmp_path / "ws" / "p").symlink_to("../real/p")
    (tmp_path / "real" / "p" / "package.xml").write_text(manifest_text("p"))
    (tmp_path / "real" / "p" / "CMakeLists.txt").write_text(HEAD + INSTALL.format("../config"))
    script = script_of(DiskTree(str(tmp_path)), "ws/p")
    assert script.path == "ws/p/CMakeLists.txt"
    assert script.opaque
    assert not script.products.installs
