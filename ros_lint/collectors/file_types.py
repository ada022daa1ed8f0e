"""The choice of the collector that reads a file, by the path of the file."""

from __future__ import annotations

from typing import Literal

Kind = Literal[
    "manifest",
    "config",
    "cpp",
    "python",
    "program",
    "cmake",
    "interface",
    "xml",
    "yaml",
    "resource",
    "java",
    "rust",
    "cargo",
    "matlab",
]


_SUFFIXES: dict[str, Kind] = {"py": "python", "cmake": "cmake", "java": "java", "rs": "rust", "m": "matlab"}


def kind_of(path: str) -> Kind | None:
    """Return the kind of collector that reads a file: ``src/a.cpp`` -> "cpp", ``a/package.xml`` -> "manifest"; else None."""
    name = path.rpartition("/")[2]
    if name == "CMakeLists.txt":
        return "cmake"
    if name == "package.xml":
        return "manifest"  # read by discovery; listed here for its comments
    if name in ("setup.cfg", "pyproject.toml"):
        return "config"  # evaluated together with setup.py; listed here for its comments, and to report that it is unreadable
    if name == "Cargo.toml":
        return "cargo"
    stem, _, suffix = name.rpartition(".")
    if suffix in ("in", "em") and stem:  # configured by CMake, expanded by empy
        inner = _SUFFIXES.get(stem.rpartition(".")[2])
        return inner if inner in ("cmake", "python") else None
    if name == suffix:  # may be a program, except for markers in resource/ and names in capitals such as LICENSE
        return None if name.isupper() or path.endswith(f"resource/{name}") else "program"
    return _SUFFIXES.get(suffix) if stem else None
