"""Recursive functions of Python launch files with unknown arguments."""

import pytest

from ros_lint.base.text import Text
from ros_lint.collectors.launch.python import collect as launch_py
from ros_lint.collectors.python.interpreter import machine as launch_py_run
from ros_lint.collectors.python.interpreter.machine import Machine
from ros_lint.facts.launch import LaunchFile
from tests.launch_cases import summaries

HEAD = """\
import os
from pathlib import Path
import yaml
from launch import LaunchDescription
from launch_ros.actions import Node

nodes = []

"""

BODY = """
def generate_launch_description():
    {}
    return LaunchDescription(nodes)
"""

SEARCH = """\
def search(d, key):
    if isinstance(d, dict):
        for v in d.values():
            search(v, key)
    elif isinstance(d, list):
        for v in d:
            search(v, key)
"""

BRANCHES = {
    "a nested dictionary": (SEARCH, "search(unknown(), 'x')"),
    "what the functions around have": (
        "data = unknown()\ndef f():\n    if data.first():\n        f()\n    else:\n        f()",
        "f()",
    ),
    "nothing": ("def f():\n    if unknown():\n        f()\n    else:\n        f()", "f()"),
    "a lambda": ("f = lambda x: f(x.left) if x.more else f(x.right)", "f(unknown())"),
    "functions that call each other": (
        "def f(x):\n    for y in x.left: g(y)\n    for y in x.right: g(y)\ndef g(x):\n    f(x.first)\n    f(x.second)",
        "f(unknown())",
    ),
    "a method": (
        "class Tree:\n    def __init__(self, data):\n        self.data = data\n    def walk(self):\n"
        "        for x in self.data.left: Tree(x).walk()\n        for x in self.data.right: Tree(x).walk()",
        "Tree(unknown()).walk()",
    ),
    "a text that grows": (
        "def f(x, p):\n    for k in x.left: f(x[k], p + '/' + k)\n    for k in x.right: f(x[k], f'{p}/{k}')",
        "f(unknown(), 'root')",
    ),
    "a path that grows": (
        "def f(x, p):\n    for k in x.left: f(x[k], p / k)\n    for k in x.right: f(x[k], p / k)",
        "f(unknown(), Path('root'))",
    ),
    "a list that grows": (
        "def f(x, p):\n    for k in x.left: f(x[k], p + [k])\n    for k in x.right: f(x[k], [*p, k])",
        "f(unknown(), ['root'])",
    ),
    "a list that is added to": (
        "def f(x, found):\n    for k in x.left:\n        found.append(Node(package='a', executable=k))\n        f(x[k], found)\n"
        "    for k in x.right:\n        nodes.append(Node(package='a', executable='c'))\n        f(x[k], found)",
        "f(unknown(), nodes)",
    ),
    "a description that is added to": (
        "def f(x, ld):\n    for k in x.left:\n        ld.add_action(Node(package='a', executable=k))\n        f(x[k], ld)\n"
        "    for k in x.right:\n        ld.add_action(Node(package='a', executable='c'))\n        f(x[k], ld)",
        "f(unknown(), LaunchDescription())",
    ),
    "one of several values": (
        "def f(x, p, q):\n    r = p if x.same else x.last\n    f(x.left, r, os.path) if x.more else f(x.right, r, os.path)",
        "f(unknown(), {'a': (1, 2.5, None, f)}, os.path)",
    ),
    "whether a file is there": (
        "def f(x):\n    if x:\n        f(os.path.exists('a'))\n    else:\n        f(os.path.exists('b'))",
        "f(os.path.exists('c'))",
    ),
}


def collect(functions: str, start: str) -> tuple[Text, LaunchFile]:
    source = Text("a.launch.py", HEAD + functions + BODY.format(start))
    return source, launch_py.collect(source)


@pytest.fixture
def machines(monkeypatch: pytest.MonkeyPatch) -> list[Machine]:
    """Return the list of the machines that are created during the test."""
    made: list[Machine] = []
    init = Machine.__init__

    def noted(self: Machine, *arguments: object) -> None:
        made.append(self)
        init(self, *arguments)  # type: ignore[arg-type]

    monkeypatch.setattr(Machine, "__init__", noted)
    return made


@pytest.mark.parametrize("name", BRANCHES)
def test_recursive_calls_in_both_branches_take_linear_time(
    name: str, machines: list[Machine], monkeypatch: pytest.MonkeyPatch
) -> None:
    steps = []
    for depth in (8, 16):
        monkeypatch.setattr(launch_py_run, "_DEEPEST_CALL", depth)
        collect(*BRANCHES[name])
        steps.append(launch_py_run.STEPS - machines[-1].budget.steps)
    assert steps[1] <= 2 * steps[0]
    assert steps[0] < 1_000


