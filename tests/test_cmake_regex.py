"""Expressions of CMake that could take long are matched in bounded time, with the same matches as those of Python's re."""

from __future__ import annotations

from random import Random

import pytest

from ros_lint.base.budget import Budget, BudgetExceeded
from ros_lint.collectors.cmake.evaluator.regex import translated

LETTERS = "ab."


def expression(random: Random, depth: int = 0) -> str:
    """Return a random expression without nested repetitions."""
    return "|".join("".join(piece(random, depth) for _ in range(random.randint(1, 4))) for _ in range(random.choice((1, 1, 2))))


def piece(random: Random, depth: int) -> str:
    atom = random.choice(("a", "b", ".", "[ab]", "[^b]", "\\\\.", "^", "$") if random.random() < 0.3 else ("a", "b", "."))
    if depth < 2 and random.random() < 0.3:
        atom = f"({expression(random, depth + 1)})"
    return atom + random.choice(("", "", "*", "+", "?"))


def test_both_ways_find_the_same_matches() -> None:
    random = Random(5)
    compared = 0
    for _ in range(4_000):
        searcher = translated(expression(random), Budget(0, 1 << 40))
        if searcher is None:
            continue
        compiled = searcher.expression
        slow = compiled._replace(ambiguous=True)
        for _ in range(4):
            text = "".join(random.choices(LETTERS, k=random.randint(0, 12)))
            at = random.randint(0, len(text))
            expected, found = compiled.pattern.search(text, at), slow.search(text, Budget(0, 1 << 40), at)
            assert (expected is None) == (found is None), (compiled.pattern, text, at)
            if expected is not None and found is not None:
                groups = [group or "" for group in expected.groups()]
                assert (found.start(), found.end(), found[0]) == (*expected.span(), expected[0]), (compiled.pattern, text, at)
                assert list(found.groups()) == groups, (compiled.pattern, text, at)
                compared += 1
    assert compared > 4_000


@pytest.mark.parametrize("regex", ["x*x*x*x*y", "(a|aa)+b", "(x|xx)*y", "x?" * 40 + "x" * 40 + "y", "(x?y?)z*q", ".*.*.*=.*;"])
def test_characters_grow_with_the_text_only(regex: str) -> None:
    used = []
    for size in (1_000, 2_000, 4_000):
        budget = Budget(0, 1 << 40)
        searcher = translated(regex, budget)
        assert searcher is not None
        assert searcher.search("x" * size + "a" * size) is None
        used.append((1 << 40) - budget.characters)
    assert used[2] < 2.5 * used[1] < 6 * used[0]


def test_a_search_that_exceeds_the_budget_ends() -> None:
    searcher = translated("x*x*x*x*y", Budget(0, 1_000))
    assert searcher is not None
    with pytest.raises(BudgetExceeded):
        searcher.search("x" * 10_000)
