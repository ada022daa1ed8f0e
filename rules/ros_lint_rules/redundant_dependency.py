"""
## What it finds

A dependency that is declared twice under the same condition:

- two equal tags with the same name;
- a `<build_depend>`, `<build_export_depend>` or `<exec_depend>` in addition to a `<depend>` on the same name.

## Why it matters

Nothing breaks, but the list is longer than necessary, and a later removal easily misses the second tag. Without versions,
`catkin_pkg` rejects the second case: see `rejected-manifest`.

## How to fix it

Keep the more general tag, or the tag with a version. The fix removes the other one.

## Limitations

Not reported:

- A `<test_depend>` in addition to other tags: REP 149 allows it.
- Tags with different conditions.
- Tags with different versions.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Depend, Finding, Fix, Package, Related, Rule, Severity, Workspace, edits

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
    redundant: set[Depend] = set()
    for depend in manifest.depends:
        kept = next((other for other in by_name[depend.name] if other not in redundant and _implies(other, depend)), None)
        if kept is None:
            continue
        redundant.add(depend)
        how = "twice" if kept.tag == depend.tag else f"already as <{kept.tag}>"
        yield Finding(
            f"'{depend.name}' is declared {how}; remove this <{depend.tag}>",
            depend.span,
            depend.name,
            (Related(f"'{depend.name}' is also declared here", kept.span),),
            Fix(f"remove <{depend.tag}>{depend.name}</{depend.tag}>", (edits.manifest.remove(manifest, depend),)),
        )


def _implies(general: Depend, special: Depend) -> bool:
    """Return whether the tag ``general`` declares everything that ``special``, a tag with the same name, declares."""
    if general is special or general.condition != special.condition:
        return False
    if general.tag == special.tag:
        if general.versions == special.versions:
            return general.span < special.span
        return not special.versions
    return general.tag == "depend" and special.tag in _IN_DEPEND and special.versions in ((), general.versions)


RULE = Rule(
    name="redundant-dependency",
    code="ROS106",
    summary="dependencies are declared only once",
    severity=Severity.INFO,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
