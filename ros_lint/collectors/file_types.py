"""Which collector reads a file, by its path."""

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
    """Return what a file is taken for by its name, or None for one that no collector reads."""
    name = path.rpartition("/")[2]
    if name == "CMakeLists.txt":
        return "cmake"
    if name == "package.xml":
        return "manifest"  # discovery has read it; here for its comments
    if name in ("setup.cfg", "pyproject.toml"):
        return "config"  # setup.py is evaluated with it; here for its comments, and to say when it cannot be read
    if name == "Cargo.toml":
        return "cargo"
    stem, _, suffix = name.rpartition(".")
    if suffix in ("in", "em") and stem:  # configured by CMake, expanded by empy
        inner = _SUFFIXES.get(stem.rpartition(".")[2])
        return inner if inner in ("cmake", "python") else None
    if name == suffix:  # without a suffix, it may be a program; what lies in resource/ is a marker, what is in capitals a LICENSE
        return None if name.isupper() or path.endswith(f"resource/{name}") else "program"
    return _SUFFIXES.get(suffix) if stem else None
