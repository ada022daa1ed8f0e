"""The values of what rules have read, by names that are the same in the next run: inputs, and answers that rules share."""

from __future__ import annotations

from array import array
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.engine.shared_answers import PREFIX, SharedAnswers
from ros_lint.workspace.inputs import Inputs, digest

if TYPE_CHECKING:
    from ros_lint.base.questions import Cell, Recorder
    from ros_lint.workspace.handles import Handles

UNKNOWN = ""
"""Name of an input that cannot be named. What has read it is never valid."""


class KeptInput(NamedTuple):
    """A part of the workspace, or an answer that rules share, that was read."""

    name: str
    digest: bytes
    reads: bytes
    """For an answer the numbers of what it has read, otherwise nothing."""


class CurrentValues:
    """The values in the loaded workspace of what can be read."""

    def __init__(self, handles: Handles) -> None:
        self._inputs = Inputs(handles)
        self._answers = SharedAnswers(handles)
        self._digests: dict[str, bytes] = {}

    def names(self, recorder: Recorder) -> dict[Cell, str]:
        return {**self._inputs.names(), **dict(self._answers.named(recorder))}

    def digest(self, name: str) -> bytes:
        """Return the digest of an input or of a shared answer; b"" if it does not exist."""
        if name not in self._digests:
            self._digests[name] = self._compute(name)
        return self._digests[name]

    def changed(self, inputs: Sequence[KeptInput]) -> set[int]:
        """Return the numbers of the inputs with another value than in an earlier run.

        An answer is computed again only if something that it has read has another value.
        """
        result: set[int] = set()
        for number, (name, before, reads) in enumerate(inputs):
            below = unpacked(reads)
            if below and before and result.isdisjoint(below):
                self._digests[name] = before
            elif not before or self.digest(name) != before:
                result.add(number)
        return result

    def _compute(self, name: str) -> bytes:
        try:
            if name.startswith(PREFIX):
                return digest(self._answers.value(name))
            return self._inputs.digest(name) if name != UNKNOWN else b""
        except Exception:  # a name of a manipulated file may have any form, and a rule raises the error of an answer again
            return b""


def packed(numbers: Iterable[int]) -> bytes:
    """Return numbers as an array of 32-bit integers."""
    return array("I", numbers).tobytes()


def unpacked(reads: bytes) -> array[int]:
    """Return the numbers in an array of 32-bit integers. Raises ValueError if its length is none."""
    numbers = array("I")
    numbers.frombytes(reads)
    return numbers
