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

## Limitations

- A part of the build script that cannot be followed may install the file, or one of its name from a folder that is chosen
  when it is built.
- Where the file does not exist at all: that is a matter of `launch-missing-include`.
- Launch files themselves: see `uninstalled-launch`.
- A `CMakeLists.txt` has no command at all: that is a matter of `missing-ament-package`.
- What only launch files of ROS 1 look up: nobody launches them. The `joint_names_*.yaml` that the exporter of SolidWorks
  writes serves ROS 1, too.
- What a command of the build names, such as the file that `generate_parameter_library()` reads, is taken for its input.
- Pictures in `images/` and `media/` that nothing names: they are there for the documentation.
- Hidden folders and what lies in them, such as the history that an editor keeps; folders for what is put aside, such as `old`.
- A folder that nothing in the package names has medium confidence: it may serve documentation, be opened by hand from the
  sources, or be left over. Not so if it lies in a folder that is installed (`worlds/textures/`), and its files serve at run
  time alone: displays, maps, models, textures, parameters; nor if the package builds, installs and tests nothing, so that
  it is there for these files; nor if they are parameters of nodes (`ros__parameters`), and the package has nodes, or nothing
  but files; nor if they are models or worlds of a package that has nothing but files, and installs no other; nor if a file is
  looked up in it that is not even there, and that git does not leave out either. Examples and templates, as their names say,
  are copied and not looked up. Where a text names the folder as it lies in the sources
  (`/home/me/src/robot/maps/hall`, `'src', 'robot', 'maps'`), or code comes to it by a macro to which CMake gives the folder of
  the sources, it is found there: the confidence is medium. It is so where a program seeks its files in the folder that it is
  started from. A launch file that looks a file of the name up in another package names that one, and what lies here may be a
  copy.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from ros_lint.api import (
    LAUNCH_NAMES,
    BuildScript,
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
    folders_of,
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
_RUN_TIME = (
    ".dae", ".lua", ".obj", ".pgm", ".rviz", ".sdf", ".srdf", ".stl", ".urdf", ".wbt", ".world", ".xacro", ".yaml", ".yml",
)  # fmt: skip
"""What serves at run time, and nowhere else."""
_OF_MODELS = (".dae", ".obj", ".sdf", ".srdf", ".stl", ".urdf", ".wbt", ".world", ".xacro")
"""What of it is looked up by other files and programs; displays, maps and parameters are also opened by hand."""


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or script.is_empty or package.builds_with not in ("ament_cmake", "ament_python"):
        return
    installed = _with_folders(provided.path for provided in script.provides)
    kept = _with_folders(script.installed)
    missing: dict[str, list[tuple[str, Span]]] = {}
    looked_into: dict[str, Span] = {}
    files = frozenset(package.files)
    folders = frozenset(file.partition("/")[0] for file in package.files if _is_resource(file))
    for look_up in workspace.looked_up.get(package.name, ()):
        path, span = look_up.path.rstrip("/"), look_up.span
        place = f"share/{package.name}/{path}"
        if place in installed or path.endswith(LAUNCH_NAMES):
            continue
        if not (path in files or path in folders):
            if not workspace.is_made(package, path):  # else it is made, and there where it is wanted
                looked_into.setdefault(path.partition("/")[0], span)
            continue
        if not package.hidden(Facet.SHARE, place):
            missing.setdefault(_unit(path, kept), []).append((path, span))
    for unit, found in missing.items():
        yield _named(package, script, unit, found)
    if not package.hidden(Facet.SHARE):
        told = {unit.partition("/")[0] for unit in missing}
        yield from _folders(package, script, kept, told, looked_into)


def _with_folders(paths: Iterable[str]) -> set[str]:
    found = set(paths)
    return found.union(*[folders_of(path) for path in found])


def _is_resource(path: str) -> bool:
    """Whether a file is one of a folder that a launch file or a program can look up as a whole."""
    return "/" in path and path.lower().endswith(_RUN_TIME) and not is_apart(path)


def _unit(path: str, kept: set[str]) -> str:
    """Return what to install: the topmost folder of the file, if nothing of it is installed so far, else the file."""
    top, inside, _ = path.partition("/")
    if not inside and "." not in top:
        return f"{top}/"
    return f"{top}/" if inside and top not in kept else path


def _named(package: Package, script: BuildScript, unit: str, found: list[tuple[str, Span]]) -> Finding:
    paths = sorted({path for path, _ in found} - {unit.rstrip("/")})
    names = list(dict.fromkeys(map(_name, paths)))
    named = f"{few(names)} {'is' if len(names) == 1 else 'are'} looked up in it"
    inside = named if unit.endswith("/") and paths else "is looked up at run time"
    return Finding(
        f"{unit} is not installed, and {inside}; install it to share/{package.name}",
        setup_edits.place(script),
        unit,
        several(Related("looked up here", span) for _, span in found),
        _fix(package, script, unit),
    )


def _name(path: str) -> str:
    return path.rpartition("/")[2]


def _folders(
    package: Package, script: BuildScript, kept: set[str], told: set[str], looked_into: Mapping[str, Span]
) -> Iterator[Finding]:
    """Speak of folders of resources of which nothing is installed.

    ``looked_into`` are those in which a file is looked up that is not even there.
    """
    launches = {launch.path for launch in launchable(package)}
    places = dict(script.named)
    # What is installed from a place that is not known, such as one of several folders, may be any file of the name.
    chosen = frozenset([_name(provided.path) for provided in script.provides if not provided.source])
    modules = frozenset(script.python_packages)
    forgotten = _Forgotten(package, script, places, looked_into)
    for folder, found in uninstalled_resources(package.files, kept).items():
        files = [file for file in found if file not in launches and file not in script.inputs]
        top = folder.partition("/")[0]
        if top in told or folder in modules or any(_name(file) in chosen for file in files):
            continue
        if top in _PICTURES and not any(file in places for file in files):
            files = [file for file in files if not file.lower().endswith(_PICTURE)]
        if files and (folder == "controllers" or not all(file.rpartition(".")[2] in _PLAIN for file in files)):
            yield forgotten.finding(folder, files)


class _Forgotten:
    """What to say of a folder that is not installed, and how sure that is, going by the rest of the package.

    ``places`` are those where a text of the package names one of its files, ``looked_into`` those where a file is looked up
    that is not in its folder.
    """

    def __init__(
        self, package: Package, script: BuildScript, places: Mapping[str, Span], looked_into: Mapping[str, Span]
    ) -> None:
        self._package = package
        self._script = script
        self._places = places
        self._looked_into = looked_into
        models = any(provided.source.lower().endswith(_OF_MODELS) for provided in script.provides)
        self._lacks_models = not models and _only_files(package, script)
        self._made_of_them = _makes_nothing(package, script)
        self._of_nodes = _of_nodes(package, script)
        self._elsewhere = _looked_up_elsewhere(package)

    def finding(self, folder: str, files: Sequence[str]) -> Finding:
        package, script, places = self._package, self._script, self._places
        # What the files say of each other tells nothing of who reads the first of them.
        below = from_base(package, f"{folder}/")
        named = [file for file in files if file in places and not places[file].path.startswith(below)]
        looked_up = [file for file in named if (places[file].path, _name(file)) not in self._elsewhere]
        examples = few(_name(file) for file in (*named, *(file for file in files if file not in places)))
        return Finding(
            f"{folder}/ ({examples}) is not installed, so it cannot be looked up at run time; install it to share/{package.name}",
            setup_edits.place(script),
            f"{folder}/",
            several(
                [Related(f"{_name(file)} is named here", places[file]) for file in looked_up]
                or [Related("it is looked into here", self._looked_into[one]) for one in [folder] if one in self._looked_into]
            ),
            fix=_fix(package, script, f"{folder}/") if "/" not in folder else None,
            confidence=Confidence.HIGH if looked_up or folder in self._looked_into else self._unnamed(folder, files),
            severity=Severity.WARNING,
        )

    def _unnamed(self, folder: str, files: Sequence[str]) -> Confidence:
        """Return how sure it is that a folder has been forgotten which nothing in the package names."""
        if folder.partition("/")[0] in _DOCUMENTS:
            return Confidence.LOW
        copied = not {name for _, name in self._elsewhere}.isdisjoint([_name(file) for file in files])
        files = [file for file in files if not any(word in file for word in _TO_COPY)]
        in_sources = f"{folder}/" in self._script.inputs
        if any(file in self._of_nodes for file in files) and not in_sources:
            return Confidence.HIGH
        for_run_time = any(file.lower().endswith(_RUN_TIME) or "/textures/" in file for file in files)
        lost = self._lacks_models and any(file.lower().endswith(_OF_MODELS) for file in files)
        meant = "/" in folder or self._made_of_them or lost
        return Confidence.HIGH if meant and for_run_time and not copied and not in_sources else Confidence.MEDIUM


_TO_COPY = ("example", "sample", "template")
"""In the names of files that somebody copies, and that nothing reads where they are."""


def _looked_up_elsewhere(package: Package) -> frozenset[tuple[str, str]]:
    """Return launch files with the names of files that they look up in other packages, and not in this one."""
    files = [each for launch in package.launch for each in launch.references if each.kind in ("file", "include")]
    own = {(each.span.path, _name(each.name)) for each in files if each.package == package.name}
    return frozenset([(each.span.path, _name(each.name)) for each in files]) - own


def _makes_nothing(package: Package, script: BuildScript) -> bool:
    """Whether a package has nothing for its users, so that the files that it has are what it is there for.

    One that is called after tests or examples may keep them where it lies.
    """
    return script.makes_nothing and not is_apart(f"{package.name.replace('_', '/')}/")


def _only_files(package: Package, script: BuildScript) -> bool:
    """Whether a package has nothing for its users but files that it installs to its share folder."""
    makes = script.targets or script.python_packages or script.interfaces or script.components
    installs = any("/" in provided.source for provided in script.provides)
    return script.of_cmake and installs and not makes and all(p.path.startswith("share/") for p in script.provides)


def _of_nodes(package: Package, script: BuildScript) -> frozenset[str]:
    """Return the files with parameters of nodes, for a package that installs nodes, or nothing but files."""
    runs = script.components or any(provided.path.startswith(f"lib/{package.name}/") for provided in script.provides)
    installs = runs or _only_files(package, script)
    if not installs or "example" in package.name:
        return frozenset()
    return frozenset(relative(package, file.path) for file in package.parameter_files if file.nodes)


_MOST_LISTED = 12
"""Files that a fix lists or globs in ``data_files``; a folder with more may need another way."""


def _fix(package: Package, script: BuildScript, unit: str) -> Fix | None:
    folder, _, name = unit.rpartition("/")
    edit = None
    if script.of_cmake:
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
