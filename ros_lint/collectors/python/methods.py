"""String methods and constants of Python that the evaluators of launch files, setup.py and substitutions treat in the same way.

No method returns a text that is longer than its arguments. Each evaluator defines the results for unknown values,
and for all other methods.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

TRUTHS: Final = frozenset(
    {
        "endswith", "isalnum", "isalpha", "isdigit", "isidentifier", "islower", "isnumeric", "isspace", "isupper", "startswith",
    }
)  # fmt: skip
"""Methods of texts that return a boolean."""

NUMBERS: Final = frozenset({"count", "find", "index", "rfind", "rindex"})
"""Methods of texts that return a number."""

SPLITS: Final = frozenset({"partition", "rpartition", "rsplit", "split", "splitlines"})
"""Methods of texts that return several texts."""

STRIPS: Final = frozenset({"lstrip", "removeprefix", "removesuffix", "rstrip", "strip"})
"""Methods that remove characters from the ends of a text."""

LENGTH_PRESERVING: Final = frozenset({"capitalize", "casefold", "endswith", "lower", "startswith", "title", "upper"})
"""Methods that a Python expression of launch may call. Their result is at most three times as long as the text."""

TEXT_METHODS: Final = (
    TRUTHS | NUMBERS | SPLITS | STRIPS | {"capitalize", "casefold", "lower", "swapcase", "title", "upper"}
)  # fmt: skip

CONSTANTS: Final[Mapping[str, str]] = {
    "os.curdir": ".",
    "os.linesep": "\n",
    "os.name": "posix",
    "os.path.sep": "/",
    "os.pardir": "..",
    "os.sep": "/",
}
