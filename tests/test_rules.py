"""Every case in fixtures/ passes for its rule."""

from pathlib import Path

import pytest

from ros_lint.base.text import Text
from ros_lint.collectors.manifest import collect as manifest
from ros_lint.engine import registry
from ros_lint.engine.edits import text_of
from ros_lint.facts.manifest import ROLES
from ros_lint.knowledge import Knowledge
from ros_lint.knowledge.underlays import in_tree
from ros_lint.testing import Case, bless, differences, fixed, issues_of, read_cases
from ros_lint.workspace.discovery.discover import discover

FIXTURES = Path(__file__).parent.parent / "fixtures"
RULES = {rule.name: rule for rule in registry.load()}
CASES = [case for source in sorted(FIXTURES.glob("*.md")) for case in read_cases(source)]


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.source.stem}: {case.title}")
def test_the_rule_meets_the_case(case: Case, request: pytest.FixtureRequest) -> None:
    rule = RULES[case.source.stem]
    if request.config.getoption("bless"):
        bless(case, rule)
        return
    assert "\n".join(differences(case, rule)) == ""


@pytest.mark.parametrize("told", [True, False])
@pytest.mark.parametrize(
    "case",
    [case for case in CASES if RULES[case.source.stem].fixable and case.wants()],
    ids=lambda case: f"{case.source.stem}: {case.title}",
)
def test_a_safe_fix_declares_only_names_that_resolve(case: Case, told: bool) -> None:
    """In the stated distribution, or in every active one where none was stated."""
    tree, case = case.tree(), case._replace(chosen=told)
    safe = [issue for issue in issues_of(tree, case, RULES[case.source.stem]) if issue.finding.fix and issue.finding.fix.safe]
    new = {
        name
        for path, text in fixed(tree, tuple(safe)).items()
        if path.endswith("package.xml")
        for name in _declared(Text(path, text)) - _declared(text_of(tree, path))
    }
    if not new:
        return
    own = {package.name for package in discover(tree, ("",)).packages}
    own |= set(in_tree(tree, case.underlay, case.distros[0]).packages) if case.underlay else set()
    knowledge = Knowledge(case.distros[0])
    for distro in case.distros if told else knowledge.active:
        assert {name for name in new - own if not knowledge.rosdep_resolves(name, distro)} == set(), distro


def _declared(text: Text) -> set[str]:
    return {depend.name for depend in manifest.collect(text).depends if depend.tag in ROLES}
