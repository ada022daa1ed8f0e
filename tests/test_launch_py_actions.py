"""Actions and substitutions of the launch libraries in Python launch files.

The expectations are what the sources of launch say: launch/actions, launch/substitutions and launch/utilities.
"""

import pytest

from ros_lint.base.text import Text
from ros_lint.collectors.launch.expand import expand
from ros_lint.collectors.launch.python import collect as launch_py
from ros_lint.collectors.symbolic_text import UNKNOWN, prefix
from ros_lint.facts.launch import LaunchFile
from tests.launch_cases import summaries

FRAME = """\
from launch import LaunchDescription
from launch.actions import *
from launch.substitutions import *
from launch.utilities import normalize_to_list_of_substitutions
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackagePrefix

{}

def generate_launch_description():
{}
"""


def collect(body: str, functions: str = "") -> tuple[Text, LaunchFile]:
    source = Text("a.launch.py", FRAME.format(functions, "".join(f"    {line}\n" for line in body.split("\n"))))
    return source, launch_py.collect(source)


@pytest.mark.parametrize(
    ("text", "given", "expected"),
    [
        ("IfElseSubstitution(LaunchConfiguration('x'), 'b', 'c')", {"x": "true"}, "b"),
        ("IfElseSubstitution(LaunchConfiguration('x'), 'b', 'c')", {"x": "false"}, "c"),
        ("IfElseSubstitution(LaunchConfiguration('x'), if_value='b')", {"x": "0"}, ""),
        ("IfElseSubstitution(LaunchConfiguration('x'), else_value='c')", {"x": "1"}, ""),
        ("IfElseSubstitution(LaunchConfiguration('x'), else_value='c')", {"x": "0"}, "c"),
        ("StringJoinSubstitution([['b', LaunchConfiguration('x')], 'c'], delimiter='.')", {"x": "d"}, "bd.c"),
        ("StringJoinSubstitution(['b', 'c'])", {}, "bc"),
        ("StringJoinSubstitution(('b', 'c'), LaunchConfiguration('x'))", {"x": "-"}, "b-c"),
        ("StringJoinSubstitution(unknown())", {}, UNKNOWN),
        ("[FindPackagePrefix('p'), '/lib']", {}, f"{prefix('p')}/lib"),
        ("normalize_to_list_of_substitutions(LaunchConfiguration('x'))", {"x": "b"}, "b"),
    ],
)
def test_substitutions_give_symbolic_texts(text: str, given: dict[str, str], expected: str) -> None:
    _, file = collect(f"return LaunchDescription([Node(package='a', executable={text})])")
    (started,) = expand(file, given).started
    assert started.target == (expected,)


@pytest.mark.parametrize(
    ("value", "given", "expected"),
    [
        ("context.launch_configurations['x']", {"x": "b"}, "b"),
        ("context.launch_configurations.get('x')", {"x": "b"}, "b"),
        ("context.launch_configurations.get('x', 'c')", {"x": "b"}, "b"),
        ("context.launch_configurations.get('x', 'c')", {}, "c"),
    ],
)
def test_configurations_of_the_context_are_read(value: str, given: dict[str, str], expected: str) -> None:
    function = f"def setup(context):\n    return [Node(package='a', executable={value})]"
    _, file = collect("return LaunchDescription([OpaqueFunction(function=setup)])", function)
    (started,) = expand(file, given).started
    assert started.target == (expected,)


@pytest.mark.parametrize(
    ("actions", "expected"),
    [
        ("AppendEnvironmentVariable('X', 'b')", f"{UNKNOWN}:b"),
        ("SetEnvironmentVariable('X', 'a'), AppendEnvironmentVariable('X', 'b')", "a:b"),
        ("SetEnvironmentVariable('X', 'a'), AppendEnvironmentVariable('X', 'b', prepend=True)", "b:a"),
        ("SetEnvironmentVariable('X', 'a'), AppendEnvironmentVariable(name='X', value='b', prepend='true')", "b:a"),
        ("SetEnvironmentVariable('X', 'a'), AppendEnvironmentVariable('X', 'b', False, separator='; ')", "a; b"),
    ],
)
def test_extended_environment_variables_are_known(actions: str, expected: str) -> None:
    _, file = collect(f"return LaunchDescription([{actions}, Node(package='a', executable='c')])")
    (started,) = expand(file, {}).started
    assert started.environment == (("X", (expected,)),)


