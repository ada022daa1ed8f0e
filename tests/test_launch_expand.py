"""Expansion of launch files with arguments, through their includes."""

import re
from collections.abc import Mapping

import pytest

from ros_lint.collectors.launch.expand import expand
from ros_lint.collectors.launch.expansion import Expansion, Started
from ros_lint.facts.launch import LaunchFile
from tests.launch_cases import collect


def xml(body: str, path: str = "pkg/launch/a.launch.xml") -> LaunchFile:
    return collect(path, f"<launch>\n{body}\n</launch>\n")[1]


def python(actions: str, path: str = "pkg/launch/a.launch.py") -> LaunchFile:
    return collect(
        path,
        "from launch import LaunchDescription\nfrom launch.actions import *\nfrom launch.conditions import *\n"
        "from launch.substitutions import *\nfrom launch_ros.actions import *\n"
        f"def generate_launch_description():\n    return LaunchDescription([{actions}])\n",
    )[1]


def run(file: LaunchFile, arguments: Mapping[str, str] | None = None, **files: LaunchFile) -> Expansion:
    by_path = {f"/x/{name}.launch.xml": started for name, started in files.items()}
    return expand(file, arguments or {}, by_path.get)


def short(started: Started) -> str:
    words = [started.kind, "|".join(started.package), "|".join(started.target)]
    return " ".join(word for word in words if word) + ("" if started.certain else " ?")


def summaries(expansion: Expansion) -> list[str]:
    return [short(started) for started in expansion.started if started.kind != "include"]


def test_passed_arguments_override_defaults() -> None:
    file = xml('<arg name="which" default="one"/><node pkg="p" exec="$(var which)"/>')
    assert summaries(run(file)) == ["node p one"]
    assert summaries(run(file, {"which": "two"})) == ["node p two"]


def test_conditions_have_three_values() -> None:
    file = xml(
        '<arg name="sim" default="false"/>'
        '<node pkg="p" exec="a" if="$(var sim)"/>'
        '<node pkg="p" exec="b" unless="$(var sim)"/>'
        '<node pkg="p" exec="c" if="$(env NOT_KNOWN)"/>'
    )
    assert summaries(run(file)) == ["node p b", "node p c ?"]
    assert summaries(run(file, {"sim": "true"})) == ["node p a", "node p c ?"]


def test_nested_logic_is_evaluated() -> None:
    file = xml(
        '<arg name="a" default="true"/><arg name="mock" default="false"/>'
        '<node pkg="p" exec="x" if="$(and $(var a) $(not $(var mock)))"/>'
        """<node pkg="p" exec="y" if="$(or $(equals $(var mock) 'it\\'s') $(if $(not $(var a)) true false))"/>"""
    )
    assert summaries(run(file)) == ["node p x"]
    assert summaries(run(file, {"mock": "true"})) == []
    assert summaries(run(file, {"a": "false"})) == ["node p y"]
    node = python(
        "DeclareLaunchArgument('a', default_value='true'), DeclareLaunchArgument('b', default_value='false'),"
        "Node(package='p', executable='x', condition=IfCondition("
        "AndSubstitution(LaunchConfiguration('a'), NotSubstitution(LaunchConfiguration('b')))))"
    )
    assert summaries(run(node)) == ["node p x"]
    assert summaries(run(node, {"b": "true"})) == []


def test_an_executable_chosen_by_a_branch_belongs_to_that_branch() -> None:
    file = collect(
        "pkg/launch/a.launch.py",
        """
import os
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

def setup(context):
    package, executable = "real", "driver"
    if LaunchConfiguration("sim").perform(context) == "true":
        package, executable = "fake", "simulator"
    other = "new" if os.environ["ROS_DISTRO"] != "foxy" else "old"
    return [Node(package=package, executable=executable), Node(package="p", executable=other)]

def generate_launch_description():
    return LaunchDescription([DeclareLaunchArgument("sim", default_value="false"), OpaqueFunction(function=setup)])
""",
    )[1]
    assert summaries(expand(file, {}, lambda _: None, "jazzy")) == ["node real driver", "node p new"]
    assert summaries(expand(file, {"sim": "true"}, lambda _: None, "foxy")) == ["node fake simulator", "node p old"]


