"""Static evaluation of a CMakeLists.txt and the files that it includes: targets, installed files and dependencies."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Final

from ros_lint.base.budget import BudgetExceeded
from ros_lint.base.paths import is_outside, join
from ros_lint.base.text import Span, file_start
from ros_lint.collectors.cmake.commands import ament as cmake_ros
from ros_lint.collectors.cmake.commands import basic as cmake_basic
from ros_lint.collectors.cmake.commands import fetch_content as cmake_fetch
from ros_lint.collectors.cmake.commands import file as cmake_file
from ros_lint.collectors.cmake.commands import find_package as cmake_find
from ros_lint.collectors.cmake.commands import include as cmake_include
from ros_lint.collectors.cmake.commands import include_directories as cmake_headers
from ros_lint.collectors.cmake.commands import install as cmake_install
from ros_lint.collectors.cmake.commands import install_targets as cmake_install_targets
from ros_lint.collectors.cmake.commands import list as cmake_list
from ros_lint.collectors.cmake.commands import math as cmake_math
from ros_lint.collectors.cmake.commands import string as cmake_string
from ros_lint.collectors.cmake.commands import system_queries as cmake_answers
from ros_lint.collectors.cmake.commands import targets as cmake_targets
from ros_lint.collectors.cmake.commands.ament import run_external_command
from ros_lint.collectors.cmake.commands.compiled_macros import released
from ros_lint.collectors.cmake.evaluator import branches as cmake_branches
from ros_lint.collectors.cmake.evaluator import definitions as cmake_definitions
from ros_lint.collectors.cmake.evaluator import flow as cmake_flow
from ros_lint.collectors.cmake.evaluator import loops as cmake_loops
from ros_lint.collectors.cmake.evaluator.flow import HANDLERS
from ros_lint.collectors.cmake.evaluator.found_packages import folded
from ros_lint.collectors.cmake.evaluator.run import Run
from ros_lint.collectors.cmake.evaluator.sources import Helper, Sources
from ros_lint.collectors.cmake.evaluator.state import MOST_CHARACTERS, STOP, CallFrame
from ros_lint.collectors.cmake.evaluator.unset import unset_variables
from ros_lint.collectors.cmake.evaluator.values import is_known
from ros_lint.collectors.cmake.exported_packages import exported_packages
from ros_lint.collectors.cmake.released_macros import macros
from ros_lint.collectors.cmake.syntax import is_template
from ros_lint.facts.build import (
    BuildExports,
    BuildProducts,
    BuildScript,
    CMakeBuild,
    CMakeCommands,
    ExportedTarget,
    InstalledFile,
)
from ros_lint.facts.cmake import CommandPlace
from ros_lint.facts.sources import Mention
from ros_lint.facts.visibility import ALL_FACETS, Facet, Opaque, Problem

for _module in (
    cmake_answers,
    cmake_basic,
    cmake_fetch,
    cmake_file,
    cmake_find,
    cmake_headers,
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
    """Return the effects of a package's CMakeLists.txt, computed without running CMake.

    ``distro`` is the ROS distribution of ``$ENV{ROS_DISTRO}``, "" if it is unknown. ``helpers`` are the packages of the
    workspace with CONFIG_EXTRAS: find_package() runs this CMake code (``exports.config_extras`` of the build script). A caller
    that evaluates several packages must evaluate the helpers first, each after the helpers that it finds itself.

    - A condition that cannot be decided: both branches are run. Targets and files of the branches are ``conditional``, and the
      packages in their commands are ``optional``.
    - An option has its default value. Targets and files of a branch for another value of the option are ``conditional``.
    - Code that cannot be evaluated is recorded in ``opaque``, with the kinds of facts that may be incomplete (``Facet``).
    - Problems have the kinds "cmake-syntax", "missing-file", "missing-folder" (add_subdirectory), "missing-script" (include),
      "no-interfaces", "undefined-target", "file-is-directory" and "directory-is-file".

    No content of the files raises an exception.
    """
    run = Run(sources, distro, helpers, run_external_command)
    path = join(sources.path, _TOP)
    if sources.scripts.get(_TOP) is None:
        return BuildScript(path, opaque=(Opaque(ALL_FACETS, "CMakeLists.txt cannot be read", file_start(path)),))
    run_script(run, sources)
    return _result(run, path)


def run_script(run: Run, sources: Sources) -> None:
    """Run the CMakeLists.txt of a package, which must exist, and leave the results in ``run``. It raises no exception."""
    path = join(sources.path, _TOP)
    frame = CallFrame(True, path, run.paths.absolute(_TOP))
    try:
        exits = cmake_flow.run_file(run, sources.scripts[_TOP].commands, frame)
    except (BudgetExceeded, RecursionError):
        run.frames[:] = [frame]
        run.budget.characters = MOST_CHARACTERS  # _result() evaluates texts once more
        run.hide(ALL_FACETS, "the script is too large to be evaluated", frame.command and frame.command.place(path))
    else:
        run.frames[:] = [frame]
        if exits & STOP:
            run.hide(ALL_FACETS, "the script stops with an error before its end", frame.command and frame.command.place(path))


def _result(run: Run, path: str) -> BuildScript:
    installs = [*_installed_files(run), *cmake_install_targets.installed_targets(run)]
    undefined = _undefined_targets(run)
    used = _used_packages(run) if run.packages.optional_finds else {}
    problems = [*run.results.problems, *_missing_files(run), *undefined]
    undefined_places = {
        problem.span for problem in undefined
    }  # an undefined target is an error of the script, so it hides nothing
    opaques = [opaque for opaque in run.results.opaques if opaque.span not in undefined_places or not opaque.undefined]
    for file, parsed in run.paths.sources.scripts.items():
        if parsed.problems and not (is_template(file) or file in run.results.config_templates):
            problems += parsed.problems
            facets = ALL_FACETS if file == _TOP else ALL_FACETS & ~Facet.INTERFACES
            opaques += [Opaque(facets, "a syntax error hides the rest of the file", problem.span) for problem in parsed.problems]
    calls = tuple(sorted([call for call in run.command_names if not call.startswith("ros_lint_")]))
    return BuildScript(
        path,
        run.results.project,
        _mentions(run, used),
        BuildProducts(
            targets=cmake_targets.targets(run),
            installs=tuple(installs),
            components=tuple(run.results.components),
            python_packages=tuple(sorted(run.results.python_packages)),
            interfaces=tuple(sorted(run.results.interfaces)),
        ),
        exports=BuildExports(tuple(run.results.config_extras), tuple(exported_packages(run)), tuple(_exported_targets(run))),
        commands=CMakeCommands(calls, insertion=run.results.insertion, insertion_after=run.results.insertion_after),
        cmake=CMakeBuild(
            subdirectories=tuple(run.results.subdirectories),
            test_subdirectories=tuple([folder for folder in run.results.test_subdirectories if folder]),
            bundled_projects=tuple(run.results.bundled_projects),
            unused_optional_finds=tuple(_unused_finds(run, used)),
            commented_interfaces=tuple([name for parsed in run.paths.sources.scripts.values() for name in parsed.set_aside]),
            errors=tuple(_errors(run)),
            lost_exports=tuple(_lost_exports(run)),
            unset_variables=tuple(unset_variables(run)),
            interpreted_tests=_interpreted_tests(run),
            runs_tests=any(map(_RUNS_TESTS.search, calls)),
            includes_outside_package=run.results.includes_outside_package,
            compiles_outside_package=run.results.compiles_outside_package,
            makes_nothing=bool(calls) and _MAKES_NOTHING.issuperset(calls),
        ),
        opaque=tuple(opaques),
        problems=tuple(problems),
        distros=run.same_distros,
    )


def _exported_targets(run: Run) -> Iterator[ExportedTarget]:
    for installed in run.results.installed_targets:
        if installed.exported_in and is_known(installed.exported_in):
            yield ExportedTarget(
                installed.target,
                installed.exported_in,
                not installed.conditional and installed.exported_in in run.results.exported_sets,
            )


_MAKES_NOTHING: Final = frozenset(
    {
        "add_compile_options", "ament_auto_find_build_dependencies", "ament_auto_package", "ament_package",
        "ament_lint_auto_find_test_dependencies", "cmake_minimum_required", "find_package", "list", "message", "option",
        "project", "set",
    }
)  # fmt: skip


def _lost_exports(run: Run) -> Iterator[CommandPlace]:
    """Yield the calls of ament_export_...() without effect, because ament_package() cannot read the variables that they set.

    The calls are in another scope of variables than ament_package(), such as a subdirectory. Nothing is yielded if the
    package itself passes the variables of ament on to the scope of ament_package().
    """
    if not run.package_scopes or all(any(scope is seen for seen in run.package_scopes) for scope, _ in run.export_scopes):
        return
    scripts = run.paths.sources.scripts.values()
    if any(_OF_AMENT.match(argument[0]) for parsed in scripts for command in parsed.commands for argument in command.args):
        return
    for scope, call in run.export_scopes:
        if not any(scope is seen for seen in run.package_scopes):
            yield call


_OF_AMENT: Final = re.compile(r"_?AMENT_(?:CMAKE_)?E")
"""Pattern of the start of variables in which ament stores exports: ``_AMENT_EXPORT_...``, ``_AMENT_CMAKE_EXPORT_...`` and