@pytest.mark.parametrize(
    "function",
    [
        "def each(name, id):\n    return [Node(package='a', executable='b')]",
        "def each(*, name, p='a'):\n    return [Node(package='a', executable='b', name=name, namespace=p)]",
        "def each(**values):\n    return [Node(package='a', executable='b', name=values['name'])]",
        "def each(i):\n    return [Node(package='a', executable='b', name=f'n{i}')] if i else []",
    ],
)
@pytest.mark.parametrize("action", ["ForEach", "ForLoop"])
def test_loops_over_values_start_their_actions(action: str, function: str) -> None:
    source, file = collect(f"return LaunchDescription([{action}(LaunchConfiguration('x'), function=each)])", function)
    assert summaries(source, file) == ["node? a b"]
    assert not file.opaque


def test_loop_values_replace_parameter_defaults() -> None:
    function = "def each(p='a'):\n    return [Node(package=p, executable='b')]"
    _, file = collect("return LaunchDescription([ForEach(LaunchConfiguration('x'), function=each)])", function)
    assert [UNKNOWN in action.package.texts for action in file.actions if action.package] == [True]


@pytest.mark.parametrize(
    ("keywords", "name", "namespace"),
    [
        ("", None, None),
        (", name=None", None, None),
        (", name='b'", ("b",), None),
        (", name='b' if unknown() else None", ("b", ""), None),
        (", namespace=None if unknown() else 'n'", None, ("", "n")),
        (", **unknown()", (UNKNOWN,), (UNKNOWN,)),
        (", name='b', **unknown()", ("b",), (UNKNOWN,)),
        (", **{'name': 'b'}", ("b",), None),
    ],
)
def test_a_name_is_set_or_not_set_or_unknown(
    keywords: str, name: tuple[str, ...] | None, namespace: tuple[str, ...] | None
) -> None:
    _, file = collect(f"return LaunchDescription([Node(package='a', executable='x'{keywords})])")
    (node,) = file.actions
    assert (node.name and node.name.texts, node.namespace and node.namespace.texts) == (name, namespace)


def test_unknown_keywords_may_have_parameters_and_remappings() -> None:
    _, file = collect("return LaunchDescription([Node(package='a', executable='x', **unknown())])")
    (node,) = file.actions
    assert [name for name, _ in node.parameters] == [UNKNOWN]
    assert [(old.texts, new.texts) for old, new in node.remappings] == [((UNKNOWN,), (UNKNOWN,))]
    _, file = collect("return LaunchDescription([Node(package='a', executable='x', parameters=[], remappings=[], **unknown())])")
    assert (file.actions[0].parameters, file.actions[0].remappings) == ((), ())


def test_a_default_that_may_be_none_is_unknown() -> None:
    _, file = collect("return LaunchDescription([DeclareLaunchArgument('a', default_value='b' if unknown() else None)])")
    (argument,) = file.actions
    assert argument.value is not None
    assert argument.value.texts == ("b", UNKNOWN)


@pytest.mark.parametrize(
    ("test", "command"),
    [
        ("launch_testing.actions.GTest(path='/a/b')", "/a/b"),
        ("launch_testing.actions.PyTest(path='/a/b.py', timeout=3)", f"{UNKNOWN} -m pytest /a/b.py"),
        ("launch_testing.util.KeepAliveProc()", f"{UNKNOWN} -c {UNKNOWN}"),
    ],
)
def test_programs_of_tests_are_processes(test: str, command: str) -> None:
    _, file = collect(f"import launch_testing\nreturn LaunchDescription([{test}])")
    (started,) = expand(file, {}).started
    assert (started.kind, started.target) == ("process", (command,))
