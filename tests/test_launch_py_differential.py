"""The interpreter of Python launch files, compared with Python on programs without anything unknown."""

import re

import pytest

from ros_lint.base.text import Text
from ros_lint.collectors.launch.python import collect as launch_py
from ros_lint.collectors.symbolic_text import UNKNOWN
from tests.python_programs import EXPRESSIONS, IMPORTS, OPEN_EXPRESSIONS, OPEN_PROGRAMS, PROGRAMS, values


def _followed(program: str) -> list[tuple[str, ...]]:
    """Return the texts of the values that the interpreter makes: of the programs of nodes that are certainly started."""
    end = "\nfrom launch_ros.actions import Node\n\ndef generate_launch_description():\n"
    end += "    return [Node(package='a', executable=str(value)) for value in values]\n"
    found = launch_py.collect(Text("a.launch.py", IMPORTS + program + end))
    assert not found.opaque
    started = []
    for action in found.actions:
        assert action.target is not None
        assert not action.conditions
        started.append(action.target.texts)
    return started


def _admits(texts: tuple[str, ...], value: str) -> bool:
    """Return whether a value is one of several texts, parts of which may be unknown."""
    return any(re.fullmatch(".*".join(map(re.escape, text.split(UNKNOWN))), value, re.DOTALL) for text in texts)


@pytest.mark.parametrize("expression", EXPRESSIONS.strip().split("\n"))
def test_expressions_are_what_python_makes_of_them(expression: str) -> None:
    program = f"values = [{expression}]"
    assert _followed(program) == [(value,) for value in values(program)]


@pytest.mark.parametrize("expression", OPEN_EXPRESSIONS.strip().split("\n"))
def test_open_expressions_admit_what_python_makes_of_them(expression: str) -> None:
    program = f"values = [{expression}]"
    assert [_admits(texts, value) for texts, value in zip(_followed(program), values(program), strict=True)] == [True]


@pytest.mark.parametrize("program", PROGRAMS.strip().split("\n\n"))
def test_values_are_those_of_python(program: str) -> None:
    assert _followed(program) == [(value,) for value in values(program)]


@pytest.mark.parametrize("program", OPEN_PROGRAMS.strip().split("\n\n"))
def test_open_values_admit_those_of_python(program: str) -> None:
    followed, wanted = _followed(program), values(program)
    assert all(_admits(texts, value) for texts, value in zip(followed, wanted, strict=True)), (followed, wanted)
