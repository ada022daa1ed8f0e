"""The modes of list(), such as list(APPEND) (cmake-commands(7))."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

from ros_lint.base.budget import Budget
from ros_lint.base.text import to_bytes
from ros_lint.collectors.cmake.commands.string import ascii_lower, ascii_upper, genex_strip, replace_all, strip
from ros_lint.collectors.cmake.evaluator.regex import RegexError, forget, independent_of_folder, is_in, translated
from ros_lint.collectors.cmake.evaluator.run import Handler, Run
from ros_lint.collectors.cmake.evaluator.values import (
    HOLE,
    LONGEST,
    MAYBE,
    elements,
    embeddable,
    is_fixed,
    is_known,
    join,
    join_with,
    split_cost,
    strip_mark,
)


def _list(run: Run, args: list[str]) -> None:
    if len(args) < 2 or HOLE in args[1]:
        return
    mode, name, rest = args[0], args[1], args[2:]
    for text in rest:
        run.note_brackets(text)
    value = run.get(name) or ""
    run.budget.charge(split_cost(value))
    change = _CHANGES.get(mode)
    if change is not None:
        change(run, name, rest)
        return
    read = _READS.get(mode)
    if read is None:
        return
    if not rest or HOLE in rest[-1]:
        return
    try:
        result = read(elements(value), rest[:-1]) if is_fixed(value) else HOLE
    except (ValueError, IndexError):
        result = HOLE  # CMake reports an error
    if mode == "JOIN" and not is_fixed(value):
        result = HOLE
    run.set(rest[-1], result)


# --- changes -------------------------------------------------------------------------------------------------------


def _append(run: Run, name: str, args: list[str]) -> None:
    if not args:
        return
    value = run.get(name)
    if run.testing and len(run.scopes) == 1:
        run.note_test_elements(name, args)
    run.set(name, join([value, *args]) if value else join(args))
    run.note_literals(2)


def _prepend(run: Run, name: str, args: list[str]) -> None:
    if args:
        value = run.get(name)
        run.set(name, join([*args, value]) if value else join(args))


def _remove_item(run: Run, name: str, args: list[str]) -> None:
    value = run.get(name)
    if not value or not args:  # CMake then does not split the list, so it keeps its escapes
        return
    if not all(is_known(arg) for arg in args) and not all(is_fixed(arg) for arg in args):
        run.set(name, HOLE)
        return
    removed = {*args, *(MAYBE + arg for arg in args)}
    remaining = join(element for element in elements(value) if element not in removed)
    uncertain = all(arg.startswith(MAYBE) for arg in args) and join(elements(value)) != value
    run.set(name, HOLE if uncertain else remaining)


def _remove_duplicates(run: Run, name: str, _args: list[str]) -> None:
    value = run.get(name)
    if value:
        run.set(name, join(dict.fromkeys(elements(value))))


def _reverse(run: Run, name: str, _args: list[str]) -> None:
    value = run.get(name)
    if value:
        run.set(name, join(reversed(elements(value))))


def _sort(run: Run, name: str, args: list[str]) -> None:
    value = run.get(name)
    if not value:
        return
    options = dict(zip(args[::2], args[1::2], strict=False))
    kind = options.get("COMPARE", "STRING")
    items = elements(value)
    comparable = kind == "STRING" or (kind == "FILE_BASENAME" and is_fixed(value))
    if len(items) > 1 and (not comparable or HOLE in value):
        run.set(name, HOLE)
        return

    def key(item: str) -> bytes:
        text = strip_mark(item)[0]
        if kind == "FILE_BASENAME":
            text = text.rpartition("/")[2]
        return to_bytes(ascii_lower(text) if options.get("CASE") == "INSENSITIVE" else text)

    keys = [key(item) for item in items]
    if len(set(keys)) != len(set(items)):
        run.set(name, HOLE)  # CMake's sorting is not stable
        return
    run.set(name, join(sorted(items, key=key, reverse=options.get("ORDER") == "DESCENDING")))


def _filter(run: Run, name: str, args: list[str]) -> None:
    value = run.get(name)
    if not value or len(args) < 3 or args[1] != "REGEX":
        return
    pattern = translated(args[2], run.budget) if is_known(args[2]) else None
    if pattern is None:
        run.set(name, HOLE)
        return
    forget(run)
    included = args[0] == "INCLUDE"
    remaining: list[str] = []
    for item in elements(value):
        plain = strip_mark(item)[0]
        if HOLE in plain:
            remaining.append(item)
            continue
        answer = independent_of_folder(lambda text: "1" if is_in(pattern, text) else "", plain)
        if answer == HOLE:
            run.set(name, HOLE)
            return
        if bool(answer) == included:
            remaining.append(item)
    run.set(name, join(remaining))


def _insert(run: Run, name: str, args: list[str]) -> None:
    value = run.get(name) or ""
    if len(args) < 2:
        return
    items = elements(value)
    try:
        index = int(args[0])
    except ValueError:
        run.set(name, HOLE)
        return
    if not is_fixed(value) or not -len(items) <= index <= len(items):
        run.set(name, HOLE)
        return
    at = index + len(items) if index < 0 else index
    run.set(name, join([*items[:at], *args[1:], *items[at:]]))


def _remove_at(run: Run, name: str, args: list[str]) -> None:
    value = run.get(name) or ""
    items = elements(value)
    try:
        indices = {index + len(items) if index < 0 else index for index in map(int, args)}
    except ValueError:
        indices = {-1}
    if not is_fixed(value) or not all(0 <= index < len(items) for index in indices):
        run.set(name, HOLE)
        return
    run.set(name, join(item for index, item in enumerate(items) if index not in indices))


def _pop(run: Run, name: str, args: list[str], index: int) -> None:
    value = run.get(name) or ""
    if not is_fixed(value):
        for output in args:
            run.set(output, HOLE)
        run.set(name, HOLE)
        return
    items = elements(value)
    if not items:
        for output in args:
            run.set(output, None)
        return
    if not args:
        items.pop(index)
    for output in args:
        run.set(output, items.pop(index) if items else None)
    run.set(name, join(items))


def _pop_back(run: Run, name: str, args: list[str]) -> None:
    _pop(run, name, args, -1)


def _pop_front(run: Run, name: str, args: list[str]) -> None:
    _pop(run, name, args, 0)


def _transform(run: Run, name: str, args: list[str]) -> None:
    output = name
    if "OUTPUT_VARIABLE" in args[:-1]:
        at = args.index("OUTPUT_VARIABLE")
        output = args[at + 1]
        args = args[:at]
    value = run.get(name)
    if not args:
        return
    count = {"APPEND": 1, "PREPEND": 1, "REPLACE": 2}.get(args[0], 0)
    action = _action(args[0], args[1 : 1 + count], run.budget)
    items = elements(value or "")
    if args[0] == "REPLACE" or "REGEX" in args[1 + count :]:
        forget(run)
    try:
        size = len(value or "")
        for index in _selected(items, args[1 + count :], run.budget):
            size -= len(items[index])
            items[index] = _transformed(items[index], action)
            size += len(items[index])
            if size > LONGEST:
                raise ValueError(name)
        run.set(output, join(items))
    except (ValueError, RegexError):
        run.set(output, HOLE)


def _action(mode: str, args: list[str], budget: Budget) -> Callable[[str], str]:
    if mode == "APPEND":
        return lambda text: text + embeddable(args[0])
    if mode == "PREPEND":
        return lambda text: embeddable(args[0]) + text
    if mode == "REPLACE":
        return lambda text: independent_of_folder(lambda piece: replace_all(args[0], args[1], piece, budget), text)
    functions = {"TOUPPER": ascii_upper, "TOLOWER": ascii_lower, "STRIP": strip, "GENEX_STRIP": genex_strip}
    return functions.get(mode, lambda _: HOLE)


def _transformed(item: str, action: Callable[[str], str]) -> str:
    plain, certain = strip_mark(item)
    value = HOLE if HOLE in plain else action(plain)
    if certain:
        return value
    return MAYBE + value if ";" not in value else HOLE


def _selected(items: list[str], selector: list[str], budget: Budget) -> Sequence[int]:
    """Return the indices that a selector of list(TRANSFORM) selects: ``["AT", "-1", "0"]`` -> the last and the first index.

    An index may occur repeatedly. Raises ValueError if CMake stops with an error or the elements are unknown.
    """
    if not selector:
        return range(len(items))
    if not is_fixed(join(items)):
        raise ValueError(selector)
    mode, args = selector[0], selector[1:]
    if mode == "REGEX":
        pattern = translated(args[0], budget)
        if pattern is None or not is_known(join(items)):
            raise ValueError(selector)
        return [index for index, item in enumerate(items) if is_in(pattern, item)]
    numbers = [int(arg) for arg in args]
    placed = [number + len(items) if number < 0 else number for number in numbers]
    if mode == "AT" and all(0 <= number < len(items) for number in placed):
        return placed
    if mode == "FOR" and len(numbers) in (2, 3) and all(0 <= number < len(items) for number in placed[:2]):
        step = numbers[2] if len(numbers) == 3 else 1
        if step > 0 and placed[0] <= placed[1]:
            return range(placed[0], placed[1] + 1, step)
    raise ValueError(selector)


_CHANGES: Final = {
    "APPEND": _append,
    "PREPEND": _prepend,
    "REMOVE_ITEM": _remove_item,
    "REMOVE_DUPLICATES": _remove_duplicates,
    "REVERSE": _reverse,
    "SORT": _sort,
    "FILTER": _filter,
    "INSERT": _insert,
    "REMOVE_AT": _remove_at,
    "POP_BACK": _pop_back,
    "POP_FRONT": _pop_front,
    "TRANSFORM": _transform,
}


# --- questions -----------------------------------------------------------------------------------------------------


def _length(items: list[str], _args: list[str]) -> str:
    return str(len(items))


def _get(items: list[str], args: list[str]) -> str:
    if not items:
        return "NOTFOUND"
    return join(items[_index(arg, len(items))] for arg in args)


def _index(text: str, length: int) -> int:
    index = int(text)
    if not -length <= index < length:
        raise IndexError(text)
    return index


def _join(items: list[str], args: list[str]) -> str:
    return join_with(args[0], items)


def _sublist(items: list[str], args: list[str]) -> str:
    begin, length = int(args[0]), int(args[1])
    if not items:
        return ""
    if not 0 <= begin < len(items) or length < -1:
        raise ValueError(args)
    return join(items[begin : len(items) if length < 0 else begin + length])


def _find(items: list[str], args: list[str]) -> str:
    if not is_fixed(args[0]):
        return HOLE
    if args[0] in items:
        return str(items.index(args[0]))
    return "-1" if is_known(args[0]) and is_known(join(items)) else HOLE


_READS: Final[dict[str, Callable[[list[str], list[str]], str]]] = {
    "LENGTH": _length,
    "GET": _get,
    "JOIN": _join,
    "SUBLIST": _sublist,
    "FIND": _find,
}

COMMANDS: Final[dict[str, Handler]] = {"list": _list}
