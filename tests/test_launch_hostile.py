"""Launch files that try to hang, to fill the memory or to run code: read in time, reported as opaque, never run."""

from __future__ import annotations

import resource
import time
from pathlib import Path

import pytest

from ros_lint.analysis.launch.includes import include_resolver
from ros_lint.base.text import Text
from ros_lint.cli.session import open_workspace
from ros_lint.collectors.launch import detect as launch
from ros_lint.collectors.launch.collect import collect
from ros_lint.collectors.launch.expand import expand
from ros_lint.engine.registry import load
from ros_lint.facts.launch import LaunchFile
from tests.one_package import loaded

pytestmark = pytest.mark.slow

SECONDS = 2.0
KILOBYTES = 100 << 10

HEAD = """
from launch import LaunchDescription
from launch.actions import *
from launch.conditions import *
from launch.substitutions import *
from launch_ros.actions import Node
"""
NODE = "    return LaunchDescription([Node(package='a', executable='b')])\n"


def _program(body: str, prologue: str = "", result: str = NODE) -> str:
    inner = "".join(f"    {line}\n" for line in body.splitlines())
    return f"{HEAD}{prologue}\ndef generate_launch_description():\n{inner}{result}"


MANIFEST = """<package format="3"><name>a</name><version>0.1.0</version><description>d</description>
<maintainer email="a@b.org">A</maintainer><license>MIT</license><export><build_type>ament_cmake</build_type></export></package>
"""
BUILD = "project(a)\nfind_package(ament_cmake REQUIRED)\ninstall(DIRECTORY launch DESTINATION share/a)\nament_package()\n"
DOUBLE = "for i in range(60):\n    x = "
OPEN = {
    "endless loop": _program("while True:\n    pass"),
    "recursion": _program("f(1)\nreturn f(1)", "def f(x):\n    return [f(x + 1), f(x + 2), f(x)]\n"),
    "functions that call each other": _program("return f()", "def f():\n    g(); g()\n\ndef g():\n    f(); f()\n"),
    "exponential comprehension": _program(
        "x = range(1000)\nreturn [Node(package=str(a), executable=str(b)) for a in x for b in x for c in x]"
    ),
    "generator without end": _program("x = list(g())", "def g():\n    yield 1\n    yield from g()\n    yield from g()\n"),
    "lists that double": _program(f"x = [Node(package='a', executable='b')]\n{DOUBLE}[x, x]\nreturn LaunchDescription(x)"),
    "descriptions that double": _program(f"x = Node(package='a', executable='b')\n{DOUBLE}LaunchDescription([x, x])\nreturn x"),
    "functions that launch themselves": _program(
        "return LaunchDescription([OpaqueFunction(function=f)])",
        "def f(context):\n    return [OpaqueFunction(function=f), OpaqueFunction(function=f)]\n",
    ),
    "a description that grows while it is visited": _program(
        "d = LaunchDescription()\nd.add_action(OpaqueFunction(function=f, args=[d]))\nreturn d",
        "def f(context, d):\n    d.add_action(OpaqueFunction(function=f, args=[d]))\n"
        "    d.add_action(OpaqueFunction(function=f, args=[d]))\n",
    ),
    "nested loops": _program("\n".join(f"{'  ' * i}for x{i} in range(100):" for i in range(15)) + f"\n{'  ' * 15}pass"),
    "too long": HEAD + "x = 1\n" * 100_000 + "def generate_launch_description():\n" + NODE,
    "nested calls": _program("x = " + "str(" * 5_000 + "1" + ")" * 5_000),
    "chained calls": _program("x = a" + ".b()" * 5_000),
    "nested lists": _program("x = " + "[" * 5_000 + "]" * 5_000),
    "long sum": _program("x = " + " + ".join(["'a'"] * 20_000)),
}
BOUNDED = {
    "huge ranges": _program("x = list(range(10 ** 12))\ny = 5 in range(10 ** 12)\nz = sorted(range(10 ** 9))"),
    "copies that double": _program("import copy\nx = [1]\nfor i in range(60):\n    x = [x, copy.deepcopy(x)]"),
    "an argument that is sought among many": _program(
        "x = LaunchConfiguration('a').perform(None)\ny = [str(i) for i in range(4000)]\n"
        "for i in range(1900):\n    if x in y:\n        z = 1"
    ),
    "keywords in plenty": _program(
        "for i in range(1900):\n    for j in range(50):\n        f(**d)",
        "d = {str(i): i for i in range(4000)}\ndef f(**k):\n    return dict(**k)\n",
    ),
    "what is sought among many": _program(
        "y = [str(i) for i in range(4000)]\nfor i in range(1000):\n    for j in range(50):\n        z = 'q' in y"
    ),
    "an argument that chooses among many": _program(
        "x = LaunchConfiguration('a').perform(None)\nd = {str(i): str(i) for i in range(4000)}\ne = {'a': 'b', 'b': 'a'}\n"
        "for i in range(1900):\n    y = d[x]\n    z = d.get(x)\n    x = e.get(x, x)"
    ),
    "an argument that changes its letters again and again": _program(
        "x = LaunchConfiguration('a').perform(None)\nfor i in range(1900):\n    x = x.lower() + x.upper()\n"
        "return LaunchDescription([Node(package='a', executable=x)])"
    ),
    "lists that are summed": _program("x = [1]\nfor i in range(60):\n    x = sum([x, x], [])"),
    "helpers of released packages": _program(
        "d = LaunchDescription()\nfor i in range(1900):\n    add_debuggable_node(d, package='a', executable='b', arguments=[d])\n"
        "return d",
        "from moveit_configs_utils.launch_utils import *\n",
    ),
    "huge powers": _program("x = 10 ** 10 ** 10\ny = 1 << (1 << 40)\nfor i in range(60):\n    x = x * x"),
    "huge texts": _program("x = 'a' * 10 ** 12\ny = 'a'.ljust(10 ** 11)\nz = f'{1:1000000000}'\nw = '%1000000000d' % 1"),
    "texts that double": _program(f"x = 'ab'\n{DOUBLE}f'{{x}}{{x}}'"),
    "lists that are compared": _program("x = [1]\ny = [1]\nfor i in range(60):\n    x = [x, x]\n    y = [y, y]\nz = x == y"),
    "paths that double": _program(
        f"x = LaunchConfiguration('a')\n{DOUBLE}PathJoinSubstitution([x, x])\n"
        "return LaunchDescription([Node(package='a', executable=x, parameters=[x], condition=IfCondition(x))])"
    ),
    "defaults that double": _program(
        "d = [DeclareLaunchArgument(f'x{i}', default_value=[LaunchConfiguration(f'x{i + 1}')] * 2) for i in range(40)]\n"
        "return LaunchDescription([*d, Node(package='a', executable=LaunchConfiguration('x0'))])"
    ),
    "huge expressions": _program(
        "return LaunchDescription([Node(package='a', executable=PythonExpression(x)) "
        "for x in ('10 ** 10 ** 10', \"'a' * 10 ** 12\", '[x for x in range(10 ** 12)]')])"
    ),
    "classes in diamonds": _program(
        "D39().missing", "class D0: pass\n" + "".join(f"class D{i}(D{i - 1}, D{i - 1}): pass\n" for i in range(1, 40))
    ),
    "parameters in themselves": _program(
        "a = []; d = {'a': a}; a.append(a); n = Node(package='a', executable='b', parameters=[d, a], arguments=a)\n"
        "a.append(n); a.append(GroupAction(a)); a += a\nreturn LaunchDescription(a)"
    ),
    "expressions that are wide": _program(
        "return LaunchDescription([Node(package='a', executable=PythonExpression(x)) for x in (\"'%2000000000d' % 1\", "
        '"\'a\' * 10000000000", "[0] * 9999 * 9999", "str([[\'a\' * 9000] * 9000] * 90)", "\'%*d\' % (10 ** 9, 1)")])'
    ),
    "texts that grow": _program(
        "return LaunchDescription([Node(package='a', executable=x) for x in "
        f"('a'.zfill(3000000000), '{'a' * 9000}'.replace('a', '{'b' * 90_000}'))])"
    ),
    "a list in itself": _program("x = []\nx.append(x)\nreturn LaunchDescription([Node(package='a', executable=x)])"),
    "branches": _program("x = ''\n" + "".join(f"if u({i}):\n    x += '{i}'\n" for i in range(60))),
    "an expression that backtracks": _program("import re\nx = re.match('(a+)+$', 'a' * 50 + 'b')"),
}


