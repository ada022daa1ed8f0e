"""Programs with a branch on a launch argument start, for each value, the same nodes as in Python."""

import pytest

from ros_lint.base.text import Text
from ros_lint.collectors.launch.expand import expand
from ros_lint.collectors.launch.python import collect as launch_py
from ros_lint.collectors.symbolic_text import UNKNOWN

FRAME = """\
from launch import LaunchDescription
from launch.actions import OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

def setup(context):
    name = LaunchConfiguration('flag').perform(context)
    flag = name == 'yes'
{}
    return [Node(package='a', executable=str(value)) for value in values]

def generate_launch_description():
    return LaunchDescription([OpaqueFunction(function=setup)])
"""

# Programs that make a list of values, which depends on ``name``, "yes" or "no", and on whether ``flag`` is true: for "yes".
PROGRAMS = """\
values = ['a', 'b'] if flag else ['c']

some = ['a']
if flag: some.append('b')
values = [f'{x}{y}' for x, y in zip(some, ['1', '2', '3'])]

some = ['a']
if flag: some.append('b')
values = [x + str(i) for i, x in enumerate(some)]

some = ['a']
if flag: some.append('b')
values = list(map(lambda x: x + '1', some))

def more(x):
    made.append(x)
    return x
made, some = [], ['a']
if flag: some.append('b')
for x in map(more, some): pass
values = made

some = ['a']
if flag: some.append('b')
values = list(filter(lambda x: x != 'a', some)) + list(reversed(some)) + sorted(some, reverse=True) + list(set(some))

some = [0]
if flag: some.append(1)
values = [any(some), all(some)]

some = [1]
if flag: some.append(0)
values = [any(some), all(some)]

some = [1, 5]
if flag: some.append(9)
values = [min(some), max(some), sum(some), len(some) > 1]

parts = [['a'], ['b']]
if flag: parts.append(['c', 'd'])
values = sum(parts, [])

from itertools import chain
some = ['a']
if flag: some.append('b')
values = list(chain(some, ['c'], some))

values = ['a', 'b', 'c']
if flag: del values[1]

values = ['a', 'b', 'c']
if flag: del values[:2]

d = {'a': 1, 'b': 2}
if flag: del d['a']
values = [d['b']]

for x in ['a', 'b', 'c']:
    if flag: break
else:
    x = 'none'
values = [x]

values = []
for x in ['a', 'b']:
    if flag: continue
    values.append(x)
values.append('c')

values = []
for x in ['a', 'b', 'c']:
    if flag and x == 'b': break
    values.append(x)

def f():
    if flag: return 'a'
    return 'b'
values = [f()]

def f():
    yield 'a'
    if flag: yield 'b'
values = list(f())

n = 1
def f():
    nonlocal n
    if flag: n = 2
f()
values = [n]

values = [y] if (y := 'a' if flag else '') else ['none']

values = [x for x in ('a', 'b') if flag or x == 'a']

some = ['yes', 'no']
try:
    some.remove(name)
    values = ['removed']
except ValueError:
    values = ['not there']

values = ['ab'[1 if flag else 0], *(['c'] if flag else ['d'])]

d = {**({'x': 'a'} if flag else {'x': 'b'})}
values = [d['x']]

pair = ('a', 'x') if flag else ('b', 'y')
values = [pair == ('a', 'x'), pair[0], pair in [('b', 'y')]]

kind = 'a' if flag else 'b'
values = [(kind, 1) == ('a', 1), [kind] == ['b'], {'k': kind} == {'k': 'a'}, (kind, 1) in [('a', 1)]]

values = [(name, 1) == ('yes', 1), [name] == ['no'], {'k': name} != {'k': 'yes'}]

values = []
for x in ['a', 'b', 'c']:
    if x != 'a':
        if flag: continue
        values.append(x + '1')
    values.append(x)

values = []
for x in ['a', 'b', 'c']:
    if x == 'b':
        if flag: break
    values.append(x)
else:
    values.append('end')
values.append('after')

values = []
for x in ['a', 'b']:
    for y in ['1', '2']:
        if flag: break
        values.append(x + y)
    else:
        continue
    values.append(x)

def f():
    for x in ['a', 'b']:
        if flag: return x
        if x == 'b': break
    return 'none'
values = [f()]

def f():
    for x in ['a', 'b']:
        if x == 'a':
            if flag: return 'left'
            continue
        return x
values = [f()]

def f():
    if name != 'maybe':
        if flag: return 'a'
    return 'b'
values = [f()]

n = 0
for x in ['a', 'b']:
    n += 1
    if flag: continue
    n += 10
values = [n]

x, some = 'start', ['a', 'b', 'c']
while some:
    x = some.pop(0)
    if flag and x == 'b': break
else:
    x = 'end'
values = [x]

values = []
while True:
    if flag: break
    values.append('a')
    if len(values) == 2: break
values.append('b')

values = []
for x in ['a', 'b']:
    try:
        if flag: continue
        values.append(x)
    finally:
        values.append('finally')

values = []
for x in ['a', 'b']:
    if flag:
        values.append(x)
        break
    else:
        continue
    values.append('never')
values.append('after')

x = 'b'
with open('/dev/null') as f:
    if flag: x = 'a'
values = [x]

match ('one' if flag else 'two'):
    case 'one': values = ['a']
    case 'two' | 'three': values = ['b']

i, values = 0, []
while i < 3:
    i += 1
    if flag: continue
    values.append(i)

values = ['a', 'b', 'c']
if flag: values.pop()

values = ['a', 'b', 'c']
if flag: values.append(values.pop(0))
else: values.clear()

values = ['a', 'b']
if flag: values.remove('a')
else: del values[-1]
values.append('c')

values = ['a', 'b', 'c']
if flag: values[:2] = ['x']
else: values[0] = 'y'

queue, values = ['a', 'b', 'c'], []
if flag:
    while queue: values.append(queue.pop())
values += queue

d = {'a': 'x', 'b': 'y'}
if flag: d.pop('a')
values = [d['b']]

names, values = ['a'], ['b']
if flag: names.append('b')
if 'b' in names: values.append('c')
if len(names) > 1: values.append('d')

some, last = ['a'], 'x'
if flag: some.append('b')
for x in some: last = x
values = [last]

some, last = [], 'x'
if flag: some.append('b')
for x in some: last = x
values = [last, 'y' if some else 'z']

some = ['a']
if flag: some.insert(0, 'b')
values = [some[0], some[-1], *some[:1]]

values = sorted({'a', 'b'} - {'b'} | ({'c'} if flag else {'d'}))
"""


@pytest.mark.parametrize("program", PROGRAMS.strip().split("\n\n"))
def test_each_argument_value_starts_what_python_starts(program: str) -> None:
    """Each certain value is one of Python; each value of Python is certain, possible or unknown."""
    body = "".join(f"    {line}\n" for line in program.split("\n"))
    file = launch_py.collect(Text("a.launch.py", FRAME.format(body)))
    for flag in (True, False):
        names: dict[str, object] = {}
        exec(f"def setup(flag, name):\n{body}    return values", names)
        expected = [str(value) for value in names["setup"](flag, "yes" if flag else "no")]  # type: ignore[operator]
        started = expand(file, {"flag": "yes" if flag else "no"}).started
        texts = [text for started in started for text in started.target]
        open_ended = UNKNOWN in "".join(texts) or not all(started.certain and len(started.target) == 1 for started in started)
        certain = [
            text
            for started in started
            if started.certain and len(started.target) == 1
            for text in started.target
            if UNKNOWN not in text
        ]
        assert set(certain) <= set(expected), flag
        assert open_ended or sorted(certain) == sorted(expected), flag
        assert set(expected) <= set(texts) or UNKNOWN in texts, flag