``AMENT_EXTENSIONS_...``."""


def _interpreted_tests(run: Run) -> tuple[str, ...] | None:
    """Return the files and folders with tests that an interpreter runs, such as pytest.

    The result is None if they are unknown: no known command runs tests, or an unknown command seems to run tests.
    """
    unknown = (call for call in run.command_names if _RUNS_TESTS.search(call) and not _is_known(run, call))
    if run.command_names.isdisjoint(cmake_ros.RUNNERS) or any(unknown):
        return None
    return tuple(run.results.interpreted_tests)


_RUNS_TESTS: Final = re.compile(r"pytest|launch_test|ros_test|add_test\Z|nose|isolated_test\Z")


def _is_known(run: Run, call: str) -> bool:
    return call in HANDLERS or call in run.procedures or released(call) is not None


def _installed_files(run: Run) -> list[InstalledFile]:
    files, generated = run.paths.files, run.paths.generated
    installed_files = []
    for provided in run.results.installed:
        if not provided.source or is_outside(provided.source) or provided.source in files:
            installed_files.append(provided)
        elif provided.source in generated:
            installed_files.append(provided._replace(source=""))
    return installed_files


def _mentions(run: Run, used: Mapping[str, bool]) -> tuple[Mention, ...]:
    """Return the recorded mentions of other packages, with a classification of each find_package(X) without REQUIRED.

    The mention of X becomes optional if a condition tests X_FOUND, unless the script stops when X is not found. It becomes a
    test dependency if only tests use the targets, variables or macros of X. ``used`` is the result of :func:`_used_packages`.
    """
    if not run.packages.optional_finds:
        return tuple(run.results.mentions)
    checked = run.packages.required_by_check
    required = {name for name in run.packages.optional_finds if name in checked or name.upper() in checked}
    quiet = {span for name in required for span in run.packages.optional_finds[name]} & run.packages.quiet_finds
    guarded = {
        span
        for name in run.packages.optional_finds
        if name not in required and f"{name}_FOUND" in run.tested_variables
        for span in run.packages.optional_finds[name]
    }
    tests = {span for name in run.packages.optional_finds if used.get(folded(name)) for span in run.packages.optional_finds[name]}
    return tuple(
        [
            mention._replace(
                optional=(mention.optional and mention.span not in quiet) or mention.span in guarded,
                test=mention.test or mention.span in tests,
            )
            if mention.via == "cmake"
            else mention
            for mention in run.results.mentions
        ]
    )


def _used_packages(run: Run) -> dict[str, bool]:
    """Return the packages whose targets, variables or macros the scripts use, each with True if only tests use it.

    The package names are in lower case, without ``_`` and ``-`` (see :func:`folded`).
    """
    used: dict[str, bool] = {}
    for mention in run.results.mentions:
        if mention.via in ("target", "macro"):
            name = folded(mention.name.partition("::")[0])
            used[name] = mention.test and used.get(name, True)
    return used


def _unused_finds(run: Run, used: Mapping[str, bool]) -> Iterator[Span]:
    """Yield the places of find_package() calls without REQUIRED for packages whose names occur nowhere else."""
    if not run.packages.optional_finds:
        return
    macro_packages = {macro.package for macro in macros().values()}
    for name in _unmentioned(run, [name for name in run.packages.optional_finds if folded(name) not in used]):
        if not name.startswith("ament_") and (name in macro_packages or not _USED_WITHOUT_NAME.search(name)):
            yield from run.packages.optional_finds[name]


_USED_WITHOUT_NAME: Final = re.compile(r"cmake|rosidl|^PkgConfig$|backward")
"""Pattern of the packages that a script uses without a further mention of their names.

