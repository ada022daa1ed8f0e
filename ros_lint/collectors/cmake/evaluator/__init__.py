"""The evaluator of the CMake language: variables, conditions, loops, functions and paths."""
