"""Launch files in Python. They are read, never run.

What is written out is understood, also by way of names, joined paths and formatted texts; what is computed from
arguments of the launch file, of functions or from other files is said to be opaque.
"""

from __future__ import annotations

import ast
import re
import shlex
import warnings
from collections.abc import Callable, Mapping
from posixpath import normpath
from typing import Literal

from ros_lint.collectors.launch_text import UNKNOWN, Installed, installed, share
from ros_lint.collectors.launch_py_scopes import Expression, Scope, Where, children, scan
from ros_lint.collectors.launch_py_values import ANYTHING, LOOK_UPS, Evaluator, argument, callee
from ros_lint.facts import Facet, LaunchFile, LaunchReference, Opaque, Problem
from ros_lint.text import Span, Text

_ENTRY = re.compile(r"^(?:async[ \t]+)?def[ \t]+generate_(launch|test)_description\b", re.MULTILINE)


def collect(source: Text) -> LaunchFile:
    """Return what a launch file in Python says. Never raises."""
    entries = {match[1] for match in _ENTRY.finditer(source.text)}
    test, helper = "launch" not in entries and "test" in entries, not entries
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about escapes in somebody's strings
            tree = ast.parse(source.text)
        reader = _Reader(source)
        reader.read(tree)
    except SyntaxError as error:
        at = _clamped(source, error.lineno or 1, error.offset or 1)
        problem = Problem("syntax", f"not valid Python: {error.msg}", at)
        opaque = Opaque(Facet.USES, "the file is no Python that can be read", at)
        return LaunchFile(source.path, "python", (), (opaque,), (problem,), test, helper)
    except (ValueError, RecursionError, MemoryError):
        start = source.span(0, 0)
        opaque = Opaque(Facet.USES, "the file is nested too deeply, or no text", start)
        return LaunchFile(source.path, "python", (), (opaque,), (), test, helper)
    references = tuple(dict.fromkeys(reader.references))
    return LaunchFile(source.path, "python", references, tuple(dict.fromkeys(reader.opaque)), (), test, helper)


def _clamped(source: Text, line: int, column: int) -> Span:
    """Return the place of a syntax error; the parser may point behind the end of the file."""
    line = min(max(line, 1), source.line_count)
    column = min(max(column, 1), len(source.line(line)) + 1)
    return Span(source.path, line, column, line, column)


Kind = Literal["node", "component", "include", "file", "package"]

_NODES = frozenset({"Node", "LifecycleNode", "ComposableNodeContainer"})
_COMPONENTS = frozenset({"ComposableNode", "ComposableLifecycleNode"})
_PROCESSES = frozenset({"ExecuteProcess", "ExecuteLocal"})
# Made, but neither returned nor added, these do nothing.
_ACTIONS = _NODES | _COMPONENTS | _PROCESSES | {"IncludeLaunchDescription", "GroupAction", "TimerAction", "Command"}
_TEXTS = frozenset({ast.BinOp, ast.JoinedStr})
_LISTS = frozenset({ast.List, ast.Tuple})
# What makes a path or a text out of its arguments.
_PATHS = LOOK_UPS | frozenset(
    {
        "join", "PathJoinSubstitution", "PathSubstitution", "Path", "PurePath", "str", "joinpath", "find", "format",
        "dirname", "abspath", "realpath", "normpath",
    }
)  # fmt: skip


