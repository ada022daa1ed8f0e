"""Which fixes are made, with a proof that knows who is to blame; and where those stand that are not."""

from collections.abc import Iterable, Mapping, Sequence
from random import Random
from types import SimpleNamespace

import pytest

from ros_lint.analysis.finding import Finding, Fix, Severity
from ros_lint.analysis.rule import Rule
from ros_lint.base.diff import line_before
from ros_lint.base.edit import Edit
from ros_lint.base.text import Span
from ros_lint.base.tree import MemoryTree
from ros_lint.engine.fix_trials import FixTrials
from ros_lint.engine.fixing import Regression, fix
from ros_lint.engine.report import Issue
from ros_lint.engine.selection import Selection

RULE = Rule("r", "ROS999", "s", Severity.ERROR, "0.1", "", package=lambda package, workspace: ())


def issue(number: int, package: str, text: str = "") -> Issue:
    span = Span("f", number + 1, 1, number + 1, 2)
    return Issue(RULE, package, Finding("m", span, f"s{number}", fix=Fix("t", (Edit(span, text),))))


class Harmful:
    """Fixes that do harm, each in the package named, or that are at odds with another one."""

    def __init__(self, issues: Sequence[Issue], harm: Mapping[str, str], odds: Sequence[tuple[str, str]] = ()) -> None:
        self._issues = issues
        self._harm = harm
        self._odds = odds
        self.trials: set[frozenset[str]] = set()

    def fixable(self, changed: Mapping[str, bytes]) -> list[Issue]:
        return [issue for issue in self._issues if issue.finding.subject not in changed]

    def applied(self, changed: Mapping[str, bytes], group: Iterable[Issue]) -> dict[str, bytes]:
        return {**changed, **{issue.finding.subject: b"" for issue in group}}

    def regressions(self, changed: Mapping[str, bytes], group: Sequence[Issue]) -> tuple[Regression, ...]:
        made = frozenset(self.applied(changed, group))
        self.trials.add(made)
        found = [Regression(name, package, "x") for name, package in self._harm.items() if name in made]
        return (*found, *(Regression("at odds") for one, other in self._odds if one in made and other in made))

    def original(self, changed: Mapping[str, bytes], issue: Issue) -> Issue:
        return issue

    def refused(self, changed: Mapping[str, bytes]) -> list[tuple[Issue, str]]:
        return []


@pytest.mark.parametrize("seed", range(40))
def test_all_that_is_harmless_is_made(seed: int) -> None:
    random = Random(seed)
    issues = [issue(number, f"p{random.randrange(30)}", random.choice(("", "text"))) for number in range(60)]
    bad = random.sample(range(60), random.randrange(6))
    # Half of the harm shows where the fix is, half somewhere else.
    harm = {f"s{number}": issues[number].package if number % 2 else f"p{random.randrange(30)}" for number in bad}
    left = [number for number in range(60) if number not in bad]
    odds = [(f"s{a}", f"s{b}") for a, b in zip(random.sample(left, 2), random.sample(left, 2), strict=True) if a != b]
    done = fix(Harmful(issues, harm, odds))
    made = {issue.finding.subject for issue in done.applied}
    withheld = {issue.finding.subject for issue, _ in done.skipped}
    assert made | withheld == {issue.finding.subject for issue in issues}
    assert not made & harm.keys()
    assert not any(one in made and other in made for one, other in odds)
    for name in withheld - harm.keys():
        assert any(name in pair for pair in odds)
        assert any(made.intersection(pair) for pair in odds if name in pair)


def test_a_few_trials_find_who_is_to_blame() -> None:
    issues = [issue(number, f"p{number // 2}", "" if number % 2 else "text") for number in range(200)]
    proof = Harmful(issues, {f"s{number}": f"p{number // 2}" for number in (11, 51, 101, 151)})
    done = fix(proof)
    assert {issue.finding.subject for issue, _ in done.skipped} == {"s11", "s51", "s101", "s151"}
    assert len(proof.trials) <= 2, "all, and all but these"


def test_what_is_not_mended_stands_where_the_file_has_it() -> None:
    loader = SimpleNamespace(tree=MemoryTree({"f": "a\nb\nc\n"}))
    proof = FixTrials(loader, (), Selection((), frozenset(), {}, pedantic=False, ignores=()), ())  # type: ignore[arg-type]
    assert proof.original({"f": b"b\nc\n"}, issue(1, "p")).finding.span == Span("f", 3, 1, 3, 2)
    assert proof.original({"g": b""}, issue(1, "p")).finding.span == Span("f", 2, 1, 2, 2)


def test_the_line_as_it_was() -> None:
    before = "a\nb\nc\nd\n"
    assert [line_before(before, "b\nc\nnew\nd\n", line) for line in (1, 2, 4)] == [2, 3, 4]
    assert [line_before(before, "a\nB\nc\nd\n", line) for line in (1, 2, 3, 9)] == [1, 2, 3, 4]
    assert line_before("", "a\n", 1) == 1
