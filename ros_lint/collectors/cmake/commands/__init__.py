"""The effects of CMake commands, one module for each group of commands."""
