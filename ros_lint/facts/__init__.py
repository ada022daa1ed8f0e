"""The types of the facts that collectors extract from files, as named tuples.

The modules of this package read no file and look up no name.

A large workspace has a hundred thousand facts. Named tuples are created, sent between processes and cached in half the
time of frozen dataclasses. The cache derives the encoding of a fact from the annotations of its class
(:mod:`ros_lint.base.columns`), so the annotations may use only types that have an encoding.
"""
