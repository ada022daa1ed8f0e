"""Python language features in launch files, and the limits of the interpretation."""

import ast
import time
from pathlib import Path

import pytest

from ros_lint.base.text import Text
from ros_lint.collectors import symbolic_text as launch_text
from ros_lint.collectors.launch.expand import expand
from ros_lint.collectors.launch.python import collect as launch_py
from ros_lint.collectors.python.interpreter.values import Module
from ros_lint.facts.visibility import Facet
from tests.launch_cases import collect, summaries

HEAD = """\
from dataclasses import dataclass
from functools import partial
import os, sys
from pathlib import Path
from launch import LaunchDescription
from launch.actions import *
from launch_ros.actions import Node

def generate_launch_description():
"""

# The body of generate_launch_description(), and what it starts; a question mark is for "perhaps".
CASES = """\
def make(e, p='a'):
    return Node(package=p, executable=e)
return [make('b'), make('c', p='d')]
=> node a b, node d c

def make(*names, **more):
    return [Node(executable=n, **more) for n in names]
return make('b', 'c', package='a')
=> node a b, node a c

numbers = [float(x) for x in LaunchConfiguration('datum').perform(None).split(' ') if x]
last = numbers.pop(2)
return [Node(package='a', executable='b', parameters=[{'datum': [numbers[0], numbers[1]]}])]
=> node a b

def twice(function):
    def wrapper(e):
        return [function(e), function(e + '2')]
    return wrapper
@twice
def make(e):
    return Node(package='a', executable=e)
return make('b')
=> node a b2, node a b

def pick(kind):
    match kind:
        case 'one' | 'two' if kind != 'two':
            return 'first'
        case 'two':
            return 'second'
        case None:
            return 'none'
        case (one, _) | [one]:
            return 'pair'
        case other:
            return other
return [Node(package='a', executable=pick(kind)) for kind in ('one', 'two', None, 'three')]
=> node a first, node a second, node a none, node? a pair, node? a three

def start(context):
    match LaunchConfiguration('kind').perform(context):
        case 'one':
            return [Node(package='a', executable='b')]
        case _:
            return [Node(package='a', executable='c')]
return [DeclareLaunchArgument('kind', default_value='two'), OpaqueFunction(function=start)]
=> node? a b, node? a c

os.environ['ROBOT'] = 'waffle'
os.environ['ROBOT'] += '_pi'
os.environ.setdefault('ROBOT', 'burger')
return [Node(package='a', executable=os.environ['ROBOT']), Node(package='a', executable=os.getenv('ROBOT'))]
=> node a waffle_pi, node a waffle_pi

from functools import cache
@cache
@unheard_of('x')
def make(e):
    return Node(package='a', executable=e)
return [make('b')]
=> node a b

make = partial(Node, package='a')
return [make(executable='b')]
=> node a b

make = lambda e: Node(package='a', executable=e)
return list(map(make, ['b', 'c']))
=> node a b, node a c

def each():
    for e in 'bc':
        yield Node(package='a', executable=e)
return list(each())
=> node a b, node a c

import copy
nodes = [{'e': 'b', 'more': ['x']}, {'e': 'c', 'more': []}]
def apart(given, end):
    own = copy.deepcopy(given)
    for one in own:
        one['was'] = one['e']
        one['e'] += end
        one['more'].append(end)
    return own
first, second, alike = apart(nodes, '1'), apart(nodes, '2'), copy.copy(nodes)
alike[0]['e'] = 'd'
return [Node(package=one['was'], executable=one['e'] + ''.join(one['more'])) for one in first + second] + [
    Node(package='a', executable=one['e']) for one in nodes]
=> node a c, node a d, node b b1x1, node c c11, node b b2x2, node c c22

nodes = {'b': 'a'}
nodes['c'] = 'd'
return [Node(package=p, executable=e) for e, p in nodes.items()]
=> node a b, node d c

ld = LaunchDescription()
for i, e in enumerate(['b', 'c']):
    if i:
        ld.add_action(Node(package='a', executable=e))
return ld
=> node a c

ld = LaunchDescription([Node(package='a', executable='b')])
ld.add_action(Node(package='a', executable='c'))
return ld
=> node a b, node a c

l = []
l += [Node(package='a', executable='b')]
l.extend([Node(package='a', executable='c')])
return LaunchDescription(l)
=> node a b, node a c

i = 0
l = []
while i < 2:
    l.append(Node(package='a', executable=f'b{i}'))
    i += 1
return l
=> node a b0, node a b1

@dataclass
class Robot:
    p: str
    e: str = 'b'
    def node(self):
        return Node(package=self.p, executable=self.e)
return [Robot('a').node()]
=> node a b

class Robot:
    def __init__(self, p):
        self.p = p
return [Node(package=Robot('a').p, executable='b')]
=> node a b

def setup(context, p):
    e = LaunchConfiguration('e').perform(context)
    return [Node(package=p, executable=e)]
return [DeclareLaunchArgument('e', default_value='b'), OpaqueFunction(function=setup, args=['a'])]
=> node a b

def setup(context):
    if LaunchConfiguration('sim').perform(context) == 'true':
        return [Node(package='a', executable='b')]
    return [Node(package='a', executable='c')]
return [OpaqueFunction(function=setup)]
=> node? a b, node? a c

def setup(context, ld):
    ld.add_action(Node(package='a', executable='b'))
ld = LaunchDescription()
ld.add_action(OpaqueFunction(function=setup, args=[ld]))
return ld
=> node a b

return [RegisterEventHandler(OnProcessExit(target_action=x, on_exit=[Node(package='a', executable='b')]))]
=> node a b

return [RegisterEventHandler(OnProcessStart(on_start=lambda event, context: [Node(package='a', executable='b')]))]
=> node a b

return [TimerAction(period=3.0, actions=[Node(package='a', executable='b')])]
=> node a b

try:
    p = {'x': 'c'}['y']
except KeyError:
    p = 'a'
return [Node(package=p, executable='b')]
=> node a b

p = os.environ.get('P', 'a')
return [Node(package=p, executable='b')]
=> node a b

p = 'x_a'.split('_')[-1].strip().replace('b', 'c')
return [Node(package=p, executable='{}{:02d}'.format('b', 1))]
=> node a b01

return [Node(package='a', executable='b')] if sys.argv else []
=> node? a b

for arg in sys.argv:
    if arg.startswith('x'):
        return [Node(package='a', executable='b')]
return [Node(package='a', executable='c')]
=> node? a b, node? a c

return unknown_helper(Node(package='a', executable='b'))
=> node? a b

x = 'a' and 'b'
y = None or 'a'
return [Node(package=y, executable=x)]
=> node a b
"""


