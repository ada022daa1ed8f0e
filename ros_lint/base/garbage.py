"""Python's garbage collection around large models: without care it traverses all of their objects again and again."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def paused() -> Iterator[None]:
    """Pause the search for cyclic garbage, for a computation that keeps most of what it creates."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()


def keep_objects() -> None:
    """Free cyclic garbage, and leave all objects that exist now out of later searches, until :func:`release_objects`."""
    gc.collect()
    gc.freeze()


def release_objects() -> None:
    """Include all objects in later searches for garbage again."""
    gc.unfreeze()
