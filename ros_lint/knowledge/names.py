"""Map the names of Python modules, headers and CMake packages to ROS packages and rosdep keys that provide them.

Each look-up returns the names of providers, best first. The maps are not specific to a distribution. The caller must
check which of the names exist in its distribution, and whether a name is a package or a key (docs/knowledge.md).
"""

from __future__ import annotations

import fnmatch
import re
from functools import cached_property
from typing import TYPE_CHECKING

from ros_lint.knowledge.builtin import CMAKE_MODULES, CXX_HEADERS, PYTHON_MODULES, SYSTEM_HEADER_FOLDERS
from ros_lint.knowledge.spelling import VENDOR

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ros_lint.knowledge.store import Store, Table

NOTHING_NEEDED = "-"
"""Value in a map for a name that the tool chain provides, so that no package has to be declared."""

END_OF_LIFE: Mapping[str, str] = {
    "i": "ROS 2 Iron",
    "g": "ROS 2 Galactic",
    "f": "ROS 2 Foxy",
    "e": "ROS 2 Eloquent",
    "d": "ROS 2 Dashing",
    "c": "ROS 2 Crystal",
    "N": "ROS 1 Noetic",
    "M": "ROS 1 Melodic",
    "K": "ROS 1 Kinetic",
}
"""Names of the distributions at their end of life, by their letter in the data files.

ROS 2 is before ROS 1, each newest first.
"""


def has_ended(distro: str) -> bool:
    """Return whether a distribution, such as "foxy", is at its end of life."""
    return any(name.endswith(f" {distro.capitalize()}") for name in END_OF_LIFE.values())


_COMMON_WORDS = frozenset({
    "lib", "dev", "python", "python3", "pip", "all", "core", "cpp", "data", "json", "tools", "xml", "yaml",
})  # fmt: skip
"""Words in the names of rosdep keys that do not identify a library."""

_EVERYDAY_WORDS = frozenset({"scripts", "controller", "vehicle"})
"""Top-level Python modules of released packages whose names are also usual names of folders."""

_MACRO_ALTERNATIVES: Mapping[str, tuple[str, ...]] = {
    "rosidl_default_generators": ("rosidl_default_generators", "rosidl_core_generators", "rosidl_cmake"),
}
"""For a package, the alternative packages that provide the same CMake macros.

Packages that rosidl_default_generators depends on use rosidl_core_generators, and tests of single generators use
rosidl_cmake.
"""


