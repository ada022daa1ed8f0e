"""
## What it finds

Paths that work only on one machine or in the root of one workspace:

- A path below a home directory (`/home/jay/ros2_ws/src/robot/config/robot.yaml`), written out in a launch file, program, model,
  parameter file or build script.
- A path to a file of a package below the source folder (`src/robot/config/robot.yaml`) or below a workspace in the home directory
  (`~/ros2_ws/src/robot/config/robot.yaml`).
- A path that climbs from an installed folder to the sources: `os.path.join(share, '../../../../src/robot/config/robot.yaml')`.

One rule reports all of them, because each leads to the sources or files of one machine instead of the installed file.

## Why it matters

A path below a home directory exists on one machine only. On the next machine, in a container and on the robot the launch fails,
or a node starts without its parameters. A path to the sources bypasses the installed file. `src/...` works only if the program is
started in the root of the workspace.

## How to fix it

For a file of a package, look up the package:

- Python: `get_package_share_directory('robot')` or `FindPackageShare`.
- XML and YAML launch files: `$(find-pkg-share robot)`.
- Models: `package://robot/` or `$(find robot)/`. For Gazebo: `model://robot/` if the folder above the share directory
  is in the resource path (`<gazebo_ros gazebo_model_path="${prefix}/.."/>`), or `model://box` for a model in a folder of the
  resource path. For parameters that a plugin opens: `$(find robot)/`, which xacro replaces.
- A model that xacro generated: generate it in the launch file in place of keeping it.
- Exports of `package.xml`: `${prefix}/`.

Other files:

- Parameter files cannot look up packages: pass the path from the launch file.
- The image of a map: its file name, if it is next to the map file.
- Programs: start them with `ros2 run` or as nodes.
- Data, devices and output files of a machine: a launch argument, or a parameter without such a default.
- Meshes of a MuJoCo model: a `meshdir` relative to the folder of the model.
- The Python of a virtual environment, as `executable` in `setup.cfg`: `/usr/bin/env python3`.

If the file is not in the share directory yet, install it first; the message says so.

## Limitations

One path in several files of a package is reported once. Not reported:

- Comments, docstrings, tests, examples and documentation.
- Help texts: `description=` of a launch argument or a parameter, and `help=` of an option of a program.
- CMake files that are not part of the build or that a build generated, and launch files of ROS 1.
- Model files that an RViz configuration mentions, if the robot comes from a topic: RViz does not read them.
- Paths that are composed at run time, such as `'/home/' + user` and `join(root, 'src/robot')`.
- Paths below `~`, unless they name an existing file of a workspace package.
- Paths with `src/` or `~` in build scripts, or to files that no package of the workspace has.
- Paths relative to the package folder: see `launch-relative-path`.

The confidence is high if the path leads to a file or source folder of this workspace and the file with the path is installed,
built or launched. Reported with medium confidence:

- Other paths, because they may be right on the machine that the package is made for.
- Paths to a workspace next to the home directories (`/home/ws/src`), which is usual in containers.
- Files in `experiments`, which record a run on one machine.
- Files that nothing installs, builds or launches.
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from ros_lint.api import (
    Confidence,
    Facet,
    Finding,
    MachinePath,
    Package,
    Related,
    Rule,
    Severity,
    Workspace,
    cached_by_workspace,
    files,
    first_related,
    launch,
)

_BUILDING = ("CMakeLists.txt", ".cmake", "setup.py")
_OF_GAZEBO = (".sdf", ".world")
_MODELS = (".urdf", ".xacro", ".srdf", ".rviz")
_PROGRAMS = (".py", ".c", ".cc", ".cpp", ".cxx", ".h", ".hpp")
_IMAGES = (".pgm", ".png", ".bmp")
"""Suffixes of images of maps. A map file names its image relative to its own folder."""


class _Inside(NamedTuple):
    """The package of the workspace to which a machine path leads. A machine path exists only on its author's machine."""

    package: str
    rest: str
    """The path relative to the folder of the package; "" for the folder itself, or if the package has no such file."""
    whole: bool
    """True if the path leads to the folder of the package itself, not to a file in it."""
    program: str
    """The name of the file for ``ros2 run``, "" if the package does not install it as a program."""


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    if not package.machine_paths:
        return
    used = launch.used_files(package)
    by_file: dict[tuple[str, str], list[tuple[MachinePath, _Inside | None]]] = {}
    for machine in package.machine_paths:
        file = package.relative(machine.span.path)
        if machine.distribution:  # distribution-path reports these
            continue
        if files.is_auxiliary(file) or (
            file.endswith(".cmake") and (file not in used or _STAGED.search(file))
        ):  # generated by a build
            continue
        if file.endswith(".launch") and not launch.is_launch_file(package, machine.span.path):  # ROS 1
            continue
        inside = _inside(machine.path, workspace)
        if machine.path.startswith("/") or (inside and not file.endswith((*_BUILDING, "package.xml"))):
            by_file.setdefault((file, inside.package if inside else ""), []).append((machine, inside))
    by_message: dict[tuple[str, Confidence], list[tuple[MachinePath, _Inside | None]]] = {}
    for (file, _), places in by_file.items():
        first, inside = places[0]
        excused = _is_of_container(first.path) or not _RECORDS.isdisjoint(file.split("/"))
        certain = inside is not None and file in used and not excused
        confidence = Confidence.HIGH if certain or _is_interpreter(first, file) else Confidence.MEDIUM
        message = f"'{first.path}' {_where(first.path)}; {_remedy(first, inside, file, package, workspace)}"
        by_message.setdefault((message, confidence), []).extend(places)
    for (message, confidence), ((first, _), *others) in by_message.items():
        related = first_related(
            Related(f"'{other.path}' {'is also named here' if other.path == first.path else 'has the same problem'}", other.span)
            for other, _ in others
        )
        yield Finding(message, first.span, first.path, related, confidence=confidence)


