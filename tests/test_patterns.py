"""Regular expressions take time in proportion to the text: those of every module, on texts that repeat themselves.

The work is done in a child process with a limit of processor time, because a match cannot be interrupted.
"""

from __future__ import annotations

import importlib
import pkgutil
import re
import signal
import subprocess
import sys
from collections.abc import Iterator, Sequence
from itertools import product
from typing import Any, Final

import pytest

import ros_lint
import ros_lint_rules
from ros_lint.base.gitignore import is_ignored, patterns
from ros_lint.base.text import Text
from ros_lint.collectors import suppressions
from ros_lint.collectors.cmake.evaluator.glob import path_pattern
from ros_lint.collectors.colcon import cmake_lists as colcon_cmake

pytestmark = pytest.mark.slow

_LONG: Final = 100_000
"""How often a part of the table below is repeated: a quadratic expression needs several seconds for that."""
_SHORT: Final = 40
"""How often other parts are repeated: an exponential expression needs days for that."""
_SECONDS: Final = 2.0
"""Of processor time for an expression and a part. A linear expression needs milliseconds."""

_TABLE: Final = (
    # expression, how it is used, prefix, repeated part, suffix
    ("ros_lint.base.auxiliary_files._OLD_VERSION_SUFFIX", "search", "a-old", "1", "!"),
    ("ros_lint.base.auxiliary_files._OLD_VERSION_SUFFIX", "search", "a-old", " v01", "!"),
    ("ros_lint.collectors.cmake.syntax._TOKEN", "match", "", " ", '"b)'),
    ("ros_lint.collectors.cmake.syntax._TOKEN", "match", "", "\n", "[[b)"),
    ("ros_lint.collectors.cmake.syntax._TOKEN", "match", "", "#", '\n"'),
    ("ros_lint.collectors.cmake.syntax._OPENING", "match", "", "#[[]]", "x"),
    ("ros_lint.collectors.colcon.cmake_lists._PROJECT", "search", "project(a", " ", ""),
    ("ros_lint.collectors.colcon.cmake_lists._FIND_PACKAGE", "search", "find_package(a", " ", ""),
    ("ros_lint.collectors.colcon.cmake_lists._SUBDIRECTORY", "search", "add_subdirectory(a", "/", "$"),
    ("ros_lint.collectors.cpp.includes._DIRECTIVE", "search", "", "#include < ", ""),
    ("ros_lint.collectors.cpp.includes._TOKENS", "search", '"', "a\\\n", ""),
    ("ros_lint.collectors.cpp.includes._TOKENS", "search", "'", "a\\\n", ""),
    ("ros_lint.collectors.resources.parameter_files._FIRST", "search", "  .1", " ", ""),
    ("ros_lint.knowledge.install_prefix._LAUNCH_CONTENT['.xml']", "search", "", "<!-- a -->\n", "<a>"),
    ("ros_lint.knowledge.install_prefix._LAUNCH_CONTENT['.xml']", "search", "", "<?a?>", "<a>"),
    ("ros_lint.collectors.cmake.evaluator.truth.NUMBER", "fullmatch", "", "9", "z"),
    ("ros_lint.collectors.cmake.evaluator.truth.NUMBER", "fullmatch", "0x", "f", "z"),
)
"""Expressions that took exponential or quadratic time for these texts."""
_COMMENTED: Final = (
    ("CMakeLists.txt", "#", ("[", "#[[\n", "[=[\n", "#[=[ ")),
    ("package.xml", "<!-- -->", ("<?", "<![CDATA[", "<!DOCTYPE [", "<!-- ")),
    ("a.cpp", "//", ('R"(', 'R"a(\n', "/*", "\\\n")),
    ("a.msg", "#", ("'", "\t")),
)
"""Paths of files, a sign of their comments, and what opens a comment or string that is never closed."""
_PARTS: Final = (" ", "\t", "\n", "a", "A", "1", "_", ".", "-", "/", "#", '"', "\\\n", "()", "[]", "<a>", "<!---->", "<?a?>")
_METHODS: Final = ("search", "match", "fullmatch")


