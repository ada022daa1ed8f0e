"""Every case in fixtures/, against its rule."""

from pathlib import Path

import pytest

from ros_lint import registry
from ros_lint.testing import Case, bless, differences, read_cases

FIXTURES = Path(__file__).parent.parent / "fixtures"
RULES = {rule.name: rule for rule in registry.load()}
CASES = [case for source in sorted(FIXTURES.glob("*.md")) for case in read_cases(source)]


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.source.stem}: {case.title}")
def test_case(case: Case, request: pytest.FixtureRequest) -> None:
    rule = RULES[case.source.stem]
    if request.config.getoption("bless"):
        bless(case, rule)
        return
    assert "\n".join(differences(case, rule)) == ""
