"""Expressions and programs without anything unknown, and what Python makes of them."""

IMPORTS = """\
import collections, copy, functools, itertools, json, math, numbers, os, re, typing
from pathlib import Path, PurePosixPath
"""

# Expressions whose values the interpreter of launch files knows.
EXPRESSIONS = r"""
list(zip('ab', [1, 2, 3], (True, None)))
[f'{a}{b}' for a, b in zip(['x', 'y'], range(5))]
list(reversed(['a', 'b']))
list(reversed(range(3)))
list(reversed('ab'))
[*reversed((1, 2))]
list(filter(None, ['a', '', 0, 1, None]))
list(filter(lambda x: x > 1, [1, 2, 3]))
any([])
all([])
any([0, 1])
all([0, 1])
any(x > 1 for x in (1, 2))
all(x > 1 for x in (1, 2))
any([''])
all(['a'])
min(2, 1)
max(2, 1)
min([3, 2.5])
max((3, 2))
min('b', 'a')
max(['b', 'c'])
max('ab')
max('a', 'bb', key=len)
max([], default=7)
min([], default='x')
max(x for x in (1, 3, 2))
sum([1, 2])
sum([1, 2], 10)
sum([])
sum((0.5, 1))
sum([[1], [2]], [])
sum([[1], [2]], [0])
sum([1], start=2)
sorted([3, 1, 2])
sorted('bca')
sorted([3, 1, 2], reverse=True)
sorted(['bb', 'a', 'ccc'], key=len)
sorted({'b': 1, 'a': 2})
sorted([(2, 'a'), (1, 'b')])
sorted([{'n': 2}, {'n': 1}], key=lambda d: d['n'])
list(tuple('ab'))
list(tuple())
tuple([1, 2])
tuple(range(2))
tuple({'a': 1})
len({1, 2, 2})
len(set('aab'))
sorted(set(['b', 'a', 'b']))
1 in {1}
len(frozenset([1, 1]))
len(set())
[x for x in {'a', 'a'}]
sorted({c for c in 'abca'})
len({i % 2 for i in range(5)})
int('7')
int(3.9)
int()
int('10', 2)
int('ff', 16)
int('z', base=36)
float('1.5')
float()
bool('')
bool()
int(True)
str()
str(1.0)
str(None)
str(True)
str([1, 'a'])
str({'a': 1})
str((1,))
str(('a', 2))
7 // 2
-7 // 2
7 % 3
-7 % 3
7 / 2
6 & 3
6 | 3
6 ^ 3
-3
+3
not 1
2 * 'a'
[0] * 2
1.5 * 2
'a' + 'b'
[1] + [2]
(1,) + (2,)
'a' * 3
3 * [1]
'a' * 0
'a' * -1
{'a': 1} | {'b': 2}
{'a': 1} | {'a': 3}
1 < 2 < 3
1 < 3 < 2
1 == 1.0
'a' < 'b'
[1, 2] < [1, 3]
(1, 2) == (1, 2)
{'a': 1} == {'a': 1}
1 != 2
None is None
'a' in 'abc'
'd' not in 'abc'
1 in [1]
'a' in {'a': 1}
2 in (1,)
2 in range(3)
None in [None]
'a' in ['b']
1.0 in [1]
1 and 0
0 or 'a'
None or 0
'a' and 'b'
not []
not 'a'
1 if [] else 2
[] or {} or 'x'
1 and 2 and 3
isinstance('a', str)
isinstance(1, (int, str))
isinstance(True, int)
isinstance(1, bool)
isinstance([], (list, tuple))
isinstance(None, str)
isinstance({}, dict)
isinstance(1.5, int)
isinstance('a', object)
'a,b'.split(',')
'a b  c'.split()
' a '.strip()
'a.b.c'.rsplit('.', 1)
'Ab'.lower()
'ab'.upper()
'ab'.title()
'a-b'.partition('-')
'a-b-c'.rpartition('-')
'ab'.replace('a', 'x')
'abab'.replace('a', 'x', 1)
'a'.join(['1', '2'])
'ab'.capitalize()
'abc'.startswith('ab')
'abc'.endswith(('x', 'c'))
'abc'.find('c')
'abc'.index('b')
'aba'.count('a')
'7'.zfill(3)
'a\nb'.splitlines()
'12'.isdigit()
'ab'.isalpha()
'a1'.isalnum()
'xax'.strip('x')
'Ab'.swapcase()
'abc'.removeprefix('a')
'abc'.removesuffix('c')
'a'.isupper()
'abc'.rfind('c')
'{} {}'.format(1, 'a')
'{1}{0}'.format('a', 'b')
'{x}'.format(x=1)
'{:>3}|{:<3}|'.format('a', 'b')
'{:03d}'.format(7)
'{:.2f}'.format(1.5)
'{!r}'.format('a')
'{!s:>3}'.format('a')
'{{}}'.format()
'%s %s' % ('a', 1)
'%d' % 7
'%05.1f' % 1.25
'%s' % 'a'
'100%% %s' % 'a'
'%r' % 'a'
'%s' % [1]
'%x' % 255
'%-3s|' % 'a'
{k: v for k, v in zip('ab', (1, 2))}
{i: i * i for i in range(3) if i}
list({1: 'a', 1.0: 'b', True: 'c'}.items())
{None: 1}[None]
{(1, 2): 'x'}[1, 2]
{(1, 'a'): 'y', (1, 'b'): 'z'}[(1, 'b')]
[[x, y] for x in range(2) for y in range(x)]
[x for x in range(9) if x % 2 if x > 3]
[[y for y in range(x)] for x in range(2)]
'a' 'b'
r'a\d'
'''x'''
0x10
1_000
1e3
0b11
list(map(str, [1, 2]))
list(map(lambda a, b: a + b, [1, 2], [3, 4]))
list(map(int, '12'))
os.path.join('a', 'b')
os.path.join('a', '/b')
os.path.join('a', '')
os.path.basename('a/b.c')
os.path.basename('a/')
os.path.dirname('a/b')
os.path.dirname('a')
os.path.splitext('a/b.c')
os.path.splitext('a.b/.c')
os.path.split('a/b')
os.path.normpath('a/../b')
os.sep
str(Path('a/b.tar.gz'))
Path('a/b.tar.gz').name
Path('a/b.tar.gz').stem
Path('a/b.tar.gz').suffix
Path('a/b.tar.gz').parent
Path('a/b.tar.gz').parent.parent
Path('a/b.tar.gz').parents[0]
Path('a/b.tar.gz') / 'c'
'x' / Path('a/b.tar.gz')
Path('a/b.tar.gz').with_suffix('.yaml')
Path('a/b.tar.gz').with_name('d')
Path('a/b.tar.gz').joinpath('e', 'f')
Path('a/b.tar.gz').as_posix()
Path('a').with_suffix('.yaml')
Path('a').suffix
Path('a').stem
Path('a').parent
Path('.a').stem
Path('.a').suffix
Path('.a').with_suffix('.b')
Path('/').parent
Path()
Path('a//b/./c/')
Path('a', 'b')
Path('a', '/b')
PurePosixPath('a') / 'b'
Path('a').parent / 'b'
copy.copy((1,))
copy.copy({'k': 1})
copy.deepcopy({'k': [1]})
json.loads('{"a": [1, null, true]}')
list(itertools.chain([1], (2,), 'a'))
list(itertools.chain())
[0, 1, 2, 3, 4][1:3]
[0, 1, 2, 3, 4][::-1]
[0, 1, 2, 3, 4][-2:]
[0, 1, 2, 3, 4][:2]
'abc'[1:]
'abc'[::2]
(1, 2, 3)[:-1]
functools.partial(dict, a=1)(b=2)
isinstance([], collections.abc.Sequence)
isinstance([], collections.abc.Mapping)
isinstance({}, collections.abc.Mapping)
isinstance(1, collections.abc.Iterable)
isinstance('a', collections.abc.Iterable)
isinstance((), typing.Hashable)
isinstance([], typing.Sequence)
isinstance([], typing.List)
isinstance({}, typing.List)
isinstance(1, numbers.Number)
isinstance('a', numbers.Number)
"""

