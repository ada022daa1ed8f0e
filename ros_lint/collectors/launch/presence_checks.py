"""Conditions in launch files that test whether a package is installed, or which ROS distribution is used."""

from __future__ import annotations

from collections.abc import Iterable

from ros_lint.collectors.launch.expressions import evaluate, means_true
from ros_lint.collectors.symbolic_text import fill, is_settled, named_in, package_of_presence
from ros_lint.facts.launch import LaunchCondition


def is_guarded_by_presence(conditions: Iterable[LaunchCondition]) -> bool:
    """Return whether one of the conditions tests that a package is installed, so that the package is optional."""
    return any(condition.wanted and package_of_presence(text) for condition in conditions for text in condition.texts)


DISTRIBUTIONS = ("humble", "jazzy", "kilted", "lyrical", "rolling")
"""The maintained ROS distributions.

Conditions on older distributions are ignored. The list is constant, because the facts of a file must not depend on data that
the user can update. A test compares it with the package index."""
_ROS_DISTRO = "$ROS_DISTRO"


EVERYWHERE = frozenset(DISTRIBUTIONS)


def distributions_under(conditions: Iterable[LaunchCondition]) -> frozenset[str]:
    """Return the maintained ROS distributions in which all conditions on ROS_DISTRO may hold."""
    on_distribution = [condition for condition in conditions if any(_ROS_DISTRO in text for text in condition.texts)]
    return (
        frozenset([distro for distro in DISTRIBUTIONS if _holds_in(distro, on_distribution)]) if on_distribution else EVERYWHERE
    )


def _holds_in(distro: str, conditions: Iterable[LaunchCondition]) -> bool:
    """Return whether all conditions may hold in a ROS distribution. Only conditions on ROS_DISTRO alone are evaluated."""
    for (text, *further_texts), equals, wanted in conditions:
        if further_texts or set(named_in(text) or ()) != {_ROS_DISTRO}:
            continue
        texts = fill(text, lambda _: (distro,), evaluate)
        answers = {means_true(filled) if equals is None else filled == equals for filled in texts if is_settled(filled)}
        if answers == {not wanted}:
            return False
    return True
