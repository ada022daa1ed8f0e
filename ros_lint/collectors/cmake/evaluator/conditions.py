"""Evaluation of the conditions of if(), elseif() and while() (cmake-commands(7)).

The truth value of a condition is true, false, unknown, *likely* or *unlikely*. Likely is true, and unlikely is false, unless
the user sets an option or a variable.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

from ros_lint.collectors.cmake.evaluator.condition_tests import BINARY, UNARY
from ros_lint.collectors.cmake.evaluator.truth import (
    FALSE,
    LIKELY,
    TRUE,
    UNKNOWN,
    UNLIKELY,
    ConditionToken,
    Truth,
    both,
    constant,
    either,
    is_off,
    negated,
    reversible,
    reversible_if_configurable,
)
from ros_lint.collectors.cmake.evaluator.values import cached_short, is_fixed, split, split_cost
from ros_lint.collectors.cmake.syntax import BRACKET, LITERAL, PLAIN, QUOTED, UNQUOTED, Command

if TYPE_CHECKING:
    from ros_lint.collectors.cmake.evaluator.run import Run

_TESTS_ENABLED: Final = Truth(LIKELY, test_if_true=True)
_TESTS_DISABLED: Final = Truth(UNLIKELY, test_if_true=True)


_TEST_VARIABLE = re.compile(
    r"(?:\A|_)(?:BUILD_TESTING|(?:CATKIN|AMENT)_ENABLE_TESTING|(?:BUILD|ENABLE)_(?:\w+_)?TEST(?:S|ING)?|BUILD_TEST)\Z"
)
_REFERENCE = re.compile(r"\$\{([A-Za-z0-9_./+-]+)\}")


_FOUND_VARIABLE = re.compile(r"\$\{(\w+_FOUND)\}")


def condition(run: Run, command: Command) -> Truth:
    """Return the truth value of the condition in the arguments of if(), elseif() or while()."""
    if len(command.args) == 1:
        text, kind, _, _ = command.args[0]
        if kind == PLAIN:  # by far the most frequent conditions
            return _word(run, ConditionToken(text, False, False))
    tokens: list[ConditionToken] = []
    for text, kind, _, _ in command.args:
        if kind == UNQUOTED:
            configurable = _is_configurable(run, text)
            value = run.evaluate(text)
            run.budget.charge(split_cost(value))
            tokens += [ConditionToken(part, False, configurable) for part in split(value)]
        elif kind == QUOTED:
            tokens.append(ConditionToken(run.evaluate(text), True, _is_configurable(run, text)))
        else:
            tokens.append(ConditionToken(text, kind in (LITERAL, BRACKET), False))
        if "_FOUND}" in text:
            run.tested_variables.update(_FOUND_VARIABLE.findall(text))
    if len(tokens) > 1:
        truth = _Parser(run, tokens).whole()
        if sum(token.text == "MATCHES" for token in tokens) > 1:
            from ros_lint.collectors.cmake.evaluator.regex import forget  # noqa: PLC0415

            forget(run)  # the parentheses determine the order of the matches
        return truth
    return _word(run, tokens[0]) if tokens else Truth(FALSE)


def _is_configurable(run: Run, text: str) -> bool:
    # The packages of a repository are often built for several distributions, not only for the chosen one.
    return "$ENV{ROS_DISTRO}" in text or any(run.may_be_set(name) for name in _REFERENCE.findall(text))


class _Parser:
    """A parser of conditions with the operator precedence of CMake.

    The order is: parentheses, unary tests, binary tests, NOT, then AND and OR from left to right.
    """

    def __init__(self, run: Run, tokens: list[ConditionToken]) -> None:
        self.run = run
        self.tokens = tokens
        self.at = 0

    def whole(self) -> Truth:
        truth = self.chain()
        return truth if self.at == len(self.tokens) else Truth(UNKNOWN)

    def keyword(self, ahead: int = 0) -> str:
        """Return the token ``ahead`` tokens after the current one if it can be a keyword (it is not quoted), else ""."""
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
            # Older versions of CMake bind AND more tightly; some newer versions take the operands in pairs.
            readings = (_and_first(truths, signs), _in_pairs(truths, signs))
            if any(reading.value != first.value for reading in readings):
                return first._replace(value=UNKNOWN)
        return first

    def negation(self) -> Truth:
        if self.keyword() == "NOT" and self.at + 1 < len(self.tokens):
            self.at += 1
            return negated(self.negation())
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
        unary = UNARY.get(word)
        if unary is not None and self.at + 1 < len(self.tokens) and self.keyword(1) not in (")", "AND", "OR"):
            operand = self.tokens[self.at + 1]
            self.at += 2
            if operand.text.startswith("CMAKE_MATCH_") and any(token.text == "MATCHES" for token in self.tokens):
                return Truth(UNKNOWN)  # the variable is read before MATCHES is evaluated
            return unary(self.run, operand)
        left = self.tokens[self.at]
        self.at += 1
        binary = BINARY.get(self.keyword())
        if binary is not None and self.at + 1 < len(self.tokens):
            right = self.tokens[self.at + 1]
            self.at += 2
            return reversible_if_configurable(binary(self.run, left, right), self.run, left, right)
        return _word(self.run, left)

    def binary_after(self, truth: Truth) -> Truth:
        """Return ``truth``, the value of a condition in parentheses; UNKNOWN in the rare case that a binary test follows."""
        if self.keyword() in BINARY:
            self.at = len(self.tokens) + 1
            return Truth(UNKNOWN)
        return truth


def _from_left(truths: Sequence[Truth], signs: Sequence[str]) -> Truth:
    truth = truths[0]
    for sign, operand in zip(signs, truths[1:], strict=True):
        truth = both(truth, operand) if sign == "AND" else either(truth, operand)
    return truth


def _and_first(truths: Sequence[Truth], signs: Sequence[str]) -> Truth:
    alternatives = [truths[0]]
    for sign, operand in zip(signs, truths[1:], strict=True):
        if sign == "AND":
            alternatives[-1] = both(alternatives[-1], operand)
        else:
            alternatives.append(operand)
    return _from_left(alternatives, ["OR"] * (len(alternatives) - 1))


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


def _word(run: Run, token: ConditionToken) -> Truth:
    """Return the truth value of a single word: a constant, a variable or a string."""
    text = token.text
    if text == "BUILD_TESTING" and not token.quoted:
        return _build_testing(run)
    if not is_fixed(text):
        return Truth(UNKNOWN)
    value_of_constant = constant(text)
    if value_of_constant is not None:
        answer = TRUE if value_of_constant else FALSE
        return Truth(reversible(answer) if token.configurable else answer)
    if token.quoted:
        return Truth(UNLIKELY if token.configurable else FALSE)
    if _is_test_option(text):
        return _tests_enabled(run, text)
    value = run.get(text)
    if text.endswith("_FOUND"):
        run.tested_variables.add(text)
    if value is None:
        configurable = token.configurable or run.may_be_set(text)
        return Truth(UNLIKELY if configurable else FALSE)
    # A function may have a local variable of this name with another value.
    for_tests = text in run.test_switches and (value == run.test_switches[text] or not is_fixed(value))
    if not is_fixed(value):
        return Truth(UNKNOWN, for_tests)
    answer = FALSE if is_off(value) else TRUE
    return Truth(reversible(answer) if token.configurable or run.is_configurable(text) else answer, for_tests)


@cached_short(1024)
def _is_test_option(name: str) -> bool:
    return _TEST_VARIABLE.search(name) is not None


def _build_testing(run: Run) -> Truth:
    """Return the truth value of BUILD_TESTING: LIKELY (true by default), or UNLIKELY if the script itself sets it to false.

    An option(BUILD_TESTING) after set(BUILD_TESTING OFF) keeps the value false.
    """
    value = run.get("BUILD_TESTING")
    return _TESTS_DISABLED if value and is_fixed(value) and is_off(value) else _TESTS_ENABLED


def _tests_enabled(run: Run, name: str) -> Truth:
    """Return the truth value of a variable that enables tests, such as BUILD_TESTS.

    The result is LIKELY (true by default) or UNLIKELY (false by default), because the user can change the variable.
    """
    value = run.get(name)
    if value is None or not is_fixed(value):
        return Truth(UNLIKELY, test_if_true=True)
    return Truth(UNLIKELY if is_off(value) else LIKELY, test_if_true=True)
