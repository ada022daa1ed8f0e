"""Library functions that setup.py files call, evaluated on values and the package's files."""

from __future__ import annotations

import ast
import fnmatch
import posixpath
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from ros_lint.collectors.python import methods as python_methods
from ros_lint.collectors.setup_py.interpreter import methods as setup_py_methods
from ros_lint.collectors.setup_py.interpreter import sequences as setup_py_sequences
from ros_lint.collectors.setup_py.interpreter.expressions import Expressions
from ros_lint.collectors.setup_py.interpreter.files import ROOT
from ros_lint.collectors.setup_py.interpreter.state import LeaveError, at
from ros_lint.collectors.setup_py.interpreter.values import (
    REST,
    Module,
    Native,
    Unknown,
    Value,
    globbed,
    is_path,
    located,
    path_of,
    unknown_in,
)
from ros_lint.facts.environment import ROS_2

if TYPE_CHECKING:
    from pathlib import PurePosixPath

CONSTANTS: dict[str, Value] = {
    **python_methods.CONSTANTS,
    "os.extsep": ".",
    "sys.platform": "linux",
    "sys.maxsize": 2**63 - 1,
    "sys.byteorder": "little",
}
_MODULES = frozenset(
    {"os", "os.path", "sys", "glob", "pathlib", "fnmatch", "itertools", "setuptools", "distutils", "distutils.core"}
)
_SAME_AS = {
    "posixpath": "os.path",
    "distutils.core.setup": "setuptools.setup",
    "setuptools.PackageFinder.find": "setuptools.find_packages",
    "setuptools.find_packages.find": "setuptools.find_packages",
    "glob.iglob": "glob.glob",
    "pathlib.PosixPath": "pathlib.Path",
    "pathlib.PurePath": "pathlib.Path",
    "pathlib.PurePosixPath": "pathlib.Path",
    "os.getcwdb": "os.getcwd",
    "os.path.realpath": "os.path.abspath",
    "os.path.lexists": "os.path.exists",
}


def member(name: str) -> Value | None:
    """Return the value of a dotted name of the library, None if it is unknown."""
    name = _SAME_AS.get(name, name)
    if name in CONSTANTS:
        return CONSTANTS[name]
    if name in FUNCTIONS:
        return Native(name)
    return Module(name) if name in _MODULES else None


def environment(node: ast.AST) -> dict[str, Value]:
    """Return the environment variables that are the same in every build of ROS 2; all others are unknown."""
    return {**ROS_2, REST: Unknown("os.environ is not known", node)}


def builtin(name: str) -> Value | None:
    """Return the value of a builtin name, None if it is unknown."""
    return Native(name) if name in FUNCTIONS and "." not in name else None


def method(owner: Value, name: str, node: ast.AST) -> Value:
    """Return an attribute of a value that is not a module."""
    if is_path(owner):
        if name in _PATH_PROPERTIES:
            found = getattr(owner, name)
            return located(list(found) if name == "parents" else found, node)
        return Native(f"path.{name}", owner) if f"path.{name}" in FUNCTIONS else Unknown(f"Path.{name} is not known", node)
    known = setup_py_methods.method(owner, name)
    return known if known is not None else Unknown(f"the attribute {name} is not known", node)


_PATH_PROPERTIES = frozenset({"parent", "parents", "name", "stem", "suffix", "suffixes", "parts"})


def call(program: Expressions, function: Native, arguments: list[Value], keywords: dict[str, Value], node: ast.Call) -> Value:
    """Return the result of a known function or method."""
    if function.name in FUNCTIONS:
        known = FUNCTIONS[function.name]
        owner = [] if function.owner is None else [function.owner]
        if function.name not in _TOLERANT:
            program.weigh(*owner, *arguments, *keywords.values())
            unknown = unknown_in([*owner, *arguments, *keywords.values()])
            if unknown:
                return unknown
        try:
            found = known(program, node, *owner, *arguments, **keywords)
        except (AttributeError, TypeError) as error:  # it may take more than what is known of it
            return Unknown(f"{at(node)} fails with {type(error).__name__}", node)
        program.weigh(found)
        return located(found, node)
    return setup_py_methods.call(program, function, arguments, keywords, node)


# --- functions. The parameters of each are the program, the call and the arguments of the call


def _variable(_: Expressions, node: ast.Call, key: str, *_default: Value, **_named: Value) -> Value:
    known = environment(node)
    return known.get(key, known[REST])


def _glob(program: Expressions, _: ast.Call, pathname: str, **options: Value) -> Value:
    hidden, recursive = bool(options.get("include_hidden")), bool(options.get("recursive"))
    root = options.get("root_dir")
    pattern = str(pathname)
    if root is None:
        paths = program.files.glob(pattern, recursive=recursive, hidden=hidden)
    else:
        start = posixpath.join(str(root), "")
        paths = [path.removeprefix(start) for path in program.files.glob(start + pattern, recursive=recursive, hidden=hidden)]
    return globbed(pattern, paths)


def _path_glob(program: Expressions, _: ast.Call, owner: PurePosixPath, pattern: str) -> Value:
    whole = str(owner / pattern)
    paths = program.files.glob(whole, recursive=True, hidden=True)
    folders = pattern.endswith("**")
    return globbed(whole, [path_of(path) for path in paths if not folders or program.files.is_folder(path)])


def _find_packages(*, namespaces: bool) -> Callable[..., Value]:
    def find(program: Expressions, _: ast.Call, where: Value = ".", exclude: Value = (), include: Value = ("*",)) -> Value:
        patterns = {
            key: [texts] if isinstance(texts, str) else list(texts) for key, texts in (("include", include), ("exclude", exclude))
        }
        return program.files.find(str(where), namespaces=namespaces, **patterns)

    return find


