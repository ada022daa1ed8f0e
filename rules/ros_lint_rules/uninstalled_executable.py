"""
## What it finds

Executables that are built but not installed, or installed where `ros2 run` and launch do not find them:

- an executable that a launch file of the workspace starts and that is not installed at all;
- a node that is not installed, if nothing that the package builds is installed, or if other nodes of the package are installed;
- a node, or an executable that a launch file starts, that is installed to `bin/` or `lib/` instead of `lib/<package>`. A node
  is an executable whose sources, or the headers that belong to it, include rclcpp;
- any other executable that is installed to `lib/` or `bin/<package>/`, where the shell does not find it either.

One rule reports both, because `ros2 run` finds the executable in neither case, and the remedy is the same `install()`.

## Why it matters

`ros2 run` and launch only look in `lib/<package>`: "No executable found". In `install(TARGETS ... RUNTIME DESTINATION bin)` the
destination is right for other programs, but wrong for nodes.

## How to fix it

`install(TARGETS talker DESTINATION lib/${PROJECT_NAME})`. The fix adds this rule, or corrects the destination.

## Limitations

Not reported:

- Tests, examples and benchmarks.
- Targets that are also installed to `lib/<package>`.
- Packages that call `ament_auto_package(INSTALL_TO_PATH)`.
- Targets that are not installed, if a part of the build script that cannot be evaluated may install them.

Reported with medium confidence:

- Targets installed elsewhere, if a part of the build script that cannot be evaluated may also install to `lib/<package>`.
- Executables in `bin/` that include rclcpp only through other headers of the package.
- Executables that are not nodes and are installed to `lib/` together with a library.
- Executables that only launch files start that are not installed, if a rule excludes one of them on purpose (`PATTERN x
  EXCLUDE`).

Executables with the same problem are one finding. The finding is an error if launch files start the executables. Otherwise it
is a warning, because the executables may be run from the build folder.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ros_lint.api import (
    BuildScript,
    BuildTarget,
    Confidence,
    Facet,
    Finding,
    Fix,
    LaunchReference,
    Package,
    Related,
    Rule,
    Severity,
    Span,
    Workspace,
    build,
    edits,
    first_related,
    launch,
    names,
)

_BIN = ("bin", "${CMAKE_INSTALL_BINDIR}", "lib", "${CMAKE_INSTALL_LIBDIR}")


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with != "ament_cmake":
        return
    alike: dict[tuple[str, Confidence, Severity | None, bool], list[Finding]] = {}
    for problem, finding in _problems(package, script, workspace):
        alike.setdefault((problem, finding.confidence, finding.severity, finding.fix is None), []).append(finding)
    for (problem, *_), findings in alike.items():
        yield _merged(problem, findings, script, package)


def _problems(package: Package, script: BuildScript, workspace: Workspace) -> Iterator[tuple[str, Finding]]:
    """Yield a pair for each executable that is not installed to lib/<package>: the problem as text, and the finding.

    The finding has no message yet, because executables with the same problem share one finding.
    """
    unseen, own = build.opaque_except_undefined_targets(package, Facet.EXECUTABLES), f"lib/{package.name}"
    if any("INSTALL_TO_PATH" in call.texts for call in package.calls("ament_auto_package", anywhere=True)):
        return
    places: dict[str, list[tuple[str, str, Span]]] = {}
    for provided in script.products.installs:
        if provided.target:
            folder, _, name = provided.path.rpartition("/")
            places.setdefault(provided.target, []).append((folder, name, provided.span))
    nodes = build.node_targets(package)
    forgotten = build.never_installed_nodes(package)
    left_out = build.partly_installed_nodes(package)
    by_launch_files = launch.nodes_started(workspace, package.name)
    for target in build.programs_built(script):
        installed = places.get(target.name, [])
        if not all(_is_outside_packages(folder) for folder, _, _ in installed):
            continue
        launched = by_launch_files.get(installed[0][1] if installed else target.name, ())
        related = first_related(
            Related(f"'{target.name}' is started by a launch file here", reference.span) for reference in launched
        )
        sure = bool(launched or target.name in nodes)
        nowhere = all(folder in ("lib", f"bin/{package.name}") for folder, _, _ in installed)
        if installed and nowhere:
            sure = sure or all(
                folder != "lib" or _installs_executables_only(package, span, script.products.targets)
                for folder, _, span in installed
            )
        if installed and (
            sure or nowhere or any(file.startswith("include/") for file in build.files_using_client_library(package))
        ):
            folder, _, span = installed[0]
            uncertain = not sure or any(opaque.reaches(own) for opaque in unseen)
            finding = Finding(
                "",
                span,
                target.name,
                (*related, Related(f"'{target.name}' is built here", target.span)),
                _destination_fix(package, span, script.products.targets),
                Confidence.MEDIUM if uncertain else Confidence.HIGH,
                None if launched else Severity.WARNING,
            )
            finders = "ros2 run, launch and the shell" if nowhere else "ros2 run and launch"
            yield f"installed to {folder}/, where {finders} do not find {{them}}", finding
            continue
        finding = Finding("", target.span, target.name, related, severity=Severity.WARNING)
        if not installed and launched and not unseen:
            confidence = Confidence.MEDIUM if _only_excluded_start(package, target.name, launched, workspace) else Confidence.HIGH
            problem = "built, but not installed, so launch does not find {them}"
            yield problem, finding._replace(confidence=confidence, severity=None)
        elif target.name in forgotten:
            yield "built, but nothing that the package builds is installed", finding
        elif target.name in left_out:
            confidence = Confidence.MEDIUM if _only_excluded_start(package, target.name, (), workspace) else Confidence.HIGH
            yield "built, but not installed, unlike other nodes of the package", finding._replace(confidence=confidence)


def _merged(problem: str, findings: Sequence[Finding], script: BuildScript, package: Package) -> Finding:
    """Return one finding for all executables with the same problem. ``findings``: a finding without message for each."""
    first, *others = findings
    subjects = [finding.subject for finding in findings]
    are, them = ("are", "them") if others else ("is", "it")
    fixes = [finding.fix for finding in findings if finding.fix]
    place = "installed here" if "do not find" in problem else "built here"
    if place == "built here":
        fix = Fix.of(f"install {names.shorten_list(subjects)}", edits.cmake.install_program(script, "TARGETS", *subjects))
    else:
        changes = dict.fromkeys(edit for fix in fixes for edit in fix.edits)
        fix = fixes[0]._replace(edits=tuple(changes)) if fixes else None
    return first._replace(
        message=f"{names.shorten_list(subjects)} {are} {problem.format(them=them)}; install {them} to lib/{package.name}",
        related=(*first.related, *first_related(Related(f"'{other.subject}' is {place}", other.span) for other in others)),
        fix=fix,
    )


def _is_outside_packages(folder: str) -> bool:
    """Return whether an install folder is ``lib``, ``bin`` or a folder in ``bin``, and so not ``lib/<package>``."""
    return folder.partition("/")[0] == "bin" or folder == "lib"


def _only_excluded_start(package: Package, name: str, launched: Sequence[LaunchReference], workspace: Workspace) -> bool:
    """Return whether an excluded launch file of the package starts the program ``name``, and no installed launch file does.

    A launch file is excluded if the build script deliberately does not install it.
    """
    if name not in launch.node_references([package], excluded=True).get(package.name, {}):
        return False
    paths = {reference.span.path for reference in launched}
    files = (
        (
            launch_file
            for owner in workspace.packages
            for launch_file in launch.package_launch_files(owner)
            if launch_file.installed
        )
        if paths
        else ()
    )
    return not any(launch_file.file.path in paths for launch_file in files)


def _installs_executables_only(package: Package, span: Span, targets: tuple[BuildTarget, ...]) -> bool:
    """Return whether the call of install() at the place ``span`` installs nothing but executables."""
    kinds = {target.name: target.kind for target in targets}
    for call in package.calls("install"):
        if call.extent.covers(span):
            return all(
                kinds.get(build.evaluated_name(package, call.texts[at]) or "") == "executable"
                for at in build.installed_targets(call)
            )
    return False


def _destination_fix(package: Package, span: Span, targets: tuple[BuildTarget, ...]) -> Fix | None:
    """Return the fix that changes the destination bin or lib to lib/<package>; None if libraries share the destination."""
    kinds = {target.name: target.kind for target in targets}
    for call in package.calls("install"):
        if call.texts[:1] != ("TARGETS",) or not call.extent.covers(span):
            continue
        texts = call.texts
        at = texts.index("RUNTIME") + 2 if "RUNTIME" in texts[:-2] else 0
        executables_only = all(kinds.get(texts[index]) == "executable" for index in build.installed_targets(call))
        if not at and executables_only and "DESTINATION" in texts[:-1]:
            at = texts.index("DESTINATION") + 1
        if at and texts[at - 1] == "DESTINATION" and texts[at] in _BIN:
            return Fix(
                "install the executables to lib/${PROJECT_NAME}",
                (edits.cmake.write(call, at, "lib/${PROJECT_NAME}"),),
                safe=False,
            )
    return None


RULE = Rule(
    name="uninstalled-executable",
    code="ROS403",
    summary="nodes are installed where ros2 run and launch find them",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
