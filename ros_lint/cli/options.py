"""The table of all options, from which the command line, the settings, the JSON schema and the docs are generated."""

from __future__ import annotations

from typing import Any, Literal, NamedTuple

from ros_lint.reporters import FORMATS

Type = Literal["flag", "word", "words", "number", "path", "paths", "table"]
SEVERITIES = ("error", "warning", "info")
MOST = 1_000_000
"""The largest number that an option accepts."""


class CliOption(NamedTuple):
    """An option of the command line, a setting in configuration files, or both.

    The value of the types ``words`` and ``paths`` is a tuple. The value of the type ``table`` maps patterns or rules to
    words; such an option exists only in configuration files.
    """

    name: str
    type: Type
    default: Any
    help: str
    choices: tuple[str, ...] = ()
    metavar: str = ""
    on_command_line: bool = True
    in_file: bool = True
    environment: str = ""
    """Environment variable that is read if neither the command line nor the configuration file sets the option; "" if none."""
    short: str = ""
    """Short form of the flag, such as "-q"; "" if there is none."""
    single: bool = False
    """True if a configuration file may set an option of the type ``words`` to a string, which is a single word."""
    several: bool = False
    """True if the command-line option takes several arguments, as ``--packages-select a b`` of colcon does."""
    loads_code: bool = False
    """True if the option makes ros-lint load code.

    Configuration files cannot set it, because they may be in an untrusted workspace.
    """


