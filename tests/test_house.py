"""Requirements that every rule and every module has to meet."""

import re
from pathlib import Path

import pytest

from ros_lint.analysis.rule import Rule
from ros_lint.engine import registry
from ros_lint.engine.former_rules import FORMER, FormerRule
from ros_lint.testing import FENCE, read_cases

ROOT = Path(__file__).parent.parent
FIXTURES = ROOT / "fixtures"
HEADINGS = ["What it finds", "Why it matters", "How to fix it", "Limitations"]
RULES = registry.load()


def by_name(rule: Rule) -> str:
    return rule.name


def test_names_and_codes_are_unique() -> None:
    assert len({rule.name for rule in RULES}) == len({rule.code for rule in RULES}) == len(RULES)


@pytest.mark.parametrize("former", FORMER, ids=lambda former: former.name)
def test_former_rules_are_gone_and_their_successors_exist(former: FormerRule) -> None:
    assert not any(former.name == rule.name or former.code == rule.code for rule in RULES)
    assert set(former.successors) <= {rule.name for rule in RULES}


@pytest.mark.parametrize("rule", RULES, ids=by_name)
def test_every_rule_has_complete_documentation(rule: Rule) -> None:
    module = ROOT / "rules" / "ros_lint_rules" / f"{rule.name.replace('-', '_')}.py"
    assert module.exists(), "a rule's file is called as the rule"
    assert re.fullmatch(r"ROS[123459]\d\d", rule.code)
    assert re.findall(r"^## (.*)$", rule.doc, re.MULTILINE) == HEADINGS
    assert rule.summary[0].islower()
    assert not rule.summary.endswith(".")
    assert sum(check is not None for check in (rule.package, rule.workspace, rule.suppressions)) == 1


@pytest.mark.parametrize("rule", RULES, ids=by_name)
def test_every_rule_has_cases_with_and_without_a_finding(rule: Rule) -> None:
    wants = [bool(case.wants()) for case in read_cases(FIXTURES / f"{rule.name}.md")]
    assert any(wants), "no case in which the rule reports something"
    assert not all(wants), "no case in which the rule reports nothing"


@pytest.mark.parametrize("rule", [rule for rule in RULES if rule.fixable], ids=by_name)
def test_every_rule_with_a_fix_has_a_case_with_its_diff(rule: Rule) -> None:
    assert any(case.diff for case in read_cases(FIXTURES / f"{rule.name}.md")), "no case shows the fix as a diff"


def test_every_file_of_cases_belongs_to_a_rule() -> None:
    assert {path.stem for path in FIXTURES.glob("*.md")} == {rule.name for rule in RULES}


def test_every_fence_is_closed() -> None:
    for path in FIXTURES.glob("*.md"):
        assert "```" not in FENCE.sub("", path.read_text("utf-8")), path


def test_only_the_api_re_exports_names() -> None:
    """Elsewhere a name is imported from the module that defines it."""
    package = ROOT / "ros_lint"
    hubs = {
        path.relative_to(package).parts[0]
        for path in package.rglob("*.py")
        if re.search(r"^__all__\b|import (\w+) as \1\b", path.read_text("utf-8"), re.MULTILINE)
    }
    assert hubs == {"api"}


def test_every_module_has_a_docstring_of_one_sentence() -> None:
    package = ROOT / "ros_lint"
    lacking = [
        str(path.relative_to(package))
        for path in package.rglob("*.py")
        if not re.match(r'""".+[.:]["\n]', path.read_text("utf-8")) or "TODO" in path.read_text("utf-8")[:80]
    ]
    assert lacking == []


def test_the_package_has_few_modules_at_its_top_level() -> None:
    names = {path.name.removesuffix(".py") for path in (ROOT / "ros_lint").iterdir() if not path.name.startswith("_")} - {
        "py.typed"
    }
    assert len(names) <= 12, sorted(names)
