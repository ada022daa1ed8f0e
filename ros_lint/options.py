"""The one table of options. Command line, configuration file, error messages, JSON schema and docs are made of it."""

from __future__ import annotations

from typing import Any, Literal, NamedTuple

Type = Literal["flag", "word", "words", "number", "path", "paths", "table"]
SEVERITIES = ("error", "warning", "info")
MOST = 1_000_000
"""The largest number that an option takes."""
FORMATS = ("text", "concise", "json", "sarif", "github", "gitlab")


class Option(NamedTuple):
    """An option and where it may stand. ``table`` maps a pattern or rule to words, and stands in files only."""

    name: str
    type: Type
    default: Any
    help: str
    choices: tuple[str, ...] = ()
    metavar: str = ""
    on_command_line: bool = True
    in_file: bool = True
    environment: str = ""
    """The variable that is read when neither says anything."""
    loads_code: bool = False
    """Whether it loads code. A configuration file that has it gets a warning, because the file can be part of what is checked."""


OPTIONS: tuple[Option, ...] = (
    Option(
        "distro",
        "word",
        "",
        "ROS distribution to check for; without one, the newest long-term release known",
        metavar="NAME",
        environment="ROS_DISTRO",
    ),
    Option(
        "underlay",
        "paths",
        (),
        "install prefix that the workspace is built on; topmost first; may be repeated",
        metavar="PREFIX",
        environment="AMENT_PREFIX_PATH",
    ),
    Option("select", "words", ("default",), "rules to run: names, codes, beginnings of codes, default, all", metavar="RULES"),
    Option("extend-select", "words", (), "rules to run besides the selected ones", metavar="RULES"),
    Option("ignore", "words", (), "rules not to run", metavar="RULES"),
    Option("pedantic", "flag", False, "run every rule, and show what is less than certain"),
    Option(
        "fail-on",
        "word",
        "warning",
        "least severity of a finding that makes the exit code 1",
        choices=(*SEVERITIES, "never"),
    ),
    Option("exclude", "words", (), "folders or files not to look at, as patterns like build_* or src/vendor", metavar="PATTERNS"),
    Option(
        "severity",
        "table",
        {},
        "severity by rule: error, warning, info or off",
        choices=(*SEVERITIES, "off"),
        on_command_line=False,
    ),
    Option("per-path-ignores", "table", {}, "rules to ignore for files that match a pattern", on_command_line=False),
    Option("baseline", "path", "", "file of known findings, which are not shown", metavar="FILE"),
    Option(
        "plugins",
        "flag",
        False,
        "load rules of other installed distributions (entry points ros_lint.rules)",
        in_file=False,
        loads_code=True,
    ),
    Option(
        "jobs",
        "number",
        0,
        "processes to read files with, at most the number of cores; 0 decides by the size of the workspace",
        metavar="N",
    ),
    Option("cache", "flag", True, "keep what was read in the user's cache folder"),
    Option("format", "word", "text", "how to write the findings", choices=FORMATS, in_file=False),
    Option("output", "path", "", "write the findings to a file instead of standard output", metavar="FILE", in_file=False),
    Option("color", "word", "auto", "whether to colour the text", choices=("auto", "always", "never"), in_file=False),
    Option("write-baseline", "flag", False, "write what is found to the file of known findings, and stop", in_file=False),
    Option("fix", "flag", False, "mend what can be mended safely", in_file=False),
    Option("unsafe-fixes", "flag", False, "with --fix or --diff, also mend what may change behaviour", in_file=False),
    Option("diff", "flag", False, "show what --fix would change, and change nothing", in_file=False),
    Option("config", "path", "", "configuration file to use instead of the nearest one", metavar="FILE", in_file=False),
    Option("isolated", "flag", False, "use no configuration file and no environment variable", in_file=False),
    Option("show-settings", "flag", False, "print every setting and where it comes from, and stop", in_file=False),
    Option("progress", "flag", True, "show progress on a terminal", in_file=False),
)
COMMANDS = {
    "check": "look for what is wrong (the default)",
    "order": "print the packages in build order",
    "why": "say how one package comes to need another",
    "graph": "print the dependency graph",
    "explain-package": "say what a package declares, uses, provides and installs",
    "launch": "say what a launch file would start, without starting it",
    "overlay": "say which layer each package name resolves to",
    "rules": "list the rules",
    "rule": "explain a rule",
    "index": "rebuild or extend what is known of the released world",
    "schema": "print the JSON schema of the configuration file",
    "completion": "print the completion script for a shell",
}

BY_NAME = {option.name: option for option in OPTIONS}


def schema() -> dict[str, Any]:
    """Return the JSON schema of ``ros-lint.toml`` (the table ``[tool.ros-lint]`` of a pyproject.toml has the same shape)."""
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "ros-lint settings",
        "type": "object",
        "additionalProperties": False,
        "properties": {option.name: _property(option) for option in OPTIONS if option.in_file},
    }


def _property(option: Option) -> dict[str, Any]:
    word: dict[str, Any] = {"type": "string"}
    if option.choices:
        word["enum"] = list(option.choices)
    words = {"type": "array", "items": {"type": "string"}}
    shapes: dict[Type, dict[str, Any]] = {
        "flag": {"type": "boolean"},
        "word": word,
        "words": words,
        "number": {"type": "integer", "minimum": 0, "maximum": MOST},
        "path": {"type": "string"},
        "paths": words,
        "table": {"type": "object", "additionalProperties": word if option.choices else words},
    }
    result = {"description": option.help, **shapes[option.type]}
    if option.type != "table" and option.default != "":
        result["default"] = list(option.default) if isinstance(option.default, tuple) else option.default
    return result
