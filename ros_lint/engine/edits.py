"""Apply edits to texts, and write files atomically."""

from __future__ import annotations

import os
import re
import tempfile
import time
from bisect import bisect_left, bisect_right, insort
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from functools import partial
from itertools import groupby
from typing import TypeAlias

from ros_lint.analysis.finding import Fix
from ros_lint.base import files
from ros_lint.base.edit import Edit
from ros_lint.base.text import Span, Text, read
from ros_lint.base.tree import Tree


class EditError(Exception):
    """A file cannot be edited or written. The message names the file.

    ``written`` lists the files that were written before the error.
    """

    def __init__(self, message: str, written: Sequence[str] = ()) -> None:
        super().__init__(message)
        self.written = tuple(written)


def choose(fixes: Iterable[Fix]) -> tuple[Fix, ...]:
    """Return fixes that can be applied together, in order.

    A fix whose edits overlap those of an earlier returned fix is left out.
    """
    chosen: list[Fix] = []
    chosen_edits: set[Edit] = set()
    places: dict[str, _Places] = {}
    for fix in fixes:
        new = [edit.span for edit in fix.edits if edit not in chosen_edits]
        if any(span.path in places and places[span.path].collides(span) for span in new):
            continue
        chosen.append(fix)
        chosen_edits.update(fix.edits)
        for span in new:
            places.setdefault(span.path, _Places()).add(span)
    return tuple(chosen)


_Position: TypeAlias = tuple[int, int]
"""A line and a column."""


class _Places:
    """The places of edits in a file that do not overlap."""

    def __init__(self) -> None:
        self._points: list[_Position] = []
        """The places of insertions, sorted."""
        self._ranges: list[tuple[_Position, _Position]] = []
        """The start and end of each replaced text, sorted."""

    def add(self, span: Span) -> None:
        start, end = span[1:3], span[3:]
        if start == end:
            insort(self._points, start)
        else:
            insort(self._ranges, (start, end))

    def collides(self, span: Span) -> bool:
        """Return whether a place overlaps one of these places. An insertion at the start or end of a range does not."""
        start, end = span[1:3], span[3:]
        before = bisect_left(self._ranges, (end,))
        if before and self._ranges[before - 1][1] > start:
            return True
        return start < end and bisect_right(self._points, start) < bisect_left(self._points, end)


def apply(fixes: Iterable[Fix], texts: Callable[[str], Text]) -> dict[str, str]:
    """Return the new text of each file that the fixes change, by path. The fixes must not overlap, see :func:`choose`.

    ``texts`` returns the text of a file by path. Raises EditError if a file has fewer lines than an edit assumes.
    """
    edits: dict[str, list[Edit]] = {}
    for edit in dict.fromkeys(edit for fix in fixes for edit in fix.edits):
        edits.setdefault(edit.span.path, []).append(edit)
    return {path: _apply_to(texts(path), in_file) for path, in_file in sorted(edits.items())}


def text_of(tree: Tree, path: str) -> Text:
    """Return the text of a file to edit; an empty text if the file does not exist.

    Raises EditError if the file cannot be read.
    """
    try:
        return read(path, tree.read(path))
    except FileNotFoundError:
        return Text(path, "")
    except OSError as error:
        raise EditError(f"{path}: cannot be read: {error.strerror or error}") from error


def encode(changed: Mapping[str, str], texts: Callable[[str], Text]) -> dict[str, bytes]:
    """Return changed texts as bytes, each in the encoding of its file. ``texts`` returns the unchanged text of a file by path.

    Raises EditError if an encoding lacks a character of the text.
    """
    result = {}
    for path, text in changed.items():
        try:
            result[path] = texts(path).encode(text)
        except UnicodeEncodeError as error:
            raise EditError(f"{path}: its encoding {error.encoding} cannot represent {text[error.start]!r}") from error
    return result


def write(path: str, data: bytes) -> None:
    """Replace or create a file atomically. A FIFO or a device is written directly.

    Raises EditError if the file cannot be written.
    """
    try:
        if os.path.exists(path) and not os.path.isfile(path):
            with open(path, "wb") as stream:
                stream.write(data)
            return
    except OSError as error:
        raise _write_error(path, error) from error
    target = os.path.realpath(path)
    _check_writable(path, target)
    _replace(path, target, data)


