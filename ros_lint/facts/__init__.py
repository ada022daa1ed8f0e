"""Facts that collectors return, as frozen named tuples.

This package reads no file and looks nothing up.

Facts are named tuples because a large workspace has a hundred thousand of them: they are created, sent between
processes and cached in half the time of frozen dataclasses. The fact cache unpickles only classes of these modules
and the classes that a report is made of.
"""
