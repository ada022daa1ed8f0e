"""The interpreter of Python, compared with Python on random expressions and on random programs with unknown conditions."""

from __future__ import annotations

import random
from itertools import product

import pytest

from ros_lint.base.text import Text
from ros_lint.collectors.setup_py.evaluate import evaluate
from ros_lint.facts.visibility import Facet

TEXTS = ["''", "'a'", "'ab c'", "'%s-%s'", "'{} {x}'", "'share/'", "'%d'", "'%(a)s'", "'a,b,,c'"]
NUMBERS = ["0", "1", "2", "-3", "7", "1.5", "True"]


def _text(dice: random.Random, depth: int) -> str:
    if depth <= 0:
        return dice.choice(TEXTS)
    text, number, elements = (make(dice, depth - 1) for make in (_text, _number, _list))
    return dice.choice(
        [
            f"({text} + {_text(dice, depth - 1)})",
            f"({text} * {dice.choice(NUMBERS[:5])})",
            f"({text} % ({_any(dice, depth - 1)}, {_any(dice, depth - 1)}))",
            f"({text} % {_any(dice, depth - 1)})",
            f"{text}.format({_any(dice, depth - 1)}, x={_any(dice, depth - 1)})",
            f"f'{{{dice.choice(NUMBERS)}:>{dice.randint(1, 5)}}}|{{{dice.choice(NUMBERS)}!r}}'",
            f"{text}[{number}:]",
            f"{text}[{dice.choice(['-1', '0', '::-1', '1:', ':2', '::2'])}]",
            f"{text}.{dice.choice(['upper', 'title', 'strip', 'lower', 'swapcase', 'capitalize'])}()",
            f"{text}.replace({_text(dice, 0)}, {_text(dice, 0)})",
            f"{text}.join(str(x) for x in {elements})",
            f"str({_any(dice, depth - 1)})",
            f"({text} if {_any(dice, depth - 1)} else {_text(dice, depth - 1)})",
            f"({text} or {_text(dice, depth - 1)})",
        ]
    )


def _number(dice: random.Random, depth: int) -> str:
    if depth <= 0:
        return dice.choice(NUMBERS)
    left, right = _number(dice, depth - 1), _number(dice, depth - 1)
    return dice.choice(
        [
            f"({left} {dice.choice(['+', '-', '*', '//', '%', '/', '&', '|'])} {right})",
            f"({left} {dice.choice(['<', '<=', '==', '!='])} {right})",
            f"({_any(dice, depth - 1)} {dice.choice(['in', 'not in'])} {_list(dice, depth - 1)})",
            f"({_any(dice, depth - 1)} {dice.choice(['==', '!='])} {_any(dice, depth - 1)})",
            f"len({dice.choice([_text, _list, _dict])(dice, depth - 1)})",
            f"(not {_any(dice, depth - 1)})",
            f"-{left}",
            f"{_text(dice, depth - 1)}.{dice.choice(['count', 'find', 'startswith', 'endswith'])}({_text(dice, 0)})",
            f"{_list(dice, depth - 1)}.count({_any(dice, 0)})",
            f"{dice.choice(['max', 'min', 'sum'])}([{left}, {right}])",
            f"({left} and {right})",
            f"int({left})",
        ]
    )


def _list(dice: random.Random, depth: int) -> str:
    if depth <= 0:
        return dice.choice(["[]", "['a', 'b']", "[1, 2, 3]", "('x', 1)", "list(range(4))", "{'a'}"])
    inner = _list(dice, depth - 1)
    return dice.choice(
        [
            f"[{_any(dice, depth - 1)}, {_any(dice, depth - 1)}]",
            f"[*{inner}, {_any(dice, depth - 1)}]",
            f"(list({inner}) + list({_list(dice, depth - 1)}))",
            f"list({inner})[{dice.choice(['1:', '::-1', ':1', '-2:'])}]",
            f"[x for x in {inner} if x != {_any(dice, 0)}]",
            f"sorted(str(x) for x in {inner})",
            f"list(reversed(list({inner})))",
            f"list(zip({inner}, {_list(dice, 0)}))",
            f"{_text(dice, depth - 1)}.split({dice.choice(['', repr(','), repr('a')])})",
            f"list({_dict(dice, depth - 1)}.{dice.choice(['keys', 'values', 'items'])}())",
            f"sorted(set(str(x) for x in {inner}) {dice.choice('-&|^')} {{'a', '1', 'z'}})",
            f"list(enumerate({inner}))",
            f"list(map(str, {inner}))",
            f"list(filter(None, {inner}))",
            f"(list({inner}) * {dice.choice(NUMBERS[:3])})",
        ]
    )


def _dict(dice: random.Random, depth: int) -> str:
    if depth <= 0:
        return dice.choice(["{}", "{'a': 1}", "{'a': 'x', 'b': [2]}", "dict(x=1)"])
    inner = _dict(dice, depth - 1)
    return dice.choice(
        [
            f"{{**{inner}, {_text(dice, 0)}: {_any(dice, depth - 1)}}}",
            f"dict({inner}, y={_any(dice, depth - 1)})",
            f"{{k: str(v) for k, v in {inner}.items()}}",
            f"{inner}.copy()",
            f"({inner} | {_dict(dice, depth - 1)})",
        ]
    )


def _any(dice: random.Random, depth: int) -> str:
    return dice.choice([_text, _text, _number, _list, _dict])(dice, depth)


