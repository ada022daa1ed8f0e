"""The target distribution of a run, and inputs that could not be checked."""

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
    """Origin of the choice, such as ``--distro``, for messages."""
    explicit: bool = True
    """False if the distribution is assumed: then names of other active distributions count as existing."""
    others: tuple[str, ...] = ()
    """The other distributions of a run for several. A safe fix has to hold in them, too."""

    @property
    def distros(self) -> tuple[str, ...]:
        """All distributions of the run, this one first."""
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
    """A distribution that a repository builds for, with the first place that names it."""

    distro: str
    """Name of the distribution, such as "jazzy"."""
    path: str
    """Path of the file, relative to the base."""
    line: int
    """Line of the file, from 1."""
    indexed: bool = True
    """False if the distribution is at its end of life and has no package index."""


class UnreadFile(NamedTuple):
    """An input that could not be checked. ``what`` is the path of a file, or another description."""

    what: str
    """Path of the file, or name of the missing data."""
    reason: str
    """Reason, for messages."""
    span: Span | None
    """Place of the file; None for missing data."""

    @classmethod
    def of(cls, path: str, error: OSError) -> UnreadFile:
        """Return a file or folder that cannot be read. ``path`` is relative to the base, "" is the base."""
        return cls(path or ".", error.strerror or str(error), file_start(path))