class _Reader:
    def __init__(self, source: Text) -> None:
        self._source = source
        self._ascii = source.text.isascii()
        self._evaluator = Evaluator()
        self._where: Where
        self._dead = False
        self.references: list[LaunchReference] = []
        self.opaque: list[Opaque] = []

    def read(self, tree: ast.Module) -> None:
        expressions = scan(tree)
        dead = _dead(expressions)
        for expression in expressions:
            self._where = expression.where
            self._dead = id(expression.node) in dead
            self._visit(expression.node, expression.conditional)

    def _visit(self, node: ast.expr, conditional: bool) -> None:
        kind = type(node)
        if kind is ast.Name or kind is ast.Constant:
            return
        if isinstance(node, ast.Call):
            self._call(node, conditional)
            return
        if kind in _TEXTS or (kind in _LISTS and any(type(item) is ast.Constant for item in node.elts)):  # type: ignore[attr-defined]
            if self._path(node, conditional):
                return
        elif isinstance(node, ast.IfExp):
            self._visit(node.test, conditional)
            self._visit(node.body, conditional=True)
            self._visit(node.orelse, conditional=True)
            return
        for child in children(node):
            self._visit(child, conditional)

    def _call(self, node: ast.Call, conditional: bool) -> None:
        name = callee(node)
        keywords = [keyword.arg for keyword in node.keywords]
        conditional = conditional or "condition" in keywords
        done: list[ast.expr | None] = []
        if "package" in keywords and (name in _NODES or "executable" in keywords):
            done = self._program(node, "node", "executable", conditional)
        elif "package" in keywords and (name in _COMPONENTS or "plugin" in keywords):
            done = self._program(node, "component", "plugin", conditional)
        elif name in _PATHS:
            if self._path(node, conditional):
                return
        elif special := _SPECIAL.get(name):
            done = special(self, node, conditional)
        for child in children(node):
            if child not in done:
                self._visit(child, conditional)

    def _program(self, node: ast.Call, kind: Kind, keyword: str, conditional: bool) -> list[ast.expr | None]:
        package_node = argument(node, 1, "package")
        name_node = argument(node, 0, keyword)
        if self._dead or package_node is None:
            return []
        packages = self._evaluator.values(package_node, self._where)
        names = self._evaluator.values(name_node, self._where)
        several = len(packages) * len(names) > 1
        if len(packages) > 1 and len(names) > 1:
            names = ANYTHING  # which belongs to which is not known
        for package in packages:
            if not package.known or not package.text:
                self._hidden(f"the package of a {kind} is computed: {self._quote(package_node)}", package_node)
                continue
            for name in names:
                if name.known and name.text:
                    self._add(
                        kind, package.text, name.text, name_node, package_node, conditional=conditional or several
                    )
                else:
                    self._add(
                        "package", package.text, "", package_node, package_node, conditional=conditional or several
                    )
        return [package_node, name_node]

    def _include(self, node: ast.Call, conditional: bool) -> list[ast.expr | None]:
        target = argument(node, 0, "launch_description_source")
        if target is None or self._dead:
            return []
        inner = target
        while isinstance(inner, ast.Call) and callee(inner).endswith("LaunchDescriptionSource"):
            given = argument(inner, 0, "launch_file_path", "location", "launch_description")
            if given is None:
                return []
            inner = given
        values = self._evaluator.values(inner, self._where)
        found = False
        for value in values:
            for package, package_node in value.packages:
                for place in installed(value.text):
                    if place.package == package and place.known:
                        found = True
                        whole = place.share is not None and normpath(value.text) == f"{share(package)}/{place.share}"
                        kind: Kind = "include" if whole else "package"
                        self._place(kind, place, inner, package_node, conditional=conditional or len(values) > 1)
        if not found and any(not value.known for value in values):
            self._hidden(f"which launch file is included is computed: {self._quote(inner)}", inner)
            return []
        return [target] if found else []

    def _process(self, node: ast.Call, conditional: bool) -> list[ast.expr | None]:
        """``ros2 run package executable`` and ``ros2 launch package file`` (reference, section E2.19)."""
        command = argument(node, 0, "cmd")
        if command is None or self._dead:
            return []
        words: list[tuple[str, ast.expr]] = []
        for element, where in self._evaluator.elements(command, self._where) or ():
            values = self._evaluator.values(element, where)
            text = values[0].text if len(values) == 1 else UNKNOWN
            words += [(word, element) for word in _words(text)]
        names = [word for word, _ in words]
        if names[:1] == ["xacro"]:
            self._xacro(words[0][1], conditional)
        if names[:2] not in (["ros2", "run"], ["ros2", "launch"]):
            return []
        rest = [(word, element) for word, element in words[2:] if not word.startswith("-")][:2]
        if not rest or UNKNOWN in rest[0][0]:
            self._hidden(f"what ros2 {names[1]} starts is computed", command)
        elif names[1] == "run" and len(rest) == 2 and UNKNOWN not in rest[1][0]:
            self._add("node", rest[0][0], rest[1][0], rest[1][1], rest[0][1], conditional=conditional)
        elif "/" not in rest[0][0] and not rest[0][0].endswith((".py", ".xml", ".yaml")):
            self._add("package", rest[0][0], "", rest[0][1], rest[0][1], conditional=conditional)
        return []

    def _builder(self, node: ast.Call, conditional: bool) -> list[ast.expr | None]:
        """MoveIt's builders look a package up (reference, section G2.7)."""
        name = callee(node)
        given = (
            argument(node, 1, "package_name") if name == "MoveItConfigsBuilder" else argument(node, 0, "package_name")
        )
        robot = argument(node, 0, "robot_name")
        suffix = ""
        if given is None and name == "MoveItConfigsBuilder":
            given, suffix = robot, "_moveit_config"
        if given is None:
            return []
        for value in self._evaluator.values(given, self._where):
            if value.known:
                self._add("package", value.text + suffix, "", given, given, conditional=conditional)
            else:
                self._hidden(f"the package of {name} is computed", given)
        return []

    def _in_package(self, node: ast.Call, conditional: bool) -> list[ast.expr | None]:
        return self._program(node, "node", "executable", conditional)

    def _found_program(self, node: ast.Call, conditional: bool) -> list[ast.expr | None]:
        self._xacro(argument(node, 0, "name"), conditional)
        return []

    def _xacro(self, node: ast.expr | None, conditional: bool) -> None:
        if node is not None and not self._dead and self._evaluator.values(node, self._where)[0].text == "xacro":
            self._add("package", "xacro", "", node, node, conditional=conditional)

    def _path(self, node: ast.expr, conditional: bool) -> bool:
        """Note the packages whose files a path or a text names. Return whether there are any."""
        lazy = isinstance(node, ast.Call) and callee(node) in ("FindPackageShare", "PathJoinSubstitution")
        if self._dead and lazy:
            return True
        values = self._evaluator.values(node, self._where)
        found = False
        for value in values:
            for package, package_node in value.packages:
                if UNKNOWN in package:
                    self._hidden(
                        f"the package that is looked up is computed: {self._quote(package_node)}", package_node
                    )
                    found = True
            for place in installed(value.text):
                for package, package_node in value.packages:
                    if place.package == package and place.known:
                        found = True
                        self._place("file", place, node, package_node, conditional=conditional or len(values) > 1)
                        break
        if not found and isinstance(node, ast.Call) and callee(node) in LOOK_UPS:
            self._hidden(f"the package that is looked up is computed: {self._quote(node)}", node)
        return found

    def _place(
        self, kind: Kind, place: Installed, node: ast.expr, package_node: ast.expr, *, conditional: bool
    ) -> None:
        if place.executable:
            self._add("node", place.package, place.executable, node, package_node, conditional=conditional)
        elif place.share and kind in ("include", "file"):
            self._add(kind, place.package, place.share, node, package_node, conditional=conditional)
        else:
            self._add("package", place.package, "", package_node, package_node, conditional=conditional)

    def _add(
        self,
        kind: Kind,
        package: str,
        name: str,
        node: ast.expr | None,
        package_node: ast.expr,
        *,
        conditional: bool,
    ) -> None:
        if not _PACKAGE.fullmatch(package):
            return
        node = node or package_node
        span, exact = self._span(node, name or package)
        package_span, package_exact = self._span(package_node, package)
        self.references.append(
            LaunchReference(kind, package, name, span, package_span, conditional, exact, package_exact)
        )

    def _hidden(self, reason: str, node: ast.expr) -> None:
        self.opaque.append(Opaque(Facet.USES, reason, self._span(node, "")[0]))

    def _quote(self, node: ast.expr) -> str:
        text = " ".join(ast.unparse(node).split())
        return text if len(text) <= 60 else text[:57] + "..."

    def _span(self, node: ast.expr, text: str) -> tuple[Span, bool]:
        """Return the place of an expression; of the text alone when it is written there as it is."""
        start = self._offset(node.lineno, node.col_offset)
        end = self._offset(node.end_lineno or node.lineno, node.end_col_offset or node.col_offset)
        if text and isinstance(node, ast.Constant):
            at = self._source.text.find(text, start, end)
            if at >= 0 and node.value == text:
                return self._source.span(at, at + len(text)), True
        return self._source.span(start, end), False

    def _offset(self, line: int, column: int) -> int:
        """Turn a line and a column in bytes of UTF-8 into an offset."""
        start = self._source.offset(line, 1)
        if self._ascii:
            return start + column
        head = self._source.line(line).encode("utf-8", "surrogateescape")[:column]
        return start + len(head.decode("utf-8", "surrogateescape"))


_SPECIAL: Mapping[str, Callable[[_Reader, ast.Call, bool], list[ast.expr | None]]] = {
    "IncludeLaunchDescription": _Reader._include,
    "ExecuteProcess": _Reader._process,
    "ExecuteLocal": _Reader._process,
    "ExecutableInPackage": _Reader._in_package,
    "MoveItConfigsBuilder": _Reader._builder,
    "ParameterBuilder": _Reader._builder,
    "FindExecutable": _Reader._found_program,
}
_PACKAGE = re.compile(r"[A-Za-z0-9_][\w.-]*")


def _words(text: str) -> list[str]:
    try:
        return shlex.split(text)
    except ValueError:
        return text.split()


def _dead(expressions: list[Expression]) -> set[int]:
    """Return the expressions whose value nobody can use: actions that are made and then neither returned nor added."""
    found: set[int] = set()
    for expression in expressions:
        if not isinstance(expression.node, ast.Call) or callee(expression.node) not in _ACTIONS:
            continue
        scope: Scope = expression.where.scope
        if expression.target == "" or (
            expression.target is not None and expression.target not in scope.loads and not scope.reflective
        ):
            found.add(id(expression.node))
    return found
