"""Scripts whose values grow and grow take neither all memory nor all time.

They run in a child process, which may take a gigabyte and some seconds.
"""

from __future__ import annotations

import resource
import signal
import subprocess
import sys
from typing import Final

import pytest

from ros_lint.base.text import Text
from ros_lint.collectors.launch.expand import expand
from ros_lint.collectors.launch.expressions import evaluate
from ros_lint.collectors.launch.python.collect import collect
from ros_lint.collectors.symbolic_text import UNKNOWN
from tests.cmake_runs import run
from tests.setup_scripts import script

pytestmark = pytest.mark.slow

_MEMORY: Final = 1 << 30
_SECONDS: Final = 8.0
"""Of processor time for one script."""


def _loop(rounds: int, body: str) -> str:
    return f"foreach(i RANGE {rounds})\n{body}\nendforeach()\n"


_TEXT: Final = "set(T aaaaaaaa)\n" + _loop(15, 'set(T "${T}${T}")')
"""A variable T of half a million characters, half as many as a value may have."""
_LIST: Final = 'set(L "aa;bb")\n' + _loop(16, "set(L ${L} ${L})")
"""A variable L of 250,000 elements."""

CMAKE: Final = {
    "macro": 'macro(m x)\nm("${x}${x}")\nendmacro()\nm(aaaa)',
    "function in a macro": 'macro(a x)\nfunction(f)\nset(z "'
    + "${x}" * 1000
    + '")\nendfunction()\na("${x}${x}")\nendmacro()\na(aa)',
    "arguments of a function": "function(f)\nf(${ARGV} ${ARGV})\nendfunction()\nf(a b c)",
    "text in a loop": _loop(20_000, 'set(x "${x}' + "a" * 50 + '")'),
    "many texts": _TEXT + _loop(20_000, 'set(v${i} "${T}x")'),
    "many cache entries": _TEXT + _loop(20_000, 'set(v${i} "${T}x" CACHE STRING "")'),
    "many arguments": _TEXT + "set(z " + '"${T}x" ' * 20_000 + ")",
    "many lists": _LIST + "set(z " + "${L} " * 20_000 + ")",
    "transform append": "set(L a a)\n" + _loop(60, 'list(TRANSFORM L APPEND "${L}")'),
    "transform prepend": "set(L a a)\n" + _loop(60, 'list(TRANSFORM L PREPEND "${L}")'),
    "transform replace": "set(L a a)\n" + _loop(60, 'list(TRANSFORM L REPLACE a "${L}")'),
    "concat": _TEXT + "string(CONCAT y " + "${T} " * 20_000 + ")",
    "replace": _TEXT + "string(REPLACE x y z " + "${T} " * 20_000 + ")",
    "match": _TEXT + "string(REGEX MATCHALL x z " + "${T} " * 20_000 + ")",
    "long expressions": _TEXT + _loop(200, 'if(x MATCHES "${T}${i}")\nendif()'),
    "stars": f"set(T {'x' * 20_000})\n" + _loop(2000, 'if(T MATCHES "x*x*x*x*y")\nendif()'),
    "alternatives": f"set(T {'a' * 20_000})\n" + _loop(2000, 'if(T MATCHES "(a|aa)+b")\nendif()'),
    "optional letters": f"set(T {'a' * 400})\n" + _loop(2000, f'if(T MATCHES "{"a?" * 400}{"a" * 400}b")\nendif()'),
    "replacements": f"set(T {'a' * 20_000})\n" + _loop(2000, 'string(REGEX REPLACE "a*a*b" "" U "${T}")'),
    "patterns of folders": f'install(DIRECTORY src DESTINATION a REGEX "{"[a-z/]*" * 9}!" EXCLUDE)\n' * 200,
    "a filter": f"set(L {'a' * 2_000}; {'a' * 2_000})\n" + _loop(2000, 'list(FILTER L EXCLUDE REGEX "a*a*a*b")'),
    "property": _TEXT + _loop(9000, 'set_property(GLOBAL APPEND_STRING PROPERTY q "${T}")'),
    "loops in loops": _LIST + "foreach(x IN LISTS L)\n" * 100 + "set(a b)\n" + "endforeach()\n" * 100,
    "elements": _LIST + _loop(40_000, "if(x IN_LIST L)\nendif()"),
    "sort": _LIST + _loop(20_000, "list(SORT L)"),
    "brackets": 'set(B "[a]")\n' + _loop(16, 'set(B "${B}${B}")') + _loop(20_000, "set(z ${B})"),
    "keywords": _LIST + 'cmake_parse_arguments("${L}" "" "" "${L}" a)',
    "names": "find_package(x)\n" + _TEXT + _loop(2000, "set(c ${${T}${i}})"),
    "hexadecimal": _TEXT + _loop(20_000, 'string(HEX "${T}" c)'),
    "generator expressions": 'string(REPEAT "$<" 400000 p)\n' + _loop(1000, 'string(GENEX_STRIP "${p}" q)'),
    "sums": 'string(REPEAT "1+" 400000 p)\n' + _loop(1000, 'math(EXPR z "${p}1")'),
    "elements that may be missing": "find_package(q)\nif(q_X)\nlist(APPEND l b)\nendif()\nset(z " + '"' + "${l};" * 40_000 + '")',
    "a path of which little is known": 'find_package(q)\ninstall(FILES "a' + "${q_A}a" * 12 + '/b" DESTINATION share)',
    "folders": "foreach(a 1 2 3 4 5 6 7 8)\n" * 8 + "install(DIRECTORY src DESTINATION share)\n" + "endforeach()\n" * 8,
}


