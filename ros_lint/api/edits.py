"""Functions that create edits of package.xml, CMakeLists.txt, setup.py and setup.cfg for fixes."""

from ros_lint.analysis.build import cmake_edits as cmake
from ros_lint.collectors.manifest import edits as manifest
from ros_lint.collectors.setup_py import edits as setup_py

__all__ = [
    "cmake",
    "manifest",
    "setup_py",
]
