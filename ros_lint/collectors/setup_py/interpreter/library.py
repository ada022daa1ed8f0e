"""Models that compute the results of the functions in setup.py files: functions of setuptools, glob, os and pathlib."""

from __future__ import annotations

import ast
import fnmatch
import posixpath
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from ros_lint.base.budget import Budget
from ros_lint.collectors.python.interpreter.alternatives import plain
from ros_lint.collectors.python.interpreter.builtins import FUNCTIONS as PYTHON
from ros_lint.collectors.python.interpreter.calls import LibraryCall, Rule, nothing
from ros_lint.collectors.python.interpreter.operations import each
from ros_lint.collectors.python.interpreter.path_calls import PATH_FUNCTIONS, on_path
from ros_lint.collectors.python.interpreter.values import (
    FilePath,
    Frame,
    Globbed,
    LaunchObject,
    LibraryName,
    Method,
    ProgramRaised,
    Source,
    Unknown,
    Value,
    globbed,
)
from ros_lint.collectors.python.methods import CONSTANTS as PYTHON_CONSTANTS
from ros_lint.collectors.setup_py.interpreter.files import ROOT, Files
from ros_lint.collectors.setup_py.interpreter.values import REST, Deciding
from ros_lint.collectors.symbolic_text import UNKNOWN, is_plain
from ros_lint.facts.environment import ROS_2

if TYPE_CHECKING:
    from ros_lint.collectors.python.interpreter.protocol import Interpreter
    from ros_lint.collectors.python.interpreter.recorder import How

MODULES: Final = frozenset(
    {"os", "os.path", "sys", "glob", "pathlib", "fnmatch", "itertools", "setuptools", "distutils", "distutils.core"}
)
"""The modules whose functions have models."""
_CONSTANTS: dict[str, Value] = {
    **PYTHON_CONSTANTS,
    "os.extsep": ".",
    "sys.platform": "linux",
    "sys.maxsize": 2**63 - 1,
    "sys.byteorder": "little",
}
_SAME_AS = {
    "posixpath": "os.path",
    "distutils.core.setup": "setuptools.setup",
    "setuptools.PackageFinder.find": "setuptools.find_packages",
    "setuptools.find_packages.find": "setuptools.find_packages",
    "glob.iglob": "glob.glob",
    "os.getcwdb": "os.getcwd",
    "os.path.realpath": "os.path.abspath",
    "os.path.lexists": "os.path.exists",
}
_EXTENSIONS = frozenset({"setup", "generate_parameter_module", "generate_distutils_setup"})
"""Functions of modules that extend setuptools, by their last names."""


class Setup(NamedTuple):
    """A call of setup() in a setup.py, with the values of its options."""

    options: dict[str, Value]
    node: ast.Call | None
    module: str
    """The module of the function: setuptools, or a package that extends it."""


