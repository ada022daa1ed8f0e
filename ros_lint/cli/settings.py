"""Read the settings and record their origins. Precedence: command line, configuration file, environment, defaults.

The configuration file is the nearest ``ros-lint.toml``, or ``pyproject.toml`` with a table ``[tool.ros-lint]``, in the
workspace folder or a folder above it, up to the root of its repository.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Mapping
from typing import Any, NamedTuple

from ros_lint.base import files
from ros_lint.base.paths import is_below, upwards
from ros_lint.base.suggestions import did_you_mean, similar_names
from ros_lint.cli.context import workspace_around
from ros_lint.cli.options import BY_NAME, MOST, OPTIONS, CliOption
from ros_lint.errors import UserError

_MOST_BYTES = 256 << 10
"""Size limit of a configuration file, much larger than any real one."""

_MOST_SEARCHED = 16 << 20
"""Number of bytes of a pyproject.toml in which the table ``[tool.ros-lint]`` is searched for."""

_LONG_KEY = r"""(?:\.[ \t]*(?:[\w-]+|"(?:[^"\\\n]|\\.){0,50}"|'[^'\n]{0,50}')[ \t]*){50}"""
"""Pattern of the rest of a TOML key with more than 50 parts, after its first part.

Such a key is rejected, because tomllib takes time proportional to the square of the number of parts.
"""


class ConfigError(UserError):
    """A setting is invalid. The message names its place and a remedy."""


class Setting(NamedTuple):
    """The value of an option and the origin of the value, such as "--distro" or the path of the configuration file."""

    value: Any
    origin: str


class Settings:
    """The values of all options with their origins: ``settings["fail-on"]``, ``settings.origin("fail-on")``.

    ``warnings`` are messages about a configuration file that is not used, and about settings that have no effect. ``file`` is the
    origin of values in the configuration file, ``folder`` the absolute folder of the file, and ``text`` its text.
    """

    def __init__(
        self, values: Mapping[str, Setting], warnings: tuple[str, ...] = (), file: str = "", folder: str = "", text: str = ""
    ) -> None:
        self._values = values
        self._file = file
        self._folder = folder
        self._text = text
        self.warnings = warnings

    def __getitem__(self, name: str) -> Any:
        return self._values[name].value

    def origin(self, name: str) -> str:
        """Return the origin of an option's value: a command-line option, the path of a file, a variable, or "default"."""
        return self._values[name].origin

    def place(self, name: str, value: str) -> str:
        """Return where ``value`` of an option was set: the origin of the option, for a file with the line of the value."""
        origin = self.origin(name)
        key = _key(self._text, name)
        if key is None or origin != self._file:
            return origin
        word = re.compile(rf"(?<![\w-])[\"']?{re.escape(value)}[\"']?(?![\w-])").search(self._text, key.end())
        return f"{origin}:{self._text.count(chr(10), 0, word.start() if word else key.end()) + 1}"

    def folder(self, name: str) -> str:
        """Return the absolute folder of the configuration file that sets an option, "" if no file sets it."""
        return self._folder if self.origin(name) == self._file else ""

    def show(self) -> str:
        """Return the output of ``--show-settings``: one line for each option with its value and origin."""
        width = max(len(name) for name in self._values)
        return "".join(f"{name:{width}} = {toml(setting.value)}  # {setting.origin}\n" for name, setting in self._values.items())


def settle(arguments: Mapping[str, Any], start: str, environment: Mapping[str, str], display: str = "") -> Settings:
    """Return the settings of a run. Raises ConfigError.

    ``arguments`` has the values on the command line by option name. ``start`` is the absolute path of the workspace; the
    configuration file is searched for in this folder and above. Of ``environment`` only the variables in the table of
    options are read. In origins, the path of the file is relative to the folder ``display``.
    """
    isolated = bool(arguments.get("isolated"))
    path, unused = ("", "") if isolated else (str(arguments["config"]), "") if arguments.get("config") else find(start)
    if arguments.get("config") and not os.path.isfile(path):
        raise ConfigError(f"{path}: no such configuration file")
    from_file, warnings, text = read(path) if path else ({}, (unused,) if unused else (), "")
    shown = os.path.relpath(path, display) if path and display else path
    values: dict[str, Setting] = {}
    for option in OPTIONS:
        if option.name in arguments:
            values[option.name] = Setting(arguments[option.name], f"--{option.name}")
        elif option.name in from_file:
            values[option.name] = Setting(_relative(option, from_file[option.name], path), shown)
        elif not isolated and option.environment and (variable := environment.get(option.environment)):
            values[option.name] = Setting(_from_environment(option, variable), option.environment)
        else:
            values[option.name] = Setting(option.default, "default")
    return Settings(values, warnings, shown, os.path.dirname(os.path.abspath(path)) if path else "", text)


