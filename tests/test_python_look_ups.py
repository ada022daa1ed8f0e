"""Packages and files that Python sources look up, with a parser and without."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ros_lint.base.text import Text
from ros_lint.collectors.python import collect as python
from ros_lint.collectors.python.excerpt import excerpt
from ros_lint.collectors.python.lookups import in_excerpt, literals, look_ups
from ros_lint.collectors.python.source_errors import NotPythonError
from ros_lint.collectors.python.syntax import parse
from ros_lint.facts.sources import FileFacts
from ros_lint.facts.visibility import Facet


def packages(text: str) -> list[tuple[str, str, bool]]:
    facts = python.collect(source := Text("a.py", text))
    found = [mention for mention in facts.mentions if mention.via == "package"]
    assert {source.slice(mention.span) for mention in found} <= {"NAME", *(f"'{mention.name}'" for mention in found)}
    return [(mention.name, mention.what, mention.optional) for mention in found]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("x = get_package_share_directory('p')\n", [("p", 'get_package_share_directory("p")', False)]),
        (
            "x = f(a.get_package_share_path(\n    package_name='p'), FindPackageShare('q'))\n",
            [("p", 'get_package_share_path("p")', False), ("q", 'FindPackageShare("q")', False)],
        ),
        ("NAME = 'p'\ndef f():\n    return get_package_prefix(NAME)\n", [("p", 'get_package_prefix("p")', False)]),
        ("# get_package_prefix('p')\nx = 'get_package_prefix(\"q\")'\n", []),
        ('"""\nget_package_prefix("p")\n"""\n', []),
        (
            "try:\n    x = get_package_prefix('p')\nexcept PackageNotFoundError:\n    x = get_package_prefix('q')\n",
            [("p", 'get_package_prefix("p")', True), ("q", 'get_package_prefix("q")', False)],
        ),
        (
            "def f():\n    if not has_resource('packages', 'q'):\n        return None\n    return get_package_prefix('p')\n",
            [("p", 'get_package_prefix("p")', True)],
        ),
        (
            "if 'q' in get_packages_with_prefixes():\n    x = get_package_prefix('p')\nelse:\n    x = get_package_prefix('r')\n",
            [("p", 'get_package_prefix("p")', True), ("r", 'get_package_prefix("r")', False)],
        ),
        ("from ament_index_python import get_package_prefix\n", []),
    ],
)
def test_look_ups(text: str, expected: list[tuple[str, str, bool]]) -> None:
    assert packages(text) == expected


def test_a_computed_look_up_is_opaque() -> None:
    facts = python.collect(Text("a.py", "def f(name):\n    return get_package_share_directory(name)\n"))
    assert [(opaque.hides, opaque.reason, str(opaque.span)) for opaque in facts.opaque] == [
        (Facet.USES, "the package that get_package_share_directory() looks up is computed", "a.py:2:40")
    ]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("x = os.path.join(get_package_share_directory('p'), 'config', 'a.yaml')\n", [("p", "config/a.yaml")]),
        ("share = get_package_share_path('p')\nx = open(share / 'a' / 'b.xml')\n", [("p", "a/b.xml")]),
        ("x = f(Path(get_package_share_directory('p')).joinpath('a.bt'), mode='r')\n", [("p", "a.bt")]),
        ("x = f\"{get_package_share_directory('p')}/a/b.yaml\"\n", [("p", "a/b.yaml")]),
        ("P = 'p'\nx = get_package_share_directory(P) + '/a.yaml'\n", [("p", "a.yaml")]),
        ("x = '%s/a.%s' % (get_package_share_directory('p'), 'b.c')\n", [("p", "a.b.c")]),
        ("x = os.path.join(get_package_share_directory('p'), name, 'a.yaml')\n", []),
        ("x = os.path.join(get_package_prefix('p'), 'lib', 'a.so')\n", []),
        (
            "d = [os.path.join(get_package_share_directory('p'), n) for n in ('a.xml', 'b.xml')]\n",
            [("p", "a.xml"), ("p", "b.xml")],
        ),
        ("x = os.path.join(get_package_share_directory('p'), 'a.xml' if y else 'b.xml')\n", [("p", "a.xml"), ("p", "b.xml")]),
    ],
)
def test_files_that_are_looked_up(text: str, expected: list[tuple[str, str]]) -> None:
    facts = python.collect(Text("a.py", text))
    assert [(found.package, found.path) for found in facts.lookups] == expected
    assert {mention.name for mention in facts.mentions} == {"p"}
    assert python.collect(Text("a.py", text), launch=True) == FileFacts()


CALLS = st.sampled_from(
    [
        "get_package_prefix('a')",
        'x(FindPackageShare( package = "b" ))',
        "get_package_share_directory(c)",
        "c = 'd'",
        "# get_package_prefix('e')",
        "'get_package_prefix(\"f\")'",
        '"""',
        "'''",
        "from x import get_package_prefix",
        "get_package_prefix(\n'g')",
        "get_package_prefix('h' 'i')",
    ]
)


@given(st.lists(CALLS, max_size=6))
@settings(max_examples=500)
def test_look_ups_with_and_without_a_parser_agree(lines: list[str]) -> None:
    source = Text("a.py", "\n".join(lines) + "\n")
    try:
        tree = parse(source)
    except NotPythonError:
        return
    found = literals(source)
    assert found is None or found == look_ups(source, tree)


def _functions(lines: list[str]) -> str:
    """Return the lines, every other one of which stands in a function that is long enough to be left out."""
    filling = "    pass  # something long enough\n" * 8
    return "".join(
        f"def f{number}(a=0):\n{filling}    {line}\n" if number % 2 else f"{line}\n" for number, line in enumerate(lines)
    )


NAMED = st.sampled_from(
    [
        "S = get_package_share_directory('p')",
        "S = 'q'",
        "x = open(S + '/a.yaml')",
        "x = open(S / T / 'b.yaml')",
        "T = os.path.join(S, 'c')",
        "x = open(f'{T}/d.yaml')",
        "get_package_share_directory(S)",
        "S = T",
        "'''",
        "x = '''S'''; y = (",
        ")",
        "class S: T = get_package_prefix('r')",
        "global S",
        "try: get_package_prefix(T)\nexcept KeyError: pass",
        "# (",
    ]
)


@given(st.lists(NAMED, max_size=9))
@settings(max_examples=600)
def test_what_is_left_out_says_nothing(lines: list[str]) -> None:
    source = Text("a.py", _functions(lines))
    try:
        tree = parse(source)
    except NotPythonError:
        return
    assert in_excerpt(source) == look_ups(source, tree)


def test_functions_without_the_words_are_left_out() -> None:
    long = "        x = 1\n" * 40
    text = f"@d\ndef f(\n    a,\n):\n{long}\n\nclass C:\n    async def g(self):\n{long}\ndef h():\n        word()\n{long}"
    found = excerpt(text, {"word"})
    assert [part.split("(")[0].strip() for part in found.omitted] == ["def f", "async def g"]
    assert found.text.count("\n") == text.count("\n")
    assert found.text.startswith("@d\ndef f(): pass\n\n")
    assert found.text.endswith(f"def h():\n        word()\n{long}")


def test_a_function_in_a_last_line_without_an_end_is_read() -> None:
    text = "a = 'b'\nget_package_share_directory(a)\ndef f(): " + "pass; " * 50 + "pass"
    assert excerpt(text, {"word"}).omitted == (text.splitlines()[-1],)
    assert [mention.name for mention in python.collect(Text("a.py", text)).mentions] == ["b"]
