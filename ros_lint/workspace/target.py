"""The distribution that a run checks for, and the inputs that could not be checked."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ros_lint.base.text import Span, file_start
from ros_lint.facts.environment import ROS_2

if TYPE_CHECKING:
    from collections.abc import Mapping


class TargetDistro(NamedTuple):
    """The ROS distribution that the workspace is checked for, or one of several."""

    distro: str
    """Name of the distribution, such as "jazzy"."""
    source: str
    """Origin of the choice for messages, such as ``--distro``."""
    explicit: bool = True
    """False if the distribution is assumed, so that names of other active distributions count as existing."""
    others: tuple[str, ...] = ()
    """The other distributions of the run. A safe fix must be correct in them, too."""

    @property
    def distros(self) -> tuple[str, ...]:
        """All distributions of the run, ``distro`` first."""
        return (self.distro, *self.others)

    @property
    def chosen(self) -> str:
        """The distribution if the user chose it, else ""."""
        return self.distro if self.explicit else ""

    @property
    def context(self) -> Mapping[str, str]:
        """Values, by name, of the variables in conditions of package.xml that are known for the distribution (REP 149)."""
        return {**ROS_2, "ROS_DISTRO": self.distro, "DISABLE_GROUPS_WORKAROUND": "1"}


class NamedDistro(NamedTuple):
    """A distribution that a repository builds for, with the place where a file names it first."""

    distro: str
    """Name of the distribution, such as "jazzy"."""
    path: str
    """Path of the file, relative to the base folder of the run."""
    line: int
    """Line of the file, from 1."""
    indexed: bool = True
    """False if ros-lint has no index of its packages, because the distribution is at its end of life."""


class UnreadFile(NamedTuple):
    """A file or other data that could not be checked."""

    what: str
    """Path of the file, or name of the missing data."""
    reason: str
    """Reason why the input could not be checked, for messages."""
    span: Span | None
    """Place of the file; None for missing data."""

    @classmethod
    def of(cls, path: str, error: OSError) -> UnreadFile:
        """Return the entry for a file or folder that cannot be read.

        ``path`` is relative to the base folder of the run; "" is the base folder.
        """
        return cls(path or ".", error.strerror or str(error), file_start(path))
