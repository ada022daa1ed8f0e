"""Which fixes are applied, for trials in which it is known which fixes cause which regressions."""

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from random import Random
from types import SimpleNamespace
from typing import Any

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


def test_a_fix_that_another_fix_makes_possible_is_applied() -> None:
    class Dependent(RegressionTrials):
        def regressions(self, changed: Mapping[str, bytes], group: Sequence[Issue]) -> tuple[Regression, ...]:
            return tuple(
                Regression("too early", issue.package, issue.finding.subject)
                for issue in group
                if issue.finding.subject == "s1" and "s0" not in changed
            )

    result = fix(Dependent([issue(0, "p"), issue(1, "q")], {}))
    assert ([issue.finding.subject for issue in result.applied], result.skipped) == (["s0", "s1"], ())


def test_unsaved_files_are_part_of_the_result_and_refused_fixes_are_reported() -> None:
    class Refusing(RegressionTrials):
        def refused(self, changed: Mapping[str, bytes]) -> list[tuple[Issue, str]]:
            return [(issue(2, "p"), f"refused after {len(changed)} changes")]

    result = fix(Refusing([issue(0, "p"), issue(1, "p")], {"s1": "p"}), {"unsaved": b"text"})
    assert result.changed == {"unsaved": b"text", "s0": b""}
    assert [(issue.finding.subject, reason) for issue, reason in result.skipped] == [
        ("s1", "s1"),
        ("s2", "refused after 2 changes"),
    ]


def test_a_fix_is_tried_if_an_earlier_fix_that_it_overlaps_is_skipped() -> None:
    one, two = issue(0, "p"), issue(1, "q")
    overlapping = two._replace(finding=two.finding._replace(fix=Fix("t", (Edit(one.finding.span, "x"),))))
    result = fix(RegressionTrials([one, overlapping], {"s0": "p"}))
    assert [issue.finding.subject for issue in result.applied] == ["s1"]
    assert [issue.finding.subject for issue, _ in result.skipped] == ["s0"]


@pytest.mark.parametrize(
    ("package", "subject", "suspects"),
    [
        ("p", "s0", ["s0"]),  # the package and the subject
        ("p", "other", ["s1"]),  # the package, by fixes that only remove
        ("q", "s0", ["s0"]),  # the subject, if no fix of the package only removes
        ("q", "other", ["s2", "s3"]),  # the package
        ("r", "s3", ["s3"]),  # the subject
        (None, None, []),
    ],
)
def test_a_regression_is_ascribed_to_fixes_of_its_package_and_subject(
    package: str | None, subject: str | None, suspects: list[str]
) -> None:
    group = [issue(0, "p", "text"), issue(1, "p", " \n"), issue(2, "q", "text"), issue(3, "q", "text")]
    assert [issue.finding.subject for issue in Regression("", package, subject).suspects(group)] == suspects


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


# --- with a workspace ----------------------------------------------------------------------------------------------


def rule(
    name: str, replacements: Mapping[str, str | None], *, safe: bool = True, path: str = "", line: int = 0, **finding: Any
) -> Rule:
    """Return a rule that finds dependencies, with fixes that replace their names; None if there is no fix.

    ``path`` and ``line`` are the place that the fixes edit if it is not that of the finding.
    """

    def found(package: Package, _: Workspace) -> Iterator[Finding]:
        for depend in package.manifest.depends if package.manifest else ():
            if depend.name in replacements:
                new, place = replacements[depend.name], depend.name_span
                edited = place._replace(path=path or place.path, line=line or place.line, end_line=line or place.end_line)
                edit = Edit(edited, new or "")
                change = None if new is None else Fix("t", (edit,), safe)
                yield Finding(f"{name} of {depend.name}", place, depend.name, fix=change, **finding)

    return RULE._replace(name=name, code=f"ROS-{name}", package=found)


def trials_of(
    *rules: Rule, roots: Sequence[str] = ("",), pedantic: bool = False, selected: Container[str] | None = None, **options: Any
) -> FixTrials:
    """Return trials in the packages p and q, which both depend on "aa"."""
    files = {f"{name}/package.xml": manifest_text(name, ["<depend>aa</depend>"]) for name in "pq"}
    loader = Loader(MemoryTree(files), ("",), TargetDistro("jazzy", "test"))
    chosen = tuple(one for one in rules if selected is None or one.name in selected)
    return FixTrials(loader, roots, Selection(chosen, frozenset(), {}, pedantic=pedantic, ignores=()), rules, **options)


def outcome(trials: FixTrials) -> tuple[str, list[str]]:
    """Return the dependencies of p and q after all fixes, and the distinct reasons for skipped fixes."""
    result = fix(trials)
    texts = [result.changed.get(f"{name}/package.xml", b"<depend>aa<").decode() for name in "pq"]
    names = [text.partition("<depend>")[2].partition("<")[0] for text in texts]
    return ",".join(names), list(dict.fromkeys(reason for _, reason in result.skipped))


NEW = "it would cause a new finding: two of bb"


def test_a_fix_that_resolves_its_finding_is_applied() -> None:
    assert outcome(trials_of(rule("one", {"aa": "bb"}))) == ("bb,bb", [])
    assert outcome(trials_of(rule("one", {"aa": "bb", "bb": "cc"}))) == ("cc,cc", [])


def test_a_fix_that_does_not_resolve_its_finding_is_skipped() -> None:
    assert outcome(trials_of(rule("one", {"aa": " aa"}))) == ("aa,aa", ["it does not resolve the finding"])


