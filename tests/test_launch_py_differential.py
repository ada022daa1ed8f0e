"""The interpreter of Python launch files, compared with Python on programs without anything unknown."""

import re

import pytest

from ros_lint.base.text import Text
from ros_lint.collectors.launch.python import collect as launch_py
from ros_lint.collectors.symbolic_text import UNKNOWN
from tests.python_programs import EXPRESSIONS, IMPORTS, OPEN_EXPRESSIONS, OPEN_PROGRAMS, PROGRAMS, values


def _followed(program: str) -> list[tuple[str, ...]]:
    """Return the executables of the certainly started nodes, which are the values in the interpreter."""
    end = "\nfrom launch_ros.actions import Node\n\ndef generate_launch_description():\n"
    end += "    return [Node(package='a', executable=str(value)) for value in values]\n"
    result = launch_py.collect(Text("a.launch.py", IMPORTS + program + end))
    assert not result.opaque
    started = []
    for action in result.actions:
        assert action.target is not None
        assert not action.conditions
        started.append(action.target.texts)
    return started


def _admits(texts: tuple[str, ...], value: str) -> bool:
    """Return whether a value is one of several texts, parts of which may be unknown."""
    return any(re.fullmatch(".*".join(map(re.escape, text.split(UNKNOWN))), value, re.DOTALL) for text in texts)


@pytest.mark.parametrize("expression", EXPRESSIONS.strip().split("\n"))
def test_expressions_have_the_value_of_python(expression: str) -> None:
    program = f"values = [{expression}]"
    assert _followed(program) == [(value,) for value in values(program)]


@pytest.mark.parametrize("expression", OPEN_EXPRESSIONS.strip().split("\n"))
def test_unknown_expressions_admit_the_value_of_python(expression: str) -> None:
    program = f"values = [{expression}]"
    assert [_admits(texts, value) for texts, value in zip(_followed(program), values(program), strict=True)] == [True]


@pytest.mark.parametrize("program", PROGRAMS.strip().split("\n\n"))
def test_programs_have_the_values_of_python(program: str) -> None:
    assert _followed(program) == [(value,) for value in values(program)]


@pytest.mark.parametrize("program", OPEN_PROGRAMS.strip().split("\n\n"))
def test_unknown_values_admit_the_values_of_python(program: str) -> None:
    followed, expected = _followed(program), values(program)
    assert all(_admits(texts, value) for texts, value in zip(followed, expected, strict=True)), (followed, expected)
