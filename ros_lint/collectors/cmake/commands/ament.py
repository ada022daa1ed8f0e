"""Commands of ROS packages: macros of released packages, and the commands ``ros_lint_*`` of their reduced definitions.

``ros_macros.cmake`` has the reduced definitions. The commands ``ros_lint_*`` exist only there and record the effects of a
macro.
"""

from __future__ import annotations

import posixpath
import re
from itertools import accumulate, pairwise
from typing import Final

from ros_lint.base.paths import is_outside
from ros_lint.base.paths import join as join_path
from ros_lint.collectors.cmake.commands.compiled_macros import released, run_released
from ros_lint.collectors.cmake.commands.install_directory import unlisted
from ros_lint.collectors.cmake.commands.targets import SOURCES
from ros_lint.collectors.cmake.evaluator.arguments import sections
from ros_lint.collectors.cmake.evaluator.flow import HANDLERS
from ros_lint.collectors.cmake.evaluator.run import Handler, Run
from ros_lint.collectors.cmake.evaluator.state import Properties
from ros_lint.collectors.cmake.evaluator.values import FILE, HOLE, MAYBE, elements, is_known, strip_mark
from ros_lint.facts.build import Component, InstalledFile
from ros_lint.facts.cmake import CommandPlace
from ros_lint.facts.sources import Purpose
from ros_lint.facts.visibility import ALL_FACETS, Facet

_PRODUCER = re.compile(r"install|program|executable|node|script|package|component|launch|resource|share|deploy|xacro|module")
"""Pattern of the names of unknown commands that probably install something."""
_BUILDER = re.compile(r"librar|executable|target|plugin|component|node|kernel|module|build|(?:\A|_)add(?:_|\Z)")
"""Pattern of the names of unknown commands that probably build something."""
_TESTER = re.compile(
    r"(?:\A|_)(?:\w*test\w*|lint\w*|gmock|pytest|coverage|benchmark\w*|check\w*|cpplint|cppcheck|flake8)(?:_|\Z)"
)
"""Pattern of the names of unknown commands that define tests and install nothing."""
_OF_LIBRARY = re.compile(
    r"(?:boost|catch2?|clang|cuda|doctest|doxygen|ecm|flex|bison|gettext|grpc|hip|itk|kde|ki18n|nanobind|protobuf|pybind11"
    r"|python[23]?|qt[4-6]?|sdl|sphinx|swig|vtk|xsdcxx)_"
)
"""Pattern of the names of unknown commands that belong to libraries and tools outside of ROS.

These commands do not call macros such as ament_export_targets().
"""
_GENERATES: Final = "rosidl_generate_interfaces"


def run_external_command(run: Run, name: str, args: list[str]) -> int | None:
    """Run a command that neither CMake nor the package defines. Return the ways in which it may end, None for a normal end.

    For a macro of a released package, the definition in ``ros_macros.cmake`` runs. The effects of any other command are
    recorded as unknown.
    """
    macro = released(name)
    if macro is not None:
        provider = macro.procedure.provider
        if provider and run.runs_own_code():
            purpose: Purpose = "interfaces" if name == _GENERATES else ""
            run.add_mention(provider, "macro", run.current_place(), f"{name}()", purpose=purpose)
        if name.startswith("ament_export_") and run.frames[-1].own and not (run.muted or run.uncertain_conditions or run.testing):
            run.export_scopes.append((run.scopes[-1], CommandPlace(name, run.current_place())))
        return run_released(run, macro, args)
    if name.startswith("_") and name[1:] in HANDLERS and name[1:] in run.procedures:
        return HANDLERS[name[1:]](run, args)  # the original of an overridden command
    run.open_world = True
    hidden = Facet.USES
    if not (_TESTER.search(name) or _OF_LIBRARY.match(name)):
        hidden |= Facet.EXPORTS
    if not _TESTER.search(name):
        run.any_variable_may_be_set = True
        run.may_define_targets = run.may_define_targets or _BUILDER.search(name) is not None
        if _PRODUCER.search(name):
            hidden |= ALL_FACETS & ~Facet.EXPORTS
        elif _is_given_data(run, args):
            hidden |= Facet.SHARE
    run.hide(hidden, f"the effects of {name}() are unknown")
    return None


