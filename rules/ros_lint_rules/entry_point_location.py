"""
## What it finds

Console scripts of nodes that land in `bin/`, because `setup.cfg` is missing or does not say
`install_scripts=$base/lib/<package>`. Another name than that of the package there is a matter of `name-mismatch`.

Also a `setup.cfg` that says so under `[install]` alone: `colcon build --symlink-install` asks for `script_dir` under `[develop]`.

## Why it matters

`ros2 run` and launch look into `lib/<package>` only: "No executable found". Command line tools, in contrast, belong into
`bin/`, where the shell finds them.

## How to fix it

Write a `setup.cfg`:

    [develop]
    script_dir=$base/lib/<package>
    [install]
    install_scripts=$base/lib/<package>

The fix does this, and adds what is missing to one that is there.

## Limitations

For entry points whose module does not use rclpy, and that no launch file of the workspace starts; in packages that extend the
command `ros2`. A program that uses rclpy and defines no node of its own may be a tool, too: the confidence is medium.
"""

from __future__ import annotations

from collections.abc import Container, Iterator

from ros_lint.api import (
    Confidence,
    Facet,
    Finding,
    Fix,
    Package,
    Related,
    Rule,
    Severity,
    Workspace,
    few,
    place_of,
    relative,
    setup_edits,
    several,
)


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with != "ament_python" or package.hidden(Facet.EXECUTABLES):
        return
    inside = {p.path.rpartition("/")[2] for p in script.provides if p.path.startswith(f"lib/{package.name}/")}
    yield from _for_copies_only(package, inside)
    outside = {p.path.rpartition("/")[2] for p in script.provides if p.path.startswith("bin/")} - inside
    using = {relative(package, use.span.path) for use in package.uses if use.package == "rclpy"}
    modules = {module.name: module.path for module in script.modules}
    started = workspace.started.get(package.name, {})
    nodes = [
        entry
        for entry in script.entry_points
        if entry.group == "console_scripts"
        and entry.name in outside
        and (modules.get(entry.module) in using or entry.name in started)
    ]
    if not nodes or any(entry.group.startswith("ros2cli.") for entry in script.entry_points):
        return
    defining = {module.name for module in script.modules if _NODES.intersection(module.names)}
    sure = any(entry.name in started or entry.module in defining for entry in nodes)
    config = place_of(package, "setup.cfg")
    there = "setup.cfg" in package.files
    edits = setup_edits.programs_to(script, package.name) if there else (setup_edits.config(config, package.name),)
    names = [entry.name for entry in nodes]
    named = few(names)
    yield Finding(
        f"{named} {'land' if len(names) > 1 else 'lands'} in bin/, where ros2 run does not look; "
        f"{'say' if there else 'add a setup.cfg with'} install_scripts=$base/lib/{package.name}",
        config if there else nodes[0].span,
        "setup.cfg",
        several(Related("this entry point", entry.span) for entry in nodes[0 if there else 1 :]),
        Fix.of(f"{'complete' if there else 'add'} setup.cfg", *edits),
        Confidence.HIGH if sure else Confidence.MEDIUM,
    )


def _for_copies_only(package: Package, inside: Container[str]) -> Iterator[Finding]:
    """Yield what is to say where programs find their place unless they are linked to the sources."""
    script = package.built
    folders = setup_edits.program_folders(script)
    entries = [entry for entry in script.entry_points if entry.group == "console_scripts" and entry.name in inside]
    if entries and "install.install_scripts" in folders and "develop.script_dir" not in folders:
        names = [entry.name for entry in entries]
        yield Finding(
            f"with colcon build --symlink-install {few(names)} {'land' if len(names) > 1 else 'lands'} in bin/, where ros2 run "
            f"does not look; say script_dir=$base/lib/{package.name} under [develop], too",
            folders["install.install_scripts"],
            "setup.cfg",
            several(Related("this entry point", entry.span) for entry in entries),
            Fix.of("complete setup.cfg", *setup_edits.programs_to(script, package.name)),
            severity=Severity.WARNING,
        )


_NODES = frozenset({"Node", "LifecycleNode"})
"""Classes that a module with a node imports by name."""


RULE = Rule(
    name="entry-point-location",
    code="ROS407",
    summary="nodes written in Python must be installed to lib/<package>",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
