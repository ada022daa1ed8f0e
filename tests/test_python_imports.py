"""Imports of Python sources: the scan without a parser against the syntax tree, on generated and on real sources."""

from __future__ import annotations

import ast
import random
import sysconfig
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ros_lint.base.text import Text, read
from ros_lint.collectors.python import collect as python
from ros_lint.collectors.python.import_tree import walk
from ros_lint.collectors.python.imports import scan
from ros_lint.collectors.python.source_errors import NotPythonError
from ros_lint.collectors.python.syntax import is_of_others, parse, refusal
from ros_lint.collectors.python.unused_imports import unused_imports
from ros_lint.facts.visibility import Facet, Problem


def imports(text: str) -> list[tuple[str, bool]]:
    mentions = python.collect(Text("a.py", text)).mentions
    return [(mention.name, mention.optional) for mention in mentions if mention.via == "import"]


# --- real sources


def library() -> list[Path]:
    """Return some hundred files of Python's own library, the same on every run."""
    files = sorted(Path(sysconfig.get_paths()["stdlib"]).rglob("*.py"))
    files = [path for path in files if "site-packages" not in path.parts]
    return random.Random(4).sample(files, min(250, len(files)))


def test_the_library_of_python() -> None:
    compared = 0
    for path in [*library(), *Path(__file__).parent.parent.glob("ros_lint/**/*.py")]:
        source = read(path.as_posix(), path.read_bytes())
        try:
            tree = parse(source)
        except NotPythonError:
            continue
        found = scan(source.text)
        if found is not None:
            compared += 1
            assert found == walk(source, tree), path
    assert compared > 180, "most files are read without a parser"


def test_the_tree_is_walked_whole() -> None:
    """The other reader, against nothing but the definition of the nodes."""
    for path in library()[:80]:
        source = read(path.as_posix(), path.read_bytes())
        try:
            tree = parse(source)
        except NotPythonError:
            continue
        if "import_module" in source.text or "__import__" in source.text:
            continue
        plain = sorted(
            name
            for node in ast.walk(tree)
            for name in (
                [alias.name for alias in node.names]
                if isinstance(node, ast.Import)
                else [node.module]
                if isinstance(node, ast.ImportFrom) and node.module and not node.level
                else []
            )
        )
        found = [item for item in walk(source, tree) if not item.module.startswith(".")]
        assert sorted(item.module for item in found) == plain
        assert all(source.text.startswith(item.module, item.start) for item in found)


# --- generated sources

SIMPLE = [
    "import a",
    "import a.b as c, d  # why",
    "from g.h import i",
    "from .k import l",
    "from m import (\nn, o)",
    "pass",
    "from . import j",
    "import e;x = 1",
    "x = 1; import f",
    "from m import (  # import n\n    o)",
    "import \\\n  q",
    "from r \\\nimport s",
    "x = '''\nimport t\n'''",
    'x = """ # \nif x:\n  import t\n"""',
    "'''one line'''",
    '"""import t"""',
    "# import t",
    "# ''' import t",
    "x = 'import u'",
    "print('''import v''')",
    "text = 'from w import x'",
    "text = 'a \\\nimport w'",
    "if x: import y",
    "raise",
    "sys.exit()",
    "reimport = important",
    "",
]
HEADS = [
    "if TYPE_CHECKING:",
    "if not typing.TYPE_CHECKING:",
    "if x:",
    "if sys.version_info > (3,):",
    "def f():",
    "async def g(\n    x, y):",
    "class A:",
    "for x in y:",
    "while True:",
    "with suppress(ImportError):",
    "with suppress(\nImportError):",
    "with x(\n    a), b:",
    "match x:\n case 1:",
]
HANDLERS = ["except ImportError:", "except (\n  KeyError, ImportError) as error:", "except KeyError:", "except Exception:"]
ODD = ["'''", '"""', "'", "(", ")", "try:", "else:", "import", "from x", "\\"]


