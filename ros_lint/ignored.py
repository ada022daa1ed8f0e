"""What git is told to leave out of a repository: a file that is ignored is made or fetched, and no checkout has it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from ros_lint.tree import Tree, folders_of, join, parent, text_of

_NAME = ".gitignore"


class Pattern(NamedTuple):
    """A line of a ``.gitignore`` (gitignore(5))."""

    folder: str
    """Where the file lies; what is not below it is not meant."""
    regex: str
    """Of a path below the folder. Most runs never ask, so it is compiled when it is needed."""
    negated: bool
    """Whether it takes back what an earlier line said."""


def find(tree: Tree, packages: Iterable[tuple[str, Iterable[str]]]) -> tuple[Pattern, ...]:
    """Return the patterns for packages, given by folder with the files in it: later ones win. What cannot be read has none."""
    paths = {_NAME}
    for folder, files in packages:
        paths.update([join(folder, file) for file in files if file.rpartition("/")[2] == _NAME])
        paths.update([join(above, _NAME) for above in folders_of(folder)])
    found: list[Pattern] = []
    for path in sorted(paths, key=lambda one: (one.count("/"), one)):
        text = text_of(tree, path)
        found += patterns(parent(path), text.text) if text else ()
    return tuple(found)


def patterns(folder: str, text: str) -> Iterator[Pattern]:
    """Yield what the text of a ``.gitignore`` in a folder says."""
    for written in text.split("\n"):
        line = re.sub(r"(?<!\\)[ \t\r]+\Z", "", written)
        if not line or line.startswith("#"):
            continue
        negated = line.startswith("!")
        line = line[negated:]
        whole = line.rstrip("/")
        if whole:
            anywhere = "" if "/" in whole else "(?:.*/)?"
            yield Pattern(folder, anywhere + _regex(whole.lstrip("/")) + r"\Z", negated)


def is_ignored(given: Iterable[Pattern], path: str) -> bool:
    """Return whether git leaves out a path, which need not exist: it, or a folder it is in."""
    ours = [
        (re.compile(one.regex, re.DOTALL), len(one.folder) + 1 if one.folder else 0, one.negated)
        for one in given
        if not one.folder or path.startswith(f"{one.folder}/")
    ]
    parts = path.split("/")
    for number in range(len(parts)) if ours else ():
        place = "/".join(parts[: number + 1])
        said = [not negated for regex, start, negated in ours if len(place) > start and regex.match(place, start)]
        if said and said[-1]:
            return True
    return False


_PIECES = re.compile(r"(\A\*\*/|/\*\*/|/\*\*\Z)|(\*+)|(\?)|(\[!?\]?[^\]/]*\])|\\(.)|(.)", re.DOTALL)


def _regex(glob: str) -> str:
    """Return a regular expression for a pattern without what marks it as negated, anchored or a folder."""
    return "".join(_translated(match) for match in _PIECES.finditer(glob))


def _translated(match: re.Match[str]) -> str:
    across, stars, question, several, escaped, one = match.groups()
    if across:
        return {"**/": "(?:.*/)?", "/**/": "/(?:.*/)?", "/**": "/.*"}[across]
    if stars:
        return "[^/]*"
    if question:
        return "[^/]"
    if several:
        return _class(several)
    return re.escape(escaped or one)


def _class(several: str) -> str:
    inner = several[1:-1].replace("\\", "\\\\").replace("[", "\\[")
    return f"[^/{inner[1:]}]" if inner.startswith("!") else f"[{inner}]"
