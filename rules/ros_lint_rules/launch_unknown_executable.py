"""
## What it finds

A launch file that starts an executable which is not installed into `lib/<package>`. Either the installed executable has another
name, or the executable is not built, or it is a script in the sources that is not installed.

## Why it matters

The launch file stops there: `executable 'x' not found on the libexec directory`.

## How to fix it

Correct the name. Frequent mistakes are:

- the suffix: a console script is called `talker`, a script installed by CMake is called `talker.py`;
- the name of a module instead of the entry point that runs it;
- the old name of a target that was renamed.

Install a script or target that is not installed. If it is installed to `bin/`, install it to `lib/${PROJECT_NAME}`, or write
`install_scripts=$base/lib/<package>` in `setup.cfg`. The fix corrects the name if only one executable is possible.

## Limitations

Not reported:

- A part of the package's build script that cannot be evaluated may install the executable.
- The build script installs a file of that name that is not in the sources: see `missing-file`.
- The package is released, and the sources of its release are not fully known. The sources for an earlier and a later
  distribution are used instead, if both are known and neither contains the executable.
- Names that are only used on other distributions: `'spawner' if os.environ['ROS_DISTRO'] > 'foxy' else 'spawner.py'`.

Reported with medium confidence:

- The distribution was not chosen, and the package may install the executable in another distribution.
- Launch files of examples, and of tests that the build script does not run. A launch file that only has a test-like name but is
  always installed is not affected.
- The name is the default of an argument.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from typing import NamedTuple

from ros_lint.api import Confidence, Finding, Package, Related, Rule, Severity, Workspace, build, first_related, launch, names


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    idle = frozenset(
        launch_file.file.path for launch_file in launch.package_launch_files(package, apart=True) if not launch_file.run
    )
    started = launch.references_by_name(package, ("node",), apart=True)
    for (owner, name), references in started.items():
        if "/" in name:
            continue
        missing = _missing(owner, name, package, workspace)
        if missing is None:
            continue
        best, *others = sorted(
            references, key=lambda reference: (reference.span.path in idle, reference.from_default, reference.span)
        )
        meant = started.get((owner, missing.meant), ())
        alternatives = [other for other in meant if other.conditional and other.span.path == best.span.path]
        if alternatives and best.conditional:  # two conditional nodes: the names are alternatives, so neither is a typo
            instead = (Related(f"'{missing.meant}' is started here", alternatives[0].span), *missing.related)
            missing = missing._replace(hint=f"; it installs '{missing.meant}'", meant="", related=instead)
        yield Finding(
            f"'{owner}' does not install an executable '{name}'{missing.hint}",
            best.span,
            name,
            (*missing.related, *first_related(Related(f"'{name}' is also started here", reference.span) for reference in others)),
            launch.rename_fix(
                f"start '{missing.meant}'",
                missing.meant,
                [(reference.span, reference.exact) for reference in references],
            ),
            Confidence.MEDIUM if best.from_default or best.span.path in idle else missing.confidence,
        )


class _Missing(NamedTuple):
    """An executable that a package does not install, and the hint for the message."""

    hint: str
    """The end of the message, which says what to do: ``; did you mean 'talker'?``."""
    meant: str = ""
    """The only executable that is possible instead, or ""."""
    related: tuple[Related, ...] = ()
    confidence: Confidence = Confidence.HIGH


def _missing(owner: str, name: str, starting: Package, workspace: Workspace) -> _Missing | None:
    """Return the problem, with a suggestion, if package ``owner`` does not install the executable ``name``; else None.

    ``starting`` is the package of the launch file: only packages of its workspace are suggested.
    """
    owners = workspace.by_name.get(owner, ())
    other = launch.only_installer([name], starting, workspace)
    if not owners:
        known = workspace.world.executables(owner)
        if known.ask(name) != "missing":
            return None
        sure = workspace.surely_lacks(owner, "executables", name)
        meant = _meant(name, known.names)
        return _Missing(
            f" in {workspace.target.distro}{_hint(name, meant, other, known.possible)}",
            meant,
            (),
            Confidence.HIGH if sure else Confidence.MEDIUM,
        )
    all_names: set[str] = set()
    for package in owners:
        installed = launch.installed_programs(package)
        if installed is None or name in installed.names or build.installed_to_bin_only(package, name) or _is_lost(package, name):
            return None
        if name in installed.elsewhere:
            path = installed.elsewhere[name]
            where = tuple(
                Related(f"'{path}' is installed here", p.span) for p in package.built.products.installs if p.path == path
            )
            hint = f" in lib/{owner}; it is installed as '{path}', where launch does not look; install it to lib/{owner}"
            return _Missing(hint, "", where)
        all_names |= installed.names
        if left_out := _uninstalled_script(package, name) or _uninstalled_target(package, name):
            return left_out
    meant = _meant(name, tuple(sorted(all_names)))
    if not meant and (by_module := next(filter(None, (_named_by_module(package, name, all_names) for package in owners)), None)):
        return by_module
    scripts = [package.script for package in owners]
    related = tuple(
        Related(f"the build script of '{owner}'", script.commands.insertion)
        for script in scripts
        if script and script.commands.insertion
    )
    return _Missing(_hint(name, meant, other, tuple(sorted(all_names))), meant, related[:1])


def _is_lost(package: Package, name: str) -> bool:
    """Return whether the build script installs a file ``name`` that is not in the sources: missing-file reports that file."""
    lost = [problem.subject.rpartition("/")[2] for problem in package.built.problems if problem.kind == "missing-file"]
    return name in lost


def _uninstalled_target(package: Package, name: str) -> _Missing | None:
    """Return the hint for an executable that the package builds but does not install; None if it does not build ``name``."""
    executables = [target for target in package.built.products.targets if target.kind == "executable"]
    target = next((target for target in executables if target.name == name), None)
    if target is None:
        return None
    hint = f", although it builds it; install it to lib/{package.name}"
    return _Missing(hint, "", (Related(f"'{name}' is built here", target.span),))


def _named_by_module(package: Package, name: str, all_names: Collection[str]) -> _Missing | None:
    """Return the hint if ``name`` is a Python module of the package instead of the executable that runs it, else None."""
    script, stem = package.built, name.removesuffix(".py")
    entries = [
        entry for entry in script.products.entry_points if entry.name in all_names and entry.module.rpartition(".")[2] == stem
    ]
    if entries:
        quoted = " or ".join(f"'{entry.name}'" for entry in entries[:3])
        return _Missing(
            f"; start {quoted}, which runs the module '{entries[0].module}'",
            entries[0].name if len(entries) == 1 else "",
            tuple(Related(f"entry point '{entry.name}' is defined here", entry.span) for entry in entries[:1]),
        )
    module = next(
        (module for module in script.products.python_packages if module.rpartition(".")[2] == stem and "." in module), ""
    )
    if module and script.products.entry_points:
        return _Missing(f"; add an entry point for the module '{module}' to console_scripts")
    uninstalled = _uninstalled_script(package, f"{stem}.py")
    return uninstalled._replace(hint=f"{uninstalled.hint}, and start '{stem}.py'") if uninstalled and stem == name else None


def _uninstalled_script(package: Package, name: str) -> _Missing | None:
    """Return the hint for a script with this file name that is not installed to lib/<package>; None if there is none."""
    script = package.built
    own = f"lib/{package.name}/"
    programs_of = {provided.source for provided in script.products.installs if provided.path.startswith(own)}
    files = (file.path for file in script.files.scripts if file.path.rpartition("/")[2] == name)
    uninstalled = next((path for path in files if path not in programs_of), "")
    if not uninstalled:
        return None
    file = Related(f"the script '{uninstalled}'", package.start_of(uninstalled))
    return _Missing(f"; install the script '{uninstalled}' to {own[:-1]}", "", (file,))


def _hint(name: str, meant: str, other: str, all_names: tuple[str, ...]) -> str:
    """Return the end of the message for an executable that a package does not install.

    - ``meant``: the only executable of the package that is possible instead, or ""
    - ``other``: the only package that installs ``name``, or ""
    - ``all_names``: the executables of the package
    """
    if meant:
        return names.ask_if_meant([meant])
    if other:
        return f"; did you mean '{other}', which installs '{name}'?"
    near = names.near_names(name, all_names, 3, 0.6)
    if near:
        return names.did_you_mean(near)
    executables = [other for other in all_names if not other.endswith(_LIBRARY)]
    if not executables:
        return f"; it installs no executables: correct the package, or install '{name}'"
    listed = ", ".join(f"'{executable}'" for executable in executables[:5])
    return f"; it installs {listed}{' ...' if len(executables) > 5 else ''}"


_LIBRARY = (".a", ".so")
"""Suffixes of libraries, which a build script may install next to the executables."""


_SUFFIX = re.compile(r"(?:\.py|\.sh|_?node|_?exe|_?main)+$")


def _meant(name: str, all_names: tuple[str, ...]) -> str:
    """Return the only executable that differs from ``name`` just in its suffix, dashes, underscores or capitals; else ""."""

    def plain(text: str) -> str:
        text = text.lower().replace("-", "_")
        return (_SUFFIX.sub("", text) or text).replace("_", "")

    same = [other for other in all_names if plain(other) == plain(name)]
    return same[0] if len(same) == 1 else ""


RULE = Rule(
    name="launch-unknown-executable",
    code="ROS502",
    summary="executables that launch files start are installed by their packages",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
