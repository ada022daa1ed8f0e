"""Facts that collectors return, as frozen named tuples.

This package reads no file and looks nothing up.

Facts are named tuples because a large workspace has a hundred thousand of them: they are created, sent between
processes and cached in half the time of frozen dataclasses. The cache derives the encoding of a fact from the
annotations of its class (:mod:`ros_lint.base.columns`), so these may name only types that have an encoding.
"""