def _is_given_data(run: Run, args: list[str]) -> bool:
    """Return whether an argument of an unknown command is the path or name of a folder that contains no C++ sources.

    The command probably installs the folder: ``install_models(meshes)``.
    """
    words = frozenset([plain for arg in args if is_known(plain := strip_mark(arg)[0])])
    below = [file for file in run.paths.files if not words.isdisjoint(_folders(file))]
    return bool(below) and not any(file.endswith(SOURCES) for file in below)


def _folders(file: str) -> list[str]:
    """Return the names and the paths of the folders that contain a file: ``a/b/c.stl`` -> ``a``, ``b``, ``a``, ``a/b``."""
    names = file.split("/")[:-1]
    return [*names, *accumulate(names, join_path)]


def _component(run: Run, args: list[str]) -> None:
    """Run ``ros_lint_component(class...)``: record component classes (rclcpp_components) of the package."""
    for arg in args:
        name, certain = strip_mark(arg)
        if not is_known(name):
            run.hide(Facet.COMPONENTS, "the class of a component is unknown")
        elif not run.muted:
            run.results.components.append(Component(name, run.conditional or run.testing or not certain, run.place_of(arg)))
            run.component_scopes.append(run.scopes[-1])


def _exported(run: Run, args: list[str]) -> None:
    """Run ``ros_lint_exported(sets...)``: record export sets with targets that all dependents of the package can use."""
    if not (run.muted or run.conditional or run.testing):
        run.results.exported_sets.update(dict.fromkeys([name for name, certain in map(strip_mark, args) if certain]))


def _interfaces(run: Run, args: list[str]) -> None:
    """Run ``ros_lint_interfaces(install|- files...)``: record interface files from which code is generated.

    With ``install`` the interface files are installed, too.
    """
    project = run.get("PROJECT_NAME") or ""
    package = project if is_known(project) else run.paths.sources.name or run.results.project.name
    for arg in args[1:]:
        plain, certain = strip_mark(arg)
        path = plain.rpartition(":")[2] if ":" in plain else plain
        folder, name = posixpath.split(path)
        stem, dot, suffix = name.rpartition(".")
        kind = posixpath.basename(folder) or suffix
        if not is_known(f"{kind}{stem}") or not dot:
            run.hide(Facet.INTERFACES, "the name of an interface file is unknown")
            continue
        if run.muted:
            continue
        run.results.interfaces[f"{suffix if suffix != 'idl' else kind}/{stem}"] = None
        span = run.place_of(arg)
        source = run.paths.source(plain.replace(":", "/") if ":" in plain else plain)
        conditional = run.conditional or run.testing or not certain
        if source is not None and source not in run.paths.files:
            run.results.missing_files.append((source, span, conditional))
        if args[0] == "install":
            source_path = source if source is not None and source not in run.paths.generated else ""
            # rosidl_adapter writes a generated .idl file to the folder of its kind (msg, srv, action)
            places = [(folder, "idl", source_path)] if suffix == "idl" else [(kind, suffix, source_path), (suffix, "idl", "")]
            for place, end, installed_source in places:
                run.results.installed.append(
                    InstalledFile(f"share/{package}/{place}/{stem}.{end}", installed_source, False, conditional, span)
                )
    if not run.muted and len(args) > 1:
        run.results.python_packages[package] = None
    elif not run.any_variable_may_be_set:
        run.add_problem(
            "no-interfaces",
            f"{_GENERATES}() is called without interface files; add a file, or remove the call",
            run.current_place(),
            package,
        )


