"""Fuzzing of ros-lint: a run that must not crash, hang, fill the memory, give two answers or damage a file.

    python -m tests.fuzz --minutes 30 [--target T] [--seeds FOLDER]

* ``seeds`` are whole workspaces: the cases of the rules, and packages of a folder of real files.
* ``mutate`` changes bytes, lines and words of a file; ``trees`` changes names and kinds of files.
* ``targets`` say which files of a workspace are changed: one target for each format, and one for the whole run.
* ``hostile`` has inputs that were written by hand: deep nesting, long words, bombs of many formats.
* ``oracle`` checks a run, ``server`` runs it in a process of its own, ``campaign`` feeds two servers and compares them.
"""
