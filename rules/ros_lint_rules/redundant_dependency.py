"""
## What it finds

A dependency that says nothing new: the same tag with the same name twice, or a `<build_depend>`, `<build_export_depend>`
or `<exec_depend>` beside a `<depend>` on the same name. Only tags with the same condition are compared.

## Why it matters

Nothing breaks. The list is longer than it need be, and who takes a dependency out forgets the other half. (Without
versions `catkin_pkg` rejects the second case altogether, see rejected-manifest.)

## How to fix it

Keep the more general tag, or the one that asks for a version. The fix removes the other.

## Limitations

For `<test_depend>` beside other tags, which REP 149 allows, for tags with different conditions, and when both ask for a
version and the versions differ.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Depend, Finding, Fix, Package, Related, Rule, Severity, Workspace, manifest_edits

_IN_DEPEND = ("build_depend", "build_export_depend", "exec_depend")


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    manifest = package.manifest
    if manifest is None or manifest.problems:
        return
    by_name: dict[str, list[Depend]] = {}
    for depend in manifest.depends:
        by_name.setdefault(depend.name, []).append(depend)
    if len(by_name) == len(manifest.depends):
        return
    gone: set[Depend] = set()
    for depend in manifest.depends:
        holder = next((other for other in by_name[depend.name] if other not in gone and _holds(other, depend)), None)
        if holder is None:
            continue
        gone.add(depend)
        how = "twice" if holder.tag == depend.tag else f"already as <{holder.tag}>"
        yield Finding(
            f"{depend.name} is declared {how}; remove this <{depend.tag}>",
            depend.span,
            depend.name,
            (Related("declared here", holder.span),),
            Fix(f"remove <{depend.tag}>{depend.name}</{depend.tag}>", (manifest_edits.remove(manifest, depend),)),
        )


def _holds(one: Depend, other: Depend) -> bool:
    """Whether the first of two tags with one name says all that the second does."""
    if one is other or one.condition != other.condition:
        return False
    if one.tag == other.tag:
        if one.versions == other.versions:
            return one.span < other.span
        return not other.versions
    return one.tag == "depend" and other.tag in _IN_DEPEND and other.versions in ((), one.versions)


RULE = Rule(
    name="redundant-dependency",
    code="ROS106",
    summary="a dependency must be declared once",
    severity=Severity.INFO,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
