"""Scripts whose values grow and grow take neither all memory nor all time.

They run in a child process, which may take a gigabyte and some seconds.
"""

from __future__ import annotations

import resource
import signal
import subprocess
import sys
from typing import Final

import pytest

from tests.cmake_runs import run

_MEMORY: Final = 1 << 30
_SECONDS: Final = 8.0
"""Of processor time for one script."""


def _loop(rounds: int, body: str) -> str:
    return f"foreach(i RANGE {rounds})\n{body}\nendforeach()\n"


_TEXT: Final = "set(T aaaaaaaa)\n" + _loop(15, 'set(T "${T}${T}")')
"""A variable T of half a million characters, half as many as a value may have."""
_LIST: Final = 'set(L "aa;bb")\n' + _loop(16, "set(L ${L} ${L})")
"""A variable L of 250,000 elements."""

CMAKE: Final = {
    "macro": 'macro(m x)\nm("${x}${x}")\nendmacro()\nm(aaaa)',
    "function in a macro": 'macro(a x)\nfunction(f)\nset(z "'
    + "${x}" * 1000
    + '")\nendfunction()\na("${x}${x}")\nendmacro()\na(aa)',
    "arguments of a function": "function(f)\nf(${ARGV} ${ARGV})\nendfunction()\nf(a b c)",
    "text in a loop": _loop(20_000, 'set(x "${x}' + "a" * 50 + '")'),
    "many texts": _TEXT + _loop(20_000, 'set(v${i} "${T}x")'),
    "many cache entries": _TEXT + _loop(20_000, 'set(v${i} "${T}x" CACHE STRING "")'),
    "many arguments": _TEXT + "set(z " + '"${T}x" ' * 20_000 + ")",
    "many lists": _LIST + "set(z " + "${L} " * 20_000 + ")",
    "transform append": "set(L a a)\n" + _loop(60, 'list(TRANSFORM L APPEND "${L}")'),
    "transform prepend": "set(L a a)\n" + _loop(60, 'list(TRANSFORM L PREPEND "${L}")'),
    "transform replace": "set(L a a)\n" + _loop(60, 'list(TRANSFORM L REPLACE a "${L}")'),
    "concat": _TEXT + "string(CONCAT y " + "${T} " * 20_000 + ")",
    "replace": _TEXT + "string(REPLACE x y z " + "${T} " * 20_000 + ")",
    "match": _TEXT + "string(REGEX MATCHALL x z " + "${T} " * 20_000 + ")",
    "long expressions": _TEXT + _loop(200, 'if(x MATCHES "${T}${i}")\nendif()'),
    "property": _TEXT + _loop(9000, 'set_property(GLOBAL APPEND_STRING PROPERTY q "${T}")'),
    "loops in loops": _LIST + "foreach(x IN LISTS L)\n" * 100 + "set(a b)\n" + "endforeach()\n" * 100,
    "elements": _LIST + _loop(40_000, "if(x IN_LIST L)\nendif()"),
    "sort": _LIST + _loop(20_000, "list(SORT L)"),
    "brackets": 'set(B "[a]")\n' + _loop(16, 'set(B "${B}${B}")') + _loop(20_000, "set(z ${B})"),
    "keywords": _LIST + 'cmake_parse_arguments("${L}" "" "" "${L}" a)',
    "names": "find_package(x)\n" + _TEXT + _loop(2000, "set(c ${${T}${i}})"),
    "hexadecimal": _TEXT + _loop(20_000, 'string(HEX "${T}" c)'),
    "generator expressions": 'string(REPEAT "$<" 400000 p)\n' + _loop(1000, 'string(GENEX_STRIP "${p}" q)'),
    "sums": 'string(REPEAT "1+" 400000 p)\n' + _loop(1000, 'math(EXPR z "${p}1")'),
    "elements that may be missing": "find_package(q)\nif(q_X)\nlist(APPEND l b)\nendif()\nset(z " + '"' + "${l};" * 40_000 + '")',
    "folders": "foreach(a 1 2 3 4 5 6 7 8)\n" * 8 + "install(DIRECTORY src DESTINATION share)\n" + "endforeach()\n" * 8,
}


def _run_cmake(name: str) -> None:
    run(CMAKE[name], tuple(f"src/{number}.cpp" for number in range(1000)))


@pytest.mark.parametrize("name", CMAKE)
def test_cmake_scripts_that_grow_end(name: str) -> None:
    done = subprocess.run([sys.executable, "-m", "tests.test_bounds", name], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-2000:]


if __name__ == "__main__":
    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
    signal.setitimer(signal.ITIMER_PROF, _SECONDS)
    _run_cmake(sys.argv[1])
