"""What a launch file of the workspace starts when it is launched without arguments."""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING, Literal, NamedTuple

from ros_lint.collectors.launch_text import UNKNOWN, installed_place, is_settled, share

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from ros_lint.facts.launch import LaunchFile
    from ros_lint.interpret.launch_expand import Expansion
    from ros_lint.text import Span
    from ros_lint.workspace import Workspace

_NOTHING: Mapping[str, str] = MappingProxyType({})


class PassedFile(NamedTuple):
    """A file that a launch file names which another one includes, as it is with what that one passes on."""

    package: str
    path: str
    """Below share/<package>."""
    kind: Literal["include", "file"]
    """Whether it is included, or a file of parameters."""
    span: Span
    """Of the action that names it."""
    via: Span
    """Of the include in the file that is launched."""
    depth: int
    """How many includes lie between."""
    sure: bool
    """False when it depends on something that is not known."""


def launched(
    file: LaunchFile, workspace: Workspace, follow: Callable[[LaunchFile], bool], given: Mapping[str, str] = _NOTHING
) -> Expansion:
    """Return what a launch file starts by itself, in brief, with those of the files that it includes that are to be followed."""
    from ros_lint.interpret.launch_expand import expand  # noqa: PLC0415  (most runs need nothing of it)

    place = workspace.links.place(file)
    if place is not None:
        file = file._replace(path=f"{share(place.package.name)}/{place.path}")

    def included(path: str) -> LaunchFile | None:
        found = workspace.links.included(path)
        return found if found is not None and follow(found) else None

    return expand(file, given, included, workspace.target.distro, brief=True)


def passed_files(file: LaunchFile, workspace: Workspace, *, settled: bool = False) -> Iterator[PassedFile]:
    """Yield the files that included launch files name when a file is launched.

    With ``settled`` only those that are the same whatever arguments it is launched with.
    """
    found = launched(file, workspace, lambda inner: True)
    if settled:
        open_ = {argument.name: UNKNOWN for argument in found.arguments if not argument.given}
        found = launched(file, workspace, lambda inner: True, open_)
    for started in found.started:
        if started.via is None:
            continue
        kind: Literal["include", "file"] = "include" if started.kind == "include" else "file"
        named = [started.target] if kind == "include" else [texts for name, texts in started.parameters if not name]
        for texts in named:
            for text in texts:
                place = installed_place(text) if is_settled(text) else None
                if place is not None and place.known and place.share:
                    sure = started.certain and len(texts) == 1
                    yield PassedFile(place.package, place.share, kind, started.span, started.via, started.depth, sure)