class SetupLibrary:
    """The models of library functions for a setup.py.

    The class implements :class:`ros_lint.collectors.python.interpreter.protocol.Library`.
    """

    def __init__(self, package: str, files: Files) -> None:
        self._package = package
        self.files = files
        self.setups: list[Setup] = []
        self.generated: list[str] = []
        """Dotted names of Python modules that a generator adds to the package."""
        self._functions: dict[str, Rule] = {
            **{name: _on_known(partial(function, files)) for name, function in _ON_FILES.items()},
            "generate_parameter_module": self._generate_parameter_module,
            "generate_distutils_setup": self._generate_distutils_setup,
        }

    def describes(self, module: str) -> bool:  # noqa: ARG002
        return True

    def model(self, module: str, at: ast.stmt) -> ast.Module | None:  # noqa: ARG002
        return None

    def member(self, name: str, node: ast.AST, source: Source) -> Value:  # noqa: ARG002
        name = _SAME_AS.get(name, name)
        if name in _CONSTANTS:
            return _CONSTANTS[name]
        if name == "os.environ":
            return {**ROS_2, REST: Unknown("os.environ is not known", None, node)}
        known = name in MODULES or name in _FUNCTIONS or name in self._functions or name.rpartition(".")[2] in _EXTENSIONS
        return LibraryName(name) if known else Unknown(f"{name} is not known", None, node)

    def is_substitution(self, name: str) -> bool:  # noqa: ARG002
        return False

    def call(
        self,
        interpreter: Interpreter,
        callee: str | Method,
        arguments: list[Value],
        keywords: dict[str, Value],
        node: ast.Call,
        frame: Frame,
    ) -> Value:
        if isinstance(callee, Method):
            name, arguments = f"pathlib.Path.{callee.name}", [callee.owner, *arguments]
        else:
            name = callee
        module, _, last = name.rpartition(".")
        call = LibraryCall(interpreter, name, arguments, keywords, node, frame)
        if last == "setup":
            self._note_setup(call, module)
            return Unknown("the result of setup() is not evaluated", None, node)
        rule = _FUNCTIONS.get(name) or self._functions.get(name) or self._functions.get(last)
        return rule(call) if rule is not None else Unknown(f"{last}()")

    def attribute(self, owner: LaunchObject, name: str) -> Value:  # noqa: ARG002
        return Unknown(f"attribute {name}")

    def subscript(self, interpreter: Interpreter, owner: Value, key: Value) -> Value:  # noqa: ARG002
        return Unknown("element of an unknown value")

    def texts(self, value: Value, budget: Budget) -> tuple[str, ...]:  # noqa: ARG002
        return (UNKNOWN,)

    def with_defaults(self, interpreter: Interpreter, text: str) -> tuple[str, ...]:  # noqa: ARG002
        return ()

    def misuse(self, made: LaunchObject, how: How) -> How | None:  # noqa: ARG002
        return None

    def _note_setup(self, call: LibraryCall, module: str) -> None:
        deciding = Deciding(call.machine.conditions, call.machine.tests)
        options = {name: deciding.option(value) for name, value in call.keywords.items()}
        self.setups.append(Setup(options, call.node, module))

    def _generate_parameter_module(self, call: LibraryCall) -> Value:
        name = plain(call.get(0, "module_name"))
        if isinstance(name, str):
            self.generated.append(f"{self._package}.{name}")
        return None

    def _generate_distutils_setup(self, call: LibraryCall) -> Value:
        """Return the result of generate_distutils_setup() of catkin_pkg: the options of setup().

        These are the name of the package, an unknown version, and the keywords of the call.
        """
        version = Unknown("the version in package.xml is not read", None, call.node)
        return {"name": self._package, "version": version, **call.keywords}


# --- functions of known values, with the files of the package as the first argument


def _on_known(function: Callable[..., Value]) -> Rule:
    """Return a function that computes the result of a call by ``function``, Unknown if an argument of the call is unknown.

    Paths of pathlib are passed to ``function`` as texts.
    """

    def rule(call: LibraryCall) -> Value:
        keywords = {name: _argument(plain(value)) for name, value in call.keywords.items()}
        if not all(map(_is_known, keywords.values())):
            return Unknown(f"{call.name}()")
        return _spread(call.arguments, lambda known: function(*known, **keywords))

    return rule


def _spread(arguments: list[Value], function: Callable[[list[Value]], Value]) -> Value:
    """Return a value whose alternatives are the results of a function for all combinations of alternatives of its arguments.

    The result for an unknown argument is Unknown.
    """
    if not arguments:
        try:
            return function([])
        except (AttributeError, TypeError, ValueError) as error:
            raise ProgramRaised(type(error).__name__) from None

    def with_first(value: Value) -> Value:
        first = _argument(value)
        return _spread(arguments[1:], lambda rest: function([first, *rest])) if _is_known(first) else Unknown("an argument")

    return each(arguments[0], with_first)


def _argument(value: Value) -> Value:
    return value.text if isinstance(value, FilePath) else value


def _is_known(value: Value) -> bool:
    if isinstance(value, (list, tuple)):
        return all(isinstance(item, str) and is_plain(item) for item in value)
    return value is None or isinstance(value, (bool, int)) or (isinstance(value, str) and is_plain(value))