# Expressions that an interpreter may leave open.
OPEN_EXPRESSIONS = r"""
min([3, -4], key=abs)
repr('a')
repr(1)
abs(-1)
round(1.6)
round(1.25, 1)
divmod(7, 2)
pow(2, 3)
chr(97)
ord('a')
hex(10)
bin(2)
oct(8)
2 ** 3
1 << 2
9 >> 1
~1
'a'.ljust(3) + '|'
'a'.rjust(3)
'a'.center(3)
'a\tb'.expandtabs(2)
'{a}{}'.format(1, a=2)
'{0[0]}'.format(['x'])
'{0[k]}'.format({'k': 1})
'%(a)s' % {'a': 1}
dict.fromkeys(['a', 'b'])
dict.fromkeys('ab', 1)
b'a'.decode()
'é'.encode().decode()
type('a') is str
getattr('a', 'upper')()
(1).bit_length()
(255).to_bytes(1, 'big')
os.path.isabs('/a')
Path('a/b.tar.gz').parts
Path('a/b.tar.gz').suffixes
Path('a/b.tar.gz').is_absolute()
Path('a/b.tar.gz').with_stem('g')
Path('/a/b').relative_to('/a')
math.floor(1.5)
math.pi > 3
re.sub('a', 'b', 'aa')
re.split(',', 'a,b')
json.dumps({'a': 1})
functools.reduce(lambda a, b: a + b, [1, 2, 3])
sorted({1, 2} | {7})
sorted({1, 3} & {3})
sorted({1, 3} - {3})
sorted({1, 3}.difference([1]))
(1, 2).index(2)
(1, 1).count(1)
[1, 2].index(2)
[1, 1].count(1)
next(iter([7]))
next(i for i in [8, 9])
isinstance({1}, set)
isinstance([], set)
'{!r}'.format(None)
"""

