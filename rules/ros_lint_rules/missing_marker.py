"""
## What it finds

An `ament_python` package whose `data_files` do not install its `package.xml` or its marker, the file
`share/ament_index/resource_index/packages/<package>` of the ament index.

## Why it matters

ROS finds packages by their marker. colcon still adds both files with a warning; Debian packages, pip and other builders do not,
and then `ros2 run` reports "Package not found".

## How to fix it

    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],

The marker is an empty file `resource/<package>`. The fix adds the missing entry, if that file exists.

## Limitations

Not reported:

- `data_files` that cannot be evaluated.
- A marker or manifest installed under the name of another package: see `name-mismatch`.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import EditableList, Facet, Finding, Fix, Package, Rule, Severity, Workspace, edits

_MARKERS = "share/ament_index/resource_index/packages"


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.type != "ros.ament_python" or package.hidden(Facet.SHARE):
        return
    if "setup.py" not in package.files:
        return
    slot = edits.setup_py.slot(script, "data_files")
    paths = {provided.path for provided in script.products.installs}
    place = edits.setup_py.place(script)
    source_missing = any(problem.kind == "missing-file" and "resource/" in problem.subject for problem in script.problems)
    if not source_missing and not any(path.startswith(f"{_MARKERS}/") for path in paths):
        marker = f"resource/{package.name}"
        fix = None
        if slot and marker in package.files:
            element = edits.setup_py.joined(slot, package.name, "resource/")
            fix = _add(slot, f"({edits.setup_py.quoted(slot, _MARKERS)}, [{element}])")
        misplaced = next((provided for provided in script.products.installs if provided.source == marker), None)
        where = f"installed to {misplaced.path.rpartition('/')[0]}" if misplaced else "not installed"
        adds = f"add {marker}" if marker in package.files else f"create an empty file {marker} and add it"
        remedy = f"install it to {_MARKERS}" if misplaced else f"{adds} to data_files"
        yield Finding(
            f"the package marker of the ament index is {where}, so ROS finds the package only if colcon adds the marker; "
            f"{remedy}",
            misplaced.span if misplaced else place,
            marker,
            fix=fix,
        )
    if not any(path.startswith("share/") and path.endswith("/package.xml") and path.count("/") == 2 for path in paths):
        yield Finding(
            f"package.xml is not installed, so tools cannot read it; add ('share/{package.name}', ['package.xml']) to data_files",
            place,
            "package.xml",
            fix=_add(slot, _manifest(slot, package.name)) if slot else None,
        )


def _manifest(slot: EditableList, package: str) -> str:
    return f"({edits.setup_py.joined(slot, package, 'share/')}, [{edits.setup_py.quoted(slot, 'package.xml')}])"


def _add(slot: EditableList, element: str) -> Fix:
    return Fix(f"add {element} to data_files", (edits.setup_py.add(slot, element),))


RULE = Rule(
    name="missing-marker",
    code="ROS408",
    summary="packages of type ament_python install their marker and package.xml",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
