"""A workspace with one package, and what is found of it."""

from __future__ import annotations

from collections.abc import Mapping

from ros_lint.base.tree import MemoryTree
from ros_lint.facts.manifest import Role
from ros_lint.facts.sources import Use
from ros_lint.workspace.loader import Loader
from ros_lint.workspace.model import Workspace
from ros_lint.workspace.target import TargetDistro
from tests.packages import manifest_text

BUILT = Role.BUILD | Role.EXEC
PUBLIC = BUILT | Role.EXPORT
HIDDEN = "include(${UNHEARD_OF}/all.cmake)\n"
"""A line after which neither the targets nor the installed files are known."""
INSTALLED = "install(DIRECTORY include/ DESTINATION include)\n"


def loaded(files: Mapping[str, str], distro: str = "jazzy") -> Workspace:
    """Return the workspace that some files are, by their paths."""
    return Loader(MemoryTree(files), ("",), TargetDistro(distro, "test")).load()


def load(lines: str, files: Mapping[str, str], depends: str = "") -> Workspace:
    """Return a workspace with one package of ament_cmake, given what its CMakeLists.txt has in the middle."""
    script = f"project(robot)\nfind_package(ament_cmake REQUIRED)\n{lines}\nament_package()\n"
    return _robot({"package.xml": manifest_text("robot", [depends]), "CMakeLists.txt": script, **files})


def load_python(options: str, files: Mapping[str, str]) -> Workspace:
    """Return the same of ament_python, given what its setup() says."""
    setup = f"from setuptools import setup\nsetup({options})\n"
    return _robot({"package.xml": manifest_text("robot", build_type="ament_python"), "setup.py": setup, **files})


def _robot(files: Mapping[str, str]) -> Workspace:
    return loaded({f"robot/{path}": text for path, text in files.items()})


def include(package: str) -> str:
    return f"#include <{package}/msg/a.hpp>\n"


def use(workspace: Workspace, package: str) -> Use:
    """Return the only use of a package."""
    (found,) = (use for use in workspace.packages[0].uses if use.package == package)
    return found


def placed(workspace: Workspace, package: str) -> tuple[Role, bool, bool]:
    """Return the role of the only use of a package, whether it is sure and whether it is optional."""
    found = use(workspace, package)
    return found.role, found.certain, found.optional
