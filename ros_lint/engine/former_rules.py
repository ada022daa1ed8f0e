"""Rules that were divided or removed. Messages tell the user which rules replace them.

The name or code of a former rule selects and suppresses no rule. In settings and on the command line it is an error. In a
comment it is a finding of the rule ``unknown-rule-in-suppression``.
"""

from __future__ import annotations

from typing import NamedTuple


class FormerRule(NamedTuple):
    """A rule that no longer exists, because it was divided or removed."""

    name: str
    code: str
    successors: tuple[str, ...] = ()
    """The names of the rules into which the rule was divided; () if it was removed."""

    @property
    def fate(self) -> str:
        """The end of a message that begins with "rule 'x'": "was removed; ..." or "was divided into 'y' and 'z'; ..."."""
        *others, last = (f"'{name}'" for name in self.successors or ("",))
        if not others:
            return "was removed; delete its name"
        return f"was divided into {', '.join(others)} and {last}; name the rules that you mean"


FORMER = (
    FormerRule("dead-group", "ROS118"),
    FormerRule("flattened-duplicates", "ROS414"),
    FormerRule(
        "cmake-hygiene",
        "ROS310",
        (
            "old-cmake-version",
            "find-package-without-required",
            "duplicate-find-package",
            "overwritten-cmake-variable",
            "include-find-module",
            "link-directories",
        ),
    ),
    FormerRule(
        "launch-argument",
        "ROS507",
        (
            "launch-missing-argument",
            "launch-unknown-argument",
            "launch-undeclared-configuration",
            "launch-used-before-declaration",
            "launch-invalid-default",
            "launch-invalid-expression",
            "launch-unused-argument",
        ),
    ),
)


def former_rule(selector: str) -> FormerRule | None:
    """Return the former rule whose name or code is ``selector``, in upper or lower case; None if there is none."""
    return next((rule for rule in FORMER if selector.lower() in (rule.name, rule.code.lower())), None)
