"""The parser of the command line. Its options come from the table in :mod:`ros_lint.cli.options`."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Sequence
from typing import Any, NoReturn

from ros_lint.base.suggestions import did_you_mean, similar_names
from ros_lint.cli.options import BY_NAME, COMMANDS, MOST, OPTIONS, CliOption

_ONE_DISTRO = "ROS distribution to answer for; if unset, the first one of the settings, or else the newest LTS release"
_COMMON_OPTIONS = (
    BY_NAME["distro"]._replace(help=_ONE_DISTRO, metavar="NAME"),
    *(BY_NAME[name] for name in ("underlay", "config", "isolated", "jobs", "cache", "exclude", "progress")),
)
"""The options of the commands that work with one distribution of ROS, such as ``graph``."""
_LSP_OPTIONS = (
    "distro", "underlay", "select", "extend-select", "ignore", "pedantic", "min-severity", "exclude", "plugins", "jobs", "cache",
    "config", "isolated",
)  # fmt: skip
"""The names of the options of ``ros-lint lsp``, the language server."""
_WORKSPACE_HELP = "workspace (default: the workspace that contains the current folder)"
SHELLS = ("bash", "zsh", "fish")
"""The shells for which ``ros-lint completion`` prints a script."""
_SIMILAR = 0.75
"""Minimum similarity (0 to 1) of an option to suggest it for an unknown one: ``--exit-zero`` does not suggest ``--distro``."""
_FOREIGN = {
    "--base-paths": "give the paths as arguments",
    "--disable": "use --ignore",
    "--enable": "use --extend-select",
    "--exit-zero": "use --fail-on never",
    "--no-color": "use --color never",
    "--output-format": "use --format",
    "--output-file": "use --output",
    "--skip-checks": "use --ignore",
    "--verbose": "use --pedantic for all findings, or --format json for all details",
}
"""Options of other linters and of colcon, each with what to use instead."""
_EPILOG = """\
commands (see also ros-lint COMMAND --help):
{}

