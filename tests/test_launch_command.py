"""``ros-lint launch``."""

import json
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

import pytest

from ros_lint.base.tree import MemoryTree
from ros_lint.cli import main as cli
from ros_lint.cli.commands.launch.launch import LaunchOptions, LaunchRequest, answer, parse_launch_request
from ros_lint.cli.commands.launch.lookup import LaunchFileLookup
from ros_lint.cli.session import UsageError
from ros_lint.knowledge.underlays import in_tree
from ros_lint.workspace.loader import Loader
from ros_lint.workspace.target import TargetDistro
from tests.packages import manifest_text

INSTALLS = """\
project({0})
find_package(ament_cmake REQUIRED)
install(DIRECTORY {1} DESTINATION share/{0})
install(PROGRAMS $ENV{{PROGRAMS}} DESTINATION lib/{0})
rclcpp_components_register_nodes($ENV{{LIBRARY}} $ENV{{CLASSES}})
ament_package()
"""
"""A build script that installs folders, and programs and components with unknown names."""


EVERYTHING = LaunchOptions()


def package(name: str, files: Mapping[str, str], folders: str = "launch") -> dict[str, str]:
    return {
        f"{name}/package.xml": manifest_text(name),
        f"{name}/CMakeLists.txt": INSTALLS.format(name, folders),
        **{f"{name}/{path}": content for path, content in files.items()},
    }


def xml(body: str) -> str:
    return f"<launch>\n{body}\n</launch>\n"


def ask(
    files: Mapping[str, str],
    *words: str,
    form: str = "tree",
    underlay: Mapping[str, str] | None = None,
    options: LaunchOptions = EVERYTHING,
) -> tuple[str, str, int]:
    """Return standard output, standard error and exit code of the command for a workspace in memory."""
    tree = MemoryTree(files)
    underlay_tree = MemoryTree({f"opt/{path}": content for path, content in (underlay or {}).items()})
    underlays = (in_tree(underlay_tree, "opt", "jazzy"),) if underlay else ()
    loader = Loader(tree, ("",), TargetDistro("jazzy", "--distro"), underlays=underlays)
    request = parse_launch_request(words, lambda path: path in files)
    workspace = loader.load()
    path = "" if request.package else request.file
    return answer(workspace, LaunchFileLookup(workspace, tree), request, path, options._replace(form=form))


def launch(body: str, *arguments: str) -> list[str]:
    """Return the output lines for one launch file, without its name and the summary."""
    output, err, code = ask(package("p", {"launch/a.launch.xml": xml(body)}), "p", "a.launch.xml", *arguments)
    assert (err, code) == ("", 0)
    lines = output.splitlines()
    return [line.strip() for line in lines[1 : lines.index("")]]


def test_command_line_words_are_parsed() -> None:
    arguments = {"x": "1", "y": "", "z": "a:=b"}
    assert parse_launch_request(["a.py", "x:=1", "y:=", "z:=a:=b"], lambda _: True) == LaunchRequest("", "a.py", arguments)
    assert parse_launch_request(["p", "x:=1", "a.py"], lambda _: False) == LaunchRequest("p", "a.py", {"x": "1"})


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["x:=1"], "no launch file given"),
        (["nowhere.py"], "nowhere.py: no such file"),
        (["there.py", "x=1"], "unexpected 'x=1'; launch arguments are written as name:=value"),
        (["p", "a.py", "x"], "unexpected 'x'; launch arguments are written as name:=value"),
        (["there.py", ":=1"], "argument without a name: ':=1'"),
    ],
)
def test_invalid_command_line_words_are_rejected(words: list[str], message: str) -> None:
    with pytest.raises(UsageError, match=message.replace("?", r"\?")):
        parse_launch_request(words, lambda path: path == "there.py")


def test_settings_of_a_group_apply_to_its_nodes() -> None:
    assert launch(
        '<group><push_ros_namespace namespace="left"/><set_parameter name="rate" value="5"/><set_remap from="a" to="b"/>'
        '<set_env name="X" value="1"/><node pkg="p" exec="x" name="n"><param name="own" value="2"/><env name="Y" value="3"/>'
        '<remap from="c" to="d"/></node></group><node pkg="p" exec="y"/>'
    ) == [
        "node p x as /left/n",
        "parameter rate = 5",
        "parameter own = 2",
        "remap a to b",
        "remap c to d",
        "environment X = 1",
        "environment Y = 3",
        "node p y",
    ]


