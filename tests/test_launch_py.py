"""Launch files in Python: detection and references."""

import pytest

from ros_lint.base.text import read
from ros_lint.collectors.launch import collect as launch_files
from ros_lint.collectors.launch import detect as launch
from tests.launch_cases import collect, summaries, summary

HEAD = "def generate_launch_description():\n"


def python(body: str, prologue: str = "") -> list[str]:
    indented = "".join(f"    {line}\n" for line in body.splitlines())
    return summaries(*collect("a.launch.py", f"{prologue}\n{HEAD}{indented}"))


@pytest.mark.parametrize(
    ("path", "text", "expected"),
    [
        ("a.launch.py", HEAD + "    pass", "python"),
        ("start.py", "import os\n" + HEAD, "python"),
        ("a.py", "def generate_test_description():\n", "python"),
        ("helper.py", "from launch_ros.actions import Node\ndef f(p): return Node(package=p)\n", "python"),
        ("helper.py", "from launch_ros.actions import Node\n", None),
        ("a.py", "class A:\n    def generate_launch_description(self): ...\n", None),
        ("a.py", "import launcher\n", None),
        ("setup.py", "data_files=[('share/a/launch', ['launch/a.py'])]", None),
    ],
)
def test_launch_files_are_recognised_by_content(path: str, text: str, expected: str | None) -> None:
    assert launch.is_launch_file(path, text) == expected


def test_comments_need_not_be_in_utf_8() -> None:
    """launch imports the file, and Python accepts any bytes in comments when it imports, but not in strings."""
    body = b"    return [Node(package='a', executable='b')]  # caf\xe9\n"
    text = read("a.launch.py", f"from launch_ros.actions import Node\n# \n{HEAD}".encode().replace(b"# ", b"# \xa3\xba") + body)
    launch_file = launch_files.collect(text, "python")
    assert summaries(text, launch_file) == ["node a b"]
    assert not launch_file.opaque
    refused = launch_files.collect(read("a.launch.py", HEAD.encode() + body.replace(b"'b'", b"'\xe9'")), "python")
    assert [problem.kind for problem in refused.problems] == ["syntax"]
    assert refused.opaque


