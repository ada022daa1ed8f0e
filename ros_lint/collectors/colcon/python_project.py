"""Name and dependencies of a Python package without a usable package.xml, from its setup scripts, as colcon determines them.

colcon runs setup.py to get the name and the dependencies. This module only reads setup.py, so a name that is not a literal
is unknown. Source: package identification and augmentation of colcon-core and colcon-python-setup-py.
"""

from __future__ import annotations

import ast
import re
from configparser import Error as ConfigError
from configparser import RawConfigParser
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.collectors.pyproject import table, tables
from ros_lint.collectors.python.source_errors import NotPythonError, TooDeepError
from ros_lint.collectors.python.syntax import parse, span_of
from ros_lint.facts.manifest import ColconDepend, Role

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from ros_lint.base.text import Text

_REQUIREMENTS = {"setup_requires": Role.BUILD, "install_requires": Role.EXEC, "tests_require": Role.TEST}
_TEST_EXTRAS = ("test", "tests", "testing")
_REQUIREMENT = re.compile(r"\s*([\w.-]+)")


class PythonProject(NamedTuple):
    """The name and the dependencies that colcon gets from setup.py, setup.cfg and pyproject.toml of a Python package."""

    name: str
    """The name of the package, "" if it has no name or the name is unknown."""
    unknown: str
    """The reason why the name is unknown, as a clause such as "setup.py computes its name"; "" if the name is not unknown."""
    depends: tuple[ColconDepend, ...]


NO_PROJECT = PythonProject("", "", ())


def needs_no_run(setup_py: Text) -> bool:
    """Return whether colcon reads setup.cfg and does not run setup.py, because setup() has no arguments."""
    return "setup()" in setup_py.text or "setup(cmdclass=cmdclass)" in setup_py.text


def from_setup_cfg(setup_cfg: Text) -> PythonProject:
    """Return the name and dependencies that a ``setup.cfg`` defines, without setup.py."""
    parser = RawConfigParser(strict=False)
    try:
        parser.read_string(setup_cfg.text)
    except ConfigError:
        return PythonProject("", "setup.cfg cannot be parsed", ())
    sections = {name: {key.replace("-", "_"): value or "" for key, value in parser.items(name)} for name in parser}
    depends = list(_cfg_depends(setup_cfg, sections.get("options", {}), _REQUIREMENTS))
    extras = dict.fromkeys(_TEST_EXTRAS, Role.TEST)
    depends += _cfg_depends(setup_cfg, sections.get("options.extras_require", {}), extras)
    return PythonProject(sections.get("metadata", {}).get("name", "").strip(), "", tuple(depends))


def _cfg_depends(text: Text, options: Mapping[str, str], roles: Mapping[str, Role]) -> Iterator[ColconDepend]:
    for option, role in roles.items():
        value = options.get(option, "").strip()
        if value.startswith("file:"):
            continue
        for item in value.splitlines() if "\n" in value else value.split(";"):
            if match := _REQUIREMENT.match(item):
                at = text.text.find(item.strip())
                yield ColconDepend(match[1], role, text.span(at, at + len(match[1])))


def from_setup_py(setup_py: Text, setup_cfg: Text | None, pyproject: Text | None) -> PythonProject:
    """Return the name and dependencies that colcon would get by running a ``setup.py``. The name may be unknown."""
    try:
        module = parse(setup_py)
    except TooDeepError as error:
        return PythonProject("", f"setup.py has {error.message}", ())
    except NotPythonError:
        return NO_PROJECT  # running it fails, too
    try:
        return _from_module(module, setup_py, from_setup_cfg(setup_cfg) if setup_cfg else NO_PROJECT, pyproject)
    except RecursionError:
        return PythonProject("", "setup.py is nested too deeply", ())


def _from_module(module: ast.Module, setup_py: Text, declared: PythonProject, pyproject: Text | None) -> PythonProject:
    calls = [node for node in ast.walk(module) if isinstance(node, ast.Call) and _is_setup(node.func)]
    if not calls:
        return NO_PROJECT
    if len(calls) > 1:
        return PythonProject("", "setup.py calls setup() in several places", ())
    script = _Script(setup_py, module)
    arguments, complete = script.arguments(calls[0])
    name, unknown = declared.name or _pyproject_name(pyproject), ""
    if "name" in arguments:
        value = script.value(arguments["name"])
        name = value if isinstance(value, str) else ""
        unknown = "" if name else "setup.py computes its name"
    elif not complete and not name:
        unknown = "setup.py computes the arguments of setup()"
    return PythonProject(name, unknown, (*script.depends(arguments), *declared.depends))