def test_a_name_that_may_not_be_set_and_unknown_keywords_are_shown() -> None:
    nodes = "Node(package='p', executable='x', name='n' if unknown() else None), Node(package='p', executable='y', **unknown())"
    body = f"from launch_ros.actions import Node\ndef generate_launch_description():\n    return [{nodes}]\n"
    output, _, _ = ask(package("p", {"launch/a.launch.py": body}), "p", "a.launch.py")
    assert [line.strip() for line in output.splitlines()[1:5]] == [
        "node p x as /n | /...",
        "node p y as /?/?",
        "unknown parameters",
        "unknown remappings",
    ]


def test_settings_of_an_unscoped_group_stay_in_effect() -> None:
    assert launch('<group scoped="false"><set_env name="X" value="1"/></group><executable cmd="ls -l" cwd="/tmp"/>') == [
        "process ls -l",
        "environment X = 1",
        "cwd = /tmp",
    ]


def test_appended_environment_variables_are_shown() -> None:
    assert launch(
        '<set_env name="X" value="1"/><append_env name="X" value="2"/><append_env name="Y" value="3"/><executable cmd="ls"/>'
    ) == ["process ls", "environment X = 1:2", "environment Y = ?:3"]


def test_a_variable_set_by_the_file_is_known() -> None:
    assert launch('<set_env name="X" value="1"/><node pkg="p" exec="x$(env X)"/><node pkg="p" exec="y$(env Z 2)"/>') == [
        "node p x1",
        "environment X = 1",
        "node p y2",
        "environment X = 1",
    ]


def test_configurations_in_parameter_lists_are_replaced() -> None:
    assert launch(
        '<arg name="a" default="1"/><node pkg="p" exec="x"><param name="l" value="$(var a);x,y" value-sep=";"/></node>'
    ) == ["argument a = 1", "node p x", "parameter l = [1, 'x,y']"]


def test_unknown_conditions_are_shown() -> None:
    reason = "open because the environment variable 'SIM' is not known"
    assert launch('<node pkg="p" exec="x" if="$(env SIM)"/>') == ["node p x", "if $(env SIM)", reason]
    assert launch('<node pkg="p" exec="x" unless="$(env SIM)"/>') == ["node p x", "unless $(env SIM)", reason]


def test_the_argument_that_decides_a_condition_is_named() -> None:
    files = package("p", {"launch/a.launch.xml": xml('<arg name="sim"/><group if="$(var sim)"><node pkg="q" exec="x"/></group>')})
    output, _, _ = ask(files, "p", "a.launch.xml")
    assert output.splitlines()[2:5] == [
        "  node q x",
        "    if $(var sim)",
        "    open because the argument 'sim' has no default; sim:=VALUE decides it",
    ]
    assert "open because" not in ask(files, "p", "a.launch.xml", "sim:=true")[0]


def test_tags_of_other_packages_are_listed() -> None:
    files = package("p", {"launch/a.launch.xml": xml('<gz_server world_sdf_file="a.sdf"/>\n<log message="x"/>')})
    output, _, code = ask(files, "p", "a.launch.xml")
    assert "not analysed:\n  p/launch/a.launch.xml:2:2: what <gz_server> starts is not known\n\n" in output
    assert code == 0


def test_tags_that_packages_of_the_workspace_may_add_are_listed() -> None:
    setup = "entry_points={'launch.frontend.launch_extension': ['q = q']}"
    adding = {
        "q/package.xml": manifest_text("q", build_type="ament_python"),
        "q/setup.py": f"from setuptools import setup\nsetup(name='q', version='0.1.0', packages=['q'], {setup})\n",
        "q/q/__init__.py": "",
    }
    files = package("p", {"launch/a.launch.xml": xml('<own_tag a="b"/>\n<log message="x"/>')})
    output, _, code = ask({**files, **adding}, "p", "a.launch.xml")
    assert "not analysed:\n  p/launch/a.launch.xml:2:2: what <own_tag> starts is not known\n\n" in output
    assert code == 0
    assert ask(files, "p", "a.launch.xml")[2] == 1


def test_actions_of_unknown_classes_are_listed() -> None:
    python = """
from launch import LaunchDescription
from launch.actions import SetROSLogDir
from vendor import Driver

def generate_launch_description():
    return LaunchDescription([Driver(model="a"), SetROSLogDir("/tmp")])
"""
    output, _, _ = ask(package("p", {"launch/a.launch.py": python}), "p", "a.launch.py")
    assert "not analysed:\n  p/launch/a.launch.py:7:31: what Driver() starts is not known\n" in output


