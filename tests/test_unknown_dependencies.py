"""Unknown dependencies of a package with few and with many of them."""

from __future__ import annotations

import pytest

from ros_lint.analysis.dependencies.unknown_closure import may_provide
from ros_lint.analysis.dependencies.unresolved import MOST_CORRECTED
from ros_lint_rules import unknown_dependency
from tests.one_package import load


@pytest.mark.parametrize(("count", "suggested"), [(MOST_CORRECTED, "did you mean 'rclcpp'"), (MOST_CORRECTED + 1, "correct it")])
def test_intended_names_are_searched_for_few_unknown_dependencies(count: int, suggested: str) -> None:
    names = ["rclcp", *(f"thing{number}" for number in range(count - 1))]
    workspace = load("", {}, "".join(f"<depend>{name}</depend>\n" for name in names))
    found = list(unknown_dependency.check(workspace))
    assert [finding.subject for finding in found] == names
    assert suggested in found[0].message


def test_one_of_many_unknown_dependencies_may_provide_any_package() -> None:
    workspace = load("", {})
    assert not may_provide(["no-package"], "rclcpp", workspace)
    assert may_provide(["no-package"] * (MOST_CORRECTED + 1), "rclcpp", workspace)
