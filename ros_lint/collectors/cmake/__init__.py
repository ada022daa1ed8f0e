"""Static analysis of CMakeLists.txt: a parser, an evaluator, and the effects of commands."""