CONFIGURATION_FILES = ("ros-lint.toml", "pyproject.toml")
"""Names of files with settings."""


def find(start: str) -> tuple[str, str]:
    """Return the path of the nearest configuration file in ``start`` or above it, and a warning; "" for each that does not exist.

    The search ends at the workspace or repository that contains ``start``, as that of git and mypy. A file above it is not used,
    nor is a file of another user, because anyone may write into a folder such as /tmp: the warning names it.
    """
    folder = os.path.abspath(start)
    if not os.path.isdir(folder):
        folder = os.path.dirname(folder)
    around = workspace_around(folder)
    for place in upwards(folder):
        path = _configuration_in(place)
        if not path:
            continue
        if is_below(place, around or folder) or (not around and _is_trusted(path, folder)):
            return path, ""
        why = f"it is above {around}" if around else "it belongs to another user"
        return "", f"{path}: not used, because {why}; use --config to use it"
    return "", ""


def _configuration_in(folder: str) -> str:
    ros_lint_toml = os.path.join(folder, "ros-lint.toml")
    if os.path.isfile(ros_lint_toml):
        return ros_lint_toml
    pyproject = os.path.join(folder, "pyproject.toml")
    return pyproject if os.path.isfile(pyproject) and _has_table(pyproject) else ""


def _is_trusted(path: str, folder: str) -> bool:
    """Return whether a file belongs to the current user, to the owner of the checked folder or to root."""
    owners = {os.lstat(path).st_uid, os.stat(path).st_uid}
    return not hasattr(os, "geteuid") or owners <= {os.geteuid(), os.stat(folder).st_uid, 0}


def read(path: str) -> tuple[dict[str, Any], tuple[str, ...], str]:
    """Return the validated settings in the configuration file ``path``, warnings, and the text of the file.

    Raises ConfigError.
    """
    try:
        data = files.read(path, _MOST_BYTES)
    except OSError as error:
        raise ConfigError(f"{path}: {error.strerror or error}") from error
    table: Any = _load_toml(path, data)
    for name in ("tool", "ros-lint") if os.path.basename(path) == "pyproject.toml" else ():
        table = table.get(name, {})
        if not isinstance(table, dict):
            raise ConfigError(f"{path}: {'tool.ros-lint' if name == 'ros-lint' else name} is not a table")
    text = data.decode("utf-8", "replace")
    without_effect = [name for name in table if name in BY_NAME and BY_NAME[name].loads_code]
    settings = {name: _checked(path, text, name, value) for name, value in table.items() if name not in without_effect}
    return settings, tuple([_without_effect(path, text, name) for name in without_effect]), text


def _without_effect(path: str, text: str, name: str) -> str:
    return f"{_place(path, text, name)}: '{name}' has no effect in a configuration file, because it loads code; use --{name}"


def _has_table(path: str) -> bool:
    """Return whether a pyproject.toml has a table [tool.ros-lint]. It is not parsed, because it may be invalid or large."""
    try:
        with open(path, "rb") as file:
            head = file.read(_MOST_SEARCHED)
    except OSError:
        return False
    return re.search(rb"^[ \t]*\[[ \t]*tool[ \t]*\.[ \t]*['\"]?ros-lint", head, re.MULTILINE) is not None


