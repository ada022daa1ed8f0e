"""What the functions of Python and of the launch libraries return, as far as launch files need it."""

from __future__ import annotations

import ast
import posixpath
from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

from ros_lint.collectors import launch_text
from ros_lint.collectors.launch_py_methods import items, sort
from ros_lint.collectors.launch_py_objects import (
    Api,
    Bound,
    Class,
    FilePath,
    Guarded,
    Instance,
    Made,
    Method,
    Raised,
    Unknown,
    Value,
    alternatives,
    environment,
    plain,
    union,
    written,
)
from ros_lint.collectors.launch_text import OWN_FOLDER, UNKNOWN, joined

if TYPE_CHECKING:
    from ros_lint.collectors.launch_py_objects import Frame
    from ros_lint.collectors.launch_py_run import Machine


class Call:
    """A call of a library: whose it is, what it gets, where it stands."""

    __slots__ = ("arguments", "frame", "keywords", "machine", "name", "node")

    def __init__(
        self, machine: Machine, name: str, arguments: list[Value], keywords: dict[str, Value], node: ast.Call, frame: Frame
    ) -> None:
        self.machine = machine
        self.name = name
        self.arguments = arguments
        self.keywords = keywords
        self.node = node
        self.frame = frame

    def get(self, position: int, *names: str) -> Value:
        for name in names:
            if name in self.keywords:
                return self.keywords[name]
        return self.arguments[position] if position < len(self.arguments) else None

    def texts(self, position: int, *names: str) -> tuple[str, ...]:
        from ros_lint.collectors.launch_py_eval import text_of  # noqa: PLC0415  (they know each other)

        value = self.get(position, *names)
        return (UNKNOWN,) if value is None else text_of(value)

    def result(self, found: tuple[str, ...]) -> Value:
        if len(found) == 1:
            return written(found[0], self.node, self.frame.source)
        return union(written(one, self.node, self.frame.source) for one in found)

    def items(self, position: int) -> list[Value] | None:
        return items(self.machine, self.get(position))


Rule = Callable[[Call], Value]


def call_library(
    machine: Machine,
    what: str | Method,
    arguments: list[Value],
    keywords: dict[str, Value],
    node: ast.Call,
    frame: Frame,
) -> Value:
    """Return what a function of a library returns, or a method of what one made."""
    if isinstance(what, Method):
        return _method(Call(machine, what.name, arguments, keywords, node, frame), what.owner)
    call = Call(machine, what, arguments, keywords, node, frame)
    last = what.rpartition(".")[2]
    rule = _BY_NAME.get(what) or (_BY_LAST.get(last) if not what.startswith(("os.", "builtins.")) else None)
    if rule is not None:
        return rule(call)
    if last[:1].isupper():
        return _make(call, last)
    machine.lose([arguments, keywords])
    if "package" in keywords and "executable" in keywords:
        _make(call, "Node").lost = True  # by its name a function that makes one
    return Unknown("" if what.partition(".")[0] in _STANDARD else f"{last}() cannot be followed")


def _make(call: Call, name: str) -> Made:
    made = Made(name, call.arguments, call.keywords, call.node, call.frame.source)
    made.conditions = call.machine.conditions
    call.machine.made.append(made)
    if name == "LaunchDescription":
        entities = made.get(0, "initial_entities")
        found = items(call.machine, entities) if entities is not None else []
        made.entities = found if found is not None else [entities]
    elif name in ("FindPackageShare", "FindPackagePrefix", "FindPackage"):
        _note(call, made.get(0, "package"), made.written(0, "package"), eager=False)
    elif name == "ExecutableInPackage":
        _note(call, made.get(1, "package"), made.written(1, "package"), eager=False)
    elif name in ("MoveItConfigsBuilder", "ParameterBuilder"):
        _note_builder(call, made)
    return made


def _note_builder(call: Call, made: Made) -> None:
    """MoveIt's builders look a package up at once (reference, section G2.7)."""
    position = 1 if made.name == "MoveItConfigsBuilder" else 0
    given = made.get(position, "package_name")
    if given is not None:
        _note(call, given, made.written(position, "package_name"), eager=True)
    elif position:
        robots = made.get(0, "robot_name")
        names = tuple(f"{one.value}_moveit_config" for one in alternatives(robots) if isinstance(one.value, str))
        for name in names:
            _note(call, name, made.written(0, "robot_name"), eager=True)


