"""Comparison of the evaluator with CMake: a value that the evaluator knows must be the value of CMake.

The scripts are random. CMake runs them with concrete values for the variables U0, U1 and U2, which are unknown to the
evaluator, so its values must hold on each path through a script.
"""

from __future__ import annotations

import contextlib
import shutil
import subprocess
from collections import Counter
from pathlib import Path
from typing import NamedTuple

import pytest

import ros_lint.collectors.cmake.evaluate  # noqa: F401  (it registers the commands and blocks)
from ros_lint.base.budget import BudgetExceeded
from ros_lint.base.text import Text
from ros_lint.collectors.cmake.evaluator import flow as cmake_flow
from ros_lint.collectors.cmake.evaluator.run import Run
from ros_lint.collectors.cmake.evaluator.sources import Sources
from ros_lint.collectors.cmake.evaluator.state import CallFrame, Variables
from ros_lint.collectors.cmake.evaluator.values import HOLE, MAYBE, elements, is_known, strip_mark
from ros_lint.collectors.cmake.syntax import parse
from tests.cmake_writer import UNKNOWN, VARIABLES, Script, generate

pytestmark = pytest.mark.slow


class Outcome(NamedTuple):
    values: dict[str, str | None]
    """None is an unset variable."""
    traces: Counter[str]
    certain: Counter[str]
    """The traces that are not conditional."""


def evaluated(script: Script) -> Outcome:
    """Return the outcome of a script by the evaluator."""
    traces: Counter[str] = Counter()
    certain: Counter[str] = Counter()

    def trace(run: Run, name: str, args: list[str]) -> None:
        if name != "trace":
            raise AssertionError(name)
        if not run.muted:
            traces[args[0]] += 1
            certain[args[0]] += not run.uncertain_conditions

    parsed = parse(Text("CMakeLists.txt", script.text))
    assert not parsed.problems, parsed.problems
    run = Run(Sources("p", "", (), {}), "", {}, trace)
    run.policy_version = (3, 20)
    run.scopes.append(Variables(ARGC="0", ARGN="", ARGV=""))  # the scripts run within a function
    for name in UNKNOWN:
        run.set(name, HOLE)
    cmake_flow.run_file(run, parsed.commands, CallFrame(True, "", "/x"))
    return Outcome({name: run.get(name) for name in VARIABLES}, traces, certain)


_HEAD = """cmake_minimum_required(VERSION 3.20)
function(trace x)
  set_property(GLOBAL APPEND PROPERTY TRACES "${x}")
endfunction()
"""
_DUMP = """
  get_property(t GLOBAL PROPERTY TRACES)
  file(APPEND "${OUT}" "traces ${t}\\n")
  foreach(v %s)
    if(DEFINED ${v})
      string(HEX "${${v}}" h)
      file(APPEND "${OUT}" "${v} =${h}\\n")
    endif()
  endforeach()
""" % " ".join(VARIABLES)  # noqa: UP031  (braces are CMake's)

_FORGET = "".join(f"  unset({name} CACHE)\n" for name in VARIABLES)


def really_run(cmake_program: str, scripts: dict[int, Script], folder: Path) -> dict[int, Outcome]:
    """What CMake says. Scripts with an error are left out."""
    driver = folder / "driver.cmake"
    out = folder / "out.txt"
    outcomes: dict[int, Outcome] = {}
    waiting = dict(scripts)
    for number, script in scripts.items():
        (folder / f"{number}.cmake").write_text(script.text + "\n")
    while waiting:
        out.write_text("")
        lines = [_HEAD]
        for number, script in waiting.items():
            # Macros and functions are global, but every script defines those that it calls.
            sets = "".join(f'  set({name} "{value}")\n' for name, value in zip(UNKNOWN, script.concrete, strict=True))
            lines.append(
                f"function(run_{number})\n  set_property(GLOBAL PROPERTY TRACES)\n{sets}{_FORGET}"
                f'  file(APPEND "${{OUT}}" "script {number}\\n")\n'
                f'  include("{folder}/{number}.cmake")\n{_DUMP}endfunction()\n'
                f"function(outer_{number})\n  run_{number}()\nendfunction()\nouter_{number}()"
            )
        driver.write_text("\n".join(lines) + '\nfile(APPEND "${OUT}" "end\\n")\n')
        command = [cmake_program, "-Wno-dev", f"-DOUT={out}", "-P", str(driver)]
        with contextlib.suppress(subprocess.TimeoutExpired):  # lists that double with every round
            subprocess.run(command, capture_output=True, check=False, timeout=len(waiting) / 20 + 2)
        text = out.read_text()
        blocks = text.split("script ")[1:]
        done = text.endswith("end\n")
        for index, block in enumerate(blocks):
            number = int(block.partition("\n")[0])
            del waiting[number]
            if done or index < len(blocks) - 1:
                outcomes[number] = _read(block.removesuffix("end\n"))
        if not blocks:
            raise AssertionError("cmake runs nothing")
    return outcomes