def _python(run: Run, args: list[str]) -> None:
    """Run ``ros_lint_python(module folder)``: record that the Python files in a folder are installed as a module."""
    if args and not is_known(args[0]):
        run.hide(Facet.PYTHON, "the name of a Python package is unknown")
        return
    if run.muted or not args:
        return
    name = args[0].replace("/", ".")
    run.results.python_packages[name] = None
    folder = run.paths.source_or_outside(args[1]) if len(args) > 1 else None
    if folder is None or (is_outside(folder) and not run.paths.files_below(folder)):
        if len(args) > 1 and (HOLE in args[1] or run.paths.is_outside_source(args[1])):
            run.hide(Facet.PYTHON, "the folder of a Python package is unknown")
        return
    span = run.place_of(args[0])
    base = run.get("PYTHON_INSTALL_DIR") or ""
    skip = len(folder) + 1 if folder else 0
    conditional = run.conditional or run.testing
    unlisted_files = unlisted(run, folder, Facet.PYTHON, span) if run.paths.sources.unlisted_folders else []
    files = (*run.paths.files_below(folder), *unlisted_files)
    run.budget.charge(FILE * len(files))
    for file in files:
        if file.endswith(".py"):
            subfolder = posixpath.dirname(file[skip:])
            if subfolder:
                run.results.python_packages[f"{name}.{subfolder.replace('/', '.')}"] = None
        path = join_path(join_path(base, args[0]), file[skip:])
        if is_known(path) and not file.endswith((".pyc", ".pyo")):
            run.results.installed.append(InstalledFile(path, run.paths.normalized(file), False, conditional, span))


def _scripts(run: Run, args: list[str]) -> None:
    """Record the console_scripts of a setup.cfg as programs that are installed into a folder.

    The arguments are the folder and the setup.cfg. ros-lint calls this command in its own definition of
    ``ament_python_install_package()``.
    """
    path = run.paths.source(args[1])
    text = run.paths.sources.texts.get(path) if path is not None else None
    destination = run.paths.destination(args[0])
    if text is None or destination is None:
        run.hide(Facet.EXECUTABLES, "the console_scripts of a setup.cfg cannot be read")
        return
    for name in console_scripts(text):
        run.results.installed.append(
            InstalledFile(join_path(destination, name), "", True, run.conditional or run.testing, run.current_place())
        )


def console_scripts(text: str) -> list[str]:
    """Return the names of the console_scripts in the text of a setup.cfg; empty if the text cannot be parsed."""
    import configparser  # noqa: PLC0415  (few packages have one)

    parser = configparser.ConfigParser(interpolation=None)
    try:
        parser.read_string(text)
        value = parser.get("options.entry_points", "console_scripts", fallback="")
    except configparser.Error:
        return []
    return [line.partition("=")[0].strip() for line in value.splitlines() if "=" in line]


def _provide(run: Run, args: list[str]) -> None:
    """Run ``ros_lint_provide(path [program])``: record that a generated file is installed."""
    path = run.paths.destination(args[0])
    if path is not None and not run.muted:
        program = "program" in args[1:]
        run.results.installed.append(InstalledFile(path, "", program, run.conditional or run.testing, run.current_place()))


def _headers(run: Run, args: list[str]) -> None:
    """Run ``ros_lint_headers(scoped)``: install the folder include/, as ament_auto_package() of ament_cmake_auto does.

    The destination is include/<project> if ``scoped`` is TRUE or the ROS distribution always uses this folder, else include/.
    """
    scoped = args[:1] == ["TRUE"]
    if not scoped:
        scoped = run.distro in _SCOPED
        run.depend_on_distro(_SCOPED if scoped else _UNSCOPED | {run.distro})
    folder = f"include/{run.get('PROJECT_NAME') or ''}" if scoped else "include"
    run_handler(run, "install", ["DIRECTORY", "include/", "DESTINATION", folder, "OPTIONAL"])


_SCOPED: Final = frozenset({"kilted", "lyrical", "rolling"})
_UNSCOPED: Final = frozenset({"humble", "jazzy"})