def test_needed_environment_variables_are_listed() -> None:
    body = '<node pkg="q" exec="$(env PROGRAM)"/><set_env name="SET" value="1"/><node pkg="q" exec="$(env SET)$(env OTHER x)"/>'
    output, _, _ = ask(package("p", {"launch/a.launch.xml": xml(body)}), "p", "a.launch.xml")
    assert "needed environment variables: PROGRAM\n" in output


def test_what_starts_a_later_action_is_shown() -> None:
    assert launch('<timer period="2.5"><node pkg="q" exec="x"/></timer>') == ["node q x (later: 2.5 s)"]
    python = """
from launch import LaunchDescription
from launch.actions import ExecuteProcess, RegisterEventHandler
from launch.event_handlers import OnProcessExit

def generate_launch_description():
    first = ExecuteProcess(cmd=["ls"])
    second = ExecuteProcess(cmd=["ps"])
    third = ExecuteProcess(cmd=["id"], on_exit=[second])
    return LaunchDescription([first, third, RegisterEventHandler(OnProcessExit(target_action=first, on_exit=[second]))])
"""
    output, _, _ = ask(package("p", {"launch/a.launch.py": python}), "p", "a.launch.py")
    assert output.splitlines()[1:5] == [
        "  process ls",
        "  process id",
        "  process ps (later: on_exit)",
        "  process ps (later: OnProcessExit)",
    ]


def test_logical_conditions_are_shown_as_written() -> None:
    condition = "$(and $(env SIM) $(not $(equals $(env SHAPE) 'a b')))"
    assert launch(f'<node pkg="p" exec="x" if="{condition}"/>')[:2] == ["node p x", f"if {condition}"]


def test_a_branch_with_an_unknown_condition_is_uncertain() -> None:
    python = """
from launch import LaunchDescription
from launch_ros.actions import Node
from somewhere import answer

def generate_launch_description():
    node = Node(package="p", executable="x", parameters=[answer(), answer()])
    return LaunchDescription([node] if answer() else [])
"""
    output, _, _ = ask(package("p", {"launch/a.launch.py": python}), "p", "a.launch.py")
    assert [line.strip() for line in output.splitlines()[1:5]] == [
        "node p x",
        "conditional: the condition is unknown",
        "unknown parameters",
        "? it is computed in a way that ros-lint cannot follow",
    ]


def test_components_are_shown_below_their_containers() -> None:
    load = '<load_composable_node target="NAME"><composable_node pkg="p" plugin="p::X" name="x"/></load_composable_node>'
    container = '<node_container pkg="rclcpp_components" exec="component_container" name="c" namespace="n"/>'
    once = load.replace("NAME", "/n/c") + container + '<node pkg="p" exec="last"/>'
    body = ["container as /n/c", "  component p p::X as /x", "node p last"]
    for text, expected in ((once, body), (once + container, ["component p p::X as /x", "  in container /n/c"])):
        output, _, _ = ask(package("p", {"launch/a.launch.xml": xml(text)}), "p", "a.launch.xml")
        lines = [line[2:].replace("node rclcpp_components component_", "") for line in output.splitlines()[1:]]
        assert [line for line in lines if "error" not in line][: len(expected)] == expected


def test_components_are_shown_with_their_containers() -> None:
    assert launch(
        '<node_container pkg="rclcpp_components" exec="component_container" name="c" namespace="n">'
        '<composable_node pkg="p" plugin="p::A" name="a"/></node_container>'
        '<load_composable_node target="other"><composable_node pkg="p" plugin="p::B" name="b"/></load_composable_node>'
        '<node_container pkg="rclcpp_components" exec="component_container" name="d" namespace="/">'
        '<composable_node pkg="p" plugin="p::C" name="c"/></node_container>'
    ) == [
        "node rclcpp_components component_container as /n/c",
        "component p p::A as /a",
        "component p p::B as /b",
        "in container /other",
        "node rclcpp_components component_container as /d",
        "component p p::C as /c",
    ]


def test_reasons_of_unknown_values_are_shown() -> None:
    body = xml('<node pkg="p" exec="$(env WHICH)"/><node pkg="p" exec="$(var unset)"/>')
    output, _, code = ask(package("p", {"launch/a.launch.xml": body}), "p", "a.launch.xml")
    lines = [line.strip() for line in output.partition("\n\n")[0].splitlines()[1:]]
    assert code == 1
    assert lines == [
        "node p ?",
        "? the environment variable 'WHICH' is not known",
        "node p ?",
        "? the launch configuration 'unset' is not set",
    ]


