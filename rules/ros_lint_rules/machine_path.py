"""
## What it finds

A path below somebody's home directory (`/home/jay/ros2_ws/src/robot/config/robot.yaml`), written out in a launch file, a
program, a model, parameters or a build script. And a path to a file of a package from the folder that its sources are in
(`src/robot/config/robot.yaml`), or from the workspace in whoever's home (`~/ros2_ws/src/robot/config/robot.yaml`). And one
from the folder of the package, `config/robot.yaml`, that a launch file gives to a node for its parameters, gives to RViz, or
includes.

## Why it matters

It is there on one machine only. On the next one, in a container and on the robot the launch stops, or a node starts without
its parameters; and where the path leads into the sources, it passes by what is installed. One that begins with `src/` is there
for whoever starts the program in the root of the workspace, and `config/robot.yaml` for whoever launches in the folder of the
package: it counts from there, and not from the launch file.

## How to fix it

A file of a package is found by the package: `get_package_share_directory('robot')` and `FindPackageShare` in Python,
`$(find-pkg-share robot)` in XML and YAML launch files, `package://robot/` and `$(find robot)/` in models, `model://robot/` in
those of Gazebo, or `model://box` for a model in a folder that is in its resource path, `${prefix}/` in what `package.xml`
exports. A plugin that opens its parameters by itself gets `$(find robot)/`, which xacro fills in. Parameters cannot look up
anything: the launch file gives such ones. A map finds its image beside it. A program is started by `ros2 run`, or as a node.
What belongs to the machine, such as data, a device or what is written there, becomes a launch argument or a parameter
without such a default. What the share directory lacks is installed first, as the message says. A model for MuJoCo looks up
nothing: its `meshdir` counts from the folder of the file. The Python of an environment, as `executable` in `setup.cfg`, is
`/usr/bin/env python3`: the one that is active. One path in several files of a package is told once.

## Limitations

- In comments and docstrings, in tests, examples and documentation, in CMake files that are no part of the build or that a
  build has left, in launch files of ROS 1. In a display of RViz whose robot comes from a topic: the file that it keeps is not
  read.
- Of paths that are put together, such as `'/home/' + user` and `join(root, 'src/robot')`, and of `~`: these are meant for
  whoever runs it. But `~/ros2_ws/src/robot/map.yaml` is told where a package of the workspace has that file.
- Of `src/` and `~` in build scripts, and where no package of the workspace has such a file. Of `config/robot.yaml` where the
  package has no such file, for a process whose folder the launch file sets (`cwd`), and among arguments that only the program
  knows.
- The confidence is high where the path leads to a file of this workspace, or into a folder of its sources, and the file that
  names it is used: installed, built or launched. It is medium for other paths, which may be right on the machine that the
  package is made for, for a workspace beside the homes of users (`/home/ws/src`), which is one of a container, in records of
  `experiments`, which say how it was on one machine, and where nothing is seen to use the file.
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import NamedTuple

from ros_lint.api import (
    Confidence,
    Facet,
    Finding,
    LaunchAction,
    LaunchValue,
    MachinePath,
    Package,
    Related,
    Rule,
    Severity,
    Span,
    Workspace,
    defaults_of,
    everything,
    filled,
    folders_of,
    is_apart,
    is_launched,
    launchable,
    per_workspace,
    relative,
    several,
    used_files,
)

_BUILDING = ("CMakeLists.txt", ".cmake", "setup.py")
_OF_GAZEBO = (".sdf", ".world")
_MODELS = (".urdf", ".xacro", ".srdf", ".rviz")
_PROGRAMS = (".py", ".c", ".cc", ".cpp", ".cxx", ".h", ".hpp")
_IMAGES = (".pgm", ".png", ".bmp")
"""What a map has beside it."""


class _Inside(NamedTuple):
    """Where in the workspace a path of somebody's machine leads."""

    package: str
    rest: str
    """What the package has there, below its folder; "" where it has nothing, or the folder itself is meant."""
    whole: bool
    """Whether the folder itself is meant."""
    program: str
    """What ``ros2 run`` calls the file, "" if it is not installed as a program of the package."""


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    if package.machine_paths:
        yield from _written_out(package, workspace)
    yield from _from_the_package(package, workspace)


