"""Determine whether the tests of a package run ament_xmllint, which validates package.xml."""

from __future__ import annotations

from ros_lint.analysis.build.commands import FINDS_TESTS
from ros_lint.facts.cmake import Call
from ros_lint.workspace.model import Package, Workspace

_LINTER = "ament_cmake_xmllint"
_EXCLUDED = "AMENT_LINT_AUTO_EXCLUDE"


def runs_xmllint(package: Package, workspace: Workspace) -> bool:
    """Return whether a test of every build certainly runs ament_xmllint on package.xml.

    In an ament_cmake package, CMake calls ``ament_xmllint()``, or finds all test dependencies and one of them provides the
    linter. In an ament_python package, a test imports ``ament_xmllint``.
    """
    if package.builds_with == "ament_python":
        return any(use.name.partition(".")[0] == "ament_xmllint" and _is_test(use.span.path) for use in package.uses)
    if package.builds_with != "ament_cmake":
        return False
    if any(_takes_no_paths(call) and _in_every_test_build(call) for call in package.calls("ament_xmllint")):
        return True
    if any(_may_exclude(call) for call in package.calls("set", "list", anywhere=True)):
        return False
    tests = [declared.name for declared in package.declared if declared.depend.tag == "test_depend" and declared.certain]
    return any(map(_in_every_test_build, package.calls(*FINDS_TESTS))) and any(_brings_linter(workspace, name) for name in tests)


def _is_test(path: str) -> bool:
    """Return whether pytest collects a file as a test."""
    return path.rpartition("/")[2].startswith("test_") and path.endswith(".py")


def _takes_no_paths(call: Call) -> bool:
    """Return whether a call of ``ament_xmllint()`` checks the whole package."""
    return call.texts in ((), ("TESTNAME", *call.texts[1:2]))


def _in_every_test_build(call: Call) -> bool:
    """Return whether a command runs whenever tests are built."""
    return call.blocks in ((), ("if",) if call.test else ())


def _may_exclude(call: Call) -> bool:
    """Return whether a set() or list() command may exclude ament_cmake_xmllint from the linters that are run.

    The result is True if an argument contains the name of the linter, or if AMENT_LINT_AUTO_EXCLUDE gets the value of a variable.
    """
    named = any(_LINTER in text for text in call.texts)
    return named or (_EXCLUDED in call.texts and any("$" in text for text in call.texts))


def _brings_linter(workspace: Workspace, name: str) -> bool:
    """Return whether a test dependency makes CMake run ament_xmllint: ament_cmake_xmllint or a package ``*_lint_common``.

    A ``*_lint_common`` package counts only if it depends on ament_cmake_xmllint at run time.
    """
    return name == _LINTER or (name.endswith("_lint_common") and _LINTER in (workspace.world.depends(name, "x") or ()))
