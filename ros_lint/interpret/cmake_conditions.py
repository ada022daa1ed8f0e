"""The conditions of if(), elseif() and while(): cmake's if(7), with answers that may not be known.

An answer is true, false, unknown, or *likely* and *unlikely*: true or false unless the user sets an option or a variable.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import TYPE_CHECKING, Final, NamedTuple

from ros_lint.collectors.cmake_syntax import BRACKET, CLOSE, LITERAL, OPEN, QUOTED, UNQUOTED, Command
from ros_lint.interpret.cmake_values import HOLE, SOURCE, elements, is_fixed, is_known, split

if TYPE_CHECKING:
    from ros_lint.interpret.cmake_run import Run

FALSE: Final = 0
UNLIKELY: Final = 1
UNKNOWN: Final = 2
LIKELY: Final = 3
TRUE: Final = 4


class Truth(NamedTuple):
    """An answer, and whether the tests must be enabled for it to be true, or to be false."""

    value: int
    test_if_true: bool = False
    test_if_false: bool = False


class _Token(NamedTuple):
    text: str
    quoted: bool
    soft: bool
    """Whether its value is one that a user may change."""


_TEST_VARIABLE = re.compile(
    r"(?:\A|_)(?:BUILD_TESTING|(?:CATKIN|AMENT)_ENABLE_TESTING|(?:BUILD|ENABLE)_(?:\w+_)?TEST(?:S|ING)?|BUILD_TEST)\Z"
)
_REFERENCE = re.compile(r"\$\{([A-Za-z0-9_./+-]+)\}")
_NUMBER = re.compile(r"\s*[-+]?(?:0[xX][0-9a-fA-F]+|(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)")
_TRUE_WORDS: Final = frozenset({"ON", "YES", "TRUE", "Y"})
_FALSE_WORDS: Final = frozenset({"", "OFF", "NO", "FALSE", "N", "IGNORE", "NOTFOUND"})


def condition(run: Run, command: Command) -> Truth:
    """Return what a condition evaluates to."""
    tokens: list[_Token] = []
    for text, kind, _, _ in command.args:
        if kind == UNQUOTED:
            soft = _is_soft(run, text)
            tokens += [_Token(value, False, soft) for value in split(run.evaluated(text))]
        elif kind == QUOTED:
            tokens.append(_Token(run.evaluated(text), True, _is_soft(run, text)))
        else:
            tokens.append(_Token(text, kind in (LITERAL, BRACKET), False))
    if any(kind in (OPEN, CLOSE) for _, kind, _, _ in command.args) or len(tokens) > 1:
        return _Parser(run, tokens).whole()
    return _word(run, tokens[0]) if tokens else Truth(FALSE)


def _is_soft(run: Run, text: str) -> bool:
    return any(run.may_be_set(name) for name in _REFERENCE.findall(text))


class _Parser:
    """Reduces tokens as CMake does: parentheses, unary tests, binary tests, NOT, then AND and OR from left to right."""

    def __init__(self, run: Run, tokens: list[_Token]) -> None:
        self.run = run
        self.tokens = tokens
        self.at = 0

    def whole(self) -> Truth:
        truth = self.chain()
        return truth if self.at == len(self.tokens) else Truth(UNKNOWN)

    def keyword(self, ahead: int = 0) -> str:
        """Return the token at hand if it can be a keyword, else ""."""
        at = self.at + ahead
        if at >= len(self.tokens) or self.tokens[at].quoted:
            return ""
        return self.tokens[at].text

    def chain(self) -> Truth:
        truth = self.negation()
        while self.keyword() in ("AND", "OR"):
            both = self.keyword() == "AND"
            self.at += 1
            other = self.negation()
            truth = _and(truth, other) if both else _or(truth, other)
        return truth

    def negation(self) -> Truth:
        if self.keyword() == "NOT" and self.at + 1 < len(self.tokens):
            self.at += 1
            return _not(self.negation())
        return self.test()

    def test(self) -> Truth:
        if self.at >= len(self.tokens):
            return Truth(UNKNOWN)
        word = self.keyword()
        if word == "(":
            self.at += 1
            truth = self.chain()
            if self.keyword() != ")":
                self.at = len(self.tokens) + 1
                return Truth(UNKNOWN)
            self.at += 1
            return self.binary_after(truth)
        unary = _UNARY.get(word)
        if unary is not None and self.at + 1 < len(self.tokens) and self.keyword(1) not in (")", "AND", "OR"):
            operand = self.tokens[self.at + 1]
            self.at += 2
            return unary(self.run, operand)
        left = self.tokens[self.at]
        self.at += 1
        binary = _BINARY.get(self.keyword())
        if binary is not None and self.at + 1 < len(self.tokens):
            right = self.tokens[self.at + 1]
            self.at += 2
            return _softened(binary(self.run, left, right), self.run, left, right)
        return _word(self.run, left)

    def binary_after(self, truth: Truth) -> Truth:
        """A parenthesis may be the left side of a comparison; nobody writes that."""
        if self.keyword() in _BINARY:
            self.at = len(self.tokens) + 1
            return Truth(UNKNOWN)
        return truth


def _not(truth: Truth) -> Truth:
    return Truth(TRUE - truth.value, truth.test_if_false, truth.test_if_true)


def _and(left: Truth, right: Truth) -> Truth:
    # min() is Kleene's AND, and with the two half-sure answers between the others it keeps what is true by default.
    return Truth(
        min(left.value, right.value), left.test_if_true or right.test_if_true, left.test_if_false and right.test_if_false
    )


def _or(left: Truth, right: Truth) -> Truth:
    return Truth(
        max(left.value, right.value), left.test_if_true and right.test_if_true, left.test_if_false or right.test_if_false
    )


def _soften(value: int) -> int:
    return {TRUE: LIKELY, FALSE: UNLIKELY}.get(value, value)


def _softened(value: int, run: Run, *tokens: _Token) -> Truth:
    """Return an answer, less sure if it rests on something that a user may change."""
    soft = any(token.soft or (not token.quoted and run.is_soft(token.text)) for token in tokens)
    return Truth(_soften(value) if soft else value)


def constant(text: str) -> bool | None:
    """Return what a value means as a condition, or None when it is neither a true nor a false constant."""
    upper = text.upper()
    if upper in _TRUE_WORDS:
        return True
    if upper in _FALSE_WORDS or upper.endswith("-NOTFOUND"):
        return False
    if text[:1].isdigit() or text[:1] in "+-.":
        try:
            return float(text) != 0
        except ValueError:
            return None
    return None


def _word(run: Run, token: _Token) -> Truth:
    """A constant, a variable or a string."""
    text = token.text
    if not is_fixed(text):
        return Truth(UNKNOWN)
    known = constant(text)
    if known is not None:
        return Truth(_soften(TRUE if known else FALSE) if token.soft else (TRUE if known else FALSE))
    if token.quoted:
        return Truth(UNLIKELY if token.soft else FALSE)
    if _TEST_VARIABLE.search(text):
        return _tests_enabled(run, text)
    value = run.get(text)
    if text.endswith("_FOUND"):
        run.tested.add(text)
    if value is None:
        soft = token.soft or run.may_be_set(text)
        return Truth(UNLIKELY if soft else FALSE)
    if not is_fixed(value):
        return Truth(UNKNOWN)
    answer = FALSE if constant(value) is False else TRUE
    return Truth(_soften(answer) if token.soft or run.is_soft(text) else answer)


def _tests_enabled(run: Run, name: str) -> Truth:
    """Tests are enabled unless the user says otherwise (ament_cmake_test; reference, section C1.5)."""
    value = run.get(name)
    if name == "BUILD_TESTING" or value is None or not is_fixed(value):
        usual = LIKELY if name == "BUILD_TESTING" else UNLIKELY
        return Truth(usual, test_if_true=True)
    return Truth(LIKELY if constant(value) is not False else UNLIKELY, test_if_true=True)


# --- unary tests ---------------------------------------------------------------------------------------------------


def _defined(run: Run, token: _Token) -> Truth:
    name = token.text
    if not is_known(name):
        return Truth(UNKNOWN)
    if name.startswith("ENV{") and name.endswith("}"):
        return Truth(TRUE if run.lookup(name[4:-1], "ENV") and is_known(run.lookup(name[4:-1], "ENV")) else UNKNOWN)
    if name.startswith("CACHE{") and name.endswith("}"):
        return Truth(TRUE if name[6:-1] in run.cache else UNKNOWN)
    value = run.get(name)
    if value is None:
        return Truth(UNLIKELY if run.may_be_set(name) else FALSE)
    return Truth(UNKNOWN if value == HOLE else TRUE)


def _target(run: Run, token: _Token) -> Truth:
    if token.text in run.targets:
        return Truth(TRUE if "CONDITIONAL" not in run.targets[token.text] else UNKNOWN)
    return Truth(UNKNOWN if run.open_world or not is_known(token.text) else FALSE)


def _command(run: Run, token: _Token) -> Truth:
    name = token.text.lower()
    if name in run.procedures:
        return Truth(TRUE)
    return Truth(UNKNOWN)


def _exists(run: Run, token: _Token) -> Truth:
    path = run.source(token.text) if token.text.startswith(SOURCE) else None
    if path is None:
        return Truth(UNKNOWN)
    return Truth(TRUE if path in run.files or run.is_folder(path) else UNLIKELY)


def _is_directory(run: Run, token: _Token) -> Truth:
    path = run.source(token.text) if token.text.startswith(SOURCE) else None
    if path is None:
        return Truth(UNKNOWN)
    return Truth(TRUE if run.is_folder(path) else UNLIKELY)


def _is_absolute(_run: Run, token: _Token) -> Truth:
    if not is_fixed(token.text):
        return Truth(UNKNOWN)
    return Truth(TRUE if token.text.startswith(("/", "~")) else FALSE)


def _policy(_run: Run, token: _Token) -> Truth:
    match = re.fullmatch(r"CMP(\d{4})", token.text)
    return Truth(TRUE if match and int(match[1]) <= 50 else LIKELY)


def _unknown(_run: Run, _token: _Token) -> Truth:
    return Truth(UNKNOWN)


_UNARY: Final[dict[str, Callable[[Run, _Token], Truth]]] = {
    "DEFINED": _defined,
    "TARGET": _target,
    "COMMAND": _command,
    "EXISTS": _exists,
    "IS_DIRECTORY": _is_directory,
    "IS_ABSOLUTE": _is_absolute,
    "POLICY": _policy,
    "IS_SYMLINK": _unknown,
    "TEST": _unknown,
}


# --- binary tests --------------------------------------------------------------------------------------------------


def _operand(run: Run, token: _Token) -> str:
    """Return the value of a variable, or the text itself."""
    if token.quoted:
        # Before policy CMP0054 quoted arguments were looked up as well.
        return token.text if run.versions >= (3, 1) or run.get(token.text) is None else HOLE
    value = run.get(token.text) if is_known(token.text) else None
    return token.text if value is None else value


def _comparison(compare: Callable[[str, str], bool]) -> Callable[[Run, _Token, _Token], int]:
    def compared(run: Run, left: _Token, right: _Token) -> int:
        first, second = _operand(run, left), _operand(run, right)
        if is_known(first) and is_known(second):
            return TRUE if compare(first, second) else FALSE
        return UNKNOWN

    return compared


def _same(run: Run, left: _Token, right: _Token) -> int:
    first, second = _operand(run, left), _operand(run, right)
    if is_known(first) and is_known(second):
        return TRUE if first == second else FALSE
    if first == second and is_fixed(first):
        return TRUE
    if is_fixed(first) and is_fixed(second) and _root(first) and _root(second) and _root(first) != _root(second):
        return FALSE  # in-source builds are none that colcon makes
    if "" in (first, second) and is_fixed(first) and is_fixed(second):
        return FALSE
    return UNKNOWN


def _root(path: str) -> str:
    """Return which of the unknown folders a path starts at, "" for none."""
    return path.split("/")[1] if path.startswith("/\1") else ""


def _numbers(compare: Callable[[float, float], bool]) -> Callable[[str, str], bool]:
    def compared(left: str, right: str) -> bool:
        first, second = _NUMBER.match(left), _NUMBER.match(right)
        if first is None or second is None:
            return False
        return compare(_number(first[0]), _number(second[0]))

    return compared


def _number(text: str) -> float:
    text = text.strip()
    return float(int(text, 16)) if "x" in text.lower() else float(text)


def version(text: str) -> tuple[int, ...]:
    """Return the components that VERSION_LESS and the like compare."""
    found = []
    for part in text.split("."):
        digits = re.match(r"\d+", part)
        if digits is None:
            break
        found.append(int(digits[0]))
        if digits.end() != len(part):
            break
    while found and not found[-1]:
        found.pop()
    return tuple(found)


def _versions(compare: Callable[[tuple[int, ...], tuple[int, ...]], bool]) -> Callable[[str, str], bool]:
    return lambda left, right: compare(version(left), version(right))


def _matches(run: Run, left: _Token, right: _Token) -> int:
    from ros_lint.interpret.cmake_regex import find  # noqa: PLC0415  (few scripts match anything)

    text = _operand(run, left)
    if not (is_known(text) and is_known(right.text)):
        return UNKNOWN
    found = find(run, right.text, text)
    return UNKNOWN if found is None else (TRUE if found else FALSE)


def _in_list(run: Run, left: _Token, right: _Token) -> int:
    element = _operand(run, left)
    value = run.get(right.text)
    if value is None:
        return UNLIKELY if run.may_be_set(right.text) else FALSE
    if not is_known(element):
        return UNKNOWN
    if element in elements(value):
        return TRUE
    return FALSE if is_known(value) else UNKNOWN


def _newer(_run: Run, _left: _Token, _right: _Token) -> int:
    return UNKNOWN


_BINARY: Final[dict[str, Callable[[Run, _Token, _Token], int]]] = {
    "STREQUAL": _same,
    "STRLESS": _comparison(lambda left, right: left.encode() < right.encode()),
    "STRGREATER": _comparison(lambda left, right: left.encode() > right.encode()),
    "STRLESS_EQUAL": _comparison(lambda left, right: left.encode() <= right.encode()),
    "STRGREATER_EQUAL": _comparison(lambda left, right: left.encode() >= right.encode()),
    "EQUAL": _comparison(_numbers(lambda left, right: left == right)),
    "LESS": _comparison(_numbers(lambda left, right: left < right)),
    "GREATER": _comparison(_numbers(lambda left, right: left > right)),
    "LESS_EQUAL": _comparison(_numbers(lambda left, right: left <= right)),
    "GREATER_EQUAL": _comparison(_numbers(lambda left, right: left >= right)),
    "VERSION_EQUAL": _comparison(_versions(lambda left, right: left == right)),
    "VERSION_LESS": _comparison(_versions(lambda left, right: left < right)),
    "VERSION_GREATER": _comparison(_versions(lambda left, right: left > right)),
    "VERSION_LESS_EQUAL": _comparison(_versions(lambda left, right: left <= right)),
    "VERSION_GREATER_EQUAL": _comparison(_versions(lambda left, right: left >= right)),
    "MATCHES": _matches,
    "IN_LIST": _in_list,
    "IS_NEWER_THAN": _newer,
    "PATH_EQUAL": _newer,
}
