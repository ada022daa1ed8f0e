"""The entry points in a setup.py, e.g. ``talker = my_package.talker:main``."""

from __future__ import annotations

import re

from ros_lint.facts.setup_py import EntryPoint

_TARGET = re.compile(r"\s*([\w.]+)\s*(?::\s*([\w.]+)\s*)?(?:\[.*\])?\s*\Z")


def entry_point_target(entry: EntryPoint) -> tuple[str, str | None] | None:
    """Return the module and the function of an entry point: ``pkg.node:main`` -> ``("pkg.node", "main")``.

    The function is None if the entry point has only a module. The result is None if the entry point is invalid.
    """
    match = _TARGET.match(entry.target)
    return (match[1], match[2]) if match else None
