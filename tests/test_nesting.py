"""Texts that nest deeply, in each format that is read by a recursive library: the run ends soon, and with no signal."""

import json
import subprocess
import sys
import time
from pathlib import Path

import pytest

from ros_lint.base.text import Text
from ros_lint.collectors.python.syntax import NotPythonError, TooDeepError, parse

pytestmark = pytest.mark.slow

DEPTHS = (10, 60, 300, 1_500, 10_000, 100_000)
_SECONDS = 20
"""How long six depths of one form may take, on a slow machine."""

PYTHON = {
    "lists": lambda n: "x = " + "[" * n + "]" * n,
    "brackets that are not closed": lambda n: "x = " + "(" * n,
    "attributes": lambda n: "x = a" + ".b" * n,
    "calls": lambda n: "x = f" + "()" * n,
    "subscripts": lambda n: "x = f" + "[0]" * n,
    "methods": lambda n: "x = f" + ".a(b, c=1)[0]" * n,
    "signs": lambda n: "x = " + "-" * n + "1",
    "not": lambda n: "x = " + "not " * n + "a",
    "lambda": lambda n: "x = " + "lambda a, b: " * n + "a",
    "powers": lambda n: "x = " + "2**" * n + "1",
    "sums": lambda n: "x = " + "1+" * n + "1",
    "texts": lambda n: "x = (\n" + "'a' +\n" * n + "'b')",
    "conditions": lambda n: "x = " + "1 if a else " * n + "2",
    "elif": lambda n: "if a: pass\n" + "elif b: pass\n" * n,
    "await": lambda n: "async def f():\n  x = " + "await " * n + "b",
    "f-strings": lambda n: "x = " + "f'{" * n + "1" + "}'" * n,
    "formats": lambda n: "x = f'" + "{a:" * n + "1" + "}" * n + "'",
    "indentation": lambda n: "".join(" " * i + "if a:\n" for i in range(min(n, 2_000))) + " " * min(n, 2_000) + "pass\n",
    "patterns": lambda n: "match x:\n  case " + "[" * n + "]" * n + ": pass\n",
    "type parameters": lambda n: "def f[T: " + "a[" * n + "]" * n + "](): pass\n",
    "a line that is wrong": lambda n: "x = " + "(a, " * min(n, 90) + ")" * min(n, 90) + " y\n" + "z = [1]\n" * n,
}
YAML = {
    "lists": lambda n: "a: " + "[" * n + "]" * n,
    "lists that are not closed": lambda n: "a: " + "[" * n,
    "mappings": lambda n: "a: " + "{a: " * n + "}" * n,
    "dashes": lambda n: "a:\n- " + "- " * n + "a",
    "keys": lambda n: "a:\n  " + "? " * n + "a",
    "indentation": lambda n: "".join(" " * i + "a:\n" for i in range(min(n, 2_000))),
    "quoted brackets": lambda n: "a: " + '["]", ' * n + "]" * n,
    "aliases": lambda n: "a: &v0 [b]\n" + "".join(f"b{i}: &v{i} [*v{i - 1}, *v{i - 1}]\n" for i in range(1, min(n, 5_000))),
}
_PACKAGE = """<package format="3">
  <name>{name}</name><version>0.1.0</version><description>d</description>
  <maintainer email="a@b.org">A</maintainer><license>Apache-2.0</license>
  <export><build_type>{kind}</build_type></export>
</package>
"""
_LAUNCH = "\n\ndef generate_launch_description():\n    return LaunchDescription([Node(package='a', executable='b')])\n"
_OPENS = """import os
import yaml
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    with open(os.path.join(os.path.dirname(__file__), 'a.yaml')) as file:
        values = yaml.safe_load(file)
    return LaunchDescription([Node(package='a', executable='b', parameters=[values, {'c': str(values)}])])
"""


def lint(root: Path) -> tuple[int, dict[str, str]]:
    """Return the exit code of a run in a process of its own, and why files are not checked."""
    command = [sys.executable, "-m", "ros_lint", str(root), "--no-cache", "--jobs", "1", "--format", "json", "--distro", "jazzy"]
    done = subprocess.run(command, capture_output=True, timeout=_SECONDS, check=False)
    assert done.returncode in (0, 1), (done.returncode, done.stderr.decode()[-2_000:])
    report = json.loads(done.stdout)
    assert not report["crashes"]
    return done.returncode, {entry["what"]: entry["reason"] for entry in report["not_checked"]}


def write(root: Path, files: dict[str, str]) -> None:
    for name, text in files.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)