@pytest.mark.parametrize(
    ("text", "test", "helper"),
    [
        (HEAD + " pass", False, False),
        ("def generate_test_description():\n pass", True, False),
        ("import launch\nx = Node()", False, True),
        ("def generate_launch_description(kind, name='a'):\n pass", False, True),
        ("def generate_launch_description(*, kind):\n pass", False, True),
        ("def generate_launch_description(kind='a', *more, name='a', **rest):\n pass", False, False),
        ("@given('a')\ndef generate_launch_description(kind):\n pass", False, False),
    ],
)
def test_test_files_and_helpers_are_distinguished(text: str, test: bool, helper: bool) -> None:
    _, launch_file = collect("a.py", text)
    assert (launch_file.test, launch_file.helper) == (test, helper)


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("return [Node(package='a', executable='b')]", ["node a b"]),
        ("return [launch_ros.actions.LifecycleNode(executable='b', package='a')]", ["node a b"]),
        ("p = 'a'\nreturn [Node(package=p, executable=p + '_node')]", ["node a a_node"]),
        ("return [Node(package='a', executable=f'{E}_node')]", ["node a b_node"]),
        ("return [Node(package='a', executable='%s_%s' % (E, 'x'))]", ["node a b_x"]),
        ("return [Node(package='a', executable='{}_x'.format(E))]", ["node a b_x"]),
        ("return [Node(package='a', executable=LaunchConfiguration('b'))]", ["package a"]),
        ("return [Node(executable='/usr/bin/b')]", []),
        ("return [Node(package='a', executable='b', condition=IfCondition(x))]", ["node? a b"]),
        ("return [GroupAction([Node(package='a', executable='b')], condition=x)]", ["node? a b"]),
        ("if x:\n    return [Node(package='a', executable='b')]", ["node? a b"]),
        ("e = 'c' if x else 'd'\nreturn [Node(package='a', executable=e)]", ["node? a c", "node? a d"]),
        (
            "if x:\n    e = 'c'\nelse:\n    e = 'd'\nreturn [Node(package='a', executable=e)]",
            ["node? a c", "node? a d"],
        ),
        ("e = 'c'\ne = 'd'\nreturn [Node(package='a', executable=e)]", ["node a d"]),
        ("return [Node(package='a', executable=e) for e in ['c', 'd']]", ["node a c", "node a d"]),
        (
            "r = []\nfor p, e in [('a', 'b'), ('c', 'd')]:\n    r.append(Node(package=p, executable=e))\nreturn r",
            ["node a b", "node c d"],
        ),
        ("return [Node(package=D['p'], executable=D['e'])]", ["node a b"]),
        ("c, d = 'x', 'y'\nreturn [Node(package=c, executable=d)]", ["node x y"]),
        (
            "return [ComposableNodeContainer(package='rclcpp_components', executable='component_container',\n"
            "  composable_node_descriptions=[ComposableNode(package='a', plugin='a::B')])]",
            ["node rclcpp_components component_container", "component a a::B"],
        ),
        (
            "return [LoadComposableNodes(composable_node_descriptions=[ComposableNode(package='a', plugin='a::B')])]",
            ["component a a::B"],
        ),
        ("return [ExecuteProcess(cmd=['ros2', 'run', 'a', 'b', '--x'])]", ["node a b"]),
        ("return [ExecuteProcess(cmd=['ros2 run a b'], shell=True)]", ["node a b"]),
        ("return [ExecuteProcess(cmd=['ros2', 'launch', 'a', 'b.launch.py'])]", ["package a"]),
        ("return [ExecuteProcess(cmd=[ExecutableInPackage('b', 'a')])]", ["node a b"]),
        ("return [ExecuteProcess(cmd=[os.path.join(get_package_prefix('a'), 'lib', 'a', 'b')])]", ["node a b"]),
        (
            "d = Command(['xacro ', os.path.join(get_package_share_directory('a'), 'b.xacro')])\n"
            "return [Node(package='c', executable='d', parameters=[{'robot_description': d}])]",
            ["command xacro xacro", "node c d", "file a b.xacro"],
        ),
        (
            "return [DeclareLaunchArgument('d', default_value=Command([FindExecutable(name='xacro'), ' ', x]))]",
            ["command xacro xacro"],
        ),
        ("return [Node(package='a', executable='b', prefix='xterm -e')]", ["node a b", "program xterm xterm"]),
        ("return [Node(package='a', executable='b', prefix=['x', 'term -e'])]", ["node a b", "program xterm xterm"]),
        ("return [ExecuteProcess(cmd=['b'], prefix=['nice'], cwd=[FindPackageShare('c'), '/d'])]", ["file c d"]),
        ("m = MoveItConfigsBuilder('a')\nreturn []", ["package a_moveit_config"]),
        ("m = MoveItConfigsBuilder('a', package_name='b').to_moveit_configs()\nreturn []", ["package b"]),
        ("m = MoveItConfigsBuilder('a', 'robot_description_left')\nreturn []", ["package a_moveit_config"]),
        ("m = MoveItConfigsBuilder('a', 'robot_description', 'b')\nreturn []", ["package b"]),
        (
            "m = MoveItConfigsBuilder('a').robot_description_semantic(file_path='config/b.srdf').sensors_3d('c.yaml')\nreturn []",
            ["file a_moveit_config config/b.srdf"],
        ),
        (
            "m = MoveItConfigsBuilder('a', package_name='b').joint_limits(Path('config') / 'c.yaml').to_moveit_configs()\n"
            "return []",
            ["file b config/c.yaml"],
        ),
        (
            "p = ParameterBuilder('a').yaml('config/b.yaml').file_parameter('c', 'd.txt')\nreturn []",
            ["file a config/b.yaml", "file a d.txt"],
        ),
        (
            "try:\n    m = MoveItConfigsBuilder('a', package_name='b').yaml('c.yaml')\nexcept OSError:\n    m = None\nreturn []",
            ["package b"],
        ),
    ],
)
def test_references_to_programs(body: str, expected: list[str]) -> None:
    assert python(body, "E = 'b'\nD = {'p': 'a', 'e': E}\n") == expected


