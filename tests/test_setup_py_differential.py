"""The interpreter of setup.py files, compared with Python on programs without anything unknown."""

import pytest

from tests.python_programs import EXPRESSIONS, IMPORTS, OPEN_EXPRESSIONS, OPEN_PROGRAMS, PROGRAMS, values
from tests.setup_scripts import script

pytestmark = pytest.mark.slow

HEAD = f"from setuptools import setup\n{IMPORTS}"
ALL = [
    *[f"values = [{expression}]" for block in (EXPRESSIONS, OPEN_EXPRESSIONS) for expression in block.strip().split("\n")],
    *[program for block in (PROGRAMS, OPEN_PROGRAMS) for program in block.strip().split("\n\n")],
]

# Programs whose values the interpreter of setup.py files knows.
KNOWN = """\
values = [y := 3, y]

import sys
try:
    sys.exit(1)
except Exception:
    values = ['caught']
except SystemExit:
    values = ['left']

try:
    raise KeyError('x')
except IndexError:
    values = ['index']
except (ValueError, LookupError) as error:
    values = ['lookup']

try:
    try:
        values = [{}['x']]
    finally:
        before = 'finally'
except KeyError:
    values = ['key', before]

def f():
    try:
        return 'try'
    finally:
        done.append('finally')
done = []
values = [f(), *done]

values = [sorted({x % 2 for x in range(5)}), {x: x * x for x in range(2)}, sum([[1], [2]], []), sum([1, 2]), isinstance('a', str)]

x = 'a'
try:
    x += 1
except TypeError:
    x = 'caught'
values = [x]

values = [isinstance([], (str, tuple)), isinstance(True, int), print('x'), ~5]

def outer():
    n = 0
    def inner():
        nonlocal n
        n += 1
        return n
    inner()
    return inner(), n
values = [outer()]

total = 0
def add(x):
    global total
    total += x
add(1)
add(2)
values = [total]
"""


def _version(program: str) -> str:
    """Return the values, joined, as the version that setup() is given; "" if the interpreter does not know them."""
    found = script(f"{program}\nsetup(name='pkg', version='|'.join([str(value) for value in values]))", head=HEAD)
    assert not found.problems
    return found.project.version


@pytest.mark.parametrize("program", ALL)
def test_values_are_those_of_python_or_unknown(program: str) -> None:
    assert _version(program) in ("|".join(values(program)), "")


@pytest.mark.parametrize("program", KNOWN.strip().split("\n\n"))
def test_values_are_those_of_python(program: str) -> None:
    assert _version(program) == "|".join(values(program))


def test_most_values_are_known() -> None:
    known = sum(_version(program) == "|".join(values(program)) for program in ALL)
    assert known > 0.7 * len(ALL)