_TWO_LISTS: Final = "x = [0]\ny = [0]\n" + "x = [x, x]\ny = [y, y]\n" * 30
_TWO_TUPLES: Final = "x = (0,)\ny = (0,)\n" + "x = (x, x)\ny = (y, y)\n" * 30
"""Each holds the one before twice, so that they have a billion elements in all."""


def _rounds(rounds: int, line: str) -> str:
    return f"for i in range({rounds}):\n    {line}\n"


SETUP: Final = {
    "lists that are compared": f"{_TWO_LISTS}z = x == y\n",
    "tuples that are compared": f"{_TWO_TUPLES}z = x < y\n",
    "an element": f"{_TWO_LISTS}z = x in [y]\n",
    "a key": f"{_TWO_TUPLES}z = {{x: 1}}\n",
    "an element of a set": f"{_TWO_TUPLES}z = {{x}}\n",
    "an index": f"{_TWO_LISTS}z = [y].index(x)\n",
    "a text": f"{_TWO_LISTS}z = str(x)\n",
    "an f-string": f"{_TWO_LISTS}z = f'{{x}}'\n",
    "a template": f"{_TWO_LISTS}z = '%s' % (x,)\n",
    "sorted": f"{_TWO_LISTS}z = sorted([x, y])\n",
    "of two ways": f"{_TWO_LISTS}z = x if os.environ['A'] else y\n",
    "a dictionary": "x = {}\n" + "x = {1: x, 2: x}\n" * 30 + "z = str(x)\n",
    "a method": f"{_TWO_LISTS}z = str(x.append)\n",
    "data files": f"{_TWO_LISTS}setup(name='pkg', data_files=x)\n",
    "entry points": f"{_TWO_LISTS}setup(name='pkg', entry_points={{'console_scripts': x}})\n",
    "a list that holds itself": "x = []\nx.append(x)\nsetup(name='pkg', entry_points={'console_scripts': x})\n",
    "a list of a long text": "x = ['a' * 100000] * 100000\nz = str(x)\n",
    "products": "import itertools\n" + _rounds(900, "z = itertools.product(*([[1, 2]] * 16 + [[1]] * 1000))"),
    "sums": "x = [(0,) * 100] * 1000\n" + _rounds(900, "z = sum(x, ())"),
    "long lists that are compared": "x = [[0] * 90000]\ny = [[0] * 90000]\n" + _rounds(9000, "z = x == y"),
    "words": "x = 'a ' * 50000\ny = []\n" + _rounds(9000, "y.append(x.split())"),
    "a wide field": "z = '%(a)99999999s' % {'a': 1}\n" + _rounds(900, "z = '%s%99999999s' % (z, z)"),
    "a path": "from pathlib import Path\nx = Path('a')\n" + _rounds(40, "x = x / x"),
    "a path of parts": "from pathlib import Path\nx = Path('a')\n" + _rounds(40, "x = x.joinpath(x, x, x)"),
}

_WIDE: Final = "'%(a)999999999s' % {'a': 'x'}"
LAUNCH: Final = {
    "a wide field": f"def generate_launch_description():\n    return [Node(package='a', executable={_WIDE})]\n",
    "a wide field of an expression": f'def generate_launch_description():\n    return [PythonExpression("{_WIDE}")]\n',
    "a wide field of an argument": "def generate_launch_description():\n"
    f'    return [Node(package="a", executable=PythonExpression(["{_WIDE[:-2]}", LaunchConfiguration("a"), "\'}}"]))]\n',
}


def _check(kind: str, name: str) -> None:
    """Run a script in a child process."""
    command = [sys.executable, "-m", "tests.test_bounds", kind, name]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-2000:]


@pytest.mark.parametrize("name", CMAKE)
def test_cmake_scripts_that_grow_end(name: str) -> None:
    _check("cmake", name)


@pytest.mark.parametrize("name", SETUP)
def test_setup_scripts_that_grow_end(name: str) -> None:
    _check("setup", name)


@pytest.mark.parametrize("name", LAUNCH)
def test_launch_files_that_grow_end(name: str) -> None:
    _check("launch", name)


@pytest.mark.parametrize("text", [_WIDE, "'%*d' % (999999999, 1)", "'%.999999999f' % 1"])
def test_an_expression_with_a_wide_field_has_no_value(text: str) -> None:
    assert evaluate(text) == UNKNOWN


if __name__ == "__main__":
    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
    signal.setitimer(signal.ITIMER_PROF, _SECONDS)
    if sys.argv[1] == "cmake":
        run(CMAKE[sys.argv[2]], ("a" * 200 + "/c", *(f"src/{number}.cpp" for number in range(1000))))
    elif sys.argv[1] == "launch":
        head = "from launch.substitutions import LaunchConfiguration, PythonExpression\nfrom launch_ros.actions import Node\n"
        expand(collect(Text("a.launch.py", head + LAUNCH[sys.argv[2]])), {"a": "x"})
    else:
        script(SETUP[sys.argv[2]])
