"""Python sources under every interpreter: the same trees, constructs, messages and places, which stand here in full."""

import ast
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from ros_lint.base.text import Text
from ros_lint.collectors.launch.presence_checks import DISTRIBUTIONS
from ros_lint.collectors.python.syntax import NotPythonError, parse, read, refusal
from ros_lint.collectors.python.versions import PYTHON_OF, too_new
from ros_lint.workspace.target import TargetDistro

pytestmark = pytest.mark.slow

NEWER = [
    ("def f[T](x: T) -> T: pass", "type parameter lists", (3, 12), "1:6"),
    ("class A[T: int, *Ts, **P](B[T]): pass", "type parameter lists", (3, 12), "1:8"),
    ("async def f[\n  T,  # é\n](x): pass", "type parameter lists", (3, 12), "1:12"),
    ("type X = int", "type statements", (3, 12), "1:1"),
    ("if a: type X[T] = list[T]", "type statements", (3, 12), "1:7"),
    ("class A[T = int]: pass", "defaults of type parameters", (3, 13), "1:11"),
    ('x = f"{d["a"]}"', "f-strings with their own quotes inside", (3, 12), "1:5"),
    ("x = f'{\"\\n\".join(a)}'", "f-strings with backslashes in braces", (3, 12), "1:5"),
    ('x = f"{\n a}"', "f-strings with line breaks in braces", (3, 12), "1:5"),
    ('x = f"""{a # é\n}"""', "f-strings with comments in braces", (3, 12), "1:5"),
    ('x = f"{a:{b:{c}}}"', "f-strings with nested format specifications", (3, 12), "1:5"),
    ('x = f"{a!r }"', "f-strings with blanks after a conversion", (3, 12), "1:5"),
    ('x = f"{f"{a}"}"', "f-strings with their own quotes inside", (3, 12), "1:5"),
    ("try: pass\nexcept* A: pass", "except* clauses", (3, 11), "2:1"),
    ("try: pass\nexcept A, B: pass", "except clauses with several types and no parentheses", (3, 14), "2:9"),
    ("try: pass\nexcept a.b, C(d), E:  # é\n  pass", "except clauses with several types and no parentheses", (3, 14), "2:11"),
    ("a[*b]", "starred expressions in subscripts", (3, 11), "1:3"),
    ("x = a[b(1, 2), *c] = 1", "starred expressions in subscripts", (3, 11), "1:16"),
    ("def f(*a: *T): pass", "starred annotations", (3, 11), "1:11"),
    ('x = t"{a}"', "template strings", (3, 14), "1:5"),
    ("lazy import a", "lazy imports", (3, 15), "1:1"),
    ("[*a for a in b]", "comprehensions that unpack", (3, 15), "1:2"),
]
OLD = [
    "type = 1; type(x); type in y",
    "match = 1; case = 2; lazy = 3",
    "match x:\n  case [*a, b]: pass",
    "x = [*a, *b]; f(*a, **b); {**a}; {*a}; a[1:2, 3] * b",
    "try: pass\nexcept (A, B) as e: pass",
    "x = f'{d[\"a\"]}' f\"{a!r:>{b}}\" f'''\n{a}''' rf'\\{a}'",
    "with (a as b, c as d): pass",
    "x = f'{a, b}{*a, b}{(yield)}{a:=5}{(a:=5)}{a=}{a!=b}'",
    "def f(a, /, *, b=1, **c) -> 'x': pass",
    "print(a) if b else [c for d in e if f for g in h]",
    "x = '\\N{EM DASH}' u'b'",
]


def newer(code: str) -> list[tuple[str, tuple[int, int], str]]:
    found = read(Text("a.py", code + "\n")).newer
    return [(one.construct, one.version, f"{one.span.line}:{one.span.column}") for one in found]


@pytest.mark.parametrize(("code", "construct", "version", "place"), NEWER)
def test_what_came_later(code: str, construct: str, version: tuple[int, int], place: str) -> None:
    assert (construct, version, place) in newer(code)
    assert all(version >= one for _, one, _ in newer(code))