def test_actions_after_a_recursive_search_are_found() -> None:
    source, launch_file = collect(SEARCH, "search(unknown(), 'x'); nodes.append(Node(package='a', executable='b'))")
    assert summaries(source, launch_file) == ["node a b"]
    assert not launch_file.opaque


def test_arguments_of_a_repeated_call_may_be_launched() -> None:
    function = "def f(x, action):\n    if x.right:\n        return [action, f(x.left, action)]\n"
    source, launch_file = collect(function, "f(unknown(), Node(package='a', executable='b'))")
    assert summaries(source, launch_file) == ["node? a b"]


def test_the_result_of_a_repeated_call_is_unknown() -> None:
    function = "def f(x):\n    if x.right:\n        return Node(package='a', executable='b')\n    return f(x.left)\n"
    source, launch_file = collect(function, "return LaunchDescription([f(unknown())])")
    assert summaries(source, launch_file) == ["node? a b"]
    assert [item.reason for item in launch_file.opaque] == ["the launched actions are not known: the result of f() within itself"]


# Functions that call themselves, how they are called, and what they start. Known values decide how often.
FOLLOWED = {
    "an argument": (
        "def f(n):\n    return [Node(package='a', executable=f'b{n}'), *f(n - 1)] if n else []",
        "nodes.extend(f(3))",
        "b3 b2 b1",
    ),
    "an argument besides an unknown argument": (
        "def f(x, n):\n    if n and x.more:\n        return [Node(package='a', executable=f'b{n}'), *f(x, n - 1)]\n    return []",
        "nodes.extend(f(unknown(), 3))",
        "b3 b2 b1",
    ),
    "an argument besides a large argument": (
        "def f(x, many, n):\n    if n and x.more:\n        return [Node(package='a', executable=f'b{n}'), *f(x, many, n - 1)]\n"
        "    return []",
        "nodes.extend(f(unknown(), list(range(600)), 3))",
        "b3 b2 b1",
    ),
    "an argument that chooses": (
        "def f(x, name):\n    if x.first == name: return [Node(package='a', executable=name)]\n"
        "    if name == 'b': return f(x, 'c')\n    if name == 'c': return f(x, 'd')\n    return []",
        "nodes.extend(f(unknown(), 'b'))",
        "b c d",
    ),
    "a list that is taken apart": (
        "def f(x, names):\n    if not names or x.done: return []\n    name, *rest = names\n"
        "    return [Node(package='a', executable=name), *f(x, rest)]",
        "nodes.extend(f(unknown(), ['b', 'c', 'd']))",
        "b c d",
    ),
    "a list around the function": (
        "names = ['b', 'c', 'd']\ndef f(x):\n    if not names or x.done: return []\n"
        "    return [Node(package='a', executable=names.pop()), *f(x)]",
        "nodes.extend(f(unknown()))",
        "d c b",
    ),
    "a list around a function that is called": (
        "names = ['b', 'c', 'd']\ndef more(): return bool(names)\ndef last(): return names.pop()\n"
        "def f(x):\n    if x.done or not more(): return []\n    return [Node(package='a', executable=last()), *f(x)]",
        "nodes.extend(f(unknown()))",
        "d c b",
    ),
    "a list of a class": (
        "class A:\n    names = ['b', 'c', 'd']\ndef f(x):\n"
        "    return [Node(package='a', executable=A.names.pop()), *f(x)] if A.names else []",
        "nodes.extend(f(unknown()))",
        "d c b",
    ),
    "an attribute": (
        "class A:\n    n = 4\n    def f(self, x):\n        self.n -= 1\n        if not self.n or x.done: return []\n"
        "        return [Node(package='a', executable=f'b{self.n}'), *self.f(x)]",
        "nodes.extend(A().f(unknown()))",
        "b3 b2 b1",
    ),
    "functions with one definition": (
        "def only_if_more(function):\n    def inner(x):\n        return function(x) if x.more else []\n    return inner\n"
        "@only_if_more\ndef last(x): return [Node(package='a', executable='b')]\n"
        "@only_if_more\ndef between(x): return last(x)\n@only_if_more\ndef first(x): return between(x)",
        "nodes.extend(first(unknown()))",
        "b",
    ),
}


@pytest.mark.parametrize("name", FOLLOWED)
def test_calls_with_different_known_arguments_are_interpreted(name: str) -> None:
    functions, start, expected = FOLLOWED[name]
    source, launch_file = collect(functions, start)
    assert sorted(item.rpartition(" ")[2] for item in summaries(source, launch_file)) == sorted(expected.split())
    assert not launch_file.opaque
