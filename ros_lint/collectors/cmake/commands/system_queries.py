"""Commands whose output variables become unknown: queries of the machine, and of properties that are not evaluated."""

from __future__ import annotations

from typing import Final

from ros_lint.collectors.cmake.evaluator.run import Handler, Run
from ros_lint.collectors.cmake.evaluator.values import HOLE, is_known


def _unknown(run: Run, name: str) -> None:
    if HOLE not in name:
        run.set(name, HOLE)


def _first(run: Run, args: list[str]) -> None:
    """Run a command with an output variable as its first argument: set the variable to an unknown value."""
    if args:
        _unknown(run, args[0])


def _first_in_cache(run: Run, args: list[str]) -> None:
    """Run a command with an output variable in the cache as its first argument: set the variable to an unknown value.

    The value remains after the end of a function, because it is in the cache.
    """
    if args:
        _unknown_in_cache(run, args[0])


def _last_in_cache(run: Run, args: list[str]) -> None:
    """Run a command with an output variable in the cache as its last argument: set the variable to an unknown value."""
    if args:
        _unknown_in_cache(run, args[-1])


def _unknown_in_cache(run: Run, name: str) -> None:
    if HOLE in name:
        return
    run.put(run.cache, name, HOLE)
    if run.normal(name) is not None:
        run.set(name, HOLE)


def _host(run: Run, args: list[str]) -> None:
    """Run ``cmake_host_system_information(RESULT variable QUERY ...)``: set the variable to an unknown value."""
    if len(args) > 1:
        _unknown(run, args[1])


def _path(run: Run, args: list[str]) -> None:
    """Run ``cmake_path()``: set the variable to which the mode writes its result to an unknown value."""
    if len(args) < 2:
        return
    if "OUTPUT_VARIABLE" in args[:-1]:
        _unknown(run, args[args.index("OUTPUT_VARIABLE") + 1])
    elif args[0] in _CHANGES_PATH:
        _unknown(run, args[1])
    elif args[0] == "CONVERT":
        _unknown(run, args[3] if len(args) > 3 else HOLE)
    else:
        _unknown(run, args[-1])


_CHANGES_PATH: Final = frozenset(
    (
        "SET", "APPEND", "APPEND_STRING", "REMOVE_FILENAME", "REPLACE_FILENAME", "REMOVE_EXTENSION", "REPLACE_EXTENSION",
        "NORMAL_PATH", "RELATIVE_PATH", "ABSOLUTE_PATH",
    )
)  # fmt: skip


def _separate(run: Run, args: list[str]) -> None:
    """Run ``separate_arguments(variable [mode ... text])``.

    Without a mode, the spaces in the value of the variable become semicolons. With a mode, the value becomes unknown.
    """
    if len(args) != 1:
        _first(run, args)
    elif HOLE not in args[0]:
        value = run.get(args[0]) or ""
        run.set(args[0], value.replace(" ", ";") if is_known(value) else HOLE)


COMMANDS: Final[dict[str, Handler]] = {
    "cmake_host_system_information": _host,
    "cmake_path": _path,
    "separate_arguments": _separate,
    **dict.fromkeys(
        ("get_cmake_property", "get_directory_property", "get_source_file_property", "processorcount"), _first
    ),
    **dict.fromkeys(
        (
            "find_file", "find_library", "find_path", "find_program", "site_name", "test_big_endian", "try_compile", "try_run",
        ),
        _first_in_cache,
    ),
    **dict.fromkeys(
        (
            "check_c_compiler_flag", "check_c_source_compiles", "check_cxx_compiler_flag", "check_cxx_linker_flag",
            "check_cxx_source_compiles", "check_cxx_source_runs", "check_cxx_symbol_exists", "check_function_exists",
            "check_include_file", "check_include_file_cxx", "check_include_files", "check_library_exists",
            "check_symbol_exists", "check_type_size",
        ),
        _last_in_cache,
    ),
}  # fmt: skip