@pytest.mark.parametrize("form", PYTHON)
def test_python(tmp_path: Path, form: str) -> None:
    """As setup.py, as a launch file and as a module."""
    begun = time.monotonic()
    for depth in DEPTHS:
        code = PYTHON[form](depth) + "\n"
        name = f"p{depth}"
        write(
            tmp_path / name,
            {
                "package.xml": _PACKAGE.format(name=name, kind="ament_python"),
                "setup.py": f"from setuptools import setup\n{code}setup(name='{name}')\n",
                "launch/a.launch.py": f"from launch import LaunchDescription\n{code}{_LAUNCH}",
                f"{name}/__init__.py": f"import rclpy; import os\nif a: import b\n{code}",
            },
        )
    _, unchecked = lint(tmp_path)
    assert not any("failed on it" in reason for reason in unchecked.values()), unchecked
    assert time.monotonic() - begun < _SECONDS


@pytest.mark.parametrize("form", YAML)
def test_yaml(tmp_path: Path, form: str) -> None:
    """As colcon.pkg and colcon.meta, as a launch file, as a value in one and as a file of parameters that one opens."""
    begun = time.monotonic()
    for depth in DEPTHS:
        text = YAML[form](depth) + "\n"
        name = f"p{depth}"
        value = text.removeprefix("a:").strip().replace("&", "&amp;").replace('"', "&quot;")
        write(
            tmp_path / name,
            {
                "package.xml": _PACKAGE.format(name=name, kind="ament_cmake"),
                "CMakeLists.txt": f"project({name})\nfind_package(ament_cmake REQUIRED)\nament_package()\n",
                "colcon.pkg": text,
                "launch/a.launch.yaml": "launch:\n- arg:\n    default:\n      " + text.replace("\n", "\n      ") + "\n",
                "launch/b.launch.xml": f'<launch><node pkg="a" exec="b"><param name="c" value="{value}"/></node></launch>',
                "launch/c.launch.py": _OPENS,
                "launch/a.yaml": text,
                "config/a.yaml": f"{text}# ros-lint: ignore[unused-dependency]\n",
            },
        )
    write(tmp_path, {"colcon.meta": YAML[form](DEPTHS[-1]) + "\n"})
    _, unchecked = lint(tmp_path)
    assert not any("failed on it" in reason for reason in unchecked.values()), unchecked
    assert {f"p{DEPTHS[-1]}/colcon.pkg", f"p{DEPTHS[-1]}/launch/a.launch.yaml"} <= unchecked.keys() or "not closed" in form
    assert time.monotonic() - begun < _SECONDS


@pytest.mark.parametrize(
    ("code", "reason", "place"),
    [
        ("x = 1\ny = a" + ".b" * 201, "expressions nested more than 200 levels deep", "a.py:2:406"),
        ("x = " + "-" * 201 + "1", "expressions nested more than 200 levels deep", "a.py:1:205"),
        ("if a: pass\n" + "elif b: pass\n" * 201, "more than 200 branches in a row", "a.py:202:1"),
        ('x = f"{' + "-" * 201 + 'a["b"]}"', "expressions nested more than 200 levels deep", "a.py:1:7"),
        ("type X = int\ny = 0x" + "f" * 1_001, "a number of more than 1,000 digits", "a.py:2:5"),
        ('x = f"' + '{f"' * 7 + "1" + '"}' * 7 + '"', "f-strings nested more than 5 levels deep", "a.py:1:23"),
    ],
)
def test_what_exceeds_a_bound_has_a_reason_and_a_place(code: str, reason: str, place: str) -> None:
    with pytest.raises(TooDeepError) as caught:
        parse(Text("a.py", code + "\n"))
    assert (caught.value.message, str(caught.value.span)) == (reason, place)


@pytest.mark.parametrize(
    "code",
    [
        "x = a" + ".b" * 199,
        "x = [" + "f(a.b.c, d=-1),\n" * 500 + "]",
        "x = {" + "'a': lambda a, b: a.b,\n" * 500 + "}",
        "x = (" + " and ".join(["a"] * 199) + ")",
        "if a: pass\n" + "elif b: pass\n" * 200,
        "if a:\n  pass\n" + "elif b.c:\n  pass\n" * 150 + "if a:\n  pass\n" + "elif b.c:\n  pass\n" * 150,
        "x = f(" + "a=b.c,\n" * 1_000 + ")\n" + "y = 1 + 2\n" * 1_000,
        "def f(a, " + "".join(f"b{n}=c.d, " for n in range(300)) + "): pass\n",
    ],
)
def test_what_is_long_is_not_deep(code: str) -> None:
    try:
        parse(Text("a.py", code + "\n"))
    except NotPythonError:
        pytest.fail("it is refused")
