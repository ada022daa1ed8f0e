"""Launch files with one mistake each that the real launch refuses, and their correct twins.

``tests/golden/launch_mistakes.txt`` lists the files of :mod:`launch_mistakes` that launch 3.9.8 and launch_ros 0.29.9 refuse
while they accept the twins.
"""

import random
from pathlib import Path

from tests import launch_mistakes
from tests.launch_cases import collect

REFUSED = frozenset((Path(__file__).parent / "golden" / "launch_mistakes.txt").read_text().split())


def _is_reported(text: str) -> bool:
    return bool(collect("a.launch.py", text)[1].problems)


def test_most_mistakes_are_reported() -> None:
    known = {mistake.name: mistake for mistake in launch_mistakes.mistakes()}
    refused = [known[name] for name in random.Random(25).sample(sorted(REFUSED), 120)]
    reported = {mistake.name for mistake in refused if _is_reported(mistake.wrong)}
    assert len(REFUSED) >= 200
    assert len(reported) >= 0.9 * len(refused), sorted({mistake.name for mistake in refused} - reported)


def test_no_twin_is_reported() -> None:
    twins = {mistake.right: mistake.name for mistake in launch_mistakes.mistakes()}
    assert [name for right, name in twins.items() if _is_reported(right)] == []