INNER = xml(
    '<arg name="robot"/><arg name="mode" default="a"><choice value="a"/><choice value="b"/></arg><node pkg="p" exec="x"/>'
)


def included(body: str, *arguments: str) -> tuple[str, str, int]:
    outer = xml(f'<include file="$(find-pkg-share p)/launch/inner.launch.xml">{body}</include>')
    files = package("p", {"launch/a.launch.xml": outer, "launch/inner.launch.xml": INNER})
    return ask(files, "p/launch/a.launch.xml", *arguments)


def test_an_include_is_expanded() -> None:
    output, err, code = included('<arg name="robot" value="r"/>')
    assert (err, code) == ("", 0)
    assert output.splitlines() == [
        "p/launch/a.launch.xml",
        "  include $(find-pkg-share p)/launch/inner.launch.xml",
        "    argument robot = r",
        "    node p x",
        "",
        "1 node, 1 include for jazzy (--distro)",
    ]


def test_an_include_without_a_required_argument_is_reported() -> None:
    _, err, code = included("")
    assert (err, code) == (
        "ros-lint: p/launch/a.launch.xml:2:2: the argument 'robot' is not passed here and has no default at "
        "p/launch/inner.launch.xml:2:2\n",
        1,
    )
    assert included("", "robot:=r")[1:] == ("", 0)


def test_a_value_that_is_not_a_choice_is_reported() -> None:
    _, err, code = included('<arg name="robot" value="r"/><arg name="mode" value="c"/>')
    refused = "'c' is not a valid choice for the argument 'mode'; use one of a, b"
    assert (err, code) == (f"ros-lint: p/launch/inner.launch.xml:2:21: {refused}\n", 1)
    assert included('<arg name="robot" value="r"/><arg name="mode" value="b"/>')[1:] == ("", 0)


def test_a_missing_required_argument_is_reported() -> None:
    files = package("p", {"launch/a.launch.xml": INNER})
    _, err, code = ask(files, "p", "a.launch.xml")
    assert (err, code) == ("ros-lint: p/launch/a.launch.xml:2:2: the argument 'robot' has no default; pass robot:=VALUE\n", 1)
    assert ask(files, "p", "a.launch.xml", "robot:=r")[1:] == ("", 0)


def test_an_undeclared_argument_is_rejected() -> None:
    files = package("p", {"launch/a.launch.xml": INNER})
    with pytest.raises(UsageError, match=r"a.launch.xml has no argument 'robt'; did you mean '?robot'?\?"):
        ask(files, "p", "a.launch.xml", "robt:=r")
    with pytest.raises(UsageError, match=r"has no argument 'colour'; available: robot, mode"):
        ask(files, "p", "a.launch.xml", "colour:=r", "robot:=r")


def test_an_undeclared_argument_is_accepted_if_an_unread_file_may_declare_it() -> None:
    body = '<include file="$(find-pkg-share nav2_bringup)/launch/bringup_launch.py"/>'
    _, err, code = ask(package("p", {"launch/a.launch.xml": xml(body)}), "p", "a.launch.xml", "map:=m")
    assert (err, code) == ("ros-lint: no launch file that can be read uses the argument 'map'; it declares none\n", 0)


def test_an_argument_that_is_read_but_not_declared_is_accepted() -> None:
    assert launch('<node pkg="p" exec="$(var which)"/>', "which:=w") == ["node p w"]


def test_cyclic_includes_are_reported() -> None:
    a = xml('<include file="$(dirname)/b.launch.xml"/>')
    b = xml('<include file="$(find-pkg-share p)/launch/a.launch.xml"/>')
    files = package("p", {"launch/a.launch.xml": a, "launch/b.launch.xml": b})
    _, err, code = ask(files, "p", "a.launch.xml")
    assert (err, code) == (
        "ros-lint: p/launch/b.launch.xml:2:2: this include leads back to p/launch/a.launch.xml, so launching never ends\n",
        1,
    )


def test_a_recursive_include_with_an_end_condition_is_expanded() -> None:
    body = (
        '<arg name="n" default="2"/><node pkg="p" exec="x$(var n)"/>'
        '<include file="$(dirname)/a.launch.xml" if="$(eval \'$(var n) > 0\')">'
        '<arg name="n" value="$(eval \'$(var n) - 1\')"/></include>'
    )
    output, err, code = ask(package("p", {"launch/a.launch.xml": xml(body)}), "p", "a.launch.xml")
    assert (err, code) == ("", 0)
    assert [line.split()[-1] for line in output.splitlines() if "node" in line and "include" not in line] == ["x2", "x1", "x0"]


