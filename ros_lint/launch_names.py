"""Which launch configurations a launch file declares, sets and asks for, and what it gets from those that include it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from ros_lint.collectors.launch_text import configurations, is_plain, named_in
from ros_lint.facts import LaunchFile
from ros_lint.launch_links import Links, everything, texts_of
from ros_lint.text import Span


class Names(NamedTuple):
    """The launch configurations of one file."""

    declared: Mapping[str, Span]
    """Its arguments."""
    made: frozenset[str]
    """Those that it sets in other ways, or passes to a file that it includes, which leaves them set."""
    asked: frozenset[str]
    """Those that it asks for."""
    needed: Mapping[str, Span]
    """Those among them that must be there, since it has no default for them."""
    whole: bool
    """Whether no other name can be meant."""


def names_of(file: LaunchFile) -> Names:
    """Return what a file itself does."""
    declared: dict[str, Span] = {}
    made: set[str] = set()
    asked = set(file.asks)
    needed: dict[str, Span] = {}
    whole = not file.problems and not file.opaque and all(map(is_plain, file.asks))
    for action in everything(file.actions):
        for text, span in texts_of(action):
            names = named_in(text)
            whole = whole and names is not None
            asked.update(names or ())
            for name, has_default in configurations(text):
                if not has_default and not name.startswith("$"):
                    needed.setdefault(name, span)
        if action.kind in ("include", "group"):
            made.update(name for name, _ in action.arguments)
        if action.kind in ("argument", "set") and action.target is not None:
            whole = whole and all(map(is_plain, action.target.texts))
            if action.kind == "set":
                made.update(action.target.texts)
            else:
                declared.update((name, action.span) for name in action.target.texts if name not in declared)
    return Names(declared, frozenset(made), frozenset(asked), needed, whole and all(map(is_plain, made)))


class Families:
    """Who includes whom among the launch files of a workspace."""

    def __init__(self, files: Iterable[LaunchFile], links: Links) -> None:
        self._names = {file.path: names_of(file) for file in files}
        self._includers: dict[str, set[str]] = {}
        for file in files:
            for action in everything(file.actions):
                target = links.target(action.target, file) if action.kind == "include" else None
                if target is not None:
                    self._includers.setdefault(target.file.path, set()).add(file.path)

    def names(self, file: LaunchFile) -> Names:
        """Return what a file itself does."""
        return self._names[file.path]

    def above(self, file: LaunchFile) -> list[Names]:
        """Return the same of every file that includes it, itself or by way of others."""
        seen = {file.path}
        waiting = [file.path]
        while waiting:
            new = self._includers.get(waiting.pop(), set()) - seen
            seen |= new
            waiting += new
        return [self._names[path] for path in sorted(seen - {file.path})]
