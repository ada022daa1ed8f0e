"""The completion scripts for shells, made from the parsers of the command line."""

from __future__ import annotations

import argparse
from collections.abc import Iterator

from ros_lint.cli.arguments import create_parser
from ros_lint.cli.options import COMMANDS
from ros_lint.engine import registry
from ros_lint.knowledge import distros

_RULE_OPTIONS = ("--select", "--extend-select", "--ignore", "--fix-only")


def script(shell: str) -> str:
    """Return the completion script for "bash", "zsh" or "fish".

    It completes commands, options, rules and distributions.
    """
    match shell:
        case "zsh":
            return f"#compdef ros-lint\nautoload -Uz bashcompinit && bashcompinit\n{_bash()}"
        case "fish":
            return _fish()
        case _:
            return _bash()


def actions(command: str) -> list[argparse.Action]:
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
        return [distro.name for distro in distros()]
    if set(_RULE_OPTIONS) & set(action.option_strings) or (command == "rule" and not action.option_strings):
        return [rule.name for rule in registry.load()]
    return []


def _bash() -> str:
    options, values = [], []
    for command in COMMANDS:
        arguments = actions(command)
        flags = dict.fromkeys(flag for action in arguments for flag in action.option_strings)
        words = [word for action in arguments if not action.option_strings for word in _words(action, command)]
        options.append(f'    {command}) words="{" ".join([*flags, *words])}" ;;')
        for action in arguments:
            known = _words(action, command)
            if known and action.option_strings:
                values += [f'    {command}:{flag}) words="{" ".join(known)}" ;;' for flag in action.option_strings]
    return f"""# Completion of ros-lint.
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
    lines = ["# Completion of ros-lint."]
    lines += [
        f"complete -c ros-lint -n '__fish_is_first_arg' -a {name} -d {_fish_quoted(text)}" for name, text in COMMANDS.items()
    ]
    for command in COMMANDS:
        condition = f"__fish_seen_subcommand_from {command}"
        if command == "check":
            condition = f"not __fish_seen_subcommand_from {names.replace('check ', '')}"
        for action in actions(command):
            known = _words(action, command)
            values = f" -x -a '{' '.join(known)}'" if known and (action.option_strings or command == "rule") else ""
            flags = "".join(f" -l {flag[2:]}" if flag.startswith("--") else f" -s {flag[1:]}" for flag in action.option_strings)
            if flags or values:
                text = _fish_quoted((action.help or "").replace("%%", "%"))
                lines.append(f"complete -c ros-lint -n '{condition}'{flags}{values} -d {text}")
    return "\n".join(dict.fromkeys(lines)) + "\n"


def _fish_quoted(text: str) -> str:
    return "'" + text.replace("\\", "\\\\").replace("'", "\\'") + "'"