def test_a_configuration_without_value_is_reported() -> None:
    files = package("p", {"launch/a.launch.xml": xml('<node pkg="q" exec="$(var x)"/>')})
    message = "the launch configuration 'x' is not set here; pass x:=VALUE, or declare it"
    assert ask(files, "p", "a.launch.xml")[1:] == (f"ros-lint: p/launch/a.launch.xml:2:2: {message}\n", 1)
    assert ask(files, "p", "a.launch.xml", "x:=y")[1:] == ("", 0)


def test_a_computed_include_sets_nothing_before_it() -> None:
    include, node = '<include file="$(var b)"/>', '<node pkg="q" exec="$(var x)"/>'
    for body, expected in ((node + include, {"b", "x"}), (include + node, {"b"})):
        _, err, _ = ask(package("p", {"launch/a.launch.xml": xml(body)}), "p", "a.launch.xml")
        assert set(re.findall(r"configuration '(\w+)' is not set", err)) == expected


def test_a_substitution_in_an_f_string_does_not_fail_the_launch() -> None:
    main = (
        "from launch import LaunchDescription\nfrom launch.substitutions import LaunchConfiguration\n"
        "from launch_ros.actions import Node\n\ndef generate_launch_description():\n"
        "    return LaunchDescription([Node(package='q', executable='e', name=f\"{LaunchConfiguration('x')}_n\")])\n"
    )
    assert ask(package("p", {"launch/a.launch.py": main}), "p", "a.launch.py")[1:] == ("", 0)


def test_a_rejected_file_is_reported() -> None:
    files = package("p", {"launch/a.launch.xml": xml('<nod pkg="p" exec="x"/>')})
    _, err, code = ask(files, "p", "a.launch.xml")
    assert (err, code) == ("ros-lint: p/launch/a.launch.xml:2:2: there is no tag <nod>\n", 1)


def test_a_missing_included_file_is_reported() -> None:
    files = package("p", {"launch/a.launch.xml": xml('<include file="$(find-pkg-share p)/launch/b.launch.xml"/>')})
    output, err, code = ask(files, "p", "a.launch.xml")
    assert "not followed: 'p' does not install 'launch/b.launch.xml'" in output
    assert code == 1
    assert err.endswith("$(find-pkg-share p)/launch/b.launch.xml: 'p' does not install 'launch/b.launch.xml'\n")


def test_includes_of_an_underlay_are_expanded() -> None:
    underlay = {
        "share/ament_index/resource_index/packages/below": "",
        "share/below/package.xml": manifest_text("below"),
        "share/below/launch/b.launch.xml": xml('<node pkg="below" exec="x"/>'),
    }
    files = package("p", {"launch/a.launch.xml": xml('<include file="$(find-pkg-share below)/launch/b.launch.xml"/>')})
    output, err, code = ask(files, "p", "a.launch.xml", underlay=underlay)
    assert (err, code) == ("", 0)
    assert "    node below x" in output.splitlines()
    output, _, code = ask(files, "below", "b.launch.xml", underlay=underlay)
    assert (output.splitlines()[0], output.splitlines()[1], code) == ("opt/share/below/launch/b.launch.xml", "  node below x", 0)


def test_an_include_of_a_released_package_is_not_expanded() -> None:
    body = '<include file="$(find-pkg-share nav2_bringup)/launch/bringup_launch.py"/>'
    output, err, code = ask(package("p", {"launch/a.launch.xml": xml(body)}), "p", "a.launch.xml")
    assert (err, code) == ("", 0)
    assert "not followed: 'nav2_bringup' is neither in the workspace nor in an underlay" in output


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("q", "a.launch.xml"), "there is no package 'q'"),
        (("p", "c.launch.xml"), r"'p' does not install a launch file 'c.launch.xml'; did you mean '?a.launch.xml'?\?"),
        (("p", "forgotten.launch.xml"), r"'p' has other/forgotten.launch.xml, but does not install it"),
        (("p", "twice.launch.xml"), r"'p' installs several files 'twice.launch.xml', .*: launch/twice.launch.xml, more/twice"),
        (("nav2_bringup", "bringup_launch.py"), "'nav2_bringup' is neither in the workspace nor in an underlay"),
        (("p/package.xml",), "p/package.xml: not a ROS 2 launch file"),
        (("p/launch/helper.py",), r"p/launch/helper.py: not a launch file: it has no generate_launch_description\(\)"),
    ],
)
def test_an_unknown_launch_file_is_rejected(words: tuple[str, ...], message: str) -> None:
    files = package(
        "p",
        {
            "launch/a.launch.xml": xml(""),
            "launch/twice.launch.xml": xml(""),
            "more/twice.launch.xml": xml(""),
            "other/forgotten.launch.xml": xml(""),
            "launch/helper.py": "from launch_ros.actions import Node\ndef make():\n    return Node(package='p')\n",
        },
        "launch more",
    )
    with pytest.raises(UsageError, match=message):
        ask(files, *words)


