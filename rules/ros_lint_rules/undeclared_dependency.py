"""
## What it finds

A package that is used, but that nothing in `package.xml` brings along: a header that is included, a Python module that
is imported, a `find_package`, a message type, a package whose files are looked up.

## Why it matters

It works as long as somebody else happens to install or build the package first. On a clean machine, in a container or
on the build farm it does not: colcon may build the packages in the wrong order, `rosdep install` leaves the package
out, and the released binary lacks it.

## How to fix it

Declare the package in `package.xml`, in the tag that the message names: `<depend>` for what is compiled against and
needed at run time, `<exec_depend>` for what is needed at run time only, `<test_depend>` for tests. The fix does this.
Where a tag is there, under a condition that does not hold, widen the condition.

The fix is safe if the name resolves in the chosen distribution, or in every active one if none was chosen. Otherwise
the message names the distributions that have or lack the name, and the fix needs `--unsafe-fixes`.

## Limitations

- The package comes with a declared one: see `transitive-dependency` for uses that hang on such a chain.
- It is declared by a wrong name: `unknown-dependency` says so. Then the confidence is medium, and nothing is fixed here.
- The use is optional: `find_package(QUIET)` behind `if(X_FOUND)`, `try: import`, also `try: from .file import` of the file
  that has it, `__has_include`, an import where a comparison of `ROS_VERSION` says ROS 1. Then the confidence is low, and
  nothing is fixed. It is silent where the package needs this one itself.
- It is named only in a template for other packages, by what makes the pages of the documentation, or in an editor's copy.
- colcon rejects `package.xml`, which is to be mended first: then the confidence is medium.
- The name belongs to no package or rosdep key that is known, or to the system. Whose messages are used is a package all the
  same: the confidence is medium, unless another package of the workspace declares it, or CMake does not do without it. What
  another one declares, and CMake finds here, or something looks up, is one, too. So is, with medium confidence, what nobody
  declares, and something that is installed looks up for certain: `$(find x)` means a package, wherever it comes from.
- Only other distributions have the package, or had it: then the message names them, and the confidence is medium, unless
  nobody said which distribution is meant. What brings it along there counts.
- A declared dependency is itself not known, so that the package might come with it, and nothing else needs it that could not:
  then the confidence is medium.
- All evidence is in files that are perhaps not built or installed: then, too, the confidence is medium. So it is with files
  that need what is declared under a condition which does not hold, unless CMake asks for it: they may be for where it does.
  And with files that are looked up in a released metapackage, which has none: another package of its name is meant.
- The package needs this one itself, in whatever tag, so that declaring it would close a cycle that colcon refuses: then,
  too, the confidence is medium, and nothing is fixed. Nor is it where no key resolves for the distribution, and for a project of
  the workspace without `package.xml`, which colcon builds and rosdep does not know.
- Of `launch`, the confidence is medium where `launch_ros` is missing as well, which brings it.
- Modules of launch itself that only launch files import come with `ros2 launch`: then the severity is info.
- Only launch files that are no tests name it, for what they start, include or look up: that is the business of
  `launch-outside-closure`.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import (
    Confidence,
    Finding,
    Need,
    Package,
    Related,
    Role,
    Rule,
    Severity,
    Workspace,
    advice,
    comes_with_launching,
    is_miswritten,
    is_somewhere,
    several,
    tells,
    undeclared,
    unguarded_tests,
    wishes,
)


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    if not tells(package):
        return
    found = undeclared(package, workspace)
    with_launch = {need.name for need, _ in found if comes_with_launching(package, need.uses)}
    for need, sure in found:
        certain = sure and not (need.name == "launch" and "launch_ros" in with_launch)  # which brings it
        says = "is used here, but package.xml does not declare it"
        severity = Severity.INFO if need.name in with_launch else None
        finding = _finding(package, workspace, need, says, Confidence.HIGH if certain else Confidence.MEDIUM)
        if is_miswritten(package, workspace, need):  # the fix is to write its name
            finding = finding._replace(message=f"{need.name} is used here, and package.xml has a wrong name for it", fix=None)
        yield finding._replace(severity=severity)
    for wish in wishes(package, workspace):
        if not wish.brought:
            says = "is used here if it is there, and package.xml does not declare it"
            yield _finding(package, workspace, wish, says, Confidence.LOW)._replace(fix=None)


def _finding(package: Package, workspace: Workspace, need: Need, says: str, confidence: Confidence) -> Finding:
    """Return what is to say of a need. A manifest that colcon rejects has to be mended first: then nothing is certain."""
    best, *others = need.uses
    name = need.name
    role = Role.TEST if name in unguarded_tests(package) else need.role  # which is told to be put where tests are
    way_out = advice(package, workspace, name, role)
    where = _where(name, workspace)
    condition, instead = _condition(package, name), _instead(name, workspace)
    if way_out.circular:
        message = f"{name} is used here, but cannot be declared: {way_out.obstacle}"
    elif where:
        message = f"{name} {says}, nor could it: {workspace.target.distro} has no such package, only {where}"
    elif instead:
        message = f"{name} is used here, and there is no such package: {instead} is meant"
    elif way_out.obstacle:
        message = f"{name} {says}, nor could it: {way_out.obstacle}"
    elif condition:
        message = f"{name} is used here, but package.xml declares it only under the condition {condition}: widen that"
    else:
        message = f"{name} {says}: add {way_out.written}"
        if _needs_back(name, package, workspace):
            message += f"; {name} needs {package.name}, too, and they cannot both declare each other: move to one what both need"
    return Finding(
        message,
        best.span,
        name,
        several(Related(f"also used here: {use.what}", use.span) for use in others),
        None if where or condition or instead else way_out.fix,
        confidence if way_out.certain else min(confidence, Confidence.MEDIUM),
    )


def _instead(name: str, workspace: Workspace) -> str:
    """Return the package that a name which nobody has must mean, "" if there is doubt: one near it, or with a word before it."""
    if workspace.world.standing(name) != "unknown":
        return ""
    meant = workspace.world.meant(name)
    if meant is not None and workspace.world.is_package(meant.name):
        return meant.name
    longer = [other for other in workspace.by_name if other.endswith(f"_{name}")]
    return longer[0] if len(longer) == 1 else ""


def _condition(package: Package, name: str) -> str:
    """Return the condition, which does not hold, under which a manifest declares a name, "" if it does not."""
    depends = package.manifest.depends if package.manifest else ()
    return next((each.condition for each in depends if each.name == name), "")


def _needs_back(name: str, package: Package, workspace: Workspace) -> bool:
    """Whether a package of the workspace surely needs the one that needs it, and does not declare that either."""
    others = workspace.by_name.get(name, ())
    return any(need.name == package.name and sure for other in others for need, sure in undeclared(other, workspace))


def _where(name: str, workspace: Workspace) -> str:
    """Return the distributions that have a package which cannot be had here: if nobody said which is meant, any will do."""
    world = workspace.world
    if world.is_key(name) or is_somewhere(name, workspace):
        return ""
    ended = () if world.is_declared(name) else world.knowledge.names.end_of_life(name)  # whoever declares it has its sources
    return ", ".join(world.where_else(name) or ended)


RULE = Rule(
    name="undeclared-dependency",
    code="ROS201",
    summary="a package that is used must be declared",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
