"""Entry points of a setup.py."""

from __future__ import annotations

import re

from ros_lint.facts.setup_py import EntryPoint

_TARGET = re.compile(r"\s*([\w.]+)\s*(?::\s*([\w.]+)\s*)?(?:\[.*\])?\s*\Z")


def entry_point_target(entry: EntryPoint) -> tuple[str, str | None] | None:
    """Return the module and the function that an entry point names: ``pkg.node:main`` -> ``("pkg.node", "main")``.

    The function is None if the target is only a module. The result is None if the target is invalid.
    """
    match = _TARGET.match(entry.target)
    return (match[1], match[2]) if match else None
