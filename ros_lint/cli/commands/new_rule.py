"""``ros-lint new-rule NAME``: write a plugin with one rule, its test cases and its tests into a new folder."""

from __future__ import annotations

import os
import re
import shlex
from collections.abc import Mapping
from string import Template
from typing import Any

from ros_lint import __version__
from ros_lint.analysis.finding import Severity
from ros_lint.analysis.rule import Rule
from ros_lint.cli.messages import show
from ros_lint.engine import registry
from ros_lint.engine.plugins import Plugin, problems
from ros_lint.errors import UserError

_TEMPLATES = os.path.join(os.path.dirname(os.path.dirname(__file__)), "templates", "new_rule")


class NewRuleError(UserError):
    """The name or code of the new rule is invalid, or its folder cannot be written."""


def run(options: Mapping[str, Any]) -> int:
    """Write the plugin, and print its folder and the command that tests it. Return the exit code: 0, or 2 after an error."""
    name = str(options["name"])
    try:
        code = str(options.get("code") or code_for(name))
        check(name, code)
        write(name, files(name, code))
    except UserError as error:
        show(str(error))
        return 2
    test = f".venv/bin/pip install -q {shlex.quote(_source())} -e '.[test]' && .venv/bin/python -m pytest"
    print(f"{name}: a plugin with the rule '{name}' ({code}); README.md explains its files. This command runs its tests:\n")
    print(f"  cd {name} && python3 -m venv .venv && {test}")
    return 0


def code_for(name: str) -> str:
    """Return the first rule code of a plugin: the letters of the first word of the rule's name, and 001.

    "acme-old-name" -> "ACME001".
    """
    return f"{re.sub('[^A-Z]', '', name.partition('-')[0].upper())}001"


def check(name: str, code: str) -> None:
    """Raise NewRuleError if the name or the code is invalid, reserved or taken, or if a Python package cannot have the name."""
    rule = Rule(name, code, "", Severity.WARNING, "1.0", "")
    for problem in problems(registry.load(), [Plugin(name, (rule,))]):
        raise NewRuleError(problem)
    owner = name.partition("-")[0]
    if owner in ("", name, "ros"):
        example = f"acme-{name.removeprefix('ros-')}"
        raise NewRuleError(
            f"new-rule: a later version of ros-lint may have a rule '{name}'; begin the name with a word of your own, such as "
            f"'{example}'"
        )


def files(name: str, code: str) -> dict[str, str]:
    """Return the texts of the plugin's files by their paths in its folder."""
    module = name.replace("-", "_")
    templates = {
        "pyproject.toml": "pyproject.toml.txt",
        "README.md": "README.md.txt",
        f"src/{module}/rule.py": "rule.py.txt",
        f"tests/{name}.md": "cases.md.txt",
        "tests/test_rules.py": "test_rules.py.txt",
    }
    words = {"name": name, "code": code, "module": module, "bounds": bounds(__version__)}
    return {f"src/{module}/__init__.py": ""} | {path: _filled(template, words) for path, template in templates.items()}


def _filled(template: str, words: Mapping[str, str]) -> str:
    with open(os.path.join(_TEMPLATES, template), encoding="utf-8") as file:
        return Template(file.read()).substitute(words)


def bounds(version: str) -> str:
    """Return the versions of ros-lint with which a new plugin works: ">=0.3,<0.4" for 0.3.2, ">=1.3,<2" for 1.3.2.

    By semantic versioning (semver.org), the API may change with the first number, and with the second number while the
    first is 0.
    """
    major, minor = map(int, version.split(".")[:2])
    return f">={major}.{minor},<{major + 1}" if major else f">=0.{minor},<0.{minor + 1}"


def write(folder: str, texts: Mapping[str, str]) -> None:
    """Write files into a new folder. Raises NewRuleError if the folder exists or cannot be written."""
    try:
        os.mkdir(folder)
        for path, text in texts.items():
            target = os.path.join(folder, path)
            os.makedirs(os.path.dirname(target), exist_ok=True)
            with open(target, "x", encoding="utf-8", newline="\n") as file:
                file.write(text)
    except FileExistsError as error:
        raise NewRuleError(f"new-rule: '{folder}' exists, and new-rule overwrites nothing; choose another name") from error
    except OSError as error:
        raise NewRuleError(f"new-rule: '{folder}' cannot be written: {error.strerror}") from error


def _source() -> str:
    """Return the argument with which pip installs this version of ros-lint.

    It is the URL of the source tree or archive from which ros-lint was installed (PEP 610), else the name "ros-lint".
    """
    import json  # noqa: PLC0415
    from importlib.metadata import PackageNotFoundError, distribution  # noqa: PLC0415

    try:
        origin = json.loads(distribution("ros-lint").read_text("direct_url.json") or "{}")
    except PackageNotFoundError:
        return "ros-lint"
    url = str(origin.get("url", "ros-lint"))
    vcs = origin.get("vcs_info")
    return f"{vcs['vcs']}+{url}@{vcs['commit_id']}" if vcs else url