def test_comparisons_joined_by_and_and_or_are_evaluated() -> None:
    file = collect(
        "pkg/launch/a.launch.py",
        """
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

def setup(context):
    sim = LaunchConfiguration("sim").perform(context)
    robot = LaunchConfiguration("robot").perform(context)
    simulated = sim == "true" or sim == "True"
    nodes = [Node(package="p", executable="simulator" if simulated else "driver")]
    if robot != "" and sim != "true":
        nodes.append(Node(package="p", executable="motors"))
    return nodes

def generate_launch_description():
    arguments = [DeclareLaunchArgument("sim", default_value="false"), DeclareLaunchArgument("robot", default_value="r")]
    return LaunchDescription([*arguments, OpaqueFunction(function=setup)])
""",
    )[1]
    assert summaries(run(file)) == ["node p driver", "node p motors"]
    assert summaries(run(file, {"sim": "True", "robot": ""})) == ["node p simulator"]


def test_a_required_argument_that_is_not_passed_is_unknown() -> None:
    file = xml('<arg name="sim"/><node pkg="p" exec="a" if="$(var sim)"/><node pkg="p" exec="b"/>')
    assert summaries(run(file)) == ["node p a ?", "node p b"]


def test_python_launch_files_are_expanded_like_xml() -> None:
    file = python(
        "DeclareLaunchArgument('sim', default_value='true'), "
        "Node(package='p', executable='a', condition=IfCondition(LaunchConfiguration('sim'))), "
        "Node(package='p', executable=['b_', LaunchConfiguration('sim')])"
    )
    assert summaries(run(file)) == ["node p a", "node p b_true"]
    assert summaries(run(file, {"sim": "false"})) == ["node p b_false"]


def test_groups_keep_their_values_and_namespaces_unless_unscoped() -> None:
    body = '<arg name="v" default="out"/><group{}><push-ros-namespace namespace="n"/><let name="v" value="in"/></group>'
    node = '<node pkg="p" exec="$(var v)"/>'
    for scoped, expected, namespace in (("", "out", ("",)), (' scoped="false"', "in", ("n",))):
        (started,) = run(xml(body.format(scoped) + node)).started
        assert (started.target, started.namespace) == ((expected,), namespace)


def test_namespaces_are_joined() -> None:
    file = xml(
        '<group><push-ros-namespace namespace="a"/><group><push-ros-namespace namespace="b"/>'
        '<node pkg="p" exec="x" namespace="c"/><node pkg="p" exec="y" namespace="/d"/></group></group><node pkg="p" exec="z"/>'
    )
    assert [started.namespace for started in run(file).started] == [("a/b/c",), ("/d",), ("",)]


def test_includes_share_values_and_report_missing_arguments() -> None:
    inner = xml('<arg name="robot"/><arg name="speed" default="1"/><node pkg="p" exec="$(var robot)_$(var speed)"/>')
    outer = '<include file="/x/inner.launch.xml">{}</include>'
    expansion = run(xml(outer.format('<arg name="robot" value="r"/>')), inner=inner)
    assert (summaries(expansion), expansion.missing, expansion.complete) == (["node p r_1"], (), True)
    assert [started.depth for started in expansion.started] == [0, 1]
    expansion = run(xml(outer.format('<arg name="speed" value="2"/>')), inner=inner)
    assert [started.name for started in expansion.missing] == ["robot"]


def test_values_set_by_an_unscoped_include_stay_set() -> None:
    inner = xml('<push-ros-namespace namespace="n"/><let name="v" value="inner"/>')
    file = xml('<include file="/x/inner.launch.xml"/><node pkg="p" exec="$(var v)"/>')
    (started,) = (started for started in run(file, inner=inner).started if started.kind == "node")
    assert (started.target, started.namespace) == (("inner",), ("n",))


def test_an_include_under_an_unknown_condition_is_uncertain() -> None:
    inner = xml('<node pkg="p" exec="x"/>')
    file = xml('<include file="/x/inner.launch.xml" if="$(env NOT_KNOWN)"/>')
    assert summaries(run(file, inner=inner)) == ["node p x ?"]


