"""The modules that a Python file imports, found in its text and in its syntax tree."""

from __future__ import annotations

import pytest

from ros_lint.base.text import Text
from ros_lint.collectors.python.imported_paths import imported_paths

PARSED = "\nif False:\n    __import__('parsed')\n"
"""Source that names a function that imports modules, so that the file is parsed."""


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ("import a", {"a"}),
        ("import a.b as c, d", {"a", "a/b", "d"}),
        ("from a.b import c as d, e", {"a", "a/b", "a/b/c", "a/b/e"}),
        ("from a import (b,  # the first, really\n    c,\n)", {"a", "a/b", "a/c"}),
        ("from a \\\n    import b, \\\n    c", {"a", "a/b", "a/c"}),
        ("from a import *", {"a", "a/*"}),
        ("from . import b", {"robot", "robot/b"}),
        ("from .b import c", {"robot", "robot/b", "robot/b/c"}),
        ("from ..b import c", {"b", "b/c"}),
        ("import a; import b", {"a", "b"}),
        ("def f():\n\tfrom a import b\n\treturn b", {"a", "a/b"}),
        ("important = 1\nfrom_import = 2", set()),
    ],
)
def test_the_text_and_the_tree_have_the_same_imports(source: str, expected: set[str]) -> None:
    assert imported_paths(Text("f", source), "robot/f.py") == expected
    assert imported_paths(Text("f", source + PARSED), "robot/f.py") == expected | {"parsed"}


def test_a_computed_module_hides_the_imports() -> None:
    assert imported_paths(Text("f", "import_module(name)"), "f.py") is None
    assert imported_paths(Text("f", "import_module(name"), "f.py") is None, "the source is not valid Python"