def _glob(files: Files, pathname: str, **options: Value) -> Value:
    hidden, recursive = bool(options.get("include_hidden")), bool(options.get("recursive"))
    root = options.get("root_dir")
    if root is None:
        return globbed(pathname, files.glob(pathname, recursive=recursive, hidden=hidden))
    start = posixpath.join(root, "")
    paths = files.glob(start + pathname, recursive=recursive, hidden=hidden)
    return globbed(pathname, [path.removeprefix(start) for path in paths])


def _path_glob(files: Files, owner: str, pattern: str) -> Globbed:
    whole = FilePath(posixpath.join(owner, pattern)).text
    paths = files.glob(whole, recursive=True, hidden=True)
    return globbed(whole, [FilePath(path) for path in paths if not pattern.endswith("**") or files.is_folder(path)])


def _find_packages(
    files: Files, where: str = ".", exclude: Value = (), include: Value = ("*",), *, namespaces: bool = False
) -> Value:
    patterns = {
        key: [texts] if isinstance(texts, str) else list(texts) for key, texts in (("include", include), ("exclude", exclude))
    }
    return files.find(where, namespaces=namespaces, **patterns)


def _listdir(files: Files, path: str = ".") -> Value:
    names = files.names(path)
    return Unknown(f"the folder {path} does not exist") if names is None else names


def _relative(_: Files, path: str, start: str = ".") -> str:
    return posixpath.relpath(posixpath.join(ROOT, path), posixpath.join(ROOT, start))


def _absolute(path: str) -> str:
    return posixpath.normpath(posixpath.join(ROOT, path))


_ON_FILES: dict[str, Callable[..., Any]] = {
    "fnmatch.filter": lambda _, names, pattern: [name for name in names if fnmatch.fnmatchcase(name, pattern)],
    "fnmatch.fnmatch": lambda _, name, pattern: fnmatch.fnmatchcase(name, pattern),
    "glob.glob": _glob,
    "os.listdir": _listdir,
    "os.path.exists": Files.exists,
    "os.path.isabs": lambda _, path: posixpath.isabs(path),
    "os.path.isdir": Files.is_folder,
    "os.path.isfile": Files.is_file,
    "os.path.relpath": _relative,
    "os.walk": lambda files, top, **_: files.walk(top),
    "pathlib.Path.absolute": lambda _, owner: FilePath(posixpath.join(ROOT, owner)),
    "pathlib.Path.exists": Files.exists,
    "pathlib.Path.glob": _path_glob,
    "pathlib.Path.is_dir": Files.is_folder,
    "pathlib.Path.is_file": Files.is_file,
    "pathlib.Path.iterdir": lambda files, owner: [FilePath(posixpath.join(owner, name)) for name in files.names(owner) or ()],
    "pathlib.Path.resolve": lambda _, owner: FilePath(_absolute(owner)),
    "pathlib.Path.rglob": lambda files, owner, pattern: _path_glob(files, posixpath.join(owner, "**"), pattern),
    "setuptools.find_namespace_packages": partial(_find_packages, namespaces=True),
    "setuptools.find_packages": _find_packages,
}


def _variable(call: LibraryCall) -> Value:
    name = plain(call.get(0, "key"))
    known = ROS_2.get(name) if isinstance(name, str) else None
    return Unknown("an environment variable") if known is None else known


def _exit(_: LibraryCall) -> Value:
    raise ProgramRaised("SystemExit", deliberate=True)


_FUNCTIONS: dict[str, Rule] = {
    **PYTHON,
    **PATH_FUNCTIONS,
    **dict.fromkeys(("builtins.exit", "builtins.quit", "sys.exit"), _exit),
    **dict.fromkeys(("os.makedirs", "os.mkdir"), nothing),
    "os.getcwd": lambda _: ROOT,
    "os.getenv": _variable,
    "os.path.abspath": on_path(_absolute),
    "pathlib.Path.cwd": lambda _: FilePath(ROOT),
}
