"""Comparison of small scripts and projects with CMake: commands and tests that the random scripts do not contain."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from ros_lint.base.text import Text
from ros_lint.collectors.cmake.evaluator import flow as cmake_flow
from ros_lint.collectors.cmake.evaluator.run import Run
from ros_lint.collectors.cmake.evaluator.sources import Sources
from ros_lint.collectors.cmake.evaluator.state import CallFrame
from ros_lint.collectors.cmake.evaluator.values import is_known
from ros_lint.collectors.cmake.syntax import parse
from ros_lint.facts.build import BuildScript
from tests.cmake_runs import mentioned, run
from tests.cmake_writer import Script
from tests.test_cmake_language import CMAKE, disagreements, evaluated, really_run

pytestmark = pytest.mark.slow

needs_cmake = pytest.mark.skipif(CMAKE is None, reason="cmake is not installed")

# Scripts in which U0, U1 and U2 are variables that the evaluator does not know.
SCRIPTS = r"""
macro(outer x)
macro(inner y)
set(A "${x}|${y}")
endmacro()
endmacro()
outer(a)
inner(b)

macro(outer x)
function(inner y)
if("${x}" STREQUAL "a")
set(A "${x}|${y}" PARENT_SCOPE)
elseif("${x}" STREQUAL "b")
set(B "${x}" PARENT_SCOPE)
else()
set(C "${y}" PARENT_SCOPE)
endif()
endfunction()
endmacro()
outer(b)
inner(c)

macro(outer)
function(inner)
foreach(i ${ARGN} x)
set(A "${A}-${i}" PARENT_SCOPE)
set(A "${A}-${i}")
endforeach()
set(B "${ARGC}" PARENT_SCOPE)
endfunction()
endmacro()
outer(p q)
inner(r)

macro(outer x)
function(inner)
set(A [[${x}]] PARENT_SCOPE)
set(B ${x}${x} PARENT_SCOPE)
endfunction()
endmacro()
outer("a;b")
inner()

macro(outer x)
macro(inner)
while(NOT DEFINED A)
set(A "${x}")
endwhile()
block()
set(B "${x}")
set(C 1 PARENT_SCOPE)
endblock()
endmacro()
endmacro()
outer(z)
inner()

macro(outer ${U0})
endmacro()
set(A 1)

if(U0)
function(f x)
set(A "1${x}" PARENT_SCOPE)
endfunction()
else()
function(f x)
set(A "2${x}" PARENT_SCOPE)
set(B b PARENT_SCOPE)
endfunction()
endif()
f(a)

macro(f)
set(A 0)
endmacro()
if(U0)
macro(f)
set(A 1)
trace(x)
endmacro()
endif()
f()

if(U1)
macro(mark_as_advanced)
set(A mine)
endmacro()
endif()
mark_as_advanced(B)

if(U1)
macro(f)
return()
endmacro()
else()
macro(f)
set(C 1)
endmacro()
endif()
function(g)
f()
set(A 1 PARENT_SCOPE)
endfunction()
g()

foreach(i 1 2)
if(U0)
function(f)
set(A "${i}" PARENT_SCOPE)
endfunction()
elseif(U1)
function(f)
set(A "x${i}" PARENT_SCOPE)
endfunction()
else()
function(f)
endfunction()
endif()
f()
endforeach()

string(ASCII 65 66 A)

string(ASCII 59 B)
set(A "${B}x")

string(ASCII 10 A)

string(ASCII 92 A)
string(LENGTH "${A}" B)

string(ASCII 200 A)

string(ASCII 36 123 A)
set(B "${A}x}")

string(ASCII 91 A)
set(L "${A};b")
list(LENGTH L B)

set(A 1 CACHE STRING "")
unset(A CACHE)
if(DEFINED A)
trace(1)
endif()

set(A 1)
unset(A CACHE)
set(B "${A}")