def test_a_fix_that_causes_a_finding_is_skipped() -> None:
    one, two = rule("one", {"aa": "bb"}), rule("two", {"bb": None})
    assert outcome(trials_of(one, two)) == ("aa,aa", [NEW])
    assert outcome(trials_of(one, two, selected={"one"})) == ("aa,aa", [NEW])


def test_a_fix_may_cause_findings_of_low_confidence_or_of_rules_that_are_off() -> None:
    one, off = rule("one", {"aa": "bb"}), rule("two", {"bb": None})._replace(default=False)
    assert outcome(trials_of(one, rule("two", {"bb": None}, confidence=Confidence.MEDIUM))) == ("bb,bb", [])
    assert outcome(trials_of(one, off)) == ("bb,bb", [])
    assert outcome(trials_of(one, off, selected={"one"})) == ("bb,bb", [])


def test_a_fix_may_cause_findings_that_fixes_of_the_next_round_resolve() -> None:
    one, two = rule("one", {"aa": "bb"}), rule("two", {"bb": "cc"})
    assert outcome(trials_of(one, two)) == ("cc,cc", [])
    assert outcome(trials_of(one, two, selected={"one"})) == ("aa,aa", [NEW])
    assert outcome(trials_of(one, two, rule("three", {"cc": None}))) == ("aa,aa", [NEW])
    assert outcome(trials_of(one, rule("two", {"bb": " bb"}))) == ("aa,aa", [NEW])
    overlapping = trials_of(one, two, rule("three", {"bb": "dd"}))
    assert outcome(overlapping) == ("aa,aa", ["it would cause a new finding: three of bb"])
    assert outcome(trials_of(one, rule("two", {"bb": "cc"}, line=99))) == ("aa,aa", [NEW])


def test_the_first_and_the_last_two_trials_are_kept() -> None:
    trials = trials_of(rule("one", {"aa": "bb"}))
    made = [trials.trial({"new": str(number).encode()}) for number in range(6)]
    assert [trials.trial(made[number].changed) is made[number] for number in (5, 4, 0)] == [True] * 3
    assert trials.trial(made[3].changed) is not made[3]


def test_only_selected_rules_fix_their_findings() -> None:
    one, two = rule("one", {"aa": "bb"}), rule("two", {"aa": "cc"})
    assert outcome(trials_of(one, two, selected={"two"})) == ("cc,cc", [])
    assert outcome(trials_of(one, two, only={"two"})) == ("cc,cc", [])
    assert outcome(trials_of(one, two, only=())) == ("aa,aa", [])
    assert outcome(trials_of(one._replace(default=False))) == ("bb,bb", [])


def test_unsafe_fixes_are_applied_only_on_request() -> None:
    unsafe = rule("one", {"aa": "bb"}, safe=False)
    assert outcome(trials_of(unsafe)) == ("aa,aa", [])
    assert outcome(trials_of(unsafe, unsafe=True)) == ("bb,bb", [])


def test_hidden_findings_are_not_fixed() -> None:
    doubtful = rule("one", {"aa": "bb"}, confidence=Confidence.MEDIUM)
    assert outcome(trials_of(doubtful)) == ("aa,aa", [])
    assert outcome(trials_of(doubtful, pedantic=True)) == ("bb,bb", [])


def test_only_files_below_the_requested_folders_are_changed() -> None:
    assert outcome(trials_of(rule("one", {"aa": "bb"}), roots=("q",))) == ("aa,bb", [])
    trials = trials_of(rule("one", {"aa": "bb"}, path="p/package.xml"), roots=("q",))
    assert trials.fixable({}) == []
    assert outcome(trials) == ("aa,aa", ["'p/package.xml' is outside the folders to check"])


def test_the_patch_has_all_changed_files_in_order() -> None:
    trials = trials_of(rule("one", {"aa": "bb"}))
    patch = trials.patch(dict(reversed(fix(trials).changed.items()))).decode().splitlines()
    changes = ("--- a/{}/package.xml", "+++ b/{}/package.xml", "-  <depend>aa</depend>", "+  <depend>bb</depend>")
    assert [line for line in patch if line[0] in "+-"] == [line.format(name) for name in "pq" for line in changes]


def test_a_fix_of_a_line_that_the_file_lacks_is_skipped() -> None:
    trials = trials_of(rule("one", {"aa": "bb"}))
    first, _ = trials.fixable({})
    reason = "p/package.xml: changed since it was read; fix skipped"
    assert trials.regressions({"p/package.xml": b""}, [first]) == (Regression(reason),)
    assert trials.regressions({}, ()) == ()


@pytest.mark.parametrize(
    ("package", "subject", "safe", "is_new"),
    [
        ("p", "x", True, True),
        ("p", "x", False, False),
        ("p", "aa", False, True),
        ("q", "aa", True, True),
        ("q", "x", True, False),
    ],
)
def test_a_finding_whose_confidence_becomes_high_is_new_near_a_fix(package: str, subject: str, safe: bool, is_new: bool) -> None:
    def doubted(place: Package, workspace: Workspace) -> Iterator[Finding]:
        fixed = any(declared.name == "bb" for other in workspace.packages for declared in other.declared)
        if place.name == package:
            span = Span(f"{package}/package.xml", 1, 1, 1, 2)
            yield Finding("n", span, subject, confidence=Confidence.HIGH if fixed else Confidence.MEDIUM)

    rules = (rule("one", {"aa": "bb"}, safe=safe), RULE._replace(name="d", code="ROS998", package=doubted))
    trials = trials_of(*rules, selected={"one"}, unsafe=True)
    group = [issue for issue in trials.fixable({}) if issue.package == "p"]
    reasons = [regression.reason for regression in trials.regressions({}, group)]
    assert reasons == (["it would cause a new finding: n"] if is_new else [])