def _read(block: str) -> Outcome:
    values: dict[str, str | None] = dict.fromkeys(VARIABLES)
    traces: Counter[str] = Counter()
    for line in block.split("\n")[1:]:
        name, _, value = line.partition(" ")
        if name == "traces":
            traces.update(item for item in value.split(";") if item)
        elif value.startswith("="):
            values[name] = bytes.fromhex(value[1:]).decode("utf-8", "surrogateescape")
    return Outcome(values, traces, traces)


def disagreements(outcome_of_evaluator: Outcome, real: Outcome) -> list[str]:
    """Return the differences between the outcome of the evaluator and that of CMake."""
    differences = []
    for name, value in outcome_of_evaluator.values.items():
        actual = real.values[name]
        if value is None or is_known(value):
            if value != actual and (value or actual):  # an empty value may also be unset
                differences.append(f"{name}: {value!r} is {actual!r}")
        elif HOLE not in value and not _may_be(elements(value), elements(actual or "")):
            differences.append(f"{name}: {value!r} cannot be {actual!r}")
    for trace, count in real.traces.items():
        if outcome_of_evaluator.traces[trace] == 0 and count:
            differences.append(f"trace {trace} is missing")
    for trace, count in outcome_of_evaluator.certain.items():
        if real.traces[trace] < count:
            differences.append(f"trace {trace} is there {real.traces[trace]} times, not {count}")
    return differences


def _may_be(marked: list[str], actual: list[str]) -> bool:
    """Return whether the actual list has each certain element, and no element that is not in ``marked``."""
    certain = [element for element in marked if element and not element.startswith(MAYBE)]
    possible = {strip_mark(element)[0] for element in marked} | {""}
    return not Counter(certain) - Counter(actual) and set(actual) <= possible


try:
    from cmake import CMAKE_BIN_DIR  # type: ignore[import-not-found, unused-ignore]  # of the wheel on PyPI

    CMAKE = shutil.which("cmake", path=CMAKE_BIN_DIR)
except ImportError:
    CMAKE = shutil.which("cmake")


