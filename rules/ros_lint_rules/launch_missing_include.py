"""
## What it finds

- A launch file that includes or names a missing file of a package: another launch file, a parameter file, a model, a map, or a
  display (a configuration of RViz, `*.rviz`). The package neither installs the file nor has it in its sources.
- An installed model, display or parameter file (URDF and xacro among them) that looks up a missing mesh or other file in a
  package of the workspace.
- A missing file that MoveIt's builders read from their package:
  `MoveItConfigsBuilder("arm").joint_limits(file_path="config/joint_limits.yaml")`.
- A missing file that an included launch file names by an argument, such as `$(var folder)/robot.yaml`. The argument has the
  value that the including launch file passes, directly or through further includes.

One rule reports all these cases, because each is the name of a file that its package neither installs nor has in its sources.

## Why it matters

The launch file stops, or the node starts without its parameters. xacro stops at a missing include. RViz and Gazebo show nothing
for a missing mesh. If the configuration of RViz is missing, RViz starts with its default, so this is only a warning.

## How to fix it

Correct the path. The message suggests a file of the same name that the package installs, or names the package with the file.

## Limitations

Not reported:

- The file is in the sources but not installed: see `uninstalled-resource`.
- A part of the package's build script that cannot be evaluated may install the file.
- Folders, and files that programs usually write or download: networks, recordings, images. Files that a node certainly reads
  are always reported: parameters, and the displays of rviz2.
- The package is released, and its launch files are not fully known. The launch files of an earlier and a later distribution are
  used instead, if both are known and neither has the file. Other files of released packages are not known.
- The launch file checks first whether the package or the file exists (`os.path.exists`), unless it stops if the file is
  missing.
- The launch file uses the file only if another file does not exist, and that file exists.
- Several launch configurations form the path, and each of their values belongs to the path of a file that exists, because the
  values may never occur together.
- The launch file writes the file itself (`open(path, 'w')`, `xacro.open_output(path)`), or by a command (`xacro ... > path`).
- Models, displays and parameters that are not installed in every build, and what xacro includes as `optional`.

Reported with medium confidence:

- Maps, files in a folder for generated files (`temp`, `tmp`, `generated`), and files that git ignores.
- Recordings, if a recording of nearly the same name is installed in the folder. The confidence is high if the installed
  recording is the only one that nothing looks up.
- The distribution was not chosen, and the released package may have the file in another distribution.
- Files named by a model, display or parameter file that no launch file or model looks up itself.
- The name depends on the default of an argument.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache

from ros_lint.api import (
    Confidence,
    Facet,
    Finding,
    LaunchFile,
    LaunchReference,
    Package,
    Related,
    Rule,
    Severity,
    Span,
    Workspace,
    cached_by_name,
    cached_by_package,
    files,
    first_related,
    launch,
    names,
)

_WRITTEN = (".yaml", ".yml", ".rviz", ".urdf", ".xacro", ".srdf", ".sdf", ".world", ".wbt", ".lua", ".launch", ".py", ".xml")
"""Suffixes of files that developers write and keep with the package."""
_MODELS = (".urdf", ".xacro", ".srdf", ".sdf", ".world", ".rviz", ".yaml", ".yml", ".xml")
"""Suffixes of files other than programs that may look up files of packages, such as models and RViz configurations."""


def check(workspace: Workspace) -> Iterator[Finding]:
    for package in workspace.packages:
        yield from _of_package(package, workspace)
    yield from _passed(workspace)


@cached_by_package
def _of_package(package: Package, workspace: Workspace) -> tuple[Finding, ...]:
    found = (*_named(package, workspace), *_modelled(package, workspace))
    return tuple([finding._replace(package=package.name) for finding in found])


def _modelled(package: Package, workspace: Workspace) -> Iterator[Finding]:
    """Yield findings for missing files of workspace packages that other files look up.

    These other files are installed models, RViz configurations and parameter files.
    """
    if not package.lookups:
        return
    share = f"share/{package.name}/"
    installed = {p.source: p.path.removeprefix(share) for p in package.built.products.installs if p.source and not p.conditional}
    used = {look_up.path for look_up in launch.files_looked_up(workspace, package.name)}
    look_ups: dict[tuple[str, str], list[tuple[bool, Span]]] = {}
    for look_up in package.lookups:
        file, path = package.relative(look_up.span.path), look_up.path.lstrip("/")
        if file.endswith(_MODELS) and file in installed and look_up.package in workspace.by_name and not files.is_auxiliary(file):
            look_ups.setdefault((look_up.package, path), []).append((installed[file] not in used, look_up.span))
    groups: dict[tuple[str, str, bool], list[tuple[str, str, Span, list[Span]]]] = {}
    for (owner, path), named in look_ups.items():
        existing = _files_without(owner, path, "file", workspace) if ".." not in path else None
        if existing is not None:
            (idle, best), *others = sorted(named)
            sure = not (idle or _is_made(owner, path, workspace))
            hint = _hint(path, existing)
            # A missing folder of meshes is a single mistake.
            folder, _, name = path.rpartition("/")
            key = (owner, f"{folder} {best.path}" if not hint or hint.endswith(f"/{name}'?") else path, sure)
            groups.setdefault(key, []).append((path, hint, best, [place for _, place in others]))
    for (owner, _, sure), missing in groups.items():
        (path, hint, first, repeated), *more = missing
        yield Finding(
            f"{_message(owner, path, len(more))}{hint or _OTHERWISE}",
            first,
            path,
            first_related(
                [
                    *(Related(f"'{path}' is also named here", place) for place in repeated),
                    *(Related(f"'{name}' does not exist either", place) for name, _, place, _ in more),
                ]
            ),
            confidence=Confidence.HIGH if sure else Confidence.MEDIUM,
            severity=Severity.WARNING,
        )


def _named(package: Package, workspace: Workspace) -> Iterator[Finding]:
    """Yield findings for missing files that launch files name without the help of launch arguments."""
    by_name = launch.references_by_name(package, ("include", "file"))
    names_at: dict[Span, set[str]] = {}
    paths_at: dict[Span, list[tuple[str, str]]] = {}
    for (owner, path), named in by_name.items():
        for reference in named:
            if reference.conditional:  # as is each of several values
                paths_at.setdefault(reference.span, []).append((owner, path))
            names_at.setdefault(reference.package_span, set()).add(path)
    for (owner, path), named in by_name.items():
        references = [
            reference
            for reference in named
            if not (reference.optional or reference.existence_checked or _is_never_used(reference, workspace))
        ]
        if not references:
            continue
        best, *others = sorted(
            references, key=lambda place: (place.from_default, place.kind != "include", not place.surely_read, place.span)
        )
        existing = _files_without(owner, path, best.kind, workspace)
        if existing is None or (best.conditional and _is_mixed(owner, path, paths_at[best.span], workspace)):
            continue
        written = best.kind == "include" or path.endswith(_WRITTEN) or any(reference.surely_read for reference in references)
        written = written or _is_misspelt(path, existing)
        twin = "" if written else _twin(path, existing)
        if not written and not twin:
            continue
        meant = written or _is_left_over(twin, owner, existing, workspace)
        sure = meant and workspace.surely_lacks(owner, "launch", path)
        yield Finding(
            f"{_message(owner, path)}{_hint(path, existing) or _owner(package, path, workspace) or _OTHERWISE}",
            best.span,
            path,
            first_related(
                [
                    *_look_up(best, owner, names_at),
                    *(Related(f"'{path}' is also named here", other.span) for other in others),
                ]
            ),
            confidence=Confidence.HIGH
            if sure and not best.from_default and not _is_made(owner, path, workspace)
            else Confidence.MEDIUM,
            severity=_severity(path),
        )


def _is_never_used(reference: LaunchReference, workspace: Workspace) -> bool:
    """Return whether a reference is only used if another file is missing, and this other file may exist."""
    return any(_files_without(owner, path, reference.kind, workspace) is None for owner, path in reference.fallback_for)


def _is_mixed(owner: str, path: str, paths: Iterable[tuple[str, str]], workspace: Workspace) -> bool:
    """Return whether a missing file is named only by values that never occur together.

    ``paths`` are the paths that result from all values of the configurations in one text. The result is True if the path has
    several parts that vary, and if each part is at the same position of a path whose file may exist.
    """
    parts = _parts(owner, path)
    others = [_parts(*other) for other in paths if other != (owner, path) and _files_without(*other, "file", workspace) is None]
    alike = [other for other in others if len(other) == len(parts)]
    return bool(alike) and all(any(other[position] == part for other in alike) for position, part in enumerate(parts))


def _parts(owner: str, path: str) -> tuple[str, ...]:
    return owner, *path.split("/")


def _look_up(reference: LaunchReference, owner: str, names_at: Mapping[Span, set[str]]) -> Iterator[Related]:
    """Yield the earlier line of a launch file in which the package of a missing file is looked up.

    Nothing is yielded if the look-up also serves for other files. ``names_at``: the files for which each look-up serves.
    """
    place, named = reference.span, reference.package_span
    if place.path == named.path and named.line < place.line and len(names_at[named]) == 1:
        yield Related(f"package '{owner}' is looked up here", named)


def _passed(workspace: Workspace) -> Iterator[Finding]:
    """Yield findings for missing files whose paths are formed by an included launch file from arguments of the include."""
    links = launch.include_resolver(workspace)
    paths = [
        (package, launch_file.file) for package in workspace.packages for launch_file in launch.package_launch_files(package)
    ]
    including = [(package, file) for package, file in paths if links.includes(file)]
    inner = {included.path for _, file in including for included in links.includes(file)}
    missing = _Missing(workspace)
    if not any(missing.passed_by(file) for _, file in including if file.path not in inner):
        return  # most workspaces have no such mistake, and following the included files as well would double the time
    nearest: dict[_Key, tuple[launch.PassedFile, Package, LaunchFile]] = {}
    for package, file in including:
        for key, passed in missing.passed_by(file).items():
            if key not in nearest or passed.depth < nearest[key][0].depth:
                nearest[key] = passed, package, file
    for key, (passed, package, file) in nearest.items():
        sure = passed.sure and key in missing.passed_by(file, settled=True)
        hint = _hint(passed.path, _files_without(passed.package, passed.path, passed.kind, workspace) or ())
        yield Finding(
            f"{_message(passed.package, passed.path)}; the included file forms this path from an argument passed here"
            f"{hint or '; correct the argument, or add the file'}",
            passed.via,
            passed.path,
            (Related(f"'{passed.path}' is named here", passed.span),),
            confidence=Confidence.HIGH if sure and not _is_made(passed.package, passed.path, workspace) else Confidence.MEDIUM,
            severity=_severity(passed.path),
            package=package.name,
        )


class _Missing:
    """Cache of the missing files that included launch files name, by path and by launch file."""

    def __init__(self, workspace: Workspace) -> None:
        self._workspace = workspace
        self._known: dict[tuple[str, str, str], bool] = {}
        self._passed: dict[tuple[str, bool], dict[_Key, launch.PassedFile]] = {}

    def passed_by(self, file: LaunchFile, *, settled: bool = False) -> dict[_Key, launch.PassedFile]:
        """Return the missing files whose paths included launch files form from arguments when ``file`` is launched.

        The keys are the place in the included file, the package and the path (:func:`passed_files`). Files that a launch file
        names without arguments are left out. ``settled``: also leave out files that depend on the arguments of ``file`` itself.
        """
        key = file.path, settled
        if key not in self._passed:
            self._passed[key] = self._among(launch.passed_files(file, self._workspace, settled=settled))
        return self._passed[key]

    def _among(self, paths: Iterable[launch.PassedFile]) -> dict[_Key, launch.PassedFile]:
        missing: dict[_Key, launch.PassedFile] = {}
        for file in paths:
            place = (file.package, file.path, file.kind)
            if place not in self._known:
                self._known[place] = self._is_missing(file)
            if self._known[place]:
                missing.setdefault((file.span, file.package, file.path), file)
        return missing

    def _is_missing(self, file: launch.PassedFile) -> bool:
        if file.kind != "include" and not file.path.endswith(_WRITTEN):
            return False
        if any(look_up.path == file.path for look_up in launch.files_looked_up(self._workspace, file.package)):
            return False
        return _files_without(file.package, file.path, file.kind, self._workspace) is not None


_Key = tuple[Span, str, str]
_OTHERWISE = "; correct the path, or add the file"
"""The remedy for a missing file without a suggestion."""


def _message(owner: str, path: str, more: int = 0) -> str:
    """Return the beginning of a message: ``path`` and ``more`` other files of its folder do not exist in package ``owner``."""
    if not more:
        return f"'{path}' does not exist in '{owner}'"
    return f"'{path}' and {more} more file{'s' if more > 1 else ''} of the same folder do not exist in '{owner}'"


def _severity(path: str) -> Severity:
    """Return the severity of a missing file. RViz starts with its default settings if a file ``*.rviz`` is missing."""
    return Severity.WARNING if path.endswith(".rviz") else Severity.ERROR


def _twin(path: str, all_names: tuple[str, ...]) -> str:
    """Return the installed file with nearly the name of ``path``, in the same folder and with the same suffix; else ""."""
    folder, _, base = path.rpartition("/")
    siblings = [name.rpartition("/")[2] for name in all_names if _folder_and_suffix(name) == _folder_and_suffix(path)]
    near = names.similar_names(base, siblings, 1, 0.8)
    return f"{folder}/{near[0]}".lstrip("/") if near else ""


def _is_misspelt(path: str, all_names: tuple[str, ...]) -> bool:
    """Return whether ``path`` is an existing file except for the order of letters in the suffix: ``x.yalm`` for ``x.yaml``."""
    stem, _, suffix = path.rpartition(".")
    return any(name.startswith(f"{stem}.") and sorted(name[len(stem) + 1 :]) == sorted(suffix) for name in all_names)


def _folder_and_suffix(path: str) -> tuple[str, str]:
    """Return the folder and the suffix of a file."""
    folder, _, base = path.rpartition("/")
    return folder, base.rpartition(".")[2]


def _is_left_over(file: str, owner: str, all_names: tuple[str, ...], workspace: Workspace) -> bool:
    """Return whether nothing looks up ``file`` of package ``owner``, but other files with its folder and suffix are looked up."""
    wanted = {look_up.path for look_up in launch.files_looked_up(workspace, owner)}
    return file not in wanted and any(
        _folder_and_suffix(other) == _folder_and_suffix(file) for other in wanted.intersection(all_names)
    )


def _is_made(owner: str, path: str, workspace: Workspace) -> bool:
    """Return whether the file ``path`` of package ``owner`` is probably created later, so that sources do not contain it.

    True in a folder such as ``maps`` or ``generated``, and for a file that git ignores.
    """
    if not _FILLED_LATER.isdisjoint(path.split("/")[:-1]):
        return True
    return any(workspace.is_made(package, path) for package in workspace.by_name.get(owner, ()))


_FILLED_LATER = frozenset({"generated", "map", "maps", "temp", "tmp"})


def _files_without(owner: str, path: str, kind: str, workspace: Workspace) -> tuple[str, ...] | None:
    """Return the files in the share directory of package ``owner`` if ``path`` is certainly not among them, else None.

    ``kind``: "include" for a launch file, "file" for any other file.
    """
    owners = workspace.by_name.get(owner, ())
    if not owners:
        known = workspace.world.launch_files(owner)
        return known.possible if kind == "include" and known.ask(path) == "missing" else None
    for package in owners:
        if package.script is None or package.builds_with not in ("ament_cmake", "ament_python"):
            return None
        if package.hidden(Facet.SHARE, f"share/{owner}/{path}"):
            return None
        # Another rule reports a file of the sources that is not installed, also if the folders differ.
        installed = package.script.products.installed
        named = files.files_by_name(package, workspace).get(path.rpartition("/")[2], ())
        if any((file == path or file.endswith(f"/{path}")) and file not in installed for file in named):
            return None
        if any(path.startswith(f"{folder}/") for folder in (*package.unvisited_folders, *package.nested)):
            return None
    shared = _shared(workspace, owner)
    same, below = (bisect_left(shared, start) for start in (path, f"{path}/"))
    exists = path in shared[same : same + 1] or any(file.startswith(f"{path}/") for file in shared[below : below + 1])
    return None if exists else shared


@cached_by_name
def _shared(workspace: Workspace, owner: str) -> tuple[str, ...]:
    """Return the files in the share directory of the packages with the name ``owner``, sorted."""
    share = f"share/{owner}/"
    found = {
        installed.path[len(share) :]
        for package in workspace.by_name.get(owner, ())
        for installed in package.built.products.installs
        if installed.path.startswith(share)
    }
    return tuple(sorted(found))


def _owner(package: Package, path: str, workspace: Workspace) -> str:
    """Return the hint that names the package which installs ``path``; "" if no package or several packages install it.

    If ``package`` itself installs ``path``, the hint names ``package`` in any case.
    """
    owners = {
        other.name
        for other in workspace.packages
        if any(provided.path == f"share/{other.name}/{path}" for provided in other.built.products.installs)
    }
    if package.name in owners:
        return f"; did you mean '{package.name}', which installs it?"
    return f"; did you mean '{owners.pop()}', which installs it?" if len(owners) == 1 else ""


def _hint(path: str, all_names: tuple[str, ...]) -> str:
    """Return the suggestion of an installed file: one with the same name, else one with a similar path, else "".

    ``robot.urdf`` and ``robot.urdf.xacro`` count as the same name.
    """
    base = path.rpartition("/")[2]
    alike = names.of_same_kind(path, _by_base(all_names).get(_without_xacro(path), ()))
    if same := [name for name in alike if name.rpartition("/")[2] == base] or alike:
        return names.did_you_mean(names.similar_names(path, same, 1, 0))
    meant = names.of_same_kind(path, all_names)
    near = [name for name in names.near_names(path, meant, 3, 0.8) if names.near_names(base, [name.rpartition("/")[2]], 1, 0.6)]
    return names.did_you_mean(near[:1])


@lru_cache(maxsize=8)
def _by_base(paths: tuple[str, ...]) -> Mapping[str, tuple[str, ...]]:
    """Return files by their names without ``.xacro``."""
    result: dict[str, list[str]] = {}
    for path in paths:
        result.setdefault(_without_xacro(path), []).append(path)
    return {base: tuple(same) for base, same in result.items()}


def _without_xacro(path: str) -> str:
    """Return the name of a file as xacro would write it: ``robot.urdf`` for ``urdf/robot.urdf.xacro``."""
    return path.rpartition("/")[2].removesuffix(".xacro")


RULE = Rule(
    name="launch-missing-include",
    code="ROS505",
    summary="files that launch files include or name exist in their packages",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    workspace=check,
)
