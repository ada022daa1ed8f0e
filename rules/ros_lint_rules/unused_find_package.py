"""
## What it finds

A `find_package()` of a ROS package that the code does not use: no include, no macro, no interface, no import. That its
targets are linked, that it is exported, or that `rosidl_generate_interfaces()` is given it among `DEPENDENCIES`, does not count.

## Why it matters

Configuring takes longer, and the package can only be built where the other one is.

## How to fix it

Remove the `find_package()`, the target that is linked, and the dependency from `package.xml` if nothing else needs it.

## Limitations

- It is off unless asked for.
- The package found gives CMake macros, plugins or components, or is a build tool.
- Its name stands in the code, as a namespace that some other header makes known, or in another file of the package, or one
  of its types is used by its bare name.
- The code includes a header that nobody is known to have, in a folder that begins like the name.
- The script uses more of its variables than those that are linked.
- It is found for tests, or it is optional.
- The script cannot be followed everywhere, or code is generated from interfaces that cannot be read, or are written in IDL.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Finding, Mention, Package, Related, Rule, Severity, Workspace, found_for_nothing, several


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    for mention in found_for_nothing(package, workspace):
        name = mention.name
        others = _also_named(package, mention)
        what = f"find_package({name})" + (f", and {name} where else it is named" if others else "")
        related = several(Related(f"named here, too: {each.what or each.name}", each.span) for each in others)
        yield Finding(f"{name} is found, but no code uses it: remove {what}", mention.span, name, related)


def _also_named(package: Package, found: Mention) -> list[Mention]:
    """Return where else the build script names what is found: what is linked or exported fails when it is found no more."""
    places = {
        each.span: each
        for each in package.built.mentions
        if each.name.partition("::")[0] == found.name and each.span != found.span
    }
    return [places[span] for span in sorted(places)]


RULE = Rule(
    name="unused-find-package",
    code="ROS205",
    summary="a package that is found must be used by code",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    default=False,
    package=check,
)
