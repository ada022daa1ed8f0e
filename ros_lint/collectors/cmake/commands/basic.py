"""Commands for variables, options, projects and control flow: set(), option(), project(), return() and others."""

from __future__ import annotations

import posixpath
import re
from typing import Final

from ros_lint.base.text import Text
from ros_lint.collectors.cmake.commands.ros2_run import note_started_programs
from ros_lint.collectors.cmake.evaluator.arguments import parse_keywords
from ros_lint.collectors.cmake.evaluator.flow import run_file, run_named
from ros_lint.collectors.cmake.evaluator.run import Handler, Run
from ros_lint.collectors.cmake.evaluator.state import BREAK, CONTINUE, MOST_STEPS, RETURN, STOP, CallFrame
from ros_lint.collectors.cmake.evaluator.truth import TRUE_WORDS, is_off
from ros_lint.collectors.cmake.evaluator.values import (
    HOLE,
    MAYBE,
    SLOW,
    cached_short,
    certainly_set,
    elements,
    is_fixed,
    is_known,
    join,
    merge,
    natural,
    split,
)
from ros_lint.collectors.cmake.syntax import parse
from ros_lint.facts.build import BuildProject
from ros_lint.facts.visibility import ALL_FACETS


def _set(run: Run, args: list[str]) -> None:
    if not args or HOLE in args[0]:
        return
    name = args[0]
    if name.startswith("ENV{"):
        run.put(run.environment, name[4:-1], join(args[1:2]))
        return
    if len(args) == 1:
        run.set(name, None)
        return
    if len(args) > 3 and "CACHE" in args[1:]:
        at = len(args) - 3 if args[-3] == "CACHE" else len(args) - 4 if args[-4] == "CACHE" and args[-1] == "FORCE" else 0
        if at:
            _set_cache(run, name, join(args[1:at]), args[at + 1], args[-1] == "FORCE")
            return
    if args[-1] == "PARENT_SCOPE":
        run.set_parent(name, join(args[1:-1]) if len(args) > 2 else None)
        return
    value = join(args[1:])
    if len(run.scopes) == 1 and (run.testing or name in run.test_switches or name in run.test_elements):
        _note_test_switch(run, name, value)
        run.note_test_elements(name, split(value))
    command = run.frames[-1].command
    if run.distro and run.distro in value and command and any("$ENV{ROS_DISTRO}" in text for text, *_ in command.args):
        run.settable.add(name)  # the user may change ROS_DISTRO, and with it this variable
    run.set(name, value)
    run.note_literals(1)


def _note_test_switch(run: Run, name: str, value: str) -> None:
    """Record in ``run.test_switches`` a variable that set() makes true only when tests are enabled."""
    if is_off(value):
        return
    value_before = run.get(name)
    if not run.testing:
        run.test_switches.pop(name, None)
    elif value_before is None or is_off(value_before):
        run.test_switches[name] = value


def _set_cache(run: Run, name: str, value: str, kind: str, force: bool) -> None:
    is_new = name not in run.cache
    if kind in ("PATH", "FILEPATH"):
        value = _path(value)
    if kind != "INTERNAL" and not force:
        run.settable.add(name)
    if not is_new and not force and kind != "INTERNAL" and not certainly_set(run.cache[name]):
        run.put(run.cache, name, merge([run.cache[name], value]))
        run.set(name, HOLE)
    elif is_new or force or kind == "INTERNAL":
        run.put(run.cache, name, value)
        if run.policy_version < (3, 21):  # policy CMP0126
            run.set(name, None)


def _path(value: str) -> str:
    """Return a path as CMake stores it in the cache, without a slash at the end; HOLE (unknown) if it is hard to normalize.

    This is the case for a path with an unknown part, a double slash, a backslash, a semicolon, or ``~`` at the start.
    """
    not_modelled = HOLE in value or "//" in value or "\\" in value or ";" in value or value.startswith("~")
    return HOLE if not_modelled else value.rstrip("/") or value


def _unset(run: Run, args: list[str]) -> None:
    if not args or HOLE in args[0]:
        return
    if args[0].startswith("ENV{"):
        run.put(run.environment, args[0][4:-1], "")
    elif "CACHE" in args[1:]:
        run.remove(run.cache, args[0])
    elif "PARENT_SCOPE" in args[1:]:
        run.set_parent(args[0], None)
    else:
        run.set(args[0], None)


def _option(run: Run, args: list[str]) -> None:
    if not args or HOLE in args[0]:
        return
    name = args[0]
    usual = _switch(args[2]) if len(args) > 2 else "OFF"
    run.settable.add(name)
    value = run.normal(name)
    if value is not None and run.policy_version >= (3, 13):  # policy CMP0077
        if not certainly_set(value):
            run.put(run.cache, name, merge([run.cache.get(name), usual]))
            run.set(name, HOLE)
        return
    if name not in run.cache:
        run.put(run.cache, name, usual)
        run.set(name, None)
    elif not certainly_set(run.cache[name]):
        run.put(run.cache, name, merge([run.cache[name], usual]))
        if value is not None:
            run.set(name, HOLE)