def _is_setup(node: ast.expr) -> bool:
    if isinstance(node, ast.Attribute):
        return node.attr == "setup" and isinstance(node.value, (ast.Name, ast.Attribute))
    return isinstance(node, ast.Name) and node.id == "setup"


def _pyproject_name(pyproject: Text | None) -> str:
    if pyproject is None:
        return ""
    name = table(tables(pyproject), "project").get("name")
    return name if isinstance(name, str) else ""


class _Script:
    """A setup.py, and the values of the variables to which it assigns exactly once."""

    def __init__(self, text: Text, module: ast.Module) -> None:
        self._text = text
        names = [node for node in ast.walk(module) if isinstance(node, ast.Name)]
        stores = [node.id for node in names if isinstance(node.ctx, ast.Store)]
        self._values: dict[str, ast.expr] = {}
        for statement in module.body:
            if isinstance(statement, ast.Assign) and len(statement.targets) == 1:
                target = statement.targets[0]
                if isinstance(target, ast.Name) and stores.count(target.id) == 1:
                    self._values[target.id] = statement.value

    def arguments(self, call: ast.Call) -> tuple[dict[str, ast.expr], bool]:
        """Return the known keyword arguments of a call, and False if a ``**mapping`` in the call may have further ones."""
        result: dict[str, ast.expr] = {}
        complete = True
        for keyword in call.keywords:
            if keyword.arg is not None:
                result[keyword.arg] = keyword.value
                continue
            items = self._items(keyword.value)
            complete = complete and items is not None
            result.update(items or {})
        return result, complete

    def _items(self, node: ast.expr) -> dict[str, ast.expr] | None:
        node = self._resolved(node)
        if isinstance(node, ast.Dict):
            keys = [key.value for key in node.keys if isinstance(key, ast.Constant) and isinstance(key.value, str)]
            return dict(zip(keys, node.values, strict=True)) if len(keys) == len(node.keys) else None
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "dict" and not node.args:
            arguments, complete = self.arguments(node)
            return arguments if complete else None
        return None

    def _resolved(self, node: ast.expr) -> ast.expr:
        for _ in range(10):
            if not isinstance(node, ast.Name) or node.id not in self._values:
                break
            node = self._values[node.id]
        return node

    def value(self, node: ast.expr) -> object:
        """Return the value of an expression that consists of constants, variables, ``+`` and f-strings, None if unknown."""
        node = self._resolved(node)
        if isinstance(node, ast.Constant):
            return node.value
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
            left, right = self.value(node.left), self.value(node.right)
            return left + right if isinstance(left, str) and isinstance(right, str) else None
        if isinstance(node, ast.JoinedStr):
            parts = [self.value(part) for part in node.values]
            texts = [part for part in parts if isinstance(part, str)]
            return "".join(texts) if len(texts) == len(parts) else None
        if isinstance(node, ast.FormattedValue) and node.conversion == -1 and node.format_spec is None:
            return self.value(node.value)
        return None

    def depends(self, arguments: Mapping[str, ast.expr]) -> Iterator[ColconDepend]:
        for option, role in _REQUIREMENTS.items():
            yield from self._needs(arguments.get(option), role)
        extras = self._items(arguments["extras_require"]) if "extras_require" in arguments else None
        for extra in _TEST_EXTRAS:
            yield from self._needs((extras or {}).get(extra), Role.TEST)

    def _needs(self, node: ast.expr | None, role: Role) -> Iterator[ColconDepend]:
        node = self._resolved(node) if node else None
        items = node.elts if isinstance(node, (ast.List, ast.Tuple, ast.Set)) else [node] if node else []
        for item in items:
            value = self.value(item)
            lines = value.splitlines() if isinstance(value, str) else []
            for line in lines:
                if match := _REQUIREMENT.match(line):
                    yield ColconDepend(match[1], role, span_of(self._text, item))
