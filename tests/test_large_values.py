"""YAML that a launch file parses, and integers of more digits than Python writes: no value ends the reading of a file."""

import pytest

from ros_lint.base.safe_yaml import YamlBoundError, load
from ros_lint.base.text import Text
from ros_lint.collectors import symbolic_text as launch_text
from ros_lint.collectors.colcon import python_project as colcon_python
from ros_lint.collectors.launch import collect as launch_files
from ros_lint.collectors.launch.python import collect as launch_py
from ros_lint.collectors.python import collect as python
from ros_lint.collectors.setup_py import evaluate as setup_py

HEAD = """\
import json
import os
import yaml
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
"""
DIGITS = "9" * 4_000
HEX = "0x" + "f" * 900


def collect(body: str, files: dict[str, str] | None = None) -> list[tuple[str, str]]:
    """Return the nodes of a launch file."""
    text = HEAD + "".join(f"    {line}\n" for line in body.splitlines())
    found = launch_py.collect(Text("a.launch.py", text), files=(files or {}).get)
    return [(one.package, one.name) for one in found.references if one.kind == "node"]


@pytest.mark.parametrize("parser", ["yaml.safe_load", "yaml.load", "json.loads"])
def test_a_literal_is_parsed(parser: str) -> None:
    body = f"""values = {parser}('{{"rate": 10, "nodes": ["b", "c"]}}')
return LaunchDescription([Node(package='a', executable=name) for name in values['nodes']])"""
    assert collect(body) == [("a", "b"), ("a", "c")]


DOUBLED = "x0: &x0 [b]\n" + "".join(f"x{n}: &x{n} [*x{n - 1}, *x{n - 1}]\n" for n in range(1, 30))


@pytest.mark.parametrize("text", ["[" * 50_000, "- " * 50_000, "&a [*a]", DOUBLED])
def test_what_exceeds_a_bound_is_not_known(text: str) -> None:
    body = """with open(os.path.join(get_package_share_directory('p'), 'a.yaml')) as file:
    values = yaml.safe_load(file)
return LaunchDescription([Node(package='a', executable='b', parameters=[values, str(values)])])"""
    with pytest.raises(YamlBoundError):
        load(text)
    assert collect(body, {f"{launch_text.share('p')}/a.yaml": text}) == [("a", "b")]


ODD = ("!!int ''", "!!bool x", "!!timestamp x", "!!float ''", f"0x{'f' * 5_000}", "9" * 5_000, "2001-99-99")


@pytest.mark.parametrize("text", ODD)
def test_values_that_yaml_cannot_make(text: str) -> None:
    source = Text("a.launch.yaml", f"launch:\n- let:\n    name: a\n    value: {text}\n- node: {{pkg: a, exec: b}}\n")
    assert [one.name for one in launch_files.collect(source, "yaml").references] == ["b"]
    value = text.replace("'", "&apos;")
    source = Text("a.launch.xml", f'<launch><node pkg="a" exec="b"><param name="c" value="{value}"/></node></launch>')
    assert [one.name for one in launch_files.collect(source, "xml").references] == ["b"]
    assert len(collect(f'x = yaml.safe_load("{text}")\nreturn LaunchDescription([Node(package="a", executable="b")])')) < 2


VALUES = (
    DIGITS,
    "9" * 5_000,
    HEX,
    "0x" + "f" * 5_000,
    "10 ** 5_000",
    "1 << 99_999",
    f"int('{DIGITS}') * int('{DIGITS}')",
    f"{HEX} * {HEX}",
    f"yaml.safe_load('0x{'f' * 5_000}')",
)
USES = (
    "str(x)",
    "f'{x}'",
    "f'{x:d}'",
    "'%d' % x",
    "'%*d' % (x, 1)",
    "'{}'.format(x)",
    "x * x",
    "[x]",
    "{x: x}",
    "'a' * x",
    "'a'.center(x)",
    "'a'.replace('a', 'b', x)",
    "range(x)",
    "float(x)",
    "x / 3",
    "'a'[x]",
    "'abc'[:x]",
)


@pytest.mark.parametrize("value", VALUES, ids=range(len(VALUES)))
@pytest.mark.parametrize("use", USES)
def test_integers_of_many_digits(value: str, use: str) -> None:
    assigned = f"x = {value}\ny = {use}\n"
    collect(f"{assigned}return LaunchDescription([Node(package='a', executable=f'{{y}}', parameters=[{{'a': y}}])])")
    script = f"from setuptools import setup\n{assigned}setup(name='a', version=f'{{y}}', description=y, keywords=[str(y)])\n"
    setup_py.evaluate("a", "a", ["setup.py"], Text("a/setup.py", script), None, None)
    colcon_python.from_setup_py(Text("a/setup.py", script), None, None)
    asks = "get_package_share_directory(f'{x}')\nimport_module(x)\nif a: import b\n"
    python.collect(Text("a.py", f"import a; x = {value}\n{asks}"))


@pytest.mark.parametrize(
    "text",
    [
        "tool = 1",
        "project = 1",
        "[tool]\nsetuptools = 1",
        "a = " + "[" * 100_000,
        f"[project]\nname = 0x{'f' * 5_000}\nversion = {'9' * 5_000}",
        f"[project.scripts]\na = 0x{'f' * 5_000}",
        "[project]\nentry-points = 1\nscripts = 1\n[tool.setuptools]\npackages = 1\ndata-files = 1",
        "[tool.setuptools.data-files]\na = 1\nb = [1]",
    ],
)
def test_projects_of_another_shape(text: str) -> None:
    cfg, project = Text("a/setup.cfg", "[metadata]\nname = a\n"), Text("a/pyproject.toml", text + "\n")
    assert setup_py.evaluate("a", "a", ["setup.cfg"], None, cfg, project).project.name == "a"
    assert colcon_python.from_setup_py(Text("a/setup.py", "setup(a=1)\n"), None, project).name == ""
