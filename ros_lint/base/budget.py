"""Limits of the work that ros-lint does to evaluate one file.

Each evaluator takes work from its budget before it does the work.
"""

from __future__ import annotations


class BudgetExceeded(Exception):  # noqa: N818
    """The evaluation of a file needs more steps or more characters than its budget has left."""


class Budget:
    """The remaining steps of an evaluation, and the remaining characters of the texts that it reads and writes."""

    __slots__ = ("characters", "steps")

    def __init__(self, steps: int, characters: int = 0) -> None:
        self.steps = steps
        self.characters = characters

    def step(self, count: int = 1) -> None:
        """Take ``count`` steps from the budget. Raises BudgetExceeded if fewer are left."""
        self.steps -= count
        if self.steps < 0:
            raise BudgetExceeded

    def charge(self, count: int) -> None:
        """Take ``count`` characters from the budget. Raises BudgetExceeded if fewer are left.

        Callers express other costs of memory or time as a number of characters.
        """
        self.characters -= count
        if self.characters < 0:
            raise BudgetExceeded

    def affords(self, count: int = 1) -> bool:
        """Take ``count`` steps from the budget, and return False if fewer were left."""
        self.steps -= count
        return self.steps >= 0
