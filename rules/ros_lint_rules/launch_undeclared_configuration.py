"""
## What it finds

- A launch configuration that is read although nothing declares or sets it.
- A launch configuration that is read with a default although nothing declares or sets it, while an argument of nearly the same
  name is declared.

## Why it matters

The launch file stops: `launch configuration 'x' does not exist`. Only `LaunchConfigurationEquals` continues, and is never true. A
configuration with a default that is read under another name than that of its declaration always has this default.

## How to fix it

Correct the name, or declare the argument.

## Limitations

Not reported:

- Configurations of a file that computes the names of the configurations it reads.
- Configurations of a file with more than two undeclared ones, because such a file is made to be included by other files.
- Files that include a launch file from outside the workspace, and all files if a file of the workspace cannot be read, because it
  may include them.
- Configurations of a file if it, or a file above or below it in the tree of includes, includes an unknown launch file or has an
  action of an unknown class, unless the name is nearly that of a declared argument.
- Configurations of a file that is included by a file with required arguments, if nothing includes the latter: a launch file
  outside of the workspace probably includes it.
- Configurations read with a default, if any launch file of the workspace sets or passes them, or if the name differs from the
  declared one in a number.

Reported with medium confidence:

- One or two undeclared configurations, unless the name is nearly that of a declared argument.
- Configurations read with a default, if the declared argument is used as well.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Confidence, Consequence, Finding, Package, Related, Rule, Severity, Workspace, launch, names

_MOST_MISSING = 2
"""Maximum number of undeclared configurations that are reported in a launch file.

A file that reads more is assumed to be included by a file that sets them.
"""


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    for launch_file in launch.package_launch_files(package):
        if (arguments := launch.argument_use(launch_file.file, workspace)) is not None:
            tree = launch.include_tree(workspace)
            included = bool(tree.above(launch_file.file))
            yield from _undeclared(arguments, included=included, sure=tree.declares_all(launch_file.file))
            yield from _similar(arguments)


def _undeclared(arguments: launch.ArgumentUse, *, included: bool, sure: bool) -> Iterator[Finding]:
    """Yield the findings for undeclared configurations that a launch file reads without a default.

    ``included``: whether another launch file includes the file. ``sure``: whether nothing unknown may declare configurations.
    """
    for name, span in arguments.undeclared.items() if len(arguments.undeclared) <= _MOST_MISSING else ():
        near = names.similar_names(name, sorted(arguments.declared), 1, 0.85)
        if not (near or sure):
            continue
        yield Finding(
            f"launch configuration '{name}' is read, but nothing declares or sets it{names.did_you_mean(near) or '; declare it'}",
            span,
            name,
            confidence=Confidence.HIGH if near and not included else Confidence.MEDIUM,
            explains=tuple([Consequence("launch-unused-argument", meant) for meant in near if meant in arguments.unused]),
        )


def _similar(arguments: launch.ArgumentUse) -> Iterator[Finding]:
    for name, read in arguments.similar.items():
        unused = read.declared in arguments.unused
        yield Finding(
            f"launch configuration '{name}' is read but never declared, so the default here always applies; "
            f"did you mean '{read.declared}', which is declared{' but not used' if unused else ''}?",
            read.span,
            name,
            (Related(f"launch configuration '{read.declared}' is declared here", arguments.declared[read.declared]),),
            confidence=Confidence.HIGH if unused else Confidence.MEDIUM,
            severity=Severity.WARNING,
        )


RULE = Rule(
    name="launch-undeclared-configuration",
    code="ROS515",
    summary="launch configurations that are read are declared or set",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    package=check,
)
