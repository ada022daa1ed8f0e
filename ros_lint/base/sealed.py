"""Objects that a pickle cannot change."""

from __future__ import annotations

from typing import NoReturn


class Sealed:
    """Base class of cached objects with a ``__dict__``: a pickle cannot set their attributes.

    Enumerations need it, because their members are shared by the whole process. Named tuples do not need it, because
    they have no ``__dict__``.
    """

    __slots__ = ()

    def __setstate__(self, state: object) -> NoReturn:
        """Raise TypeError. The opcode BUILD of a pickle calls this method to set the attributes of the object."""
        raise TypeError(f"{type(self).__name__} takes no state")
