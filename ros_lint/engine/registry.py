"""Find the rules of ros-lint and of plugins by the entry point group ``ros_lint.rules``.

An entry point names a module or package. The object ``RULE`` of this module and of each direct submodule is a rule. The
entry point of ros-lint itself is not searched for, because ``importlib.metadata`` takes longer than most runs. Plugins
are searched for only with ``--plugins``.
"""

from __future__ import annotations

import importlib
from collections.abc import Sequence
from functools import lru_cache
from typing import TYPE_CHECKING

from ros_lint.analysis.rule import Rule
from ros_lint.base.suggestions import did_you_mean, similar_names
from ros_lint.engine.former_rules import former_rule
from ros_lint.engine.rule_modules import rules_of

if TYPE_CHECKING:
    from ros_lint.engine.plugins import Plugin

BUILTIN = "ros_lint_rules"


@lru_cache(maxsize=2)
def load(plugins: bool = False) -> tuple[Rule, ...]:
    """Return the rules of ros-lint, and if ``plugins`` is True those of plugins, sorted by code. Raises PluginError."""
    rules = list(rules_of(importlib.import_module(BUILTIN)))
    if plugins:
        rules += [rule for plugin in _plugins() for rule in plugin.rules]
    return tuple(sorted(rules, key=lambda rule: rule.code))


@lru_cache(maxsize=1)
def _plugins() -> tuple[Plugin, ...]:
    from ros_lint.engine import plugins  # noqa: PLC0415  (importlib.metadata takes longer than most runs)

    return plugins.load(load(), BUILTIN)


def plugin_of(rule: str) -> str:
    """Return name and version of the plugin with a rule, "" for a rule of ros-lint. ``rule`` is the rule's name.

    Raises PluginError.
    """
    if any(rule == builtin.name for builtin in load()):
        return ""
    return next((plugin.name for plugin in _plugins() if any(rule == other.name for other in plugin.rules)), "")


def matching(rules: Sequence[Rule], selector: str) -> tuple[Rule, ...]:
    """Return the rules that a selector means. A selector is ``all``, ``default``, a name, a code or a code prefix.

    A code prefix is the letters of a code, optionally with its first digits: ``ROS``, ``ROS2``, ``ACME``.
    """
    if selector == "all":
        return tuple(rules)
    if selector == "default":
        return tuple(rule for rule in rules if rule.default)
    exact = tuple(rule for rule in rules if selector in (rule.name, rule.code))
    letters = _letters(selector)
    return exact or tuple(rule for rule in rules if rule.code.startswith(selector) and _letters(rule.code) == letters)


def _letters(code: str) -> str:
    return code.rstrip("0123456789")


def unknown_rule_message(rules: Sequence[Rule], selector: str) -> str:
    """Return the error message for a selector that matches none of ``rules``.

    The message mentions the option ``--plugins`` if ``rules`` include no rules of plugins.
    """
    if former := former_rule(selector):
        return f"rule '{selector}' {former.fate}"
    words = [word for rule in rules for word in (rule.name, rule.code)]
    hint = did_you_mean(similar_names(selector, [*words, "all", "default"]))
    if len(rules) > len(load()):
        return f"unknown rule '{selector}'{hint}"
    from ros_lint.engine.plugins import installed  # noqa: PLC0415

    if plugins := ", ".join(f"'{name}'" for name in installed(BUILTIN)):
        return f"unknown rule '{selector}'{hint or ';'} rules of installed plugins ({plugins}) need --plugins"
    return f"unknown rule '{selector}'{hint or '; if a plugin has it, install the plugin and add --plugins'}"