OPTIONS: tuple[CliOption, ...] = (
    CliOption(
        "distro",
        "words",
        (),
        "ROS distribution to check for, or several, such as humble,jazzy; if unset, the newest LTS release",
        metavar="NAMES",
        environment="ROS_DISTRO",
        single=True,
    ),
    CliOption(
        "underlay",
        "paths",
        (),
        "install prefix of an underlay, such as /opt/ros/jazzy; may be repeated, topmost first",
        metavar="PREFIX",
        environment="AMENT_PREFIX_PATH",
    ),
    CliOption("select", "words", ("default",), "rules to run: names, codes, code prefixes, default, all", metavar="RULES"),
    CliOption("extend-select", "words", (), "additional rules to run", metavar="RULES"),
    CliOption("ignore", "words", (), "rules not to run", metavar="RULES"),
    CliOption("pedantic", "flag", False, "run every rule and show findings of lower confidence"),
    CliOption(
        "fail-on",
        "word",
        "warning",
        "lowest severity that makes the exit code 1",
        choices=(*SEVERITIES, "never"),
    ),
    CliOption("min-severity", "word", "info", "lowest severity of findings to show", choices=SEVERITIES),
    CliOption("exclude", "words", (), "patterns of files or folders not to read, such as build_*", metavar="PATTERNS"),
    CliOption(
        "context",
        "flag",
        True,
        "also read the packages around the requested ones, without reporting their findings",
        in_file=False,
    ),
    *(
        CliOption(f"packages-{name}", "words", (), text, metavar=metavar, in_file=False, several=True)
        for name, metavar, text in (
            ("select", "PKG_NAME", "report only these packages"),
            ("up-to", "PKG_NAME", "report only these packages and their direct and indirect dependencies"),
            ("above", "PKG_NAME", "report only these packages and the packages that depend on them, directly or indirectly"),
            ("select-regex", "PATTERN", "report only packages whose names begin with a match of a regular expression"),
            ("skip", "PKG_NAME", "do not report these packages"),
        )
    ),
    CliOption(
        "severity",
        "table",
        {},
        "severity for each rule: error, warning, info or off",
        choices=(*SEVERITIES, "off"),
        on_command_line=False,
    ),
    CliOption("per-path-ignores", "table", {}, "rules to ignore in files that match a pattern", on_command_line=False),
    CliOption("baseline", "path", "", "file of known findings, which are hidden", metavar="FILE"),
    CliOption(
        "since",
        "word",
        "",
        "show only findings that are new since the commit from which HEAD and a git revision diverged",
        metavar="REF",
        in_file=False,
    ),
    CliOption(
        "plugins",
        "flag",
        False,
        "also load rules from installed Python packages (entry point group ros_lint.rules)",
        in_file=False,
        loads_code=True,
    ),
    CliOption(
        "jobs", "number", 0, "processes that read files and run rules, at most one per core; 0: by workspace size", metavar="N"
    ),
    CliOption("cache", "flag", True, "cache results in the user's cache folder"),
    CliOption("format", "word", "text", "output format", choices=FORMATS, in_file=False),
    CliOption(
        "output",
        "paths",
        (),
        "write the findings to a file instead of standard output; FORMAT:FILE writes a further format; may be repeated",
        metavar="FILE",
        in_file=False,
    ),
    CliOption("rule-url", "word", "", "URL of the page of a rule, for links; {rule} is replaced by its name", metavar="URL"),
    CliOption("color", "word", "auto", "when to colour the text", choices=("auto", "always", "never"), in_file=False),
    CliOption("write-baseline", "flag", False, "write all findings to the baseline file and exit", in_file=False),
    CliOption("fix", "flag", False, "apply safe fixes", in_file=False),
    CliOption("unsafe-fixes", "flag", False, "with --fix or --diff, include fixes that may change behaviour", in_file=False),
    CliOption("fix-only", "words", (), "with --fix or --diff, apply only fixes of these rules", metavar="RULES", in_file=False),
    CliOption("show-fixes", "flag", False, "with --fix, list the applied fixes", in_file=False),
    CliOption("diff", "flag", False, "show what --fix would change, without changing files", in_file=False),
    CliOption("watch", "flag", False, "check again whenever a file changes, until Ctrl+C", in_file=False),
    CliOption(
        "stdin-filename",
        "word",
        "",
        "read the contents of this file from standard input, and report only the findings in it",
        metavar="FILE",
        in_file=False,
    ),
    CliOption("config", "path", "", "configuration file to use instead of the nearest one", metavar="FILE", in_file=False),
    CliOption("isolated", "flag", False, "ignore configuration files and environment variables", in_file=False),
    CliOption("show-settings", "flag", False, "print every setting with its origin and exit", in_file=False),
    CliOption("statistics", "flag", False, "print the number of findings of each rule instead of the findings", in_file=False),
    CliOption("quiet", "flag", False, "print findings without a summary", in_file=False, short="-q"),
    CliOption("progress", "flag", True, "show progress on a terminal", in_file=False),
)
COMMANDS = {
    "check": "report problems (the default command)",
    "order": "print the packages in build order",
    "why": "show how one package depends on another",
    "graph": "print the dependency graph",
    "explain-package": "show what a package declares, uses, provides and installs",
    "launch": "show what a launch file would start, without starting it",
    "lsp": "run the language server for editors",
    "overlay": "show packages that exist in several layers, and which layer wins",
    "rules": "list the rules",
    "rule": "explain a rule",
    "new-rule": "write a plugin with a new rule, its cases and its tests into a new folder",
    "index": "rebuild or extend the index of released packages",
    "cache": "show or remove cached results",
    "schema": "print the JSON schema of the configuration file",
    "completion": "print the completion script for a shell",
}

BY_NAME = {option.name: option for option in OPTIONS}


def schema() -> dict[str, Any]:
    """Return the JSON schema of ``ros-lint.toml`` and of the table ``[tool.ros-lint]`` in pyproject.toml."""
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "ros-lint settings",
        "type": "object",
        "additionalProperties": False,
        "properties": {option.name: _property(option) for option in OPTIONS if option.in_file},
    }


def _property(option: CliOption) -> dict[str, Any]:
    word: dict[str, Any] = {"type": "string"}
    if option.choices:
        word["enum"] = list(option.choices)
    words = {"type": "array", "items": {"type": "string"}}
    shapes: dict[Type, dict[str, Any]] = {
        "flag": {"type": "boolean"},
        "word": word,
        "words": {**words, "type": ["string", "array"]} if option.single else words,
        "number": {"type": "integer", "minimum": 0, "maximum": MOST},
        "path": {"type": "string"},
        "paths": words,
        "table": {"type": "object", "additionalProperties": word if option.choices else words},
    }
    result = {"description": option.help, **shapes[option.type]}
    if option.type != "table" and option.default != "":
        result["default"] = list(option.default) if isinstance(option.default, tuple) else option.default
    return result