def _read(program: str, language: launch.Language = "python", path: str = "a.launch.py") -> LaunchFile:
    prologue = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    start = time.process_time()
    result = collect(Text(path, program), language)
    assert time.process_time() - start < SECONDS
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - prologue < KILOBYTES
    return result


@pytest.mark.parametrize("name", OPEN)
def test_programs_that_exceed_a_limit_are_opaque(name: str) -> None:
    assert _read(OPEN[name]).opaque


@pytest.mark.parametrize("name", BOUNDED)
def test_huge_values_are_limited(name: str) -> None:
    _read(BOUNDED[name])


@pytest.mark.parametrize(
    ("language", "program"),
    [
        (
            "xml",
            "<launch>"
            + "".join(f"<let name='a' value='$(var a)b{i}' if='$(var u 1)'/>" for i in range(1_000))
            + "".join(f"<node pkg='$(var a)' exec='$(var a){i}' name='$(var a)'/>" for i in range(250))
            + "</launch>",
        ),
        ("yaml", "launch:\n- " + "[" * 20_000 + "]" * 20_000),
    ],
)
def test_check_of_hostile_files_ends_in_time(language: str, program: str) -> None:
    tree = {"a/package.xml": MANIFEST, "a/CMakeLists.txt": BUILD, f"a/launch/a.launch.{language}": program}
    start = time.process_time()
    workspace = loaded(tree)
    for rule in load():
        for package in workspace.packages:
            list(rule.package(package, workspace) if rule.package else ())
        list(rule.workspace(workspace) if rule.workspace else ())
    assert time.process_time() - start < SECONDS