if(U0)
set(C 1 CACHE STRING "")
endif()
unset(C CACHE)
if(DEFINED C)
trace(1)
endif()

if(U0)
unset(C CACHE)
else()
set(C 1 CACHE STRING "")
endif()
set(A "${C}")

foreach(i a b)
endforeach()
if(DEFINED i)
set(A "${i}")
endif()

if(U0)
foreach(A 1 2)
endforeach()
endif()
set(B "${A}")

set(A x)
foreach(A 1 2)
break()
endforeach()

foreach(i IN ZIP_LISTS L M)
set(A "${i_0}${i_1}")
endforeach()
if(DEFINED i_0)
trace(1)
endif()

function(f)
endfunction()
if(COMMAND f)
trace(1)
endif()
if(COMMAND F)
trace(2)
endif()
if(COMMAND nope)
trace(3)
endif()
if(COMMAND set)
trace(4)
endif()
if(NOT COMMAND if)
trace(5)
endif()

if(U0)
macro(f)
endmacro()
endif()
if(COMMAND f)
trace(1)
endif()

if(IS_DIRECTORY /nope)
trace(1)
else()
trace(2)
endif()
if(IS_DIRECTORY /)
trace(3)
endif()
if(IS_DIRECTORY "")
trace(4)
endif()

foreach(p /a a ./a ~/a ~a "" C:/a "/" "a/b" "//a")
if(IS_ABSOLUTE "${p}")
trace("x${p}")
else()
trace("y${p}")
endif()
endforeach()

if(IS_ABSOLUTE "${U0}")
trace(1)
else()
trace(2)
endif()

if(POLICY CMP0048)
trace(1)
endif()
if(POLICY CMP0000)
trace(2)
endif()
if(POLICY CMP0077)
trace(3)
endif()
if(POLICY nope)
trace(5)
endif()

if(IS_SYMLINK /nope)
trace(1)
else()
trace(2)
endif()
if(TEST nope)
trace(3)
else()
trace(4)
endif()

if(/nope IS_NEWER_THAN /)
trace(1)
else()
trace(2)
endif()
if(/ IS_NEWER_THAN /nope)
trace(3)
endif()

if(TARGET nope)
trace(1)
else()
trace(2)
endif()
if(TARGET "${U0}")
trace(3)
endif()

if(EXISTS /nope)
trace(1)
else()
trace(2)
endif()
if(EXISTS /)
trace(3)
endif()

if(DEFINED ENV{HOME_NOPE})
trace(1)
else()
trace(2)
endif()
set(ENV{XYZ} 1)
if(DEFINED ENV{XYZ})
trace(3)
endif()
set(A "$ENV{XYZ}")

cmake_policy(SET CMP0139 NEW)
if("a//b" PATH_EQUAL "a/b")
trace(1)
endif()
if(a PATH_EQUAL b)
trace(2)
else()
trace(3)
endif()
"""


@needs_cmake
@pytest.mark.parametrize("concrete", [("", "0", "a"), ("ON", "a", "b;c"), ("0", "1", "")])
def test_effects_of_small_scripts_equal_those_of_cmake(concrete: tuple[str, ...], tmp_path: Path) -> None:
    assert CMAKE is not None
    scripts = {number: Script(text, concrete) for number, text in enumerate(SCRIPTS.strip().split("\n\n"))}
    real = really_run(CMAKE, scripts, tmp_path)
    assert len(real) == len(scripts)
    wrong = {script.text: disagreements(evaluated(script), real[number]) for number, script in scripts.items()}
    assert not {text: differences for text, differences in wrong.items() if differences}


# Projects in which A, B and C are set.
PROJECTS = r"""
add_library(t INTERFACE)
get_target_property(A t TYPE)
get_target_property(B t NOPE)
get_target_property(C t NAME)

add_library(t STATIC IMPORTED)
get_target_property(A t TYPE)
get_property(B TARGET t PROPERTY NOPE)
get_property(C TARGET t PROPERTY TYPE)

