"""Models of functions of os.path and classes of pathlib whose results depend only on the path, not on the files that exist."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from ros_lint.collectors.conditional_text import joined
from ros_lint.collectors.python.interpreter.alternatives import guarded_text, union
from ros_lint.collectors.python.interpreter.calls import LibraryCall, Rule
from ros_lint.collectors.python.interpreter.path_functions import normalized, split, split_suffix
from ros_lint.collectors.python.interpreter.values import (
    FilePath,
    Value,
)
from ros_lint.collectors.symbolic_text import join_path


def _join(call: LibraryCall) -> Value:
    for argument in call.arguments:
        call.machine.record_misuse(argument, "joined", call.node, call.frame)
    rows = [call.texts(position) for position in range(len(call.arguments))]
    return call.result(joined(rows, join_path))


def on_path(function: Callable[[str], str]) -> Rule:
    """Return a function that computes the result of a call such as ``os.path.dirname(path)`` in an interpreted program.

    ``function`` computes the result for one path, which may have parts that are known only at launch.
    """
    return lambda call: call.result(joined([call.texts(0)], lambda row: function(row[0])))


def _split(function: Callable[[str], tuple[str, ...]]) -> Rule:
    return lambda call: union(guarded_text(text, function(text)) for text in call.texts(0))


def new_path(call: LibraryCall) -> Value:
    """Model of ``pathlib.Path()``: return the path that joins all arguments."""
    rows = [call.texts(position) for position in range(len(call.arguments))]
    paths = joined(rows, join_path) if rows else (".",)
    return union(guarded_text(text, FilePath(text)) for text in paths)


PATH_FUNCTIONS: Mapping[str, Rule] = {
    "os.path.join": _join,
    "os.path.basename": on_path(lambda path: split(path)[1]),
    "os.path.dirname": on_path(lambda path: split(path)[0]),
    "os.path.normpath": on_path(normalized),
    "os.path.split": _split(split),
    "os.path.splitext": _split(split_suffix),
    "os.fspath": on_path(str),
    **dict.fromkeys(("pathlib.Path", "pathlib.PurePath", "pathlib.PosixPath", "pathlib.PurePosixPath"), new_path),
}
"""The models that compute the results of functions, by the full name of the function such as ``os.path.join``."""
