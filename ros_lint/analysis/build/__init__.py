"""Questions about build scripts: targets, commands and edits of CMakeLists.txt."""
