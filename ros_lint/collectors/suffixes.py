"""Suffixes of C++ headers, C++ sources and interface definitions."""

from __future__ import annotations

from typing import Final

HEADERS: Final = (".h", ".hh", ".hpp", ".hxx", ".inl", ".ipp", ".tpp", ".cuh")
SOURCES: Final = (".c", ".cc", ".cpp", ".cxx", ".cu")
INTERFACES: Final = (".msg", ".srv", ".action", ".idl")