def block(dice: random.Random, depth: int = 0) -> list[str]:
    lines: list[str] = []
    for _ in range(dice.randint(1, 3)):
        kind = dice.choice(["simple", "simple", "head", "try"] if depth < 3 else ["simple"])
        if kind == "simple":
            lines.append(dice.choice(SIMPLE[: dice.choice([6, 6, 6, 6, len(SIMPLE)])]))
            continue
        heads = ["try:", *dice.choices(HANDLERS, k=dice.randint(1, 2)), "else:", "finally:"]
        if kind == "head":
            head = dice.choice(HEADS)
            heads = [head, *(["else:"] if head.startswith(("if", "for", "while")) else [])]
        for head in heads:
            if head not in ("else:", "finally:") or dice.random() < 0.5:
                indent = dice.choice([" ", "    ", "\t"]) + ("  " if "case" in head else "")
                # Only the first line of a piece is indented: the others lie in brackets or strings.
                body = [indent + line for line in block(dice, depth + 1)]
                lines += [head.replace("\n case", "\n  case"), *body, indent + "pass"]
    return lines


@pytest.mark.parametrize("seed", range(10))
def test_scan_and_tree_agree(seed: int) -> None:
    dice = random.Random(seed)
    agreed = 0
    for _ in range(300):
        lines = block(dice)
        if dice.random() < 0.2:
            lines.insert(dice.randint(0, len(lines)), dice.choice(ODD))
        source = Text("a.py", dice.choice(["\n", "\n", "\r\n"]).join(lines) + "\n")
        try:
            tree = parse(source)
        except NotPythonError:
            continue
        found = scan(source.text)
        if found is not None:
            agreed += bool(found)
            assert found == walk(source, tree), source.text
    assert agreed > 30


@pytest.mark.parametrize(
    ("text", "caught"),
    [
        ("try:\n    from .a import b\n    from ..c.d import e\nexcept ImportError:\n    b = None\n", (".a", "..c.d")),
        ("try:\n    from . import a, b\nexcept ImportError as error:\n    a = b = None\n", (".a", ".b")),
        ("with suppress(ImportError):\n    from .a import b\n", (".a",)),
        ("try:\n    from .a import b\n    import c\nexcept ImportError:\n    pass\n", (".a", "c")),
        # The other branch may import the same file by another way.
        ("try:\n    from .a import b\nexcept ImportError:\n    from a import b\n", ("a",)),
        ("try:\n    from .a import b\nexcept ImportError:\n    from robot.a import b\n", ("robot.a",)),
        ("try:\n    from .a import b\nexcept ImportError:\n    raise\n", ()),
        ("try:\n    from .a import b\nexcept Exception:\n    b = None\n", ()),
        ("if TYPE_CHECKING:\n    from .a import b\n", ()),
        ("from .a import b\ntry:\n    pass\nexcept ImportError:\n    pass\n", ()),
    ],
)
def test_files_of_the_package_that_a_file_goes_on_without(text: str, caught: tuple[str, ...]) -> None:
    source = Text("a.py", text)
    facts = python.collect(source)
    assert facts.optional_modules == caught
    assert [mention.name for mention in facts.mentions if mention.name.startswith(".")] == []
    assert tuple(item.module for item in walk(source, parse(source)) if item.caught) == caught


@given(st.text(alphabet="import from as.x,\n\t \"'#\\();:", max_size=60))
@settings(max_examples=500)
def test_any_text_is_read(text: str) -> None:
    source = Text("a.py.in", text)
    for mention in python.collect(source).mentions:
        assert source.slice(mention.span) == mention.name