def _is_interpreter(machine: MachinePath, file: str) -> bool:
    """Return whether a path in ``setup.cfg`` is that of the Python interpreter (``[build_scripts] executable``)."""
    return file == "setup.cfg" and _PYTHON.search(machine.path) is not None


_PYTHON = re.compile(r"/bin/python[\d.]*\Z")


def _where(path: str) -> str:
    if path.startswith("~"):
        return "exists only if the workspace is at this place in the home directory"
    if path.startswith("../"):
        return "leads to the sources, which exist only where the workspace is built"
    return (
        "exists on one machine only"
        if path.startswith("/")
        else "is only found if the program is started in the root of the workspace"
    )


def _remedy(machine: MachinePath, inside: _Inside | None, file: str, package: Package, workspace: Workspace) -> str:
    if _is_interpreter(machine, file):
        return "all programs of the package would use it: write /usr/bin/env python3, or remove this option"
    if source := _source_of_generated(machine, package):
        return f"this file is generated from '{source}': remove it, and run xacro in the launch file"
    if machine.is_rviz_description:
        return "set 'Description Source' to Topic, because RViz does not resolve package:// in 'Description File'"
    if inside is None:
        return "make the path an argument, or move the file to a package"
    if machine.is_written:
        place = f"it is '{inside.rest}' of" if inside.rest else "it leads into the sources of"
        return f"{place} '{inside.package}' but is written at run time: {_without_file(machine, inside, file, package)}"
    if inside.whole and not file.endswith((*_BUILDING, "package.xml")) and not _scheme(inside, file) and not _is_yaml(file):
        return f"it is the folder of '{inside.package}': look up the share directory of '{inside.package}'"
    if not inside.rest:
        return f"it leads into the sources of '{inside.package}': {_without_file(machine, inside, file, package)}"
    it_is = f"it is '{inside.rest}' of '{inside.package}'"
    folder, _, name = inside.rest.rpartition("/")
    if inside.package == package.name and file.endswith(_BUILDING):
        return f"it is '{inside.rest}' of this package: write that relative path"
    if file == "package.xml":
        return f"{it_is}: write ${{prefix}}/{inside.rest}"
    if machine.relative_to_file:
        below = posixpath.relpath(inside.rest, posixpath.dirname(file)) if inside.package == package.name else "a path"
        return f"{it_is}: write {below}, relative to the folder of this file"
    if inside.package == package.name and name.endswith(_IMAGES) and (folder, True) == (file.rpartition("/")[0], _is_yaml(file)):
        return f"{it_is}, next to this file: write {name}"
    if file.endswith(_OF_GAZEBO) and inside.rest.startswith("models/"):
        model = inside.rest.removeprefix("models/")
        return f"{it_is}: write model://{model}, and add the folder 'models' to Gazebo's resource path"
    if file.endswith(".py") and (modules := _as_modules(inside, workspace)):
        return f"{it_is}: {modules}"
    if inside.program:
        return f"{it_is}: start it with ros2 run {inside.package} {inside.program}, or as a node"
    it_is += ": install it and " if _is_left_out(inside, workspace) else ": "
    if scheme := _scheme(inside, file):
        needs_xacro = scheme.startswith("$") and not file.endswith(".xacro")
        by_xacro = ", in a template from which xacro makes this file" if file.endswith(_OF_GAZEBO) else _BY_XACRO
        condition = by_xacro if needs_xacro else _resource_path(scheme, inside, workspace)
        return f"{it_is}write {scheme}/{inside.rest}{condition}"
    if _is_yaml(file) and not launch.is_launch_file(package, machine.span.path):
        return f"{it_is}pass the path from the launch file, which can look up the share directory of '{inside.package}'"
    return f"{it_is}look it up in the share directory of '{inside.package}'"


