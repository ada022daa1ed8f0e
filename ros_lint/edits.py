"""Apply edits to texts, and write files whole or not at all."""

from __future__ import annotations

import os
import re
import tempfile
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import groupby

from ros_lint.rule import Edit, Fix
from ros_lint.text import Text, read
from ros_lint.tree import Tree


class EditError(Exception):
    """A file that cannot be written as wanted. The message names it."""


def choose(fixes: Iterable[Fix]) -> tuple[Fix, ...]:
    """Return the fixes that can be made together: one that touches the place of an earlier one is left for the next round."""
    chosen: list[Fix] = []
    taken: list[Edit] = []
    for fix in fixes:
        new = [edit for edit in fix.edits if edit not in taken]
        if any(_collide(edit, other) for edit in new for other in taken):
            continue
        chosen.append(fix)
        taken += new
    return tuple(chosen)


def apply(fixes: Iterable[Fix], texts: Callable[[str], Text]) -> dict[str, str]:
    """Return the new text of every file that changes. The fixes do not collide, see :func:`choose`."""
    edits: dict[str, list[Edit]] = {}
    for fix in fixes:
        for edit in fix.edits:
            in_file = edits.setdefault(edit.span.path, [])
            if edit not in in_file:
                in_file.append(edit)
    return {path: _apply_to(texts(path), in_file) for path, in_file in sorted(edits.items())}


def text_of(tree: Tree, path: str) -> Text:
    """Return the text of a file to edit, the empty text for one that an edit creates. Raises EditError for what is no file."""
    try:
        return read(path, tree.read(path))
    except FileNotFoundError:
        return Text(path, "")
    except OSError as error:
        raise EditError(f"{path}: cannot be read: {error.strerror or error}") from error


def encode(changed: Mapping[str, str], texts: Callable[[str], Text]) -> dict[str, bytes]:
    """Return the changed texts as bytes in each file's own encoding. Raises EditError."""
    result = {}
    for path, text in changed.items():
        try:
            result[path] = texts(path).encode(text)
        except UnicodeEncodeError as error:
            raise EditError(f"{path}: its encoding {error.encoding} cannot represent {text[error.start]!r}") from error
    return result


def write_all(base: str, changed: Mapping[str, bytes]) -> None:
    """Replace or create files, each in one step.

    Raises EditError; when a file is seen to be read-only, nothing is written at all.
    """
    for path in changed:
        _ask(path, os.path.realpath(os.path.join(base, path)))
    for path, data in changed.items():
        _write(path, os.path.realpath(os.path.join(base, path)), data)


def _ask(path: str, target: str) -> None:
    # Asked of the permission bits and not of the system, which lets root write everywhere.
    try:
        for place in (target, os.path.dirname(target)) if os.path.lexists(target) else (os.path.dirname(target),):
            if not os.stat(place).st_mode & 0o222:
                raise EditError(f"{path}: cannot be written: it is read-only; nothing was changed")
    except OSError as error:
        raise EditError(f"{path}: cannot be written: {error.strerror or error}; nothing was changed") from error


def _write(path: str, target: str, data: bytes) -> None:
    """Permissions are kept, and a link stays a link."""
    temporary = ""
    try:
        handle, temporary = tempfile.mkstemp(prefix=".ros-lint-", dir=os.path.dirname(target))
        with os.fdopen(handle, "wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        os.chmod(temporary, os.stat(target).st_mode & 0o7777 if os.path.exists(target) else _NEW_MODE)
        os.replace(temporary, target)
    except OSError as error:
        if temporary and os.path.exists(temporary):
            os.unlink(temporary)
        raise EditError(f"{path}: cannot be written: {error.strerror or error}") from error


_NEW_MODE = 0o644


def _apply_to(source: Text, edits: Sequence[Edit]) -> str:
    text = source.text
    by_return = "\r\n" in text and text.count("\r\n") == text.count("\n")
    in_order = sorted(edits, key=lambda edit: (edit.span[1:], edit.kind, edit.order))
    # From the end, so that earlier offsets stay true.
    for span, at_place in reversed([(span, list(group)) for span, group in groupby(in_order, lambda edit: edit.span)]):
        start = source.offset(span.line, span.column)
        end = source.offset(span.end_line, span.end_column)
        put = _indented(_joined(at_place), text, start)
        put = put.replace("\r\n", "\n").replace("\n", "\r\n") if by_return else put
        text = text[:start] + put + text[end:]
    return text


def _indented(put: str, text: str, start: int) -> str:
    """Indent new lines by tabs where the line before them is: who makes an edit counts characters, whatever they are."""
    line = text[text.rfind("\n", 0, start) + 1 : start]
    indent = line[: len(line) - len(line.lstrip(" \t"))]
    return put.replace(f"\n{' ' * len(indent)}", f"\n{indent}") if "\t" in indent else put


_BLANK = re.compile(r"\r\n|\n|\r")


def _joined(edits: Sequence[Edit]) -> str:
    """Return what is put to one place: what belongs together is set off once, and nothing by two blank lines."""
    whole, kind = "", 0
    for edit in edits:
        text, same = edit.text, edit.kind == kind != 0
        apart = _BLANK.match(text)
        if whole and edit.span.column == 1 and apart and (same or _ends_apart(whole)):
            text = text[apart.end() :]
        elif same and _ends_apart(whole):
            whole = whole[: len(whole) - 2 if whole.endswith("\r\n") else -1]
        whole += text
        kind = edit.kind
    return whole


def _collide(a: Edit, b: Edit) -> bool:
    x, y = a.span, b.span
    return x.path == y.path and x[1:3] < y[3:5] and y[1:3] < x[3:5]


def _ends_apart(text: str) -> bool:
    return text.endswith(("\n\n", "\r\n\r\n", "\r\r"))