def write_all(base: str, changed: Mapping[str, bytes], before: Mapping[str, bytes]) -> None:
    """Replace or create files, each of them atomically. ``changed`` has the new contents by path relative to ``base``.

    ``before`` has the contents that the existing files had when ``changed`` was computed. Raises EditError if a file cannot
    be written or no longer has these contents. All files are checked before the first is written.
    """
    targets = {path: os.path.realpath(os.path.join(base, path)) for path in changed}
    for path, target in targets.items():
        _check_writable(path, target)
        if not _has_content(target, before.get(path)):
            raise EditError(f"{path}: {_CHANGED}; nothing was changed")
    written: list[str] = []
    for path, data in changed.items():
        try:
            _replace(path, targets[path], data, partial(_has_content, targets[path], before.get(path)))
        except EditError as error:
            unwritten = [pending_path for pending_path in changed if pending_path not in written]
            raise EditError(f"{error}; {_written_so_far(written, unwritten)}", written) from error
        written.append(path)


_CHANGED = "changed since it was read; fix skipped"


def _written_so_far(written: Sequence[str], unwritten: Sequence[str]) -> str:
    if not written:
        return "nothing was changed"
    return f"written already: {', '.join(written)}; not written: {', '.join(unwritten)}"


def _has_content(target: str, before: bytes | None) -> bool:
    """Return whether a file has the content ``before``. None as ``before`` means that the file does not exist."""
    try:
        return files.read(target) == before
    except FileNotFoundError:
        return before is None
    except OSError:
        return False


def _write_error(path: str, error: OSError) -> EditError:
    return EditError(f"{path}: cannot be written: {error.strerror or error}")


def _check_writable(path: str, target: str) -> None:
    """Raise EditError if the file ``target`` cannot be replaced. ``path`` is the path of the file in the message."""
    # The permission bits are checked, too, because root may write everywhere.
    folder = os.path.dirname(target)
    try:
        for place in (target, folder) if os.path.lexists(target) else (folder,):
            if not os.stat(place).st_mode & 0o222:
                raise EditError(f"{path}: cannot be written: it is read-only; nothing was changed")
    except OSError as error:
        raise EditError(f"{_write_error(path, error)}; nothing was changed") from error
    if not os.access(folder, os.W_OK | os.X_OK):
        raise EditError(f"{path}: cannot be written: no permission to write to its folder; nothing was changed")