_SMALL = (
    "string(JSON A ERROR_VARIABLE B GET [[{}]] x)",
    'set(B 1)\nstring(CONFIGURE "@B@" A @ONLY)',
    'string(SHA3_256 A "x")',
    "set(A a/b.c)\ncmake_path(GET A STEM B)\ncmake_path(APPEND A d OUTPUT_VARIABLE C)\ncmake_path(REMOVE_FILENAME A)",
    "cmake_path(SET A x)\ncmake_path(CONVERT a:b TO_CMAKE_PATH_LIST B)\ncmake_path(IS_RELATIVE A C)",
    'set(A "a b")\nseparate_arguments(A)\nseparate_arguments(B UNIX_COMMAND "a \'b c\'")',
    "cmake_policy(GET CMP0054 A)",
    "set(B 1)\nget_directory_property(A DEFINITION B)\nget_cmake_property(C NOPE)\nset_directory_properties(PROPERTIES X Y)",
    "cmake_host_system_information(RESULT A QUERY IS_64BIT)",
    "block()\nfind_program(A nope_nope)\nfind_file(B nope_nope)\nendblock()",
    "function(f)\nset(A ${CMAKE_CURRENT_FUNCTION} PARENT_SCOPE)\nendfunction()\nf()",
    'set(L "a;b")\nlist(TRANSFORM L APPEND x AT 0 -2)',
    "set_property(GLOBAL APPEND_STRING PROPERTY P a b)\nget_property(A GLOBAL PROPERTY P)",
    'set(A 1)\noption(B "" ${A})\noption(C "" x)',
    'set(A "a;;b;$<C:d>")\nstring(GENEX_STRIP "${A}" B)',
    'file(TO_NATIVE_PATH "a//b" A)\nfile(TO_CMAKE_PATH "a/;b" B)\nfile(TO_CMAKE_PATH "/a/b" C)',
    "get_filename_component(A C:/a PATH)\nget_filename_component(B C:/a ABSOLUTE)",
    'get_filename_component(A "/bin/sh x" PROGRAM PROGRAM_ARGS B)',
    'macro(m p)\nset(A "<${${p}}>")\nendmacro()\nm("")',
    'set(A a/b/ CACHE PATH "")\nset(B a/b/ CACHE STRING "")\nset(C "x//y;z/" CACHE FILEPATH "")',
    'set(A)\nforeach(A RANGE 0)\nendforeach()\noption(A "" ON)',
    'cmake_policy(VERSION 3.5)\noption(A "" OFF)\nforeach(A)\nendforeach()\n'
    'block()\nforeach(i IN LISTS A)\nset(A 7 CACHE STRING "" FORCE)\nendforeach()\nendblock()',
    'string(REGEX REPLACE "^[a-z]" "-" A "ab")',
    'string(REGEX MATCHALL "^[a-z]" A "ab")',
    'if(U0)\nset(A x CACHE STRING "")\nendif()\nif(DEFINED CACHE{A})\ntrace(1)\nendif()',
    'if("a" MATCHES "(a)" OR FALSE AND DEFINED CMAKE_MATCH_1)\ntrace(1)\nendif()',
    'macro(m x)\nset(A "1|${x}|2")\nendmacro()\nset(B a)\nif(U0)\nlist(APPEND B b)\nendif()\nm("${B}")',
    'if(NOT U1)\nelse()\nset(B "")\nendif()\nif("B" STREQUAL B)\ntrace(1)\nendif()',
    'if(NOT U1)\nelse()\nset(B "")\nendif()\nif(B MATCHES "(.)")\nset(A "${CMAKE_MATCH_1}")\nendif()',
    'if(NOT U1)\nelse()\nset(B "")\nendif()\nset(L "B;C")\nif(B IN_LIST L)\ntrace(1)\nendif()',
    'if(NOT U1)\nelse()\nset(A yes)\nendif()\nfunction(g)\nforeach(z IN LISTS ARGN)\nset(C "${C},${z}" PARENT_SCOPE)\n'
    'endforeach()\nendfunction()\ng(a "${A}")',
    'function(f)\ncmake_parse_arguments(PARSE_ARGV 1 K "" "ONE" "MANY")\nset(A "${K_ONE}|${K_MANY}" PARENT_SCOPE)\n'
    "endfunction()\nf(x MANY a ${U2} ONE b)",
    'function(f)\ncmake_parse_arguments(PARSE_ARGV 2 K "" "ONE" "MANY")\nset(A "${K_ONE}|${K_MANY}" PARENT_SCOPE)\n'
    "endfunction()\nf(${U2} x MANY a)",
    'set(L "é;a")\nlist(TRANSFORM L APPEND x REGEX "^é" OUTPUT_VARIABLE A)\nlist(FILTER L EXCLUDE REGEX "é")',
    "cmake_policy(VERSION 3.25)\nfunction(f)\nblock(SCOPE_FOR POLICIES)\nset(A 1)\nset(B 2)\nblock(PROPAGATE C)\nset(A 3)\n"
    "return(PROPAGATE A B)\nendblock()\nendblock()\nendfunction()\nf()",
    'string(REPEAT 9 5000 B)\nif("${B}" VERSION_LESS "1${B}")\ntrace(1)\nendif()',
    'string(REPEAT 9 5000 B)\nif("1.${B}" VERSION_GREATER "1.${B}.0")\ntrace(2)\nendif()',
    'if("²" VERSION_LESS "0")\ntrace(1)\nendif()\nif("1" EQUAL "٣")\ntrace(2)\nendif()',
    "string(REPEAT f 5000 B)\nif(0x${B} GREATER 5)\ntrace(1)\nendif()\nif(-0x${B} LESS 5)\ntrace(2)\nendif()",
    'string(REPEAT 0 5000 B)\nmath(EXPR A "${B}7 + 0x${B}f")',
    'option(L "")\nforeach(i 1)\nif(L)\nelseif(1)\nif(NOT "${U1}" STREQUAL x)\nbreak()\nendif()\nendif()\nset(A y)\nendforeach()',
)


@pytest.mark.skipif(CMAKE is None, reason="cmake is not installed")
def test_values_of_small_scripts_equal_those_of_cmake(tmp_path: Path) -> None:
    assert CMAKE is not None
    scripts = {number: Script(text, ("", "0", "a")) for number, text in enumerate(_SMALL)}
    real = really_run(CMAKE, scripts, tmp_path)
    assert len(real) == len(scripts)
    wrong = {scripts[number].text: disagreements(evaluated(scripts[number]), outcome) for number, outcome in real.items()}
    assert not {text: differences for text, differences in wrong.items() if differences}


@pytest.mark.skipif(CMAKE is None, reason="cmake is not installed")
def test_values_of_random_scripts_equal_those_of_cmake(tmp_path: Path) -> None:
    assert CMAKE is not None
    once_wrong = (1001882, 3009064, 5005705, 7504225, 8003661, 9001190, 20009052, 20010304)
    scripts = {seed: generate(seed) for seed in (*range(300), *once_wrong)}
    real = really_run(CMAKE, scripts, tmp_path)
    assert len(real) > 150
    wrong = {}
    known_count = total = 0
    for seed, outcome in real.items():
        try:
            outcome_of_evaluator = evaluated(scripts[seed])
        except BudgetExceeded:
            continue
        if differences := disagreements(outcome_of_evaluator, outcome):
            wrong[seed] = differences
        total += len(outcome_of_evaluator.values)
        known_count += sum(value is None or is_known(value) for value in outcome_of_evaluator.values.values())
    assert not wrong, "\n".join(f"{seed}: {differences}\n{scripts[seed].text}" for seed, differences in list(wrong.items())[:2])
    assert known_count > total * 0.5