def test_doubling_xml_values_are_limited() -> None:
    arguments = "".join(f'<arg name="x{i}" default="$(var x{i + 1})$(var x{i + 1})"/>' for i in range(40))
    file = _read(f'<launch>{arguments}<node pkg="a" exec="$(var x0)"/></launch>', "xml", "a.launch.xml")
    assert [(reference.kind, reference.package) for reference in file.references] == [("package", "a")]


def test_doubling_yaml_aliases_are_rejected() -> None:
    lists = "".join(f"- group: &x{i} [*x{i - 1}, *x{i - 1}]\n" for i in range(1, 40))
    file = _read(f"launch:\n- group: &x0 [log: {{message: a}}]\n{lists}", "yaml", "a.launch.yaml")
    assert file.problems or file.opaque


def test_doubling_includes_are_limited() -> None:
    """Each file includes the next one twice."""

    def file(number: int) -> LaunchFile:
        include = f'<include file="$(find-pkg-share a)/{number + 1}.launch.xml"/>'
        return collect(Text(f"{number}.launch.xml", f"<launch>{include * 2}</launch>"), "xml")

    files = [file(number) for number in range(40)]
    start = time.process_time()
    result = expand(files[0], {}, lambda path: files[int(path.rpartition("/")[2].partition(".")[0])])
    assert time.process_time() - start < SECONDS
    assert not result.complete


