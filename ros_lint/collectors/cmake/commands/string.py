"""The modes of string(), such as string(REPLACE) (cmake-commands(7))."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Final

from ros_lint.base.budget import Budget
from ros_lint.base.text import to_bytes
from ros_lint.collectors.cmake.evaluator.regex import RegexError, all_matches, clear, find, forget, independent_of_folder, store
from ros_lint.collectors.cmake.evaluator.run import Handler, Run
from ros_lint.collectors.cmake.evaluator.values import (
    ATOM,
    BINARY,
    HOLE,
    LONGEST,
    PREFIX,
    SLOW,
    TREE,
    embeddable,
    is_fixed,
    is_known,
    join,
    join_with,
)

_UPPER: Final = {number: number - 32 for number in range(ord("a"), ord("z") + 1)}
_LOWER: Final = {number: number + 32 for number in range(ord("A"), ord("Z") + 1)}


def _string(run: Run, args: list[str]) -> None:
    if len(args) < 2:
        return
    mode, rest = args[0], args[1:]
    run.budget.charge(SLOW * sum(map(len, rest)))
    if mode in ("APPEND", "PREPEND"):
        if len(rest) > 1:
            _extend(run, rest[0], _concat(*rest[1:]), mode == "APPEND")
        return
    if mode == "REGEX":
        _regex(run, rest)
        return
    function = _FUNCTIONS.get(mode)
    if function is None:
        for output in _outputs(mode, rest):
            _assign(run, output, HOLE)
        return
    place, compute = function
    if len(rest) <= (max(place, 0)):
        return
    output = rest.pop(place)
    try:
        value = compute(*rest)
    except (ValueError, TypeError):
        value = HOLE  # CMake reports an error
    _assign(run, output, value, *rest)


def _outputs(mode: str, args: list[str]) -> list[str]:
    """Return the output variables of a mode of string() that is not evaluated, such as ``string(JSON out GET ...)``.

    ``args`` are the arguments after the mode.
    """
    if mode == "JSON":
        return [args[0], args[2]] if args[1:2] == ["ERROR_VARIABLE"] and len(args) > 2 else args[:1]
    if mode == "CONFIGURE":
        return args[1:2]
    return args[:1] if mode in ("TIMESTAMP", "UUID") else args[-1:]


def _assign(run: Run, name: str, value: str, *texts: str) -> None:
    """Set the variable ``name`` to ``value``, which string() computed from ``texts``.

    If the value is partly unknown and a text has square brackets, it is recorded that the value may have unpaired brackets.
    """
    if HOLE in value and any("[" in text or "]" in text for text in texts):
        run.has_unpaired_brackets = True
    if HOLE not in name:
        run.set(name, value if len(value) <= LONGEST else HOLE)


def _extend(run: Run, name: str, text: str, append: bool) -> None:
    if HOLE in name:
        return
    value = run.get(name) or ""
    text = embeddable(text)
    _assign(run, name, embeddable(value) + text if append else text + embeddable(value))


def ascii_upper(text: str) -> str:
    """Return a text with its ASCII letters in upper case; HOLE (unknown) if a part of the text is unknown."""
    return HOLE if ATOM in text else text.translate(_UPPER)


def ascii_lower(text: str) -> str:
    """Return a text with its ASCII letters in lower case; HOLE (unknown) if a part of the text is unknown."""
    return HOLE if ATOM in text else text.translate(_LOWER)


def _known(function: Callable[..., str]) -> Callable[..., str]:
    """Return a version of ``function`` that accepts arguments with unknown parts, and then returns HOLE (an unknown text)."""

    def guarded(*args: str) -> str:
        return function(*args) if all(map(is_known, args)) else HOLE

    return guarded


def _find(text: str, part: str, reverse: str = "") -> str:
    encoded, encoded_part = to_bytes(text), to_bytes(part)
    return str(encoded.rfind(encoded_part) if reverse == "REVERSE" else encoded.find(encoded_part))


def _replace(old: str, new: str, *inputs: str) -> str:
    text = _concat(*inputs)
    if not old or not is_fixed(old) or not is_fixed(text) or text.count(old) * len(new) > LONGEST:
        return HOLE
    if ATOM not in text or old in (TREE, BINARY, PREFIX) or old.startswith((f"{TREE}/", f"{BINARY}/", f"{PREFIX}/")):
        return text.replace(old, embeddable(new))
    return independent_of_folder(lambda piece: piece.replace(old, new), text) if is_fixed(new) and ATOM not in new else HOLE


def _length(text: str) -> str:
    return str(len(to_bytes(text)))


def _substring(text: str, begin: str, length: str) -> str:
    encoded = to_bytes(text)
    start, count = int(begin), int(length)
    if not 0 <= start <= len(encoded) or count < -1:
        return HOLE
    try:
        return encoded[start : len(encoded) if count < 0 else start + count].decode()
    except UnicodeDecodeError:
        return HOLE  # part of a multi-byte character


def strip(text: str) -> str:
    """Return a text without white space at its start and end."""
    return text if ATOM in text and text.strip(" \t\n\r\f\v") == text else text.strip(" \t\n\r\f\v")


def genex_strip(text: str) -> str:
    """Return a text without its generator expressions and without empty list elements."""
    letters: list[str] = []
    index = 0
    while index < len(text):
        if text.startswith("$<", index):
            depth, end = 0, index
            while end < len(text):
                if text.startswith("$<", end):
                    depth += 1
                    end += 2
                    continue
                depth -= text[end] == ">"
                end += 1
                if not depth:
                    break
            if depth:
                return HOLE
            index = end
        else:
            letters.append(text[index])
            index += 1
    return ";".join(filter(None, "".join(letters).split(";")))


def _repeat(text: str, count: str) -> str:
    number = int(count)
    if number < 0 or number * len(text) > LONGEST:
        return HOLE
    return text * number if text else ""


def _join(glue: str, *inputs: str) -> str:
    return join_with(glue, inputs)


def _concat(*inputs: str) -> str:
    if len(inputs) < 2:
        return "".join(inputs)
    return "".join(map(embeddable, inputs)) if sum(map(len, inputs)) <= LONGEST else HOLE


def _compare(how: str, left: str, right: str) -> str:
    first, second = to_bytes(left), to_bytes(right)
    answers = {
        "EQUAL": first == second,
        "NOTEQUAL": first != second,
        "LESS": first < second,
        "GREATER": first > second,
        "LESS_EQUAL": first <= second,
        "GREATER_EQUAL": first >= second,
    }
    return "1" if answers.get(how) else "0" if how in answers else HOLE


def _ascii(*codes: str) -> str:
    numbers = [int(code) for code in codes]
    return "".join(map(chr, numbers)) if all(8 < number < 127 for number in numbers) else HOLE


def _hex(text: str) -> str:
    return to_bytes(text).hex()


def _identifier(text: str) -> str:
    identifier = re.sub(rb"[^A-Za-z0-9_]", b"_", to_bytes(text)).decode()
    return f"_{identifier}" if identifier[:1].isdigit() else identifier


def _hash(name: str) -> Callable[..., str]:
    def hashed(text: str) -> str:
        import hashlib  # noqa: PLC0415  (few packages need it)

        return hashlib.new(name, to_bytes(text), usedforsecurity=False).hexdigest()

    return _known(hashed)


_FUNCTIONS: Final[dict[str, tuple[int, Callable[..., str]]]] = {
    "FIND": (2, _known(_find)),
    "REPLACE": (2, _replace),
    "CONCAT": (0, _concat),
    "JOIN": (1, _join),
    "TOLOWER": (1, ascii_lower),
    "TOUPPER": (1, ascii_upper),
    "LENGTH": (1, _known(_length)),
    "SUBSTRING": (3, _known(_substring)),
    "STRIP": (1, _known(strip)),
    "GENEX_STRIP": (1, genex_strip),
    "REPEAT": (2, _known(_repeat)),
    "COMPARE": (3, _known(_compare)),
    "ASCII": (-1, _known(_ascii)),
    "HEX": (1, _known(_hex)),
    "MAKE_C_IDENTIFIER": (1, _known(_identifier)),
    "MD5": (0, _hash("md5")),
    "SHA1": (0, _hash("sha1")),
    "SHA224": (0, _hash("sha224")),
    "SHA256": (0, _hash("sha256")),
    "SHA384": (0, _hash("sha384")),
    "SHA512": (0, _hash("sha512")),
    "SHA3_224": (0, _hash("sha3_224")),
    "SHA3_256": (0, _hash("sha3_256")),
    "SHA3_384": (0, _hash("sha3_384")),
    "SHA3_512": (0, _hash("sha3_512")),
}
"""By mode: the index of the output variable among the arguments, and the function that computes its value.