def _compiled() -> dict[str, re.Pattern[Any]]:
    """Return the expressions that modules hold, also in dictionaries and lists, by module and name."""
    found: dict[str, re.Pattern[Any]] = {}
    for package in (ros_lint, ros_lint_rules):
        for info in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            if not info.name.endswith("__main__"):
                names = vars(importlib.import_module(info.name))
                for name, value in [entry for entry in names.items() if not entry[0].startswith("__")]:
                    found.update(_held(f"{info.name}.{name}", value))
    return found


def _held(name: str, value: object) -> Iterator[tuple[str, re.Pattern[Any]]]:
    if isinstance(value, re.Pattern):
        yield name, value
    elif isinstance(value, dict):
        for key, item in value.items():
            yield from _held(f"{name}[{key!r}]", item)
    elif isinstance(value, (list, tuple)):
        for index, item in enumerate(value):
            yield from _held(f"{name}[{index}]", item)


def _limit(label: str) -> None:
    """Print what comes next, and end the process when that takes too long."""
    print(label, flush=True)
    signal.setitimer(signal.ITIMER_PROF, _SECONDS)


def _use(label: str, pattern: re.Pattern[Any], methods: Sequence[str], text: str) -> None:
    _limit(label)
    given = text.encode() if isinstance(pattern.pattern, bytes) else text
    for method in methods:
        getattr(pattern, method)(given)


def _run_table() -> None:
    compiled = _compiled()
    for name, method, prefix, part, suffix in _TABLE:
        _use(f"{name} {part!r}", compiled[name], [method], prefix + part * _LONG + suffix)


def _run_all() -> None:
    parts = [*_PARTS, *("".join(pair) for pair in product(_PARTS, repeat=2))]
    for name, pattern in _compiled().items():
        for part in parts:
            _use(f"{name} {part!r}", pattern, _METHODS, part * _SHORT + "\0")


def _run_collectors() -> None:
    for prefix, part in (("", "find_package(a "), ("", "pkg_check_modules(a "), ("pkg_check_modules(", "a")):
        _limit(f"colcon_cmake.depends {part!r}")
        colcon_cmake.depends(Text("CMakeLists.txt", prefix + part * _LONG))
    for path, sign, parts in _COMMENTED:
        for part in (*parts, " ", "a ", "#", "/", "ros-lint: ignore[", '\\"', '"'):
            _limit(f"suppressions of {path} {part!r}")
            list(suppressions.collect(Text(path, f"{sign} ros-lint: ignore[x] {part * (_LONG // 4)}a")))
            list(suppressions.collect(Text(path, f"{part * (_LONG // 4)}\n{sign} ros-lint: ignore[x]")))


def _run_globs() -> None:
    path = "/".join(["a" * 200] * 15)
    for pattern in ("*a" * 8 + "b", "*a" * 2000 + "b", "**/" * 12 + "b", "**/" * 1300 + "b", "**/*a*/" * 500):
        _limit(f".gitignore {pattern[:40]}")
        assert not is_ignored(list(patterns("", pattern)), path)
    for pattern in (" " * _LONG + "b", "\\ " * _LONG):
        _limit(f".gitignore {pattern[:40]}")
        list(patterns("", pattern))
    for count in (8, 2000):
        _limit(f"file(GLOB) of {count} stars")
        assert not path_pattern(["*a" * count + "b"], recurse=True).fullmatch(path)


def _check(name: str) -> None:
    """Run a function in a child process. The last line that it has printed says what took too long."""
    done = subprocess.run([sys.executable, __file__, name], capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"too slow: {done.stdout.splitlines()[-1:]}\n{done.stderr[-2000:]}"


def test_expressions_that_were_slow_take_linear_time() -> None:
    assert _compiled().keys() >= {name for name, *_ in _TABLE}
    _check("_run_table")


def test_collectors_that_were_slow_take_linear_time() -> None:
    _check("_run_collectors")


def test_wildcards_take_linear_time() -> None:
    _check("_run_globs")


def test_no_expression_takes_exponential_time() -> None:
    _check("_run_all")


if __name__ == "__main__":
    globals()[sys.argv[1]]()
