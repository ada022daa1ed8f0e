"""Run the commands ``rules``, ``rule``, ``schema`` and ``completion``, which print information about ros-lint."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ros_lint.cli import rule_pages
from ros_lint.cli.messages import show
from ros_lint.engine import registry
from ros_lint.errors import UserError


def run(command: str, options: Mapping[str, Any]) -> int:
    """Run ``ros-lint rules``, ``rule``, ``schema`` or ``completion`` with the parsed options, and return the exit code."""
    match command:
        case "rules" | "rule":
            return _rules(options)
        case "schema":
            import json  # noqa: PLC0415

            from ros_lint.cli.options import schema  # noqa: PLC0415

            print(json.dumps(schema(), indent=2))
            return 0
        case _:
            from ros_lint.cli import completions  # noqa: PLC0415

            print(completions.script(options["shell"]), end="")
            return 0


def _rules(options: Mapping[str, Any]) -> int:
    """Print all rules, or the rule in the option ``rule``. Return the exit code: 2 if there is no such rule, else 0."""
    name: str | None = options.get("rule")
    try:
        rules = registry.load(options.get("plugins", False))
    except UserError as error:
        show(str(error))
        return 2
    matches = rules if name is None else [rule for rule in rules if name.lower() in (rule.name, rule.code.lower())]
    if not matches:
        show(registry.unknown_rule_message(rules, str(name)))
        return 2
    if options.get("format") == "json":
        print(rule_pages.as_json(matches), end="")
    else:
        print(rule_pages.listing(matches) if name is None else rule_pages.page(matches[0]), end="")
    return 0