The function takes the arguments without the output variable."""


# --- expressions ---------------------------------------------------------------------------------------------------


def _regex(run: Run, args: list[str]) -> None:
    mode = args[0]
    if mode == "REPLACE" and len(args) > 4:
        regex, new, name, text = args[1], args[2], args[3], _concat(*args[4:])
        _assign(run, name, _regex_replace(run, regex, new, text), new, text)
    elif mode in ("MATCH", "MATCHALL") and len(args) > 3:
        regex, name, text = args[1], args[2], _concat(*args[3:])
        _assign(run, name, _regex_match(run, regex, text) if mode == "MATCH" else _regex_all(run, regex, text), text)


def _regex_match(run: Run, regex: str, text: str) -> str:
    if not (is_known(regex) and is_known(text)):
        forget(run)
        return HOLE
    matches = find(run, regex, text)
    if matches is None:
        return HOLE
    return (run.get("CMAKE_MATCH_0") or "") if matches else ""


def _regex_all(run: Run, regex: str, text: str) -> str:
    if not (is_known(regex) and is_known(text)):
        forget(run)
        return HOLE
    try:
        matches = all_matches(regex, text, run.budget)[:-1]
    except RegexError:
        forget(run)
        return HOLE
    clear(run)
    for _, _, groups in matches:
        clear(run)
        store(run, groups)
    return join(match for _, match, _ in matches)


def _regex_replace(run: Run, regex: str, new: str, text: str) -> str:
    if not (is_known(regex) and is_fixed(new) and is_fixed(text)):
        forget(run)
        return HOLE
    try:
        value = independent_of_folder(lambda piece, template: replace_all(regex, template, piece, run.budget), text, new)
        if is_known(text):
            clear(run)
            for _, _, groups in all_matches(regex, text, run.budget)[:-1]:
                clear(run)
                store(run, groups)
    except RegexError:
        forget(run)
        return HOLE
    if not is_known(text):
        forget(run)
    return value


def replace_all(regex: str, template: str, text: str, budget: Budget) -> str:
    """Return ``text`` with every match of ``regex`` replaced by ``template``, as string(REGEX REPLACE) does.

    The result is HOLE (unknown) if it would be too long. Raises RegexError if the expression or the template cannot be
    evaluated.
    """
    parts = _replacement(template)
    pieces: list[str] = []
    size = 0
    for unmatched, _, groups in all_matches(regex, text, budget):
        pieces.append(unmatched)
        if groups:
            size += len(template) + sum(map(len, groups))
            if size > LONGEST:
                return HOLE
            pieces += [part if isinstance(part, str) else (groups[part] if part < len(groups) else "") for part in parts]
    return "".join(pieces)


def _replacement(template: str) -> list[str | int]:
    parts: list[str | int] = []
    index = 0
    while index < len(template):
        letter = template[index]
        if letter != "\\":
            parts.append(letter)
            index += 1
            continue
        following = template[index + 1 : index + 2]
        if "0" <= following <= "9":
            parts.append(int(following))
        elif following == "n":
            parts.append("\n")
        elif following == "\\":
            parts.append("\\")
        else:
            raise RegexError(template)
        index += 2
    return parts


COMMANDS: Final[dict[str, Handler]] = {"string": _string}