def _load_toml(path: str, data: bytes) -> dict[str, Any]:
    if sys.version_info >= (3, 11):
        import tomllib  # noqa: PLC0415
    else:
        import tomli as tomllib  # noqa: PLC0415
    try:
        text = data.decode("utf-8")
        if long := re.search(_LONG_KEY, text):
            raise ConfigError(f"{path}:{text.count(chr(10), 0, long.start()) + 1}: a key has more than 50 parts")
        return tomllib.loads(text)
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ConfigError(f"{path}: {error}") from error
    except ValueError as error:  # from int(), which accepts up to 4,300 digits
        raise ConfigError(f"{path}: a number has too many digits") from error
    except RecursionError as error:
        raise ConfigError(f"{path}: nested too deep") from error


def _checked(path: str, text: str, name: str, value: Any) -> Any:
    option = BY_NAME.get(name)
    if option is None or not option.in_file:
        available = [option.name for option in OPTIONS if option.in_file]
        if option is not None:
            raise ConfigError(f"{_place(path, text, name)}: '{name}' is a command-line option, not a setting")
        hint = did_you_mean(similar_names(name.replace("_", "-"), available)) or f"; available: {', '.join(available)}"
        raise ConfigError(f"{_place(path, text, name)}: unknown setting '{name}'{hint}")
    if error := _error_in(option, value):
        raise ConfigError(f"{_place(path, text, name)}: '{name}' {error}")
    if option.type in ("words", "paths"):
        return (value,) if isinstance(value, str) else tuple(value)
    return value


def _error_in(option: CliOption, value: Any) -> str:
    match option.type:
        case "flag":
            return "" if isinstance(value, bool) else "must be true or false"
        case "number":
            fits = isinstance(value, int) and not isinstance(value, bool) and 0 <= value <= MOST
            return "" if fits else f"must be a whole number from 0 to {MOST}"
        case "word" | "path":
            return _word_error_in(option, value)
        case "words" | "paths":
            if option.single:
                return "" if isinstance(value, str) or _is_words(value) else "must be a string or a list of strings"
            return "" if _is_words(value) else "must be a list of strings"
        case "table":
            if not isinstance(value, dict):
                return "must be a table"
            if option.choices:
                errors = [f"of '{key}' {why}" for key, entry in value.items() if (why := _word_error_in(option, entry))]
                return errors[0] if errors else ""
            return "" if all(_is_words(entry) for entry in value.values()) else "must map patterns to lists of rules"


def _word_error_in(option: CliOption, value: Any) -> str:
    if not isinstance(value, str):
        return "must be a string"
    if option.choices and value not in option.choices:
        hint = did_you_mean(similar_names(value, option.choices))
        return f"must be one of {', '.join(option.choices)}, not {value!r}{hint}"
    return ""


def _is_words(value: Any) -> bool:
    return isinstance(value, list) and all(isinstance(word, str) for word in value)


def _place(path: str, text: str, name: str) -> str:
    key = _key(text, name)
    return f"{path}:{text.count(chr(10), 0, key.start()) + 1}" if key else path


def _key(text: str, name: str) -> re.Match[str] | None:
    """Return the match of a key or table in a configuration file with the given text, None if there is none."""
    pattern = rf"^[ \t]*[\"']?{re.escape(name)}[\"']?[ \t]*(?:=|\.)|^[ \t]*\[[^\]\n]*\b{re.escape(name)}"
    return re.search(pattern, text, re.MULTILINE)


def _relative(option: CliOption, value: Any, path: str) -> Any:
    """Return a value in the configuration file ``path``. A relative path becomes relative to the folder of the file."""
    if option.type == "paths":
        return tuple(os.path.join(os.path.dirname(path), entry) for entry in value)
    return os.path.join(os.path.dirname(path), value) if option.type == "path" else value


def _from_environment(option: CliOption, value: str) -> Any:
    if option.type == "paths":
        return tuple(entry for entry in value.split(os.pathsep) if entry)
    return (value,) if option.type == "words" else value


def toml(value: Any) -> str:
    """Return the value of an option in TOML syntax, e.g. "[]" or "true"."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, tuple | list):
        return f"[{', '.join(toml(entry) for entry in value)}]"
    if isinstance(value, dict):
        return f"{{{', '.join(f'{toml(key)} = {toml(entry)}' for key, entry in value.items())}}}"
    if isinstance(value, int):
        return str(value)
    import json  # noqa: PLC0415

    return json.dumps(value, ensure_ascii=False)
