"""
## What it finds

An `ament_python` package with different versions in `package.xml` and in `setup.py` or `setup.cfg`.

## Why it matters

Debian packages and `ros2 pkg xml` show the version of `package.xml`; `pip list` and `importlib.metadata` show the other one. A
release may be made with an outdated version.

## How to fix it

Write the same version into both files. The unsafe fix writes the version of `package.xml` into the other file. If `package.xml`
still has the version `0.0.0` of the template, the fix writes the version of `setup.py` into `package.xml`.

## Limitations

Not reported: a version in `setup.py` that is not a literal, and versions that only differ in zeros at the end.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ros_lint.api import Edit, Finding, Fix, Manifest, Package, Related, Rule, Severity, Span, Workspace

_TEMPLATE = "0.0.0"


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    manifest, script = package.manifest, package.script
    if manifest is None or manifest.problems or script is None or package.type != "ros.ament_python":
        return
    version, span = script.project.version, script.project.version_span
    if not version or span is None or _short(version) == _short(manifest.version):
        return
    place = next(element.text_span for element in manifest.elements if element.tag == "version")
    file = span.path.rpartition("/")[2]
    yield Finding(
        f"{file} has version {version}, but package.xml has {manifest.version}; write the same version into both",
        span,
        "version",
        (Related(f"package.xml has version {manifest.version}", place),),
        _fix(manifest, version, span, place),
    )


def _short(version: str) -> str:
    return re.sub(r"(\.0)+$", "", version)


def _fix(manifest: Manifest, version: str, span: Span, place: Span) -> Fix | None:
    if manifest.version == _TEMPLATE and re.fullmatch(r"\d+\.\d+\.\d+", version):
        return Fix(f"write {version} into package.xml", (Edit(place, version),), safe=False)
    inner = span.inner(version)
    if inner is None:
        return None
    return Fix(f"write {manifest.version} into {span.path.rpartition('/')[2]}", (Edit(inner, manifest.version),), safe=False)


RULE = Rule(
    name="version-mismatch",
    code="ROS110",
    summary="versions in setup.py and package.xml are equal",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