def body(text: str) -> str:
    return HEAD + "".join(f"    {line}\n" for line in text.split("\n"))


@pytest.mark.parametrize("case", CASES.strip().split("\n\n"))
def test_python_language_features_are_interpreted(case: str) -> None:
    program, _, expected = case.rpartition("\n=> ")
    assert summaries(*collect("a.launch.py", body(program))) == expected.split(", ")


@pytest.mark.parametrize("case", CASES.strip().split("\n\n"))
def test_facts_contain_only_plain_values(case: str) -> None:
    """Facts are sent between processes and cached, so they must not reference objects of the interpreter."""
    program, _, _ = case.rpartition("\n=> ")
    _, launch_file = collect("a.launch.py", body(program))
    pending: list[object] = [launch_file]
    while pending:
        item = pending.pop()
        assert type(item).__module__ in (
            "builtins",
            "ros_lint.facts.launch",
            "ros_lint.facts.visibility",
            "ros_lint.base.text",
        ), item
        assert isinstance(item, tuple) or type(item) in (str, bool, int, type(None), Facet)
        pending += item if isinstance(item, tuple) else ()


def test_values_of_a_branch_are_combined_only_with_each_other() -> None:
    program = """\
if model == 'a':
    package, file = 'pa', 'a.launch.py'
elif model == 'b':
    package, file = 'pb', 'b.launch.py'
else:
    package, file = 'pc', 'c.launch.py'
share = get_package_share_directory(package)
other = os.path.join(get_package_share_directory('p') if sim else share, 'x' if sim else 'y')
return [
    IncludeLaunchDescription([FindPackageShare(package), '/launch/', file]),
    IncludeLaunchDescription(os.path.join(share, 'launch', file)),
    IncludeLaunchDescription(f'{share}/launch/{file}'),
    IncludeLaunchDescription(str(Path(share) / 'launch' / file)),
    IncludeLaunchDescription(share + '/launch/' + file),
]
"""
    source, launch_file = collect("a.launch.py", body(program))
    includes = [line for line in summaries(source, launch_file) if line.startswith("include")]
    assert sorted(set(includes)) == [f"include? p{x} launch/{x}.launch.py" for x in "abc"]
    assert len(includes) == 15