def _written_out(package: Package, workspace: Workspace) -> Iterator[Finding]:
    """Speak of paths below a home directory, and of those that begin with ``src/``."""
    used = used_files(package)
    by_file: dict[tuple[str, str], list[tuple[MachinePath, _Inside | None]]] = {}
    for each in package.machine_paths:
        file = relative(package, each.span.path)
        if each.distribution:  # of which distribution-path speaks
            continue
        if is_apart(file) or (file.endswith(".cmake") and (file not in used or _STAGED.search(file))):  # builds leave those
            continue
        if file.endswith(".launch") and not is_launched(package, each.span.path):  # a launch file of ROS 1
            continue
        inside = _inside(each.path, workspace)
        if each.path.startswith("/") or (inside and not file.endswith((*_BUILDING, "package.xml"))):
            by_file.setdefault((file, inside.package if inside else ""), []).append((each, inside))
    told: dict[tuple[str, Confidence], list[tuple[MachinePath, _Inside | None]]] = {}
    for (file, _), found in by_file.items():
        first, inside = found[0]
        doubted = _is_of_container(first.path) or not _RECORDS.isdisjoint(file.split("/"))
        found_here = inside is not None and file in used and not doubted
        sure = Confidence.HIGH if found_here or _is_interpreter(first, file) else Confidence.MEDIUM
        says = f"{first.path} {_where(first.path)}: {_way_out(first, inside, file, package, workspace)}"
        told.setdefault((says, sure), []).extend(found)
    for (says, sure), ((first, _), *others) in told.items():
        related = several(
            Related("and here" if other.path == first.path else f"and {other.path}", other.span) for other, _ in others
        )
        yield Finding(says, first.span, first.path, related, confidence=sure)


def _from_the_package(package: Package, workspace: Workspace) -> Iterator[Finding]:
    """Speak of files of the package that launch files name as they lie in it: such a path counts from where people launch."""
    if not package.launch:
        return
    files = frozenset(package.files)
    named: dict[str, list[tuple[bool, Span]]] = {}
    for launch in launchable(package):
        defaults = defaults_of(launch.file)
        for action in everything(launch.file.actions):
            for value in _read_by_path(action):
                texts = filled(value, defaults)
                path = posixpath.normpath(texts[0]) if len(texts) == 1 else ""
                if path in files and all(name != "cwd" for name, _ in action.arguments):
                    named.setdefault(path, []).append((launch.installed, value.span))
    for path, places in named.items():
        inside = _Inside(package.name, path, whole=False, program="")
        install = "install it, and " if _is_left_out(inside, workspace) else ""
        # Of one path in several places, the finding lies where a launch file is installed that says it.
        (installed, first), *others = sorted(places, key=lambda place: not place[0])
        yield Finding(
            f"{path} is found from the folder of {package.name} only: {install}look it up in its share directory",
            first,
            path,
            tuple(Related("and here", each) for _, each in others),
            confidence=Confidence.HIGH if installed else Confidence.MEDIUM,
        )


def _read_by_path(action: LaunchAction) -> Iterator[LaunchValue]:
    """Yield what names a file that is opened where the launch is started: parameters, displays and included launch files."""
    if action.kind == "include" and action.target is not None:
        yield action.target
    if action.kind in ("node", "component"):
        yield from (value for name, value in action.parameters if not name)
    words = [value for name, value in action.arguments if not name] if action.kind == "node" else []
    yield from (file for flag, file in pairwise(words) if _GIVES_FILE.issuperset(flag.texts))


_GIVES_FILE = frozenset({"-d", "--display-config", "--params-file"})
"""Options of RViz and of every node."""


def _is_interpreter(machine: MachinePath, file: str) -> bool:
    """Whether a path is what the programs of a Python package are started with: ``[build_scripts] executable``."""
    return file == "setup.cfg" and _PYTHON.search(machine.path) is not None