def _note(call: Call, package: Value, at: ast.expr, eager: bool) -> None:
    source = call.frame.source
    for one in alternatives(package):
        node, where = getattr(one.value, "node", at), getattr(one.value, "source", source)
        if isinstance(one.value, str):
            call.machine.look_up(one.value, node, where, eager)


# --- methods of what was made --------------------------------------------------------------------------------------

_ADDS = frozenset({"add_action", "add_entity", "append"})


def _method(call: Call, owner: Made) -> Value:
    machine, name = call.machine, call.name
    if name in _ADDS and owner.name == "LaunchDescription":
        machine.spend(1)
        owner.entities.append(machine.guard(call.get(0, "action", "entity")))
        return None
    if name == "extend" and owner.name == "LaunchDescription":
        owner.entities += [machine.guard(one) for one in call.items(0) or [call.get(0)]]
        return None
    if name in ("perform", "toxml", "toprettyxml"):
        return call.result(machine.texts(owner))
    if name == "find" and owner.name in ("FindPackageShare", "FindPackagePrefix", "FindPackage"):
        return (_share if owner.name == "FindPackageShare" else _prefix)(call)
    if name == "evaluate":
        from ros_lint.collectors.launch_py_actions import conditions_of  # noqa: PLC0415

        found = conditions_of(machine, owner)
        return Unknown("a condition", found[0] if len(found) == 1 else None)
    if owner.name.endswith("Builder"):
        owner.keywords.update({f"{name}.{key}": value for key, value in call.keywords.items()})
        owner.keywords.update({f"{name}.{index}": value for index, value in enumerate(call.arguments)})
        return owner
    machine.lose([owner, call.arguments, call.keywords])
    return Unknown(f"{name}() of {owner.name}")


# --- packages, paths, environment ----------------------------------------------------------------------------------


def _share(call: Call) -> Value:
    given = call.get(0, "package_name", "package")
    _note(call, given, call.node.args[0] if call.node.args else call.node, eager=True)
    return call.result(tuple(launch_text.share(package) for package in call.texts(0, "package_name", "package")))


def _share_path(call: Call) -> Value:
    found = _share(call)
    return union(FilePath(str(one.value)) for one in alternatives(found))


def _prefix(call: Call) -> Value:
    given = call.get(0, "package_name", "package")
    _note(call, given, call.node.args[0] if call.node.args else call.node, eager=True)
    return call.result(tuple(launch_text.prefix(package) for package in call.texts(0, "package_name", "package")))


def _join(call: Call) -> Value:
    rows = [call.texts(position) for position in range(len(call.arguments))]
    return call.result(joined(rows, lambda row: posixpath.join("", *row)))


def _on_path(function: Callable[[str], str]) -> Rule:
    return lambda call: call.result(tuple(function(text) for text in call.texts(0)))


def _split(function: Callable[[str], tuple[str, ...]]) -> Rule:
    return lambda call: union(function(text) for text in call.texts(0))


def _path(call: Call) -> Value:
    rows = [call.texts(position) for position in range(len(call.arguments))]
    return union(FilePath(text) for text in (joined(rows, lambda row: posixpath.join("", *row)) if rows else (".",)))


def _variable(call: Call) -> Value:
    default = call.get(1, "default")
    names = call.texts(0, "key")
    if default is None and call.name != "os.environ":
        return Unknown("an environment variable")
    defaults = call.texts(1, "default") if default is not None else (None,)
    return call.result(tuple(environment(name, one) for name in names for one in defaults))


def _unknown_text(call: Call) -> Value:
    return written(UNKNOWN, call.node, call.frame.source)


def _unknown(call: Call) -> Value:
    call.machine.lose([call.arguments, call.keywords])
    return Unknown(f"{call.name.rpartition('.')[2]}()")


def _nothing(_: Call) -> Value:
    return None


def _first(call: Call) -> Value:
    return call.get(0)


# --- the launch context --------------------------------------------------------------------------------------------


def _perform(position: int) -> Rule:
    return lambda call: call.result(call.machine.texts(call.get(position)))


def _configured(call: Call) -> Value:
    default = call.get(1)
    defaults = call.texts(1) if default is not None else (None,)
    return call.result(tuple(launch_text.configuration(name, one) for name in call.texts(0) for one in defaults))


# --- Python --------------------------------------------------------------------------------------------------------


