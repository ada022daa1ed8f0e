"""The CMake language: variables, conditions, loops, functions and paths."""
