"""Variables and macros that CMake and the released packages of ROS 2 provide.

The macros are in ``ros_macros.cmake``, written in CMake and reduced to their effects. The evaluator runs them instead of the
real macros. The notation is described at the start of this file.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from functools import cache
from typing import Final, NamedTuple

INSTALL_ARTIFACTS: Final = (
    "ARCHIVE", "LIBRARY", "RUNTIME", "OBJECTS", "FRAMEWORK", "BUNDLE", "PRIVATE_HEADER", "PUBLIC_HEADER", "RESOURCE",
    "INCLUDES", "CXX_MODULES_BMI",
)  # fmt: skip
"""Kinds of files (artifacts) that can have their own DESTINATION in install(TARGETS)."""

INSTALL_TARGETS_WORDS: Final[Mapping[str, int]] = {
    "EXPORT": 1, "DESTINATION": 1, "PERMISSIONS": -1, "CONFIGURATIONS": -1, "COMPONENT": 1, "NAMELINK_COMPONENT": 1,
    "OPTIONAL": 0, "EXCLUDE_FROM_ALL": 0, "NAMELINK_ONLY": 0, "NAMELINK_SKIP": 0, "RUNTIME_DEPENDENCIES": -1,
    "RUNTIME_DEPENDENCY_SET": 1, "FILE_SET": 1,
}  # fmt: skip
"""Keywords of install(TARGETS) other than artifacts, with the number of arguments of each; -1 is any number."""

VISIBILITY: Final = frozenset({"INTERFACE", "PRIVATE", "PUBLIC"})
"""Scope keywords of commands such as target_link_libraries()."""

VARIABLES: Final[Mapping[str, str]] = {
    "CMAKE_BINARY_DIR": "/\1build",
    "CMAKE_CURRENT_BINARY_DIR": "/\1build",
    "PROJECT_BINARY_DIR": "/\1build",
    "CMAKE_INSTALL_PREFIX": "/\1prefix",
    "CMAKE_INSTALL_BINDIR": "bin",
    "CMAKE_INSTALL_SBINDIR": "sbin",
    "CMAKE_INSTALL_LIBEXECDIR": "libexec",
    "CMAKE_INSTALL_LIBDIR": "lib",
    "CMAKE_INSTALL_INCLUDEDIR": "include",
    "CMAKE_INSTALL_DATAROOTDIR": "share",
    "CMAKE_INSTALL_DATADIR": "share",
    "CMAKE_INSTALL_MANDIR": "share/man",
    "CMAKE_INSTALL_SYSCONFDIR": "etc",
    "CMAKE_INSTALL_FULL_BINDIR": "/\1prefix/bin",
    "CMAKE_INSTALL_FULL_LIBDIR": "/\1prefix/lib",
    "CMAKE_INSTALL_FULL_INCLUDEDIR": "/\1prefix/include",
    "CMAKE_INSTALL_FULL_DATADIR": "/\1prefix/share",
    "PYTHON_INSTALL_DIR": "lib/python/site-packages",
    "PYTHON_MODULE_EXTENSION": ".so",
    "UNIX": "1",
    "LINUX": "1",
    "CMAKE_SYSTEM_NAME": "Linux",
    "CMAKE_HOST_SYSTEM_NAME": "Linux",
    "CMAKE_HOST_UNIX": "1",
    "CMAKE_COMPILER_IS_GNUCXX": "1",
    "CMAKE_COMPILER_IS_GNUCC": "1",
    "CMAKE_CXX_COMPILER_ID": "GNU",
    "CMAKE_C_COMPILER_ID": "GNU",
    "CMAKE_SHARED_LIBRARY_PREFIX": "lib",
    "CMAKE_SHARED_LIBRARY_SUFFIX": ".so",
    "CMAKE_STATIC_LIBRARY_PREFIX": "lib",
    "CMAKE_STATIC_LIBRARY_SUFFIX": ".a",
    "CMAKE_SIZEOF_VOID_P": "8",
    "CMAKE_FILES_DIRECTORY": "/CMakeFiles",
}
"""Variables with equal values in every colcon build on Linux.