@pytest.mark.parametrize(
    ("line", "end"),
    [
        ("if unknown{0}(): return [Node(package='a', executable='b{0}')]", "return []"),
        ("if unknown{0}(): node = Node(package='a', executable='b{0}')", "return [node]"),
        ("node = Node(package='a', executable='b{0}') if unknown{0}() else node", "return [node]"),
    ],
)
def test_each_of_too_many_alternatives_may_be_launched(line: str, end: str) -> None:
    lines = [line.format(number) for number in range(30)]
    source, launch_file = collect("a.launch.py", body("\n".join(["node = None", *lines, end])))
    assert sorted(summaries(source, launch_file)) == sorted(f"node? a b{number}" for number in range(30))
    assert [item.reason for item in launch_file.opaque] == ["the launched actions are not known: one of too many values"]


@pytest.mark.parametrize("end", ["break", "return [Node(package='a', executable='b')]"])
def test_endless_loops_with_a_possible_exit_end(end: str) -> None:
    program = f"while True:\n    if input() == 'q':\n        {end}\nreturn [Node(package='a', executable='b')]"
    source, launch_file = collect("a.launch.py", body(program))
    assert {line.replace("?", "") for line in summaries(source, launch_file)} == {"node a b"}
    assert not launch_file.opaque


def test_modules_of_the_workspace_are_interpreted() -> None:
    helper = """\
from .names import P
def node(e):
    from launch_ros.actions import Node
    return Node(package=P, executable=e)
"""
    modules = {
        "tools.launch": Module(Text("src/tools/tools/launch.py", helper), ast.parse(helper)),
        ".names": Module(Text("src/tools/tools/names.py", "P = 'a'\n"), ast.parse("P = 'a'\n")),
    }
    source = Text("a.launch.py", "from tools.launch import node\n" + body("return [node('b')]"))
    launch_file = launch_py.collect(source, lambda name, importer: modules.get(name))
    assert [(item.package, item.name, item.package_span.path) for item in launch_file.references] == [
        ("a", "b", "src/tools/tools/names.py")
    ]
    assert not launch_file.opaque
    assert launch_py.collect(source).opaque


def test_files_of_the_workspace_are_read() -> None:
    program = """\
import yaml
share = get_package_share_directory('p')
with open(share + '/nodes.yaml') as f:
    data = yaml.safe_load(f)
return [Node(package=n['p'], executable=n['e']) for n in data['nodes']]
"""
    files = {f"{launch_text.share('p')}/nodes.yaml": "nodes:\n- {p: a, e: b}\n- {p: c, e: d}\n"}
    launch_file = launch_py.collect(Text("a.launch.py", body(program)), files=files.get)
    assert [(item.package, item.name) for item in launch_file.references if item.kind == "node"] == [("a", "b"), ("c", "d")]


@pytest.mark.parametrize("reading", ["yaml.safe_load('{e: b}')", 'json.loads(\'{"e": "b"}\')'])
def test_literal_yaml_and_json_contents_are_parsed(reading: str) -> None:
    program = f"import json, yaml\nreturn [Node(package='a', executable={reading}['e'])]"
    assert summaries(*collect("a.launch.py", body(program))) == ["node a b"]


def test_the_interpreted_program_does_not_run(tmp_path: Path) -> None:
    trap = tmp_path / "sprung"
    text = f"import os\nopen({str(trap)!r}, 'w').write('x')\nos.system('touch {trap}')\n"
    collect("a.launch.py", text + body(f"open({str(trap)!r}, 'w')\nexec('x')\nreturn []"))
    assert not trap.exists()


