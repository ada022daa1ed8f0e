"""
## What it finds

Programs that are built and land where nobody looks for them:

- an executable that a launch file of the workspace starts and that is not installed at all;
- a node, if nothing at all of what the package builds is installed, or if others of its nodes are;
- an executable that is installed to `bin/` or `lib/` instead of `lib/<package>`, if it is a node (its sources or their own
  headers include rclcpp) or a launch file starts it, and any other in `lib/` or `bin/<package>/`, where not even a shell looks.
  Where only another header of the package includes rclcpp, and for other programs that go to `lib/` together with a library,
  the confidence is medium.

## Why it matters

`ros2 run` and launch look into `lib/<package>` only: "No executable found". In `install(TARGETS ... RUNTIME DESTINATION bin)`
the destination is right for other programs, and wrong for nodes.

## How to fix it

`install(TARGETS talker DESTINATION lib/${PROJECT_NAME})`. The fix adds this rule, or corrects the destination.

## Limitations

For tests, examples and what measures; for targets that are also installed to `lib/<package>`; with
`ament_auto_package(INSTALL_TO_PATH)`. Where something that cannot be followed may install the target, the confidence is
medium, or nothing is said. So it is where only a launch file starts it that is kept back itself, by a rule that installs its
like and leaves it out (`PATTERN x EXCLUDE`), or such a one and a copy in another package that is not installed either.
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
    called,
    cmake_edits,
    evaluated_name,
    forgotten_nodes,
    hidden,
    installed_targets,
    launchable,
    left_out_nodes,
    node_targets,
    programs_built,
    several,
    started,
    with_client,
)

_BIN = ("bin", "${CMAKE_INSTALL_BINDIR}", "lib", "${CMAKE_INSTALL_LIBDIR}")


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with != "ament_cmake":
        return
    unseen, own = hidden(package, Facet.EXECUTABLES), f"lib/{package.name}"
    if any("INSTALL_TO_PATH" in call.texts for call in called(package, "ament_auto_package", anywhere=True)):
        return
    places: dict[str, list[tuple[str, str, Span]]] = {}
    for provided in script.provides:
        if provided.target:
            folder, _, name = provided.path.rpartition("/")
            places.setdefault(provided.target, []).append((folder, name, provided.span))
    nodes = node_targets(package)
    forgotten = forgotten_nodes(package)
    left_out = left_out_nodes(package)
    by_launch_files = workspace.started.get(package.name, {})
    for target in programs_built(script):
        found = places.get(target.name, [])
        if not all(_is_for_others(folder) for folder, _, _ in found):
            continue
        launched = by_launch_files.get(found[0][1] if found else target.name, ())
        related = several(Related("a launch file starts it here", reference.span) for reference in launched)
        sure = bool(launched or target.name in nodes)
        nowhere = all(folder in ("lib", f"bin/{package.name}") for folder, _, _ in found)
        if found and nowhere:
            sure = sure or all(folder != "lib" or _is_of_programs(package, span, script.targets) for folder, _, span in found)
        if found and (sure or nowhere or any(file.startswith("include/") for file in with_client(package))):
            span = found[0][2]
            where = f"{found[0][0]}/, where {'nobody looks' if nowhere else 'ros2 run and launch do not look'}"
            yield Finding(
                f"{target.name} is installed to {where}; install it to {own}",
                span,
                target.name,
                (*related, Related("it is built here", target.span)),
                _move(package, span, script.targets),
                Confidence.MEDIUM if not sure or any(opaque.reaches(own) for opaque in unseen) else Confidence.HIGH,
            )
        elif not found and launched and not unseen:
            says = ", but not installed, so launch does not find it"
            confidence = Confidence.MEDIUM if _kept_back(package, target.name, launched, workspace) else Confidence.HIGH
            yield _left(package, script, target, says)._replace(related=related, confidence=confidence)
        elif target.name in forgotten:
            yield _left(package, script, target, ", but nothing that the package builds is installed")
        elif target.name in left_out:
            says = " and, unlike other nodes of the package, not installed"
            confidence = Confidence.MEDIUM if _kept_back(package, target.name, (), workspace) else Confidence.HIGH
            yield _left(package, script, target, says)._replace(severity=Severity.WARNING, confidence=confidence)


def _is_for_others(folder: str) -> bool:
    """Whether programs of a folder are found by their names alone, if at all: bin, and lib, where libraries are."""
    return folder.partition("/")[0] == "bin" or folder == "lib"


def _kept_back(package: Package, name: str, launched: Sequence[LaunchReference], workspace: Workspace) -> bool:
    """Whether the package leaves out a launch file that starts the program, and all others are installed no more than that."""
    if name not in started([package], kept_back=True).get(package.name, {}):
        return False
    paths = {reference.span.path for reference in launched}
    files = (launch for owner in workspace.packages for launch in launchable(owner) if launch.installed) if paths else ()
    return not any(launch.file.path in paths for launch in files)


def _left(package: Package, script: BuildScript, target: BuildTarget, says: str) -> Finding:
    fix = Fix.of(f"install {target.name}", cmake_edits.install_program(script, "TARGETS", target.name))
    return Finding(f"{target.name} is built{says}; install it to lib/{package.name}", target.span, target.name, fix=fix)


def _is_of_programs(package: Package, span: Span, targets: tuple[BuildTarget, ...]) -> bool:
    """Whether the rule at a place installs nothing but programs."""
    kinds = {target.name: target.kind for target in targets}
    for call in called(package, "install"):
        if call.whole.covers(span):
            return all(kinds.get(evaluated_name(package, call.texts[at]) or "") == "executable" for at in installed_targets(call))
    return False


def _move(package: Package, span: Span, targets: tuple[BuildTarget, ...]) -> Fix | None:
    """Correct the destination of the executables, where the rule says it by itself and installs no other program."""
    kinds = {target.name: target.kind for target in targets}
    for call in called(package, "install"):
        if call.texts[:1] != ("TARGETS",) or not call.whole.covers(span):
            continue
        texts = call.texts
        at = texts.index("RUNTIME") + 2 if "RUNTIME" in texts[:-2] else 0
        of_programs = all(kinds.get(texts[index]) == "executable" for index in installed_targets(call))
        if not at and of_programs and "DESTINATION" in texts[:-1]:
            at = texts.index("DESTINATION") + 1
        if at and texts[at - 1] == "DESTINATION" and texts[at] in _BIN:
            return Fix("install it to lib/${PROJECT_NAME}", (cmake_edits.write(call, at, "lib/${PROJECT_NAME}"),), safe=False)
    return None


RULE = Rule(
    name="uninstalled-executable",
    code="ROS403",
    summary="a node must be installed to lib/<package>",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