def _evaluated(expression: str, program: str = "") -> str:
    """Return the text of the value of an expression, "" if it is not known."""
    end = f"setup(name='pkg', version=str({expression}))\n"
    found = evaluate("pkg", "", [], Text("setup.py", f"from setuptools import setup\n{program}\n{end}"), None, None)
    assert not found.problems
    return found.project.version


def _expressions(seed: int, count: int) -> list[tuple[str, str]]:
    """Return random expressions, and the texts of their values."""
    dice = random.Random(seed)
    results: list[tuple[str, str]] = []
    while len(results) < count:
        expression = _any(dice, dice.randint(1, 3))
        try:
            value = eval(expression)
        except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError):
            continue
        if len(str(value)) < 2000:
            results.append((expression, str(value)))
    return results


@pytest.mark.parametrize("seed", range(20))
def test_values_of_random_expressions_are_those_of_python_or_unknown(seed: int) -> None:
    known = 0
    for expression, text in _expressions(seed, 60):
        version = _evaluated(expression)
        assert version in (text, ""), expression
        known += version == text
    assert known > 45


ELEMENTS = "abcdefgh"
KEYS = "ABC"


def _block(dice: random.Random, depth: int, indent: str) -> list[str]:
    """Return random statements that change the list 'values' under conditions, some of which are unknown."""
    lines: list[str] = []
    for _ in range(dice.randint(1, 3)):
        element, key = dice.choice(ELEMENTS), dice.choice(KEYS)
        kind = dice.randint(0, 5 if depth > 0 else 3)
        if kind <= 2:
            lines.append(indent + _change(dice, element))
        elif kind == 3:
            value = dice.choice(["[*values]", f"['{element}']", "values[1:]"])
            lines.append(f"{indent}{dice.choice(['other', 'names'])} = {value}")
        elif kind == 4:
            known = [f"'{element}' in values", "values", "len(other) > 1"]
            test = dice.choice([f"os.environ.get('{key}')", f"not os.environ.get('{key}')", *known])
            lines.append(f"{indent}if {test}:")
            lines += _block(dice, depth - 1, indent + "    ")
            if dice.randint(0, 1):
                lines += [f"{indent}else:", *_block(dice, depth - 1, indent + "    ")]
        else:
            elements = dice.choice(["list(values)", "list(other)", f"['{element}', 'b']", "list(names)"])
            lines.append(f"{indent}for name in {elements}:")
            lines += _block(dice, depth - 1, indent + "    ")
            if dice.randint(0, 1):
                lines.append(f"{indent}    if os.environ.get('{key}'): {dice.choice(['break', 'continue'])}")
                lines.append(f"{indent}    values.append('c')")
    return lines


def _change(dice: random.Random, element: str) -> str:
    return dice.choice(
        [
            f"values.append('{element}')",
            f"values.append('{element}')",
            f"values += ['{element}', 'a']",
            "values.extend(other)",
            f"values.insert({dice.choice([0, 1, -1])}, '{element}')",
            f"if '{element}' in values: values.remove('{element}')",
            "values.clear()",
            "if values: other.append(values.pop())",
            "if values: values.pop(0)",
            "values.reverse()",
            "values.sort()",
            f"values = [*values, '{element}']",
            "values = values + other",
            "values = [name for name in values if name != 'a']",
            f"if values: values[0] = '{element}'",
            "if len(values) > 1: del values[-1]",
            f"values[:1] = ['{element}']",
            f"values = sorted(set(values) | {{'{element}'}})",
            "values = other if os.environ.get('A') else values",
            f"other += [name for name in values if os.environ.get('B') or name == '{element}']",
        ]
    )


def _runs(program: str, monkeypatch: pytest.MonkeyPatch) -> list[list[str]]:
    """Return the values that Python makes with each choice of environment variables, none if any choice fails."""
    results: list[list[str]] = []
    for choice in product([True, False], repeat=len(KEYS)):
        for key, given in zip(KEYS, choice, strict=True):
            monkeypatch.setenv(key, "1") if given else monkeypatch.delenv(key, raising=False)
        names: dict[str, list[str]] = {}
        try:
            exec(compile(program, "program", "exec"), names)
        except (ValueError, IndexError):
            return []
        results.append(names["values"])
    return results


@pytest.mark.parametrize("seed", range(40))
def test_values_under_unknown_conditions_include_those_of_python(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """What is certainly installed is installed in every run, and nothing else is than what is perhaps installed."""
    dice = random.Random(seed)
    for _ in range(15):
        start = "import os\nvalues = ['a', 'b']\nother = ['h']\nnames = []\n"
        program = start + "\n".join(_block(dice, 2, ""))
        runs = _runs(program, monkeypatch)
        if not runs:
            continue
        text = f"from setuptools import setup\n{program}\nsetup(name='pkg', data_files=[('share/pkg', values)])\n"
        found = evaluate("pkg", "", list(ELEMENTS), Text("setup.py", text), None, None)
        certain = {item.source for item in found.products.installs if not item.conditional}
        possible = {item.source for item in found.products.installs}
        for run in runs:
            assert certain <= set(run), program
            assert set(run) <= possible or any(Facet.SHARE in opaque.hides for opaque in found.opaque), program


TEMPLATES = ["'%s/*.launch.py' % {}", "'{{}}/*.launch.py'.format({})", "f'{{{}}}/*.launch.py'", "{} + '/*.launch.py'"]


@pytest.mark.parametrize("template", TEMPLATES)
def test_a_template_with_a_star_is_known_if_its_values_are(template: str) -> None:
    assert _evaluated(template.format("n"), "n = 'launch'") == "launch/*.launch.py"
    assert _evaluated(template.format("n"), "import os\nn = os.environ['N']") == ""
