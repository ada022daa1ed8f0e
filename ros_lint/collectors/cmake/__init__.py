"""CMakeLists.txt: syntax, evaluation and the effects of commands."""