def _switch(value: str) -> str:
    """Return the value that option() stores for an initial value: ON or OFF, HOLE (unknown) if the value is unknown."""
    if not is_fixed(value):
        return HOLE
    return "ON" if value.upper() in TRUE_WORDS else "OFF"


def _message(_run: Run, args: list[str]) -> int | None:
    return STOP if args and args[0] == "FATAL_ERROR" else None


def _return(run: Run, args: list[str]) -> int:
    if "PROPAGATE" in args and run.policy_version >= (3, 25):  # policy CMP0140
        for name in args[args.index("PROPAGATE") + 1 :]:
            run.return_to_caller(name, run.get(name))
    return RETURN


def _break(_run: Run, _args: list[str]) -> int:
    return BREAK


def _continue(_run: Run, _args: list[str]) -> int:
    return CONTINUE


def _minimum(run: Run, args: list[str]) -> None:
    if "VERSION" in args[:-1]:
        _set_policy_version(run, args[args.index("VERSION") + 1])


def _policy(run: Run, args: list[str]) -> None:
    if args[:1] == ["VERSION"] and len(args) > 1:
        _set_policy_version(run, args[1])
    elif args[:1] == ["GET"] and len(args) > 2:
        run.set(args[2], HOLE)


def _set_policy_version(run: Run, version: str) -> None:
    run.policy_version = _version(version) or run.policy_version


@cached_short(256)
def _version(text: str) -> tuple[int, int] | None:
    """Return the version up to which policies behave as NEW: ``3.5...3.20`` -> ``(3, 20)``; None if it is unknown."""
    match = re.match(r"([0-9]+)(?:\.([0-9]+))?", text.rpartition("...")[2])
    if match is None or not is_known(text):
        return None
    major, minor = natural(match[1]), natural(match[2] or "0")
    return None if major is None or minor is None else (major, minor)


def _project(run: Run, args: list[str]) -> None:
    name = args[0] if args and is_fixed(args[0]) else HOLE
    number = ""
    if "VERSION" in args[1:-1]:
        number = args[args.index("VERSION") + 1]
    top = not run.results.project.name and not run.paths.directory
    if run.paths.directory and is_known(name):
        run.results.bundled_projects[name] = None
    if top:
        project = BuildProject(name, run.place_of(args[0])) if name and is_known(name) else BuildProject()
        if is_known(number) and number:
            run.results.project = project._replace(version=number, version_span=run.place_of(number))
        else:
            previous = run.results.project
            run.results.project = project._replace(version=previous.version, version_span=previous.version_span)
        run.set("CMAKE_PROJECT_NAME", name)
        run.path_variables["CMAKE_INSTALL_DOCDIR"] = f"share/doc/{name}"
    folder, build = run.path_variables["CMAKE_CURRENT_SOURCE_DIR"], run.path_variables["CMAKE_CURRENT_BINARY_DIR"]
    values: dict[str, str | None] = {
        "PROJECT_NAME": name,
        "PROJECT_SOURCE_DIR": folder,
        "PROJECT_BINARY_DIR": build,
        "PROJECT_VERSION": number,
        f"{name}_SOURCE_DIR": folder,
        f"{name}_BINARY_DIR": build,
        f"{name}_VERSION": number,
    }
    parts = number.split(".") if is_known(number) else [HOLE] * 4
    for index, part in enumerate(("MAJOR", "MINOR", "PATCH", "TWEAK")):
        values[f"PROJECT_VERSION_{part}"] = values[f"{name}_VERSION_{part}"] = parts[index] if index < len(parts) else ""
    if name == HOLE:
        values = {variable: value for variable, value in values.items() if HOLE not in variable}
    run.set_all(values)


def _parse_arguments(run: Run, args: list[str]) -> None:
    """Run ``cmake_parse_arguments(prefix options one multi args...)``, also with PARSE_ARGV: set the variables."""
    if args[:1] == ["PARSE_ARGV"]:
        prefix, options, singles, multis = (*args[2:6], "", "", "", "")[:4]
        call_arguments = _rest_of_call(run, args[1])
        if call_arguments is None:  # the arguments are unknown, so any keyword may be among them
            run.set_all(dict.fromkeys(parse_keywords(prefix, options, singles, multis, ()), HOLE))
            return
        arguments = [arg.replace(";", "\\;") for arg in call_arguments]
    else:
        prefix, options, singles, multis = (*args[:4], "", "", "", "")[:4]
        arguments = args[4:]
        if ";" in "".join(arguments):
            arguments = [element for arg in arguments for element in split(arg)]
        elif "" in arguments:
            arguments = [arg for arg in arguments if arg]
    if not is_known(f"{prefix}{options}{singles}{multis}"):
        return
    run.budget.charge(len(prefix) * sum(names.count(";") for names in (options, singles, multis)))
    run.set_all(parse_keywords(prefix, options, singles, multis, arguments))


