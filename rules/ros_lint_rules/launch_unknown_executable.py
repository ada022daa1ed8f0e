"""
## What it finds

A launch file that starts an executable which its package does not install into `lib/<package>`: it has another name,
is not built, or is a script that is there and is not installed.

## Why it matters

The launch file stops there: `executable 'x' not found on the libexec directory`.

## How to fix it

Correct the name. The usual slips are the suffix (a console script is called `talker`, a script installed by CMake
`talker.py`), the name of a module instead of the entry point that runs it, and a target that was renamed. Install a script
that only lies there, and what is built; if it lands in `bin/`, install it to
`lib/${PROJECT_NAME}`, or say `install_scripts=$base/lib/<package>` in `setup.cfg`. The fix corrects the name where one
executable must be meant.

## Limitations

- A part of the package's build script that cannot be followed may make the executable, or it installs a file of that name
  which is not in the sources: `missing-file` tells of it.
- For a released package: neither the sources of its release are known whole, nor those for an earlier and a later
  distribution; or one of these has it. Where nobody said which one is meant, the confidence is medium as long as one of
  them may have it.
- Only other distributions come there: `'spawner' if os.environ['ROS_DISTRO'] > 'foxy' else 'spawner.py'`.
- In launch files of examples, and of tests that the build script is not seen to run, the confidence is medium; one that is
  merely called a test and always installed counts like any other.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from typing import NamedTuple

from ros_lint.api import (
    Confidence,
    Finding,
    Package,
    Related,
    Rule,
    Severity,
    Workspace,
    corrected,
    did_you_mean,
    launchable,
    near_names,
    place_of,
    programs,
    referred,
    several,
    stranded,
)


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    idle = frozenset(launch.file.path for launch in launchable(package, apart=True) if not launch.run)
    started = referred(package, ("node",), apart=True)
    for (owner, name), references in started.items():
        if "/" in name:
            continue
        missing = _missing(owner, name, workspace)
        if missing is None:
            continue
        best, *others = sorted(references, key=lambda one: (one.span.path in idle, one.by_default, one.span))
        same = [one for one in started.get((owner, missing.meant), ()) if one.conditional and one.span.path == best.span.path]
        if same and best.conditional:  # one or the other, so that this is another program
            instead = (Related("started otherwise", same[0].span), *missing.related)
            missing = missing._replace(hint=f"; it installs {missing.meant}", meant="", related=instead)
        yield Finding(
            f"{owner} installs no executable {name}{missing.hint}",
            best.span,
            name,
            (*missing.related, *several(Related("also started here", reference.span) for reference in others)),
            corrected(f"start {missing.meant}", missing.meant, [(one.span, one.exact) for one in references]),
            Confidence.MEDIUM if best.by_default or best.span.path in idle else missing.confidence,
        )


class _Missing(NamedTuple):
    hint: str
    meant: str = ""
    related: tuple[Related, ...] = ()
    confidence: Confidence = Confidence.HIGH


def _missing(owner: str, name: str, workspace: Workspace) -> _Missing | None:
    owners = workspace.by_name.get(owner, ())
    if not owners:
        known = workspace.world.executables(owner)
        if known.ask(name) != "missing":
            return None
        sure = workspace.surely_lacks(owner, "executables", name)
        meant = _meant(name, known.names)
        return _Missing(
            f" in {workspace.target.distro}{_hint(name, meant, known.possible)}",
            meant,
            (),
            Confidence.HIGH if sure else Confidence.MEDIUM,
        )
    names: set[str] = set()
    for one in owners:
        found = programs(one)
        if found is None or name in found.names or stranded(one, name) or _is_lost(one, name):
            return None
        if name in found.elsewhere:
            path = found.elsewhere[name]
            where = tuple(Related("installed here", p.span) for p in one.built.provides if p.path == path)
            return _Missing(f" in lib/{owner}, but {path}, where launch does not look; install it there", "", where)
        names |= found.names
        if lying := _lying(one, name) or _built(one, name):
            return lying
    meant = _meant(name, tuple(sorted(names)))
    if not meant and (running := next(filter(None, (_running(one, name, names) for one in owners)), None)):
        return running
    related = tuple(Related("its build script", one.script.end) for one in owners if one.script and one.script.end)
    return _Missing(_hint(name, meant, tuple(sorted(names))), meant, related[:1])


def _is_lost(package: Package, name: str) -> bool:
    """Whether the build script installs a program that is not in the sources: missing-file tells, unless git leaves it out."""
    lost = [problem.subject.rpartition("/")[2] for problem in package.built.problems if problem.kind == "missing-file"]
    return name in lost


def _built(package: Package, name: str) -> _Missing | None:
    """Return what to say of an executable of the name that a package builds, and that no other rule tells to be left behind."""
    target = next((each for each in package.built.targets if each.kind == "executable" and each.name == name), None)
    if target is None:
        return None
    return _Missing(f": it is built, but not installed; install it to lib/{package.name}", "", (Related("here", target.span),))


def _running(package: Package, name: str, names: Collection[str]) -> _Missing | None:
    """Return what to say of a name that is not one of a program, but of the Python file that is to run."""
    script, stem = package.built, name.removesuffix(".py")
    entries = [entry for entry in script.entry_points if entry.name in names and entry.module.rpartition(".")[2] == stem]
    if entries:
        one = entries[0] if len(entries) == 1 else None
        return _Missing(
            f": {' or '.join(entry.name for entry in entries[:3])} runs the module {entries[0].module}",
            one.name if one else "",
            tuple(Related("by this entry point", entry.span) for entry in entries[:1]),
        )
    module = next((module for module in script.python_packages if module.rpartition(".")[2] == stem and "." in module), "")
    if module and script.entry_points:
        return _Missing(f": the module {module} has no entry point; add one to console_scripts")
    lying = _lying(package, f"{stem}.py")
    return lying._replace(hint=f"{lying.hint}, and start {stem}.py") if lying and stem == name else None


def _lying(package: Package, name: str) -> _Missing | None:
    """Return what to say of a script of the name that is not among the programs of a package, under another name either."""
    script = package.built
    own = f"lib/{package.name}/"
    programs_of = {provided.source for provided in script.provides if provided.path.startswith(own)}
    files = (file.path for file in script.files if file.path.rpartition("/")[2] == name)
    lying = next((path for path in files if path not in programs_of), "")
    if not lying:
        return None
    elsewhere = any(provided.source == lying for provided in script.provides)
    there = Related("this file", place_of(package, lying))
    return _Missing(f": {lying} is not installed{f' to {own[:-1]}' if elsewhere else ''}; install it", "", (there,))


def _hint(name: str, meant: str, names: tuple[str, ...]) -> str:
    if meant:
        return f": {meant} is meant"
    near = near_names(name, names, 3, 0.6)
    if near:
        return did_you_mean(near)
    started = [other for other in names if not other.endswith(_LIBRARY)]
    if not started:
        return ", and no other either"
    return f"; it installs {', '.join(started[:5])}{' ...' if len(started) > 5 else ''}"


_LIBRARY = (".a", ".so")
"""Such files are put beside the programs by a build script that says the one folder for all of its targets."""


_SUFFIX = re.compile(r"(?:\.py|\.sh|_?node|_?exe|_?main)+$")


def _meant(name: str, names: tuple[str, ...]) -> str:
    """Return the one executable that differs only in its suffix, in dashes and underscores, or in capitals."""

    def plain(text: str) -> str:
        text = text.lower().replace("-", "_")
        return (_SUFFIX.sub("", text) or text).replace("_", "")

    same = [other for other in names if plain(other) == plain(name)]
    return same[0] if len(same) == 1 else ""


RULE = Rule(
    name="launch-unknown-executable",
    code="ROS502",
    summary="an executable that a launch file starts must be installed by its package",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
