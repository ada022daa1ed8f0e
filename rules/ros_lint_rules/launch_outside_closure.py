"""
## What it finds

A launch file that starts something from a package, includes a file of it or looks it up, while that package does not
come along when the launch file's own package is installed: it is not in the closure of its run-time dependencies. So it is
with commands that it runs: `xacro`, `ros2 control`, `ros2 bag`, `ros2 trace`; and with what it starts nodes with, such as
`prefix="xterm -e"`.

## Why it matters

It works on the machine of whoever wrote it, where everything is installed. After `rosdep install` or
`apt install ros-<distro>-<package>` elsewhere, the launch file stops: `package 'x' not found`.

## How to fix it

Add `<exec_depend>` to `package.xml`. The fix does this. It is unsafe where the message says that not every distribution has
the name.

## Limitations

- The package comes with a declared dependency.
- The package is used in other ways, too, and reported by `undeclared-dependency` or `wrong-dependency-kind`.
- The launch file asks first what is installed, whatever it asks for (`has_resource`, `get_packages_with_prefixes`,
  `PackageNotFoundError`).
- The package exists nowhere: that is `launch-unknown-package`. Where nobody said which distribution is meant, a package of
  any will do, what brings it along there counts, and the message says which have it.
- Launch files of tests and examples, those that a file manager has copied (`arm.launch (copy).py`), and those that are not
  installed. What the package declares for its tests, where the launch file is merely called one (`test_arm.launch.py`).
- What a declared dependency brings along is not known, or a file of the package cannot be read, which may be the script that
  runs the launch file as a test: then the confidence is medium.
- What nodes are started with only under a condition, mostly to find a mistake, has medium confidence.
- The other package needs this one itself, in whatever tag, so that declaring it would close a cycle that colcon refuses: then
  the confidence is medium, too; the launch file may be at home there. So it is where neither declares what it needs of the
  other, for only one of them can.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from ros_lint.api import (
    Confidence,
    Facet,
    Finding,
    LaunchReference,
    Package,
    Related,
    Role,
    Rule,
    Severity,
    Span,
    Workspace,
    advice,
    comes_elsewhere,
    comes_with_launching,
    declared_closure,
    is_apart,
    is_somewhere,
    launchable,
    may_bring,
    needs,
    several,
    undeclared,
)

_AT_RUN_TIME = Role.EXEC | Role.EXPORT
_DONE = {
    "node": "started",
    "component": "loaded",
    "include": "included",
    "command": "run",
    "program": "run",
    "file": "used",
    "package": "looked up",
}
"""What is done with what a launch file refers to, by the kind of the reference: what shows a need best comes first."""
_ORDER = tuple(_DONE)


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    lacking = tuple(_lacking(package, workspace))
    if not lacking:
        return
    unknown = declared_closure(package, workspace, _AT_RUN_TIME).unknown
    sighted = not workspace.unread(package)  # a file that cannot be read may be the script that runs these as tests
    for name, references in lacking:
        best, *others = sorted(references, key=lambda r: (r.package_by_default, r.conditional, _ORDER.index(r.kind), r.span))
        what = name if best.name in ("", name) else f"{best.name} of {name}"
        only = ", if only under a condition" if best.conditional else ""
        only = ", by the default of an argument" if best.package_by_default else only
        way_out = advice(package, workspace, name, Role.EXEC)
        wanted = best.kind != "program" or not best.conditional
        certain = sighted and wanted and way_out.certain and not may_bring(unknown, name, workspace)
        yield Finding(
            f"{what} is {_DONE[best.kind]} here{only}, but {package.name} {_says(package, name)}{way_out.ending}",
            best.package_span,
            name,
            several(Related("also needed here", span) for span in _elsewhere(best.package_span, others)),
            way_out.fix,
            Confidence.HIGH if certain and not _needs(workspace, name, package) else Confidence.MEDIUM,
        )


def _says(package: Package, name: str) -> str:
    """Return how a package declares a name, which is not for running if it does."""
    tags = dict.fromkeys(f"<{declared.depend.tag}>" for declared in package.tags(name))
    return f"declares it as {' and '.join(tags)} only" if tags else "does not depend on it"


def _lacking(package: Package, workspace: Workspace) -> Iterator[tuple[str, list[LaunchReference]]]:
    """Yield what the launch files of a package need and nothing brings along, with the places: what no other rule tells."""
    manifest = package.manifest
    if manifest is None or manifest.problems:
        return
    named = _named(package, workspace)
    if not named:
        return
    closure = declared_closure(package, workspace, _AT_RUN_TIME)
    reported = {need.name for need, sure in undeclared(package, workspace) if sure} | _in_wrong_tags(package, workspace)
    for name, references in named.items():
        if name in closure or name in reported:
            continue
        if workspace.world.is_package(name) or not comes_elsewhere(package, workspace, name):
            yield name, references


def _in_wrong_tags(package: Package, workspace: Workspace) -> frozenset[str]:
    """Return what is declared and does not come at run time, though more than starting and including it takes it then.

    So does what is handed on to those that build against the package.
    """
    found: set[str] = set()
    for need in needs(package, workspace):
        uses = [use for use in need.uses if use.sure and use.via in ("import", "package") and use.role & Role.EXEC]
        handed_on = any(use.sure and use.role & Role.EXPORT for use in need.uses)
        if need.declared and (handed_on or (uses and not comes_with_launching(package, uses))):
            found.update(need.declared)
    return frozenset(found)


def _needs(workspace: Workspace, name: str, package: Package) -> bool:
    """Whether a package of the workspace needs another one that it does not declare: not both can be declared."""
    for other in workspace.by_name.get(name, ()):
        if any(need.name == package.name and sure for need, sure in undeclared(other, workspace)):
            return True
        if any(lacking == package.name for lacking, _ in _lacking(other, workspace)):
            return True
    return False


def _elsewhere(best: Span, others: Sequence[LaunchReference]) -> Iterator[Span]:
    """Yield other places, one of each line."""
    said = {(best.path, best.line)}
    for span in [other.package_span for other in others]:
        if (span.path, span.line) not in said:
            said.add((span.path, span.line))
            yield span


def _named(package: Package, workspace: Workspace) -> Mapping[str, list[LaunchReference]]:
    hidden = bool(package.hidden(Facet.SHARE))
    found: dict[str, list[LaunchReference]] = {}
    for launch in launchable(package):
        if not (launch.installed or hidden):
            continue
        for reference in launch.file.references:
            name = reference.package
            if is_apart(launch.path) and package.declares(name) & Role.TEST:
                continue
            there = workspace.world.is_key(name) if reference.kind == "program" else is_somewhere(name, workspace)
            if name != package.name and not reference.optional and there:
                found.setdefault(name, []).append(reference)
    return found


RULE = Rule(
    name="launch-outside-closure",
    code="ROS503",
    summary="what a launch file needs must be among the run-time dependencies",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