add_library(t SHARED IMPORTED)
get_target_property(A t TYPE)
set_target_properties(t PROPERTIES OUTPUT_NAME x P "1;2")
get_target_property(B t OUTPUT_NAME)
get_target_property(C t P)

add_executable(t IMPORTED)
get_target_property(A t TYPE)
add_executable(u ALIAS t)
get_target_property(B u TYPE)
get_target_property(C u ALIASED_TARGET)

add_library(t INTERFACE)
add_library(p::t ALIAS t)
set_target_properties(t PROPERTIES P 1)
get_target_property(A p::t P)
get_target_property(B p::t NAME)
get_target_property(C p::t TYPE)

add_custom_target(t)
get_target_property(A t TYPE)
get_target_property(B t OUTPUT_NAME)
get_target_property(C t NAME)

add_library(t MODULE IMPORTED)
get_target_property(A t TYPE)

add_library(t OBJECT IMPORTED)
get_target_property(A t TYPE)

add_library(t UNKNOWN IMPORTED)
get_target_property(A t TYPE)

add_library(t INTERFACE)
set_property(TARGET t APPEND PROPERTY P a)
set_property(TARGET t APPEND PROPERTY P b c)
get_target_property(A t P)
set_property(TARGET t APPEND_STRING PROPERTY P d)
get_property(B TARGET t PROPERTY P)
get_property(C TARGET t PROPERTY P SET)

if(TARGET t)
set(A 1)
endif()
add_library(t INTERFACE)
if(TARGET t)
set(B 1)
endif()
if(NOT TARGET u)
set(C 1)
endif()

if(IS_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/sub)
set(A 1)
endif()
if(IS_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/CMakeLists.txt)
set(B 1)
endif()
if(IS_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
set(C 1)
endif()

if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/sub/x.txt)
set(A 1)
endif()
if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/nope)
set(B 1)
endif()
if("${CMAKE_SOURCE_DIR}" STREQUAL "${CMAKE_BINARY_DIR}")
set(C 1)
endif()

if("${CMAKE_SOURCE_DIR}" STREQUAL "${CMAKE_CURRENT_SOURCE_DIR}")
set(A 1)
endif()
if("${CMAKE_CURRENT_SOURCE_DIR}/sub" STREQUAL "${CMAKE_CURRENT_BINARY_DIR}/sub")
set(B 1)
endif()
if("${PROJECT_SOURCE_DIR}" STREQUAL "")
set(C 1)
endif()

list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_SOURCE_DIR}/cmake)
find_package(Own)
set(A "${OWN_VALUE}")
set(B "${Own_FOUND}")
function(f)
find_package(Own)
set(C "${OWN_VALUE}" PARENT_SCOPE)
endfunction()
f()

get_filename_component(A ${CMAKE_CURRENT_LIST_FILE} NAME)
get_filename_component(B ${CMAKE_CURRENT_SOURCE_DIR}/sub/x.txt NAME_WE)
file(RELATIVE_PATH C ${CMAKE_CURRENT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR}/sub/x.txt)

