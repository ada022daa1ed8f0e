"""Make a failing input smaller while it still fails in the same way."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Iterator
from typing import Final

from tests.fuzz.seeds import Files

_NUMBERS: Final = re.compile(r"\d+(\.\d+)?|'[^']*'|\"[^\"]*\"|\S*/\S*")


def signature(failure: str) -> str:
    """Return what two failures of the same cause have in common: the last line without numbers, names and paths."""
    return _NUMBERS.sub("", (failure.strip().splitlines() or [""])[-1])[:200] or failure[:20]


def minimise(files: Files, fails: Callable[[Files], bool], seconds: float) -> Files:
    """Return a smaller workspace for which ``fails`` is still true. It takes about ``seconds``."""
    end = time.monotonic() + seconds
    progress = True
    while progress:
        progress = False
        for smaller in _smaller(files):
            if time.monotonic() > end:
                return files
            if fails(smaller):
                files, progress = smaller, True
                break
    return files


def _smaller(files: Files) -> Iterator[Files]:
    for path in files:
        yield {other: content for other, content in files.items() if other != path}
    for path, content in files.items():
        if isinstance(content, bytes):
            for shorter in _shorter(content):
                yield {**files, path: shorter}


def _shorter(content: bytes) -> Iterator[bytes]:
    lines = content.splitlines(keepends=True)
    parts: list[bytes] = (
        lines if len(lines) > 1 else [content[at : at + 1] for at in range(len(content))] if len(content) < 2_000 else []
    )
    size = len(parts) // 2
    while size:
        for start in range(0, len(parts), size):
            yield b"".join(parts[:start] + parts[start + size :])
        size //= 2
    if not parts:
        yield content[: len(content) // 2]
        yield content[len(content) // 2 :]
