"""Lookups in C++ sources: of packages and their files by ament_index_cpp, and of plugins by plugin loaders."""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from ros_lint.collectors.cpp.includes import blank_comments, may_be_comments
from ros_lint.collectors.cpp.registrations import class_name
from ros_lint.facts.sources import LookUp, Mention, PluginLoader

if TYPE_CHECKING:
    from ros_lint.base.text import Text

_LOOK_UP = re.compile(r'(get_package_(?:share_directory|share_path|prefix))\s*\(\s*"([^"\\\n]+)"')
_LOADER = re.compile(r'oader\w*(?:<[^;{}()"]*>)?\s*\w*\s*[({]\s*"([\w.-]+)"\s*,\s*"([\w:]*\w::\w[^"\\\n]*)"')
# Text that is added to a path: only literals count, and only if nothing follows them.
_APPENDED = re.compile(r'((?:\s*[/+]\s*"[^"\\\n]*")+)(?!\s*[/+]\s*[\w("])')
_PIECE = re.compile(r'([/+])\s*"([^"]*)"')
_BRACKETS = re.compile(r"\s*\)+")
_OPTIONAL_BRACKET = re.compile(r"\s*\)?")
_ASSIGNED = re.compile(r"\b([A-Za-z_]\w*)\s*[=({]\s*(?:[\w:]+\s*[({]\s*)?(?:\w+::)*\Z")
_MAX_DISTANCE = 200
"""Number of characters before a lookup in which the variable for its result is searched."""


def look_ups(source: Text, code: Sequence[int] = ()) -> tuple[list[Mention], tuple[LookUp, ...]]:
    """Return the packages that a source looks up by name in the ament index, and the files in their share folders.

    ``code`` has sorted offsets that are certainly outside of comments and strings.
    """
    text = source.text
    if "get_package_" not in text:
        return [], ()
    calls = list(_LOOK_UP.finditer(text))
    if may_be_comments(text, [call.start() for call in calls], code):
        text = blank_comments(text)
        calls = list(_LOOK_UP.finditer(text))
    spans = source.spans([match.span(2) for match in calls])
    guarded = _guarded_blocks(text) if "PackageNotFoundError" in text else []
    mentions = [
        Mention(match[2], "package", span, f'{match[1]}("{match[2]}")', any(match.start(2) in block for block in guarded))
        for match, span in zip(calls, spans, strict=True)
    ]
    files = sorted(_files(text, calls))
    spans = source.spans([place for place, _, _ in files])
    return mentions, tuple(LookUp(package, path, span) for (_, package, path), span in zip(files, spans, strict=True))


def loaders(source: Text, code: Sequence[int] = ()) -> tuple[PluginLoader, ...]:
    """Return the plugin loaders (pluginlib) in a source. The caller must check that the source may include ``pluginlib``."""
    if "oader" not in source.text:
        return ()
    matches = list(_LOADER.finditer(source.text))
    if may_be_comments(source.text, [match.start() for match in matches], code):
        matches = list(_LOADER.finditer(blank_comments(source.text)))
    spans = source.spans([match.span(1) for match in matches])
    return tuple(PluginLoader(match[1], class_name(match[2]), span) for match, span in zip(matches, spans, strict=True))


def _guarded_blocks(text: str) -> list[range]:
    """Return the offset ranges of try blocks whose handler catches PackageNotFoundError and neither throws nor exits."""
    result = []
    for catch in _CATCH.finditer(text):
        handler = text[catch.end() : _block_end(text, catch.end())]
        begin = _try_start(text, catch.start())
        if begin >= 0 and not _GIVES_UP.search(handler):
            result.append(range(begin, catch.start()))
    return result


_CATCH = re.compile(r"\}\s*catch\s*\([^()]*\bPackageNotFoundError\b[^()]*\)\s*\{")
_GIVES_UP = re.compile(r"\b(?:throw|abort|exit|_Exit|quick_exit|terminate|FAIL|GTEST_FAIL|FATAL|RCLCPP_FATAL\w*)\b")
_BRACE = re.compile(r"[{}]")


def _block_end(text: str, at: int) -> int:
    """Return the offset of the brace that closes the block around the offset ``at``."""
    depth = 1
    for brace in _BRACE.finditer(text, at):
        depth += 1 if brace[0] == "{" else -1
        if not depth:
            return brace.start()
    return len(text)


def _try_start(text: str, end: int) -> int:
    """Return the offset of the opening brace of the block whose closing brace is at ``end``; -1 if it is not a try block."""
    depth = 0
    at = end + 1
    while (at := max(text.rfind("{", 0, at), text.rfind("}", 0, at))) >= 0:
        depth += 1 if text[at] == "}" else -1
        if not depth:
            return at if text[:at].rstrip().endswith("try") else -1
    return -1


def _files(text: str, calls: list[re.Match[str]]) -> Iterator[tuple[tuple[int, int], str, str]]:
    """Yield each file that the code looks up: the offset range of the first literal of its path, its package and its path.

    ``get_package_share_directory("robot") + "/maps/a.yaml"`` -> ``maps/a.yaml`` of ``robot``. The result of the call may
    be stored in a variable first.
    """
    variables: dict[str, set[str]] = {}
    for call in calls:
        if call[1] == "get_package_prefix":
            continue
        brackets = _BRACKETS.match(text, call.end())
        if brackets is None:
            continue
        literals = _APPENDED.match(text, brackets.end())
        if literals:
            yield from _path(literals, call[2])
        elif assigned := _ASSIGNED.search(text, _statement_start(text, call.start()), call.start()):
            variables.setdefault(assigned[1], set()).add(call[2])
    for name, packages in variables.items():
        if len(packages) == 1:
            for end in _uses(text, name):
                if literals := _APPENDED.match(text, end):
                    yield from _path(literals, *packages)


def _statement_start(text: str, at: int) -> int:
    """Return the offset at which the statement around ``at`` begins, at most ``_MAX_DISTANCE`` characters before."""
    farthest = max(0, at - _MAX_DISTANCE)
    return max(farthest, text.rfind(";", farthest, at) + 1)


def _uses(text: str, name: str) -> Iterator[int]:
    """Yield the offset after each use of the variable ``name``. If ``)`` follows the use, the offset is after this bracket."""
    start = text.find(name)
    while start >= 0:
        end = start + len(name)
        previous, following = text[start - 1 : start], text[end : end + 1]
        if not (previous.isalnum() or previous == "_" or following.isalnum() or following == "_"):
            brackets = _OPTIONAL_BRACKET.match(text, end)
            assert brackets is not None
            yield brackets.end()
        start = text.find(name, end)


def _path(literals: re.Match[str], package: str) -> Iterator[tuple[tuple[int, int], str, str]]:
    pieces = list(_PIECE.finditer(literals[1]))
    text = ""
    for piece in pieces:
        text = f"{text}/{piece[2]}" if piece[1] == "/" else text + piece[2]
    path = posixpath.normpath(text.lstrip("/")) if text.startswith("/") else ""
    if path and path != "." and not path.startswith(".."):
        start = literals.start(1) + pieces[0].start(2)
        yield (start, start + len(pieces[0][2])), package, path