def _source_of_generated(machine: MachinePath, package: Package) -> str:
    """Return the xacro file from which a file was generated, "" if the package does not contain the xacro file.

    The generated file has the path ``machine``, which exists only on the machine of its author.
    """
    name = machine.generated_from.rpartition("/")[2]
    return next((file for file in sorted(package.files) if name and file.rpartition("/")[2] == name), "")


def _resource_path(scheme: str, inside: _Inside, workspace: Workspace) -> str:
    """Return the part of a remedy that says what to add to Gazebo's resource path, so that ``model://<package>`` is found.

    The result is "" if the manifest of the package adds the folder already, or ``scheme`` is not ``model://``. Gazebo searches
    the folders in ``gazebo_model_path`` of each ``package.xml`` for the folder of the package (gazebo_ros, ros_gz_sim).
    """
    elements = [
        element for package in workspace.by_name[inside.package] if package.manifest for element in package.manifest.exports
    ]
    is_found = any(element.get("gazebo_model_path").rstrip("/").endswith("..") for element in elements)
    if is_found or not scheme.startswith("model:"):
        return ""
    return f", and add the folder above the share directory of '{inside.package}' to Gazebo's resource path"


def _as_modules(inside: _Inside, workspace: Workspace) -> str:
    """Return the remedy for a path to a folder of Python modules, which a program adds to ``sys.path``; "" for other paths."""
    below = [
        file for package in workspace.by_name[inside.package] for file in package.files if file.startswith(f"{inside.rest}/")
    ]
    if f"{inside.rest}/__init__.py" in below:
        return f"import its modules from {inside.rest.removeprefix('src/').replace('/', '.')}"
    if below and all(file.endswith(".py") for file in below):
        return "remove the path, because Python finds modules next to the installed program"
    return ""


def _is_left_out(inside: _Inside, workspace: Workspace) -> bool:
    """Return whether the package certainly does not install the file to its share directory."""
    below = (f"{inside.rest}/", f"{inside.rest}.")
    for package in workspace.by_name[inside.package]:
        installed = [file.source for file in package.built.products.installs if file.path.startswith("share/")]
        if not package.built.path or package.hidden(Facet.SHARE):
            return False
        if any(source == inside.rest or source.startswith(below) for source in installed):
            return False
    return True