def _listdir(program: Expressions, node: ast.Call, path: Value = ".") -> Value:
    names = program.files.names(str(path))
    return Unknown(f"the folder {path} does not exist", node) if names is None else names


def _relative(_: Expressions, __: ast.Call, path: Value, start: Value = ".") -> str:
    return posixpath.relpath(posixpath.join(ROOT, str(path)), posixpath.join(ROOT, str(start)))


def _ignore(*_: Value, **__: Value) -> None:
    return None


def _exit(*_: Value) -> None:
    raise LeaveError("raise", raised="SystemExit")


def _dict(_: Expressions, __: ast.Call, *values: Value, **more: Value) -> Value:
    found = dict(values[0]) if values else {}
    found.update(more)
    return found


def _plain(function: Callable[..., Any]) -> Callable[..., Value]:
    return lambda _program, _node, *arguments, **keywords: function(*arguments, **keywords)


def _on_texts(function: Callable[..., Any]) -> Callable[..., Value]:
    return lambda _program, _node, *paths: function(*(str(path) for path in paths))


def _isinstance(_: Expressions, __: ast.Call, value: Value, kinds: Value) -> bool:
    names = {kind.name for kind in (kinds if isinstance(kinds, tuple) and not isinstance(kinds, Native) else (kinds,))}
    return any(kind.__name__ in names for kind in type(value).__mro__)


FUNCTIONS: dict[str, Callable[..., Value]] = {
    **setup_py_sequences.FUNCTIONS,
    "os.path.join": _on_texts(posixpath.join),
    **{name: _on_texts(function) for name, function in {**python_methods.ON_PATHS, **python_methods.PATH_SPLITS}.items()},
    "os.path.isabs": _on_texts(posixpath.isabs),
    "os.path.abspath": _on_texts(lambda path: posixpath.normpath(posixpath.join(ROOT, path))),
    "os.path.relpath": _relative,
    "os.path.exists": lambda program, _, path: program.files.exists(str(path)),
    "os.path.isfile": lambda program, _, path: program.files.is_file(str(path)),
    "os.path.isdir": lambda program, _, path: program.files.is_folder(str(path)),
    "os.fspath": _on_texts(str),
    "os.getcwd": lambda *_: ROOT,
    "os.getenv": _variable,
    "os.listdir": _listdir,
    "os.walk": lambda program, _, top, **__: program.files.walk(str(top)),
    "glob.glob": _glob,
    "fnmatch.fnmatch": _on_texts(fnmatch.fnmatchcase),
    "fnmatch.filter": lambda _, __, names, pattern: [name for name in names if fnmatch.fnmatchcase(name, pattern)],
    "pathlib.Path": lambda _, __, *parts: path_of(*parts),
    "pathlib.Path.cwd": lambda *_: path_of(ROOT),
    "path.glob": _path_glob,
    "path.rglob": lambda program, node, owner, pattern: _path_glob(program, node, owner / "**", pattern),
    "path.iterdir": lambda program, _, owner: [owner / name for name in program.files.names(str(owner)) or ()],
    "path.exists": lambda program, _, owner: program.files.exists(str(owner)),
    "path.is_file": lambda program, _, owner: program.files.is_file(str(owner)),
    "path.is_dir": lambda program, _, owner: program.files.is_folder(str(owner)),
    "path.as_posix": lambda _, __, owner: str(owner),
    "path.resolve": lambda *args: path_of(posixpath.normpath(posixpath.join(ROOT, str(args[2])))),
    "path.absolute": lambda _, __, owner: path_of(ROOT) / owner,
    "path.joinpath": lambda _, __, *parts: path_of(*parts),
    "path.relative_to": lambda _, __, owner, *parts: owner.relative_to(*parts),
    "path.with_suffix": lambda _, __, owner, suffix: owner.with_suffix(suffix),
    "path.with_name": lambda _, __, owner, name: owner.with_name(name),
    "path.match": lambda _, __, owner, pattern: owner.match(pattern),
    "path.is_absolute": lambda _, __, owner: owner.is_absolute(),
    "setuptools.find_packages": _find_packages(namespaces=False),
    "setuptools.find_namespace_packages": _find_packages(namespaces=True),
    "sys.exit": _exit,
    "exit": _exit,
    "quit": _exit,
    "print": _ignore,
    "os.makedirs": _ignore,
    "os.mkdir": _ignore,
    "dict": _dict,
    "set": _plain(set),
    "frozenset": _plain(set),
    "str": _plain(str),
    "repr": _plain(repr),
    "int": _plain(int),
    "float": _plain(float),
    "bool": lambda program, _, value=False: bool(program.truth(value)),
    "len": _plain(len),
    "min": _plain(min),
    "max": _plain(max),
    "any": _plain(any),
    "all": _plain(all),
    "range": lambda _, __, *bounds: list(range(*bounds)) if all(abs(bound) < 10_000 for bound in bounds) else None,
    "zip": _plain(lambda *lists, **_: list(zip(*lists, strict=False))),
    "enumerate": _plain(lambda values, start=0: list(enumerate(values, start))),
    "isinstance": _isinstance,
}
_TOLERANT = frozenset(
    {
        "list", "sorted", "reversed", "iter", "tuple", "dict", "map", "filter", "sum", "print", "itertools.chain",
        "itertools.chain.from_iterable", "os.makedirs", "os.mkdir", "sys.exit", "exit", "quit",
    }
)  # fmt: skip
