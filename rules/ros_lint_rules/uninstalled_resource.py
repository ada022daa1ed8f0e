"""
## What it finds

- Files that are looked up in the share folder of a package of the workspace and exist in its sources, but are not installed
  there: parameters, models, maps, configurations of RViz and included files that launch files name.
- Whole folders of such files (`config/`, `urdf/`, `worlds/` ...) of which nothing is installed.

## Why it matters

At run time only the install space counts: "No such file or directory: .../install/robot/share/robot/config/robot.yaml".

## How to fix it

In `CMakeLists.txt`, add the folder to `install(DIRECTORY ... DESTINATION share/${PROJECT_NAME})`. The fix does this. In
`setup.py`, add an entry to `data_files`: `('share/' + package_name + '/config', glob('config/*'))`. The fix does this if
`data_files` is a literal list and the folder has few files.

## Limitations

Not reported:

- A part of the build script that cannot be evaluated may install the file, or a file of the same name from a folder that is
  chosen during the build.
- The file does not exist at all: see `launch-missing-include`.
- Launch files: see `uninstalled-launch`.
- The `CMakeLists.txt` contains no command: see `missing-ament-package`.
- Files that only launch files of ROS 1 look up, and `joint_names_*.yaml` of the SolidWorks exporter, which only ROS 1 uses.
- Inputs of build commands, such as the file that `generate_parameter_library()` reads.
- Pictures in `images/` and `media/` that nothing names, because they belong to the documentation.
- Hidden folders, such as the history of an editor, and folders for old files, such as `old`.

Reported with medium confidence:

- Folders that nothing in the package names. They may serve documentation, be opened by hand from the sources, or be left over.
- Examples and templates, going by their names, because they are copied and not looked up.
- Folders that a program or launch file finds in the sources: by a path such as `/home/me/src/robot/maps/hall` or `'src',
  'robot', 'maps'`, or by a macro that CMake sets to the source folder.
- Folders that a program looks up in its working directory.
- Files of a name that a launch file looks up in another package, because the file here may be a copy.

A folder that nothing in the package names is reported with high confidence in these cases:

- It is inside a folder that is installed (`worlds/textures/`), and its files are only used at run time: configurations of RViz,
  maps, models, textures, parameters.
- It contains files that are only used at run time, and the package builds, installs and tests nothing, so that these files are
  the purpose of the package.
- It contains parameters of nodes (`ros__parameters`), and the package has nodes, or files only.
- It contains models or worlds, and the package has files only and installs no other model.
- A file is looked up in it that does not exist and is not ignored by git.
- It is the only folder of resources that is left out, and the package installs at least two others. The finding is an info.
  Folders of maps, meshes and launch files of ROS 1 are excepted, because maps are recorded and the others are left over.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from ros_lint.api import (
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
    build,
    edits,
    files,
    first_related,
    launch,
    names,
)

_PLAIN = frozenset({"py", "sh", "txt", "md"})
_DOCUMENTS = frozenset({"images", "media", "data"})
_PICTURES = frozenset({"images", "media"})
_PICTURE = (".png", ".jpg", ".jpeg")
_RUN_TIME = (
    ".dae", ".lua", ".obj", ".pgm", ".rviz", ".sdf", ".srdf", ".stl", ".urdf", ".wbt", ".world", ".xacro", ".yaml", ".yml",
)  # fmt: skip
"""Suffixes of files that programs and launch files use only at run time, never in a build."""
_OF_MODELS = (".dae", ".obj", ".sdf", ".srdf", ".stl", ".urdf", ".wbt", ".world", ".xacro")
"""Suffixes of files that users do not open by hand, in contrast to configurations of RViz, maps and parameters."""


_TO_EXTEND = "add it to this install(DIRECTORY)"
"""The remedy if the finding is at an install() that installs other folders to the share folder."""


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or script.is_empty or package.builds_with not in ("ament_cmake", "ament_python"):
        return
    installed = _with_folders(provided.path for provided in script.products.installs)
    kept = _with_folders(script.products.installed)
    missing: dict[str, list[tuple[str, Span]]] = {}
    looked_into: dict[str, Span] = {}
    file_paths = frozenset(package.files)
    folders = frozenset(file.partition("/")[0] for file in package.files if _is_resource(file))
    for look_up in launch.files_looked_up(workspace, package.name):
        path, span = look_up.path.rstrip("/"), look_up.span
        place = f"share/{package.name}/{path}"
        if place in installed or path.endswith(launch.LAUNCH_FILE_NAMES):
            continue
        if not (path in file_paths or path in folders):
            if not workspace.is_made(package, path):  # else it is generated where it is needed
                looked_into.setdefault(path.partition("/")[0], span)
            continue
        if not package.hidden(Facet.SHARE, place):
            missing.setdefault(_unit(path, kept), []).append((path, span))
    for unit, look_ups in missing.items():
        yield _looked_up(package, script, unit, look_ups)
    if not package.hidden(Facet.SHARE):
        reported = {unit.partition("/")[0] for unit in missing}
        yield from _folders(package, script, kept, reported, looked_into)


def _with_folders(paths: Iterable[str]) -> set[str]:
    unique = set(paths)
    return unique.union(*[files.folders_of(path) for path in unique])


def _is_resource(path: str) -> bool:
    """Return whether a file is in a folder that a launch file or program may look up as a whole."""
    return "/" in path and path.lower().endswith(_RUN_TIME) and not files.is_auxiliary(path)


def _unit(path: str, kept: set[str]) -> str:
    """Return what to install so that ``path`` is installed: its topmost folder, or the file itself if the folder is in ``kept``.

    ``kept``: folders with installed files.
    """
    top, inside, _ = path.partition("/")
    if not inside and "." not in top:
        return f"{top}/"
    return f"{top}/" if inside and top not in kept else path


def _looked_up(package: Package, script: BuildScript, unit: str, look_ups: list[tuple[str, Span]]) -> Finding:
    paths = sorted({path for path, _ in look_ups} - {unit.rstrip("/")})
    all_names = list(dict.fromkeys(map(_name, paths)))
    inside = f"{names.shorten_list(all_names)} {'is' if len(all_names) == 1 else 'are'} looked up in it"
    reason = inside if unit.endswith("/") and paths else "it is looked up at run time"
    place = edits.cmake.install_folder_place(package) if unit.endswith("/") else None
    remedy = _TO_EXTEND if place else f"install it to share/{package.name}"
    return Finding(
        f"'{unit}' is not installed, but {reason}; {remedy}",
        place or edits.setup_py.place(script),
        unit,
        first_related(Related(f"'{path}' is looked up here", span) for path, span in look_ups),
        _fix(package, script, unit),
    )


def _name(path: str) -> str:
    return path.rpartition("/")[2]


def _folders(
    package: Package, script: BuildScript, kept: set[str], reported: set[str], looked_into: Mapping[str, Span]
) -> Iterator[Finding]:
    """Yield a finding for each folder with resources (models, parameters and other files) of which no file is installed.

    ``kept``: paths and folders of installed files. ``reported``: top folders that are left out, because they have findings.
    ``looked_into``: folders in which a missing file is looked up, with the place of the look-up.
    """
    launches = {launch_file.path for launch_file in launch.package_launch_files(package)}
    places = dict(script.files.referenced_resources)
    # A file that is installed from an unknown place, such as one of several folders, may be any file of that name.
    chosen = frozenset([_name(provided.path) for provided in script.products.installs if not provided.source])
    modules = frozenset(script.products.python_packages)
    resources = build.uninstalled_resources(package.files, kept)
    findings = _FolderFindings(package, script, places, looked_into, resources)
    for folder, uninstalled in resources.items():
        file_paths = [file for file in uninstalled if file not in launches and file not in script.files.build_inputs]
        top = folder.partition("/")[0]
        if top in reported or folder in modules or any(_name(file) in chosen for file in file_paths):
            continue
        if top in _PICTURES and not any(file in places for file in file_paths):
            file_paths = [file for file in file_paths if not file.lower().endswith(_PICTURE)]
        if file_paths and (folder == "controllers" or not all(file.rpartition(".")[2] in _PLAIN for file in file_paths)):
            yield findings.finding(folder, file_paths)


class _FolderFindings:
    """Findings for folders that are not installed, with a confidence that depends on the rest of the package.

    ``places``: files of the package, each with the place of a text that names it. ``looked_into``: folders in which a missing
    file is looked up, each with the place of the look-up. ``folders``: all folders of which nothing is installed.
    """

    def __init__(
        self,
        package: Package,
        script: BuildScript,
        places: Mapping[str, Span],
        looked_into: Mapping[str, Span],
        folders: Iterable[str],
    ) -> None:
        self._package = package
        self._script = script
        self._places = places
        self._looked_into = looked_into
        models = any(provided.source.lower().endswith(_OF_MODELS) for provided in script.products.installs)
        self._lacks_models = not models and _only_files(package, script)
        self._resources_only = _makes_nothing(package, script)
        self._node_parameters = _node_parameters(package, script)
        self._elsewhere = _looked_up_elsewhere(package)
        self._only_one_left_out = _only_one_left_out(package, script, folders)

    def finding(self, folder: str, file_paths: Sequence[str]) -> Finding:
        package, script, places = self._package, self._script, self._places
        # A file of the folder that names another one does not show that the first one is used.
        below = package.base_path(f"{folder}/")
        named = [file for file in file_paths if file in places and not places[file].path.startswith(below)]
        looked_up = [file for file in named if (places[file].path, _name(file)) not in self._elsewhere]
        examples = names.shorten_list(_name(file) for file in (*named, *(file for file in file_paths if file not in places)))
        place = edits.cmake.install_folder_place(package) if "/" not in folder else None
        remedy = _TO_EXTEND if place else f"install it to share/{package.name}"
        is_used = bool(looked_up) or folder in self._looked_into
        confidence, severity = (Confidence.HIGH, Severity.WARNING) if is_used else self._unnamed(folder, file_paths)
        return Finding(
            f"'{folder}/' (contains {examples}) is not installed, so it will not be found at run time; {remedy}",
            place or edits.setup_py.place(script),
            f"{folder}/",
            first_related(
                [Related(f"'{_name(file)}' is named here", places[file]) for file in looked_up]
                or [
                    Related(f"a file in '{path}/' is looked up here", self._looked_into[path])
                    for path in (folder,)
                    if path in self._looked_into
                ]
            ),
            fix=_fix(package, script, f"{folder}/") if "/" not in folder else None,
            confidence=confidence,
            severity=severity,
        )

    def _unnamed(self, folder: str, file_paths: Sequence[str]) -> tuple[Confidence, Severity]:
        """Return the confidence and the severity of the finding for a folder that no text of the package names."""
        if folder.partition("/")[0] in _DOCUMENTS:
            return Confidence.LOW, Severity.WARNING
        copied = not {name for _, name in self._elsewhere}.isdisjoint([_name(file) for file in file_paths])
        file_paths = [file for file in file_paths if not any(word in file for word in _TO_COPY)]
        in_sources = f"{folder}/" in self._script.files.build_inputs
        if any(file in self._node_parameters for file in file_paths) and not in_sources:
            return Confidence.HIGH, Severity.WARNING
        if copied or in_sources or not file_paths:
            return Confidence.MEDIUM, Severity.WARNING
        for_run_time = any(file.lower().endswith(_RUN_TIME) or "/textures/" in file for file in file_paths)
        lost = self._lacks_models and any(file.lower().endswith(_OF_MODELS) for file in file_paths)
        if for_run_time and ("/" in folder or self._resources_only or lost):
            return Confidence.HIGH, Severity.WARNING
        if folder == self._only_one_left_out and folder not in _KEPT_IN_SOURCES:
            return Confidence.HIGH, Severity.INFO
        return Confidence.MEDIUM, Severity.WARNING


_KEPT_IN_SOURCES = ("launch", "map", "maps", "mesh", "meshes")
"""Folders whose files are often recorded or left over, such as launch files of ROS 1."""


def _only_one_left_out(package: Package, script: BuildScript, folders: Iterable[str]) -> str:
    """Return the only uninstalled folder of resources if the package installs two or more others to its share folder, else ""."""
    left_out = {folder.partition("/")[0] for folder in folders} - _DOCUMENTS
    installed = {
        folder
        for provided in script.products.installs
        for folder, _, file in [provided.source.partition("/")]
        if file and provided.path == f"share/{package.name}/{provided.source}"
    }
    return left_out.pop() if len(left_out) == 1 and len(installed) > 1 else ""


_TO_COPY = ("example", "sample", "template")
"""Parts of the names of files that users copy before use."""


def _looked_up_elsewhere(package: Package) -> frozenset[tuple[str, str]]:
    """Return pairs of a launch file and the name of a file that it looks up in other packages, but not in ``package``."""
    file_paths = [file for launch_file in package.launch for file in launch_file.references if file.kind in ("file", "include")]
    own = {(file.span.path, _name(file.name)) for file in file_paths if file.package == package.name}
    return frozenset([(file.span.path, _name(file.name)) for file in file_paths]) - own


def _makes_nothing(package: Package, script: BuildScript) -> bool:
    """Return whether the build script builds and installs nothing, so that the package can only exist for its files.

    The result is False for a package named after tests or examples, because it may use its files in the sources.
    """
    return script.cmake.makes_nothing and not files.is_auxiliary(f"{package.name.replace('_', '/')}/")


def _only_files(package: Package, script: BuildScript) -> bool:
    """Return whether a package provides nothing but files that it installs to its share folder."""
    makes = script.products.targets or script.products.python_packages or script.products.interfaces or script.products.components
    installs = any("/" in provided.source for provided in script.products.installs)
    return script.of_cmake and installs and not makes and all(p.path.startswith("share/") for p in script.products.installs)


def _node_parameters(package: Package, script: BuildScript) -> frozenset[str]:
    """Return the files with parameters of nodes, relative to the package.

    Empty unless the package installs components or programs, or installs nothing but files to its share folder. Empty for
    a package of examples, too.
    """
    runs = script.products.components or any(
        provided.path.startswith(f"lib/{package.name}/") for provided in script.products.installs
    )
    installs = runs or _only_files(package, script)
    if not installs or "example" in package.name:
        return frozenset()
    return frozenset(package.relative(file.path) for file in package.parameter_files if file.nodes)


_MOST_LISTED = 12
"""The most files that a fix adds to ``data_files``; a larger folder may need another solution."""


def _fix(package: Package, script: BuildScript, unit: str) -> Fix | None:
    folder, _, name = unit.rpartition("/")
    edit = None
    if script.of_cmake:
        edit = edits.cmake.install_files(script, [unit], folder) if name else edits.cmake.install_folder(package, folder)
    elif slot := edits.setup_py.slot(script, "data_files"):
        paths = [unit] if name else [file for file in package.files if file.startswith(unit)]
        edit = edits.setup_py.add_files(slot, package.name, paths, package.files) if len(paths) <= _MOST_LISTED else None
    return Fix.of(f"install '{unit}'", edit)


RULE = Rule(
    name="uninstalled-resource",
    code="ROS402",
    summary="files that are looked up at run time are installed",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