@pytest.mark.parametrize(
    "path",
    [
        "os.path.join(get_package_share_directory('a'), 'launch', 'b.launch.py')",
        "join(share, 'launch/b.launch.py')",
        "share + '/launch/b.launch.py'",
        "f'{share}/launch/b.launch.py'",
        "str(Path(share) / 'launch' / 'b.launch.py')",
        "str(get_package_share_path('a') / 'launch' / 'b.launch.py')",
        "get_package_share_path('a').joinpath('launch', 'b.launch.py').as_posix()",
        "os.path.join(folder, 'b.launch.py')",
        "[folder, '/b.launch.py']",
        "[FindPackageShare('a'), '/launch/b.launch.py']",
        "[FindPackageShare(package='a'), '/launch', '/b.launch.py']",
        "[PathJoinSubstitution([FindPackageShare('a'), 'launch', 'b.launch.py'])]",
        "PathJoinSubstitution([FindPackageShare('a'), 'launch', 'b.launch.py'])",
        "FindPackageShare('a') / 'launch' / 'b.launch.py'",
        "os.path.join(FindPackageShare('a').find('a'), 'launch', 'b.launch.py')",
        "ThisIs('a').perform(context)",
        "os.path.join(get_package_prefix('a'), 'share', 'a', 'launch', 'b.launch.py')",
        "os.path.join(get_package_share_directory('a'), 'config', '..', 'launch', 'b.launch.py')",
    ],
)
@pytest.mark.parametrize("source", ["PythonLaunchDescriptionSource({})", "AnyLaunchDescriptionSource({})", "{}"])
def test_references_to_included_files(path: str, source: str) -> None:
    body = (
        "from os.path import join\nshare = get_package_share_directory('a')\nfolder = os.path.join(share, 'launch')\n"
        f"return [IncludeLaunchDescription({source.format(path)})]"
    )
    launch_file = [line for line in python(body) if line.startswith("include")]
    assert launch_file == ([] if path.startswith("ThisIs") else ["include a launch/b.launch.py"])


def test_a_file_that_may_be_missing_leaves_both_values() -> None:
    body = "try:\n    with open('/etc/robot') as file:\n        name = 'arm'\nexcept OSError:\n    name = 'hand'\n"
    assert python(f"{body}return [Node(package='a', executable=name)]") == ["node? a arm", "node? a hand"]


def test_paths_are_found_in_named_values() -> None:
    body = (
        "share = get_package_share_directory('a')\n"
        "params = os.path.join(share, 'config', 'p.yaml')\n"
        "return [Node(package='b', executable='c', parameters=[params], arguments=['-d', share + '/x.rviz'])]"
    )
    assert python(body) == ["file a config/p.yaml", "node b c", "file a x.rviz"]


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("doc = xacro.parse(open(path))", ["file a urdf/x.urdf"]),
        ("with open(path, 'r') as file:\n    text = file.read()", ["file a urdf/x.urdf"]),
        ("text = Path(path).read_text()", ["file a urdf/x.urdf"]),
        ("with open(path, 'w') as file:\n    file.write('')", ["package a"]),
        ("try:\n    text = open(path).read()\nexcept OSError:\n    text = ''", ["package a"]),
        ("try:\n    text = open(path).read()\nexcept ValueError:\n    text = ''", ["file a urdf/x.urdf"]),
        ("try:\n    pass\nexcept OSError:\n    pass\ntext = open(path).read()", ["file a urdf/x.urdf"]),
    ],
)
def test_files_read_during_the_launch_are_references(body: str, expected: list[str]) -> None:
    path = "path = os.path.join(get_package_share_directory('a'), 'urdf', 'x.urdf')\n"
    assert python(f"{path}{body}\nreturn []") == expected