# --- what is optional


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("import a\ndef f():\n    import b\n", [("a", False), ("b", False)]),
        ("if TYPE_CHECKING:\n    import a\nelse:\n    import b\n", [("a", True), ("b", False)]),
        ("if typing.TYPE_CHECKING:\n    from a.b import c\n", [("a.b", True)]),
        ("DEBUG = False\nif DEBUG:\n    import a\nelse:\n    import b\n", [("a", True), ("b", False)]),
        ("DEBUG: bool = False  # slow\ndef f():\n    if x and DEBUG:\n        import a\n", [("a", True)]),
        ("DEBUG = False\nif x or DEBUG:\n    import a\n", [("a", False)]),
        ("DEBUG = False\nDEBUG = f()\nif DEBUG:\n    import a\n", [("a", False)]),
        ("DEBUG = False\ndef f(DEBUG):\n    if DEBUG:\n        import a\n", [("a", False)]),
        ("DEBUG = True\nif DEBUG:\n    import a\n", [("a", False)]),
        ("try:\n    import a\nexcept ImportError:\n    a = None\n", [("a", True)]),
        ("try:\n    import a\nexcept ModuleNotFoundError:\n    import b\n", [("a", True), ("b", True)]),
        ("try:\n    import a\nexcept (ImportError, OSError) as e:\n    pass\n", [("a", True)]),
        ("try:\n    import a\nexcept:\n    pass\n", [("a", True)]),
        ("try:\n    import a\nexcept Exception:\n    print(1)\n", [("a", True)]),
        ("try:\n    import a\nexcept ImportError:\n    raise RuntimeError('install a')\n", [("a", False)]),
        ("try:\n    import a\nexcept ImportError:\n    print('install a')\n    sys.exit(1)\n", [("a", False)]),
        ("if x:\n    try:\n        import a\n    except ImportError:\n        raise RuntimeError('-x needs a')\n", [("a", True)]),
        ("def f():\n    try:\n        import a\n    except ImportError as e:\n        raise\n", [("a", False)]),
        ("try:\n    import a\nexcept KeyError:\n    pass\n", [("a", False)]),
        ("try:\n    import a\nfinally:\n    import b\n", [("a", False), ("b", False)]),
        ("try:\n    from a.b import c\nexcept ImportError:\n    from a.d import c\n", [("a.b", False), ("a.d", False)]),
        ("try:\n    import a\nexcept ImportError:\n    a = None\nelse:\n    import b\n", [("a", True), ("b", True)]),
        ("def f():\n    try:\n        x()\n        import a\n    except ImportError:\n        pass\n", [("a", True)]),
        ("with suppress(ImportError):\n    import a\n", [("a", True)]),
        ("if sys.version_info >= (3, 8):\n    import a\nelse:\n    import b\n", [("a", True), ("b", True)]),
        ("if sys.platform == 'win32':\n    import a.b\nelse:\n    import a\n", [("a.b", False), ("a", False)]),
        ("if os.environ['ROS_DISTRO'] == 'humble':\n    import a\n", [("a", True)]),
        ("if ROS_VERSION == 1:\n    import a\nelif ROS_VERSION == 2:\n    import b\n", [("a", True), ("b", False)]),
        ("if os.environ['ROS_VERSION'] != '1':\n    import a\nelse:\n    import b\n", [("a", False), ("b", True)]),
        ("if 2 == get_ros_version():\n    import a\n", [("a", False)]),
        ("if ros_version >= 1:\n    import a\n", [("a", True)]),
        ("if ros_version == 1 == x:\n    import a\n", [("a", True)]),
        ("if version == 1:\n    import a\n", [("a", False)]),
        ("if x:\n    import a\n", [("a", False)]),
        ("x = importlib.import_module('a.b')\n", [("a.b", True)]),
        ("import pytest\nx = pytest.importorskip(\n    'a')\n", [("pytest", False), ("a", True)]),
        ("pytest.importorskip('a')\nfrom a.b import c\nimport ab\n", [("a", True), ("a.b", True), ("ab", False)]),
        ("import a\npytest.importorskip('a')\n", [("a", False), ("a", True)]),
        ("# x = import_module('a')\nprint('import_module(\"a\")')\nx = __import__('b')\n", [("b", True)]),
        ("class A:\n    match x:\n        case 1:\n            import a\n", [("a", False)]),
    ],
)
def test_optional(text: str, expected: list[tuple[str, bool]]) -> None:
    assert imports(text) == expected
    source = Text("a.py", text)
    assert [(item.module, item.optional) for item in walk(source, parse(source))] == expected


def test_places() -> None:
    source = Text("ü.py", 'x = "ü"; import a.b as c, d\nfrom  e.f import (\n    g)\nfrom \\\n  h import i\n')
    mentions = python.collect(source).mentions
    assert [(mention.name, source.slice(mention.span), str(mention.span)) for mention in mentions] == [
        ("a.b", "a.b", "ü.py:1:17"),
        ("d", "d", "ü.py:1:27"),
        ("e.f", "e.f", "ü.py:2:7"),
        ("h", "h", "ü.py:5:3"),
    ]


