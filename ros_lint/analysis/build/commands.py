"""Look-ups of commands in the build script of a package, for several rules."""

from __future__ import annotations

import re

from ros_lint.collectors.cmake.released_macros import INSTALL_ARTIFACTS, INSTALL_TARGETS_WORDS
from ros_lint.facts.build import ENDS, BuildScript
from ros_lint.facts.cmake import Call
from ros_lint.facts.manifest import Role
from ros_lint.facts.visibility import Facet, Opaque
from ros_lint.workspace.model import Package

FINDS_TESTS = frozenset({
    "ament_lint_auto_find_test_dependencies", "ament_auto_find_test_dependencies", "autoware_package",
})  # fmt: skip
"""Commands that find all declared test dependencies. If linters are among them, the linters run as tests."""

LINTERS = {
    f"ament_cmake_{linter}": f"ament_{linter}"
    for linter in ("clang_format", "clang_tidy", "copyright", "cppcheck", "cpplint", "flake8", "lint_cmake", "mypy", "pclint",
                   "pep257", "pycodestyle", "pyflakes", "uncrustify", "xmllint")
}  # fmt: skip
"""Packages that run linters as tests, each with the command-line program of its linter."""


def stops_early(script: BuildScript) -> bool:
    """Return whether CMake stops before the end of a build script, at a syntax error or at a missing script or folder."""
    return any(problem.kind in _STOPS for problem in script.problems)


def unconditional_calls(package: Package, *names: str) -> tuple[Call, ...]:
    """Return the calls of the commands ``names`` in CMakeLists.txt that have arguments and run in every build.

    Calls inside of blocks such as if(), and calls for tests, are left out. The result is () for a package that
    ament_cmake does not build.
    """
    if package.builds_with != "ament_cmake":
        return ()
    return tuple([call for call in package.calls(*names) if call.args and not (call.blocks or call.test)])


_STOPS = ("cmake-syntax", "missing-folder", "missing-script")


def config_names(name: str) -> tuple[str, str]:
    """Return the two file names that find_package() looks for: ``MyLib`` -> ``MyLibConfig.cmake`` and ``mylib-config.cmake``."""
    return f"{name}Config.cmake", f"{name.lower()}-config.cmake"


def has_extras(package: Package) -> bool:
    """Return whether find_package() of the package runs CMake code that the package provides (CONFIG_EXTRAS)."""
    if package.built.exports.config_extras:
        return True
    return any("CONFIG_EXTRAS" in text for call in package.calls(*ENDS, anywhere=True) for text in call.texts)


def installed_targets(call: Call) -> tuple[int, ...]:
    """Return the indexes of the targets among the arguments of install(TARGETS), () for any other call."""
    texts = call.texts
    if texts[:1] != ("TARGETS",):
        return ()
    words = (at for at, text in enumerate(texts) if text in INSTALL_ARTIFACTS or text in INSTALL_TARGETS_WORDS)
    return tuple([at for at in range(1, next(words, len(texts))) if texts[at] != "TARGETS"])


REGISTERING = ("rclcpp_components_register_node", "rclcpp_components_register_nodes")
"""Commands that register components. Their first argument is the library that contains the components."""

EXPORTING_PLUGINS = "pluginlib_export_plugin_description_file"
"""The command that installs and exports a plugin description (pluginlib)."""


_OWN_TARGET = re.compile(r"[^:\s]+")
"""Matches the name of a target of the analysed package: a name without a namespace."""


def opaque_except_undefined_targets(package: Package, facet: Facet) -> tuple[Opaque, ...]:
    """Return the places in build scripts that could not be evaluated and may affect ``facet``, e.g. the installed files.

    A call of install() for an undefined target of this package is left out, because CMake rejects the call.
    """
    return tuple(opaque for opaque in package.hidden(facet) if not _OWN_TARGET.fullmatch(opaque.undefined))


_PROJECT_NAME = re.compile(r"\$\{(?:PROJECT_NAME|CMAKE_PROJECT_NAME)\}")


def evaluated_name(package: Package, text: str) -> str | None:
    """Return the value of a CMake argument after replacing ${PROJECT_NAME}; None if it is empty or has other variables."""
    name = _PROJECT_NAME.sub(package.built.project.name or package.name, text)
    return None if "$" in name or not name else name


_TEST_COMMANDS = {
    "ament_add_gtest": "ament_cmake_gtest",
    "ament_add_gmock": "ament_cmake_gmock",
    "ament_add_pytest_test": "ament_cmake_pytest",
    "ament_add_google_benchmark": "ament_cmake_google_benchmark",
    "add_launch_test": "launch_testing_ament_cmake",
    "add_ros_test": "ros_testing",
}
_FOR_TESTS = frozenset({*_TEST_COMMANDS.values(), "ament_lint_auto", "ament_lint_common"})


def unguarded_tests(package: Package) -> dict[str, Call]:
    """Return the test packages that CMake requires even if no tests are built, each with the first call that requires it.

    Example: ``find_package(ament_cmake_gtest REQUIRED)`` outside of ``if(BUILD_TESTING)``. Left out are packages that
    package.xml declares by another tag than ``<test_depend>``.
    """
    result: dict[str, Call] = {}
    if package.builds_with != "ament_cmake":
        return result
    for call in package.calls("find_package", *_TEST_COMMANDS):
        provider = _TEST_COMMANDS.get(call.name) or (call.texts[0] if call.args else "")
        stops = call.name != "find_package" or "REQUIRED" in call.texts
        always = stops and not call.test and not call.blocks
        if always and provider in _FOR_TESTS and provider not in result and not package.declares(provider) & ~Role.TEST:
            result[provider] = call
    return result