def test_a_file_read_in_a_branch_is_conditional() -> None:
    prologue = (
        "def start(context):\n"
        "    robot = LaunchConfiguration('robot').perform(context)\n"
        "    if robot == 'arm':\n"
        "        open(os.path.join(get_package_share_directory('a'), robot + '.yaml')).read()\n"
        "    return []\n"
    )
    body = "return [DeclareLaunchArgument('robot', default_value='base'), OpaqueFunction(function=start)]"
    assert python(body, prologue) == ["file? a arm.yaml", "package? a"]


def test_an_empty_path_is_not_a_reference() -> None:
    body = (
        "name = {}.get('plugin') if os.environ.get('X') else 'aruco'\n"
        "params = os.path.join(get_package_share_directory('a'), name, 'p.yaml')\n"
        "return [Node(package='b', executable='c', parameters=[params])]"
    )
    assert python(body) == ["file a aruco/p.yaml", "node b c"]


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("n = Node(package='a', executable='b')\nreturn []", []),
        ("n = Node(package='a', executable='b')\nreturn [n]", ["node a b"]),
        ("n = Node(package='a', executable='b')\nreturn [], locals()", []),
        ("Node(package='a', executable='b')\nreturn []", []),
        ("ld.add_action(Node(package='a', executable='b'))", ["node? a b"]),
        ("n = Node(package='a', executable='b')\ndef later():\n    return n", []),
        ("n = Node(package='a', executable='b', parameters=[get_package_share_directory('c')])", ["package c"]),
        ("i = IncludeLaunchDescription(PathJoinSubstitution([FindPackageShare('a'), 'b']))", []),
        ("i = IncludeLaunchDescription(os.path.join(get_package_share_directory('a'), 'b'))", ["package a"]),
    ],
)
def test_actions_that_are_not_launched_start_nothing(body: str, expected: list[str]) -> None:
    """Eager look-ups still count, because they fail if the package is missing; lazy substitutions do not."""
    assert python(body) == expected


def test_removed_keywords_are_read_and_reported() -> None:
    names = "    return [Node(package='a', node_executable='b', node_name='c')]\n"
    text = f"from launch_ros.actions import Node\n{HEAD}{names}"
    source, launch_file = collect("a.launch.py", text)
    assert summaries(source, launch_file) == ["node a b"]
    assert [problem.message for problem in launch_file.problems] == [
        "Node(node_executable=) was removed in Galactic; use executable=",
        "Node(node_name=) was removed in Galactic; use name=",
    ]
    assert source.slice(launch_file.problems[0].span) == "node_executable"


def test_the_main_guard_is_not_interpreted() -> None:
    assert python("return []", "if __name__ == '__main__':\n    Node(package='a', executable='b').x()\n") == []


@pytest.mark.parametrize(
    ("body", "reason"),
    [
        (
            "return [Node(package=LaunchConfiguration('p'), executable='b')]",
            "the package of a node is computed",
        ),
        (
            "return [Node(executable=[FindPackageShare(LaunchConfiguration('p')), '/x'])]",
            "the package that is looked up is computed",
        ),
        ("return [IncludeLaunchDescription(x)]", "the included launch file is computed"),
        ("return [ExecuteProcess(cmd=['ros2', 'run', x, 'b'])]", "the target of 'ros2 run' is computed"),
    ],
)
def test_computed_names_are_opaque(body: str, reason: str) -> None:
    _, launch_file = collect("a.launch.py", f"{HEAD}    {body}\n")
    assert [opaque.reason for opaque in launch_file.opaque] == [reason]


@pytest.mark.parametrize(
    ("text", "line"),
    [
        (HEAD, 1),
        (HEAD + "    return [\n", 2),
        (HEAD + "\treturn (\n", 2),
        (HEAD + "    x = '\n", 2),
        (HEAD + "    print 'x'\n", 2),
    ],
)
def test_syntax_errors_are_problems(text: str, line: int) -> None:
    source, launch_file = collect("a.launch.py", text)
    assert [problem.kind for problem in launch_file.problems] == ["syntax"]
    assert launch_file.problems[0].span.line in (line, line + 1)
    assert source.slice(launch_file.problems[0].span) == ""
    assert launch_file.opaque


