"""
## What it finds

A launch file that starts something from a package, includes a file of it or looks it up, but the package is not in the
run-time closure: installing the package of the launch file does not install it.

Also reported are the packages of commands that the launch file runs, such as `xacro`, `ros2 control`, `ros2 bag` and `ros2
trace`, and of commands in front of nodes, such as `prefix="xterm -e"`.

## Why it matters

The launch file works on the author's machine, where everything is installed. After `rosdep install` or
`apt install ros-<distro>-<package>` on another machine it fails: `package 'x' not found`.

## How to fix it

Add `<exec_depend>` to `package.xml`. The fix does this. It is unsafe where the message says that not every distribution has
the name.

## Limitations

Not reported:

- Packages that a declared dependency provides transitively.
- Packages with other uses that `undeclared-dependency` or `wrong-dependency-kind` reports.
- Launch files that check what is installed, with `has_resource`, `get_packages_with_prefixes` or `PackageNotFoundError`.
- Packages that do not exist: see `launch-unknown-package`. If no target distribution is set, a package of any distribution is
  accepted, with its dependencies in that distribution; the message names the distributions.
- Launch files of tests and examples, copies of launch files (`arm.launch (copy).py`), and launch files that are not installed.
- `<test_depend>` packages, in a launch file that is only named like a test (`test_arm.launch.py`).

Reported with medium confidence:

- The closure of a declared dependency is unknown.
- A file of the package cannot be read: it may be the script that runs the launch file as a test.
- The launch file is called only `example` or `test`, so users start it by hand.
- Commands in front of nodes under a condition, which are mostly for debugging.
- The other package depends on this one, so declaring it would close a cycle that colcon rejects. The launch file may belong in
  the other package.
- Two packages need each other, and neither package declares the other one: only one of the two can do so.
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
    dependencies,
    files,
    first_related,
    launch,
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
"""The verb for each kind of reference of a launch file. The kind with the strongest evidence is first."""
_ORDER = tuple(_DONE)
_LINES_OF_CALL = 1
"""Maximum number of lines between the package and the file name in one call.

