"""Write the man page, the completion scripts and the conda recipe: ``python packaging/generate.py``.

The man page and the scripts are made from the parsers of the command line, so they name all commands and options. The recipe
has the description, the dependencies and the commands of ``pyproject.toml``.
"""

from __future__ import annotations

import argparse
import re
from pathlib import Path
from typing import Any

import yaml

from ros_lint import __version__
from ros_lint.cli.completions import actions, script
from ros_lint.cli.options import COMMANDS

try:
    import tomllib
except ModuleNotFoundError:  # Python 3.10
    import tomli as tomllib

ROOT = Path(__file__).parent.parent
MAN_PAGE = Path("docs/ros-lint.1")
CONDA_RECIPE = Path("packaging/conda/recipe.yaml")
COMPLETIONS = {
    "bash": Path("packaging/completions/ros-lint.bash"),
    "zsh": Path("packaging/completions/_ros-lint"),
    "fish": Path("packaging/completions/ros-lint.fish"),
}


def main() -> None:
    """Write all files."""
    for path, text in files().items():
        (ROOT / path).write_text(text, "utf-8")


def files() -> dict[Path, str]:
    """Return the generated files by their path in the repository."""
    return {MAN_PAGE: _man_page(), CONDA_RECIPE: _conda_recipe(), **{path: script(shell) for shell, path in COMPLETIONS.items()}}


def _conda_recipe() -> str:
    """Return the recipe of a conda package for all platforms, in version 1 of the format."""
    pyproject = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
    project = pyproject["project"]
    python = f"python {project['requires-python']}"
    recipe: dict[str, Any] = {
        "package": {"name": project["name"], "version": __version__},
        "source": {"path": "../.."},
        "build": {
            "number": 0,
            "noarch": "python",
            "script": "${{ PYTHON }} -m pip install . --no-deps --no-build-isolation -vv",
            "python": {"entry_points": [f"{name} = {place}" for name, place in project["scripts"].items()]},
        },
        "requirements": {
            "host": [python, "pip", *map(_conda_dependency, pyproject["build-system"]["requires"])],
            "run": [python, *map(_conda_dependency, project["dependencies"])],
        },
        "tests": [
            {"python": {"imports": ["ros_lint", "ros_lint_rules"], "pip_check": True}},
            {"script": ["ros-lint --version"]},
        ],
        "about": {"summary": project["description"], "license": project["license"], "license_file": project["license-files"]},
    }
    return yaml.safe_dump(recipe, sort_keys=False, width=130)


def _conda_dependency(requirement: str) -> str:
    """Return a dependency as conda writes it: ``tomli>=2; python_version < '3.11'`` becomes ``tomli >=2``.

    The condition is left out, because a package for all platforms and versions of Python cannot have one.
    """
    name, relation = re.match(r"([\w.-]+)([^;]*)", requirement).groups()
    return f"{name} {relation.strip()}"


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
        entries = [_man_entry(action) for action in actions(command) if action.option_strings and action.dest != "help"]
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


if __name__ == "__main__":
    main()