@pytest.mark.parametrize(
    "path",
    [
        "[ThisLaunchFileDir(), '/b.launch.py']",
        "os.path.join(os.path.dirname(os.path.realpath(__file__)), 'b.launch.py')",
        "str(Path(__file__).parent / 'b.launch.py')",
    ],
)
def test_an_include_of_a_neighbouring_file_is_not_opaque(path: str) -> None:
    _, launch_file = collect("a.launch.py", f"{HEAD}    return [IncludeLaunchDescription({path})]\n")
    assert [(reference.kind, reference.package, reference.name) for reference in launch_file.references] == [
        ("include", "", "b.launch.py")
    ]
    assert launch_file.opaque == ()


def test_places_after_non_ascii_characters_are_exact() -> None:
    source, launch_file = collect("a.launch.py", HEAD + "    return ['ü', Node(package='a', executable='''ö''')]\n")
    (node,) = launch_file.references
    assert (source.slice(node.span), source.slice(node.package_span), node.exact) == ("ö", "a", True)


def test_the_place_of_an_extended_text_is_its_first_literal() -> None:
    body = (
        "    world = os.path.join(get_package_share_directory('a'), 'worlds', 'w.sdf')\n    world += ' -r'\n"
        "    return [ExecuteProcess(cmd=['gz', 'sim', world])]\n"
    )
    source, launch_file = collect("a.launch.py", HEAD + body)
    assert {source.slice(reference.span)[:12] for reference in launch_file.references if reference.kind == "file"} == {
        "os.path.join"
    }


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("if has_resource('packages', 'a'):\n    return [@]", {"b": True}),
        ("if has_resource('packages', 'a') and x:\n    ld.add_action(@)\nreturn ld", {"b": True}),
        ("if 'a' in get_packages_with_prefixes().keys():\n    return [@]", {"b": True}),
        ("if get_packages_with_prefixes().get('a'):\n    return [@]", {"b": True}),
        ("if 'a' not in get_packages_with_prefixes():\n    return []\nreturn [@]", {"b": True}),
        ("if 'a' not in get_packages_with_prefixes():\n    raise E()\nreturn [@]", {"b": False}),
        ("if 'a' in get_packages_with_prefixes():\n    pass\nelse:\n    ld.add_action(@)\nreturn ld", {"b": False}),
        (
            "try:\n    p = get_package_share_directory('a')\nexcept PackageNotFoundError:\n    return []\nreturn [@]",
            {"a": True, "b": True},
        ),
        (
            "try:\n    p = get_package_share_directory('a')\nexcept PackageNotFoundError as e:\n    raise E() from e\nreturn [@]",
            {"a": False, "b": False},
        ),
        ("try:\n    p = get_package_share_directory('a')\nexcept OSError:\n    pass\nreturn []", {"a": False}),
        (
            "p = ''\ntry:\n    p = os.path.join(get_package_prefix('a'), 'lib', 'a', 'liba.so')\n"
            "except PackageNotFoundError:\n    print()\n"
            "g = {}\nif p and not os.path.isfile(p):\n    p = ''\nif p:\n    g['plugin'] = p\n"
            "return [@, Node(package='b', executable='d', parameters=[g])]",
            {"a": True, "b": False},
        ),
        (
            "try:\n    p = get_package_share_directory('a')\nexcept PackageNotFoundError:\n    p = ''\n"
            "return [IncludeLaunchDescription(os.path.join(get_package_share_directory('a'), 'x.launch.py'))]",
            {"a": False},
        ),
        (
            "if x:\n    try:\n        p = get_package_share_directory('a')\n"
            "    except PackageNotFoundError:\n        raise E('install a')\n"
            "    ld.add_action(Node(package='a', executable='c'))\nreturn ld",
            {"a": True},
        ),
    ],
)  # fmt: skip
def test_look_ups_that_tolerate_missing_packages_are_optional(body: str, expected: dict[str, bool]) -> None:
    indented = "".join(f"    {line}\n" for line in body.replace("@", "Node(package='b', executable='c')").splitlines())
    _, launch_file = collect("a.launch.py", f"{HEAD}    ld = LaunchDescription()\n{indented}")
    packages = {reference.package for reference in launch_file.references}
    assert {p: all(r.optional for r in launch_file.references if r.package == p) for p in packages} == expected


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        (
            "s = get_package_share_directory('a')\nt = get_package_share_directory('b')\n"
            "return [Node(package='c', executable='d', parameters=[s + '/x.yaml', {'m': t + '/y.urdf'}],\n"
            "  arguments=['-d',\n    t + '/z.rviz'])]",
            {"file a x.yaml": 1, "file b y.urdf": 2, "file b z.rviz": 2, "node c d": 3},
        ),
        (
            "p = DeclareLaunchArgument('p', default_value=get_package_share_directory('a') + '/x.rviz', condition=i)\n"
            "q = DeclareLaunchArgument('p', default_value=get_package_share_directory('b') + '/y.rviz', condition=j)\n"
            "return [p, q, Node(package='c', executable='d', arguments=[LaunchConfiguration('p')])]",
            {"file? a x.rviz": 1, "package a": 1, "file? b y.rviz": 2, "file b y.rviz": 2, "package b": 2, "node c d": 3},
        ),
        (
            "d = Command([\n  'xacro ', get_package_share_directory('a') + '/x.xacro'])\n"
            "return [Node(package='c', executable='d', parameters=[{'robot_description': d}])]",
            {"command xacro xacro": 2, "file a x.xacro": 2, "node c d": 3},
        ),
        (
            "if X == 'one':\n    p, f = get_package_share_directory('a'), '/x.launch.py'\n"
            "elif X == 'two':\n    p, f = get_package_share_directory('b'), '/y.launch.py'\n"
            "else:\n    p, f = get_package_share_directory('a'), '/x.launch.py'\nreturn [IncludeLaunchDescription([p, f])]",
            {"include? a x.launch.py": 2, "include? b y.launch.py": 4},
        ),
        (
            "if X == 'one':\n    p = LaunchConfiguration('p', default=get_package_share_directory('a'))\n    f = '/x.launch.py'\n"
            "else:\n    p = LaunchConfiguration('p', default=get_package_share_directory('b'))\n    f = '/y.launch.py'\n"
            "return [DeclareLaunchArgument('p', default_value=p), IncludeLaunchDescription([p, f])]",
            {"include? a x.launch.py": 2, "include? b y.launch.py": 5, "package? a": 2, "package? b": 5},
        ),
        (
            "p = LaunchConfiguration('p')\nf = PathJoinSubstitution([\n    FindPackageShare(p), 'x.yaml'])\n"
            "return [DeclareLaunchArgument('p', default_value='a'),\n    Node(package='c', executable='d', parameters=[f])]",
            {"file a x.yaml": 3, "node c d": 5},
        ),
    ],
)
def test_the_span_of_a_package_is_its_look_up(body: str, expected: dict[str, int]) -> None:
    indented = "".join(f"    {line}\n" for line in body.splitlines())
    _, launch_file = collect("a.launch.py", f"import os\nX = os.environ['X']\n{HEAD}{indented}")
    assert {summary(reference): reference.package_span.line - 3 for reference in launch_file.references} == expected


def test_a_package_named_by_a_default_is_marked() -> None:
    text = (
        '<launch><arg name="kit" default="a"/><arg name="file" default="$(find-pkg-share b)/x.yaml"/>'
        '<include file="$(find-pkg-share $(var kit)_description)/y.launch.xml"/>'
        '<node pkg="c" exec="d" args="$(var file)"/></launch>'
    )
    _, launch_file = collect("a.launch.xml", text)
    named = {reference.package: reference.package_from_default for reference in launch_file.references}
    assert named == {"a_description": True, "b": False, "c": False}