exit codes: 0 no findings at or above --fail-on, 1 such findings, 2 the run failed
"""


class _ArgumentParser(argparse.ArgumentParser):
    def reject(self, unknown: Sequence[str]) -> NoReturn:
        """Print an error message about unknown arguments and exit."""
        options = [text for action in self._actions for text in action.option_strings]
        name = unknown[0].partition("=")[0]
        foreign = _FOREIGN.get(name) if self.prog == "ros-lint" else None
        hint = f"; {foreign}" if foreign else did_you_mean(similar_names(name, options, least=_SIMILAR))
        self.error(f"unrecognized arguments: {' '.join(unknown)}{hint}")

    def error(self, message: str) -> NoReturn:
        print(f"ros-lint: {message} (see {self.prog} --help)", file=sys.stderr)
        raise SystemExit(2)


class _Formatter(argparse.RawDescriptionHelpFormatter):
    """A formatter of help texts that does not import ``shutil``, because argparse creates a formatter for each option."""

    def __init__(self, prog: str) -> None:
        super().__init__(prog, width=_columns() - 2)


def _columns() -> int:
    """Return the width of the terminal in columns, as shutil.get_terminal_size() does, but at least 30."""
    columns = os.environ.get("COLUMNS", "")
    if columns.isdecimal() and int(columns):
        return max(int(columns), 30)
    try:
        return max(os.get_terminal_size(sys.__stdout__.fileno()).columns, 30) if sys.__stdout__ else 80
    except (OSError, ValueError):
        return 80


def parse(arguments: Sequence[str]) -> tuple[str, dict[str, Any]]:
    """Return the name of the command and the given options by name. Positional arguments, such as ``paths``, are included.

    Raises SystemExit for ``--help`` and for invalid arguments, as argparse does.
    """
    if arguments and arguments[0] in COMMANDS:
        command, rest = arguments[0], list(arguments[1:])
    else:
        command, rest = "check", list(arguments)
    parser = create_parser(command, top=not arguments or arguments[0] != command)
    # Options may be placed between paths, which argparse does not support for commands with actions.
    has_actions = command in ("index", "cache")
    namespace, unknown = parser.parse_known_args(rest) if has_actions else parser.parse_known_intermixed_args(rest)
    if unknown:
        parser.reject(unknown)
    return command, {name.replace("_", "-"): value for name, value in vars(namespace).items()}


def create_parser(command: str, *, top: bool = False) -> _ArgumentParser:
    """Return the parser of a command. If ``top`` is True, its help text describes ros-lint and lists all commands."""
    commands = "\n".join(f"  {name:17}{summary}" for name, summary in COMMANDS.items())
    parser = _ArgumentParser(
        "ros-lint" if top else f"ros-lint {command}",
        description="Check ROS 2 workspaces without building them."
        if top
        else f"{COMMANDS[command][:1].upper()}{COMMANDS[command][1:]}.",
        epilog=_EPILOG.format(commands) if top else None,
        formatter_class=_Formatter,
        allow_abbrev=False,
        argument_default=argparse.SUPPRESS,
    )
    parser.add_argument("--version", action="store_true", help="print the version") if top else None
    _ADDERS[command](parser)
    return parser


def _add_check(parser: argparse.ArgumentParser) -> None:
    _add_paths(parser)
    for option in OPTIONS:
        if option.on_command_line:
            _add_option(parser, option)


def _add_workspace(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("-C", "--workspace", dest="paths", action="append", metavar="PATH", help=_WORKSPACE_HELP)
    for option in _COMMON_OPTIONS:
        _add_option(parser, option)


def _add_order(parser: argparse.ArgumentParser) -> None:
    _add_answer_format(parser)
    _add_paths_and_common(parser)


def _add_answer_format(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--format", choices=("text", "json"), default="text", help="output format")


def _add_paths_and_common(parser: argparse.ArgumentParser) -> None:
    _add_paths(parser)
    for option in _COMMON_OPTIONS:
        _add_option(parser, option)


def _add_graph(parser: argparse.ArgumentParser) -> None:
    _add_paths_and_common(parser)
    parser.add_argument("--format", choices=("dot", "mermaid", "json", "html"), default="dot", help="output format")
    parser.add_argument("--focus", metavar="PKG", help="print only a package, its dependencies and its dependents")
    parser.add_argument("--depth", type=int, metavar="N", help="with --focus, only packages at most N dependencies away")
    parser.add_argument("--external", action="store_true", help="also print packages and rosdep keys outside of the workspace")
    parser.add_argument("--edges", action=_Words, metavar="KINDS", help="kinds of dependencies to print: build, run, test, group")
    parser.add_argument("--reduce", action="store_true", help="leave out dependencies that longer paths imply")
    parser.add_argument("--metrics", action="store_true", help="print figures per package instead: degrees, depth, reach")


def _add_why(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("package", help="the package with the dependency")
    parser.add_argument("dependency", help="the package or rosdep key it depends on")
    parser.add_argument("--explain-silence", action="store_true", help="explain why the dependency rules report nothing")
    _add_answer_format(parser)
    _add_workspace(parser)


def _add_explain_package(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("package", help="the package to explain")
    _add_answer_format(parser)
    _add_workspace(parser)


def _add_launch(parser: argparse.ArgumentParser) -> None:
    parser.usage = (
        "%(prog)s [options] FILE [name:=value ...]\n       %(prog)s [options] PACKAGE FILE [name:=value ...]\n"
        "       %(prog)s [options] PACKAGE"
    )
    text = "a launch file; a package and the name of a launch file that it installs; or a package, to list its launch files"
    parser.add_argument("words", nargs="+", metavar="FILE", help=text)
    parser.add_argument("--format", choices=("tree", "json", "mermaid", "html"), default="tree", help="output format")
    parser.add_argument("--show-args", action="store_true", help="print the launch arguments instead, with their descriptions")
    parser.add_argument("--depth", type=_number, metavar="N", help="leave out what is below more than N includes")
    parser.add_argument("--node", metavar="NAME", help="show only nodes and components with this name, executable or class")
    _add_workspace(parser)


def _add_lsp(parser: argparse.ArgumentParser) -> None:
    for name in _LSP_OPTIONS:
        _add_option(parser, BY_NAME[name])


def _add_index(parser: argparse.ArgumentParser) -> None:
    actions = parser.add_subparsers(dest="action", required=True, metavar="ACTION")
    refresh = actions.add_parser("refresh", help="rebuild the data of distributions from rosdistro's index", allow_abbrev=False)
    refresh.add_argument("--from", dest="source", required=True, metavar="INDEX", help="path or URL of rosdistro's index-v4.yaml")
    distro_help = "distribution to rebuild (default: all active ones); may be repeated"
    refresh.add_argument("--distro", action="append", default=[], metavar="NAME", help=distro_help)
    refresh.add_argument(
        "--rosdep", action="append", default=[], metavar="YAML", help="path or URL of rosdep rules; may be repeated"
    )
    refresh.add_argument("--to", default="", metavar="FOLDER", help="output folder (default: the user's data folder)")
    scan = actions.add_parser("scan", help="generate the data from install prefixes", allow_abbrev=False)
    scan.add_argument("prefixes", nargs="+", metavar="PREFIX", help="install prefix, such as /opt/ros/jazzy")
    scan.add_argument("--distro", default="local", metavar="NAME", help="name of the generated distribution (default: local)")
    scan.add_argument("--to", default="", metavar="FOLDER", help="output folder (default: standard output)")


def _add_cache(parser: argparse.ArgumentParser) -> None:
    actions = parser.add_subparsers(dest="action", required=True, metavar="ACTION")
    info = actions.add_parser("info", help="list the workspaces with cached results", allow_abbrev=False)
    info.add_argument("--format", choices=("text", "json"), default="text", help="output format")
    clean = actions.add_parser("clean", help="remove cached results", allow_abbrev=False)
    clean.add_argument("paths", nargs="*", metavar="PATH", help="workspaces whose results are removed (default: all)")


def _add_rules(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--format", choices=("text", "json"), default="text", help="output format")
    _add_option(parser, BY_NAME["plugins"])


def _add_rule(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("rule", help="name or code of the rule")
    _add_rules(parser)


def _add_new_rule(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("name", metavar="NAME", help="name of the rule and of the folder, such as acme-old-name")
    parser.add_argument("--code", metavar="CODE", help="code of the rule (default: the first word of its name and 001: ACME001)")


def _add_completion(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("shell", choices=SHELLS, help="the shell")


_ADDERS: dict[str, Callable[[argparse.ArgumentParser], None]] = {
    "check": _add_check,
    "order": _add_order,
    "overlay": _add_order,
    "graph": _add_graph,
    "why": _add_why,
    "explain-package": _add_explain_package,
    "launch": _add_launch,
    "lsp": _add_lsp,
    "index": _add_index,
    "cache": _add_cache,
    "rules": _add_rules,
    "rule": _add_rule,
    "new-rule": _add_new_rule,
    "schema": lambda _: None,
    "completion": _add_completion,
}


def _add_paths(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("paths", nargs="*", default=["."], metavar="PATH", help="workspaces or packages (default: .)")


def _add_option(parser: argparse.ArgumentParser, option: CliOption) -> None:
    flag = f"--{option.name}"
    text = f"{option.help} (also ${option.environment})" if option.environment else option.help
    match option.type:
        case "flag":
            switch = argparse.BooleanOptionalAction if option.default else "store_true"
            parser.add_argument(*filter(None, (option.short, flag)), action=switch, help=text)
        case "number":
            parser.add_argument(flag, type=_number, metavar=option.metavar, help=text)
        case "words":
            several = "+" if option.several else None
            parser.add_argument(flag, action=_Words, nargs=several, metavar=option.metavar, help=text)
        case "paths":
            parser.add_argument(flag, action="append", metavar=option.metavar, help=text)
        case _:
            parser.add_argument(flag, choices=option.choices or None, metavar=option.metavar or None, help=text)


def _number(text: str) -> int:
    """Return the value of an option of the type "number". Raises ArgumentTypeError, as argparse requires, for other texts."""
    if text.isascii() and text.isdecimal() and len(text) <= len(str(MOST)) and int(text) <= MOST:
        return int(text)
    raise argparse.ArgumentTypeError(f"must be a whole number from 0 to {MOST}, not '{text}'")


class _Words(argparse.Action):
    """The argparse action of options with several values. It splits at commas: ``--select a,b --select c`` gives a, b, c.

    The values of an option that takes several arguments (``--packages-select a b``) are not split.
    """

    def __call__(  # signature of argparse
        self,
        parser: object,  # noqa: ARG002
        namespace: argparse.Namespace,
        values: Any,
        option_string: str | None = None,  # noqa: ARG002
    ) -> None:
        words = values if isinstance(values, list) else [word.strip() for word in str(values).split(",") if word.strip()]
        setattr(namespace, self.dest, (*getattr(namespace, self.dest, ()), *words))
