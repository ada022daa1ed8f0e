"""
## What it finds

A package whose build script does not call it as `package.xml` does: `project()` in `CMakeLists.txt`, `name=` in `setup.py`,
the marker in `share/ament_index/resource_index/packages/`, the folder `share/<package>` for its manifest, or the folder
`lib/<package>` for its programs, which `setup.cfg` names.

## Why it matters

`ament_package()` stops CMake when `project()` differs. A marker or manifest under another name makes a package that
`ros2 pkg` does not find, and `ros2 run` looks for programs in `lib/<package>` only.

## How to fix it

Use the name of `package.xml` everywhere. Where a name is written out, the fix does this; in `setup.py` it
is an unsafe one, for folders and files may be named after the same variable. There is none where another package has the
name, too (see `duplicate-package`): then it may be `package.xml` that was copied.

## Limitations

Where the name is not known for certain: it comes from a variable that cannot be evaluated, or what is installed depends on
a condition. About another name in `colcon.pkg`, by which colcon orders and selects the package. Further markers and manifests
beside those of the right name do no harm. Dashes, underscores and capitals in the name of a Python distribution make no
difference to setuptools; only the installed paths do.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import (
    BuildScript,
    Edit,
    Finding,
    Fix,
    Manifest,
    Package,
    Provided,
    Related,
    Rule,
    Severity,
    Span,
    Workspace,
    called,
    evaluated_name,
    setup_edits,
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
        if script.name_span and "ament_package" in script.calls and not _is_called(package, manifest.name):
            message = f"project() is called {script.name}, but the package {manifest.name}; ament_package() wants one name"
            yield _finding(message, manifest, script, script.name_span)
    elif package.type == "ros.ament_python":
        yield from _python(manifest, script)


def _is_called(package: Package, name: str) -> bool:
    """Whether CMake may take a package for one of a name: one that builds itself anew has more than one project()."""
    return name == package.built.name or any(
        evaluated_name(package, call.texts[0]) == name for call in called(package, "project") if call.args
    )


def _python(manifest: Manifest, script: BuildScript) -> Iterator[Finding]:
    """Yield one finding for each wrong name, at the first place that has it."""
    wrong: dict[str, list[Related]] = {}
    if script.name and script.name_span and _distribution(script.name) != _distribution(manifest.name):
        message = f"setup() calls the package {script.name}"
        wrong[script.name] = [Related(message, script.name_span)]
    told = {_installed_for(provided) for provided in script.provides}
    for provided in script.provides:
        name, what = _installed_for(provided)
        if name in ("", manifest.name) or provided.conditional or (what != "program" and (manifest.name, what) in told):
            continue
        places = wrong.setdefault(name, [])
        message = _PLACES[what].format(name)
        if all(place.message != message for place in places):
            places.append(Related(message, provided.span))
    entries = {entry.span for entry in script.entry_points}
    # Programs are written in setup.py, and where they go in setup.cfg.
    scripts = setup_edits.program_folders(script).get("install.install_scripts")
    for places in wrong.values():
        first, *others = [place._replace(span=scripts) if scripts and place.span in entries else place for place in places]
        message = f"{first.message}, but package.xml calls it {manifest.name}; use one name"
        found = _finding(message, manifest, script, first.span)._replace(related=tuple(others))
        harmless = not others and first.span == script.name_span
        yield found._replace(severity=Severity.WARNING) if harmless else found


_PLACES = {
    "marker": "the package is entered into the index as {}",
    "manifest": "package.xml is installed to share/{}",
    "program": "the programs of the package are installed to lib/{}",
}


def _installed_for(provided: Provided) -> tuple[str, str]:
    """Return the package that an installed file belongs to, and what it is; two empty texts if that is not fixed."""
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
    if span == script.name_span and (place := span.inner(script.name)):
        # In setup.py the same variable may name folders and files that would have to be renamed, too.
        fix = Fix(f"write {manifest.name}", (Edit(place, manifest.name),), safe=not script.path.endswith(".py"))
    if span in setup_edits.program_folders(script).values():
        fix = Fix(f"write $base/lib/{manifest.name}", setup_edits.programs_to(script, manifest.name))
    return Finding(message, span, manifest.name, fix=fix)


def _distribution(name: str) -> str:
    return name.replace("-", "_").replace(".", "_").lower()


RULE = Rule(
    name="name-mismatch",
    code="ROS109",
    summary="a package must have one name",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
