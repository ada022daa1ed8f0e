"""Commands of CMake files as they are written, with what they stand in: for rules about the order of commands, and for fixes.

What they do is the evaluator's affair, :mod:`ros_lint.collectors.cmake.evaluate`.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from ros_lint.collectors.cmake.syntax import Command, Parsed
from ros_lint.facts.cmake import Call

WANTED: Final = frozenset({
    "add_custom_command", "add_custom_target", "add_executable", "add_launch_test", "add_library", "add_ros_test",
    "ament_add_gmock", "ament_add_google_benchmark", "ament_add_gtest", "ament_add_pytest_test", "ament_auto_add_executable",
    "ament_auto_add_library", "ament_auto_package", "ament_clang_format", "ament_clang_tidy", "ament_copyright",
    "ament_cppcheck", "ament_cpplint", "ament_environment_hooks", "ament_export_definitions", "ament_export_dependencies",
    "ament_export_include_directories", "ament_export_interfaces", "ament_export_libraries", "ament_export_link_flags",
    "ament_export_targets", "ament_flake8", "ament_lint_auto_find_test_dependencies", "ament_lint_cmake", "ament_mypy",
    "ament_package", "ament_pclint", "ament_pep257", "ament_pycodestyle", "ament_pyflakes", "ament_python_install_package",
    "ament_target_dependencies", "ament_uncrustify", "ament_vendor", "ament_xmllint", "autoware_ament_auto_package",
    "catkin_package", "cmake_minimum_required", "cmake_policy", "exec_program", "execute_process",
    "find_package", "include", "include_directories", "install", "link_directories", "nav2_package",
    "pluginlib_export_plugin_description_file", "project", "rclcpp_components_register_node", "rclcpp_components_register_nodes",
    "rosidl_generate_interfaces", "rosidl_get_typesupport_target",
    "rosidl_target_interfaces", "set",
    "set_target_properties", "target_compile_definitions", "target_compile_features", "target_compile_options",
    "target_include_directories", "target_link_libraries", "target_sources",
})  # fmt: skip

_SET = ("CMAKE_BUILD_TYPE", "CMAKE_CXX_FLAGS", "CMAKE_MODULE_PATH", "CMAKE_PREFIX_PATH", "CMAKE_INSTALL_PREFIX")
_OPEN = frozenset({"if", "foreach", "while", "function", "macro"})


def collect(path: str, parsed: Parsed) -> Iterator[Call]:
    """Yield the wanted commands of a CMake file, in order. ``path`` is that of the file, relative to the base."""
    blocks: list[tuple[str, bool]] = []
    around: tuple[str, ...] = ()
    test = asked = False
    for command in parsed.commands:
        name = command.name
        if name in _OPEN:
            blocks.append((name, name == "if" and _asks_for_tests(command)))
            around, asked = _place(blocks)
        elif name[:3] == "end" and blocks and name[3:] in _OPEN:
            blocks.pop()
            around, asked = _place(blocks)
        elif name in ("else", "elseif") and blocks:
            blocks[-1] = ("if", blocks[-1][1] or (name == "elseif" and _asks_for_tests(command)))
            around, asked = _place(blocks)
        elif name == "return" and asked:
            test = True  # if(NOT BUILD_TESTING) return() endif(): the rest is for tests
        elif name in WANTED and (name != "set" or (command.args and command.args[0][0] in _SET)):
            _, _, args, start, end, line, column, breaks = command
            yield Call(name, path, args, start, end, line, column, breaks, around, test or asked)


def _place(blocks: list[tuple[str, bool]]) -> tuple[tuple[str, ...], bool]:
    """Return the names of blocks, and whether one of them asks if tests are wanted."""
    return tuple([block for block, _ in blocks]), any(asked for _, asked in blocks)


def _asks_for_tests(command: Command) -> bool:
    return any("TEST" in text.upper() or "BENCHMARK" in text.upper() for text, *_ in command.args)
