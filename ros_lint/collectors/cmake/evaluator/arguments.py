"""Parsing of command arguments with keywords, as cmake_parse_arguments() and most commands parse them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache

from ros_lint.collectors.cmake.evaluator.values import HOLE, MAYBE, UNPAIRED_HOLE, join, split

_FLAG, _SINGLE, _LIST, _MAYBE = 1, 2, 3, 4


@lru_cache(maxsize=512)
def _keywords(prefix: str, options: str, single_names: str, multis: str) -> tuple[dict[str, int], dict[str, str | None]]:
    """Return the kind of each keyword (_FLAG, _SINGLE or _LIST), and the variables that result from a call without arguments.

    The parameters are the first arguments of cmake_parse_arguments().
    """
    flags, singles, lists = split(options), split(single_names), split(multis)
    kinds = {**dict.fromkeys(lists, _LIST), **dict.fromkeys(singles, _SINGLE), **dict.fromkeys(flags, _FLAG)}
    initial: dict[str, str | None] = {f"{prefix}_{name}": "FALSE" for name in flags}
    unset = (*singles, *lists, "UNPARSED_ARGUMENTS", "KEYWORDS_MISSING_VALUES")
    initial.update({f"{prefix}_{name}": None for name in unset})
    return kinds, initial


def parse_keywords(prefix: str, options: str, singles: str, multis: str, args: Sequence[str]) -> dict[str, str | None]:
    """Return the variables that cmake_parse_arguments() sets, with their values; the value None unsets a variable."""
    kinds, initial = _keywords(prefix, options, singles, multis)
    values = initial.copy()
    arguments: dict[str, list[str]] = {}
    unparsed: list[str] = []
    state = ""
    expected = 0
    if args and args[-1][:1] == MAYBE and kinds.get(args[-1][1:]) == _FLAG:  # a last flag ends no list of values
        values[f"{prefix}_{args[-1][1:]}"] = HOLE
        args = args[:-1]
    for arg in args:
        kind = kinds.get(arg)
        if kind == _FLAG:
            values[f"{prefix}_{arg}"] = "TRUE"
            expected = 0
        elif kind is not None:
            state, expected = arg, kind
            arguments.setdefault(arg, [])
        elif expected == _SINGLE:
            values[f"{prefix}_{state}"] = arg
            expected = _MAYBE if arg in (HOLE, UNPAIRED_HOLE) or arg.startswith(MAYBE) else 0
        elif expected == _LIST:
            arguments[state].append(arg)
        elif expected == _MAYBE and arg.startswith(MAYBE):
            values[f"{prefix}_{state}"] = HOLE
        else:
            expected = 0
            unparsed.append(arg)
        if arg[:1] == MAYBE and arg[1:] in kinds:
            return dict.fromkeys(values, HOLE)
    if arguments:
        lists = [name for name in arguments if kinds[name] == _LIST]
        values.update({f"{prefix}_{name}": join(arguments[name]) for name in lists})
        without_values = [name for name in lists if not arguments[name]]
        without_values += [name for name in arguments if kinds[name] == _SINGLE and values[f"{prefix}_{name}"] is None]
        if without_values:
            values[f"{prefix}_KEYWORDS_MISSING_VALUES"] = join(without_values)
    if unparsed:
        values[f"{prefix}_UNPARSED_ARGUMENTS"] = join(unparsed)
    return values


def sections(args: Iterable[str], keywords: Mapping[str, int]) -> dict[str, list[str]]:
    """Return arguments grouped by the keyword before them. The key "" has the arguments without a keyword.

    ``keywords`` has the number of arguments of each keyword, -1 for any number. Surplus arguments are under "", too.
    """
    arguments: dict[str, list[str]] = {"": []}
    current, remaining = arguments[""], -1
    for arg in args:
        count = keywords.get(arg)
        if count is not None:
            current, remaining = arguments.setdefault(arg, []), count
            if not remaining:
                current, remaining = arguments[""], -1
        else:
            if not remaining:
                current, remaining = arguments[""], -1
            current.append(arg)
            remaining -= remaining > 0
    return arguments


def with_one_destination(args: list[str]) -> list[str]:
    """Return the arguments of install(); a DESTINATION whose value depends on an if() becomes unknown (HOLE)."""
    result: list[str] = []
    for arg in args:
        if arg[:1] == MAYBE and result[-2:-1] == ["DESTINATION"] and result[-1][:1] in (MAYBE, HOLE):
            result[-1] = HOLE
        else:
            result.append(arg)
    return result
