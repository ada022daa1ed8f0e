"""The effects of CMake commands, one module for each family."""
