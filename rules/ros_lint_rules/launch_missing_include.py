"""
## What it finds

A launch file that includes a launch file, or names a parameter, model, map or display file, which its package does not
have: neither installed there nor in its sources. Likewise an installed model, display or parameter file, URDF and xacro among
them, that looks up a mesh or another file in a package of the workspace.

So are files that MoveIt's builders read from the package that they are made for:
`MoveItConfigsBuilder("arm").joint_limits(file_path="config/joint_limits.yaml")`.

A file that an included launch file names with what it is passed, `$(var folder)/robot.yaml`, is looked for as it is when
one is launched that includes it, itself or by way of others.

## Why it matters

The launch file stops, or the node comes up without its parameters. xacro stops at a file to include that is not there; of a
mesh that is not there, RViz and Gazebo show nothing.

## How to fix it

Correct the path; the message names files of the same name that the package does install, or the package that has the file.

## Limitations

- The file is in the sources and not installed: that is `uninstalled-resource`.
- A part of the package's build script that cannot be followed may install it.
- Files that look as if something writes or downloads them: networks, records, images; folders. Not so what a node reads
  for certain: parameters, the displays of rviz2. Maps, which people make with the robot, what lies in a
  folder for what is made (`temp`, `tmp`, `generated`), and what git ignores have medium confidence, and so have records beside
  which one of nearly the same name is installed; unless that one is the only one that nothing names.
- For a released package: neither are its launch files known whole, nor those for an earlier and a later distribution, or
  one of these has the file; other files of it are not known at all. Where nobody said which distribution is meant, the
  confidence is medium as long as one of them may have it.
- The launch file asks first if the package is there, or the file (`os.path.exists`), unless it stops where it is not; or it
  writes the file itself (`open(path, 'w')`, `xacro.open_output(path)`), or by a command (`xacro ... > path`).
- Models, displays and parameters that are not installed, or not in every build, and what xacro includes as `optional`. Where
  no launch file and no model is seen to look them up themselves, nobody may read them, and the confidence is medium.

Where the name hangs on the default of an argument, which others can replace, the confidence is medium.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ros_lint.api import (
    Confidence,
    Facet,
    Finding,
    LaunchFile,
    Package,
    PassedFile,
    Related,
    Rule,
    Severity,
    Span,
    Workspace,
    did_you_mean,
    is_apart,
    launchable,
    near_names,
    passed_files,
    referred,
    relative,
    several,
    similar,
)

_WRITTEN = (".yaml", ".yml", ".rviz", ".urdf", ".xacro", ".srdf", ".sdf", ".world", ".wbt", ".lua", ".launch", ".py", ".xml")
"""Kinds of files that people write and keep with the package."""
_MODELS = (".urdf", ".xacro", ".srdf", ".sdf", ".world", ".rviz", ".yaml", ".yml", ".xml")
"""Kinds of files that look up others in packages and are no programs."""


def check(workspace: Workspace) -> Iterator[Finding]:
    for package in workspace.packages:
        for finding in _named(package, workspace):
            yield finding._replace(package=package.name)
        for finding in _modelled(package, workspace):
            yield finding._replace(package=package.name)
    yield from _passed(workspace)


def _modelled(package: Package, workspace: Workspace) -> Iterator[Finding]:
    """Yield what is missing of the files that installed models, displays and parameters look up in packages of the workspace."""
    if not package.look_ups:
        return
    share = f"share/{package.name}/"
    installed = {p.source: p.path.removeprefix(share) for p in package.built.provides if p.source and not p.conditional}
    taken = {look_up.path for look_up in workspace.looked_up.get(package.name, ())}
    found: dict[tuple[str, str], list[tuple[bool, Span]]] = {}
    for look_up in package.look_ups:
        file, path = relative(package, look_up.span.path), look_up.path.lstrip("/")
        if file.endswith(_MODELS) and file in installed and look_up.package in workspace.by_name and not is_apart(file):
            found.setdefault((look_up.package, path), []).append((installed[file] not in taken, look_up.span))
    alike: dict[tuple[str, str, bool], list[tuple[str, str, Span, list[Span]]]] = {}
    for (owner, path), named in found.items():
        others_there = _files_without(owner, path, "file", workspace) if ".." not in path else None
        if others_there is not None:
            (idle, best), *others = sorted(named)
            sure = not (idle or _is_made(owner, path, workspace))
            hint = _hint(path, others_there)
            # A folder of meshes that is not there is one mistake.
            folder, _, name = path.rpartition("/")
            key = (owner, f"{folder} {best.path}" if not hint or hint.endswith(f"/{name}'?") else path, sure)
            alike.setdefault(key, []).append((path, hint, best, [place for _, place in others]))
    for (owner, _, sure), lacking in alike.items():
        (path, hint, first, beside), *more = lacking
        yield Finding(
            f"{owner} has no {path}{f', nor {len(more)} more of the folder that are named here' if more else ''}{hint}",
            first,
            path,
            several(
                [
                    *(Related("also named here", place) for place in beside),
                    *(Related(f"{name} is not there either", place) for name, _, place, _ in more),
                ]
            ),
            confidence=Confidence.HIGH if sure else Confidence.MEDIUM,
            severity=Severity.WARNING,
        )


def _named(package: Package, workspace: Workspace) -> Iterator[Finding]:
    """Yield what is missing of the files that launch files name by themselves."""
    for (owner, path), named in referred(package, ("include", "file")).items():
        references = [reference for reference in named if not (reference.optional or reference.asked)]
        if not references:
            continue
        best, *others = sorted(references, key=lambda one: (one.by_default, one.kind != "include", not one.read, one.span))
        others_there = _files_without(owner, path, best.kind, workspace)
        if others_there is None:
            continue
        written = best.kind == "include" or path.endswith(_WRITTEN) or any(one.read for one in references)
        written = written or _is_misspelt(path, others_there)
        twin = "" if written else _twin(path, others_there)
        if not written and not twin:
            continue
        meant = written or _is_left_over(twin, owner, others_there, workspace)
        sure = meant and workspace.surely_lacks(owner, "launch", path)
        yield Finding(
            f"{owner} has no {path}{_hint(path, others_there) or _owner(package, path, workspace)}",
            best.span,
            path,
            several(Related("also named here", other.span) for other in others),
            confidence=Confidence.HIGH
            if sure and not best.by_default and not _is_made(owner, path, workspace)
            else Confidence.MEDIUM,
        )


def _passed(workspace: Workspace) -> Iterator[Finding]:
    """Yield what is missing of the files that launch files name with what those pass on that include them."""
    links = workspace.links
    files = [(package, launch.file) for package in workspace.packages for launch in launchable(package)]
    including = [(package, file) for package, file in files if links.includes(file)]
    inner = {each.path for _, file in including for each in links.includes(file)}
    missing = _Missing(workspace)
    if not any(missing.passed_by(file) for _, file in including if file.path not in inner):
        return  # most workspaces are right, and to follow what others include costs as much again
    found: dict[_Key, tuple[PassedFile, Package, LaunchFile]] = {}
    for package, file in including:
        for key, one in missing.passed_by(file).items():
            if key not in found or one.depth < found[key][0].depth:
                found[key] = one, package, file
    for key, (one, package, file) in found.items():
        sure = one.sure and key in missing.passed_by(file, settled=True)
        others_there = _files_without(one.package, one.path, one.kind, workspace) or ()
        hint = _hint(one.path, others_there)
        yield Finding(
            f"{one.package} has no {one.path}, which an included file names with what it is passed here{hint}",
            one.via,
            one.path,
            (Related("named here", one.span),),
            confidence=Confidence.HIGH if sure and not _is_made(one.package, one.path, workspace) else Confidence.MEDIUM,
            package=package.name,
        )


class _Missing:
    """Which of the files that are passed on are missing; each is looked for once, and each launch file followed once."""

    def __init__(self, workspace: Workspace) -> None:
        self._workspace = workspace
        self._known: dict[tuple[str, str, str], bool] = {}
        self._passed: dict[tuple[str, bool], dict[_Key, PassedFile]] = {}

    def passed_by(self, file: LaunchFile, *, settled: bool = False) -> dict[_Key, PassedFile]:
        """Return what is missing when a file is launched, see :func:`passed_files`, by what it is and who names it.

        What a launch file names by itself is left out.
        """
        key = file.path, settled
        if key not in self._passed:
            self._passed[key] = self._among(passed_files(file, self._workspace, settled=settled))
        return self._passed[key]

    def _among(self, files: Iterable[PassedFile]) -> dict[_Key, PassedFile]:
        found: dict[_Key, PassedFile] = {}
        for one in files:
            place = (one.package, one.path, one.kind)
            if place not in self._known:
                self._known[place] = self._is_missing(one)
            if self._known[place]:
                found.setdefault((one.span, one.package, one.path), one)
        return found

    def _is_missing(self, one: PassedFile) -> bool:
        if one.kind != "include" and not one.path.endswith(_WRITTEN):
            return False
        if any(look_up.path == one.path for look_up in self._workspace.looked_up.get(one.package, ())):
            return False
        return _files_without(one.package, one.path, one.kind, self._workspace) is not None


_Key = tuple[Span, str, str]


def _twin(path: str, names: tuple[str, ...]) -> str:
    """Return a file of nearly the same name, and of the same kind, that is installed beside one, "" if there is none."""
    folder, _, base = path.rpartition("/")
    beside = [name.rpartition("/")[2] for name in names if _kind(name) == _kind(path)]
    near = similar(base, beside, 1, 0.8)
    return f"{folder}/{near[0]}".lstrip("/") if near else ""


def _is_misspelt(path: str, names: tuple[str, ...]) -> bool:
    """Whether the letters of the suffix are those of a file that is there in another order: x.yalm."""
    stem, _, suffix = path.rpartition(".")
    return any(name.startswith(f"{stem}.") and sorted(name[len(stem) + 1 :]) == sorted(suffix) for name in names)


def _kind(path: str) -> tuple[str, str]:
    """Return the folder and the suffix of a file."""
    folder, _, base = path.rpartition("/")
    return folder, base.rpartition(".")[2]


def _is_left_over(file: str, owner: str, names: tuple[str, ...], workspace: Workspace) -> bool:
    """Whether nothing looks up a file, while others of its kind beside it are looked up: then it is the one that is meant."""
    wanted = {look_up.path for look_up in workspace.looked_up.get(owner, ())}
    return file not in wanted and any(_kind(other) == _kind(file) for other in wanted.intersection(names))


def _is_made(owner: str, path: str, workspace: Workspace) -> bool:
    """Whether people make such a file with the robot, as they do maps and what git ignores, or programs do when they run."""
    if not _FILLED_LATER.isdisjoint(path.split("/")[:-1]):
        return True
    return any(workspace.is_made(one, path) for one in workspace.by_name.get(owner, ()))


_FILLED_LATER = frozenset({"generated", "map", "maps", "temp", "tmp"})


def _files_without(owner: str, path: str, kind: str, workspace: Workspace) -> tuple[str, ...] | None:
    """Return the files below share/<package> when this one is certainly not among them."""
    owners = workspace.by_name.get(owner, ())
    if not owners:
        known = workspace.world.launch_files(owner)
        return known.possible if kind == "include" and known.ask(path) == "missing" else None
    share = f"share/{owner}/"
    names: set[str] = set()
    for one in owners:
        if one.script is None or one.builds_with not in ("ament_cmake", "ament_python"):
            return None
        if one.hidden(Facet.SHARE, f"{share}{path}"):
            return None
        names.update(p.path[len(share) :] for p in one.script.provides if p.path.startswith(share))
        # What is in the sources and installed nowhere is told by another rule, also when the folders differ.
        installed = one.script.installed
        if any((file == path or file.endswith(f"/{path}")) and file not in installed for file in one.files):
            return None
        if any(path.startswith(f"{folder}/") for folder in (*one.unseen, *one.nested)):
            return None
    if path in names or any(name.startswith(f"{path}/") for name in names):
        return None
    return tuple(sorted(names))


def _owner(package: Package, path: str, workspace: Workspace) -> str:
    """Return that another package has a file: the one that names it, or else the only one of the workspace."""
    packages = [one for one in workspace.packages if any(p.path == f"share/{one.name}/{path}" for p in one.built.provides)]
    owners = {one.name for one in packages}
    if package.name in owners:
        return f"; {package.name} has it"
    return f"; {owners.pop()} has it" if len(owners) == 1 else ""


def _hint(path: str, names: tuple[str, ...]) -> str:
    base = path.rpartition("/")[2]
    same = [name for name in names if name.rpartition("/")[2] == base]
    near = [name for name in near_names(path, names, 3, 0.8) if near_names(base, [name.rpartition("/")[2]], 1, 0.6)]
    return did_you_mean(similar(path, same, 1, 0) or near[:1])


RULE = Rule(
    name="launch-missing-include",
    code="ROS505",
    summary="a file that a launch file includes or names must exist in its package",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    workspace=check,
)
