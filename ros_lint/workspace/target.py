"""The target distribution of a run, and inputs that could not be checked."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ros_lint.base.text import file_start
from ros_lint.facts.environment import ROS_2

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ros_lint.base.text import Span


class TargetDistro(NamedTuple):
    """The ROS distribution that the workspace is checked for."""

    distro: str
    source: str
    """Where the choice comes from, such as "--distro" or "newest long-term release known"."""
    explicit: bool = True
    """False when nobody chose it: then what only another distribution has is no mistake."""

    @property
    def chosen(self) -> str:
        """The distribution if the user chose it, else ""."""
        return self.distro if self.explicit else ""

    @property
    def context(self) -> Mapping[str, str]:
        """Return the variables of package.xml conditions that are known (REP 149; reference, section A3)."""
        return {**ROS_2, "ROS_DISTRO": self.distro, "DISABLE_GROUPS_WORKAROUND": "1"}


class UnreadFile(NamedTuple):
    """Something that the run could not look at: a file, or a whole class of questions."""

    what: str
    reason: str
    span: Span | None

    @classmethod
    def of(cls, path: str, error: OSError) -> UnreadFile:
        """Return a file or folder that cannot be read. ``path`` is relative to the base, "" is the base."""
        return cls(path or ".", error.strerror or str(error), file_start(path))
