"""Paths with a part that is known only at launch, compared with os.path and pathlib."""

import os
from pathlib import PurePosixPath

import pytest

from ros_lint.base.text import Text
from ros_lint.collectors.launch.expand import expand
from ros_lint.collectors.launch.python import collect as launch_py
from ros_lint.collectors.symbolic_text import UNKNOWN

PROGRAM = """\
import os
from pathlib import Path
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

def setup(context):
    value = LaunchConfiguration('value'{default}).perform(context)
    path = {path}
    return [Node(package='a', executable={result})]

def generate_launch_description():
    return LaunchDescription([OpaqueFunction(function=setup)])
"""

FUNCTIONS = [
    "os.path.basename(path)",
    "os.path.dirname(path)",
    "os.path.split(path)[0]",
    "os.path.split(path)[1]",
    "os.path.splitext(path)[0]",
    "os.path.splitext(path)[1]",
    "Path(path).name",
    "Path(path).stem",
    "Path(path).suffix",
    "str(Path(path).parent)",
    "str(Path(path).parent / 'x')",
    "str(Path(path).parents[0])",
    "str(Path(path).with_suffix('.x'))",
    "str(Path(path).with_name('x'))",
]

PATHS = ["value", "'/m/' + value", "value + '/m'", "value + '/m.x'", "'m.' + value", "value + '.x'", "'/m/' + value + '/n'"]


@pytest.mark.parametrize("result", FUNCTIONS)
@pytest.mark.parametrize("path", PATHS)
def test_known_paths_equal_those_of_python(path: str, result: str) -> None:
    """An unknown part counts as one name. Values with slashes are used only if the path is nothing but this part."""
    for value in ("b", "b.yaml", "/d/b.yaml", "d/b") if path == "value" else ("b",):
        for default in ("", f", default={value!r}"):
            file = launch_py.collect(Text("a.launch.py", PROGRAM.format(default=default, path=path, result=result)))
            (started,) = expand(file, {} if default else {"value": value}).started
            names = {"os": os, "Path": PurePosixPath, "path": eval(path, {"value": value})}
            expected = eval(result, names)
            assert all(text == expected or UNKNOWN in text for text in started.target), (value, default)


@pytest.mark.parametrize(
    ("path", "result", "expected"),
    [
        ("value", "os.path.basename(path)", "b.yaml"),
        ("value", "Path(path).name", "b.yaml"),
        ("'/m/' + value", "os.path.dirname(path)", "/m"),
        ("value + '/m.x'", "os.path.basename(path)", "m.x"),
        ("value + '/m.x'", "os.path.splitext(path)[1]", ".x"),
        ("value + '/m'", "str(Path(path).with_name('x'))", "/d/b.yaml/x"),
        ("value + '.x'", "str(Path(path).with_suffix('.y'))", "/d/b.yaml.y"),
        ("'/m//' + 'n/'", "str(Path(path))", "/m/n"),
        ("'m'", "str(Path(path).with_suffix('.y'))", "m.y"),
        ("'m'", "str(Path(path).parent)", "."),
        ("'.m'", "Path(path).stem", ".m"),
    ],
)
def test_known_parts_of_paths_stay_known(path: str, result: str, expected: str) -> None:
    default = "" if path == "'/m/' + value" else ", default='/d/b.yaml'"
    file = launch_py.collect(Text("a.launch.py", PROGRAM.format(default=default, path=path, result=result)))
    (started,) = expand(file, {"value": "b"} if not default else {}).started
    assert started.target == (expected,)


@pytest.mark.parametrize(
    "result", ["os.path.dirname(u)", "str(Path(u).parent)", "str(Path(u).parents[0])", "os.path.splitext(u)[0]"]
)
def test_the_folder_of_an_unknown_path_is_unknown(result: str) -> None:
    program = PROGRAM.format(default="", path="''", result=result).replace("path = ''", "u = input()")
    file = launch_py.collect(Text("a.launch.py", program))
    assert [action.target and action.target.texts for action in file.actions if action.kind != "read"] == [(UNKNOWN,)]
