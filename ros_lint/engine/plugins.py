"""Load the rules of plugins: installed Python packages with an entry point in the group ``ros_lint.rules``.

The codes of a plugin begin with letters that no other plugin uses, so that the codes of two plugins never collide and the
letters select all rules of the plugin. A collision is an error, because settings and suppression comments would be
ambiguous.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from importlib.metadata import EntryPoint, entry_points
from itertools import groupby
from typing import Final, NamedTuple

from ros_lint.analysis.rule import Rule
from ros_lint.engine.rule_modules import rules_of
from ros_lint.errors import UserError

GROUP: Final = "ros_lint.rules"
RESERVED: Final = "ROS"
"""The letters with which the codes of ros-lint's own rules begin."""

_CODE = re.compile(r"([A-Z]+)[0-9]+")
_NAME = re.compile(r"[a-z][a-z0-9]*(-[a-z0-9]+)*")
_SELECTORS = ("all", "default")


class PluginError(UserError):
    """A plugin cannot be loaded, or a rule of the plugin has an invalid name or code, or the name or code of another rule."""


class Plugin(NamedTuple):
    """The rules of a plugin, which is one installed Python distribution."""

    name: str
    """Name and version of the Python distribution: "acme-rules 1.0"."""
    rules: tuple[Rule, ...]


def load(builtin: Sequence[Rule], builtin_module: str) -> tuple[Plugin, ...]:
    """Return the installed plugins, sorted by name. Raises PluginError.

    ``builtin`` are the rules of ros-lint itself. ``builtin_module`` is the module in the entry point of ros-lint itself,
    which is left out.
    """
    entries = groupby(_entries(builtin_module), key=_owner)
    plugins = tuple(Plugin(name, tuple(rule for entry in group for rule in _loaded(name, entry))) for name, group in entries)
    for problem in problems(builtin, plugins):
        raise PluginError(problem)
    return plugins


def installed(builtin_module: str) -> tuple[str, ...]:
    """Return the names and versions of the installed plugins, sorted. The plugins are not imported."""
    return tuple(dict.fromkeys(_owner(entry) for entry in _entries(builtin_module)))


def _entries(builtin_module: str) -> list[EntryPoint]:
    entries = [entry for entry in entry_points(group=GROUP) if entry.value != builtin_module]
    return sorted(entries, key=lambda entry: (_owner(entry), entry.name))


def _owner(entry: EntryPoint) -> str:
    return f"{entry.dist.name} {entry.dist.version}" if entry.dist else entry.name


def _loaded(owner: str, entry: EntryPoint) -> tuple[Rule, ...]:
    try:
        return tuple(rules_of(entry.load()))
    except Exception as error:
        raise PluginError(f"the plugin '{owner}' cannot be loaded ({entry.name} = {entry.value}): {error}") from error


def problems(builtin: Sequence[Rule], plugins: Iterable[Plugin]) -> Iterator[str]:
    """Yield a message for each rule of a plugin whose name or code is invalid or is also that of another rule."""
    owner_of_name = {rule.name: "ros-lint" for rule in builtin}
    owner_of_letters: dict[str, str] = {}
    for plugin in plugins:
        owner = f"the plugin '{plugin.name}'"
        for rule in plugin.rules:
            if problem := _code_problem(rule, owner, owner_of_letters) or _name_problem(rule, owner, owner_of_name):
                yield problem
        codes = [rule.code for rule in plugin.rules]
        for code in sorted({code for code in codes if codes.count(code) > 1}):
            yield f"{owner} has two rules with the code '{code}'; give each rule a code of its own"


def _code_problem(rule: Rule, owner: str, owner_of_letters: dict[str, str]) -> str:
    """Return a message about the code of a rule of a plugin, "" if it is valid.

    Adds the letters of the code to ``owner_of_letters``.
    """
    its_code = f"{owner}: the code '{rule.code}' of its rule '{rule.name}'"
    code = _CODE.fullmatch(rule.code)
    if code is None:
        return f"{its_code} is invalid; write capital letters and digits, such as 'ACME001'"
    letters = code[1]
    if letters == RESERVED:
        return f"{its_code} begins with {RESERVED}, which is reserved for ros-lint; write other letters, such as 'ACME001'"
    other = owner_of_letters.setdefault(letters, owner)
    if other != owner:
        return f"{other} and {owner} both have codes that begin with {letters}, so their codes can collide; uninstall one of them"
    return ""


def _name_problem(rule: Rule, owner: str, owner_of_name: dict[str, str]) -> str:
    """Return a message about the name of a rule of a plugin, "" if it is valid. Adds the name to ``owner_of_name``."""
    if _NAME.fullmatch(rule.name) is None or rule.name in _SELECTORS:
        return f"{owner}: the rule name '{rule.name}' is invalid; write words with hyphens, such as 'old-name'"
    if other := owner_of_name.get(rule.name):
        return f"{owner}: the rule name '{rule.name}' is already used by {other}; rename the rule of the plugin"
    owner_of_name[rule.name] = owner
    return ""
