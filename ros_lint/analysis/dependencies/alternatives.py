"""Alternative packages that provide the same header or CMake name: a library, its vendor package, packages that depend on it."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from ros_lint.knowledge.closure import Closure
from ros_lint.knowledge.spelling import is_part, is_vendor
from ros_lint.workspace.model import Workspace


def stands_for(name: str, best: str, closure_of: Callable[[tuple[str, ...]], Closure]) -> bool:
    """Return whether a dependency on ``name`` can replace one on ``best``, the best provider of a header or CMake name.

    The result is True for ``best`` itself, for an alternative that does not depend on ``best``, for a vendor package of ``best``,
    and for a library of which ``best`` is a part. It is False for a package that only depends on ``best``, e.g. for
    ``cv_bridge`` if ``best`` is the rosdep key of OpenCV.
    """
    return name == best or best not in closure_of((name,)) or is_vendor(name, best) or is_part(best, name)


def standing_for_first(workspace: Workspace, providers: Sequence[str]) -> tuple[str, ...]:
    """Return the members of ``providers`` that can replace its first, best member; see :func:`stands_for`."""
    return tuple([name for name in providers if stands_for(name, providers[0], workspace.world.closure)])