These packages provide commands, find modules or settings."""


def _unmentioned(run: Run, names: Iterable[str]) -> list[str]:
    """Return the elements of ``names`` that occur in no command of the package except find_package()."""
    candidates = list(names)
    if not candidates:
        return candidates
    commands = (command for parsed in (*run.paths.sources.scripts.values(), *run.outside_scripts) for command in parsed.commands)
    words = [argument[0] for command in commands if command.name != "find_package" for argument in command.args]
    text = "\n".join(words).replace("_", "").replace("-", "").lower()
    return [name for name in candidates if folded(name) not in text]


def _missing_files(run: Run) -> list[Problem]:
    problems = []
    for path, span, unsure in run.results.missing_files:
        source = path.rstrip("/")
        # CMake accepts a folder in a list of sources and ignores it.
        if not unsure and run.paths.generated.isdisjoint((source, path)) and not run.paths.is_folder(source):
            empty = f"'{path}' is missing or empty; git does not keep empty folders, so install() fails; add a file to the folder"
            message = f"'{source}' does not exist" if source == path else empty
            problems.append(Problem("missing-file", message, span, subject=path))
    return list(dict.fromkeys(problems))


def _undefined_targets(run: Run) -> list[Problem]:
    return [
        Problem("undefined-target", f"install() fails because '{name}' is not a target", span, subject=name)
        for name, span, certain in run.results.undefined_targets
        if certain and "__rosidl" not in name
    ]


def _errors(run: Run) -> Iterator[Problem]:
    yield from run.results.errors
    if not run.any_variable_may_be_set and not any(
        opaque.hides & Facet.LIBRARIES and not opaque.undefined for opaque in run.results.opaques
    ):
        for (name, command), span in run.results.modified_targets.items():
            if name not in run.targets and "__rosidl" not in name:
                yield Problem("undefined-target", f"{command}() fails because '{name}' is not a target", span, subject=name)