def test_json_contains_the_same_as_the_tree() -> None:
    inner = xml('<node pkg="p" exec="x" if="$(env SIM)"/>')
    include = '<include file="$(dirname)/inner.launch.xml"/>'
    outer = xml(f'<arg name="v" default="1"/>{include}<node pkg="p" exec="y$(var v)" name="n"/>')
    files = package("p", {"launch/a.launch.xml": outer, "launch/inner.launch.xml": inner})
    output, _, code = ask(files, "p", "a.launch.xml", "v:=2", form="json")
    document = json.loads(output)
    assert (code, document["schema_version"], document["file"]) == (0, 1, "p/launch/a.launch.xml")
    assert [(item["name"], item["values"], item["given"]) for item in document["arguments"]] == [("v", ["2"], True)]
    nested, node = document["starts"]
    assert (nested["kind"], nested["follows"]) == ("include", "p/launch/inner.launch.xml")
    assert [(item["target"], item["certain"], item["when"]) for item in nested["starts"]] == [(["x"], False, ["if $(env SIM)"])]
    assert (node["target"], node["name"], node["namespace"], node["line"]) == (["y2"], ["n"], ["/"], 2)


BROKEN = {
    "p/package.xml": manifest_text("p"),
    "p/CMakeLists.txt": (
        "project(p)\nfind_package(ament_cmake REQUIRED)\nadd_executable(driver_node a.cpp)\n"
        "install(TARGETS driver_node DESTINATION lib/p)\ninstall(DIRECTORY launch DESTINATION share/p)\nament_package()\n"
    ),
    "p/a.cpp": "",
    "p/launch/a.launch.xml": xml(
        '<arg name="sim" default="false" description="Use the simulator."><choice value="true"/><choice value="false"/></arg>'
        '<arg name="host"/>'
        '<include file="$(dirname)/b.launch.xml"/><node pkg="p" exec="driver" name="d" namespace="arm"/>'
    ),
    "p/launch/b.launch.xml": xml('<arg name="rate" default="1"/><node pkg="p" exec="driver_node"/>'),
}


def test_missing_programs_are_marked_and_fail_the_launch() -> None:
    message = "'p' does not install an executable 'driver'; did you mean 'driver_node'?"
    output, err, code = ask(BROKEN, "p", "a.launch.xml", "host:=h")
    assert code == 1
    assert err == f"ros-lint: p/launch/a.launch.xml:2:177: {message}\n"
    lines = [line.strip() for line in output.splitlines()]
    assert lines[lines.index("node p driver as /arm/d") + 1] == f"error: {message}"
    assert output.count("error: ") == 1
    document = json.loads(ask(BROKEN, "p", "a.launch.xml", "host:=h", form="json")[0])
    assert [item["problems"] for item in document["starts"]] == [[], [message]]
    assert "  style n3 stroke:red" in ask(BROKEN, "p", "a.launch.xml", "host:=h", form="mermaid")[0].splitlines()


def test_a_program_that_is_started_under_an_unknown_condition_does_not_fail_the_launch() -> None:
    files = {**BROKEN, "p/launch/a.launch.xml": xml('<node pkg="p" exec="driver" if="$(env SIM)"/>')}
    assert ask(files, "p", "a.launch.xml")[1:] == ("", 0)


def test_arguments_are_shown_with_descriptions_and_choices() -> None:
    output, _, _ = ask(BROKEN, "p", "a.launch.xml", "sim:=true", options=LaunchOptions(show_args=True))
    assert output.splitlines() == [
        "'sim':",
        "    Use the simulator.",
        "    one of: true, false",
        "    (given: true)",
        "'host':",
        "    (required)",
        "'rate' (of an included file):",
        "    (default: 1)",
    ]
    empty = package("p", {"launch/a.launch.xml": xml("")})
    assert ask(empty, "p", "a.launch.xml", options=LaunchOptions(show_args=True))[0] == "The launch file has no arguments.\n"