@pytest.mark.parametrize(
    "program",
    [
        "x = " + "[" * 5000,
        "x = " + "+".join(["'a'"] * 20_000),
        "x = " + "f(" * 150 + ")" * 150,
        "x = x + y\ny = x + y\nNode(package=x, executable=y).z",
        "\n".join(f"x{n} = x{n - 1} + x{n - 1}" for n in range(1, 200)) + "\nNode(package=x199, executable='b').z",
        "a = 'x' if y else 'z'\n" + "\n".join(f"a = a + ('{n}' if y else 'w')" for n in range(99)) + "\njoin(a, a)",
        "\0",
        "while True:\n    pass",
        "while True:\n    x = [x]",
        "x = []\nfor i in range(10 ** 9):\n    x.append(i)",
        "x = [a for a in range(99) for b in range(99) for c in range(99) for d in range(99)]",
        "x = ['a'] * 10 ** 9\ny = 'a' * 10 ** 9",
        "x = 7\nfor i in range(99):\n    x = x * x",
        "def f(n):\n    return f(n + 1) + f(n + 1)\nf(0)",
        "def f(n):\n    return [f(n) for _ in range(9)]\nf(0)",
        "def f(x):\n    for k in x:\n        f(k)\n    return f(x)\nf(unknown)",
        "x = []\nx.append(x)\nreturn x",
        "x = {}\nx['x'] = x\nstr(x)\nreturn [Node(package='a', executable='b', parameters=[x])]",
        "a = LaunchDescription()\na.add_action(a)\nreturn a",
        "x = '%s' % ('a' * 9999)\n" + "x = x + x\n" * 60 + "return [x]",
        "x = '{:>999999999}'.format('a')\ny = '%999999999d' % 1\nz = f'{1:999999999}'",
        "x = DeclareLaunchArgument('a', default_value=LaunchConfiguration('a'))\nreturn [x]",
        "b = DeclareLaunchArgument('b', default_value=[LaunchConfiguration('a')] * 9)\n"
        "return [DeclareLaunchArgument('a', default_value=LaunchConfiguration('b')), b]",
        "\n".join(f"if unknown{n}:\n    x{n} = {n}" for n in range(300)),
        "\n".join("    " * n + f"if unknown{n}:" for n in range(90)) + "\n" + "    " * 90 + "pass",
        "\n".join(f"x = x + [y] if unknown{n} else [x]" for n in range(40)) + "\nreturn x",
        "class A(A): pass\nA().b()",
        "f = lambda: f()\nf()",
    ],
)
def test_interpretation_of_hostile_files_ends_in_time(program: str) -> None:
    begin = time.process_time()
    collect("a.launch.py", body(program))
    assert time.process_time() - begin < 2


def test_parameters_are_named_files_or_unknown() -> None:
    program = """\
where = get_package_share_directory('a')
return LaunchDescription([Node(package='a', executable='b', parameters=[
    {'x': 1}, [FindPackageShare('a'), '/config/', 'p.yaml'], os.path.join(where, 'q.yaml'), unknown()])])"""
    _, file = collect("a.launch.py", body(program))
    (node,) = file.actions
    assert [(name, value.texts) for name, value in node.parameters] == [
        ("x", ("1",)),
        ("", (f"{launch_text.share('a')}/config/p.yaml",)),
        ("", (f"{launch_text.share('a')}/q.yaml",)),
        (launch_text.UNKNOWN, (launch_text.UNKNOWN,)),
    ]


@pytest.mark.parametrize("question", ["{} == 'humble'", "{}[0] <= 'h'", "{} in ('foxy', 'humble')", "{}[:1] not in ('j', 'k')"])
@pytest.mark.parametrize(("distro", "expected"), [("humble", "old"), ("jazzy", "new")])
def test_branches_on_the_distribution_limit_references(distro: str, expected: str, question: str) -> None:
    program = f"""\
name = 'old' if {question.format("os.environ.get('ROS_DISTRO')")} else 'new'
if {question.format("os.getenv('ROS_DISTRO')")}:
    return [Node(package='a', executable='old'), Node(package='a', executable=name)]
return [Node(package='a', executable='new'), Node(package='a', executable=name)]"""
    _, file = collect("a.launch.py", body(program))
    assert [item.target for item in expand(file, {}, distro=distro).started if item.certain][:1] == [(expected,)]