# Programs that make a list of values which the interpreter of launch files knows.
PROGRAMS = r"""
values = []
for i in range(9):
    if i == 2: continue
    if i == 5: break
    values.append(i)
else:
    values.append('else')

values = []
for i in range(3):
    for j in range(3):
        if j == 1: break
        values.append((i, j))
    else:
        values.append('else')
else:
    values.append('end')

values, i = [], 0
while i < 9:
    i += 1
    if i % 2: continue
    if i == 6: break
    values.append(i)
else:
    values.append('else')

values, i = [], 3
while i:
    i -= 1
else:
    values.append(i)

values = []
for i in range(5):
    try:
        if i == 1: continue
        if i == 3: break
        values.append(i)
    finally:
        values.append('finally')

def find(x):
    for y in [1, 2, 3]:
        if y == x: return f'has {y}'
    else:
        return 'has not'
values = [find(2), find(4)]

n = 1
def count():
    global n
    n += 1
    return n
def around():
    def inner():
        global n
        n = 10
    inner()
values = [count(), count(), n, around(), n]

def counter():
    n = 0
    def step():
        nonlocal n
        n += 1
        return n
    def again():
        def inner():
            nonlocal n
            n += 10
        inner()
        return step()
    return step, again
step, again = counter()
values = [step(), again(), step()]

x = 1
def f():
    x = 2
    return x
values = [f(), x]

a, b = [1, 2, 3], {'x': 1, 'y': 2}
del a[1], b['x']
values = [*a, *b]

a = [1, 2, 3, 4]
del a[1:3]
values = a

bases = [object]
class A(*bases): x = 1
values = [A.x, A().x]

class A: pass
a = A()
a.x = 1
del a.x
values = [getattr(a, 'x', 'none')]

values = [3, 1, 2]
values.sort()
values += ['x']
more = ['b', 'a', 'c']
more.sort(reverse=True)
most = ['aa', 'b']
most.sort(key=len)
values += more + most

values = [y := 3, y, (z := y + 1), z]
if (n := len(values)) > 3: values.append(n)
values += [m for x in (1, 2) if (m := x * 2) > 2]

n = [last := x for x in (1, 2)]
values = [n, last, {(key := x): x for x in 'ab'}, key]

values = [*(1, 2), *[3], *'ab', *{'k': 1}]
a, *b = values
*c, d = values
e, *f, g = (1, 2)
values = [a, b, c, d, e, f, g]

(a, b), [c, (d, *e)] = (1, 2), (3, (4, 5, 6))
values = [a, b, c, d, e]

a = b = []
a.append(1)
values = [a, b, a is b]

a, b = 1, 2
a, b = b, a
values = [a, b]

a = [0, 1, 2, 3]
a[1:3] = ['x']
a[0] = 'y'
a[-1] = 'z'
values = a

a, b = 'x', 1.5
values = [f'{a}', f'{b:.2f}', f'{a!r}', f'{a:>3}', f'{{}}', f'{a}{b}', f'{1 + 1}', f'{[1]}', f'{None}', f'{a=}',
    f'{b:{3}.{2}}', f'{a:<{4}}|']

values = ['a', 'b', 1000, 2.5, ('t',)]
values.remove('a')
values.remove(1000)
values.remove(2.5)
values.remove(('t',))

a = [1]
try:
    a.remove(7)
    values = ['removed']
except ValueError:
    values = ['not there']

a = [1, 2]
a.clear()
values = [a, len(a)]

d = {'a': 1, 'b': 2}
values = [d['a'], d.get('b'), d.get('c'), d.get('c', 3), d.pop('a'), d.pop('z', 4), d.setdefault('e', 5),
    d.setdefault('b', 6), d, list(d), len(d)]

d = {'a': 1}
d.update({'b': 2}, c=3)
d.update([('d', 4)])
d.update(e=5)
values = [list(d.items()), list(d.keys()), list(d.values()), d.copy() == d, {**d, 'a': 0}, dict(d, f=6), dict(x=1),
    dict([('y', 2)]), dict()]

d = {'a': 1, 'b': 2}
last = d.popitem()
values = [last, d]
d.clear()
values.append(len(d))

d = {}
try:
    d['x']
    values = ['there']
except KeyError:
    values = ['not there']

d = {}
try:
    values = [d.pop('x')]
except KeyError:
    values = ['not there']

d = {}
for i, e in enumerate(['a', 'b'], 1): d.setdefault(i % 2, []).append(e)
values = [d, list(enumerate('a', start=5)), [*enumerate('ab')]]

from typing import NamedTuple
class P(NamedTuple):
    x: int
    y: str = 'b'
p = P(1)
values = [p.x, p.y]

def f(a, b=2, *args, c=3, **more):
    return [a, b, args, c, more]
values = [f(1), f(1, 4), f(1, 4, 5, 6), f(1, c=7), f(a=8, d=9), f(*[1, 2, 3], **{'c': 0, 'z': 1}), f(1, *(2,), b2=3)]

def f(a, /, b, *, c): return [a, b, c]
values = [f(1, 2, c=3), f(1, b=2, c=3), (lambda x, y=1: x + y)(1), (lambda *a, **k: [a, k])(1, b=2)]

def f(x=[]):
    x.append(1)
    return len(x)
values = [f(), f()]

def g():
    yield 1
    return
    yield 2
values = list(g())

x = 'outer'
values = [x for x in range(2)] + [x]

fs = [lambda: i for i in range(2)]
gs = [lambda i=i: i for i in range(2)]
values = [f() for f in fs] + [g() for g in gs]

try:
    x = [1][3]
except IndexError:
    values = ['index']
else:
    values = ['else']
finally:
    values.append('finally')

try:
    values = ['a']
except Exception:
    values = ['b']
else:
    values.append('else')
finally:
    values.append('finally')

def f():
    try:
        return 'try'
    finally:
        values.append('finally')
values = []
values.append(f())

def f():
    try:
        raise ValueError('x')
    except (KeyError, ValueError) as error:
        return 'caught'
    return 'not'
values = [f()]

def f():
    try:
        raise KeyError('x')
    except ValueError:
        return 'value'
    except KeyError:
        return 'key'
values = [f()]

def f(x):
    if x: raise RuntimeError
    return 'fine'
values = [f(0)]
try:
    values.append(f(1))
except RuntimeError:
    values.append('raised')

values = []
with open('/dev/null') as f, open('/dev/null') as g:
    values.append('in')

x: int = 1
y: str
values = [x]

values = [1]
values[0] += 5
d = {'a': [1]}
d['a'] += [2]
class A: n = 1
a = A()
a.n += 1
values += [d, a.n, A.n]

assert True, 'x'
pass
values = [1, 2] and ['a']

def f():
    pass
values = [f(), print('x'), [].append(1)]

if 0: values = ['no']
elif []: values = ['no']
elif 'x': values = ['yes']
else: values = ['no']

def outer():
    def f(n): return n and f(n - 1) + 1
    return f(5)
values = [outer()]

a = [3, 1, 2]
a[0], a[2] = a[2], a[0]
for i in range(len(a)): a[i] *= 2
values = a

d = {'x': {'y': {'z': 1}}}
d['x']['y']['w'] = 2
values = [d['x']['y']['z'], d.get('x', {}).get('y', {}).get('w'), d['x'].get('q', {}).get('r')]

s = {1}
s.add(1)
s.add(2)
s.update([2, 3])
s.discard(9)
s.discard(3)
s.remove(1)
values = [len(s), sorted(s), sorted(s.union([8]))]

values = [1, 2]
values.extend((3,))
values.insert(0, 0)
values.insert(-1, 'x')
values.append(9)
last = values.pop()
first = values.pop(0)
values.remove(2)
values.reverse()
values = values + [last, first, values.copy()]

def f(x):
    match x:
        case 0: return 'zero'
        case 'a' | 'b': return 'letter'
        case True: return 'true'
        case _: return 'other'
values = [f(0), f('b'), f('c'), f(None)]

from functools import partial
def f(a, b, c=0): return [a, b, c]
values = [partial(f, 1)(2), partial(f, b=1)(2), partial(f, 1, 2, c=3)()]

import copy
a = [[1], {'x': [2]}]
b, c = copy.copy(a), copy.deepcopy(a)
a[0].append(3)
a[1]['x'].append(4)
values = [b, c]

a, b, c = 1, 2, 3
del a, (b, c)
b = 4
values = [b]

n = 1
def f():
    global n
    del n
f()
n = 2
values = [n]

d = {'a': 1}
try:
    del d['x']
except KeyError:
    values = ['not there']

a = [1]
try:
    del a[3]
except IndexError:
    values = ['not there']

def f():
    try:
        int('x')
    except KeyError:
        return 'key'
    except (TypeError, ValueError):
        return 'value'
def g():
    try:
        try:
            {}['x']
        except IndexError:
            return 'index'
        finally:
            values.append('finally')
    except LookupError:
        return 'lookup'
values = []
values += [f(), g()]

def f():
    try:
        [].pop()
    except OSError:
        return 'os'
    except:
        return 'any'
values = [f()]

a = [0, 1, 2]
a[:] = [7]
b = [0, 1, 2, 3]
b[::2] = 'xy'
values = a + b
try:
    b[::2] = [1]
except ValueError:
    values.append('sizes')

def counter():
    n = 0
    async def f(x):
        nonlocal n
        n += x
        return n
    return f
values = [1]
"""