@pytest.mark.parametrize("code", OLD)
def test_what_did_not(code: str) -> None:
    assert newer(code) == []


def test_every_distribution_has_a_python() -> None:
    assert set(PYTHON_OF) == set(DISTRIBUTIONS)


@pytest.mark.parametrize("distro", PYTHON_OF)
@pytest.mark.parametrize(("code", "construct", "version", "place"), NEWER)
def test_constructs_by_distribution(distro: str, code: str, construct: str, version: tuple[int, int], place: str) -> None:
    syntax = read(Text("a.py", code + "\n")).newer
    runs = {"humble": "3.10", "jazzy": "3.12", "kilted": "3.12", "lyrical": "3.14", "rolling": "3.14"}[distro]
    said = f"{construct} need Python {version[0]}.{version[1]}; {distro} runs {runs}"
    found = [problem.message for problem in too_new(syntax, distro)]
    assert (said in found) == (tuple(map(int, runs.split("."))) < version)
    assert not list(too_new(syntax, TargetDistro(distro, "newest", explicit=False).chosen))


@pytest.mark.parametrize(
    ("code", "tree"),
    [
        ('x = f"é{d["a"]!r:>{w}}b" "c"; z', "x = f'é{d['a']!r:>{w}}bc'\nz"),
        ("type X[T] = int; z", "X = None\nz"),
        ("def f[T, *Ts](x: T): pass", "T = None\nTs = None\ndef f(x: T):\n    pass"),
        ("try: pass\nexcept* A: z", "try:\n    pass\nexcept A:\n    z"),
        ("try: pass\nexcept A, B: z", "try:\n    pass\nexcept (A, B):\n    z"),
        ("a[*b, c]; z", "a[b, c]\nz"),
        ('x = t"{a}"; z', "x = f'{a}'\nz"),
        ('x = f"{a = }{b!s}{{}}{"\\n"}"; z', "x = f'a = {a!r}{b!s}{{}}{'\\n'}'\nz"),
        ("lazy import a; z", "0\nimport a\nz"),
    ],
)
def test_the_tree_says_what_the_source_says(code: str, tree: str) -> None:
    found = parse(Text("a.py", code + "\n"))
    assert shape(found) == shape(ast.parse(tree)) if sys.version_info >= (3, 12) else found.body
    for node in ast.walk(found):
        if isinstance(node, ast.Name) and node.id == "z":
            lines = code.split("\n")
            assert lines[node.lineno - 1].encode()[node.col_offset : node.end_col_offset] == b"z"


def shape(tree: ast.AST) -> str:
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr):  # Python 3.12 has empty texts in format specifications
            node.values = [part for part in node.values if not isinstance(part, ast.Constant) or part.value]
    return ast.dump(tree).replace(", type_params=[]", "")


@pytest.mark.parametrize(
    "code",
    [
        'x = f"é{ü["a"]} {bb:{w}}" f"""\n{c}\né{d + e}"""; z = bb',
        'f"{\n  a["b"]\n} é {c}"; z',
        "def f[Té](bb: int) -> c:\n  return bb[c, *d]",
        'try: pass\nexcept é, bb("c", d):\n  bb; é',
        'x = "é" f"{bb}" "ü" f"{c["d"]}", z',
        "class A[\n  Té,\n  U,\n](bb):\n  z = bb",
        'x = f"{f"{f"{bb}"}"}"; z',
        'f"{(lambda z: bb)(c["d"])} {z=}"',
        'x = f"{bb["a"]}"\ny = f"{bb["a"]}"\nz',
    ],
)
def test_names_stand_in_their_places(code: str) -> None:
    lines = (code + "\n").split("\n")
    names = [node for node in ast.walk(parse(Text("a.py", code + "\n"))) if isinstance(node, ast.Name)]
    for node in names:
        if node.id not in ("Té", "U") or not isinstance(node.ctx, ast.Store):  # names of type parameters are bound at the head
            assert lines[node.lineno - 1].encode()[node.col_offset : node.end_col_offset].decode() == node.id
    assert any(node.id in ("bb", "z") for node in names)


