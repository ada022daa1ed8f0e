"""
## What it finds

Nodes written in Python that are installed to `bin/`, because `setup.cfg` is missing or lacks
`install_scripts=$base/lib/<package>`. If `setup.cfg` has this setting with the name of another package, see `name-mismatch`.

Also a `setup.cfg` with this setting under `[install]` only: `colcon build --symlink-install` uses `script_dir` under `[develop]`.

## Why it matters

`ros2 run` and launch look for executables in `lib/<package>` only: "No executable found". Command line tools, in contrast,
belong in `bin/`, where the shell finds them.

## How to fix it

Write a `setup.cfg`:

    [develop]
    script_dir=$base/lib/<package>
    [install]
    install_scripts=$base/lib/<package>

The fix does this, or adds the missing settings to an existing file.

## Limitations

Not reported:

- Entry points whose module does not use rclpy, unless a launch file of the workspace starts them.
- Packages that extend the `ros2` command.

If a program uses rclpy but defines no node, it may be a command line tool: the confidence is medium.
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
    edits,
    first_related,
    launch,
    names,
)

_SET = "set the folder of programs in setup.cfg"
"""Title of the fix if setup.cfg exists."""


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with != "ament_python" or package.hidden(Facet.EXECUTABLES):
        return
    inside = {p.path.rpartition("/")[2] for p in script.products.installs if p.path.startswith(f"lib/{package.name}/")}
    yield from _without_symlinks_only(package, inside)
    outside = {p.path.rpartition("/")[2] for p in script.products.installs if p.path.startswith("bin/")} - inside
    using = {package.relative(use.span.path) for use in package.uses if use.package == "rclpy"}
    modules = {module.name: module.path for module in script.python.entry_point_modules}
    started = launch.nodes_started(workspace, package.name)
    nodes = [
        entry
        for entry in script.products.entry_points
        if entry.group == "console_scripts"
        and entry.name in outside
        and (modules.get(entry.module) in using or entry.name in started)
    ]
    if not nodes or any(entry.group.startswith("ros2cli.") for entry in script.products.entry_points):
        return
    defining = {module.name for module in script.python.entry_point_modules if _NODES.intersection(module.names)}
    sure = any(entry.name in started or entry.module in defining for entry in nodes)
    config = package.start_of("setup.cfg")
    exists = "setup.cfg" in package.files
    changes = edits.setup_py.programs_to(script, package.name) if exists else (edits.setup_py.config(config, package.name),)
    programs = names.shorten_list(entry.name for entry in nodes)
    yield Finding(
        f"{programs} {'are' if len(nodes) > 1 else 'is'} installed to bin/, where ros2 run does not look; "
        f"{'write' if exists else 'add a setup.cfg with'} install_scripts=$base/lib/{package.name} under [install]",
        config if exists else nodes[0].span,
        "setup.cfg",
        first_related(
            Related(f"entry point '{entry.name}' is defined here", entry.span) for entry in nodes[0 if exists else 1 :]
        ),
        Fix.of(_SET if exists else "add a setup.cfg that sets the folder of programs", *changes),
        Confidence.HIGH if sure else Confidence.MEDIUM,
    )


def _without_symlinks_only(package: Package, inside: Container[str]) -> Iterator[Finding]:
    """Yield a finding if programs go to lib/<package> in a normal build, but to bin/ in one with --symlink-install."""
    script = package.built
    folders = edits.setup_py.program_folders(script)
    entries = [entry for entry in script.products.entry_points if entry.group == "console_scripts" and entry.name in inside]
    if entries and "install.install_scripts" in folders and "develop.script_dir" not in folders:
        all_names = [entry.name for entry in entries]
        yield Finding(
            f"colcon build --symlink-install puts {names.shorten_list(all_names)} into bin/, where ros2 run does not look; "
            f"write script_dir=$base/lib/{package.name} under [develop], too",
            folders["install.install_scripts"],
            "setup.cfg",
            first_related(Related(f"entry point '{entry.name}' is defined here", entry.span) for entry in entries),
            Fix.of(_SET, *edits.setup_py.programs_to(script, package.name)),
            severity=Severity.WARNING,
        )


_NODES = frozenset({"Node", "LifecycleNode"})
"""Names of base classes in rclpy. A module that contains one of these names probably defines a node."""


RULE = Rule(
    name="entry-point-location",
    code="ROS407",
    summary="nodes written in Python are installed where ros2 run and launch find them",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