def test_expansion_of_cyclic_includes_ends() -> None:
    inner = xml('<node pkg="p" exec="x"/><include file="/x/inner.launch.xml"/>')
    expansion = run(xml('<include file="/x/inner.launch.xml"/>'), inner=inner)
    assert summaries(expansion) == ["node p x"]
    assert not expansion.complete


def test_expansion_of_exponentially_many_branches_is_limited() -> None:
    files = {f"f{n}": xml(f'<include file="/x/f{n + 1}.launch.xml"/>' * 4) for n in range(12)}
    expansion = run(files["f0"], **files)
    assert not expansion.complete


def opaque(body: str, *arguments: str) -> LaunchFile:
    """Return a launch file with an OpaqueFunction."""
    indented = "".join(f"    {line}\n" for line in body.splitlines())
    return collect(
        "pkg/launch/a.launch.py",
        "from launch import LaunchDescription\nfrom launch.actions import *\nfrom launch.substitutions import *\n"
        f"from launch_ros.actions import *\ndef start(context):\n{indented}"
        "def generate_launch_description():\n"
        f"    return LaunchDescription([{', '.join(arguments)}, OpaqueFunction(function=start)])\n",
    )[1]


def test_a_dictionary_is_indexed_by_the_value_of_an_argument() -> None:
    file = opaque(
        "kind = LaunchConfiguration('kind').perform(context)\n"
        "programs = {'arm': 'move', 'base': 'drive'}\n"
        "return [Node(package='p', executable=programs[kind]), Node(package='q', executable=programs.get(kind, 'stand'))]",
        "DeclareLaunchArgument('kind', default_value='base')",
    )
    assert summaries(run(file)) == ["node p drive", "node q drive"]
    assert summaries(run(file, {"kind": "arm"})) == ["node p move", "node q move"]
    assert summaries(run(file, {"kind": "head"})) == ["node q stand"]


def test_text_methods_of_an_argument_are_applied_once_it_has_a_value() -> None:
    file = opaque(
        "mode = LaunchConfiguration('mode').perform(context).lower()\n"
        "found = [Node(package='p', executable='on' if mode == 'on' else 'off')]\n"
        "if mode.startswith('o'):\n"
        "    found.append(Node(package='q', executable=mode))\n"
        "return found",
        "DeclareLaunchArgument('mode', default_value='ON')",
    )
    assert summaries(run(file)) == ["node p on", "node q on"]
    assert summaries(run(file, {"mode": "Full"})) == ["node p off"]


def test_added_lists_are_concatenated() -> None:
    file = opaque(
        "names = LaunchConfiguration('names').perform(context).split(' ')\n"
        "both = sum([[Node(package='p', executable='a')], [Node(package='p', executable='b')]], [])\n"
        "return both + sum(([Node(package='q', executable='c')] for name in names), [])",
        "DeclareLaunchArgument('names', default_value='x')",
    )
    assert summaries(run(file)) == ["node p a", "node p b", "node q c ?"]
    assert not file.opaque


LATE = "Node(package='p', executable=LaunchConfiguration('which'))"
"""A node whose executable is read when launch starts it."""


def test_timers_keep_the_values_of_their_place_since_jazzy() -> None:
    """They run after all other actions, in the order of time (launch 3.10.0, and 1.0.14 for humble)."""
    first, last = "Node(package='q', executable='first')", "Node(package='q', executable='last')"
    inner = f"TimerAction(period=1.0, actions=[{LATE}])"
    timer = f"GroupAction([PushRosNamespace('g'), TimerAction(period=2.0, actions=[{LATE}, {inner}])])"
    changing = f"TimerAction(period=1.0, actions=[SetLaunchConfiguration('which', 'two'), {LATE}])"
    file = python(
        f"SetLaunchConfiguration('which', 'one'), {first}, {timer}, {changing}, SetLaunchConfiguration('which', 'end'), {last}"
    )
    expansion = expand(file, {}, distro="rolling")
    assert summaries(expansion) == ["node q first", "node p one", "node p one", "node p two", "node q last"]
    assert [started.later for started in expansion.started] == [False, True, True, True, False]
    assert [started.namespace for started in expansion.started] == [("",), ("g",), ("g",), ("",), ("",)]
    expansion = expand(file, {}, distro="humble")
    assert summaries(expansion) == ["node q first", *["node p two"] * 3, "node q last"]
    assert [started.namespace for started in expansion.started] == [("",)] * 5