@pytest.mark.parametrize(
    ("options", "shown"),
    [
        (LaunchOptions(depth=0), ["include", "node p driver as /arm/d"]),
        (LaunchOptions(depth=1), ["include", "node p driver_node", "node p driver as /arm/d"]),
        (LaunchOptions(node="d"), ["node p driver as /arm/d"]),
        (LaunchOptions(node="/arm/d"), ["node p driver as /arm/d"]),
        (LaunchOptions(node="driver_node"), ["include", "node p driver_node"]),
        (LaunchOptions(node="driver_node", depth=0), []),
    ],
)
def test_actions_are_selected_by_depth_and_by_name(options: LaunchOptions, shown: Sequence[str]) -> None:
    output, _, _ = ask(BROKEN, "p", "a.launch.xml", "host:=h", options=options)
    lines = [line.strip() for line in output.splitlines()[:-2]]
    assert [line.partition(" $")[0] for line in lines if line.startswith(("node", "include"))] == shown


def test_the_launch_files_of_a_package_are_listed() -> None:
    output, err, code = ask(BROKEN, "p")
    assert (err, code) == ("", 0)
    assert output == "a.launch.xml  p/launch/a.launch.xml\nb.launch.xml  p/launch/b.launch.xml\n"
    with pytest.raises(UsageError, match="^nothing: no such file, and there is no package 'nothing'"):
        ask(BROKEN, "nothing")
    with pytest.raises(UsageError, match="^'q' installs no launch file$"):
        ask({"q/package.xml": manifest_text("q")}, "q")
    files = {"share/r/package.xml": manifest_text("r"), "share/r/launch/x.launch.py": "", "share/r/config/x.yaml": ""}
    underlay = {"share/ament_index/resource_index/packages/r": "", **files}
    assert ask(BROKEN, "r", underlay=underlay)[0] == "x.launch.py  launch/x.launch.py\n"


def test_mermaid_contains_every_file_and_node() -> None:
    inner = xml('<node pkg="p" exec="x" if="$(env SIM)"/>')
    files = package(
        "p", {"launch/a.launch.xml": xml('<include file="$(dirname)/inner.launch.xml"/>'), "launch/inner.launch.xml": inner}
    )
    output, _, _ = ask(files, "p", "a.launch.xml", form="mermaid")
    assert output.splitlines() == [
        "flowchart LR",
        '  n0["a.launch.xml"]',
        '  n1["inner.launch.xml"]',
        "  n0 --> n1",
        '  n2("p x")',
        '  n1 -.->|"if #36;#40;env SIM#41;"| n2',
    ]


def test_the_command_runs_from_the_command_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    for path, content in package("p", {"launch/a.launch.xml": INNER}).items():
        place = tmp_path / "src" / path
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(content, "utf-8")
    (tmp_path / ".git").mkdir()
    monkeypatch.chdir(tmp_path / "src" / "p")
    common = ["--distro", "jazzy", "--no-cache", "--isolated"]
    assert cli.main(["launch", "launch/a.launch.xml", "robot:=r", *common]) == 0
    by_file = capsys.readouterr().out
    assert by_file.splitlines()[0] == "src/p/launch/a.launch.xml"
    assert cli.main(["launch", "p", "a.launch.xml", "robot:=r", "-C", str(tmp_path), *common]) == 0
    assert capsys.readouterr().out == by_file
    assert cli.main(["launch", "launch/a.launch.xml", *common]) == 1
    assert "pass robot:=VALUE" in capsys.readouterr().err
    assert cli.main(["launch", "p", "b.launch.xml", *common]) == 2
    assert "did you mean 'a.launch.xml'?" in capsys.readouterr().err


