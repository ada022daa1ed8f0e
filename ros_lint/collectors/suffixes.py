"""Suffixes of C++ headers, C++ sources and interface definitions."""

from __future__ import annotations

from typing import Final

HEADERS: Final = (".h", ".hh", ".hpp", ".hxx", ".inl", ".ipp", ".tpp", ".cuh")
"""Endings of C and C++ headers."""
SOURCES: Final = (".c", ".cc", ".cpp", ".cxx", ".cu")
"""Endings of C, C++ and CUDA sources."""
INTERFACES: Final = (".msg", ".srv", ".action", ".idl")
"""Endings of definitions of messages, services and actions."""
