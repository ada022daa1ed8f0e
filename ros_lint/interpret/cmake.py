"""What a package's CMake scripts build, provide and need: a static evaluation of CMakeLists.txt and all that it includes."""

from __future__ import annotations

from collections.abc import Mapping

from ros_lint.facts import ANYTHING, BuildScript, Facet, Mention, Opaque, Problem, Provided
from ros_lint.interpret import (
    cmake_basic,
    cmake_branches,
    cmake_definitions,
    cmake_file,
    cmake_find,
    cmake_flow,
    cmake_include,
    cmake_install,
    cmake_list,
    cmake_loops,
    cmake_math,
    cmake_ros,
    cmake_string,
    cmake_targets,
)
from ros_lint.interpret.cmake_run import BudgetError, Run
from ros_lint.interpret.cmake_sources import Helper, Sources
from ros_lint.interpret.cmake_state import STOP, Frame
from ros_lint.interpret.cmake_values import SOURCE
from ros_lint.text import Span
from ros_lint.tree import join

__all__ = ["Helper", "Sources", "evaluate"]

for _module in (
    cmake_basic,
    cmake_file,
    cmake_find,
    cmake_include,
    cmake_install,
    cmake_list,
    cmake_math,
    cmake_ros,
    cmake_string,
    cmake_targets,
):
    cmake_flow.HANDLERS.update(_module.COMMANDS)
cmake_flow.BLOCKS.update({**cmake_branches.BLOCKS, **cmake_definitions.BLOCKS, **cmake_loops.BLOCKS})

_TOP = "CMakeLists.txt"
_NO_HELPERS: Mapping[str, Helper] = {}


def evaluate(sources: Sources, distro: str = "", helpers: Mapping[str, Helper] = _NO_HELPERS) -> BuildScript:
    """Return what the build of a package does, worked out from its CMakeLists.txt without running CMake.

    ``distro`` is the ROS distribution that ``$ENV{ROS_DISTRO}`` names, "" when it is not known. ``helpers`` are the packages
    of the workspace whose CMake code runs in packages that find them: those whose own result has ``extras``. Evaluate these
    first (in an order in which each comes after those it finds), then the others.

    Conditions that cannot be decided are followed both ways; what such a branch provides is ``conditional`` and what it
    mentions ``optional``. Options have their default, and what the other branch would do is reported as conditional. What
    cannot be seen through is in ``opaque`` with the facet that it hides. Problems have the kinds "cmake-syntax",
    "missing-file", "undefined-target", "file-is-directory" and "directory-is-file". Never raises for what the files hold.
    """
    run = Run(sources, distro, helpers, cmake_ros.foreign)
    path = join(sources.path, _TOP)
    parsed = sources.scripts.get(_TOP)
    if parsed is None:
        return BuildScript(path, opaque=(Opaque(ANYTHING, "there is no CMakeLists.txt to read", Span(path, 1, 1, 1, 1)),))
    run.enter_directory("")
    frame = Frame(True, path, f"{SOURCE}/{_TOP}")
    try:
        ended = cmake_flow.run_file(run, parsed.commands, frame)
    except BudgetError:
        run.frames[:] = [frame]
        run.hide(ANYTHING, "the script runs longer than can be followed", frame.command and frame.command.place(path))
    else:
        run.frames[:] = [frame]
        if ended & STOP:
            run.hide(ANYTHING, "the script stops with an error before its end", frame.command and frame.command.place(path))
    return _result(run, path)


def _result(run: Run, path: str) -> BuildScript:
    provides = [*_installed_files(run), *cmake_install.installed_targets(run)]
    undefined = _undefined(run)
    problems = [*run.problems, *_missing(run), *undefined]
    nowhere = {problem.span for problem in undefined}  # these are mistakes, and hide nothing
    opaques = [opaque for opaque in run.opaques if opaque.span not in nowhere or not cmake_install.is_undefined(opaque)]
    for file, parsed in run.sources.scripts.items():
        if parsed.problems and not file.endswith(".in"):
            problems += parsed.problems
            facets = ANYTHING if file == _TOP else ANYTHING & ~Facet.INTERFACES
            opaques += [Opaque(facets, "the file cannot be read to its end", problem.span) for problem in parsed.problems]
    return BuildScript(
        path,
        run.name,
        run.name_span,
        run.version,
        run.version_span,
        _mentions(run),
        cmake_targets.targets(run),
        tuple(provides),
        tuple(run.components),
        (),
        tuple(sorted(run.python_packages)),
        tuple(sorted(run.interfaces)),
        tuple(sorted([call for call in run.calls if not call.startswith("ros_lint_")])),
        tuple(opaques),
        tuple(problems),
        run.end,
        tuple(run.extras),
    )


def _installed_files(run: Run) -> list[Provided]:
    files, generated = run.files, run.generated
    found = []
    for provided in run.installed:
        if not provided.source or provided.source in files:
            found.append(provided)
        elif provided.source in generated:
            found.append(provided._replace(source=""))
    return found


def _mentions(run: Run) -> tuple[Mention, ...]:
    """Return the mentions; a package that is not required and asked for with X_FOUND is optional (section C2.2)."""
    guarded = {span for name in run.loose if f"{name}_FOUND" in run.tested for span in run.loose[name]}
    if not guarded:
        return tuple(run.mentions)
    return tuple(
        mention._replace(optional=True) if mention.via == "cmake" and mention.span in guarded else mention
        for mention in run.mentions
    )


def _missing(run: Run) -> list[Problem]:
    found = []
    for source, span, unsure in run.missing:
        if not unsure and source not in run.generated and not run.is_unseen(source):
            found.append(Problem("missing-file", f"{source} does not exist", span))
    return list(dict.fromkeys(found))


def _undefined(run: Run) -> list[Problem]:
    if run.wild or any(opaque.hides & Facet.LIBRARIES and not cmake_install.is_undefined(opaque) for opaque in run.opaques):
        return []
    return [
        Problem("undefined-target", f"install() of {name}, which is no target", span)
        for name, span, conditional in run.undefined
        if not conditional and "__rosidl" not in name
    ]