_COMMA = "is not expected here; is a comma or an operator missing before it?"
REFUSED = [
    ("Node(package='a' executable='b')", 1, 18, f'"executable" {_COMMA}'),
    ("x = [\n  'é' 'b'\n  c]", 3, 3, f'"c" {_COMMA}'),
    ("def f(:\n  pass", 1, 6, '"(" is not closed'),
    ("x = (1,\ny = 2", 1, 5, '"(" is not closed'),
    ("x = [1)", 1, 7, '")" does not close "["'),
    ("x = 1)", 1, 6, '")" closes nothing'),
    ("x = 'abc\ny = 1", 1, 5, "this string is not closed"),
    ("x = '''abc\n", 1, 5, "this string is not closed"),
    ('x = f"{a["b"]"', 1, 14, "this string is not closed"),
    ("x = f'{a b}'", 1, 8, "a b is not an expression"),
    ("x = f'{}'", 1, 7, "an f-string has an empty expression"),
    ("x = f'{a!z}'", 1, 9, "a conversion of an f-string is !a, !r or !s"),
    ("x = f'a}'", 1, 8, 'a single "}" in an f-string'),
    ("if x:\npass", 2, 1, 'an indented block is missing after this "if"'),
    ("def f():\n", 1, 9, 'an indented block is missing after this "def"'),
    ("x = 1\n  y = 2", 2, 3, "this line is indented too far"),
    ("if x:\n    y\n  z", 3, 3, "the indentation does not match any line above"),
    ("if x:\n\ty\n        z", 3, 9, "tabs and blanks are mixed in the indentation"),
    ("for x in y\n  pass", 1, 11, '":" is missing at the end of the line'),
    ("x = 1 +\n", 1, 8, "the line ends too early"),
    ("x = 5a", 1, 5, "this is no number"),
    ("x = 07", 1, 5, "this is no number"),
    ("x = $", 1, 5, "Python has no such character"),
    ("x = “a”", 1, 5, "Python has no such character"),
    ("x = 1\0", 1, 6, "Python has no such character"),
    ("x = 1  # \0", 1, 10, "Python has no such character"),
    ("x = \\ 1", 1, 5, "only the end of a line may stand after a backslash"),
    ("<<<<<<< HEAD\nx = 1\n=======\nx = 2\n>>>>>>> b", 1, 1, "this merge conflict is not resolved"),
    ("print 'hello'", 1, 7, "'hello' is not expected here; print is a function"),
    ("1 = x", 1, 3, '"=" is not expected here'),
    ("f(a=1, 2)", 1, 8, '"2" is not expected here'),
    ("x = b'é'", 1, 5, "bytes have letters of ASCII only"),
    ("x = '\\x1'", 1, 5, "an escape in this string is invalid"),
    ("x = 'a' b'b'", 1, 9, "a bytes literal cannot be next to a string literal"),
    ("x = '\udcff'", 1, 5, "a byte of this string is not valid UTF-8"),
    ("try: pass\nexcept OSError, e: pass", 2, 15, 'this is Python 2; write "as e"'),
    ("x = 1\n" * 30_000 + "y 1", 30_001, 3, f'"1" {_COMMA}'),
]


@pytest.mark.parametrize(("code", "line", "column", "message"), REFUSED)
def test_what_is_no_python(code: str, line: int, column: int, message: str) -> None:
    source = Text("a.py", code + ("" if code.endswith("\n") else "\n"))
    with pytest.raises(NotPythonError) as caught:
        parse(source)
    found = refusal(source, caught.value)
    assert (found.message, found.span.line, found.span.column, found.known) == (message, line, column, True)


def test_bytes_that_are_no_utf_8_in_a_comment_are_python() -> None:
    assert len(parse(Text("a.py", "# \udce9t\udce9\nx = 1\n")).body) == 1


