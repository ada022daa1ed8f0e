"""The conditions of if(), elseif() and while(): cmake's if(7), with answers that may not be known.

An answer is true, false, unknown, or *likely* and *unlikely*: true or false unless the user sets an option or a variable.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Final, NamedTuple

from ros_lint.collectors.cmake_syntax import BRACKET, LITERAL, QUOTED, UNQUOTED, Command
from ros_lint.interpret.cmake_values import HOLE, SOURCE, certainly_set, data, elements, is_fixed, is_known, split

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


_TESTS_WANTED: Final = Truth(LIKELY, test_if_true=True)


class _Token(NamedTuple):
    text: str
    quoted: bool
    soft: bool
    """Whether its value is one that a user may change."""


_TEST_VARIABLE = re.compile(
    r"(?:\A|_)(?:BUILD_TESTING|(?:CATKIN|AMENT)_ENABLE_TESTING|(?:BUILD|ENABLE)_(?:\w+_)?TEST(?:S|ING)?|BUILD_TEST)\Z"
)
_REFERENCE = re.compile(r"\$\{([A-Za-z0-9_./+-]+)\}")
_NUMBER = re.compile(
    r"\s*[-+]?(?:0[xX](?:[0-9a-fA-F]+\.?[0-9a-fA-F]*|\.[0-9a-fA-F]+)(?:[pP][-+]?\d+)?"
    r"|(?!0[xX])(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)"
)
"""As much of a text as C's scanf() takes for a number, infinities left out."""
_TRUE_WORDS: Final = frozenset({"1", "ON", "YES", "TRUE", "Y"})
_FALSE_WORDS: Final = frozenset({"", "0", "OFF", "NO", "FALSE", "N", "IGNORE"})


def condition(run: Run, command: Command) -> Truth:
    """Return what a condition evaluates to."""
    if len(command.args) == 1 and command.args[0][0] == "BUILD_TESTING":
        return _TESTS_WANTED  # by far the most frequent condition
    tokens: list[_Token] = []
    for text, kind, _, _ in command.args:
        if kind == UNQUOTED:
            soft = _is_soft(run, text)
            tokens += [_Token(value, False, soft) for value in split(run.evaluated(text))]
        elif kind == QUOTED:
            tokens.append(_Token(run.evaluated(text), True, _is_soft(run, text)))
        else:
            tokens.append(_Token(text, kind in (LITERAL, BRACKET), False))
    if len(tokens) > 1:
        truth = _Parser(run, tokens).whole()
        if sum(token.text == "MATCHES" for token in tokens) > 1:
            from ros_lint.interpret.cmake_regex import forget  # noqa: PLC0415

            forget(run)  # which match came last depends on the parentheses
        return truth
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
        truths = [self.negation()]
        signs: list[str] = []
        while self.keyword() in ("AND", "OR"):
            signs.append(self.keyword())
            self.at += 1
            truths.append(self.negation())
        first = _from_left(truths, signs)
        if len(set(signs)) > 1:
            # Older versions bind AND more tightly, and newer ones have taken the operands two by two.
            others = (_and_first(truths, signs), _in_pairs(truths, signs))
            if any(other.value != first.value for other in others):
                return first._replace(value=UNKNOWN)
        return first

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


def _from_left(truths: Sequence[Truth], signs: Sequence[str]) -> Truth:
    truth = truths[0]
    for sign, other in zip(signs, truths[1:], strict=True):
        truth = _and(truth, other) if sign == "AND" else _or(truth, other)
    return truth


def _and_first(truths: Sequence[Truth], signs: Sequence[str]) -> Truth:
    found = [truths[0]]
    for sign, other in zip(signs, truths[1:], strict=True):
        if sign == "AND":
            found[-1] = _and(found[-1], other)
        else:
            found.append(other)
    return _from_left(found, ["OR"] * (len(found) - 1))


