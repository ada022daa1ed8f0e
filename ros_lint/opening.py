"""From what was said on the command line to a workspace that can be loaded."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from ros_lint import cache, underlay
from ros_lint.config import Settings, settle
from ros_lint.engine import matches
from ros_lint.knowledge import Knowledge, distros, newest_lts, user_directory
from ros_lint.load import Loader, Progress
from ros_lint.tree import DiskTree
from ros_lint.workspace import Target


class UsageError(Exception):
    """Something that was asked for cannot be done. The message names it, and the way out."""


class Opened(NamedTuple):
    """A workspace that is ready to be loaded."""

    loader: Loader
    settings: Settings
    knowledge: Knowledge
    base: str
    """Absolute. Every path in the output is relative to it: the root of the repository, or the workspace itself."""
    roots: tuple[str, ...]
    """What was asked for, relative to the base."""
    warnings: tuple[str, ...]


def open_workspace(said: Mapping[str, Any], environment: Mapping[str, str], progress: Progress) -> Opened:
    """Return the workspace that the options name, not yet loaded.

    ``said`` is what :func:`ros_lint.arguments.parse` gives. Raises UsageError, ConfigError and KnowledgeError.
    """
    paths = [os.path.realpath(path) for path in said.get("paths") or ["."]]
    for path, written in zip(paths, said.get("paths") or ["."], strict=True):
        if not os.path.exists(path):
            raise UsageError(f"{written}: no such file or directory")
        if not os.path.isdir(path):
            raise UsageError(f"{written}: not a directory; ros-lint checks workspaces and packages")
    base = _base(paths)
    settings = settle(
        {name: value for name, value in said.items() if name != "paths"}, os.path.commonpath(paths), environment, base
    )
    places = (user_directory(environment),)
    target, warnings = _target(settings, places)
    knowledge = Knowledge(target.distro, places)
    underlays, unread = _underlays(settings, target.distro, base)
    roots = tuple("" if path == base else os.path.relpath(path, base).replace(os.sep, "/") for path in paths)
    loader = Loader(
        DiskTree(base),
        roots,
        target,
        underlays=underlays,
        knowledge=knowledge,
        exclude=_excluder(settings["exclude"]),
        jobs=settings["jobs"],
        cache=cache.Cache(cache.folder(environment) if settings["cache"] else "", base),
        progress=progress,
    )
    return Opened(loader, settings, knowledge, base, roots, (*warnings, *unread))


def _underlays(settings: Settings, distro: str, base: str) -> tuple[tuple[underlay.Underlay, ...], tuple[str, ...]]:
    """Return the underlays and warnings. What was asked for must be one; what merely lies in the environment need not."""
    prefixes = [prefix for prefix in settings["underlay"] if prefix]
    if settings.origin("underlay") != "AMENT_PREFIX_PATH":
        try:
            return underlay.read(prefixes, distro), ()
        except underlay.UnderlayError as error:
            raise UsageError(str(error)) from error
    found: list[underlay.Underlay] = []
    warnings: list[str] = []
    for prefix in prefixes:
        try:
            found += underlay.read([prefix], distro, base)
        except underlay.UnderlayError as error:
            warnings.append(f"AMENT_PREFIX_PATH: {error}")
    return tuple(found), tuple(warnings)


def no_packages(opened: Opened) -> str:
    """Return what to say when there is nothing to work on."""
    places = ", ".join(root or opened.base for root in opened.roots)
    return f"ros-lint: no package found below {places}; is there a package.xml?"


def _base(paths: Sequence[str]) -> str:
    """Return the root of the repository that holds the paths, or their common folder.

    What code review shows is relative to the repository, so paths in the output are, too, wherever the tool is called.
    """
    common = os.path.commonpath(paths)
    folder = common
    while True:
        if os.path.exists(os.path.join(folder, ".git")):
            return folder
        above = os.path.dirname(folder)
        if above == folder:
            return common
        folder = above


def _target(settings: Settings, places: Sequence[str]) -> tuple[Target, tuple[str, ...]]:
    distro = settings["distro"]
    if not distro:
        return Target(newest_lts(places), "newest long-term release known", told=False), ()
    known = [known.name for known in distros(places)]
    if distro in known:
        return Target(distro, settings.origin("distro")), ()
    if settings.origin("distro") == "ROS_DISTRO":
        return Target(distro, "ROS_DISTRO"), (f"nothing is known of ROS_DISTRO {distro}; there are {', '.join(known)}",)
    import difflib  # noqa: PLC0415

    close = difflib.get_close_matches(distro, known, 1)
    hint = f", did you mean {close[0]}?" if close else ""
    raise UsageError(f"{settings.origin('distro')}: nothing is known of {distro}{hint} (there are {', '.join(known)})")


def _excluder(patterns: Sequence[str]) -> Callable[[str], bool]:
    if not patterns:
        return lambda path: False
    return lambda path: any(matches(path, pattern) for pattern in patterns)