def test_a_raised_exception_ends_the_launch_only_under_its_conditions() -> None:
    text = """
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.conditions import IfCondition
from launch.substitutions import EnvironmentVariable, LaunchConfiguration


def validate(context):
    if LaunchConfiguration("front").perform(context) == "false" and LaunchConfiguration("rear").perform(context) == "false":
        raise RuntimeError("there is no camera")
    if EnvironmentVariable("CAMERA").perform(context) == "none":
        raise RuntimeError("may not happen")
    try:
        raise OSError("caught")
    except OSError:
        pass


def never(context):
    raise RuntimeError("never called")


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("front", default_value="false"),
        DeclareLaunchArgument("rear", default_value="false"),
        OpaqueFunction(function=validate),
        OpaqueFunction(function=never, condition=IfCondition(LaunchConfiguration("rear"))),
    ])
"""
    files = package("p", {"launch/a.launch.py": text})
    _, err, code = ask(files, "p", "a.launch.py")
    message = "the launch file raises an exception here"
    assert (err, code) == (f"ros-lint: p/launch/a.launch.py:10:9: {message}: there is no camera\n", 1)
    _, err, code = ask(files, "p", "a.launch.py", "front:=true")
    assert (err, code) == ("", 0)
    _, err, code = ask(files, "p", "a.launch.py", "rear:=true")
    assert (err, code) == (f"ros-lint: p/launch/a.launch.py:20:5: {message}: never called\n", 1)


READS_FILES = """
import os
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import OpaqueFunction
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterFile
from nav2_common.launch import ReplaceString


def read(name):
    with open(os.path.join(get_package_share_directory("p"), name)) as file:
        return file.read()


def tolerant(context):
    try:
        return [read("launch/caught.txt")] and []
    except OSError:
        return []


def generate_launch_description():
    text = read("launch/FILE")
    parameters = [ParameterFile(os.path.join(get_package_share_directory("p"), "launch", "SUBST"), allow_substs=True)]
    view = ReplaceString(os.path.join(get_package_share_directory("p"), "launch", "VIEW"), {"a": "b"})
    return LaunchDescription([
        OpaqueFunction(function=lambda context: [read("launch/LATER")] and []),
        OpaqueFunction(function=tolerant),
        Node(package="p", executable="launch", parameters=parameters, arguments=["-d", view]),
    ])
"""


@pytest.mark.parametrize("missing", ["", "FILE", "LATER", "SUBST", "VIEW"])
def test_files_that_the_launch_file_opens_have_to_exist(missing: str) -> None:
    text = READS_FILES.replace(missing, "missing") if missing else READS_FILES
    files = package("p", {"launch/a.launch.py": text, **{f"launch/{name}": "" for name in ("FILE", "LATER", "SUBST", "VIEW")}})
    _, err, code = ask(files, "p", "a.launch.py")
    expected = "launch/missing: 'p' does not install 'launch/missing'"
    assert (expected in err, code) == ((True, 1) if missing else (False, 0))


def test_a_parameter_file_for_all_nodes_is_rewritten() -> None:
    text = """
import os
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch_ros.actions import Node, SetParametersFromFile
from nav2_common.launch import RewrittenYaml

def generate_launch_description():
    path = os.path.join(get_package_share_directory("p"), "launch", "FILE")
    rewritten = RewrittenYaml(source_file=path, param_rewrites={"rate": "7"}, convert_types=True)
    return LaunchDescription([SetParametersFromFile(rewritten), Node(package="p", executable="launch", name="n")])
"""
    parameters = "n:\n  ros__parameters: {rate: 5, count: 1}\n"
    files = package("p", {"launch/a.launch.py": text.replace("FILE", "a.yaml"), "launch/a.yaml": parameters})
    output, err, code = ask(files, "p", "a.launch.py", options=EVERYTHING._replace(node="n"))
    assert [line.split("  (")[0].strip() for line in output.splitlines() if " = " in line] == ["count = 1", "rate = 7"]
    assert (err, code) == ("", 0)
    _, err, code = ask({**files, "p/launch/a.launch.py": text.replace("FILE", "b.yaml")}, "p", "a.launch.py")
    assert ("'p' does not install 'launch/b.yaml'" in err, code) == (True, 1)


def test_substitutions_in_a_parameter_file_need_their_configurations() -> None:
    parameters = "# $(var in_comment)\n/**:\n  ros__parameters:\n    a: $(var in_value)\n"
    body = '<node pkg="p" exec="launch"><param from="$(find-pkg-share p)/launch/a.yaml" allow_substs="SUBST"/></node>'
    for substitutes, names in (("true", ["in_comment", "in_value"]), ("false", [])):
        files = package("p", {"launch/a.launch.xml": xml(body.replace("SUBST", substitutes)), "launch/a.yaml": parameters})
        _, err, _ = ask(files, "p", "a.launch.xml")
        assert re.findall(r"configuration '(\w+)' is not set", err) == names