class Names:
    """The maps from names of modules, headers and CMake packages.

    Each look-up raises KnowledgeError if a data file is damaged.
    """

    def __init__(self, store: Store) -> None:
        self._store = store
        self._doubtful: dict[str, frozenset[str]] = {}
        self._traceless: dict[str, bool] = {}

    def cmake(self, name: str) -> tuple[str, ...]:
        """Return the ROS packages and rosdep keys with another name that provide ``name``, the argument of find_package().

        It is enough to declare one of them. ``("-",)`` means that a module of CMake has this name, so no package is
        needed.
        """
        providers = (*self._cmake_ros.get(name, ()), *self._cmake_system.get(name, ()))
        return providers or ((NOTHING_NEEDED,) if name in CMAKE_MODULES else ())

    def alternatives(self, package: str) -> tuple[str, ...]:
        """Return the packages and keys that provide the same CMake package or macros as ``package``, including ``package``.

        Example: a vendor package and the rosdep key of the library.
        """
        return self._alternatives.get(package, (package,))

    def exports_targets(self, package: str) -> bool:
        """Return whether a released package is known to export its libraries in the CMake variable ``<package>_TARGETS``."""
        return package in self._targets

    def is_cmake_usually_declared(self, name: str) -> bool:
        """Return whether packages that call find_package(name) usually declare one of the results of :meth:`cmake`."""
        return name not in self._doubtful_names("cmake_system.tsv")

    def is_header_usually_declared(self, path: str) -> bool:
        """Return whether packages that include a header usually declare one of the results of :meth:`header`."""
        ros, doubtful = self._include_ros, self._doubtful_names("include_system.tsv")
        for prefix in _prefixes(path):
            if prefix in ros or prefix in self._include_system:
                return prefix in ros or prefix not in doubtful
        return False

    def cmake_any_case(self, name: str) -> tuple[str, ...]:
        """Return the rosdep keys for an argument of find_package() with wrong capitals, such as opencv for OpenCV."""
        return self._cmake_lower.get(name.lower(), ())

    def header(self, path: str) -> tuple[str, ...]:
        """Return the ROS packages and rosdep keys that provide a header, from the longest matching path prefix in the maps.

        It is enough to declare one of them. ``path`` is the text between the brackets of #include. ``("-",)`` means that
        the tool chain provides the header.
        """
        if path in CXX_HEADERS or path.partition("/")[0] in SYSTEM_HEADER_FOLDERS:
            return (NOTHING_NEEDED,)
        if path.partition("/")[0] in self._mapped_folders:
            ros, system = self._include_ros, self._include_system
            for prefix in _prefixes(path):
                if prefix in ros or prefix in system:
                    return (*ros.get(prefix, ()), *system.get(prefix, ()))
        if "/" not in path and path.endswith(".h"):
            for prefix in sorted(self._file_prefixes, reverse=True):
                if path.startswith(prefix):
                    return self._file_prefixes[prefix]
        return ()

    def folder(self, name: str) -> tuple[str, ...]:
        """Return the rosdep keys of the library whose headers are in the folder ``name``, such as opencv2; best first.

        Return () if packages that include such headers rarely declare the keys (:meth:`is_header_usually_declared`).
        """
        prefix = f"{name}/"
        return () if prefix in self._doubtful_names("include_system.tsv") else self._include_system.get(prefix, ())

    def maps(self, folder: str) -> bool:
        """Return whether headers below a folder may belong to the tool chain or to a package with another name."""
        return folder in self._mapped_folders or folder in SYSTEM_HEADER_FOLDERS or folder in self._shared_folders

    def shares(self, folder: str) -> bool:
        """Return whether several packages install headers below a folder, so that the folder does not identify a package."""
        return folder in self._shared_folders

    def module(self, module: str) -> tuple[str, ...]:
        """Return the rosdep keys that provide a Python module, best first; ``("-",)`` for a module of the standard library.

        ``module`` may be dotted. A key is returned if the name of its system package fits, if packages that import the
        module declare the key, or if it was entered manually, but not if only data from nixpkgs name it.
        """
        top, _, rest = module.partition(".")
        if top in PYTHON_MODULES:
            return (NOTHING_NEEDED,)
        second = rest.partition(".")[0]
        keys = self._py_import.get(f"{top}.{second}", ()) if second else ()
        return keys or self._py_import.get(top, ())

    def module_packages(self, module: str, distro: str) -> tuple[str, ...]:
        """Return the ROS packages of a distribution that provide a Python module and have another name than the module."""
        top = module.partition(".")[0]
        if top in _EVERYDAY_WORDS:
            return ()
        return tuple(package for package, distros in self._py_ros.get(top, ()) if distro in distros)

    def successor(self, name: str) -> str:
        """Return the package that replaces a package of ROS 1 or of a former ROS 2 distribution, "" if there is none."""
        return self._successors.get(name, "")

    def end_of_life(self, name: str) -> tuple[str, ...]:
        """Return the distributions at their end of life that contain a package, newest first.

        The result is () for a package of an active distribution.
        """
        row = self._end_of_life.row(name)
        letters = row[1] if row and len(row) > 1 else ""
        return tuple(distro for letter, distro in END_OF_LIFE.items() if letter in letters)

    def called(self, key: str) -> tuple[str, ...]:
        """Return words for a search: every source that uses the library of a rosdep key contains at least one of them.

        These are the words in the name of the key, in lower case, and the names of its headers, modules and CMake
        packages.
        """
        parts = re.findall(r"[a-z0-9]+", key.lower())
        words = [part.removeprefix("lib") for part in parts if part not in _COMMON_WORDS and not part.isdigit()]
        return tuple(dict.fromkeys([*words, *self._called.get(key, ())])) or (key,)

    @cached_property
    def _called(self) -> Mapping[str, list[str]]:
        names_of: dict[str, list[str]] = {}
        for names in (self._cmake_system, self._include_system, self._py_import):
            for name, keys in names.items():
                for key in keys:
                    names_of.setdefault(key, []).append(name.rstrip("*/"))
        return names_of

    def provided_keys(self, key: str) -> tuple[str, ...]:
        """Return the rosdep keys whose system packages are installed together with that of ``key``, as its dependencies."""
        return self._provided_keys.get(key, ())

    def leaves_no_trace(self, package: str) -> bool:
        """Return whether the use of a package leaves no trace in the sources of its dependents, judging by the package name."""
        matches = self._traceless.get(package)
        if matches is None:
            matches = self._traceless[package] = self._traceless_pattern.match(package) is not None
        return matches

    def provides_macros(self, package: str) -> bool:
        """Return whether a package provides CMake macros whose use is not recognized, judging by the package name."""
        return self._macros_pattern.match(package) is not None

    @cached_property
    def _traceless_pattern(self) -> re.Pattern[str]:
        return re.compile("|".join(fnmatch.translate(pattern) for pattern, _ in self._rows("unseen.tsv")))

    @cached_property
    def _macros_pattern(self) -> re.Pattern[str]:
        rows = self._rows("unseen.tsv")
        return re.compile("|".join(fnmatch.translate(pattern) for pattern, why in rows if why.endswith("provides CMake macros")))

    @cached_property
    def _targets(self) -> frozenset[str]:
        return frozenset([name for name, _ in self._rows("cmake_targets.tsv")])

    @cached_property
    def _cmake_ros(self) -> Mapping[str, tuple[str, ...]]:
        return self._map("cmake_ros.tsv")

    @cached_property
    def _cmake_system(self) -> Mapping[str, tuple[str, ...]]:
        return self._map("cmake_system.tsv")

    @cached_property
    def _alternatives(self) -> Mapping[str, tuple[str, ...]]:
        result: dict[str, tuple[str, ...]] = {}
        for names in self._cmake_system.values():
            for name in names:
                if name.endswith(VENDOR):
                    result.setdefault(name, names)
        return {**result, **_MACRO_ALTERNATIVES}

    @cached_property
    def _cmake_lower(self) -> Mapping[str, tuple[str, ...]]:
        return {name.lower(): names for name, names in self._cmake_system.items() if names != (NOTHING_NEEDED,)}

    @cached_property
    def _include_ros(self) -> Mapping[str, tuple[str, ...]]:
        # A file without a folder, such as ros_utils.h, may belong to any package.
        return {prefix: names for prefix, names in self._map("include_ros.tsv").items() if "/" in prefix}

    @cached_property
    def _include_system(self) -> Mapping[str, tuple[str, ...]]:
        return self._map("include_system.tsv")

    @cached_property
    def _file_prefixes(self) -> Mapping[str, tuple[str, ...]]:
        return {name.partition("*")[0]: keys for name, keys in self._include_system.items() if "*" in name}

    @cached_property
    def _mapped_folders(self) -> frozenset[str]:
        """First parts of the header paths in the maps: ``a`` for a/b.h, and ``a.h`` for a.h."""
        return frozenset([prefix.partition("/")[0] for names in (self._include_ros, self._include_system) for prefix in names])

    @cached_property
    def _shared_folders(self) -> frozenset[str]:
        return frozenset(
            prefix.partition("/")[0]
            for prefix, packages in self._include_ros.items()
            if prefix.count("/") > prefix.endswith("/") and prefix.partition("/")[0] not in packages
        )

    @cached_property
    def _provided_keys(self) -> Mapping[str, tuple[str, ...]]:
        return self._map("key_brings.tsv")

    @cached_property
    def _py_import(self) -> Mapping[str, tuple[str, ...]]:
        keys_of = {}
        for module, value in self._rows("py_import.tsv"):
            keys = (entry.partition(":") for entry in value.split())
            keys_of[module] = tuple(key for key, _, evidence in keys if evidence != "X")
        return keys_of

    @cached_property
    def _py_ros(self) -> Mapping[str, tuple[tuple[str, frozenset[str]], ...]]:
        packages_of: dict[str, tuple[tuple[str, frozenset[str]], ...]] = {}
        for line in self._store.lines("py_ros.tsv")[1]:
            module, package, distros = (*line.split("\t"), "", "")[:3]
            packages_of[module] = (*packages_of.get(module, ()), (package, frozenset(distros.split())))
        return packages_of

    @cached_property
    def _successors(self) -> Mapping[str, str]:
        return dict(self._rows("successors.tsv"))

    @cached_property
    def _end_of_life(self) -> Table:
        return self._store.table("eol_names.tsv")[1]

    def _doubtful_names(self, file: str) -> frozenset[str]:
        """Return the names in a map file whose providers are uncertain.

        The providers of such a name were entered manually, or the packages that use the name rarely declare them.
        """
        doubtful = self._doubtful.get(file)
        if doubtful is None:
            rows = (line.split("\t") for line in self._store.lines(file)[1])
            doubtful = self._doubtful[file] = frozenset(row[0] for row in rows if row[-1] not in ("high", "medium"))
        return doubtful

    def _map(self, file: str) -> Mapping[str, tuple[str, ...]]:
        return {name: tuple(value.split()) for name, value in self._rows(file)}

    def _rows(self, file: str) -> list[tuple[str, str]]:
        rows = []
        for line in self._store.lines(file)[1]:
            name, _, rest = line.partition("\t")
            rows.append((name, rest.partition("\t")[0]))
        return rows


def _prefixes(path: str) -> list[str]:
    """Return the prefixes of a header path that a map may contain, longest first: a/b/c.h, a/b/, a/b, a/, a."""
    prefixes = [path]
    at = len(path)
    while (at := path.rfind("/", 0, at)) > 0:
        prefixes += [path[: at + 1], path[:at]]
    return prefixes
