"""The parser of the command line, built from the table of options in :mod:`ros_lint.cli.options`."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Sequence
from typing import Any, NoReturn

from ros_lint.base.suggestions import did_you_mean, similar_names
from ros_lint.cli.options import BY_NAME, COMMANDS, OPTIONS, Option

_COMMON = ("distro", "underlay", "config", "isolated", "jobs", "cache", "exclude", "progress")
_AROUND = "workspace (default: the one that contains the current folder)"
_EPILOG = """\
commands (see also ros-lint COMMAND --help):
{}

exit codes: 0 no findings at or above --fail-on, 1 such findings, 2 the check could not be done
"""


class _Parser(argparse.ArgumentParser):
    def refuse(self, unknown: Sequence[str]) -> NoReturn:
        """Exit because of unknown arguments."""
        known = [text for action in self._actions for text in action.option_strings]
        hint = did_you_mean(similar_names(unknown[0].partition("=")[0], known))
        self.error(f"unrecognized arguments: {' '.join(unknown)}{hint}")

    def error(self, message: str) -> NoReturn:
        print(f"ros-lint: {message} (see ros-lint --help)", file=sys.stderr)
        raise SystemExit(2)


class _Formatter(argparse.RawDescriptionHelpFormatter):
    """A formatter that does not import ``shutil``: argparse creates one for every option at start-up."""

    def __init__(self, prog: str) -> None:
        super().__init__(prog, width=_columns() - 2)


def _columns() -> int:
    """Return the width of the terminal as shutil.get_terminal_size does, at least 30."""
    columns = os.environ.get("COLUMNS", "")
    if columns.isdecimal() and int(columns):
        return max(int(columns), 30)
    try:
        return max(os.get_terminal_size(sys.__stdout__.fileno()).columns, 30) if sys.__stdout__ else 80
    except (OSError, ValueError):
        return 80


def parse(arguments: Sequence[str]) -> tuple[str, dict[str, Any]]:
    """Return the command, and the ``paths`` and options by name. Exits as argparse does."""
    if arguments and arguments[0] in COMMANDS:
        command, rest = arguments[0], list(arguments[1:])
    else:
        command, rest = "check", list(arguments)
    made = parser(command, top=not arguments or arguments[0] != command)
    # Options may be placed between paths, which argparse does not support for commands with actions.
    namespace, unknown = made.parse_known_args(rest) if command == "index" else made.parse_known_intermixed_args(rest)
    if unknown:
        made.refuse(unknown)
    return command, {name.replace("_", "-"): value for name, value in vars(namespace).items()}


def parser(command: str, *, top: bool = False) -> _Parser:
    """Return the parser of a command. With ``top``, return the parser that also lists the other commands."""
    listed = "\n".join(f"  {name:17}{summary}" for name, summary in COMMANDS.items())
    made = _Parser(
        "ros-lint" if top else f"ros-lint {command}",
        description="Check ROS 2 workspaces without building them."
        if top
        else f"{COMMANDS[command][:1].upper()}{COMMANDS[command][1:]}.",
        epilog=_EPILOG.format(listed) if top else None,
        formatter_class=_Formatter,
        allow_abbrev=False,
        argument_default=argparse.SUPPRESS,
    )
    made.add_argument("--version", action="store_true", help="print the version") if top else None
    _SHAPES[command](made)
    return made


def _check(made: argparse.ArgumentParser) -> None:
    _paths(made)
    for option in OPTIONS:
        if option.on_command_line:
            _add(made, option)


def _graph_like(made: argparse.ArgumentParser) -> None:
    made.add_argument("-C", "--workspace", dest="paths", action="append", metavar="PATH", help=_AROUND)
    for name in _COMMON:
        _add(made, BY_NAME[name])


def _order(made: argparse.ArgumentParser) -> None:
    _paths(made)
    for name in _COMMON:
        _add(made, BY_NAME[name])


def _graph(made: argparse.ArgumentParser) -> None:
    _order(made)
    made.add_argument("--format", choices=("dot", "mermaid", "json"), default="dot", help="output format")
    made.add_argument("--metrics", action="store_true", help="print figures per package instead: degrees, depth, reach")


def _why(made: argparse.ArgumentParser) -> None:
    made.add_argument("package", help="the package with the dependency")
    made.add_argument("dependency", help="the package or rosdep key it depends on")
    made.add_argument("--explain-silence", action="store_true", help="explain why the dependency rules report nothing")
    _graph_like(made)


def _explain_package(made: argparse.ArgumentParser) -> None:
    made.add_argument("package", help="the package to explain")
    made.add_argument("--format", choices=("text", "json"), default="text", help="output format")
    _graph_like(made)


def _launch(made: argparse.ArgumentParser) -> None:
    made.usage = "%(prog)s [options] FILE [name:=value ...]\n       %(prog)s [options] PACKAGE FILE [name:=value ...]"
    text = "a launch file, or a package and the name of a launch file that it installs"
    made.add_argument("words", nargs="+", metavar="FILE", help=text)
    made.add_argument("--format", choices=("tree", "json", "mermaid"), default="tree", help="output format")
    _graph_like(made)


def _index(made: argparse.ArgumentParser) -> None:
    actions = made.add_subparsers(dest="action", required=True, metavar="ACTION")
    refresh = actions.add_parser("refresh", help="rebuild the data of distributions from rosdistro's index", allow_abbrev=False)
    refresh.add_argument("--from", dest="source", required=True, metavar="INDEX", help="path or URL of rosdistro's index-v4.yaml")
    refresh.add_argument("--distro", action="append", default=[], metavar="NAME", help="only this distribution; may be repeated")
    refresh.add_argument(
        "--rosdep", action="append", default=[], metavar="YAML", help="path or URL of rosdep rules; may be repeated"
    )
    refresh.add_argument("--to", default="", metavar="FOLDER", help="output folder (default: the user's data folder)")
    scan = actions.add_parser("scan", help="generate the data from install prefixes", allow_abbrev=False)
    scan.add_argument("prefixes", nargs="+", metavar="PREFIX", help="install prefix, such as /opt/ros/jazzy")
    scan.add_argument("--distro", default="local", metavar="NAME", help="name of the generated distribution (default: local)")
    scan.add_argument("--to", default="", metavar="FOLDER", help="output folder (default: standard output)")


def _rules(made: argparse.ArgumentParser) -> None:
    made.add_argument("--format", choices=("text", "json"), default="text", help="output format")


def _rule(made: argparse.ArgumentParser) -> None:
    made.add_argument("rule", help="name or code of the rule")
    _rules(made)


def _completion(made: argparse.ArgumentParser) -> None:
    made.add_argument("shell", choices=("bash", "zsh", "fish", "tcsh"))


_SHAPES: dict[str, Callable[[argparse.ArgumentParser], None]] = {
    "check": _check,
    "order": _order,
    "overlay": _order,
    "graph": _graph,
    "why": _why,
    "explain-package": _explain_package,
    "launch": _launch,
    "index": _index,
    "rules": _rules,
    "rule": _rule,
    "schema": lambda made: None,
    "completion": _completion,
}


def _paths(made: argparse.ArgumentParser) -> None:
    made.add_argument("paths", nargs="*", default=["."], metavar="PATH", help="workspaces or packages (default: .)")


def _add(made: argparse.ArgumentParser, option: Option) -> None:
    flag = f"--{option.name}"
    text = f"{option.help} (also ${option.environment})" if option.environment else option.help
    match option.type:
        case "flag":
            switch = argparse.BooleanOptionalAction if option.default else "store_true"
            made.add_argument(flag, action=switch, help=text)
        case "number":
            made.add_argument(flag, type=int, metavar=option.metavar, help=text)
        case "words":
            made.add_argument(flag, action=_Words, metavar=option.metavar, help=text)
        case "paths":
            made.add_argument(flag, action="append", metavar=option.metavar, help=text)
        case _:
            made.add_argument(flag, choices=option.choices or None, metavar=option.metavar or None, help=text)


class _Words(argparse.Action):
    """Splits words at commas: ``--select a,b --select c`` gives the list a, b, c."""

    def __call__(  # signature of argparse
        self,
        parser: object,  # noqa: ARG002
        namespace: argparse.Namespace,
        values: Any,
        option_string: str | None = None,  # noqa: ARG002
    ) -> None:
        words = [word.strip() for word in str(values).split(",") if word.strip()]
        setattr(namespace, self.dest, (*getattr(namespace, self.dest, ()), *words))