def _str(call: Call) -> Value:
    value = call.get(0)
    if isinstance(value, Made):
        return _unknown_text(call)
    return call.result(call.texts(0)) if value is not None or call.arguments else ""


def _number(kind: type) -> Rule:
    def rule(call: Call) -> Value:
        value = plain(call.get(0))
        if value is None and not call.arguments:
            return kind()
        try:
            if isinstance(value, (int, float, bool)) or (
                isinstance(value, str) and launch_text.is_plain(value) and len(value) < 50
            ):
                return kind(value)
        except (ValueError, OverflowError):
            raise Raised from None
        return Unknown("a number")

    return rule


def _bool(call: Call) -> Value:
    from ros_lint.collectors.launch_py_eval import truth  # noqa: PLC0415

    answer, condition = truth(call.machine, call.get(0))
    return answer if answer is not None else Unknown("a truth", condition)


def _list(call: Call) -> Value:
    if not call.arguments:
        return []
    found = call.items(0)
    return found if found is not None else _unknown(call)


def _tuple(call: Call) -> Value:
    found = _list(call)
    return tuple(found) if isinstance(found, list) else found


def _dict(call: Call) -> Value:
    from ros_lint.collectors.launch_py_methods import call_method  # noqa: PLC0415

    found: dict[Any, Value] = {}
    call_method(call.machine, Method(found, "update"), call.arguments, call.keywords, call.node, call.frame)
    return found


def _length(call: Call) -> Value:
    value = plain(call.get(0))
    if isinstance(value, (list, tuple, dict, set, range)) or (isinstance(value, str) and launch_text.is_plain(value)):
        return len(value)
    return Unknown("a length")


def _range(call: Call) -> Value:
    values = [plain(argument) for argument in call.arguments]
    if values and all(isinstance(value, int) for value in values):
        try:
            return range(*values)
        except (TypeError, ValueError):
            raise Raised from None
    return Unknown("a range")


def _enumerate(call: Call) -> Value:
    found = call.items(0)
    start = plain(call.get(1, "start")) or 0
    if found is None or not isinstance(start, int):
        return _unknown(call)
    return [_keep(one, partial(_pair, index)) for index, one in enumerate(found, start)]


def _pair(index: int, value: Value) -> Value:
    return (index, value)


def _keep(value: Value, function: Callable[[Value], Value]) -> Value:
    """Apply a function to a value inside of the conditions around it."""
    if isinstance(value, Guarded):
        return Guarded(_keep(value.value, function), value.conditions)
    return function(value)


def _zip(call: Call) -> Value:
    rows = [items(call.machine, argument) for argument in call.arguments]
    if any(row is None for row in rows):
        return _unknown(call)
    return [tuple(plain(one) for one in row) for row in zip(*(row or [] for row in rows), strict=False)]


def _sorted(call: Call) -> Value:
    found = call.items(0)
    if found is None:
        return _unknown(call)
    sort(found)
    return found


def _reversed(call: Call) -> Value:
    found = call.items(0)
    return found[::-1] if found is not None else _unknown(call)


def _map(call: Call) -> Value:
    rows = [items(call.machine, argument) for argument in call.arguments[1:]]
    if not rows or any(row is None for row in rows):
        return _unknown(call)
    return [
        call.machine.call(call.arguments[0], [plain(one) for one in row], {}, call.node, call.frame)
        for row in zip(*(row or [] for row in rows), strict=False)
    ]


def _filter(call: Call) -> Value:
    found = call.items(1)
    if found is None:
        return _unknown(call)
    from ros_lint.collectors.launch_py_eval import truth  # noqa: PLC0415

    kept = []
    for one in found:
        asked = call.machine.call(call.arguments[0], [plain(one)], {}, call.node, call.frame) if call.arguments[0] else one
        answer, condition = truth(call.machine, asked)
        if answer is not False:
            kept.append(one if answer else Guarded(one, (condition,)))
    return kept


def _any_all(wanted: bool) -> Rule:
    def rule(call: Call) -> Value:
        from ros_lint.collectors.launch_py_eval import truth  # noqa: PLC0415

        found = call.items(0)
        answers = [truth(call.machine, one)[0] for one in found] if found is not None else [None]
        if wanted in answers:
            return wanted
        return Unknown("any or all") if None in answers else not wanted

    return rule