def _replace(path: str, target: str, data: bytes, may_replace: Callable[[], bool] = lambda: True) -> None:
    """Replace a file: write a temporary file in the folder of ``target`` and rename it.

    Symbolic links, permissions and extended attributes are kept, and the owner if this process may set it. Another hard link to
    the file keeps the former content.

    ``may_replace`` is called just before the renaming; if it returns False, the target is not replaced. Raises EditError,
    with the target unchanged.
    """
    folder = os.path.dirname(target)
    temporary = ""
    try:
        _remove_leftovers(folder)
        handle, temporary = tempfile.mkstemp(prefix=_PREFIX, suffix=_SUFFIX, dir=folder)
        with os.fdopen(handle, "wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        _copy_attributes(target, temporary)
        if not may_replace():
            raise EditError(f"{path}: {_CHANGED}")
        os.replace(temporary, target)
        temporary = ""
    except OSError as error:
        raise _write_error(path, error) from error
    finally:
        if temporary:
            with suppress(OSError):
                os.unlink(temporary)


def _copy_attributes(target: str, temporary: str) -> None:
    """Give a new file the owner, permissions and extended attributes of ``target``, or usual permissions if it does not exist."""
    if not os.path.exists(target):
        os.chmod(temporary, _NEW_MODE)
        return
    status = os.stat(target)
    with suppress(OSError, AttributeError):  # no permission, or not supported by the operating system
        os.chown(temporary, status.st_uid, status.st_gid)
    os.chmod(temporary, status.st_mode & 0o7777)
    with suppress(OSError, AttributeError):
        for name in os.listxattr(target):
            os.setxattr(temporary, name, os.getxattr(target, name))


_PREFIX, _SUFFIX = ".ros-lint-", ".part"
_TEMPORARY_NAME = re.compile(rf"{re.escape(_PREFIX)}[a-z0-9_]{{8}}{re.escape(_SUFFIX)}")
_ABANDONED_AGE = 3600
"""Age in seconds from which a temporary file is certainly not in use by a running process."""
_NEW_MODE = 0o644


def _remove_leftovers(folder: str) -> None:
    """Delete the temporary files that killed runs have left in a folder."""
    with os.scandir(folder) as entries:
        leftovers = [entry for entry in entries if _TEMPORARY_NAME.fullmatch(entry.name) and entry.is_file(follow_symlinks=False)]
    for entry in leftovers:
        with suppress(OSError):
            if time.time() - entry.stat().st_mtime > _ABANDONED_AGE:
                os.unlink(entry.path)


def _apply_to(source: Text, edits: Sequence[Edit]) -> str:
    text = source.text
    by_return = "\r\n" in text
    in_order = sorted(edits, key=lambda edit: (edit.span[1:], edit.kind, edit.order))
    if any(edit.span.end_line > source.line_count for edit in in_order):
        raise EditError(f"{source.path}: {_CHANGED}")
    # From the end, so that earlier offsets stay valid.
    for span, at_place in reversed([(span, list(group)) for span, group in groupby(in_order, lambda edit: edit.span)]):
        start = source.offset(span.line, span.column)
        end = source.offset(span.end_line, span.end_column)
        replacement = _indented(_joined(at_place), text, start)
        if by_return and _ends_with_return(text, start):
            replacement = replacement.replace("\r\n", "\n").replace("\n", "\r\n")
        if not replacement:
            end = _with_blank_line(text, start, end)
        text = text[:start] + replacement + text[end:]
    return text


_BLANK_BEFORE = re.compile(r"(?:\A|\n)[ \t]*\r?\n\Z")
_BLANK_AFTER = re.compile(r"[ \t]*\r?\n")


def _with_blank_line(text: str, start: int, end: int) -> int:
    """Return the end of the text to remove from ``start`` to ``end``, with the blank line after it if it is one too many.

    This is the case if whole lines are removed between two blank lines, such as all dependencies of a group.
    """
    after = _BLANK_AFTER.match(text, end)
    removes_lines = start < end and text[end - 1] == "\n"
    return after.end() if after and removes_lines and _BLANK_BEFORE.search(text, max(0, start - 200), start) else end


def _ends_with_return(text: str, start: int) -> bool:
    """Return whether the line at an offset ends with CR LF. For the last line, the end of the line before it counts."""
    end = text.find("\n", start)
    end = end if end >= 0 else text.rfind("\n", 0, start)
    return end > 0 and text[end - 1] == "\r"


def _indented(replacement: str, text: str, start: int) -> str:
    """Return the text to insert at ``start``, its spaces replaced by tabs if the line at ``start`` is indented with tabs."""
    line = text[text.rfind("\n", 0, start) + 1 : start]
    indent = line[: len(line) - len(line.lstrip(" \t"))]
    return replacement.replace(f"\n{' ' * len(indent)}", f"\n{indent}") if "\t" in indent else replacement


_BLANK = re.compile(r"\r\n|\n|\r")


def _joined(edits: Sequence[Edit]) -> str:
    """Return the joined text of several edits at the same place, without double blank lines."""
    result, kind = "", 0
    for edit in edits:
        text, same_group = edit.text, edit.kind == kind != 0
        blank_line = _BLANK.match(text)
        if result and edit.span.column == 1 and blank_line and (same_group or _ends_with_blank_line(result)):
            text = text[blank_line.end() :]
        elif same_group and _ends_with_blank_line(result):
            result = result[: len(result) - 2 if result.endswith("\r\n") else -1]
        result += text
        kind = edit.kind
    return result


def _ends_with_blank_line(text: str) -> bool:
    return text.endswith(("\n\n", "\r\n\r\n", "\r\r"))