def test_paths_of_many_parts_behind_long_words_are_joined_in_time() -> None:
    parts = f"['{'x' * 8_000} y', *[LaunchConfiguration('a')] * 300]"
    body = (
        "return LaunchDescription([DeclareLaunchArgument('a', default_value='b'), "
        f"Node(package='p', executable=PathJoinSubstitution({parts}))])"
    )
    file = _read(_program(body))
    start = time.process_time()
    (started,) = expand(file, {}, lambda path: None).started
    assert time.process_time() - start < SECONDS
    assert started.target == ("x" * 8_000 + " y" + "/b" * 300,)


TRAP = """
import os, pathlib, subprocess, sys
def spring():
    pathlib.Path({path!r}).write_text('sprung')
    open({path!r}, 'w').write('sprung')
    os.system('touch {path}')
    subprocess.run(['touch', {path!r}])
    exec("open({path!r}, 'w')")
    __import__('os').mknod({path!r})
class Trap:
    spring()
    def __init__(self): spring()
    def __getattr__(self, name): spring()
    def __str__(self): return spring()
    def __del__(self): spring()
spring()
trap = Trap()
x = f'{{trap}}{{spring()}}'
sys.path.insert(0, os.path.dirname(__file__))
import sibling
"""


def test_nothing_of_the_workspace_is_imported_or_run(tmp_path: Path) -> None:
    package, sprung = tmp_path / "ws" / "trap", str(tmp_path / "sprung")
    trap = TRAP.format(path=sprung)
    files = {
        "package.xml": '<package format="3"><name>trap</name><version>0.0.1</version><description>d</description>'
        '<maintainer email="a@b.cd">m</maintainer><license>MIT</license><exec_depend>launch</exec_depend>'
        "<export><build_type>ament_python</build_type></export></package>",
        "setup.py": f"{trap}\nfrom setuptools import setup\nsetup(name='trap', packages=['trap'], cmdclass={{'a': spring()}})",
        "conftest.py": trap,
        "trap/__init__.py": trap,
        "trap/helper.py": f"{trap}\nfrom launch_ros.actions import Node\ndef node(): return Node(package='a', executable='b')",
        "launch/sibling.py": trap,
        "launch/a.launch.py": f"{trap}\nfrom trap.helper import node\nfrom launch import LaunchDescription\n"
        "from launch.actions import OpaqueFunction\nfrom launch.substitutions import PythonExpression, Command\n"
        "def setup(context): spring(); return [node(), trap]\n"
        "def generate_launch_description():\n"
        f"    spring()\n    return LaunchDescription([node(), OpaqueFunction(function=setup), Command('touch {sprung}'),\n"
        f"        PythonExpression(\"__import__('os').system('touch {sprung}')\")])\n",
        "launch/b.launch.xml": f'<launch><arg name="a" default="$(command \'touch {sprung}\')"/>'
        f'<let name="b" value="$(eval \'__import__(&quot;os&quot;).system(&quot;touch {sprung}&quot;)\')"/>'
        f'<executable cmd="touch {sprung}"/></launch>',
        "config/a.yaml": f"!!python/object/apply:os.system ['touch {sprung}']",
    }
    for name, text in files.items():
        path = package / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    opened = open_workspace({"paths": [str(tmp_path / "ws")], "no_cache": True}, {}, lambda *_: None)
    workspace = opened.loader.load()
    (result,) = workspace.packages
    assert {file.language for file in result.launch if not file.helper} == {"python", "xml"}
    assert {reference.package for file in result.launch for reference in file.references} == {"a"}
    for file in result.launch:
        expand(file, {}, include_resolver(workspace).included)
    assert not Path(sprung).exists()


@pytest.mark.filterwarnings("ignore")
def test_the_trap_creates_its_file_if_it_is_run(tmp_path: Path) -> None:
    sprung = tmp_path / "sprung"
    with pytest.raises(FileExistsError):
        exec(TRAP.format(path=str(sprung)), {"__file__": __file__})
    assert sprung.exists()