def _without_file(machine: MachinePath, inside: _Inside, file: str, package: Package) -> str:
    """Return the remedy for a path to a file that the package does not have."""
    if scheme := _scheme(inside, file):
        return f"add the file to '{inside.package}' and write {scheme}/ before its path in that package"
    defaults = [
        action.value
        for launch_file in package.launch
        if launch_file.path == machine.span.path
        for action in launch.walk_actions(launch_file.actions)
        if action.kind == "argument" and action.value is not None
    ]
    if any(machine.path in text for default in defaults for text in default.texts):
        return "change or remove the default of the argument"
    if machine.parameter_default:
        return "change or remove the default of the parameter"
    if _is_yaml(file) and not launch.is_launch_file(package, machine.span.path):
        return "pass the path from the launch file"
    program = file.endswith(_PROGRAMS) and not file.endswith(_BUILDING) and not launch.is_launch_file(package, machine.span.path)
    return "make the path a parameter" if program else "make the path an argument"


def _scheme(inside: _Inside, file: str) -> str:
    """Return the prefix by which a model names a file of a package, e.g. ``package://robot``; "" if ``file`` is no model."""
    if not file.endswith((*_OF_GAZEBO, *_MODELS)):
        return ""
    if _is_yaml(inside.rest):  # a plugin opens its parameter file as a plain path, which xacro has to fill in
        return f"$(find {inside.package})"
    return f"{'model' if file.endswith(_OF_GAZEBO) else 'package'}://{inside.package}"


def _is_yaml(file: str) -> bool:
    return file.endswith((".yaml", ".yml"))


_STAGED = re.compile(r"(?:^|/)(?:(?:build|CMakeFiles|share/[^/]+/cmake)/|(?:cmake_install|CTestTestfile)\.cmake\Z)")
"""Pattern of paths to CMake files that a build generates, in a build folder or in an install prefix."""
_BY_XACRO = ", and process this file with xacro"
_RECORDS = frozenset({"experiment", "experiments"})
"""Names of folders with records of runs on one machine."""


def _is_of_container(path: str) -> bool:
    """Return whether a path is in a workspace next to the home directories, as in containers: ``/home/ws/src/robot``."""
    return path.startswith("/") and path.split("/")[3] in ("src", "install")


def _inside(path: str, workspace: Workspace) -> _Inside | None:
    """Return the package of the workspace that a path leads to, None if there is none.

    A folder of the path must have the name of the package or of its folder, and the package must contain the rest of the path:
    ``config/a.yaml`` of ``/home/me/ws/src/robot/config/a.yaml``. Below ``src`` the file may be missing, because a program may
    create it.
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
        if "src" in parts[3:at]:  # its Python package has the same name: look at the folder above, too
            sources = _Inside(package.name, "", whole=not rest, program="")
    return sources


def _program(package: Package, file: str) -> str:
    """Return the name by which ``ros2 run`` starts a file of the package, "" if it is not installed to lib/<package>."""
    own = f"lib/{package.name}/"
    installed = [provided.path for provided in package.built.products.installs if provided.path.startswith(own)]
    sources = [provided.path for provided in package.built.products.installs if file and provided.source == file]
    entries = [
        own + entry.name for entry in package.built.products.entry_points if f"{entry.module.replace('.', '/')}.py" == file
    ]
    return next((path.removeprefix(own) for path in (*sources, *entries) if path in installed), "")


def _has(package: Package, path: str) -> bool:
    """Return whether a package has a file, a folder, or files that begin with the path (``maps/hall``)."""
    return path in package.files or any(file.startswith(f"{path}.") or path in files.folders_of(file) for file in package.files)


@cached_by_workspace
def _folders(workspace: Workspace) -> Mapping[str, Package]:
    """Return the packages of the workspace, each by the name of its folder and by its own name."""
    by_folder = {package.path.rpartition("/")[2]: package for package in workspace.packages if package.path}
    return by_folder | {package.name: package for package in workspace.packages}


RULE = Rule(
    name="machine-path",
    code="ROS418",
    summary="paths do not depend on the machine or on the current folder",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    package=check,
)
