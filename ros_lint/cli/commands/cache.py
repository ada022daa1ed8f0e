"""``ros-lint cache``: show or remove the cached results of earlier runs."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Mapping, Sequence
from datetime import datetime, timezone
from typing import Any

from ros_lint.base.paths import is_below_any
from ros_lint.cli.messages import show
from ros_lint.reporters.ansi import Style, safe
from ros_lint.workspace.cache.folder import MOST_BYTES, CachedWorkspace, cached_workspaces, folder, remove


def run(options: Mapping[str, Any]) -> int:
    """Run ``ros-lint cache`` with its options. Return the exit code: 2 if the cache cannot be read or changed, else 0."""
    place = folder(os.environ)
    if not place:
        print("ros-lint: there is no cache folder, because neither XDG_CACHE_HOME nor HOME is set", file=sys.stderr)
        return 2
    try:
        if options["action"] == "clean":
            print(_removed_text(remove(place, _selector(options["paths"]))))
        elif options["format"] == "json":
            print(_json(place, cached_workspaces(place)))
        else:
            print(_text(place, cached_workspaces(place)))
    except OSError as error:
        show(f"'{error.filename or place}': {error.strerror or error}")
        return 2
    return 0


def _selector(paths: Sequence[str]) -> Callable[[CachedWorkspace], bool]:
    """Return a function that returns whether a cached workspace is in one of the paths. Without paths, all workspaces are."""
    real_paths = [os.path.realpath(path) for path in paths]
    return lambda cached: not paths or (cached.workspace != "" and is_below_any(cached.workspace, real_paths))


def _removed_text(removed: Sequence[CachedWorkspace]) -> str:
    return f"removed the cached results of {_workspaces(removed)}"


def _text(place: str, cached: Sequence[CachedWorkspace]) -> str:
    """Return the cache folder and a line for each workspace: path, size, date of the last use, and "gone" if it is missing."""
    style = Style()
    names = [safe(workspace.workspace, style) or f"unreadable file {os.path.basename(workspace.file)}" for workspace in cached]
    width = max(map(len, names), default=0)
    lines = [
        f"  {name:{width}}  {_megabytes(workspace.size)}  {_date(workspace)}{'  gone' if workspace.is_gone else ''}"
        for name, workspace in zip(names, cached, strict=True)
    ]
    return "\n".join([f"{safe(place, style)}: {_workspaces(cached)} (limit {_megabytes(MOST_BYTES).strip()})", *lines])


def _workspaces(cached: Sequence[CachedWorkspace]) -> str:
    size = sum(workspace.size for workspace in cached)
    return f"{len(cached)} workspace{'s' * (len(cached) != 1)}, {_megabytes(size).strip()}"


def _json(place: str, cached: Sequence[CachedWorkspace]) -> str:
    import json  # noqa: PLC0415

    workspaces = [
        {
            "path": workspace.workspace or None,
            "exists": not workspace.is_gone,
            "file": workspace.file,
            "bytes": workspace.size,
            "used": _date(workspace),
        }
        for workspace in cached
    ]
    total = sum(workspace.size for workspace in cached)
    return json.dumps({"folder": place, "bytes": total, "limit": MOST_BYTES, "workspaces": workspaces}, indent=2)


def _megabytes(size: int) -> str:
    return f"{size / 2**20:7.1f} MB"


def _date(cached: CachedWorkspace) -> str:
    return datetime.fromtimestamp(cached.used, timezone.utc).strftime("%Y-%m-%d")