# Programs that make a list of values, some of which an interpreter may leave open.
OPEN_PROGRAMS = r"""
import asyncio
async def f(x):
    return x + 1
async def g():
    return await f(1)
values = [asyncio.run(g())]

d = {'a': 1}
d |= {'b': 2}
t = (1,)
t += (2,)
s = 'a'
s *= 3
n = 2
n **= 3
n -= 1
values = [d, t, s, n]

class Grid:
    def __getitem__(self, key): return 'x'
values = [Grid()[0:1, 2]]

class A: pass
class B(A): pass
values = [isinstance(B(), A), isinstance(B(), B), isinstance(A(), B), isinstance(A(), (str, A)), isinstance('a', A),
    isinstance(A(), str)]

values = [1, 2]
values.extend((3,))
values.insert(0, 0)
values.insert(-1, 'x')
values.append(9)
last = values.pop()
first = values.pop(0)
values.remove(2)
values.reverse()
values = values + [last, first, values.index(3), values.count(3), values.copy()]

from collections import defaultdict
d = defaultdict(list)
d['a'].append(1)
values = [d['a'], len(d['b'])]

from collections import namedtuple
P = namedtuple('P', 'x y')
p = P(1, y=2)
values = [p.x, p.y]

from dataclasses import dataclass, field, fields
@dataclass
class P:
    x: int
    y: str = 'b'
    z: list = field(default_factory=list)
p = P(1, z=[2])
values = [p.x, p.y, p.z, P(3).z, [f.name for f in fields(p)], P(x=4, y='c').y]

from enum import Enum
class Mode(Enum):
    A = 'a'
    B = 'b'
values = [Mode.A.value, Mode.B.name]

class A:
    kind = 'a'
    def __init__(self, n=1): self.n = n
    def twice(self): return self.n * 2
    @property
    def more(self): return self.n + 1
    @staticmethod
    def plain(x): return x
    @classmethod
    def make(cls, n): return cls(n)
    def __str__(self): return f'A{self.n}'
a = A(3)
values = [a.n, a.twice(), a.more, A.plain(4), a.plain(5), A.make(6).n, A.kind, a.kind, A().n, A.twice(a)]

class A:
    def __init__(self): self.x = 'a'
    def name(self): return 'A' + self.x
class B(A):
    def __init__(self):
        super().__init__()
        self.y = 'b'
    def name(self): return 'B' + super().name()
b = B()
values = [b.x, b.y, b.name()]

def g(n):
    for i in range(n):
        yield i
    yield from ['x', 'y']
values = [*g(2), *(i * 2 for i in g(1) if i != 'x'), next(iter([7])), next(i for i in [8, 9])]

def f(x):
    match x:
        case 0: return 'zero'
        case 'a' | 'b': return 'letter'
        case True: return 'true'
        case str() if len(x) > 3: return 'long'
        case _: return 'other'
values = [f(0), f('b'), f('c'), f(None)]
"""


def values(program: str) -> list[str]:
    """Return the values that Python makes."""
    names: dict[str, list[object]] = {}
    exec(compile(IMPORTS + program, "program", "exec"), names)
    return [str(value) for value in names["values"]]
