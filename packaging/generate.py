"""Write the man page and the completion scripts: ``python packaging/generate.py``.

Both are made from the parsers of the command line, so they name all commands and options.
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterator
from pathlib import Path

from ros_lint import __version__
from ros_lint.cli.arguments import create_parser
from ros_lint.cli.options import COMMANDS
from ros_lint.engine import registry

ROOT = Path(__file__).parent.parent
MAN_PAGE = Path("docs/ros-lint.1")
BASH = Path("packaging/completions/ros-lint.bash")
ZSH = Path("packaging/completions/_ros-lint")
FISH = Path("packaging/completions/ros-lint.fish")
RULE_OPTIONS = ("--select", "--extend-select", "--ignore", "--fix-only")
DISTROS = ("humble", "jazzy", "kilted", "lyrical", "rolling")


def main() -> None:
    """Write all files."""
    for path, text in files().items():
        (ROOT / path).write_text(text, "utf-8")


def files() -> dict[Path, str]:
    """Return the generated files by their path in the repository."""
    bash = _bash()
    zsh = f"#compdef ros-lint\nautoload -Uz bashcompinit && bashcompinit\n{bash}"
    return {MAN_PAGE: _man_page(), BASH: bash, ZSH: zsh, FISH: _fish()}


def _actions(command: str) -> list[argparse.Action]:
    """Return the options and positional arguments of a command, also of its actions."""
    return list(_walk(create_parser(command)))


def _walk(parser: argparse.ArgumentParser) -> Iterator[argparse.Action]:
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            yield action
            for name in action.choices:
                yield from _walk(action.choices[name])
        elif action.help != argparse.SUPPRESS:
            yield action


def _words(action: argparse.Action, command: str) -> list[str]:
    """Return the values of an argument as far as they are known."""
    if action.choices:
        return [str(choice) for choice in action.choices]
    if "--distro" in action.option_strings:
        return list(DISTROS)
    if set(RULE_OPTIONS) & set(action.option_strings) or (command == "rule" and not action.option_strings):
        return [rule.name for rule in registry.load()]
    return []


def _man_page() -> str:
    parts = [
        f'.TH ROS-LINT 1 "" "ros-lint {__version__}" "User Commands"',
        ".SH NAME\nros\\-lint \\- check ROS 2 workspaces without building them",
        ".SH SYNOPSIS\n.B ros\\-lint\n[\\fICOMMAND\\fR] [\\fIOPTION\\fR ...] [\\fIPATH\\fR ...]",
        ".SH DESCRIPTION\n"
        + _roff(
            "ros-lint compares what packages declare, use, provide, install and launch. It neither builds nor runs anything."
        ),
        ".SH COMMANDS",
        *(f".TP\n.B {_roff(name)}\n{_roff(summary)}" for name, summary in COMMANDS.items()),
    ]
    for command in COMMANDS:
        entries = [_man_entry(action) for action in _actions(command) if action.option_strings and action.dest != "help"]
        if entries:
            parts += [f".SH OPTIONS OF {_roff(command.upper())}", *dict.fromkeys(entries)]
    parts += [
        ".SH EXIT STATUS",
        ".TP\n.B 0\nno findings at or above \\-\\-fail\\-on",
        ".TP\n.B 1\nsuch findings",
        ".TP\n.B 2\nthe check could not be done",
    ]
    return "\n".join(parts) + "\n"


def _man_entry(action: argparse.Action) -> str:
    value = action.metavar or ("{" + ",".join(map(str, action.choices)) + "}" if action.choices else "")
    shown = f" \\fI{_roff(str(value))}\\fR" if value and action.nargs != 0 else ""
    return f".TP\n\\fB{_roff(', '.join(action.option_strings))}\\fR{shown}\n{_roff((action.help or '').replace('%%', '%'))}"


def _roff(text: str) -> str:
    """Escape a text of one paragraph for a man page."""
    escaped = re.sub(r"\s+", " ", text).replace("\\", "\\e").replace("-", "\\-")
    return f"\\&{escaped}" if escaped[:1] in (".", "'") else escaped


def _bash() -> str:
    options, values = [], []
    for command in COMMANDS:
        actions = _actions(command)
        flags = dict.fromkeys(flag for action in actions for flag in action.option_strings)
        words = [word for action in actions if not action.option_strings for word in _words(action, command)]
        options.append(f'    {command}) words="{" ".join([*flags, *words])}" ;;')
        for action in actions:
            known = _words(action, command)
            if known and action.option_strings:
                values += [f'    {command}:{flag}) words="{" ".join(known)}" ;;' for flag in action.option_strings]
    return f"""# Completion of ros-lint, written by packaging/generate.py.
_ros_lint() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD-1]}} command=check words=
  case ${{COMP_WORDS[1]}} in
    {"|".join(COMMANDS)}) [ "$COMP_CWORD" = 1 ] || command=${{COMP_WORDS[1]}} ;;
  esac
  case $command in
{chr(10).join(options)}
  esac
  [ "$COMP_CWORD" != 1 ] || words="$words {" ".join(COMMANDS)}"
  case $command:$previous in
{chr(10).join(values)}
  esac
  COMPREPLY=($(compgen -W "$words" -- "$current"))
}}
complete -o default -o bashdefault -F _ros_lint ros-lint
"""


def _fish() -> str:
    names = " ".join(COMMANDS)
    lines = ["# Completion of ros-lint, written by packaging/generate.py."]
    lines += [
        f"complete -c ros-lint -n '__fish_is_first_arg' -a {name} -d {_fish_quoted(text)}" for name, text in COMMANDS.items()
    ]
    for command in COMMANDS:
        condition = f"__fish_seen_subcommand_from {command}"
        if command == "check":
            condition = f"not __fish_seen_subcommand_from {names.replace('check ', '')}"
        for action in _actions(command):
            known = _words(action, command)
            values = f" -x -a '{' '.join(known)}'" if known and (action.option_strings or command == "rule") else ""
            flags = "".join(f" -l {flag[2:]}" if flag.startswith("--") else f" -s {flag[1:]}" for flag in action.option_strings)
            if flags or values:
                text = _fish_quoted((action.help or "").replace("%%", "%"))
                lines.append(f"complete -c ros-lint -n '{condition}'{flags}{values} -d {text}")
    return "\n".join(dict.fromkeys(lines)) + "\n"


def _fish_quoted(text: str) -> str:
    return "'" + text.replace("\\", "\\\\").replace("'", "\\'") + "'"


if __name__ == "__main__":
    main()
