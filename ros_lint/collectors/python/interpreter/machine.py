"""The interpreter of Python modules and calls: it evaluates programs symbolically and runs nothing.

It interprets launch files. A subclass interprets setup.py and treats unknown values differently.

If a condition is unknown, both branches are interpreted, each under its condition. A name with different values in the
branches gets both values as alternatives. The number of steps, the depth of calls and the size of values are limited;
values beyond the limits are unknown.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress

from ros_lint.base.budget import Budget, BudgetExceeded
from ros_lint.base.paths import parent
from ros_lint.collectors.conditional_text import joined
from ros_lint.collectors.python.interpreter.alternatives import guarded_text, plain, union
from ros_lint.collectors.python.interpreter.branches import LEAVE
from ros_lint.collectors.python.interpreter.builtins import BUILTINS
from ros_lint.collectors.python.interpreter.expressions import EVALUATE
from ros_lint.collectors.python.interpreter.methods import call_method
from ros_lint.collectors.python.interpreter.operations import text_of
from ros_lint.collectors.python.interpreter.protocol import Interpreter, Library
from ros_lint.collectors.python.interpreter.recorder import How, Misused, are_unknown
from ros_lint.collectors.python.interpreter.repeated_calls import UnderWay, begin
from ros_lint.collectors.python.interpreter.statements import execute
from ros_lint.collectors.python.interpreter.values import (
    PERHAPS,
    PLAIN_BASES,
    Bound,
    Class,
    FilePath,
    Frame,
    Function,
    Guarded,
    Instance,
    LaunchObject,
    LibraryName,
    Method,
    Modules,
    ProgramRaised,
    Source,
    Super,
    Unknown,
    Value,
    settled,
)
from ros_lint.collectors.python.syntax import placed
from ros_lint.collectors.python.versions import STANDARD_LIBRARY
from ros_lint.collectors.symbolic_text import UNKNOWN, is_settled, join_path
from ros_lint.facts.launch import LaunchCondition

STEPS = 150_000
_STEPS_A_CALL = 60_000
_STEPS_AFTER_A_CALL = 1_000
"""The number of steps that remain for the caller of a function if the function takes too many steps."""
_DEEPEST_CALL = 40

_Definition = ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda


class Machine(Interpreter):
    """Interprets one program, that is, a launch file or a setup.py, and the modules of the workspace that it imports."""

    def __init__(self, modules: Modules, files: Callable[[str], Value], library: Library) -> None:
        """Create an interpreter for one program.

        ``modules`` returns the source and the syntax tree of a module of the workspace, ``files`` the content of a file of the
        workspace. ``library`` has the models of all other modules.
        """
        super().__init__(library, Budget(STEPS))
        self._modules = modules
        self._files = files
        self._sources: dict[str, Source | None] = {}
        self._placed: dict[tuple[int, int], tuple[_Definition, ast.AST, ast.AST]] = {}
        self._under_way: list[UnderWay] = []

    # --- bounds and conditions ------------------------------------------------------------------------------------

    def grant(self) -> None:
        """Allow further steps, so that results can be evaluated after the program has used up its steps."""
        self.budget = Budget(STEPS // 4)

    @contextmanager
    def under(self, *conditions: LaunchCondition) -> Iterator[None]:
        """Return a context manager for the interpretation of code that runs only if ``conditions`` hold.

        Conditions of enclosing ``with`` blocks also apply.
        """
        before = self.conditions
        self.conditions = (*before, *conditions)
        try:
            yield
        finally:
            self.conditions = before

    # --- modules --------------------------------------------------------------------------------------------------

    def run(self, tree: ast.Module, source: Source) -> Frame:
        """Interpret the statements of a module, and return its frame: the names that the statements bind, with their values."""
        frame = Frame(source, None, source.names)
        source.names.setdefault("__name__", "launch_file")
        with suppress(ProgramRaised):
            execute(self, tree.body, frame)
        frame.names.settle()
        source.names = frame.names
        return frame

    def module(self, name: str, importer: Source, at: ast.stmt) -> Source | None:
        """Return the interpreted module that the import statement ``at`` names, None if the module cannot be interpreted.

        Each module is interpreted once. A module of a released package is replaced by a short program with the same effects, if
        :meth:`Library.model` returns a program for the module.
        """
        top = name.partition(".")[0]
        known = top in STANDARD_LIBRARY or self.library.describes(top)
        key = f"{importer.text.path}:{name}" if name.startswith(".") else name
        if key in self._sources:
            return self._sources[key]
        self._sources[key] = None  # while it is interpreted, because modules may import each other
        module = None if known else self._modules(name, importer.text)
        if module is not None:
            source = self._sources[key] = Source(module.text)
            if parent(module.text.path) != parent(importer.text.path) or "__file__" in importer.names:
                source.names["__file__"] = UNKNOWN  # only paths relative to the folder of the program are known
            self.run(module.tree, source)
            return source
        if not known:
            self.wanted.add(name)
        model = self.library.model(name, at)
        if model is not None:
            self.borrows = True
            source = self._sources[key] = Source(importer.text, lent=True)
            self.run(model, source)
        return self._sources[key]

    def _lent(self, function: Function, call: ast.Call, caller: Source) -> tuple[_Definition, Source]:
        """Return a copy of a function of a released module, and the module that contains ``call``.

        All syntax nodes of the copy have the position of ``call``, so that findings about the function are reported at the call.
        """
        key = id(function.node), id(call)
        if key not in self._placed:
            self.budget.step(100)
            self._placed[key] = (
                placed(function.node, call),
                function.node,
                call,
            )  # keeps the objects alive, so that no other object gets their ids
        source = function.frame.source
        return self._placed[key][0], source if source.text is caller.text else Source(caller.text, lent=True)

    # --- statements -----------------------------------------------------------------------------------------------

    def evaluate(self, node: ast.expr, frame: Frame) -> Value:
        """Return the value of an expression. Raises ProgramRaised and BudgetExceeded."""
        self.budget.step()
        return EVALUATE[type(node)](self, node, frame)

    def execute(self, body: Sequence[ast.stmt], frame: Frame) -> int:
        """Interpret statements, and return how they end: NEXT, CONTINUE, BREAK or LEAVE.

        Raises ProgramRaised and BudgetExceeded.
        """
        return execute(self, body, frame)

    def function(self, node: ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda, frame: Frame) -> Function:
        """Return the function that a definition or a lambda creates, with the values of its default arguments."""
        function = Function(node, frame)
        function.defaults = [self.evaluate(default, frame) for default in node.args.defaults]
        for argument, default in zip(node.args.kwonlyargs, node.args.kw_defaults, strict=True):
            if default is not None:
                function.keyword_defaults[argument.arg] = self.evaluate(default, frame)
        return function

    # --- calls ----------------------------------------------------------------------------------------------------

    def builtin(self, node: ast.Name, frame: Frame) -> Value:
        """Return the value of a name that the program does not bind, and record the name as unbound if it is not builtin."""
        if node.id == "__file__":
            return BUILTINS["__file__"]
        if node.id in BUILTINS:
            return LibraryName(f"builtins.{node.id}")
        self.unbound.append((node, frame.source))
        # Python raises NameError here, but the intended meaning is mostly obvious.
        return LibraryName(node.id)

    def call(self, function: Value, arguments: list[Value], keywords: dict[str, Value], node: ast.Call, frame: Frame) -> Value:
        """Return the result of calling ``function``, which may be a function, class or method of the program or of a library."""
        self.budget.step()
        if isinstance(function, LibraryName):
            return self._call_library(function, arguments, keywords, node, frame)
        if isinstance(function, Method):
            if isinstance(function.owner, LaunchObject):
                return self.library.call(self, function, arguments, keywords, node, frame)
            return call_method(self, function, arguments, keywords, node, frame)
        if isinstance(function, Function):
            try:
                return self._run_function(function, arguments, keywords, node, frame)
            except ProgramRaised:
                if function.frame.source is frame.source:
                    raise
                # The model or the interpretation of the function is more likely to be wrong than the program.
                self.escape([arguments, keywords])
                return Unknown(f"{getattr(function.node, 'name', 'a function')}() cannot be followed")
        if isinstance(function, Bound):
            return self._run_bound(function, arguments, keywords, node, frame)
        if isinstance(function, Class):
            return self._make(function, arguments, keywords, node, frame)
        self.escape([arguments, keywords])
        return Unknown("the result of a call that cannot be followed")

    def _call_library(
        self, function: LibraryName, arguments: list[Value], keywords: dict[str, Value], node: ast.Call, frame: Frame
    ) -> Value:
        if function.name == "builtins.super" and (of_object := _super(arguments, frame)) is not None:
            return of_object
        cls, _, method = function.name.rpartition(".")
        if method == "__init__" and arguments and isinstance(arguments[0], Instance):
            self._initialize(arguments[0], cls, arguments[1:], keywords, node, frame)
            return None
        return self.library.call(self, function.name, arguments, keywords, node, frame)

    def _initialize(
        self, instance: Instance, base: str, arguments: list[Value], keywords: dict[str, Value], node: ast.Call, frame: Frame
    ) -> None:
        """Create an object of the library class ``base``, which is a base class of the class of ``instance``, and store it."""
        result = self.library.call(self, base, arguments, keywords, node, frame)
        instance.made = result if isinstance(result, LaunchObject) else None

    def _run_bound(self, bound: Bound, arguments: list[Value], keywords: dict[str, Value], node: ast.Call, frame: Frame) -> Value:
        kept = {name: value for name, value in bound.keywords.items() if name}
        return self.call(bound.function, [*bound.arguments, *arguments], {**kept, **keywords}, node, frame)

    def _make(self, cls: Class, arguments: list[Value], keywords: dict[str, Value], node: ast.Call, frame: Frame) -> Value:
        made = Instance(cls, self.conditions)
        init = cls.find("__init__")
        if isinstance(init, Function):
            self._run_function(init, [made, *arguments], keywords, node, frame)
        base = cls.library_base()
        if made.made is None and base is not None and base.last not in PLAIN_BASES:
            self._initialize(made, base.name, arguments, keywords, node, frame)
        if not isinstance(init, Function):
            for name, value in zip(cls.fields, arguments, strict=False):
                made.attributes[name] = value
            made.attributes.update({name: value for name, value in keywords.items() if name in cls.fields})
        return made

    def _run_function(
        self, function: Function, arguments: list[Value], keywords: dict[str, Value], call: ast.Call, caller: Frame
    ) -> Value:
        node, source = function.node, function.frame.source
        if source.lent:
            node, source = self._lent(function, call, caller.source)
        if len(self._under_way) >= _DEEPEST_CALL:
            return self._cut_off("calls that are nested too deeply", arguments, keywords, call, caller)
        frame = Frame(source, function.frame, function.taking(arguments, keywords))
        if not begin(self._under_way, function, frame.names, self):
            self.escape([arguments, keywords])
            return Unknown(f"the result of {getattr(node, 'name', 'a function')}() within itself")
        if isinstance(node, ast.Lambda):
            try:
                return self.evaluate(node.body, frame)
            finally:
                self._under_way.pop()
        before, budget, made = self.conditions, self.budget, len(self.made)
        allowed = min(budget.steps, _STEPS_A_CALL)
        if budget.steps >= 2 * _STEPS_AFTER_A_CALL:
            allowed = min(allowed, budget.steps - _STEPS_AFTER_A_CALL)
        self.budget = Budget(allowed)
        signal: int | None
        try:
            signal = execute(self, node.body, frame)
        except BudgetExceeded:
            if budget.steps <= allowed:
                raise
            signal = None
        except ProgramRaised:
            if not frame.returned:
                raise
            signal = LEAVE  # this branch raises, but another one returned
        finally:
            self._under_way.pop()
            budget.steps -= allowed - self.budget.steps
            self.budget = budget
            self.conditions = before
        if signal is None:
            for launch_object in self.made[made:]:
                launch_object.escaped = True
            return self._cut_off("a call that takes too many steps", arguments, keywords, call, caller)
        if frame.source.yields and function.yields():
            return frame.yielded
        if signal != LEAVE and frame.returned:
            frame.returned.append(Guarded(None, (PERHAPS,)))
        if not frame.returned:
            return None
        if len(frame.returned) == 1:
            return frame.returned[0].value
        count = len(before)
        return self.joined([Guarded(returned.value, returned.conditions[count:]) for returned in frame.returned])

    def _cut_off(self, what: str, arguments: list[Value], keywords: dict[str, Value], call: ast.Call, caller: Frame) -> Unknown:
        """Record that the interpretation of a call ended early, and the statement at which it ended. Return Unknown."""
        node, source = self.stopped_at or (call, caller.source)
        self.cut_off.append((what, node, source))
        self.stopped_at = None
        self.escape([arguments, keywords])
        return Unknown("")  # the call is recorded already

    # --- what the library needs -----------------------------------------------------------------------------------

    def join_paths(self, left: Value, right: Sequence[Value], node: ast.expr, frame: Frame) -> Value:
        """Return the joined path of ``left / right`` or ``left.joinpath(*right)``.

        The result is a PathJoinSubstitution if a part is a substitution of launch, else a path of pathlib.
        """
        if isinstance(left, LaunchObject) or any(isinstance(plain(part), LaunchObject) for part in right):
            call = node if isinstance(node, ast.Call) else ast.Call(node, [], [])
            ast.copy_location(call, node)
            return LaunchObject("PathJoinSubstitution", [[left, *right]], {}, call, frame.source)
        rows = [text_of(left), *[text_of(part) for part in right]]
        texts = joined(rows, join_path)
        return union(guarded_text(text, FilePath(text)) for text in texts)

    def open_file(self, path: str, at: ast.expr, source: Source) -> Value:
        """Record that the program opens a file, and return its content, Unknown if the file is not in the workspace."""
        if not self.guarded and not path.isascii():
            self.opened.append((path, at, source, self.conditions))
        unknown = Unknown(f"the content of {path.rpartition('/')[2] or 'a file'}")
        paths = self.library.with_defaults(self, path)
        if len(paths) != 1 or not is_settled(paths[0]):
            return unknown
        content = self._files(paths[0])
        if content is None:
            self.wanted.add(paths[0])
            return unknown
        # The caller of the launch file can pass another path.
        return content if paths[0] == path else union([Guarded(content, (PERHAPS,)), Guarded(unknown, (PERHAPS,))])

    def result(self, value: Value, operands: Iterable[Value]) -> Value:  # noqa: ARG002
        return value

    def texts(self, value: Value) -> tuple[str, ...]:
        return self.library.texts(value, self.budget)

    def record_misuse(self, value: Value, how: How, node: ast.expr, frame: Frame) -> None:
        if isinstance(value, LaunchObject) and (misuse := self.library.misuse(value, how)) and not are_unknown(self.conditions):
            self.misused.append(Misused(misuse, value, node, frame.source))

    def record_division(self, node: ast.expr, frame: Frame) -> None:
        if not are_unknown(self.conditions):
            self.divided.append((node, frame.source))


def _super(arguments: list[Value], frame: Frame) -> Super | None:
    """Return the value of ``super()`` or ``super(cls, instance)``, None if its class or its object is unknown."""
    cls = plain(arguments[0]) if len(arguments) == 2 else settled(frame.names.get("__class__"))
    if not isinstance(cls, Class):
        return None
    objects = (plain(settled(value)) for value in (arguments[1:] or frame.names.values()))
    instance = next((value for value in objects if isinstance(value, Instance) and value.cls.derives_from(cls)), None)
    return Super(cls, instance) if instance is not None else None