If more lines are between them, the path of the package is in a variable.
"""


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    lacking = tuple(_lacking(package, workspace))
    if not lacking:
        return
    unknown = dependencies.declared_closure(package, workspace, _AT_RUN_TIME).unknown
    readable = not workspace.unread(package)  # an unreadable file may be the script that runs these launch files as tests
    for name, references in lacking:
        best, *others = sorted(references, key=lambda r: (r.package_from_default, r.conditional, _ORDER.index(r.kind), r.span))
        how = " under a condition" if best.conditional and not _is_in_every_branch(name, best, package) else ""
        how = " by the default of an argument" if best.package_from_default else how
        place = _place(best, others)
        proposal = dependencies.remedy(package, workspace, name, Role.EXEC)
        needed = (best.kind != "program" or not best.conditional) and not all(map(_is_in_example, references))
        certain = readable and needed and proposal.certain and not dependencies.may_provide(unknown, name, workspace)
        yield Finding(
            f"{_use(best, name, place)}{how}, but '{package.name}' {_declares(package, name)}{proposal.ending}",
            place,
            name,
            first_related(Related(f"'{name}' is also needed here", span) for span in _elsewhere(place, others)),
            proposal.fix,
            Confidence.HIGH if certain and not _needs(workspace, name, package) else Confidence.MEDIUM,
        )


def _is_in_example(reference: LaunchReference) -> bool:
    """Return whether a reference is in ``example.launch.py`` or ``test.launch.py``: users start such files by hand."""
    return reference.span.path.rpartition("/")[2].partition(".")[0] in ("example", "test")


def _use(reference: LaunchReference, name: str, place: Span) -> str:
    """Return the part of the message that says how a launch file uses the package ``name``: ``'rviz2' is started here``.

    ``place``: the place of the finding.
    """
    verb, file_place = _DONE[reference.kind], reference.span
    if reference.name in ("", name):
        return f"'{name}' is {verb} here"
    looked_up = reference.kind in ("include", "file") and file_place.path == place.path
    if looked_up and abs(file_place.line - place.line) > _LINES_OF_CALL:
        return f"'{name}' is looked up here, and its '{reference.name}' is {verb} in line {file_place.line}"
    return f"'{reference.name}' of '{name}' is {verb} here"


def _is_in_every_branch(name: str, reference: LaunchReference, package: Package) -> bool:
    """Return whether the launch file with a reference starts nodes of the package ``name`` whichever conditions hold."""
    file = next((file for file in package.launch if file.path == reference.package_span.path), None)
    return file is not None and name in launch.packages_of_every_branch(file)


def _place(best: LaunchReference, others: Sequence[LaunchReference]) -> Span:
    """Return the place of the finding, given the reference to report first (``best``) and the other references.

    It is the place of the package name. If several references share this place, it is the place of the file name.
    """
    is_shared = any(other.package_span == best.package_span and other.name != best.name for other in others)
    return best.span if is_shared and best.kind in ("include", "file") else best.package_span


def _declares(package: Package, name: str) -> str:
    """Return the part of the message that says how the package declares a name: only as other tags, or not at all."""
    tags = dict.fromkeys(f"<{declared.depend.tag}>" for declared in package.tags(name))
    return f"declares it only as {' and '.join(tags)}" if tags else "does not depend on it"


def _lacking(package: Package, workspace: Workspace) -> Iterator[tuple[str, list[LaunchReference]]]:
    """Yield each package that launch files use without a direct or indirect run-time dependency, with its references.

    Packages that another rule reports are left out.
    """
    manifest = package.manifest
    if manifest is None or manifest.problems:
        return
    named = _named(package, workspace)
    if not named:
        return
    closure = dependencies.declared_closure(package, workspace, _AT_RUN_TIME)
    reported = {need.name for need, sure in dependencies.undeclared(package, workspace) if sure}
    reported.update(lack.need.name for lack in dependencies.misplaced(package, workspace))
    reported |= _in_wrong_tags(package, workspace)
    for name, references in named.items():
        if name in closure or name in reported:
            continue
        if workspace.world.is_package(name) or not dependencies.distros_providing(package, workspace, name):
            yield name, references


def _in_wrong_tags(package: Package, workspace: Workspace) -> frozenset[str]:
    """Return the declared packages that the rule wrong-dependency-kind may report, because their tags may not cover their uses.

    These packages are exported, or code uses them at run time for more than launching.
    """
    names: set[str] = set()
    for need in dependencies.needs(package, workspace):
        uses = [use for use in need.uses if use.certain and use.via in ("import", "package") and use.role & Role.EXEC]
        exported = any(use.certain and use.role & Role.EXPORT for use in need.uses)
        if need.declared and (exported or (uses and not dependencies.is_part_of_launch(package, workspace, uses))):
            names.update(need.declared)
    return frozenset(names)


def _needs(workspace: Workspace, name: str, package: Package) -> bool:
    """Return whether the package ``name`` needs ``package`` without declaring it.

    Only one of the two packages can declare the other one, because colcon rejects cycles.
    """
    for candidate in workspace.by_name.get(name, ()):
        if any(need.name == package.name and sure for need, sure in dependencies.undeclared(candidate, workspace)):
            return True
        if any(lacking == package.name for lacking, _ in _lacking(candidate, workspace)):
            return True
    return False


def _elsewhere(best: Span, others: Sequence[LaunchReference]) -> Iterator[Span]:
    """Yield the places at which the references ``others`` name the package: one on each line, without the line of ``best``."""
    lines = {(best.path, best.line)}
    for span in [reference.package_span for reference in others]:
        if (span.path, span.line) not in lines:
            lines.add((span.path, span.line))
            yield span


def _named(package: Package, workspace: Workspace) -> Mapping[str, list[LaunchReference]]:
    hidden = bool(package.hidden(Facet.SHARE))
    by_package: dict[str, list[LaunchReference]] = {}
    for launch_file in launch.package_launch_files(package):
        if not (launch_file.installed or hidden):
            continue
        for reference in launch_file.file.references:
            name = reference.package
            if files.is_auxiliary(launch_file.path) and package.declares(name) & Role.TEST:
                continue
            exists = (
                workspace.world.is_key(name)
                if reference.kind == "program"
                else dependencies.exists_in_any_distro(name, workspace)
            )
            if name != package.name and not reference.optional and exists:
                by_package.setdefault(name, []).append(reference)
    return by_package


RULE = Rule(
    name="launch-outside-closure",
    code="ROS503",
    summary="packages that a launch file needs are run-time dependencies",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