_PYTHON = re.compile(r"/bin/python[\d.]*\Z")


def _where(path: str) -> str:
    if path.startswith("~"):
        return "is there only for whoever calls the workspace so"
    return "is there on one machine only" if path.startswith("/") else "is found from the root of the workspace only"


def _way_out(machine: MachinePath, inside: _Inside | None, file: str, package: Package, workspace: Workspace) -> str:
    if _is_interpreter(machine, file):
        return "all programs of the package would start with it; write /usr/bin/env python3, or take it out"
    if inside is None:
        return "make it an argument, or a file of a package"
    if machine.written:
        place = f"it is {inside.rest} of" if inside.rest else "it leads into the sources of"
        return f"{place} {inside.package}, and is written to; {_without_file(machine, inside, file, package)}"
    if inside.whole and not file.endswith((*_BUILDING, "package.xml")) and not _scheme(inside, file) and not _is_yaml(file):
        return f"it is the folder of {inside.package}; look up the share directory of {inside.package}"
    if not inside.rest:
        return f"it leads into the sources of {inside.package}; {_without_file(machine, inside, file, package)}"
    it_is = f"it is {inside.rest} of {inside.package}"
    folder, _, name = inside.rest.rpartition("/")
    if inside.package == package.name and file.endswith(_BUILDING):
        return f"it is {inside.rest} of this package; write that"
    if file == "package.xml":
        return f"{it_is}; say ${{prefix}}/{inside.rest}"
    if machine.beside:
        below = posixpath.relpath(inside.rest, posixpath.dirname(file)) if inside.package == package.name else "a path"
        return f"{it_is}; say {below}, which counts from the folder of this file"
    if inside.package == package.name and name.endswith(_IMAGES) and (folder, True) == (file.rpartition("/")[0], _is_yaml(file)):
        return f"{it_is}, beside this file; say {name}"
    if file.endswith(_OF_GAZEBO) and inside.rest.startswith("models/"):
        model = inside.rest.removeprefix("models/")
        return f"{it_is}; say model://{model}, with this folder of models in Gazebo's resource path"
    if file.endswith(".py") and (modules := _as_modules(inside, workspace)):
        return f"{it_is}; {modules}"
    if inside.program:
        return f"{it_is}; start it with ros2 run {inside.package} {inside.program}, or as a node"
    it_is += "; install it, and " if _is_left_out(inside, workspace) else "; "
    if scheme := _scheme(inside, file):
        filled_in = scheme.startswith("$") and not file.endswith(".xacro")
        return f"{it_is}say {scheme}/{inside.rest}" + (", and let xacro fill it in" if filled_in else "")
    if _is_yaml(file) and not is_launched(package, machine.span.path):
        return f"{it_is}let the launch file give it, from the share directory of {inside.package}"
    return f"{it_is}look it up in the share directory of {inside.package}"


def _as_modules(inside: _Inside, workspace: Workspace) -> str:
    """Return what to do about a folder of modules that is named for Python to look there, "" for any other place."""
    below = [
        file for package in workspace.by_name[inside.package] for file in package.files if file.startswith(f"{inside.rest}/")
    ]
    if f"{inside.rest}/__init__.py" in below:
        return f"import what is in it as modules of {inside.rest.removeprefix('src/').replace('/', '.')}"
    if below and all(file.endswith(".py") for file in below):
        return "Python finds what is installed beside a program without it"
    return ""


def _is_left_out(inside: _Inside, workspace: Workspace) -> bool:
    """Whether a package is seen not to install what it has at a place to where it is looked up."""
    below = (f"{inside.rest}/", f"{inside.rest}.")
    for package in workspace.by_name[inside.package]:
        there = [each.source for each in package.built.provides if each.path.startswith("share/")]
        if not package.built.path or package.hidden(Facet.SHARE):
            return False
        if any(source == inside.rest or source.startswith(below) for source in there):
            return False
    return True


