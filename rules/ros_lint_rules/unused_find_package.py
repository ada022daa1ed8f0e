"""
## What it finds

A `find_package()` of a ROS package that the code does not use: no include, no macro, no interface, no import. That its
targets are linked, or that it is exported, does not count.

## Why it matters

Configuring takes longer, and the package can only be built where the other one is.

## How to fix it

Remove the `find_package()`, the target that is linked, and the dependency from `package.xml` if nothing else needs it.

## When it keeps silent

- It is off unless asked for.
- The package found gives CMake macros, plugins or components, or is a build tool.
- Nobody has looked for its name in other files: it may be needed by what is loaded while the program runs.
- It is found for tests, or it is optional.
- The script cannot be followed everywhere.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Facet, Finding, Package, Rule, Severity, Workspace, is_mostly_run, works_unseen

_CMAKE = ("cmake", "target")
_FOR_CODE = ("interfaces", "plugins")
"""Targets that are linked say nothing: these packages are needed for the code that is generated or loaded."""


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or script.problems or package.builds_with != "ament_cmake" or package.hidden(Facet.USES):
        return
    used = {name for use in package.uses if use.via not in _CMAKE for name in use.providers}
    used |= {
        mention.name.partition("::")[0]
        for mention in script.mentions
        if mention.via not in _CMAKE or mention.purpose in _FOR_CODE
    }
    said = set()
    for mention in script.mentions:
        name = mention.name
        if mention.via != "cmake" or mention.optional or mention.test or name in used or name in said:
            continue
        if name == package.name or works_unseen(package, workspace, name) or is_mostly_run(workspace, name):
            continue
        said.add(name)
        yield Finding(f"{name} is found, but no code uses it: remove find_package({name})", mention.span, name)


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