def test_match_on_an_argument_selects_a_branch() -> None:
    text = (
        HEAD
        + """
    def start(context):
        match LaunchConfiguration('kind').perform(context):
            case 'one' | 'two':
                return [Node(package='a', executable='b')]
            case 'three':
                return [Node(package='a', executable='c')]
    return LaunchDescription([DeclareLaunchArgument('kind', default_value='two'), OpaqueFunction(function=start)])
"""
    )
    _, file = collect("launch/a.launch.py", text)
    assert [(item.target, item.certain) for item in expand(file, {}).started] == [(("b",), True)]
    assert [(item.target, item.certain) for item in expand(file, {"kind": "three"}).started] == [(("c",), True)]
    assert not expand(file, {"kind": "four"}).started


def test_environment_variables_set_by_the_file_are_used() -> None:
    """The variables apply to launched nodes and to substitutions."""
    text = (
        HEAD
        + """
    os.environ['PLACE'] = '/maps'
    map = [EnvironmentVariable('PLACE'), '/hall.yaml']
    return LaunchDescription([Node(package='a', executable='b', parameters=[map])])
"""
    )
    _, file = collect("launch/a.launch.py", text)
    (started,) = expand(file, {}).started
    assert started.parameters == (("", ("/maps/hall.yaml",)),)
    assert started.environment == (("PLACE", ("/maps",)),)


def test_conditional_parameters_are_selected_by_arguments() -> None:
    text = (
        HEAD
        + """
    files = {'indoor': '/in.yaml', 'outdoor': '/out.yaml'}

    def start(context):
        place = LaunchConfiguration('place').perform(context)
        parameters = [files[place], '/fast.yaml' if LaunchConfiguration('fast').perform(context) == 'true' else '/slow.yaml']
        if place == 'outdoor':
            parameters.append({'rain': True})
        parameters.append(ParameterFile('/walls.yaml' if place == 'indoor' else '/trees.yaml', allow_substs=True))
        return [Node(package='a', executable='b', parameters=parameters)]

    places = DeclareLaunchArgument('place', default_value='indoor')
    speeds = DeclareLaunchArgument('fast', default_value='false')
    return LaunchDescription([places, speeds, OpaqueFunction(function=start)])
"""
    )
    _, file = collect("launch/a.launch.py", text)
    (started,) = expand(file, {}).started
    assert started.parameters == (("", ("/in.yaml",)), ("", ("/slow.yaml",)), ("", ("/walls.yaml",)))
    (started,) = expand(file, {"place": "outdoor", "fast": "true"}).started
    assert started.parameters == (("", ("/out.yaml",)), ("", ("/fast.yaml",)), ("rain", ("True",)), ("", ("/trees.yaml",)))


def test_a_conditional_parameter_file_is_a_conditional_reference() -> None:
    text = (
        HEAD
        + """
    share = get_package_share_directory('p')
    file = share + ('/humble.yaml' if os.environ['ROS_DISTRO'] == 'humble' else '/later.yaml')
    more = share + '/more.yaml'
    return LaunchDescription([Node(package='a', executable='b', parameters=[file, more])])
"""
    )
    _, file = collect("launch/a.launch.py", text)
    named = {item.name: (item.conditional, item.distros == ("humble",)) for item in file.references if item.kind == "file"}
    assert named == {"humble.yaml": (True, True), "later.yaml": (True, False), "more.yaml": (False, False)}


def test_a_path_with_an_empty_default_part_is_not_a_reference() -> None:
    text = (
        HEAD
        + """
    name = (unknown() or '').strip()
    robot = os.getenv('ROBOT') or 'burger'
    share = Path(get_package_share_directory('p'))
    (share / 'models' / name / 'model.sdf').read_text()
    (share / 'models' / robot / 'model.sdf').read_text()
    return LaunchDescription([])
"""
    )
    _, file = collect("launch/a.launch.py", text)
    named = {item.name: item.conditional for item in file.references if item.kind == "file"}
    assert named == {"models/burger/model.sdf": True}
