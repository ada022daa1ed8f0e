"""A small share of the fuzzing, the same inputs each time. Longer: ``python -m tests.fuzz --minutes 30``."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from itertools import islice
from pathlib import Path
from random import Random

import pytest

from tests.fuzz import oracle, server
from tests.fuzz.campaign import Campaign, Found, Input, hostile_inputs, mutated, save, table
from tests.fuzz.minimise import minimise, signature
from tests.fuzz.mutate import MUTATORS, Material
from tests.fuzz.oracle import Measured, Plan, damage
from tests.fuzz.seeds import Other, of_cases, of_folder, write
from tests.fuzz.targets import TARGETS

pytestmark = pytest.mark.slow

_NAMES = [target.name for target in TARGETS]
_PER_TARGET = 2
_EACH_HOSTILE = 134


def _described(found: list[Found]) -> str:
    return "\n\n".join(f"{one.input.target}, {one.input.name}:\n{one.failure[-2000:]}" for one in found)


def test_mutated_workspaces(tmp_path: Path) -> None:
    campaign = Campaign(str(tmp_path / "inputs"))
    campaign.run(list(islice(mutated(Random(7), of_cases(), _NAMES), _PER_TARGET * len(_NAMES))))
    campaign.close()
    assert campaign.found == [], _described(campaign.found)
    assert campaign.rows.keys() == set(_NAMES)
    assert "| all | " in table(campaign.rows)


def test_hostile_seeds(tmp_path: Path) -> None:
    campaign = Campaign(str(tmp_path / "inputs"))
    campaign.run(list(islice(hostile_inputs(Random(7), _NAMES), 0, None, _EACH_HOSTILE)))
    campaign.close()
    assert campaign.found == [], _described(campaign.found)


def _input(plan: Plan = Plan()) -> Input:  # noqa: B008
    return Input("made", "one", {"p/package.xml": b"<package><depend>a</depend></package>", "p/a.py": b"x = 1\n"}, plan)


def dies(arguments: list[str]) -> int:
    os.abort()


def raises(arguments: list[str]) -> int:
    raise ValueError(arguments[0])


def waits(arguments: list[str]) -> int:
    time.sleep(1 << 20)
    return 0


def loops(arguments: list[str]) -> int:
    while True:
        pass


def fills(arguments: list[str]) -> int:
    content = b"x" * (60 << 20)
    print('{"crashes": [], "not_checked": []}')
    return len(content) and 0


def differs(arguments: list[str]) -> int:
    print(f'{{"crashes": [], "not_checked": [], "hash": {hash("a")}}}')
    return 0


def crashes(arguments: list[str]) -> int:
    print('{"crashes": ["here"], "not_checked": []}')
    return 2


def damages(arguments: list[str]) -> int:
    if "--fix" in arguments:
        (Path(arguments[0]) / "p/package.xml").write_text("<package>")
    print('{"crashes": [], "not_checked": [], "findings": [{"fix": {"title": "a"}}]}')
    return 1


def changes_again(arguments: list[str]) -> int:
    if "--fix" in arguments:
        with (Path(arguments[0]) / "p/a.py").open("a") as file:
            file.write("y = 1\n")
    print('{"crashes": [], "not_checked": [], "findings": [{"fix": {"title": "a"}}]}')
    return 1


@pytest.fixture
def served(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[Callable[[list[str]], int]], list[Measured]]:
    """Return a function that serves two equal folders with a function in place of ros-lint, and returns the answers."""

    def serve(main: Callable[[list[str]], int]) -> list[Measured]:
        answers: list[Measured] = []
        monkeypatch.setattr(server, "_answer", lambda fields: answers.append(Measured(*fields)))
        folders = [str(tmp_path / name) for name in "ab"]
        for folder in folders:
            write(_input().files, folder)
        plans = [Plan(fix=True)] * 2
        while folders:
            done = server._serve_batch(main, folders, plans)
            folders, plans = folders[done:], plans[done:]
        return answers

    return serve


@pytest.mark.parametrize(
    ("main", "failure"),
    [
        (dies, "killed by signal 6"),
        (raises, "raised ValueError"),
        (fills, "memory: "),
        (crashes, "crashed rule: here"),
        (damages, "no element found"),
        (changes_again, "a second run changes ['p/a.py']"),
        (waits, "hangs: "),
        (loops, "slow: "),
    ],
)
def test_each_oracle_can_fail(
    served: Callable[[Callable[[list[str]], int]], list[Measured]],
    monkeypatch: pytest.MonkeyPatch,
    main: Callable[[list[str]], int],
    failure: str,
) -> None:
    monkeypatch.setattr(server, "_WALL_SECONDS", 1)
    monkeypatch.setattr(oracle, "MEMORY_PER_MB", 50)
    if main is loops:
        monkeypatch.setattr(server, "SECONDS_PER_MB", 0.02)
    answers = served(main)
    assert len(answers) == 2
    assert [failure in answer.failure for answer in answers] == [True, True], answers


def test_another_hash_seed_must_give_the_same_result(tmp_path: Path) -> None:
    campaign = Campaign(str(tmp_path / "inputs"), "tests.test_fuzz:differs", warm=False)
    campaign.run([_input()])
    campaign.close()
    assert [found.failure for found in campaign.found] == ["other results with another hash seed"]


def test_inputs_are_the_same_for_a_seed_and_distinct() -> None:
    first, second = (list(islice(mutated(Random(3), of_cases(), _NAMES), 60)) for _ in range(2))
    assert first == second
    assert len({str(one.files) for one in first}) > 55
    names = [(one.target, one.name) for one in hostile_inputs(Random(0), _NAMES)]
    assert len(names) == len(set(names)) > 300


def test_every_mutator_changes_something() -> None:
    content = b'<a b="12">\n  c\n</a>\n' * 9
    for mutator in MUTATORS:
        assert any(mutator(Random(seed), content, Material((b"other\nlines\n",), (b"word",))) != content for seed in range(9))


def test_failures_become_smaller() -> None:
    files = {"a": b"".join(b"line %d\n" % number for number in range(50)), "b": b"x"}
    assert minimise(files, lambda smaller: b"line 17" in smaller.get("a", b""), 20) == {"a": b"line 17"}
    assert signature("x\nValueError: /tmp/1: 5 in 'a'") == signature("y\nValueError: /tmp/2: 7 in 'b'")


def test_inputs_can_be_saved_and_read(tmp_path: Path) -> None:
    files = {
        "p/package.xml": b"<a/>",
        "p/\udcff": b"",
        "p/l": Other("link", b"nowhere"),
        "p/package.xml/below": b"",
        "p/run": Other("program", b"#!"),
    }
    place = save(Found(_input()._replace(files=files), "why \ud800"), str(tmp_path))
    seed, *others = of_folder(place)
    assert others == []
    assert seed.files == {"p/package.xml": b"<a/>", "p/run": b"#!", "p/\udcff": b""}
    for kind in ("fifo", "socket", "folder"):
        write({kind: Other(kind)}, str(tmp_path))
        assert (tmp_path / kind).exists()


@pytest.mark.parametrize(
    ("path", "before", "after", "damaged"),
    [
        ("a.xml", b"<a/>", b"<a>", True),
        ("a.xml", b"<a>", b"<b>", False),
        ("a.py", b"x", b"x =", True),
        ("CMakeLists.txt", b"a()", b"a(", True),
        ("a.cmake", b"a()", b"b()", False),
        ("a.txt", b"a", b"", False),
    ],
)
def test_damage(path: str, before: bytes, after: bytes, damaged: bool) -> None:
    assert bool(damage(path, before, after)) is damaged
