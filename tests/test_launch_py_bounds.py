"""What Python launch files with too many steps, branches and nested calls hide, and where. Their other actions are known."""

import pickle
from collections.abc import Sequence

import pytest

from ros_lint.base.text import Text
from ros_lint.collectors.launch.python.collect import collect
from ros_lint.collectors.python.interpreter.recorder import Recorder
from ros_lint.collectors.python.interpreter.values import Guarded
from ros_lint.facts.launch import LaunchFile, walk_actions

HEAD = """\
from launch import LaunchDescription
from launch_ros.actions import Node

"""
"""Three lines."""
GENERATE = "def generate_launch_description():\n"
MANY = 100


def read(program: str) -> LaunchFile:
    return collect(Text("a.launch.py", HEAD + program))


def nodes(file: LaunchFile) -> list[str]:
    return [
        text for action in walk_actions(file.actions) if action.kind == "node" and action.target for text in action.target.texts
    ]


def test_the_statement_at_which_the_steps_end_is_named() -> None:
    loops = "    y = [a for a in range(1000) for b in range(1000)]\n"
    file = read(f"{GENERATE}    x = [Node(package='a', executable='b')]\n{loops * 3}    return LaunchDescription(x)\n")
    assert {(opaque.reason, opaque.span.line) for opaque in file.opaque} == {
        ("the file contains a call that takes too many steps", 6)
    }
    assert nodes(file) == ["b"]


def test_a_call_that_takes_too_many_steps_hides_what_it_adds() -> None:
    helper = (
        "def more(x):\n    y = [a for a in range(1000) for b in range(1000)]\n    x.append(Node(package='a', executable='c'))\n\n"
    )
    body = "    x = [Node(package='a', executable='b')]\n    more(x)\n    return LaunchDescription(x)\n"
    file = read(f"{helper}{GENERATE}{body}")
    assert [(opaque.reason, opaque.span.line) for opaque in file.opaque] == [
        ("the file contains a call that takes too many steps", 5)
    ]
    assert nodes(file) == ["b"]


def test_calls_that_are_nested_too_deeply_hide_what_they_add() -> None:
    helper = "def more(x, n):\n    if n:\n        x.append(Node(package='a', executable=f'c{n}'))\n        more(x, n - 1)\n\n"
    file = read(f"{helper}{GENERATE}    x = []\n    more(x, {MANY})\n    return LaunchDescription(x)\n")
    assert [(opaque.reason, opaque.span.line) for opaque in file.opaque] == [
        ("the file contains calls that are nested too deeply", 7)
    ]
    assert 0 < len(nodes(file)) < MANY


RETURN = "    if unknown({0}):\n        return LaunchDescription([Node(package='a', executable='b{0}')])\n"
RETURNS = "".join(map(RETURN.format, range(MANY)))
TURNS = """\
    for y in range(100):
        if unknown(y):
            break
        x.append(Node(package='a', executable=f'b{y}'))
"""


@pytest.mark.parametrize("branches", [RETURNS, TURNS])
def test_nodes_after_many_ways_out_are_under_few_conditions(branches: str) -> None:
    file = read(f"{GENERATE}    x = []\n{branches}    return LaunchDescription(x)\n")
    assert nodes(file) == [f"b{n}" for n in range(MANY)]
    counts = [len(action.conditions) for action in file.actions]
    assert min(counts) > 0
    assert max(counts) < 40
    assert sum(counts) > 2 * MANY


def joins(monkeypatch: pytest.MonkeyPatch, program: str) -> tuple[LaunchFile, int]:
    """Return the facts about a program, and how many values of branches are joined while it is interpreted."""
    count = 0
    join = Recorder.joined

    def counted(machine: Recorder, values: Sequence[Guarded]) -> object:
        nonlocal count
        count += 1
        return join(machine, values)

    monkeypatch.setattr(Recorder, "joined", counted)
    return read(program), count


SEARCH = (
    "    y = 'start'\n    for z in " + repr([f"f{i}" for i in range(8)]) + ":\n        w = z + '/x'\n"
    "        if u(w):\n            y = z\n            break\n"
)


def test_only_names_that_are_read_are_joined(monkeypatch: pytest.MonkeyPatch) -> None:
    file, count = joins(monkeypatch, f"{GENERATE}{SEARCH}    return LaunchDescription([Node(package='a', executable=y)])\n")
    assert nodes(file) == ["start", *(f"f{i}" for i in range(8))]
    assert count < 20, "z and w are not read after the loop"


def test_a_deep_chain_of_branches_is_joined_without_recursion(monkeypatch: pytest.MonkeyPatch) -> None:
    branches = "".join(f"    if u({i}):\n        y = {'bc'[i % 2]!r}\n" for i in range(1_500))
    file, _ = joins(
        monkeypatch, f"{GENERATE}    y = 'b'\n{branches}    return LaunchDescription([Node(package='a', executable=y)])\n"
    )
    assert file.actions
    assert not file.opaque


def test_a_list_gets_an_unknown_element_once_in_a_loop() -> None:
    loop = (
        "    x = ['a']\n    for i in range(40):\n        if u(i):\n"
        "            x.append(u().name)\n            x.append(f'{u()}/b')\n"
    )
    file = read(f"{GENERATE}{loop}    return LaunchDescription([Node(package='a', executable='b', arguments=x)])\n")
    (action,) = [action for action in walk_actions(file.actions) if action.kind == "node"]
    assert len(action.arguments) == 3


def test_names_changed_in_a_branch_of_a_loop_are_known_after_it() -> None:
    loop = (
        "    y = 'a'\n    if u():\n        for i in ['c', 'd']:\n            y = i\n            if u(i):\n                break\n"
        "        else:\n            return LaunchDescription()\n"
    )
    file = read(f"{GENERATE}{loop}    return LaunchDescription([Node(package='a', executable=y)])\n")
    assert sorted(nodes(file)) == ["a", "c", "d"]


def test_facts_are_sent_between_processes_without_the_program() -> None:
    declare = "    x = [DeclareLaunchArgument('a', description='what a is', default_value='b')]\n    if u():\n        y = 1\n"
    head = "from launch.actions import DeclareLaunchArgument\n"
    file = read(f"{head}{GENERATE}{declare}    return LaunchDescription(x)\n")
    assert pickle.loads(pickle.dumps(file)) == file
    assert b"interpreter" not in pickle.dumps(file)
