"""The commands ``rules``, ``rule``, ``schema`` and ``completion``: information about ros-lint."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import Any

from ros_lint.cli import rule_pages
from ros_lint.engine import registry


def run(command: str, options: Mapping[str, Any]) -> int:
    """Print the requested information and return the exit code."""
    match command:
        case "rules":
            rules = registry.load()
            print(rule_pages.as_json(rules) if options.get("format") == "json" else rule_pages.listing(rules), end="")
            return 0
        case "rule":
            return _rule(options["rule"], options.get("format", "text"))
        case "schema":
            import json  # noqa: PLC0415

            from ros_lint.cli.options import schema  # noqa: PLC0415

            print(json.dumps(schema(), indent=2))
            return 0
        case _:
            return _completion(options["shell"])


def _rule(name: str, form: str) -> int:
    rules = registry.load()
    matches = [rule for rule in rules if name.lower() in (rule.name, rule.code.lower())]
    if not matches:
        print(f"ros-lint: {registry.unknown_rule_message(rules, name)}", file=sys.stderr)
        return 2
    print(rule_pages.as_json(matches) if form == "json" else rule_pages.page(matches[0]), end="")
    return 0


def _completion(shell: str) -> int:
    try:
        import shtab  # noqa: PLC0415
    except ModuleNotFoundError:
        print("ros-lint: completion needs shtab: pip install 'ros-lint[completion]'", file=sys.stderr)
        return 2
    from ros_lint.cli.arguments import create_parser  # noqa: PLC0415

    print(shtab.complete(create_parser("check", top=True), shell=shell))
    return 0
