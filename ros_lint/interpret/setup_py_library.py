"""What setup.py files call: the parts of Python's library that need nothing but values and the package's files."""

from __future__ import annotations

import ast
import fnmatch
import posixpath
from collections.abc import Callable
from itertools import product
from math import prod
from typing import TYPE_CHECKING, Any

from ros_lint.interpret.setup_py_expressions import Expressions
from ros_lint.interpret.setup_py_files import ROOT
from ros_lint.interpret.setup_py_operators import LONGEST, binary, check_format, check_size
from ros_lint.interpret.setup_py_state import LeaveError
from ros_lint.interpret.setup_py_values import (
    Globbed,
    Maybe,
    Module,
    Native,
    Unknown,
    Value,
    certain,
    is_path,
    located,
    path_of,
    unknown_in,
)

if TYPE_CHECKING:
    from pathlib import PurePosixPath

CONSTANTS: dict[str, Value] = {
    "os.sep": "/",
    "os.path.sep": "/",
    "os.curdir": ".",
    "os.pardir": "..",
    "os.linesep": "\n",
    "os.extsep": ".",
    "os.name": "posix",
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
    """Return what a dotted name of the library means, None when it is not known."""
    name = _SAME_AS.get(name, name)
    if name in CONSTANTS:
        return CONSTANTS[name]
    if name in FUNCTIONS:
        return Native(name)
    return Module(name) if name in _MODULES else None


def builtin(name: str) -> Value | None:
    """Return what a name means that needs no import, None when it is not known."""
    return Native(name) if name in FUNCTIONS and "." not in name else None


def method(owner: Value, name: str, node: ast.AST) -> Value:
    """Return an attribute of a value that is no module."""
    if is_path(owner):
        if name in _PATH_PROPERTIES:
            found = getattr(owner, name)
            return located(list(found) if name == "parents" else found, node)
        return Native(f"path.{name}", owner) if f"path.{name}" in FUNCTIONS else Unknown(f"Path.{name} is not known", node)
    for kind, known in _METHODS.items():
        if isinstance(owner, kind) and name in known:
            return Native(f"{kind.__name__}.{name}", owner)
    return Unknown(f"the attribute {name} is not known", node)


_PATH_PROPERTIES = frozenset({"parent", "parents", "name", "stem", "suffix", "suffixes", "parts"})
_PURE = frozenset(
    {
        "capitalize", "casefold", "count", "endswith", "find", "index", "isalpha", "isdigit", "isidentifier", "islower",
        "isspace", "isupper", "lower", "lstrip", "partition", "removeprefix", "removesuffix", "rfind", "rindex",
        "rpartition", "rsplit", "rstrip", "split", "splitlines", "startswith", "strip", "swapcase", "title", "upper",
    }
)  # fmt: skip
_METHODS: dict[type, frozenset[str]] = {
    str: _PURE | {"format", "join", "replace"},
    list: frozenset({"append", "extend", "insert", "remove", "pop", "sort", "reverse", "copy", "clear", "index", "count"}),
    dict: frozenset({"get", "items", "keys", "values", "update", "setdefault", "pop", "copy", "clear"}),
    set: frozenset({"add", "update", "discard", "remove", "union", "difference", "intersection", "copy", "clear"}),
    tuple: frozenset({"index", "count"}),
}


def call(program: Expressions, function: Native, arguments: list[Value], keywords: dict[str, Value], node: ast.Call) -> Value:
    """Return what a known function or method gives."""
    kind, _, name = function.name.partition(".")
    if function.name in FUNCTIONS:
        known = FUNCTIONS[function.name]
        owner = [] if function.owner is None else [function.owner]
        if function.name not in _TOLERANT:
            unknown = unknown_in([*owner, *arguments, *keywords.values()])
            if unknown:
                return unknown
        return located(known(program, node, *owner, *arguments, **keywords), node)
    if kind == "str":
        return _text_method(name, function.owner, arguments, keywords, node)
    return _container_method(program, name, function.owner, arguments, keywords, node)


def _text_method(name: str, owner: str, arguments: list[Value], keywords: dict[str, Value], node: ast.Call) -> Value:
    unknown = unknown_in([*arguments, *keywords.values()])
    if unknown:
        return unknown
    if name == "join" and sum(map(len, arguments[0])) + len(owner) * len(arguments[0]) > LONGEST:
        raise ValueError
    if name == "format":
        check_format(owner)
    if name in ("format", "replace"):
        check_size(owner, [*arguments, *keywords.values()])
    return located(getattr(str, name)(owner, *arguments, **keywords), node)


def _container_method(
    program: Expressions, name: str, owner: Value, arguments: list[Value], keywords: dict[str, Value], node: ast.Call
) -> Value:
    if isinstance(owner, list):
        return _list_method(program, name, owner, arguments, keywords, node)
    if isinstance(owner, dict):
        return _dict_method(program, name, owner, arguments, keywords, node)
    unknown = unknown_in([owner, *arguments])
    if unknown:
        return unknown
    if isinstance(owner, set):
        program.journal.touch(owner)
    return getattr(type(owner), name)(owner, *arguments)


def _list_method(
    program: Expressions,
    name: str,
    owner: list[Value],
    arguments: list[Value],
    keywords: dict[str, Value],
    node: ast.Call,
) -> Value:
    program.journal.touch(owner)
    if name == "append":
        owner.append(arguments[0])
        return None
    if name == "extend":
        owner += program.elements(arguments[0], node.args[0])
        return None
    if name == "copy":
        return owner.copy()
    if name in ("clear", "reverse"):
        getattr(owner, name)()
        return None
    if name == "sort":
        owner[:] = _sorted(program, node, owner, **keywords)
        return None
    if unknown_in([owner, *(arguments if name != "insert" else arguments[:1])]):
        program.taint(owner, node)
        return unknown_in([owner])
    return getattr(list, name)(owner, *arguments)


def _dict_method(
    program: Expressions,
    name: str,
    owner: dict[Value, Value],
    arguments: list[Value],
    keywords: dict[str, Value],
    node: ast.Call,
) -> Value:
    if name == "items":
        return list(owner.items())
    if name in ("keys", "values"):
        return list(getattr(owner, name)())
    program.journal.touch(owner)
    if name == "update":
        for more in [*arguments, keywords]:
            if isinstance(more, dict):
                owner.update(more)
            else:
                program.taint(owner, node)
        return None
    if name in ("copy", "clear"):
        return getattr(owner, name)()
    if not certain(arguments[0]):
        program.taint(owner, node)
        return unknown_in(arguments)
    return getattr(owner, name)(*arguments)


# --- functions. Each gets the program, the call, and its arguments


def _glob(program: Expressions, _: ast.Call, pathname: str, **options: Value) -> Value:
    hidden, recursive = bool(options.get("include_hidden")), bool(options.get("recursive"))
    root = options.get("root_dir")
    pattern = str(pathname)
    if root is None:
        paths = program.files.glob(pattern, recursive=recursive, hidden=hidden)
    else:
        start = posixpath.join(str(root), "")
        paths = [path.removeprefix(start) for path in program.files.glob(start + pattern, recursive=recursive, hidden=hidden)]
    return _globbed(pattern, paths)


def _path_glob(program: Expressions, _: ast.Call, owner: PurePosixPath, pattern: str) -> Value:
    whole = str(owner / pattern)
    paths = program.files.glob(whole, recursive=True, hidden=True)
    folders = pattern.endswith("**")
    return _globbed(whole, [path_of(path) for path in paths if not folders or program.files.is_folder(path)])


def _globbed(pattern: str, paths: list[Value]) -> Globbed:
    found = Globbed(paths)
    found.pattern = pattern
    return found


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
    raise LeaveError("raise")


def _elements(program: Expressions, node: ast.Call, *values: Value) -> list[Value]:
    return list(program.elements(values[0], node)) if values else []


def _sequence(program: Expressions, node: ast.Call, *values: Value) -> Value:
    found = _elements(program, node, *values)
    if values and isinstance(values[0], Globbed):
        return _globbed(values[0].pattern, found)
    return found


def _reversed(program: Expressions, node: ast.Call, values: Value) -> Value:
    return _elements(program, node, values)[::-1]


def _sorted(program: Expressions, node: ast.Call, values: Value, key: Value = None, reverse: Value = False) -> Value:
    found = _sequence(program, node, values)
    if all(map(certain, found)):
        keys = [item if key is None else program.call(key, [item], {}, node) for item in found]
        order = sorted(range(len(found)), key=keys.__getitem__, reverse=bool(reverse))
        found[:] = [found[index] for index in order]
    return found


def _tuple(program: Expressions, node: ast.Call, *values: Value) -> Value:
    return tuple(_elements(program, node, *values))


def _dict(_: Expressions, __: ast.Call, *values: Value, **more: Value) -> Value:
    found = dict(values[0]) if values else {}
    found.update(more)
    return found


def _chain(program: Expressions, node: ast.Call, *lists: Value) -> Value:
    return [item for values in lists for item in program.elements(values, node)]


def _chain_from(program: Expressions, node: ast.Call, lists: Value) -> Value:
    return _chain(program, node, *program.elements(lists, node))


def _product(_: Expressions, __: ast.Call, *lists: Value) -> Value:
    if prod(map(len, lists)) > LONGEST:
        raise ValueError
    return list(product(*lists))


def _sum(program: Expressions, node: ast.Call, lists: Value, start: Value = 0) -> Value:
    total = start
    for item in program.elements(lists, node):
        total = binary(ast.Add(), total, item.value if isinstance(item, Maybe) else item, node)
    return total


def _map(program: Expressions, node: ast.Call, function: Value, *lists: Value) -> Value:
    rows = zip(*(list(program.elements(values, node)) for values in lists), strict=False)
    return [program.call(function, list(row), {}, node) for row in rows]


def _filter(program: Expressions, node: ast.Call, function: Value, values: Value) -> Value:
    found: list[Value] = []
    for item in program.elements(values, node):
        kept = program.truth(item if function is None else program.call(function, [item], {}, node))
        if kept is not False:
            found.append(item if kept or isinstance(item, (Unknown, Maybe)) else Maybe(item))
    return found


def _plain(function: Callable[..., Any]) -> Callable[..., Value]:
    return lambda _program, _node, *arguments, **keywords: function(*arguments, **keywords)


def _on_texts(function: Callable[..., Any]) -> Callable[..., Value]:
    return lambda _program, _node, *paths: function(*(str(path) for path in paths))


def _isinstance(_: Expressions, __: ast.Call, value: Value, kinds: Value) -> bool:
    names = {kind.name for kind in (kinds if isinstance(kinds, tuple) and not isinstance(kinds, Native) else (kinds,))}
    return any(kind.__name__ in names for kind in type(value).__mro__)


FUNCTIONS: dict[str, Callable[..., Value]] = {
    "os.path.join": _on_texts(posixpath.join),
    "os.path.basename": _on_texts(posixpath.basename),
    "os.path.dirname": _on_texts(posixpath.dirname),
    "os.path.splitext": _on_texts(posixpath.splitext),
    "os.path.split": _on_texts(posixpath.split),
    "os.path.normpath": _on_texts(posixpath.normpath),
    "os.path.isabs": _on_texts(posixpath.isabs),
    "os.path.abspath": _on_texts(lambda path: posixpath.normpath(posixpath.join(ROOT, path))),
    "os.path.relpath": _relative,
    "os.path.exists": lambda program, _, path: program.files.exists(str(path)),
    "os.path.isfile": lambda program, _, path: program.files.is_file(str(path)),
    "os.path.isdir": lambda program, _, path: program.files.is_folder(str(path)),
    "os.fspath": _on_texts(str),
    "os.getcwd": lambda *_: ROOT,
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
    "path.joinpath": lambda _, __, owner, *parts: owner.joinpath(*parts),
    "path.relative_to": lambda _, __, owner, *parts: owner.relative_to(*parts),
    "path.with_suffix": lambda _, __, owner, suffix: owner.with_suffix(suffix),
    "path.with_name": lambda _, __, owner, name: owner.with_name(name),
    "path.match": lambda _, __, owner, pattern: owner.match(pattern),
    "path.is_absolute": lambda _, __, owner: owner.is_absolute(),
    "setuptools.find_packages": _find_packages(namespaces=False),
    "setuptools.find_namespace_packages": _find_packages(namespaces=True),
    "itertools.chain": _chain,
    "itertools.chain.from_iterable": _chain_from,
    "itertools.product": _product,
    "sys.exit": _exit,
    "exit": _exit,
    "quit": _exit,
    "print": _ignore,
    "os.makedirs": _ignore,
    "os.mkdir": _ignore,
    "list": _sequence,
    "sorted": _sorted,
    "reversed": _reversed,
    "iter": _sequence,
    "tuple": _tuple,
    "dict": _dict,
    "map": _map,
    "filter": _filter,
    "sum": _sum,
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