@pytest.mark.parametrize(("distro", "value"), [("humble", "two"), ("kilted", "two"), ("lyrical", "one")])
def test_timers_keep_the_environment_of_their_place_since_lyrical(distro: str, value: str) -> None:
    timer = "TimerAction(period=2.0, actions=[Node(package='p', executable='a')])"
    file = python(f"SetEnvironmentVariable('A', 'one'), {timer}, SetEnvironmentVariable('A', 'two')")
    [node] = expand(file, {}, distro=distro).started
    assert node.environment == (("A", (value,)),)


def test_events_use_values_set_after_them() -> None:
    event = f"RegisterEventHandler(OnProcessExit(on_exit=[{LATE}, SetLaunchConfiguration('which', 'event'), {LATE}]))"
    file = python(f"GroupAction([SetLaunchConfiguration('which', 'group'), {event}]), SetLaunchConfiguration('which', 'end')")
    assert summaries(run(file)) == ["node p end", "node p event"]
    other = f"RegisterEventHandler(OnProcessExit(on_exit=[{LATE}]))"
    file = python(f"SetLaunchConfiguration('which', 'end'), {event}, {other}")
    assert summaries(run(file)) == ["node p end", "node p event", "node p end|event"], "the order of the events is unknown"


def test_the_default_of_an_argument_applies_unless_another_event_declares_it_before() -> None:
    first, second = (
        f"RegisterEventHandler(OnProcessExit(on_exit=[DeclareLaunchArgument('which', default_value='{value}'), {LATE}]))"
        for value in ("one", "two")
    )
    assert summaries(run(python(f"{first}, {second}"))) == ["node p one", "node p two|one"]


@pytest.mark.parametrize(
    "handler",
    ["TimerAction(period=2.0, actions=[{}])", "RegisterEventHandler(OnProcessExit(on_exit=[{}]))"],
    ids=["timer", "event"],
)
@pytest.mark.parametrize(
    "read", ["LaunchConfiguration('which').perform(context)", "context.launch_configurations['which']"], ids=["perform", "item"]
)
def test_a_value_that_a_function_reads_before_a_timer_or_event_is_kept(handler: str, read: str) -> None:
    node = f"Node(package='p', executable={read})"
    function = f"OpaqueFunction(function=lambda context: [{handler.format(node)}])"
    file = python(f"SetLaunchConfiguration('which', 'one'), {function}, SetLaunchConfiguration('which', 'two')")
    assert [summaries(expand(file, {}, distro=distro)) for distro in ("humble", "rolling")] == [["node p one"]] * 2


def test_a_function_needs_the_configurations_that_it_reads() -> None:
    """It fails at a configuration without value, even if it uses the value nowhere."""
    body = "[LaunchConfiguration('x').perform(context), context.perform_substitution(LaunchConfiguration('y'))] and []"
    declared = "DeclareLaunchArgument('x', default_value='1')"
    function = f"OpaqueFunction(function=lambda context: {body})"
    assert unset(run(python(f"{function}, {declared}"))) == ["x", "y"]
    assert unset(run(python(f"{declared}, {function}"))) == ["y"]
    assert unset(run(python(f"OpaqueFunction(condition=IfCondition('false'), function=lambda context: {body})"))) == []
    assert unset(run(opaque("context.launch_configurations.get('x')\nreturn []"))) == []
    caught = "try:\n    LaunchConfiguration('x').perform(context)\nexcept Exception:\n    pass\nreturn []"
    assert unset(run(opaque(caught.replace("\n", "\n")))) == []
    chosen = "if LaunchConfiguration('on').perform(context) == 'true':\n    LaunchConfiguration('x').perform(context)\nreturn []"
    assert unset(run(opaque(chosen, "DeclareLaunchArgument('on', default_value='false')"))) == []
    assert unset(run(opaque(chosen, "DeclareLaunchArgument('on', default_value='true')"))) == ["x"]