def _extreme(function: Callable[[Any], Any]) -> Rule:
    def rule(call: Call) -> Value:
        found = call.items(0) if len(call.arguments) == 1 else call.arguments
        values = [plain(one) for one in found or ()]
        if values and all(isinstance(value, (int, float)) for value in values):
            return function(values)
        return Unknown("a number")

    return rule


def _isinstance(call: Call) -> Value:
    value, kind = plain(call.get(0)), plain(call.get(1))
    kinds = kind if isinstance(kind, tuple) else (kind,)
    names = {one.last for one in kinds if isinstance(one, Api)}
    if isinstance(value, (str, int, float, list, dict, tuple, type(None))) and len(names) == len(kinds):
        own = {"Written": "str", "NoneType": "NoneType"}.get(type(value).__name__, type(value).__name__)
        return own in names or (own == "bool" and "int" in names)
    if isinstance(value, Made) and len(names) == len(kinds):
        return value.name in names or (Unknown("a kind") if names & {"Action", "Substitution", "Entity"} else False)
    if isinstance(value, Instance):
        return any(isinstance(one, Class) and value.cls is one for one in kinds) or Unknown("a kind")
    return Unknown("a kind")


def _getattr(call: Call) -> Value:
    owner, name = plain(call.get(0)), plain(call.get(1))
    if isinstance(owner, Instance) and isinstance(name, str):
        if name in owner.attributes:
            return owner.attributes[name]
        found = owner.cls.find(name)
        if found is None and len(call.arguments) > 2:
            return call.arguments[2]
    return Unknown("an attribute")


def _open(call: Call) -> Value:
    found = call.texts(0, "file")
    return call.machine.open_file(found[0], call.node) if len(found) == 1 else Unknown("a file")


def _parsed(call: Call) -> Value:
    content = plain(call.get(0, "stream", "s"))
    if not isinstance(content, str) or not launch_text.is_plain(content):
        call.machine.lose(content)
        return Unknown("the content of a file")
    import yaml  # noqa: PLC0415  (takes 20 ms to import)

    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    try:
        return yaml.load(content, Loader=loader)  # noqa: S506  (one of the two safe loaders)
    except (yaml.YAMLError, ValueError, RecursionError):
        raise Raised from None


def _partial(call: Call) -> Value:
    return Bound(call.arguments[0], call.arguments[1:], call.keywords) if call.arguments else _unknown(call)


def _chain(call: Call) -> Value:
    found: list[Value] = []
    for argument in call.arguments:
        inner = items(call.machine, argument)
        if inner is None:
            return _unknown(call)
        found += inner
    return found


def _copied(call: Call) -> Value:
    value = plain(call.get(0))
    if isinstance(value, list):
        return list(value)
    return dict(value) if isinstance(value, dict) else value


def _expanded(call: Call) -> Value:
    """``xacro.process_file`` and its like read a file."""
    return _make(call, "Command") if call.arguments else _unknown(call)


def subscript_library(machine: Machine, owner: Value, key: Value) -> Value:
    """Return an element of something that a library has."""
    from ros_lint.collectors.launch_py_eval import text_of  # noqa: PLC0415

    if isinstance(owner, Api):
        if owner.name == "os.environ":
            return union(environment(name, None) for name in text_of(key))
        if owner.name == "context.launch_configurations":
            return union(launch_text.configuration(name) for name in text_of(key))
    if isinstance(owner, (Unknown, Api)):
        return Unknown("element of what is not known")
    machine.lose(owner)
    return Unknown("element of what is not known")


_STANDARD = frozenset(
    {
        "os", "sys", "shutil", "subprocess", "time", "random", "math", "json", "re", "tempfile", "datetime", "socket",
        "logging", "builtins", "platform", "getpass", "glob", "collections", "itertools", "functools", "string", "yaml",
        "numpy", "psutil", "argparse", "hashlib", "uuid", "stat", "signal", "threading", "warnings", "inspect", "ast",
    }
)  # fmt: skip
"""Modules whose functions return nothing that can be launched."""

