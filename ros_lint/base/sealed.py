"""Objects that a pickle cannot change."""

from __future__ import annotations

from typing import NoReturn


class Sealed:
    """A base for objects with a ``__dict__`` that the cache gives out: a pickle cannot set their attributes.

    Enumerations need it, because their members are shared by the whole process. A named tuple has no ``__dict__``.
    """

    __slots__ = ()

    def __setstate__(self, state: object) -> NoReturn:
        """Refuse a state: the opcode BUILD of a pickle calls this."""
        raise TypeError(f"{type(self).__name__} takes no state")
