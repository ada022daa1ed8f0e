"""
## What it finds

A `find_package()` of a ROS package that the code does not use: no include, macro, interface or import refers to it. Linking its
targets, exporting it, or naming it in the `DEPENDENCIES` of `rosidl_generate_interfaces()` does not count as use.

## Why it matters

Configuring takes longer, and this package can only be built where the other one is available.

## How to fix it

Remove the `find_package()` and the linked target, and the dependency from `package.xml` if nothing else needs it.

## Limitations

This rule is off by default. Not reported:

- The package provides CMake macros, plugins or components, or is a build tool.
- The code contains the name, as a namespace that a header of another package may declare, or another file of the package does;
  or the code uses one of its types by the bare name.
- The code includes a header of an unknown package, in a folder whose name begins like that of the package.
- The script uses more of the package's variables than those for linking.
- The package is found for tests, or it is optional.
- The script cannot be fully evaluated, or code is generated from interfaces that cannot be read or are written in IDL.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Finding, Mention, Package, Related, Rule, Severity, Workspace, dependencies, first_related


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    for mention in dependencies.unused_find_packages(package, workspace):
        name = mention.name
        others = _also_named(package, mention)
        what = f"find_package({name})" + (f" and the other uses of '{name}' in the build script" if others else "")
        related = first_related(Related(f"also named here: {other.what or other.name}", other.span) for other in others)
        yield Finding(f"no code uses '{name}'; remove {what}", mention.span, name, related)


def _also_named(package: Package, find: Mention) -> list[Mention]:
    """Return the other places where the build script names the package: links and exports fail without find_package()."""
    places = {
        mention.span: mention
        for mention in package.built.mentions
        if mention.name.partition("::")[0] == find.name and mention.span != find.span
    }
    return [places[span] for span in sorted(places)]


RULE = Rule(
    name="unused-find-package",
    code="ROS205",
    summary="packages found with find_package() are used by code",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    default=False,
    package=check,
)
