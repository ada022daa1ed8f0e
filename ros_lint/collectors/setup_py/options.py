"""The options of setup(), completed from ``setup.cfg`` and ``pyproject.toml`` as setuptools does."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import Any

from ros_lint.base.text import Span, Text
from ros_lint.collectors.pyproject import table, tables
from ros_lint.collectors.python.interpreter.values import Unknown, Value
from ros_lint.collectors.setup_py.interpreter.files import Files
from ros_lint.collectors.setup_py.interpreter.values import Word
from ros_lint.collectors.setup_py.setup_cfg import Line, Option, SetupCfg

_LISTS = frozenset({"packages", "py_modules", "scripts"})
_FINDS = {"find:": False, "find_namespace:": True}


def completed(given: Mapping[str, Value], files: Files, setup_cfg: SetupCfg | None, pyproject: Text | None) -> dict[str, Value]:
    """Return the options of setup() together with the options in setup.cfg and pyproject.toml.

    ``given`` are the options in setup.py. An option in setup.py overrides setup.cfg, and pyproject.toml overrides both.
    """
    options = dict(given)
    if setup_cfg is not None:
        options.update({key: value for key, value in _from_cfg(setup_cfg, files).items() if not options.get(key)})
    if pyproject is not None:
        options.update(_from_pyproject(pyproject, files))
    return options


def _from_cfg(cfg: SetupCfg, files: Files) -> dict[str, Value]:
    metadata, options = cfg.section("metadata"), cfg.section("options")
    found: dict[str, Value] = {}
    for key in ("name", "version"):
        if key in metadata:
            found[key] = _single(metadata[key])
    for key in _LISTS & options.keys():
        found[key] = _words(options[key])
    if "packages" in options and options["packages"].value.strip() in _FINDS:
        found["packages"] = _found(cfg, options["packages"].value.strip(), files)
    if "package_dir" in options:
        found["package_dir"] = _pairs(options["package_dir"].lines)
    groups = cfg.section("options.entry_points")
    if groups:
        found["entry_points"] = {group: list(map(_word, option.lines)) for group, option in groups.items()}
    data = cfg.section("options.data_files")
    if data:
        found["data_files"] = [
            (_at(folder, option.span), [_at(path, line.span) for line in option.lines for path in _globbed(line, files)])
            for folder, option in data.items()
        ]
    return found


def _at(text: str, span: Span) -> Word:
    return Word.at(text, span)


def _word(line: Line) -> Word:
    return _at(line.text, line.span)


def _single(option: Option) -> Value:
    if not option.lines:
        return ""
    line = option.lines[0]
    if line.text.startswith(("attr:", "file:")):
        return Unknown(f"{option.key} = {line.text} cannot be evaluated", None, line.span)
    return _word(line)


def _words(option: Option) -> list[Value]:
    """Return the elements of a list in setup.cfg: an element on each line, or elements separated by commas on one line."""
    if len(option.lines) == 1:
        line = option.lines[0]
        return [_at(part.strip(), line.span) for part in line.text.split(",") if part.strip()]
    return [_at(line.text.rstrip(","), line.span) for line in option.lines]


def _pairs(lines: Iterable[Line]) -> dict[str, Value]:
    pairs = (part.partition("=") for line in lines for part in line.text.split(","))
    return {key.strip(): value.strip() for key, sign, value in pairs if sign}


def _found(cfg: SetupCfg, how: str, files: Files) -> list[Value]:
    options = cfg.section("options.packages.find")
    span = next(option.span for option in cfg.options if option.section == "options" and option.key == "packages")
    where = options["where"].value if "where" in options else "."
    patterns = {key: [line.text for line in options[key].lines] for key in ("include", "exclude") if key in options}
    return [_at(name, span) for name in files.find(where, namespaces=_FINDS[how], **patterns)]


def _globbed(line: Line, files: Files) -> list[str]:
    return files.glob(line.text, recursive=True) if re.search(r"[*?\[]", line.text) else [line.text]


# --- pyproject.toml. tomllib reports no places, so the place of a value is its first occurrence in the text


def _from_pyproject(source: Text, files: Files) -> dict[str, Value]:
    content = tables(source)
    project, tool = table(content, "project"), table(content, "tool", "setuptools")
    found: dict[str, Value] = {key: _place(source, project[key]) for key in ("name", "version") if key in project}
    groups = dict(table(project, "entry-points"))
    groups.update({group: project[key] for key, group in _SCRIPTS.items() if key in project})
    if groups:
        found["entry_points"] = {
            group: [_place(source, f"{key} = {value}", key) for key, value in table(groups, group).items() if _is_text(value)]
            for group in groups
        }
    packages = tool.get("packages")
    if isinstance(packages, list):
        found["packages"] = [_place(source, name) for name in packages]
    elif isinstance(packages, dict) and isinstance(packages.get("find"), dict):
        found["packages"] = [_place(source, name, "packages") for name in _find_table(packages["find"], files)]
    for key in ("package-dir", "py-modules"):
        if key in tool:
            found[key.replace("-", "_")] = tool[key]
    if "data-files" in tool:
        found["data_files"] = [
            (_place(source, folder), [_place(source, path, one) for one in patterns if _is_text(one) for path in files.glob(one)])
            for folder, patterns in table(tool, "data-files").items()
            if isinstance(patterns, list)
        ]
    return found


_SCRIPTS = {"scripts": "console_scripts", "gui-scripts": "gui_scripts"}


def _find_table(find: Mapping[str, Any], files: Files) -> list[str]:
    return [
        name
        for where in find.get("where", ["."])
        for name in files.find(
            where,
            namespaces=find.get("namespaces", True),
            include=find.get("include", ["*"]),
            exclude=find.get("exclude", []),
        )
    ]


def _is_text(value: object) -> bool:
    return isinstance(value, str)


def _place(source: Text, value: Value, near: str = "") -> Value:
    if not isinstance(value, str):
        return value
    at = max(source.text.find(near or value), 0)
    return _at(value, source.span(at, at + len(near or value)))
