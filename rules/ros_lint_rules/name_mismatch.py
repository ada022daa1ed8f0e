"""
## What it finds

A package whose build script uses another name than `package.xml` in one of these places:

- `project()` in `CMakeLists.txt`;
- `name=` in `setup.py`;
- the marker in `share/ament_index/resource_index/packages/`;
- the folder `share/<package>`, to which `package.xml` is installed;
- the folder `lib/<package>`, to which programs are installed, as set in `setup.cfg`.

One rule reports all places, because a package that is renamed or copied has to be changed in each of them.

## Why it matters

If `project()` differs, `ament_package()` stops CMake. If the marker or `package.xml` has another name, `ros2 pkg` does not find
the package. `ros2 run` searches for programs in `lib/<package>` only.

## How to fix it

Use the name of `package.xml` everywhere. The fix replaces a name that is written out. In `setup.py` the fix is unsafe, because
folders and files may be named after the same variable.

There is no fix if another package has the same name (see `duplicate-package`), because then the name in `package.xml` may be
the wrong one.

## Limitations

Not reported:

- Names from variables that cannot be evaluated.
- Another name in `colcon.pkg`, which colcon uses to order and select packages.
- Files that are installed under a condition.
- Additional markers and manifests, if those with the right name are installed too.
- Dashes, dots and capitals in `name=` of `setup.py`: setuptools treats `robot-arm` and `robot_arm` as the same name.

If only `name=` of `setup.py` differs, the severity is warning.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import (
    BuildScript,
    Edit,
    Finding,
    Fix,
    InstalledFile,
    Manifest,
    Package,
    Related,
    Rule,
    Severity,
    Span,
    Workspace,
    build,
    edits,
)

_MARKERS = "share/ament_index/resource_index/packages/"


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    manifest, script = package.manifest, package.script
    if manifest is None or manifest.problems or script is None:
        return
    shared = len(workspace.by_name[package.name]) > 1
    for finding in _mismatches(package, manifest, script):
        yield finding._replace(fix=None) if shared else finding


def _mismatches(package: Package, manifest: Manifest, script: BuildScript) -> Iterator[Finding]:
    if package.type == "ros.ament_cmake":
        if script.project.name_span and "ament_package" in script.commands.names and not _is_called(package, manifest.name):
            message = (
                f"project() uses the name '{script.project.name}', but package.xml names the package '{manifest.name}', "
                "so ament_package() fails; use one name"
            )
            yield _finding(message, manifest, script, script.project.name_span)
    elif package.type == "ros.ament_python":
        yield from _python(manifest, script)


def _is_called(package: Package, name: str) -> bool:
    """Return whether any project() of the package has the name ``name``. A superbuild calls project() several times."""
    return name == package.built.project.name or any(
        build.evaluated_name(package, call.texts[0]) == name for call in package.calls("project") if call.args
    )


def _python(manifest: Manifest, script: BuildScript) -> Iterator[Finding]:
    """Yield one finding for each wrong package name in setup.py and setup.cfg, at the first place with that name."""
    wrong: dict[str, list[Related]] = {}
    if script.project.name and script.project.name_span and _distribution(script.project.name) != _distribution(manifest.name):
        message = f"setup() uses the name '{script.project.name}'"
        wrong[script.project.name] = [Related(message, script.project.name_span)]
    installed_as = {_installed_for(provided) for provided in script.products.installs}
    for provided in script.products.installs:
        name, what = _installed_for(provided)
        if name in ("", manifest.name) or provided.conditional or (what != "program" and (manifest.name, what) in installed_as):
            continue
        places = wrong.setdefault(name, [])
        message = _PLACES[what].format(name)
        if all(place.message != message for place in places):
            places.append(Related(message, provided.span))
    entries = {entry.span for entry in script.products.entry_points}
    # setup.py lists the programs, and setup.cfg sets their folder.
    scripts = edits.setup_py.program_folders(script).get("install.install_scripts")
    for places in wrong.values():
        first, *others = [place._replace(span=scripts) if scripts and place.span in entries else place for place in places]
        message = f"{first.message}, but package.xml names the package '{manifest.name}'; use one name"
        finding = _finding(message, manifest, script, first.span)._replace(related=tuple(others))
        harmless = not others and first.span == script.project.name_span
        yield finding._replace(severity=Severity.WARNING) if harmless else finding


_PLACES = {
    "marker": "the package is registered in the ament index as '{}'",
    "manifest": "package.xml is installed to share/{}",
    "program": "programs are installed to lib/{}",
}


def _installed_for(provided: InstalledFile) -> tuple[str, str]:
    """Return the package name in the path of an installed file, and the kind of the file, a key of _PLACES; else ("", "")."""
    folder, _, rest = provided.path.partition("/")
    name, _, file = rest.partition("/")
    if provided.path.startswith(_MARKERS):
        return provided.path.removeprefix(_MARKERS), "marker"
    if folder == "share" and file == "package.xml":
        return name, "manifest"
    if folder == "lib" and provided.program and file and "/" not in file:
        return name, "program"
    return "", ""


def _finding(message: str, manifest: Manifest, script: BuildScript, span: Span) -> Finding:
    fix = None
    if span == script.project.name_span and (place := span.inner(script.project.name)):
        # In setup.py the same variable may name folders and files, which the fix does not rename.
        fix = Fix(f"write '{manifest.name}'", (Edit(place, manifest.name),), safe=not script.path.endswith(".py"))
    if span in edits.setup_py.program_folders(script).values():
        fix = Fix(f"write '$base/lib/{manifest.name}'", edits.setup_py.programs_to(script, manifest.name))
    return Finding(message, span, manifest.name, fix=fix)


def _distribution(name: str) -> str:
    return name.replace("-", "_").replace(".", "_").lower()


RULE = Rule(
    name="name-mismatch",
    code="ROS109",
    summary="build scripts use the package name of package.xml",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