def _without_file(machine: MachinePath, inside: _Inside, file: str, package: Package) -> str:
    """Return what to do about a path to what the package does not have."""
    if scheme := _scheme(inside, file):
        return f"put the file into a package, and say {scheme}/ before its path there"
    defaults = [
        action.value
        for launch in package.launch
        if launch.path == machine.span.path
        for action in everything(launch.actions)
        if action.kind == "argument" and action.value is not None
    ]
    if any(machine.path in text for default in defaults for text in default.texts):
        return "the argument needs another default, or none"
    if machine.default:
        return "the parameter needs another default, or none"
    if _is_yaml(file) and not is_launched(package, machine.span.path):
        return "let the launch file give it"
    program = file.endswith(_PROGRAMS) and not file.endswith(_BUILDING) and not is_launched(package, machine.span.path)
    return "make it a parameter" if program else "make it an argument"


def _scheme(inside: _Inside, file: str) -> str:
    """Return how a model says that a file is in a package, "" for other files. What it reads by itself xacro has to fill in."""
    if not file.endswith((*_OF_GAZEBO, *_MODELS)):
        return ""
    if _is_yaml(inside.rest):  # parameters of a plugin, which opens what it is given
        return f"$(find {inside.package})"
    return f"{'model' if file.endswith(_OF_GAZEBO) else 'package'}://{inside.package}"


def _is_yaml(file: str) -> bool:
    return file.endswith((".yaml", ".yml"))


_STAGED = re.compile(r"(?:^|/)(?:build|share/[^/]+/cmake)/")
"""Where builds put the CMake files of a package: their own folder, and one that is packed or installed."""
_RECORDS = frozenset({"experiment", "experiments"})
"""Folders that say how something was tried."""


def _is_of_container(path: str) -> bool:
    """Whether a path lies in a workspace that is no user's home, but beside those: ``/home/ws/src/robot``."""
    return path.startswith("/") and path.split("/")[3] in ("src", "install")


def _inside(path: str, workspace: Workspace) -> _Inside | None:
    """Return where in the workspace a path leads: below a folder that is called as a package, to what that package has.

    Below ``src`` it need not have it: what is to be written there is a path into its sources, too.
    """
    folders = _folders(workspace)
    parts = path.split("/")
    sources = None
    for at in range(len(parts) - 1, 2 if path.startswith("/") else 0, -1):
        package = folders.get(parts[at])
        if package is None:
            continue
        rest = "/".join(parts[at + 1 :])
        if _has(package, rest):
            return _Inside(package.name, rest, whole=not rest, program=_program(package, rest))
        if "src" in parts[3:at]:  # the module of a package has its name, too: it may be the folder above that is meant
            sources = _Inside(package.name, "", whole=not rest, program="")
    return sources


def _program(package: Package, file: str) -> str:
    """Return by which name a file of a package is started where it is installed as its program (reference, section D5), or ""."""
    own = f"lib/{package.name}/"
    installed = [provided.path for provided in package.built.provides if provided.path.startswith(own)]
    sources = [provided.path for provided in package.built.provides if file and provided.source == file]
    entries = [own + entry.name for entry in package.built.entry_points if f"{entry.module.replace('.', '/')}.py" == file]
    return next((path.removeprefix(own) for path in (*sources, *entries) if path in installed), "")


def _has(package: Package, path: str) -> bool:
    """Whether a package has a file, a folder, or files of which a program is told but the beginning (``maps/hall``)."""
    return path in package.files or any(file.startswith(f"{path}.") or path in folders_of(file) for file in package.files)


@per_workspace
def _folders(workspace: Workspace) -> Mapping[str, Package]:
    """Return the packages by the names of their folders, and by their own."""
    found = {package.path.rpartition("/")[2]: package for package in workspace.packages if package.path}
    return found | {package.name: package for package in workspace.packages}


RULE = Rule(
    name="machine-path",
    code="ROS418",
    summary="a path must lead to the same file on every machine, and wherever a program is started",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    package=check,
)
