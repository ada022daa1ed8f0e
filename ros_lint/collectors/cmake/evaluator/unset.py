"""References to variables that are never set, in the commands that build, link, install and export."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Final

from ros_lint.collectors.cmake.evaluator.run import Run
from ros_lint.collectors.cmake.syntax import CLOSE, UNQUOTED, Command, is_template
from ros_lint.facts.cmake import UnsetVariable

READERS: Final = frozenset({
    "add_executable", "add_library", "ament_add_gmock", "ament_add_gtest", "ament_auto_add_executable", "ament_auto_add_library",
    "ament_export_dependencies", "ament_export_include_directories", "ament_export_libraries", "ament_export_targets",
    "ament_target_dependencies", "install", "rclcpp_components_register_nodes", "rosidl_generate_interfaces",
    "target_link_libraries", "target_sources",
})  # fmt: skip
"""Names of the commands with arguments that determine what is built, linked, installed or exported."""

_REFERENCE: Final = re.compile(r"\$\{([A-Za-z]\w*)\}")
_OF_OTHERS: Final = re.compile(
    r"(?:AMENT|ARG[CNV]|BUILD|CATKIN|CMAKE|CPACK|CTEST|CUDA|ENV|PROJECT|PYTHON|Python|QT|Qt|ROS|ament|catkin|rosidl)(?:_|\d|\Z)\w*"
    r"|\w+_(?:BINARY_DIR|CFLAGS|DEFINITIONS|DIR|DIRS|EXECUTABLE|FOUND|INCLUDE|INCLUDES|LDFLAGS|LIB|LIBRARIES|LIBRARY|LIBS|PACKAGES"
    r"|PATH|PREFIX|ROOT|SOURCE_DIR|TARGET|TARGETS|VERSION\w*)"
)
"""Pattern of variables of CMake, of build tools, and of packages that find_package() may find. They are not reported."""


def note_unset_references(run: Run, command: Command) -> None:
    """Record each unquoted argument of a command that is only a reference ``${name}`` to a variable without a value.

    Nothing is recorded if the command may not run.
    """
    frame = run.frames[-1]
    if run.muted or run.uncertain_conditions or not frame.own or frame.procedure is not None:
        return
    for text, kind, start, end in command.args:
        if kind != UNQUOTED:
            continue
        match = _REFERENCE.fullmatch(text)
        if match is not None and run.get(match[1]) is None and not _OF_OTHERS.fullmatch(match[1]):
            span = command.span(frame.path, start + 2, end - 1)
            run.results.unset_references[UnsetVariable(match[1], command.name, span)] = None


def unset_variables(run: Run) -> Iterator[UnsetVariable]:
    """Yield the recorded references to variables that no code can have set.

    A variable may be set if a command of the package has an argument that is its name, or that may evaluate to its name.
    """
    if not run.results.unset_references or run.any_variable_may_be_set or run.skipped_include:
        return
    words = {
        argument[0]
        for file, parsed in run.paths.sources.scripts.items()
        if not is_template(file)
        for command in parsed.commands
        for argument in command.args
        if argument[1] < CLOSE
    }
    computed = [_pattern(word) for word in words if "${" in word and not _REFERENCE.fullmatch(word)]
    for reference in run.results.unset_references:
        if reference.name not in words and not _matches(computed, reference.name):
            yield reference


def _pattern(word: str) -> re.Pattern[str]:
    """Return a pattern of the texts to which an argument may evaluate: ``${x}_DIR`` matches ``ROBOT_DIR``."""
    pieces = re.split(r"\$\w*\{[^{}]*\}", word)
    return re.compile(r"\w+".join(map(re.escape, pieces)) if any(pieces) else r"(?!)")


def _matches(patterns: Iterable[re.Pattern[str]], name: str) -> bool:
    return any(pattern.fullmatch(name) for pattern in patterns)
