"""Documentation of rules and options as text, Markdown and JSON: lists of rules, the page of a rule, and a table of options."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from ros_lint.analysis.rule import Rule
from ros_lint.cli.options import CliOption
from ros_lint.cli.settings import toml
from ros_lint.engine.former_rules import FORMER, FormerRule
from ros_lint.engine.registry import plugin_of

GROUPS = {
    "1": "Workspace and manifest",
    "2": "Dependencies",
    "3": "Build scripts",
    "4": "Install",
    "5": "Launch",
    "9": "The tool itself",
}


def group(rule: Rule) -> str:
    """Return the group of a rule: a topic by the first digit of its code, or "Plugin" and the name of the rule's plugin."""
    plugin = plugin_of(rule.name)
    return f"Plugin {plugin}" if plugin else GROUPS[rule.code[3]]


def listing(rules: Iterable[Rule]) -> str:
    """Return a line for each rule: code, name, severity, on or off by default, "fix" if it has fixes, and summary."""
    rules = list(rules)
    width = max((len(rule.name) for rule in rules), default=0)
    code_width = max((len(rule.code) for rule in rules), default=0)
    lines = []
    for rule in rules:
        marks = f"{'on ' if rule.default else 'off'} {'fix' if rule.fixable else '   '}"
        lines.append(f"{rule.code:{code_width}}  {rule.name:{width}}  {rule.severity!s:7}  {marks}  {rule.summary}")
    return "".join(f"{line}\n" for line in lines)


def page(rule: Rule, example: str = "") -> str:
    """Return the Markdown page of a rule. The output ``example`` is added to the section "What it finds"."""
    facts = [
        f"{rule.severity!s}",
        "on by default" if rule.default else f"off by default (`--select {rule.name}` or `--pedantic`)",
        "some findings have a fix" if rule.fixable else "no fix",
        f"since {rule.since}",
    ]
    summary = f"{rule.summary[0].upper()}{rule.summary[1:]}."
    doc = rule.doc.strip()
    if example:
        what_it_finds, why, rest = doc.partition(_WHY)
        doc = f"{what_it_finds}```text\n{example}\n```\n\n{why}{rest}"
    return f"# {rule.name} ({rule.code})\n\n{summary}\n\n{' · '.join(facts)}\n\n{doc}\n"


_WHY = "## Why it matters\n"


def overview(rules: Sequence[Rule]) -> str:
    """Return a Markdown page that lists all rules of ros-lint, with links to their pages."""
    parts = ["# Rules\n\nGenerated from the rules and their cases by `pytest --bless`. `ros-lint rule NAME` prints a page.\n"]
    for digit, heading in GROUPS.items():
        in_group = [rule for rule in rules if rule.code[3] == digit]
        if not in_group:
            continue
        parts.append(f"\n## {heading}\n\n| code | rule | severity | default | fix | checks that |\n|---|---|---|---|---|---|\n")
        parts += [
            f"| {rule.code} | [{rule.name}]({rule.name}.md) | {rule.severity!s} | {'on' if rule.default else 'off'} "
            f"| {'yes' if rule.fixable else ''} | {rule.summary} |\n"
            for rule in in_group
        ]
    parts.append("\n## Former rules\n\n| code | rule | status |\n|---|---|---|\n")
    parts += [f"| {former.code} | {former.name} | {_fate(former)} |\n" for former in FORMER]
    return "".join(parts)


def _fate(former: FormerRule) -> str:
    links = ", ".join(f"[{name}]({name}.md)" for name in former.successors)
    return f"divided into {links}" if links else "removed"


def settings(options: Iterable[CliOption]) -> str:
    """Return a Markdown table of options. Options that configuration files can set come first."""
    lines = ["| setting | command line | default | meaning |", "|---|---|---|---|"]
    for option in sorted(options, key=lambda option: not option.in_file):
        name = f"`{option.name}`" if option.in_file else ""
        default = f"`${option.environment}`" if option.environment else f"`{toml(option.default)}`" if option.in_file else ""
        choices = f": {', '.join(f'`{choice}`' for choice in option.choices)}" if option.choices and option.type == "word" else ""
        lines.append(f"| {name} | {_flag(option)} | {default} | {option.help}{choices} |")
    return "\n".join(lines)


def _flag(option: CliOption) -> str:
    if not option.on_command_line:
        return ""
    if option.type == "flag":
        return f"`--no-{option.name}`" if option.default else f"`--{option.name}`"
    return f"`--{option.name} {option.metavar or 'WORD'}`"


def as_json(rules: Iterable[Rule]) -> str:
    """Return the names, codes, severities, documentation and other data of rules as a JSON list."""
    import json  # noqa: PLC0415

    return (
        json.dumps(
            [
                {
                    "name": rule.name,
                    "code": rule.code,
                    "group": group(rule),
                    "severity": str(rule.severity),
                    "default": rule.default,
                    "fixable": rule.fixable,
                    "since": rule.since,
                    "summary": rule.summary,
                    "doc": rule.doc.strip(),
                }
                for rule in rules
            ],
            indent=2,
        )
        + "\n"
    )
