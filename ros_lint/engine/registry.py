"""Discovery of rules: built-in ones and plugins, by the entry point group ``ros_lint.rules``.

An entry names a module or a package; every ``RULE`` in it and in its direct submodules is loaded. The built-in entry is
known without a search. Entries of plugins are only searched if the settings enable plugins, because the search by
``importlib.metadata`` takes longer than most runs.
"""

from __future__ import annotations

import importlib
import os
from collections.abc import Iterator, Sequence
from functools import lru_cache
from types import ModuleType

from ros_lint.analysis.rule import Rule
from ros_lint.base.suggestions import did_you_mean, similar_names
from ros_lint.engine.former_rules import former_rule
from ros_lint.errors import UserError

GROUP = "ros_lint.rules"
BUILTIN = "ros_lint_rules"


class PluginError(UserError):
    """A plugin that cannot be loaded, or has a rule with the name or code of another rule."""


@lru_cache(maxsize=2)
def load(plugins: bool = False) -> tuple[Rule, ...]:
    """Return the built-in rules, and with ``plugins`` the rules of plugins, sorted by code. Raises PluginError."""
    rules = list(_rules_of(importlib.import_module(BUILTIN)))
    if plugins:
        rules += _plugin_rules()
    rule_of: dict[str, Rule] = {}
    for rule in rules:
        for key in (rule.name, rule.code):
            if rule_of.setdefault(key, rule) != rule:
                raise PluginError(f"two rules have the same name or code '{key}'")
    return tuple(sorted(rules, key=lambda rule: rule.code))


def _plugin_rules() -> Iterator[Rule]:
    from importlib.metadata import entry_points  # noqa: PLC0415

    for entry in sorted(entry_points(group=GROUP), key=lambda entry: entry.name):
        if entry.value == BUILTIN:
            continue
        try:
            yield from _rules_of(entry.load())
        except Exception as error:
            raise PluginError(f"plugin '{entry.name}' ({entry.value}) cannot be loaded: {error}") from error


def _rules_of(module: ModuleType) -> Iterator[Rule]:
    if isinstance(rule := getattr(module, "RULE", None), Rule):
        yield rule
    for name in sorted({name for folder in getattr(module, "__path__", ()) for name in _modules_in(folder)}):
        yield from _rules_of(importlib.import_module(f"{module.__name__}.{name}"))


def _modules_in(folder: str) -> Iterator[str]:
    """Yield the names of the modules and packages in a folder, without ``pkgutil``, whose import takes longer."""
    for entry in os.scandir(folder) if os.path.isdir(folder) else ():
        name, dot, suffix = entry.name.partition(".")
        is_module = suffix == "py" or (not dot and os.path.isfile(os.path.join(entry.path, "__init__.py")))
        if is_module and name.isidentifier() and name != "__init__":
            yield name


def matching(rules: Sequence[Rule], selector: str) -> tuple[Rule, ...]:
    """Return the rules that match a selector: ``all``, ``default``, a name, a code or a code prefix."""
    if selector == "all":
        return tuple(rules)
    if selector == "default":
        return tuple(rule for rule in rules if rule.default)
    exact = tuple(rule for rule in rules if selector in (rule.name, rule.code))
    if exact or not selector.startswith("ROS"):
        return exact
    return tuple(rule for rule in rules if rule.code.startswith(selector))


def unknown_rule_message(rules: Sequence[Rule], selector: str) -> str:
    """Return the message for a selector that matches no rule."""
    if former := former_rule(selector):
        return f"rule '{selector}' {former.fate}"
    words = [word for rule in rules for word in (rule.name, rule.code)]
    return f"unknown rule '{selector}'{did_you_mean(similar_names(selector, [*words, 'all', 'default']))}"
