"""Which fixes are applied, for trials in which it is known which fixes cause which regressions."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from random import Random
from types import SimpleNamespace

import pytest

from ros_lint.analysis.finding import Confidence, Finding, Fix, Severity
from ros_lint.analysis.rule import Rule
from ros_lint.base.diff import line_before
from ros_lint.base.edit import Edit
from ros_lint.base.text import Span
from ros_lint.base.tree import MemoryTree
from ros_lint.engine.fix_trials import FixTrials
from ros_lint.engine.fixing import Regression, fix
from ros_lint.engine.report import Issue
from ros_lint.engine.selection import Selection
from ros_lint.workspace.loader import Loader
from ros_lint.workspace.model import Package, Workspace
from ros_lint.workspace.target import TargetDistro
from tests.packages import manifest_text

RULE = Rule("r", "ROS999", "s", Severity.ERROR, "0.1", "", package=lambda package, workspace: ())


def issue(number: int, package: str, text: str = "") -> Issue:
    span = Span("f", number + 1, 1, number + 1, 2)
    return Issue(RULE, package, Finding("m", span, f"s{number}", fix=Fix("t", (Edit(span, text),))))


class RegressionTrials:
    """Trials in which some fixes cause a regression in a package, and some pairs of fixes conflict."""

    def __init__(
        self, issues: Sequence[Issue], regressions: Mapping[str, str], conflicts: Sequence[tuple[str, str]] = ()
    ) -> None:
        self._issues = issues
        self._regressions = regressions
        self._conflicts = conflicts
        self.groups: set[frozenset[str]] = set()

    def fixable(self, changed: Mapping[str, bytes]) -> list[Issue]:
        return [issue for issue in self._issues if issue.finding.subject not in changed]

    def applied(self, changed: Mapping[str, bytes], group: Iterable[Issue]) -> dict[str, bytes]:
        return {**changed, **{issue.finding.subject: b"" for issue in group}}

    def regressions(self, changed: Mapping[str, bytes], group: Sequence[Issue]) -> tuple[Regression, ...]:
        names = frozenset(self.applied(changed, group))
        self.groups.add(names)
        regressions = [Regression(name, package, "x") for name, package in self._regressions.items() if name in names]
        return (*regressions, *(Regression("conflict") for pair in self._conflicts if names.issuperset(pair)))

    def original(self, changed: Mapping[str, bytes], issue: Issue) -> Issue:
        return issue

    def refused(self, changed: Mapping[str, bytes]) -> list[tuple[Issue, str]]:
        return []


@pytest.mark.parametrize("seed", range(40))
def test_all_fixes_without_regressions_are_applied(seed: int) -> None:
    random = Random(seed)
    issues = [issue(number, f"p{random.randrange(30)}", random.choice(("", "text"))) for number in range(60)]
    causes = random.sample(range(60), random.randrange(6))
    # Half of the regressions are in the package of the fix, the others in any package.
    regressions = {f"s{number}": issues[number].package if number % 2 else f"p{random.randrange(30)}" for number in causes}
    harmless = [number for number in range(60) if number not in causes]
    pairs = zip(random.sample(harmless, 2), random.sample(harmless, 2), strict=True)
    conflicts = [(f"s{first}", f"s{second}") for first, second in pairs if first != second]
    result = fix(RegressionTrials(issues, regressions, conflicts))
    applied = {issue.finding.subject for issue in result.applied}
    skipped = {issue.finding.subject for issue, _ in result.skipped}
    assert applied | skipped == {issue.finding.subject for issue in issues}
    assert not applied & regressions.keys()
    assert not any(applied.issuperset(pair) for pair in conflicts)
    for name in skipped - regressions.keys():
        assert any(name in pair for pair in conflicts)
        assert any(applied.intersection(pair) for pair in conflicts if name in pair)


def test_few_trials_find_the_fixes_that_cause_regressions() -> None:
    issues = [issue(number, f"p{number // 2}", "" if number % 2 else "text") for number in range(200)]
    trials = RegressionTrials(issues, {f"s{number}": f"p{number // 2}" for number in (11, 51, 101, 151)})
    result = fix(trials)
    assert {issue.finding.subject for issue, _ in result.skipped} == {"s11", "s51", "s101", "s151"}
    assert len(trials.groups) <= 2, "all fixes, and all but these"


def test_a_skipped_fix_is_reported_at_its_line_on_disk() -> None:
    loader = SimpleNamespace(tree=MemoryTree({"f": "a\nb\nc\n"}))
    trials = FixTrials(loader, (), Selection((), frozenset(), {}, pedantic=False, ignores=()), ())  # type: ignore[arg-type]
    assert trials.original({"f": b"b\nc\n"}, issue(1, "p")).finding.span == Span("f", 3, 1, 3, 2)
    assert trials.original({"g": b""}, issue(1, "p")).finding.span == Span("f", 2, 1, 2, 2)


def test_a_line_of_the_new_text_corresponds_to_a_line_of_the_old_text() -> None:
    before = "a\nb\nc\nd\n"
    assert [line_before(before, "b\nc\nnew\nd\n", line) for line in (1, 2, 4)] == [2, 3, 4]
    assert [line_before(before, "a\nB\nc\nd\n", line) for line in (1, 2, 3, 9)] == [1, 2, 3, 4]
    assert line_before("", "a\n", 1) == 1


def test_a_finding_whose_confidence_becomes_high_is_new() -> None:
    text = manifest_text("p")
    line, column = next((line, at + 1) for line, words in enumerate(text.splitlines(), 1) if (at := words.find("0.1.0")) >= 0)
    place = Span("p/package.xml", line, column, line, column + len("0.1.0"))

    def version(package: Package) -> str:
        return package.manifest.version if package.manifest else ""

    def fixed(package: Package, _: Workspace) -> Iterator[Finding]:
        if version(package) == "0.1.0":
            yield Finding("m", place, "x", fix=Fix("raise", (Edit(place, "0.2.0"),)))

    def doubted(package: Package, _: Workspace) -> Iterator[Finding]:
        yield Finding("n", place, "x", confidence=Confidence.MEDIUM if version(package) == "0.1.0" else Confidence.HIGH)

    loader = Loader(MemoryTree({"p/package.xml": text, "p/CMakeLists.txt": "project(p)\n"}), ("",), TargetDistro("jazzy", "test"))
    rules = (RULE._replace(package=fixed), RULE._replace(name="d", code="ROS998", package=doubted))
    trials = FixTrials(loader, ("",), Selection(rules, frozenset(), {}, pedantic=False, ignores=()), rules)
    [(skipped, reason)] = fix(trials).skipped
    assert (skipped.rule.name, reason) == ("r", "it would cause a new finding: n")