def _in_pairs(truths: Sequence[Truth], signs: Sequence[str]) -> Truth:
    while len(truths) > 1:
        truths, signs = (
            [
                _from_left(truths[at : at + 2], signs[at : at + 1]) if at + 1 < len(truths) else truths[at]
                for at in range(0, len(truths), 2)
            ],
            signs[1::2],
        )
    return truths[0]


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


def is_off(text: str) -> bool:
    """Return whether a value counts as false."""
    return text.upper() in _FALSE_WORDS or text == "NOTFOUND" or text.endswith("-NOTFOUND")


def constant(text: str) -> bool | None:
    """Return what a word means as a condition, or None when it is neither a true nor a false constant nor a number."""
    if text.upper() in _TRUE_WORDS:
        return True
    if is_off(text):
        return False
    number = _NUMBER.fullmatch(text)
    return _number(text) != 0 if number else None


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
    answer = FALSE if is_off(value) else TRUE
    return Truth(_soften(answer) if token.soft or run.is_soft(text) else answer)


def _tests_enabled(run: Run, name: str) -> Truth:
    """Tests are enabled unless the user says otherwise (ament_cmake_test; reference, section C1.5)."""
    if name == "BUILD_TESTING":
        return _TESTS_WANTED
    value = run.get(name)
    if value is None or not is_fixed(value):
        return Truth(UNLIKELY, test_if_true=True)
    return Truth(UNLIKELY if is_off(value) else LIKELY, test_if_true=True)


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
    return Truth(TRUE if certainly_set(value) else UNKNOWN)


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
    return float.fromhex(text) if "x" in text.lower() else float(text)


_COMPONENT = re.compile(r"\s*([-+]?)(\d+)")


def compare_versions(left: str, right: str) -> int:
    """Return -1, 0 or 1 as VERSION_LESS and the like see it: component by component, each read as C's strtoul() does."""
    at, other = 0, 0
    while left[at : at + 1].isdigit() or right[other : other + 1].isdigit():
        first, at = _component(left, at)
        second, other = _component(right, other)
        if first != second:
            return -1 if first < second else 1
        at += left[at : at + 1] == "."
        other += right[other : other + 1] == "."
    return 0


def _component(text: str, at: int) -> tuple[int, int]:
    match = _COMPONENT.match(text, at)
    if match is None:
        return 0, at
    number = int(match[2])
    return (-number % (1 << 64) if match[1] == "-" else number), match.end()


def _versions(compare: Callable[[int, int], bool]) -> Callable[[str, str], bool]:
    return lambda left, right: compare(compare_versions(left, right), 0)


def _matches(run: Run, left: _Token, right: _Token) -> int:
    from ros_lint.interpret.cmake_regex import find, forget  # noqa: PLC0415  (few scripts match anything)

    text = _operand(run, left)
    if not (is_known(text) and is_known(right.text)):
        forget(run)
        return UNKNOWN
    found = find(run, right.text, text)
    return UNKNOWN if found is None else (TRUE if found else FALSE)


def _in_list(run: Run, left: _Token, right: _Token) -> int:
    element = _operand(run, left)
    value = run.get(right.text)
    if value is None:
        return UNLIKELY if run.may_be_set(right.text) else FALSE
    if not is_known(element) or not element + value:
        return UNKNOWN
    if element in elements(value):
        return TRUE
    return FALSE if is_known(value) else UNKNOWN


def _newer(_run: Run, _left: _Token, _right: _Token) -> int:
    return UNKNOWN


_BINARY: Final[dict[str, Callable[[Run, _Token, _Token], int]]] = {
    "STREQUAL": _same,
    "STRLESS": _comparison(lambda left, right: data(left) < data(right)),
    "STRGREATER": _comparison(lambda left, right: data(left) > data(right)),
    "STRLESS_EQUAL": _comparison(lambda left, right: data(left) <= data(right)),
    "STRGREATER_EQUAL": _comparison(lambda left, right: data(left) >= data(right)),
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