_FILES = {
    "package.xml": """<package format="3">
  <name>robot</name><version>0.1.0</version><description>d</description>
  <maintainer email="a@b.org">A</maintainer><license>Apache-2.0</license>
  <exec_depend>launch</exec_depend><exec_depend>launch_ros</exec_depend><exec_depend>demo_nodes_cpp</exec_depend>
  <export><build_type>ament_python</build_type></export>
</package>
""",
    "setup.py": """from glob import glob
from setuptools import setup

about = {'name': 'robot'}
setup(
    name=f'{about['name']}', version='0.1.0', packages=['robot'],
    data_files=[('share/robot/launch', glob('launch/*'))],
)
""",
    "robot/__init__.py": "",
    "launch/a.launch.py": "def generate_launch_description():\n    return LaunchDescription([a b])\n",
    "launch/b.launch.py": "from launch import LaunchDescription\ndef generate_launch_description():\n"
    "    for _ in []:\n        pass\n    with open('a'):\n        break\n    return LaunchDescription([])\n",
    "launch/c.launch.py": "from launch import LaunchDescription\nfrom launch_ros.actions import Node\n"
    "type Name = str\ndef generate_launch_description():\n    d = {'a': 'demo_nodes_cpp'}\n"
    '    return LaunchDescription([\n        Node(package=f"{d["a"]}",\n'
    "             executable=f'{d[\"b\"]!r:>3}{'er'}'),\n        Node(package=Name)])\n",
    "launch/d.launch.py": "x = " + "-" * 300 + "1\ndef generate_launch_description():\n    pass\n",
    "launch/e.launch.py": "from launch import LaunchDescription\ndef generate_launch_description():\n"
    "    return LaunchDescription([f'''\n\U0001fae8\U0001e08f {undefined}'''])\n",
}
_EXPECTED = """\
robot: 5 findings

error[ROS506 launch-invalid]: not valid Python: "b" is not expected here; is a comma or an operator missing before it?
 --> launch/a.launch.py:2:33
  |
2 |     return LaunchDescription([a b])
  |                                 ^

error[ROS506 launch-invalid]: not valid Python: 'break' outside loop
 --> launch/b.launch.py:6:9
  |
6 |         break
  |         ^

error[ROS506 launch-invalid]: type statements need Python 3.12; humble runs 3.10
 --> launch/c.launch.py:3:1
  |
3 | type Name = str
  | ^^^^
... |
7 |         Node(package=f"{d["a"]}",
  |                      ----------- f-strings with their own quotes inside need Python 3.12; humble runs 3.10
8 |              executable=f'{d["b"]!r:>3}{'er'}'),
  |                         ---------------------- f-strings with their own quotes inside need Python 3.12; humble runs 3.10

error[ROS506 launch-invalid]: 'undefined' is not defined; define or import it
 --> launch/e.launch.py:4:5
  |
4 | \U0001fae8\U0001e08f {undefined}'''])
  |     ^^^^^^^^^

error[ROS312 invalid-build-script]: f-strings with their own quotes inside need Python 3.12; humble runs 3.10
 --> setup.py:6:10
  |
6 |     name=f'{about['name']}', version='0.1.0', packages=['robot'],
  |          ^^^^^^^^^^^^^^^^^^

Found 5 errors in 1 package for humble (--distro); package index of 2026-08-22.
"""


def test_a_run_gives_the_same_bytes_under_every_python(tmp_path: Path) -> None:
    for name, text in _FILES.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    command = [sys.executable, "-m", "ros_lint", str(tmp_path), "--distro", "humble", "--no-cache", "--select"]
    rules = "launch-invalid,invalid-build-script,launch-unknown-executable"
    environment = {**os.environ, "PYTHONUTF8": "1"}
    done = subprocess.run([*command, rules], capture_output=True, check=False, cwd=tmp_path, env=environment)
    assert done.stdout.decode().partition("Not fully analysed")[0] == _EXPECTED
    done = subprocess.run([*command, rules, "--format", "json"], capture_output=True, check=False, cwd=tmp_path)
    assert [entry["what"] for entry in json.loads(done.stdout)["not_checked"]] == ["launch/d.launch.py"]