def _rest_of_call(run: Run, first: str) -> list[str] | None:
    """Return the arguments of the current function from index ``first``; None if the arguments are unknown."""
    begin, end = natural(first), natural(run.get("ARGC") or "")
    if begin is None:
        return None
    if end is not None:
        return [run.get(f"ARGV{index}") or "" for index in range(begin, end)] if end <= MOST_STEPS else None
    certain: list[str] = []
    while (arg := run.get(f"ARGV{len(certain)}")) and not _NOT_SINGLE.search(arg):
        certain.append(arg)
    if begin > len(certain):
        return None
    return [*certain[begin:], *elements(run.get("ARGV") or HOLE)[len(certain) :]]


_NOT_SINGLE = re.compile(f"[{HOLE}{MAYBE};\\\\[\\]]")
"""Pattern of values that may be no argument or several arguments, or that change when they are stored in a list."""


def _language(run: Run, args: list[str]) -> int | None:
    """Run ``cmake_language(CALL command args...)`` or ``cmake_language(EVAL CODE text...)``.

    Return the ways in which the code may end, e.g. by return(); None for a normal end.
    """
    mode = args[0] if args else ""
    if mode == "CALL" and len(args) > 1 and is_known(args[1]):
        return run_named(run, args[1].lower(), args[2:])
    if mode == "EVAL" and args[1:2] == ["CODE"] and is_fixed(" ".join(args)):
        frame = run.frames[-1]
        run.budget.charge(SLOW * sum(map(len, args)))
        commands = parse(Text(frame.path, " ".join(args[2:]))).commands
        return run_file(run, commands, CallFrame(False, frame.path, frame.file, provider=frame.provider))
    if mode in ("CALL", "EVAL", "DEFER"):
        run.open_world = run.any_variable_may_be_set = run.may_define_targets = True
        run.hide(ALL_FACETS, f"the commands that cmake_language({mode}) runs are unknown")
    elif len(args) > 1:
        run.set(args[-1], HOLE)
    return None


def _folder_sources(run: Run, args: list[str]) -> None:
    """Run ``aux_source_directory(folder variable)``: append the sources of a folder to the list in a variable."""
    if len(args) < 2 or HOLE in args[1]:
        return
    folder = run.paths.source(args[0])
    if folder is None:
        run.set(args[1], HOLE)
        return
    skip = len(folder) + 1 if folder else 0
    files = run.paths.files_below(folder)
    run.budget.charge(SLOW * len(files))
    names = [file[skip:] for file in files if "/" not in file[skip:]]
    sources = [
        f"{args[0]}/{name}" for name in names if name.endswith((".c", ".cc", ".cpp", ".cxx", ".C", ".c++", ".cu", ".m", ".mm"))
    ]
    run.set(args[1], join([*filter(None, [run.get(args[1])]), *sources]))


def _execute_process(run: Run, args: list[str]) -> None:
    """Run ``execute_process()``: set its output variables to unknown values, and record the programs that it starts.

    ``COMMAND cmake -S folder ...`` builds a project in a folder of the package. The project is recorded as bundled, that is,
    built together with the package.
    """
    folder = run.paths.source(args[args.index("-S") + 1]) if "-S" in args[:-1] else None
    if folder and run.paths.is_folder(folder) and not run.muted:
        run.results.bundled_projects[posixpath.basename(folder)] = None
    note_started_programs(run, args)
    for keyword in ("RESULT_VARIABLE", "OUTPUT_VARIABLE", "ERROR_VARIABLE", "RESULTS_VARIABLE"):
        for index in range(len(args) - 1):
            if args[index] == keyword:
                run.set(args[index + 1], HOLE)


def nothing(_run: Run, _args: list[str]) -> None:
    """Run a command that has no effect on the recorded facts."""


COMMANDS: Final[dict[str, Handler]] = {
    "set": _set,
    "unset": _unset,
    "option": _option,
    "message": _message,
    "return": _return,
    "break": _break,
    "continue": _continue,
    "cmake_minimum_required": _minimum,
    "cmake_policy": _policy,
    "project": _project,
    "cmake_parse_arguments": _parse_arguments,
    "execute_process": _execute_process,
    "exec_program": _execute_process,
    "cmake_language": _language,
    "aux_source_directory": _folder_sources,
    "check_language": nothing,
}
COMMANDS.update(
    dict.fromkeys(
        (
            "mark_as_advanced", "include_guard", "enable_testing", "enable_language",
            "add_compile_definitions", "add_link_options", "link_directories", "source_group",
            "add_dependencies", "set_tests_properties", "remove_definitions", "set_source_files_properties",
            "set_directory_properties",
            "variable_watch", "build_command", "create_test_sourcelist", "define_property", "include_regular_expression",
            "include_external_msproject", "load_cache", "cmake_print_variables", "cmake_print_properties",
            "feature_summary", "add_feature_info", "set_package_properties", "ctest_start", "ctest_test", "export",
            "target_compile_definitions", "target_compile_features", "target_link_options",
            "target_link_directories", "target_precompile_headers", "gtest_discover_tests", "gtest_add_tests",
            "check_ipo_supported", "cmake_push_check_state", "cmake_pop_check_state", "cmake_file_api",
            "write_file", "make_directory", "check_struct_has_member",
        ),
        nothing,
    )
)  # fmt: skip
