"""Analyses of build scripts for rules: targets, commands and edits of CMakeLists.txt."""
