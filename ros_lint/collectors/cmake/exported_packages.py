"""The packages that the CMake code of a package needs when this code runs in other packages (CONFIG_EXTRAS)."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Final

from ros_lint.base.paths import join
from ros_lint.base.text import Span
from ros_lint.collectors.cmake.evaluator.run import Run
from ros_lint.collectors.cmake.syntax import Command
from ros_lint.facts.sources import Mention


def exported_packages(run: Run) -> Iterator[tuple[Mention, bool]]:
    """Yield the packages that a package needs when its CMake code runs in other packages, each with its certainty.

    The certainty is True if the need does not depend on a condition. The packages are those of find_package() and
    find_dependency() in the files of :func:`_exported_files`. Calls in functions and macros are omitted, because they run
    only if the function or macro is called. ros_environment is needed for ``$ENV{ROS_DISTRO}``, also in functions and macros.
    """
    for file in _exported_files(run):
        blocks: list[bool | None] = []  # for each enclosing block, whether it always runs; None for a function or macro
        path, commands = join(run.paths.sources.path, file), _commands(run, file)
        tested = {argument[0] for command in commands for argument in command.args}
        for command in commands:
            words = [argument[0] for argument in command.args]
            yield from ((mention, False not in blocks) for mention in _of_environment(path, command, tested))
            if command.name in ("function", "macro"):
                blocks.append(None)
            elif command.name in ("if", "foreach", "while", "block"):
                blocks.append(command.name == "if" and _tests_existence(words))
            elif command.name.startswith("end") and blocks:
                blocks.pop()
            elif command.name in ("else", "elseif") and blocks:
                blocks[-1] = False
            elif command.name in ("find_package", "find_dependency") and words and _PLAIN_NAME.fullmatch(words[0]):
                if (
                    None in blocks
                    or words[0] in (run.results.project.name, run.paths.sources.name)
                    or words[0] in run.packages.find_modules
                ):
                    continue
                required = "REQUIRED" in words or command.name == "find_dependency"
                quotation = f"{command.name}({words[0]}) for dependents of this package"
                yield Mention(words[0], "cmake", _argument(path, command, 0), quotation, not required), all(blocks)


_PLAIN_NAME: Final = re.compile(r"[A-Za-z][\w+.-]*")


def _exported_files(run: Run) -> list[str]:
    """Return the CMake files of the package that run in the packages that find it.

    These are:

    - the files of CONFIG_EXTRAS,
    - the templates of CMake config files,
    - installed files that another result includes, as in ``include("${tools_DIR}/more.cmake")``, or registers, as in
      ``ament_register_extension(point tools more.cmake)``.
    """
    name = run.results.project.name
    folder = f"share/{name}/cmake/"
    installed = {file.path.removeprefix(folder): file.source for file in run.results.installed if file.path.startswith(folder)}
    own = (f"${{{name}_DIR}}/", "${@PROJECT_NAME@_DIR}/", "${CMAKE_CURRENT_LIST_DIR}/")
    files = list(dict.fromkeys([*run.results.config_extras, *run.results.config_templates]))
    for file in files:
        for command in _commands(run, file):
            argument = {"include": 0, "ament_register_extension": 2}.get(command.name, len(command.args))
            if argument >= len(command.args):
                continue
            text = command.args[argument][0]
            beginning = next((beginning for beginning in own if text.startswith(beginning)), "")
            source = installed.get(text.removeprefix(beginning)) if beginning or command.name != "include" else None
            if source and source not in files:
                files.append(source)
    return files


def _commands(run: Run, file: str) -> Sequence[Command]:
    scripts = run.paths.sources.scripts
    return scripts[file].commands if file in scripts else ()


_ENVIRONMENT: Final = re.compile(r"\$ENV\{(ROS_(?:DISTRO|VERSION|PYTHON_VERSION))\}")


def _of_environment(path: str, command: Command, tested: set[str]) -> Iterator[Mention]:
    """Yield a mention of ros_environment for each environment variable of ros_environment in a command.

    Example: ``$ENV{ROS_DISTRO}``. The mention is optional if a command of the file tests whether the variable exists.
    ``tested`` has the texts of all arguments of the file.
    """
    for index, argument in enumerate(command.args):
        match = _ENVIRONMENT.search(argument[0])
        if match and command.name != "message":
            span = _argument(path, command, index)
            yield Mention("ros_environment", "package", span, match[0], f"ENV{{{match[1]}}}" in tested)


def _tests_existence(words: Sequence[str]) -> bool:
    """Return whether a condition tests only the existence of a target, package or policy: ``NOT TARGET fmt::fmt``."""
    return len(words) <= 3 and ("TARGET" in words or "POLICY" in words or words[-1].endswith("_FOUND"))


def _argument(path: str, command: Command, index: int) -> Span:
    _, _, start, end = command.args[index]
    return command.span(path, start, end)
