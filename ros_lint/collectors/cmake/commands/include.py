"""include() and add_subdirectory() of scripts in the package and in other packages of the workspace."""

from __future__ import annotations

import posixpath
import re
from typing import Final

from ros_lint.base.paths import is_outside, relative
from ros_lint.base.paths import join as join_path
from ros_lint.collectors.cmake.evaluator.flow import run_file
from ros_lint.collectors.cmake.evaluator.run import Handler, Run
from ros_lint.collectors.cmake.evaluator.sources import OUTSIDE
from ros_lint.collectors.cmake.evaluator.state import NEXT, CallFrame, Variables
from ros_lint.collectors.cmake.evaluator.values import ATOM, BINARY, HOLE, OTHER_PACKAGE, PREFIX, TREE, is_fixed
from ros_lint.collectors.cmake.syntax import Command, ParsedScript
from ros_lint.facts.visibility import ALL_FACETS, Facet


def _include(run: Run, args: list[str]) -> int | None:
    optional = "OPTIONAL" in args
    if "RESULT_VARIABLE" in args[:-1]:
        run.set(args[args.index("RESULT_VARIABLE") + 1], HOLE)
    name = args[0] if args else ""
    if not name or name in MODULES:
        if name in MODULES:
            _module(run, name)
        return None
    if not is_fixed(name):
        if _is_from_index(run):
            return _skip(run, "a file that another package has registered")
        run.hide(ALL_FACETS, "the file of include() is unknown")
        run.open_world = run.skipped_include = True
        return None
    return _include_file(run, name, optional)


def _include_file(run: Run, name: str, optional: bool) -> int | None:
    if name.startswith(OTHER_PACKAGE):
        return _include_installed(run, name)
    is_module = "/" not in name and "." not in name
    folders = run.get("CMAKE_MODULE_PATH") or ""
    candidates = [name]
    if not name.startswith("/"):
        candidates[:0] = [f"{folder}/{name}.cmake" for folder in folders.split(";") if is_fixed(folder)]
    for candidate in candidates:
        path = run.paths.source_or_outside(candidate)
        parsed = run.paths.script(path) if path is not None else None
        if path is not None and parsed is not None:
            return _run_script(run, path, parsed)
    run.skipped_include = True
    if optional:
        return None
    if is_module:
        # A module of CMake or of a found package defines commands, but does not build anything itself.
        run.open_world = True
        if not folders or HOLE not in folders:
            run.hide(Facet.USES, f"the module '{name}' of include() was not found")
        return None
    if name.startswith(f"/{ATOM}") and not name.startswith((TREE, BINARY, PREFIX)):
        return _skip(run, f"{posixpath.basename(name)} of another package")
    path = run.paths.source(name)
    if path is not None and not name.startswith(BINARY) and path not in run.paths.files:
        run.add_problem("missing-script", f"include({path}): the file does not exist", run.place_of(name), path)
        return None
    run.open_world = run.any_variable_may_be_set = run.may_define_targets = True
    readable_name = run.paths.relative(name) or name.replace(BINARY, "the build folder").replace("\1", "")
    run.hide(ALL_FACETS, f"include() of {readable_name} cannot be evaluated")
    return None


def include_own(run: Run, path: str) -> int | None:
    """Run the script of the package at ``path``, relative to the package, in the current scope.

    Return how the script may end (Exit; None: normally).
    """
    return _run_script(run, path, run.paths.sources.scripts[path])


def _run_script(run: Run, path: str, parsed: ParsedScript) -> int | None:
    """Run a script of the package, or a script of the workspace outside of the package.

    ``path`` is relative to the package. Return how the script may end (Exit; None: normally).
    """
    outside = is_outside(path)
    if outside:
        run.outside_scripts.append(parsed)
        if parsed.problems:
            run.hide(ALL_FACETS, f"a syntax error hides the rest of '{path}'")
    frame = CallFrame(not outside, run.paths.tree_path(path), run.paths.absolute(path), provider=OUTSIDE if outside else "")
    return run_file(run, parsed.commands, frame)


def _include_installed(run: Run, name: str) -> int | None:
    package, _, install_path = name[len(OTHER_PACKAGE) :].partition("/")
    helper = run.helpers.get(package)
    if helper is not None:
        source = next((file.source for file in helper.script.products.installs if file.path == install_path), None)
        if source is not None and source in helper.sources.scripts:
            return include_of_package(run, package, source)
    return _skip(run, f"{install_path} of {package}")


def _skip(run: Run, file: str) -> int:
    """Skip an include() of a file of another package: record that the file may use packages and define commands.

    The skipped file is assumed to install nothing, as most CMake modules do.
    """
    run.open_world = run.skipped_include = True
    run.hide(Facet.USES | Facet.EXPORTS, f"include() of {file} cannot be evaluated")
    return NEXT


def _is_from_index(run: Run) -> bool:
    """Return whether the path in the current include() begins with a variable that was read from the ament index."""
    command = run.frames[-1].command
    match = _BEGINS.match(command.args[0][0]) if command is not None and command.args else None
    return match is not None and match[1] in run.index_variables


_BEGINS: Final = re.compile(r"\$\{(\w+)\}/[\w./-]+\Z")


