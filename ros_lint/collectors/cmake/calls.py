"""The command calls in a CMake file as they are written, each with the names of the blocks around it.

These calls serve fixes, and rules about the order of commands. The effects of the commands are computed by
:mod:`ros_lint.collectors.cmake.evaluate`.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from ros_lint.collectors.cmake.syntax import Command, ParsedScript
from ros_lint.facts.cmake import MOST_BLOCKS, Call

_OPEN: Final = frozenset({"if", "foreach", "while", "function", "macro"})
_BLOCK_WORDS: Final = frozenset({"else", "elseif", "return", "break", "continue", *(f"end{word}" for word in _OPEN)})


def collect(path: str, parsed: ParsedScript) -> Iterator[Call]:
    """Yield the command calls of a CMake file in order, without the commands that begin or end blocks.

    ``path`` is the path of the file, relative to the root folder of the workspace.
    """
    blocks: list[tuple[str, bool]] = []  # the open blocks, each with whether it or a block around it is for tests
    test = False
    for command in parsed.commands:
        name = command.name
        for_tests = bool(blocks) and blocks[-1][1]
        if name in _OPEN:
            blocks.append((name, for_tests or (name == "if" and _depends_on_tests(command))))
        elif name[:3] == "end" and blocks and name[3:] in _OPEN:
            blocks.pop()
        elif name in ("else", "elseif") and blocks:
            blocks[-1] = ("if", for_tests or (name == "elseif" and _depends_on_tests(command)))
        elif name == "return":
            test = test or for_tests  # after if(NOT BUILD_TESTING) return() endif(), all commands are for tests
        elif name not in _BLOCK_WORDS:
            _, _, args, start, end, line, column, breaks = command
            enclosing = tuple([block for block, _ in blocks[:MOST_BLOCKS]])
            yield Call(name, path, args, start, end, line, column, breaks, enclosing, test or for_tests)


def _depends_on_tests(command: Command) -> bool:
    return any("TEST" in text.upper() or "BENCHMARK" in text.upper() for text, *_ in command.args)