def test_actions_of_a_timer_in_an_included_file_name_the_include() -> None:
    inner = python("TimerAction(period=1.0, actions=[Node(package='p', executable='a')])", "/x/inner.launch.py")
    outer = xml('<include file="/x/inner.launch.py"/><node pkg="p" exec="b"/>')
    expansion = expand(outer, {}, {"/x/inner.launch.py": inner}.get)
    assert [
        (started.depth, started.via is not None, started.target) for started in expansion.started if started.kind == "node"
    ] == [
        (1, True, ("a",)),
        (0, False, ("b",)),
    ]


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("'/a', x, 'b'", "/a/b"),
        ("'/', x, 'b'", "/b"),
        ("x, 'b'", "b"),
        ("'a', x", "a"),
        ("'a', absolute", "/d"),
        ("'a', x, absolute, 'b'", "/d/b"),
        ("'a/', name, 'b'", "a/n/b"),
        ("['a', x], ['b', name]", "a/bn"),
        ("name, PathJoinSubstitution([x, 'b'])", "n/b"),
    ],
)
def test_paths_are_joined_with_the_values_of_arguments(path: str, value: str) -> None:
    names = {"x": "", "absolute": "/d", "name": "n"}
    declared = "".join(f"DeclareLaunchArgument('{name}', default_value='{text}')," for name, text in names.items())
    for name in names:
        path = re.sub(rf"(?<!['\w]){name}\b", f"LaunchConfiguration('{name}')", path)
    file = python(f"{declared} Node(package='p', executable=PathJoinSubstitution([{path}]))")
    assert summaries(run(file)) == [f"node p {value}"]


def unset(expansion: Expansion) -> list[str]:
    return [found.name for found in expansion.unset]


def test_configurations_without_value_are_found() -> None:
    assert unset(run(xml('<node pkg="p" exec="$(var x)"/>'))) == ["x"]
    assert unset(run(xml('<node pkg="p" exec="e" if="$(var x)"/>'))) == ["x"]
    assert unset(run(xml('<node pkg="p" exec="$(var x)" if="false"/>'))) == []
    assert unset(run(xml('<node pkg="p" exec="$(var x)" if="$(env Y)"/>'))) == []
    assert unset(run(xml('<group><let name="x" value="1"/></group><node pkg="p" exec="$(var x)"/>'))) == ["x"]
    assert unset(run(xml('<node pkg="p" exec="$(var x)"/>'), {"x": "e"})) == []
    assert unset(run(python("Node(package='p', executable=LaunchConfiguration('x', default='e'))"))) == []
    assert unset(run(python("TimerAction(period=1.0, actions=[Node(package='p', executable=LaunchConfiguration('x'))])"))) == []


def test_an_include_that_cannot_be_read_may_set_any_configuration() -> None:
    body = '<include file="/x/{}.launch.xml"/><node pkg="p" exec="$(var x)"/>'
    assert unset(run(xml(body.format("b")))) == []
    assert unset(run(xml(body.format("b")), b=xml('<let name="y" value="1"/>'))) == ["x"]
    assert unset(run(xml(body.format("b")), b=xml('<let name="x" value="1"/>'))) == []


def test_words_of_a_command_line_depend_on_their_conditions() -> None:
    text = """
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, OpaqueFunction
from launch.substitutions import EnvironmentVariable, LaunchConfiguration
from launch_ros.actions import Node


def start(context):
    words, arguments = ["run"], ["x"]
    if LaunchConfiguration("loud").perform(context) == "true":
        words.append("--loud")
        arguments.append("-v")
    if EnvironmentVariable("FAST").perform(context) == "1":
        words.append("--fast")
    return [ExecuteProcess(cmd=words), Node(package="p", executable="e", arguments=arguments)]


def generate_launch_description():
    return LaunchDescription([DeclareLaunchArgument("loud", default_value="false"), OpaqueFunction(function=start)])
"""
    file = collect("pkg/launch/a.launch.py", text)[1]
    process, node = run(file).started
    assert set(process.target) == {"run", "run --fast"}
    assert node.words == (("x",),)
    process, node = run(file, {"loud": "true"}).started
    assert set(process.target) == {"run --loud", "run --loud --fast"}
    assert node.words == (("x",), ("-v",))
