"""
## What it finds

Files that are looked up in the share directory of a package of the workspace, exist in its sources, and are not installed
there: parameters, models, maps, displays and included files that launch files name. Also whole folders of such files
(`config/`, `urdf/`, `worlds/` ...) of which nothing is installed.

## Why it matters

At run time only the install space counts: "No such file or directory: .../install/robot/share/robot/config/robot.yaml".

## How to fix it

In `CMakeLists.txt` add the folder to `install(DIRECTORY ... DESTINATION share/${PROJECT_NAME})`; the fix does this. In
`setup.py` add an entry to `data_files`: `('share/' + package_name + '/config', glob('config/*'))`; the fix does this, too,
where `data_files` is written out and the files are not too many.

## When it keeps silent

- A part of the build script that cannot be followed may install the file, or one of its name from a folder that is chosen
  when it is built.
- Where the file does not exist at all: that is a matter of `launch-missing-include`.
- Launch files themselves: see `uninstalled-launch`.
- What a command of the build names, such as the file that `generate_parameter_library()` reads, is taken for its input.
- Pictures in `images/` and `media/` that nothing names: they are there for the documentation.
- A folder that nothing in the package names has medium confidence: it may serve documentation, or be left over. Not so if
  other folders of the kind are installed and its files serve at run time alone: displays, maps, models, textures, parameters;
  nor if the package builds, installs and tests nothing, so that it is there for these files; nor if they are parameters of
  nodes (`ros__parameters`), and the package has nodes. A launch file that looks a file of the name up in another package
  names that one, and what lies here may be a copy.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import (
    LAUNCH_NAMES,
    Confidence,
    Facet,
    Finding,
    Fix,
    Package,
    Related,
    Rule,
    Severity,
    Span,
    Workspace,
    cmake_edits,
    few,
    from_base,
    is_apart,
    launchable,
    relative,
    setup_edits,
    several,
    uninstalled_resources,
)

_PLAIN = frozenset({"py", "sh", "txt", "md"})
_DOCUMENTS = frozenset({"images", "media", "data"})
_PICTURES = frozenset({"images", "media"})
_PICTURE = (".png", ".jpg", ".jpeg")
_FOR_RUN_TIME = frozenset(
    {"config", "configs", "launch", "maps", "meshes", "models", "param", "params", "rviz", "urdf", "worlds", "world"}
)
_RUN_TIME = (
    ".dae", ".obj", ".pgm", ".rviz", ".sdf", ".srdf", ".stl", ".urdf", ".wbt", ".world", ".xacro", ".yaml", ".yml",
)  # fmt: skip
"""What serves at run time, and nowhere else."""


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with not in ("ament_cmake", "ament_python"):
        return
    installed = {provided.path for provided in script.provides}
    kept = {provided.source for provided in script.provides if provided.source}
    missing: dict[str, list[tuple[str, Span]]] = {}
    files = frozenset(package.files)
    folders = frozenset(file.partition("/")[0] for file in package.files if _is_resource(file))
    for look_up in workspace.looked_up.get(package.name, ()):
        path, span = look_up.path.rstrip("/"), look_up.span
        place = f"share/{package.name}/{path}"
        if place in installed or path.endswith(LAUNCH_NAMES) or not (path in files or path in folders):
            continue
        if any(each.startswith(f"{place}/") for each in installed) or package.hidden(Facet.SHARE, place):
            continue
        missing.setdefault(_unit(path, kept), []).append((path, span))
    for unit, found in missing.items():
        yield _named(package, unit, found)
    if package.hidden(Facet.SHARE):
        return
    told = {unit.partition("/")[0] for unit in missing}
    yield from _folders(package, kept, told)


def _is_resource(path: str) -> bool:
    """Whether a file is one of a folder that a launch file or a program can look up as a whole."""
    return "/" in path and path.lower().endswith(_RUN_TIME) and not is_apart(path)


def _unit(path: str, kept: set[str]) -> str:
    """Return what to install: the topmost folder of the file, if nothing of it is installed so far, else the file."""
    top, inside, _ = path.partition("/")
    if not inside and "." not in top:
        return f"{top}/"
    return f"{top}/" if "/" in path and not any(source.startswith(f"{top}/") for source in kept) else path


def _named(package: Package, unit: str, found: list[tuple[str, Span]]) -> Finding:
    script = package.script
    assert script is not None
    paths = sorted({path for path, _ in found} - {unit.rstrip("/")})
    named = few(path.rpartition("/")[2] for path in paths)
    inside = f"{named} is looked up in it" if unit.endswith("/") and paths else "is looked up at run time"
    return Finding(
        f"{unit} is not installed, and {inside}; install it to share/{package.name}",
        setup_edits.place(script),
        unit,
        several(Related("looked up here", span) for _, span in found),
        _fix(package, unit),
    )


def _folders(package: Package, kept: set[str], told: set[str]) -> Iterator[Finding]:
    """Speak of folders of resources of which nothing is installed."""
    script = package.script
    assert script is not None
    launches = {launch.path for launch in launchable(package)}
    places = dict(script.named)
    inputs = frozenset(script.inputs)
    # What is installed from a place that is not known, such as one of several folders, may be any file of the name.
    chosen = frozenset([provided.path.rpartition("/")[2] for provided in script.provides if not provided.source])
    shared = _shared(package) or _makes_nothing(package)
    of_nodes = _of_nodes(package)
    elsewhere = _looked_up_elsewhere(package)
    for folder, found in uninstalled_resources(package.files, kept).items():
        files = [file for file in found if file not in launches and file not in inputs]
        if any(file.rpartition("/")[2] in chosen for file in files):
            continue
        if folder.partition("/")[0] in _PICTURES and not any(file in places for file in files):
            files = [file for file in files if not file.lower().endswith(_PICTURE)]
        if (
            not files
            or folder.partition("/")[0] in told
            or (folder != "controllers" and all(file.rpartition(".")[2] in _PLAIN for file in files))
        ):
            continue
        # What the files say of each other tells nothing of who reads the first of them.
        below = from_base(package, f"{folder}/")
        named = [file for file in files if file in places and not places[file].path.startswith(below)]
        looked_up = [file for file in named if (places[file].path, file.rpartition("/")[2]) not in elsewhere]
        copies = {name for _, name in elsewhere}.intersection(file.rpartition("/")[2] for file in files if file not in looked_up)
        shown = [file.rpartition("/")[2] for file in named + [file for file in files if file not in places]]
        examples = few(shown)
        yield Finding(
            f"{folder}/ ({examples}) is not installed, so nothing finds it at run time; install it to share/{package.name}",
            setup_edits.place(script),
            f"{folder}/",
            several(Related(f"{file.rpartition('/')[2]} is named here", places[file]) for file in looked_up),
            fix=_fix(package, f"{folder}/") if "/" not in folder else None,
            confidence=_confidence(folder, files, looked_up, shared and not copies and f"{folder}/" not in inputs, of_nodes),
            severity=Severity.WARNING,
        )


def _looked_up_elsewhere(package: Package) -> frozenset[tuple[str, str]]:
    """Return launch files with the names of files that they look up in other packages, and not in this one."""
    files = [each for launch in package.launch for each in launch.references if each.kind in ("file", "include")]
    own = {(each.span.path, each.name.rpartition("/")[2]) for each in files if each.package == package.name}
    return frozenset([(each.span.path, each.name.rpartition("/")[2]) for each in files]) - own


def _shared(package: Package) -> bool:
    """Whether a package installs other folders of files for run time, so that this one is forgotten."""
    script = package.script
    assert script is not None
    share = f"share/{package.name}/"
    return any(
        provided.path.startswith(share) and provided.source.partition("/")[0] in _FOR_RUN_TIME for provided in script.provides
    )


def _makes_nothing(package: Package) -> bool:
    """Whether a package has nothing for its users, so that the files that it has are what it is there for.

    One that is called after tests or examples may keep them where it lies.
    """
    script = package.script
    return script is not None and script.makes_nothing and not is_apart(f"{package.name.replace('_', '/')}/")


def _of_nodes(package: Package) -> frozenset[str]:
    """Return the files with parameters of nodes, for a package that installs nodes."""
    script = package.script
    assert script is not None
    installs = script.components or any(provided.path.startswith(f"lib/{package.name}/") for provided in script.provides)
    if not installs or "example" in package.name:
        return frozenset()
    return frozenset(relative(package, file.path) for file in package.parameter_files if file.nodes)


def _confidence(folder: str, files: list[str], looked_up: list[str], shared: bool, of_nodes: frozenset[str]) -> Confidence:
    if looked_up:
        return Confidence.HIGH
    if folder.partition("/")[0] in _DOCUMENTS:
        return Confidence.LOW
    for_run_time = any((file.endswith(_RUN_TIME) or "/textures/" in file) and "example" not in file for file in files)
    for_nodes = any(file in of_nodes and "example" not in file for file in files)
    return Confidence.HIGH if (shared and for_run_time) or for_nodes else Confidence.MEDIUM


_MOST_LISTED = 12
"""Files that a fix lists or globs in ``data_files``; a folder with more may need another way."""


def _fix(package: Package, unit: str) -> Fix | None:
    script = package.script
    assert script is not None
    folder, _, name = unit.rpartition("/")
    edit = None
    if script.path.endswith("CMakeLists.txt"):
        edit = cmake_edits.install_files(script, [unit], folder) if name else cmake_edits.install_folder(package, folder)
    elif slot := setup_edits.slot(script, "data_files"):
        paths = [unit] if name else [file for file in package.files if file.startswith(unit)]
        edit = setup_edits.add_files(slot, package.name, paths, package.files) if len(paths) <= _MOST_LISTED else None
    return Fix.of(f"install {unit}", edit)


RULE = Rule(
    name="uninstalled-resource",
    code="ROS402",
    summary="a file that is looked up at run time must be installed",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
