"""install(TARGETS): the files that targets build, and their destinations."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from ros_lint.base.paths import join as join_path
from ros_lint.collectors.cmake.commands.target_headers import DESTINATION, FILE_SET, installed_headers
from ros_lint.collectors.cmake.commands.targets import output_name, real_target
from ros_lint.collectors.cmake.evaluator.run import Run
from ros_lint.collectors.cmake.evaluator.state import InstalledTarget, Properties
from ros_lint.collectors.cmake.evaluator.values import is_known, strip_mark
from ros_lint.collectors.cmake.released_macros import INSTALL_ARTIFACTS, INSTALL_TARGETS_WORDS, VARIABLES
from ros_lint.facts.build import InstalledFile
from ros_lint.facts.visibility import Facet, Opaque


def install_targets(run: Run, args: list[str]) -> None:
    """Run ``install(TARGETS args...)``: record the targets."""
    names: list[str] = []
    destinations: dict[str, str] = {}
    exported_in = ""
    artifact = ""
    remaining = -1
    keyword = ""
    for arg in args:
        if arg in INSTALL_ARTIFACTS:
            artifact, keyword = arg, arg
        elif arg in INSTALL_TARGETS_WORDS:
            keyword, remaining = arg, INSTALL_TARGETS_WORDS[arg]
        elif arg == "TARGETS":
            keyword = ""  # CMake allows the word to be repeated
        elif not keyword:
            names.append(arg)
        elif keyword == "FILE_SET" and remaining:
            artifact = f"{FILE_SET}{arg}"
            destinations[artifact] = DESTINATION
            remaining -= 1
        elif keyword == "DESTINATION" and remaining:
            destinations[artifact] = arg
            remaining -= 1
        elif keyword == "EXPORT" and not exported_in:
            exported_in = strip_mark(arg)[0]
            if not is_known(exported_in):
                run.hide(Facet.LIBRARIES, "the export set of install(TARGETS) is unknown")
    default = destinations.get("")
    runtime = run.paths.destination(strip_mark(destinations.get("RUNTIME") or default or "bin")[0])
    library = run.paths.destination(strip_mark(destinations.get("LIBRARY") or default or "lib")[0])
    archive = run.paths.destination(strip_mark(destinations.get("ARCHIVE") or default or "lib")[0])
    of_headers = [artifact for artifact in destinations if artifact.startswith(FILE_SET) or artifact.endswith("_HEADER")]
    headers = tuple([(artifact, run.paths.destination(strip_mark(destinations[artifact])[0])) for artifact in of_headers])
    for name in names:
        plain, certain = strip_mark(name)
        if not is_known(plain):
            run.hide(Facet.EXECUTABLES | Facet.LIBRARIES, "a target of install(TARGETS) is unknown")
        elif not run.muted:
            conditional = run.conditional or run.testing or not certain
            span = run.place_of(name)
            undefined = not (conditional or _may_be_target(run, plain))
            target = InstalledTarget(plain, runtime, library, archive, conditional, span, exported_in, headers, undefined)
            run.results.installed_targets.append(target)


def _may_be_target(run: Run, name: str) -> bool:
    """Return whether a command has defined a target so far, or may have defined it."""
    return (
        name in run.targets
        or run.any_variable_may_be_set
        or any(opaque.hides & Facet.LIBRARIES for opaque in run.results.opaques)
    )


_PYTHON: Final = f"{VARIABLES['PYTHON_INSTALL_DIR']}/"


def installed_targets(run: Run) -> Iterator[InstalledFile]:
    """Yield the files of the installed targets. This function must be called after the whole script has run."""
    for installed in run.results.installed_targets:
        name, span, conditional = installed.target, installed.span, installed.conditional
        target = real_target(run, name)
        if target is None:
            if not run.open_world or "::" not in name:
                run.results.undefined_targets.append((name, span, installed.undefined))
            reason = f"no definition of the target '{name}' was found"
            run.results.opaques.setdefault(Opaque(Facet.EXECUTABLES | Facet.LIBRARIES, reason, span, name))
            if installed.executables is not None:  # if the target exists, it is most likely a program
                yield InstalledFile(join_path(installed.executables, name), "", True, True, span, name)
            continue
        yield from installed_headers(run, name, target, installed.headers, conditional or "CONDITIONAL" in target, span)
        if target["KIND"] not in ("interface", "object", "other", "imported"):
            unsure = conditional or not {"CONDITIONAL", "PERHAPS", "TEST"}.isdisjoint(target)
            yield from _built_files(run, installed, target, unsure)
            if "PERHAPS" in target:
                yield from _built_files(run, installed, Properties(target, KIND=target["PERHAPS"]), unsure)


def _built_files(run: Run, installed: InstalledTarget, target: Properties, unsure: bool) -> Iterator[InstalledFile]:
    """Yield the installed files of an executable or a library: the built file, and its versioned links."""
    name, span, kind = installed.target, installed.span, target["KIND"]
    destination = {"executable": installed.executables, "static": installed.archives}.get(kind, installed.libraries)
    file = output_name(target)
    if destination is None or file is None:
        facet = Facet.EXECUTABLES if kind == "executable" else Facet.LIBRARIES | Facet.PYTHON
        run.results.opaques.setdefault(Opaque(facet, f"the installed file of the target '{name}' is unknown", span))
        return
    path = join_path(destination, file)
    yield InstalledFile(path, "", kind == "executable", unsure, span, name)
    if path.startswith(_PYTHON) and not file.startswith("lib"):
        run.results.python_packages[path[len(_PYTHON) :].partition(".")[0].replace("/", ".")] = None
    if kind == "shared":
        for number in {target.get("VERSION", ""), target.get("SOVERSION", "")} - {""}:
            if is_known(number):
                yield InstalledFile(join_path(destination, f"{file}.{number}"), "", False, unsure, span, name)
