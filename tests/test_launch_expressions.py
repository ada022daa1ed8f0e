"""The expressions in launch files have the values that Python gives them."""

from __future__ import annotations

import pytest

from ros_lint.collectors.launch.expressions import evaluate
from ros_lint.collectors.symbolic_text import UNKNOWN


@pytest.mark.parametrize(
    "text",
    [
        "[x for x in 'a b c'.split() if x != 'b']",
        "[x + y for x in ['a', 'b'] for y in ['1', '2']]",
        "{x: len(x) for x in ['a', 'bb']}",
        "len({x.lower() for x in ['A', 'a']})",
        "all(x in ['a', 'b'] for x in ['a'])",
        "any(int(x) > 3 for x in '1,2,4'.split(','))",
        "[b for a, b in [('x', 1), ('y', 2)]]",
        "[i for i, x in enumerate(['a', 'b'])]",
        "list(zip(['a'], [1]))",
        "sum(range(1, 5))",
        "list(reversed([1, 2]))",
        "'{}_{}'.format('a', 1)",
        "'{1}{0}'.format('a', 'b')",
        "'{name}'.format(name='robot')",
        "f'robot_{1 + 1}'",
        "f'x{2}'",
        "isinstance('a', str)",
        "isinstance(1, (str, float))",
        "','.join(['a', 'b'])",
        "{'a': 1}.get('b', 2)",
        "dict([('a', 1)])['a']",
        "[k for k, v in {'a': 1, 'b': 2}.items() if v > 1]",
    ],
)
def test_the_value_is_that_of_python(text: str) -> None:
    assert evaluate(text) == str(eval(text))


@pytest.mark.parametrize(
    "text",
    [
        "(x for x in [1])",
        "[x for x in range(9) for y in unknown]",
        "'{:>99999999}'.format(1)",
        "'{0.__class__}'.format(1)",
        "'{' + '}'.format(1)",
        "'{x}'.format(y=1)",
        "f'{1:>99999999}'",
        "f'{1!r}'",
        "isinstance(1, complex)",
        "range(1 << 40)",
        "[x for x in range(9000) for y in range(9000) if x < 0]",
        "[['x' * 9000 for x in range(9000)] for y in range(9000)]",
        "'x'.join(['y' * 9000, 'y' * 9000])",
        "('{0}' * 3000).format('x' * 9000)",
    ],
)
def test_the_value_is_unknown(text: str) -> None:
    assert evaluate(text) == UNKNOWN