- GNUInstallDirs: ``lib``, as on Debian and Ubuntu.
- PYTHON_INSTALL_DIR: the real value is ``lib/pythonX.Y/site-packages``.
- PYTHON_MODULE_EXTENSION: the real value is ``.cpython-XY-<machine>.so``.
- A value with a control character is a folder at an unknown place, see :mod:`ros_lint.collectors.cmake.evaluator.values`."""

CONFIGURABLE_VARIABLES: Final = frozenset({
    "ANDROID", "APPLE", "BUILD_SHARED_LIBS", "CMAKE_BUILD_TYPE", "CMAKE_CROSSCOMPILING", "CMAKE_C_COMPILER_ID",
    "CMAKE_COMPILER_IS_GNUCC", "CMAKE_COMPILER_IS_GNUCXX", "CMAKE_CXX_COMPILER_ID", "CMAKE_CXX_STANDARD",
    "CMAKE_C_STANDARD", "CMAKE_HOST_APPLE", "CMAKE_HOST_SYSTEM_NAME", "CMAKE_HOST_UNIX", "CMAKE_HOST_WIN32",
    "CMAKE_SYSTEM_NAME", "CYGWIN", "EMSCRIPTEN", "IOS", "LINUX", "MINGW", "MSVC", "QNX", "QNXNTO", "UNIX", "WIN32",
    "XCODE", "CMAKE_SIZEOF_VOID_P", "CMAKE_COMPILER_IS_CLANG", "VXWORKS", "BORLAND", "MSYS", "COVERAGE",
})  # fmt: skip
"""Variables whose value depends on the platform, the compiler or the user."""

UNKNOWN_VARIABLES: Final = frozenset({
    "CMAKE_COMMAND", "CMAKE_CTEST_COMMAND", "CMAKE_CXX_COMPILER", "CMAKE_CXX_COMPILER_VERSION", "CMAKE_CXX_FLAGS",
    "CMAKE_CXX_FLAGS_DEBUG", "CMAKE_CXX_FLAGS_RELEASE", "CMAKE_C_COMPILER", "CMAKE_C_COMPILER_VERSION", "CMAKE_C_FLAGS",
    "CMAKE_EXE_LINKER_FLAGS", "CMAKE_GENERATOR", "CMAKE_HOST_SYSTEM_PROCESSOR", "CMAKE_HOST_SYSTEM_VERSION",
    "CMAKE_INSTALL_RPATH", "CMAKE_LIBRARY_ARCHITECTURE", "CMAKE_MAJOR_VERSION", "CMAKE_MINOR_VERSION",
    "CMAKE_MODULE_PATH", "CMAKE_PATCH_VERSION", "CMAKE_PREFIX_PATH", "CMAKE_ROOT", "CMAKE_SHARED_LINKER_FLAGS",
    "CMAKE_SYSTEM", "CMAKE_SYSTEM_PROCESSOR", "CMAKE_SYSTEM_VERSION", "CMAKE_VERSION", "CMAKE_CXX_BYTE_ORDER",
    "CMAKE_C_BYTE_ORDER", "CMAKE_MAKE_PROGRAM", "CMAKE_PROJECT_VERSION", "CMAKE_CXX_COMPILE_FEATURES",
    "CMAKE_CXX_IMPLICIT_INCLUDE_DIRECTORIES", "CMAKE_CXX_IMPLICIT_LINK_DIRECTORIES", "CMAKE_THREAD_LIBS_INIT",
    "CMAKE_DL_LIBS", "CMAKE_SYSROOT", "CMAKE_TOOLCHAIN_FILE", "PYTHON_EXECUTABLE", "Python3_EXECUTABLE",
    "PYTHON_VERSION_MAJOR", "PYTHON_VERSION_MINOR", "PYTHON_VERSION_STRING",
})  # fmt: skip
"""Variables whose value differs between machines, so that it is unknown."""


class Macro(NamedTuple):
    """A function or macro of a released package, with a definition that is reduced to its effects."""

    package: str
    text: str
    """The CMake code of the definition, from function() or macro() to endfunction() or endmacro()."""


@cache
def macros() -> Mapping[str, Macro]:
    """Return the known functions and macros of released packages, by name in lower case."""
    macros_by_name: dict[str, Macro] = {}
    package = ""
    for match in _PIECE.finditer(_source()):
        if match[4]:
            macros_by_name[match[4].lower()] = Macro(package, match[0])
        else:
            package = match[1]
    return macros_by_name


@cache
def opaque_packages() -> frozenset[str]:
    """Return the released packages (marked OPAQUE) whose CMake code cannot be evaluated, but whose macros are all known."""
    return frozenset([match[1] for match in _PIECE.finditer(_source()) if match[2]])


@cache
def _source() -> str:
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "ros_macros.cmake"), encoding="utf-8") as file:
        return file.read()


# The definitions are not parsed here, because a run needs only few of them.
_PIECE = re.compile(r'^package\("?([^" )\n]*)"?( OPAQUE)?\)$|^(function|macro)\((\w+)[^\n]*\n(?s:.*?)^end\3\(\)$', re.MULTILINE)
