"""
## What it finds

A launch file that includes a launch file, or names a parameter, model, map or display file, which its package does not
have: neither installed there nor in its sources.

## Why it matters

The launch file stops, or the node comes up without its parameters.

## How to fix it

Correct the path; the message names files of the same name that the package does install.

## When it keeps silent

- The file is in the sources and not installed: that is `uninstalled-resource`.
- A part of the package's build script that cannot be followed may install it.
- Files that look as if something writes or downloads them: networks, records, images; folders. Maps, which people make
  with the robot, and what git ignores have medium confidence, and so have records beside which one of nearly the same name
  is installed.
- For a released package: its launch files are not known whole; other files of it are not known at all.
- The launch file asks first if the package is there.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterator

from ros_lint.api import (
    Confidence,
    Facet,
    Finding,
    Package,
    Related,
    Rule,
    Severity,
    Workspace,
    referred,
)

_MOST_RELATED = 4
_WRITTEN = (".yaml", ".yml", ".rviz", ".urdf", ".xacro", ".srdf", ".sdf", ".world", ".wbt", ".lua", ".launch", ".py", ".xml")
"""Kinds of files that people write and keep with the package."""


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    for (owner, path), named in referred(package, ("include", "file")).items():
        references = [reference for reference in named if not reference.optional]
        if not references:
            continue
        best, *others = sorted(references, key=lambda one: (one.by_default, one.kind != "include", one.span))
        others_there = _files_without(owner, path, best.kind, workspace)
        if others_there is None:
            continue
        written = best.kind == "include" or path.endswith(_WRITTEN)
        if not written and not _has_twin(path, others_there):
            continue
        sure = written and (bool(workspace.by_name.get(owner)) or workspace.target.told)
        yield Finding(
            f"{owner} has no {path}{_hint(path, others_there)}",
            best.span,
            path,
            tuple(Related("also named here", other.span) for other in others[:_MOST_RELATED]),
            confidence=Confidence.HIGH
            if sure and not best.by_default and not _is_made(owner, path, workspace)
            else Confidence.MEDIUM,
        )


def _has_twin(path: str, names: tuple[str, ...]) -> bool:
    """Whether a file of nearly the same name, and of the same kind, is installed beside it."""
    folder, _, base = path.rpartition("/")
    suffix = base.rpartition(".")[2]
    twins = [name.rpartition("/")[2] for name in names if name.rpartition("/")[0] == folder and name.endswith(f".{suffix}")]
    return bool(difflib.get_close_matches(base, twins, 1, 0.8))


def _is_made(owner: str, path: str, workspace: Workspace) -> bool:
    """Whether people make such a file with the robot, as they do maps and what git ignores."""
    if not {"map", "maps"}.isdisjoint(path.split("/")[:-1]):
        return True
    return any(workspace.is_made(one, path) for one in workspace.by_name.get(owner, ()))


def _files_without(owner: str, path: str, kind: str, workspace: Workspace) -> tuple[str, ...] | None:
    """Return the files below share/<package> when this one is certainly not among them."""
    owners = workspace.by_name.get(owner, ())
    if not owners:
        known = workspace.world.launch_files(owner)
        return known.names if kind == "include" and known.ask(path) == "missing" else None
    share = f"share/{owner}/"
    names: set[str] = set()
    for one in owners:
        if one.script is None or one.hidden(Facet.SHARE) or one.builds_with not in ("ament_cmake", "ament_python"):
            return None
        names.update(p.path[len(share) :] for p in one.script.provides if p.path.startswith(share))
        # What is in the sources and installed nowhere is told by another rule, also when the folders differ.
        installed = {provided.source for provided in one.script.provides}
        if any((file == path or file.endswith(f"/{path}")) and file not in installed for file in one.files):
            return None
        if any(path.startswith(f"{folder}/") for folder in (*one.unseen, *one.nested)):
            return None
    if path in names or any(name.startswith(f"{path}/") for name in names):
        return None
    return tuple(sorted(names))


def _hint(path: str, names: tuple[str, ...]) -> str:
    base = path.rpartition("/")[2]
    same = [name for name in names if name.rpartition("/")[2] == base]
    near = same or difflib.get_close_matches(path, names, 1, 0.8)
    return f"; did you mean {near[0]}?" if near else ""


RULE = Rule(
    name="launch-missing-include",
    code="ROS505",
    summary="a file that a launch file includes or names must exist in its package",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    package=check,
)
