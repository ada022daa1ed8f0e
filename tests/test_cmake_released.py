"""Comparison of compiled macros with the interpretation of the same macros."""

from __future__ import annotations

import random

import pytest

from ros_lint.base.text import Text
from ros_lint.collectors.cmake.commands import ament as cmake_ros
from ros_lint.collectors.cmake.commands.compiled_macros import ReleasedMacros, released, run_released
from ros_lint.collectors.cmake.evaluate import evaluate
from ros_lint.collectors.cmake.evaluator.flow import call
from ros_lint.collectors.cmake.evaluator.run import Run
from ros_lint.collectors.cmake.evaluator.sources import Sources
from ros_lint.collectors.cmake.released_macros import macros
from ros_lint.collectors.cmake.syntax import parse
from ros_lint.facts.build import BuildScript

FILES = ("CMakeLists.txt", "include/pkg/a.hpp", "launch/a.launch.py", "msg/A.msg", "plugins.xml", "src/a.cpp", "src/b.cpp")
WORDS = (
    "a", "b", "src/a.cpp", "src/b.cpp", "${L}", '"${L}"', '"x y"', "${U_FOUND}", "launch", "plugins.xml", "msg/A.msg",
    '"$<TARGET_FILE:a>"', '"a;b"', '""', "DIRECTORY", "src", "PLUGIN", '"pkg::A"', "EXECUTABLE", "INSTALL_TO_SHARE",
    "INSTALL_TO_PATH", "SHARED", "DEPENDENCIES", "std_msgs", "SKIP_INSTALL", "EXECUTOR", "CONFIG_EXTRAS", "REQUIRED",
    "RESOURCE_INDEX", "COMPONENTS", "TARGETS", "PUBLIC", "nav2_core::Planner", "${PROJECT_NAME}", "${PROJECT_NAME}_x",
)  # fmt: skip


def _step_by_step(run: Run, macro: ReleasedMacros, args: list[str]) -> int:
    return run_released(run, macro, args) if macro.direct else call(run, macro.procedure, args)


def _result(script: str) -> BuildScript:
    text = f"cmake_minimum_required(VERSION 3.8)\nproject(pkg)\nset(L a b)\nfind_package(U)\n{script}"
    parsed = {"CMakeLists.txt": parse(Text("CMakeLists.txt", text))}
    depends = ("rclcpp", "std_msgs")
    result = evaluate(Sources("pkg", "", FILES, parsed, build_depends=depends, test_depends=("ament_lint_auto",)))
    names = tuple(name for name in result.commands.names if name != "cmake_parse_arguments")
    return result._replace(commands=result.commands._replace(names=names))


def _script(choice: random.Random, names: list[str]) -> str:
    lines = []
    for _ in range(choice.randint(1, 6)):
        words = " ".join(choice.choice(WORDS) for _ in range(choice.randint(1, 7)))
        line = f"{choice.choice(names)}({words})\n"
        lines.append(line if choice.random() < 0.8 else f"if(U_FOUND)\n{line}endif()\n")
    return "".join(lines)


@pytest.mark.parametrize("seed", range(300))
def test_compiled_macros_have_the_effects_of_interpreted_ones(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    compiled = [name for name in macros() if (macro := released(name)) and macro.steps]
    choice = random.Random(seed)
    script = _script(choice, compiled)
    fast = _result(script)
    monkeypatch.setattr(cmake_ros, "run_released", _step_by_step)
    slow = _result(script)
    assert fast == slow, script


def test_most_macros_with_keywords_are_compiled() -> None:
    for name in ("ament_auto_package", "ament_auto_add_library", "autoware_package", "rclcpp_components_register_node"):
        macro = released(name)
        assert macro is not None
        assert macro.steps, name
    lookup = released("ament_index_get_resource")
    assert lookup is not None
    assert lookup.steps is None
