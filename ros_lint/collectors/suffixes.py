"""What a file is by the end of its name."""

from __future__ import annotations

from typing import Final

HEADERS: Final = (".h", ".hh", ".hpp", ".hxx", ".inl", ".ipp", ".tpp", ".cuh")
SOURCES: Final = (".c", ".cc", ".cpp", ".cxx", ".cu")
INTERFACES: Final = (".msg", ".srv", ".action", ".idl")