def _package(run: Run, args: list[str]) -> None:
    """Run ``ros_lint_package(...)``, the effects of ament_package(): record the installed files that find_package() reads."""
    if run.muted:
        return
    name = run.get("PROJECT_NAME") or ""
    span = run.current_place()
    conditional = run.conditional or run.testing
    parts = sections(args, dict.fromkeys(_EXTRAS, -1)) if args else {}
    for word in _EXTRAS:
        files = [*parts.get(word, ()), *elements(run.normal(f"{name}_{word}") or "")]
        if files:
            _extras(run, name, files, conditional)
    if is_known(name):
        package_files = [(f"share/{name}/package.xml", "package.xml")] if "package.xml" in run.paths.files else []
        package_files += [
            (f"share/ament_index/resource_index/packages/{name}", ""),
            (f"share/{name}/cmake/{name}Config.cmake", ""),
        ]
        run.results.installed += [InstalledFile(path, source, False, conditional, span) for path, source in package_files]
    run.package_scopes += run.scopes
    if run.component_scopes and not any(variable.startswith(_REGISTERED) for scope in run.scopes for variable in scope):
        for number, scope in enumerate(run.component_scopes):
            if not any(scope is visible for visible in run.scopes):
                run.results.components[number] = run.results.components[number]._replace(unregistered=True)
        if all(component.unregistered for component in run.results.components):
            run.results.installed[:] = [
                provided for provided in run.results.installed if not provided.path.startswith(_COMPONENT_INDEX)
            ]
    _end(run)


_COMPONENT_INDEX: Final = "share/ament_index/resource_index/rclcpp_components/"
_REGISTERED: Final = "_RCLCPP_COMPONENTS"
"""Prefix of the variables with which rclcpp_components passes the registered components to ament_package().

Some packages set these variables in the scope of ament_package() themselves."""
_EXTRAS: Final = ("CONFIG_EXTRAS", "CONFIG_EXTRAS_POST")


def _needed(run: Run, args: list[str]) -> None:
    """Run ``ros_lint_needed(files...)``: record missing files for which ament stops with an error (assert_file_exists)."""
    for arg in args:
        plain, certain = strip_mark(arg)
        path, span = run.paths.source(plain), run.place_of(arg)
        # The path is relative to the file with the call, which is the current directory only for a CMakeLists.txt.
        if (
            path
            and path not in run.paths.files
            and not (run.muted or run.paths.is_unlisted(path))
            and span.path.endswith("CMakeLists.txt")
        ):
            run.results.missing_files.append((path, span, run.conditional or run.testing or not certain))


def _extras(run: Run, name: str, files: list[str], conditional: bool) -> None:
    _needed(run, files)
    for file in files:
        plain, certain = strip_mark(file)
        path = run.paths.source(plain)
        source = next(
            (candidate for candidate in (path, f"{path}.in") if path is not None and candidate in run.paths.files), None
        )
        file_name = posixpath.basename(source or plain)
        if source is not None:
            run.results.config_extras.append(source)
        elif path is not None or not is_known(file_name):
            continue
        install_path = f"share/{name}/cmake/{file_name.removesuffix('.in')}"
        span = run.place_of(file)
        run.results.installed.append(InstalledFile(install_path, source or "", False, conditional or not certain, span))


def _end(run: Run) -> None:
    """Record the place of ament_package(), because fixes insert install rules before it.

    If a blank line precedes ament_package(), the end of the previous command is recorded as well.
    """
    frame = next(frame for frame in reversed(run.frames) if frame.own)
    top = join_path(run.paths.sources.path, "CMakeLists.txt")
    if (
        run.results.insertion is None
        and not run.uncertain_conditions
        and frame.procedure is None
        and frame.path == top
        and frame.command
    ):
        run.results.insertion = frame.command.place(frame.path).start()
        commands = run.paths.sources.scripts["CMakeLists.txt"].commands
        previous = next((earlier for earlier, later in pairwise(commands) if later.start == frame.command.start), None)
        if previous is not None:
            lines = frame.command.line - previous.line - len(previous.breaks)
            if lines > 1 and frame.command.start - previous.end in (lines, 2 * lines):  # LF or CRLF
                run.results.insertion_after = previous.span(frame.path, previous.end, previous.end)


