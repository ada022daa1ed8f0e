"""docs/catkin-lint.md covers each check of catkin_lint."""

import re
from pathlib import Path

from ros_lint.engine import registry

TABLE = (Path(__file__).parent.parent / "docs" / "catkin-lint.md").read_text("utf-8")
ROWS = re.findall(r"^\| ([A-Z_]+) \| .+? \| (.+) \|$", TABLE, re.MULTILINE)
NAMES = {rule.name for rule in registry.load()}


def test_every_check_is_listed_once() -> None:
    names = [name for name, _ in ROWS]
    assert len(names) == len(set(names)) == 80  # 96 in all, less 16 about catkin alone


def test_every_check_has_rules_that_exist_or_a_reason() -> None:
    for name, answer in ROWS:
        named = re.findall(r"\[([a-z-]+)\]\(rules/\1\.md\)", answer)
        assert named or re.match(r"none: \S.{9}", answer), name
        assert set(named) <= NAMES, name