BUILTINS: Mapping[str, Value] = {
    "__file__": f"{OWN_FOLDER}/{UNKNOWN}",
    **dict.fromkeys(
        (
            "str", "int", "float", "bool", "list", "dict", "tuple", "set", "frozenset", "len", "range", "enumerate", "zip",
            "sorted", "reversed", "map", "filter", "any", "all", "min", "max", "sum", "isinstance", "hasattr", "getattr",
            "setattr", "print", "open", "super", "next", "iter", "repr", "type", "locals", "globals", "vars", "input", "abs",
            "round", "format", "callable", "id", "hash", "object", "property", "staticmethod", "classmethod", "bytes",
            "exec", "eval", "dir", "chr", "ord", "divmod", "pow", "slice", "issubclass", "NotImplemented", "Ellipsis",
            "exit", "quit", "__name__", "__import__", "bytearray", "complex", "memoryview", "__doc__", "__debug__",
            "delattr", "hex", "oct", "bin", "ascii", "breakpoint", "help", "compile", "copyright", "credits", "license",
            "BaseException", "Exception", "ArithmeticError", "AssertionError", "AttributeError", "EnvironmentError",
            "EOFError", "FileExistsError", "FileNotFoundError", "ImportError", "IndexError", "IOError", "KeyError",
            "KeyboardInterrupt", "LookupError", "ModuleNotFoundError", "NameError", "NotADirectoryError",
            "NotImplementedError", "OSError", "OverflowError", "PermissionError", "RecursionError", "RuntimeError",
            "StopIteration", "SyntaxError", "SystemError", "SystemExit", "TimeoutError", "TypeError", "UnicodeError",
            "UnicodeDecodeError", "ValueError", "Warning", "UserWarning", "DeprecationWarning", "ZeroDivisionError",
        )
    ),
}  # fmt: skip
"""Names that Python binds."""

_BY_NAME: Mapping[str, Rule] = {
    "os.path.join": _join,
    "os.path.dirname": _on_path(posixpath.dirname),
    "os.path.basename": _on_path(posixpath.basename),
    "os.path.abspath": _on_path(str),
    "os.path.realpath": _on_path(str),
    "os.path.expanduser": _on_path(str),
    "os.path.expandvars": _on_path(str),
    "os.path.normpath": _on_path(posixpath.normpath),
    "os.path.split": _split(posixpath.split),
    "os.path.splitext": _split(posixpath.splitext),
    "os.fspath": _on_path(str),
    "os.getenv": _variable,
    "os.environ.get": _variable,
    "os.getcwd": _unknown_text,
    "os.makedirs": _nothing,
    "pathlib.Path": _path,
    "pathlib.PurePath": _path,
    "pathlib.PosixPath": _path,
    "pathlib.Path.cwd": lambda call: FilePath(UNKNOWN),
    "pathlib.Path.home": lambda call: FilePath(UNKNOWN),
    "context.launch_configurations.get": _configured,
    "context.perform_substitution": _perform(0),
    "yaml.safe_load": _parsed,
    "yaml.load": _parsed,
    "json.load": _parsed,
    "json.loads": _parsed,
    "functools.partial": _partial,
    "itertools.chain": _chain,
    "copy.copy": _copied,
    "copy.deepcopy": _copied,
    "collections.OrderedDict": _dict,
    "xacro.process_file": _expanded,
    "xacro.process": _expanded,
    "builtins.str": _str,
    "builtins.int": _number(int),
    "builtins.float": _number(float),
    "builtins.bool": _bool,
    "builtins.list": _list,
    "builtins.set": _list,
    "builtins.frozenset": _list,
    "builtins.tuple": _tuple,
    "builtins.dict": _dict,
    "builtins.len": _length,
    "builtins.range": _range,
    "builtins.enumerate": _enumerate,
    "builtins.zip": _zip,
    "builtins.sorted": _sorted,
    "builtins.reversed": _reversed,
    "builtins.map": _map,
    "builtins.filter": _filter,
    "builtins.any": _any_all(True),
    "builtins.all": _any_all(False),
    "builtins.min": _extreme(min),
    "builtins.max": _extreme(max),
    "builtins.sum": _extreme(sum),
    "builtins.isinstance": _isinstance,
    "builtins.getattr": _getattr,
    "builtins.print": _nothing,
    "builtins.open": _open,
    "builtins.repr": _unknown_text,
    "builtins.input": _unknown_text,
    "builtins.type": _unknown,
}

_BY_LAST: Mapping[str, Rule] = {
    "get_package_share_directory": _share,
    "get_package_share_path": _share_path,
    "get_package_prefix": _prefix,
    "get_packages_with_prefixes": lambda call: Api("installed packages"),
    "perform_substitutions": _perform(1),
    "normalize_to_list_of_substitutions": _first,
    "Path": _path,
}