# --- what is no Python for this interpreter


def syntax(source: Text) -> Problem | None:
    """Return the syntax error of a source, None also if this interpreter accepts it."""
    try:
        parse(source)
    except NotPythonError as error:
        return None if is_of_others(source) else refusal(source, error).problem()
    return None


@pytest.mark.parametrize(
    ("path", "text", "problems"),
    [
        ("a.py", "import a;\ndef f(:\n    import b\n", 1),
        ("a.py", "<<<<<<< HEAD\nimport a\n=======\nimport b;\n", 1),
        ("a.py", "import a; print 'hello'\n", 0),
        ("a.py", "import a;\ntry:\n    pass\nexcept OSError, e:\n    pass\n", 0),
        ("a.py.in", "import a;\nx = @VALUE\n", 0),
        ("a.py", "import a;\nx = {{ cookiecutter.name }\n", 0),
        ("a.py", "import a;\nX = '@NAME@' + @NAME@\n", 0),
    ],
)
def test_unreadable_sources(path: str, text: str, problems: int) -> None:
    source = Text(path, text)
    assert (syntax(source) is not None) == bool(problems)
    facts = python.collect(source)
    assert [opaque.hides for opaque in facts.opaque] == [Facet.USES]
    assert facts.mentions[0][:2] == ("a", "import")
    assert all(mention.optional for mention in facts.mentions)


def test_newer_python_is_no_problem() -> None:
    assert syntax(Text("a.py", "import a; x = 1\ntype X = int\n")) is None


@pytest.mark.parametrize(
    ("text", "caught", "added"),
    [
        ("try:\n    import a\nexcept ImportError:\n    import b\nimport c\n", ["a", "b"], []),
        ("try:\n    import a\nexcept Exception:\n    pass\n", [], []),
        ("with contextlib.suppress(ImportError):\n    import a\n", ["a"], []),
        ("if TYPE_CHECKING:\n    import a\n", [], []),
        ("import a, sys\nsys.path.append(os.path.join(d, 'a'))\nimport a.x\nimport b\n", [], ["a.x"]),
        ("p = f'{x}/lib/a'\nsys.path.insert(\n    0, p)\nimport a\nimport lib.c\nimport d\n", [], ["a", "lib.c"]),
        ("sys.path += ['/opt/a']\nimport a\n", [], ["a"]),
    ],
)
def test_imports_that_need_no_package(text: str, caught: list[str], added: list[str]) -> None:
    facts = python.collect(Text("a.py", text))
    assert list(facts.optional_modules) == caught
    assert [mention.name for mention in facts.mentions if mention.span in facts.path_additions] == added


# --- look-ups


def test_a_computed_import_is_opaque() -> None:
    facts = python.collect(Text("a.py", "x = importlib.import_module(name)\ny = import_module('.z', package=p)\n"))
    assert not facts.mentions
    assert [(opaque.hides, opaque.reason, str(opaque.span)) for opaque in facts.opaque] == [
        (Facet.USES, "the name of the module imported here is computed at run time", "a.py:1:29")
    ]


@pytest.mark.parametrize("seed", range(20))
def test_an_import_of_many_is_unused_if_it_is_among_few(seed: int) -> None:
    """Many imports are counted in another way than few."""
    choice = random.Random(seed)
    names = [f"{choice.choice(('a', 'é', 'a_', 'ab'))}{number}" for number in range(300)]
    uses = [f"{choice.choice(('', 'x', 'x.', '_', '# '))}{name}{choice.choice(('', '_', 'é', '.y', '-'))}1" for name in names]
    text = "".join(f"import {name}\n" for name in names) + "\n".join(choice.sample(uses, 200)) + "\n"
    items = scan(text)
    assert items is not None
    of_many = unused_imports(text, "a.py", items)
    assert of_many == frozenset(start for item in items for start in unused_imports(text, "a.py", [item]))
    assert 0 < len(of_many) < len(names)
