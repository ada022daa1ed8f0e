"""The work that the evaluation of one file may take. It is taken from the budget before it is done."""

from __future__ import annotations


class BudgetExceeded(Exception):  # noqa: N818
    """An evaluation needs more steps or more characters than its budget has."""


class Budget:
    """The steps that an evaluation may still take, and the characters that it may still write and read."""

    __slots__ = ("characters", "steps")

    def __init__(self, steps: int, characters: int = 0) -> None:
        self.steps = steps
        self.characters = characters

    def step(self, count: int = 1) -> None:
        """Take steps. Raises BudgetExceeded if fewer are left."""
        self.steps -= count
        if self.steps < 0:
            raise BudgetExceeded

    def charge(self, count: int) -> None:
        """Take characters; other work that costs memory or time is converted into characters. Raises BudgetExceeded."""
        self.characters -= count
        if self.characters < 0:
            raise BudgetExceeded

    def affords(self, count: int = 1) -> bool:
        """Take steps, and return whether as many were left."""
        self.steps -= count
        return self.steps >= 0