def _unknown(run: Run, args: list[str]) -> None:
    """Run ``ros_lint_unknown(variables...)``: set variables to unknown values."""
    for arg in args:
        if is_known(arg):
            run.set(arg, HOLE)


def _index_variables(run: Run, args: list[str]) -> None:
    """Run ``ros_lint_of_index(variable)``: set a variable to an unknown value that comes from the ament index."""
    _unknown(run, args)
    run.index_variables.update(args)


def _package_xml(run: Run, _args: list[str]) -> None:
    """Run ``ros_lint_package_xml()``: set the variables for the name and the version in package.xml."""
    name = run.paths.sources.name
    run.set("_AMENT_PACKAGE_NAME", name)
    run.set(f"{name}_VERSION", run.paths.sources.version or HOLE)
    run.set(f"{name}_MAINTAINER", HOLE)


def _test_executable(run: Run, args: list[str]) -> None:
    """Run ``ros_lint_test_executable(target sources...)``: record a test program, even outside of if(BUILD_TESTING)."""
    testing, run.testing = run.testing, True
    arguments = [arg for arg in args if arg[:1] != MAYBE or _TEST_WORDS.get(arg[1:]) != 0]  # drops SKIP_TEST etc.
    try:
        run_handler(run, "add_executable", sections(arguments, _TEST_WORDS)[""])
    finally:
        run.testing = testing


_TEST_WORDS: Final = {
    "SKIP_LINKING_MAIN_LIBRARIES": 0, "SKIP_TEST": 0, "RUNNER": 1, "TIMEOUT": 1, "WORKING_DIRECTORY": 1, "APPEND_ENV": -1,
    "APPEND_LIBRARY_DIRS": -1, "ENV": -1,
}  # fmt: skip


def _vendor(run: Run, args: list[str]) -> None:
    """Run ``ros_lint_vendor(target ...)``, the effects of ament_vendor(): record a target with unknown files.

    ament_vendor() builds an external project and installs it below opt/.
    """
    if args:
        run.put(run.targets, args[0], Properties(KIND="other"))
    run.hide(Facet.USES | Facet.LIBRARIES, "ament_vendor() builds an external project")


def _tests(run: Run, args: list[str]) -> None:
    """Record the files and folders in the arguments of ``add_test()`` as tests that run without being compiled.

    The same is done for ``ros_lint_runs()``: the macros of released packages, as ros-lint stores them, call it in place of
    ``add_test()``.
    """
    for arg in args:
        path = run.paths.source(strip_mark(arg)[0])
        if path is None and HOLE in arg:
            run.results.interpreted_tests[""] = None
        elif path in run.paths.files or (path and run.paths.is_folder(path)):
            run.results.interpreted_tests[path] = None


RUNNERS: Final = frozenset({"add_test", "ros_lint_runs"})
"""Commands that run tests without compiling them: add_test(), and its replacement in macros of released packages."""


def run_handler(run: Run, name: str, args: list[str]) -> None:
    """Run the CMake command ``name``, and assume that it ends normally."""
    HANDLERS[name](run, args)


COMMANDS: Final[dict[str, Handler]] = {
    "ros_lint_component": _component,
    "ros_lint_exported": _exported,
    "ros_lint_interfaces": _interfaces,
    "ros_lint_python": _python,
    "ros_lint_console_scripts": _scripts,
    "ros_lint_provide": _provide,
    "ros_lint_headers": _headers,
    "ros_lint_needed": _needed,
    "ros_lint_package": _package,
    "ros_lint_unknown": _unknown,
    "ros_lint_of_index": _index_variables,
    "ros_lint_package_xml": _package_xml,
    "ros_lint_test_executable": _test_executable,
    "ros_lint_vendor": _vendor,
    "ros_lint_runs": _tests,
    "add_test": _tests,
}