set(BUILD_SHARED_LIBS ON)
add_library(t x.c)
get_target_property(A t TYPE)
set(BUILD_SHARED_LIBS OFF)
add_library(u x.c)
get_target_property(B u TYPE)
set(BUILD_SHARED_LIBS $ENV{NOPE})
add_library(v x.c)
get_target_property(C v TYPE)
"""

FILES = {
    "sub/x.txt": "",
    "x.c": "",
    "cmake/FindOwn.cmake": "set(OWN_VALUE own)\nset(Own_FOUND TRUE)\n",
}


def _project(text: str) -> str:
    return f"cmake_minimum_required(VERSION 3.20)\nproject(p NONE)\n{text}\n"


def _configured(text: str, folder: Path) -> dict[str, str]:
    """Return the variables that CMake sets when it configures a project."""
    assert CMAKE is not None
    dump = "".join(f'if(DEFINED {name})\nfile(APPEND "{folder}/out" "{name}=${{{name}}}\\n")\nendif()\n' for name in "ABC")
    for path, content in {**FILES, "CMakeLists.txt": _project(text) + dump}.items():
        (folder / "src" / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / "src" / path).write_text(content)
    command = [CMAKE, "-Wno-dev", "-S", str(folder / "src"), "-B", str(folder / "build")]
    subprocess.run(command, capture_output=True, check=False)  # this fails without a compiler, but the values are written
    return dict(line.split("=", 1) for line in (folder / "out").read_text().splitlines())


@needs_cmake
@pytest.mark.parametrize("text", PROJECTS.strip().split("\n\n"))
def test_values_of_small_projects_equal_those_of_cmake(text: str, tmp_path: Path) -> None:
    files = {**FILES, "CMakeLists.txt": _project(text)}
    parsed = {path: parse(Text(path, content)) for path, content in files.items() if not path.startswith(("sub", "x"))}
    evaluated_run = Run(Sources("p", "", sorted(files), parsed), "", {}, lambda run, name, args: None)
    cmake_flow.run_file(
        evaluated_run,
        parsed["CMakeLists.txt"].commands,
        CallFrame(True, "CMakeLists.txt", evaluated_run.paths.absolute("CMakeLists.txt")),
    )
    known_values = {name: value or "" for name in "ABC" if (value := evaluated_run.get(name)) is None or is_known(value)}
    real = _configured(text, tmp_path)
    assert known_values == {name: real.get(name, "") for name in known_values}
    assert known_values


def _tested(script: BuildScript) -> dict[str, bool]:
    """Return the packages that are searched, each with whether only tests need it."""
    return {name: mention.test for (via, name), mention in mentioned(script).items() if via == "cmake"}


@pytest.mark.parametrize(
    ("setting", "option", "for_tests", "conditional"),
    [
        ("", "BUILD_TESTING", True, False),
        ("", "BUILD_TESTS", True, True),
        ("set(BUILD_TESTS ON)\n", "BUILD_TESTS", True, False),
        ("set(BUILD_TESTS OFF)\n", "BUILD_TESTS", True, True),
        ("", "PKG_ENABLE_TESTING", True, True),
        ('option(BUILD_DOCS "" OFF)\n', "BUILD_DOCS", False, True),
    ],
)
def test_options_that_enable_tests_are_recognized(setting: str, option: str, for_tests: bool, conditional: bool) -> None:
    script = run(f"{setting}if({option})\nfind_package(other REQUIRED)\nendif()\n")
    assert _tested(script) == {"other": for_tests}
    assert mentioned(script)["cmake", "other"].optional is conditional


EXTRAS = """\
find_package(a REQUIRED)
if(NOT TARGET b::b)
  find_package(b REQUIRED)
endif()
if(NOT c_FOUND)
  find_dependency(c)
else()
  find_package(d)
endif()
if(POLICY CMP0057)
  find_package(e REQUIRED)
endif()
if(WIN32)
  find_package(f REQUIRED)
endif()
if(TARGET b::b AND WIN32)
  find_package(g REQUIRED)
endif()
foreach(name x)
  find_package(h REQUIRED)
endforeach()
macro(later)
  find_package(i REQUIRED)
endmacro()
find_package(pkg REQUIRED)
"""


def test_config_extras_export_the_packages_that_they_find() -> None:
    """A search is unconditional if its condition only tests whether a target or package exists."""
    script = run("ament_package(CONFIG_EXTRAS cmake/x.cmake)\n", {"cmake/x.cmake": EXTRAS})
    packages = {mention.name: (certain, mention.optional) for mention, certain in script.exports.packages}
    assert packages == {
        "a": (True, False),
        "b": (True, False),
        "c": (True, False),
        "d": (False, True),
        "e": (True, False),
        "f": (False, False),
        "g": (False, False),
        "h": (False, False),
    }