def include_of_package(run: Run, package: str, source: str) -> int | None:
    """Run the script ``source`` of another package of the workspace in the current scope.

    Return how the script may end (Exit; None: normally).
    """
    helper = run.helpers[package]
    install_path = f"share/{package}/cmake/{posixpath.basename(source).removesuffix('.in')}"
    install_path = next((file.path for file in helper.script.products.installs if file.source == source), install_path)
    frame = CallFrame(False, join_path(helper.sources.path, source), f"{OTHER_PACKAGE}{package}/{install_path}", provider=package)
    commands = helper.sources.scripts[source].commands
    if source.endswith(".in"):
        commands = tuple([_configured(command, helper.script.project.name or package) for command in commands])
    return run_file(run, commands, frame)


def _configured(command: Command, project: str) -> Command:
    """Return a command of a template file with ``@PROJECT_NAME@`` replaced by ``project``.

    Other variables of templates are not replaced, because CMake code in templates rarely uses them.
    """
    args = [(text.replace("@PROJECT_NAME@", project), kind, start, end) for text, kind, start, end in command.args]
    return command._replace(args=tuple(args))


MODULES: Final = frozenset({
    "CMakePackageConfigHelpers", "CTest", "CheckCXXCompilerFlag", "CheckCXXSourceCompiles", "CheckCXXSourceRuns",
    "CheckCCompilerFlag", "CheckCSourceCompiles", "CheckFunctionExists", "CheckIPOSupported", "CheckIncludeFile",
    "CheckIncludeFileCXX", "CheckIncludeFiles", "CheckLanguage", "CheckLibraryExists", "CheckSymbolExists",
    "CheckTypeSize", "CMakeDependentOption", "CMakeParseArguments", "CMakePrintHelpers", "CPack", "ExternalProject",
    "FeatureSummary", "FetchContent", "FindPackageHandleStandardArgs", "FindPkgConfig", "GNUInstallDirs",
    "GenerateExportHeader", "GoogleTest", "InstallRequiredSystemLibraries", "ProcessorCount", "TestBigEndian",
    "UseJava", "UseSWIG", "WriteBasicConfigVersionFile", "CheckLinkerFlag", "CheckCompilerFlag", "CheckCXXSymbolExists",
    "CheckStructHasMember", "CheckPIESupported", "CheckSourceCompiles", "DefaultPolicies", "FortranCInterface",
    "CMakePushCheckState", "CheckCXXLinkerFlag",
})  # fmt: skip
"""Names of the modules of CMake that only define commands."""


def _module(run: Run, name: str) -> None:
    if name == "CTest":
        run.settable.add("BUILD_TESTING")


def _add_subdirectory(run: Run, args: list[str]) -> int | None:
    name = args[0] if args else ""
    path = run.paths.source_or_outside(name) if is_fixed(name) else None
    script = join_path(path or "", _TOP)
    parsed = run.paths.script(script) if path is not None else None
    if path is None or (parsed is None and is_outside(path)):
        run.open_world = run.any_variable_may_be_set = run.may_define_targets = True
        run.hide(_BY_SUBDIRECTORY, "the folder of add_subdirectory() was not found")
        return None
    if not (run.uncertain_conditions or run.muted or is_outside(path)):
        run.results.subdirectories[path] = None
    if run.testing and not is_outside(path):
        run.results.test_subdirectories[path] = None
    last = posixpath.basename(run.paths.tree_path(path))
    if path and (parsed is None or run.paths.is_folder(f"{path}/include/{last}")):
        run.results.bundled_projects[last] = None  # a library in its own folder, or a submodule that is not checked out
    if parsed is None:
        if run.paths.is_folder(path):
            run.open_world = run.any_variable_may_be_set = run.may_define_targets = True
            run.hide(_BY_SUBDIRECTORY, f"the folder '{path}' of add_subdirectory() has no CMakeLists.txt", inside=path)
        else:
            run.add_problem(
                "missing-folder", f"add_subdirectory() fails because the folder '{path}' does not exist", run.place_of(name), path
            )
        return None
    run.paths.enter_directory(path, _built_in(run, path, args[1:]))
    run.scopes.append(Variables())
    policy_version = run.policy_version
    try:
        return _run_script(run, script, parsed)
    finally:
        run.policy_version = policy_version
        run.scopes.pop()
        run.paths.leave_directory()


_TOP: Final = "CMakeLists.txt"
_BY_SUBDIRECTORY: Final = ALL_FACETS & ~Facet.EXPORTS
"""The kinds of facts about a package that are incomplete if a subdirectory cannot be evaluated: all but EXPORTS.

EXPORTS are complete because ament_package() ignores ament_export_...() calls in a subdirectory."""


def _built_in(run: Run, path: str, args: list[str]) -> str:
    """Return the build folder of a subdirectory; HOLE, which means an unknown text, if the build folder is unknown.

    The build folder is the second argument of add_subdirectory(), by default the path of the subdirectory. A relative path
    is relative to the build folder of the current directory.
    """
    argument = next((arg for arg in args if arg not in ("EXCLUDE_FROM_ALL", "SYSTEM")), "")
    below = argument or relative(run.paths.tree_path(run.paths.directory), run.paths.tree_path(path))
    if not is_fixed(below) or (is_outside(below) and not argument):
        return HOLE
    return below if below.startswith("/") else posixpath.normpath(f"{run.path_variables['CMAKE_CURRENT_BINARY_DIR']}/{below}")


COMMANDS: Final[dict[str, Handler]] = {"include": _include, "add_subdirectory": _add_subdirectory}
