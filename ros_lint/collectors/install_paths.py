"""Where packages are installed, as text that a launch file can compute with.

The prefix of a package is not known before it is installed. While a launch file is read, an absolute path that no file
system has stands for it, so that joining, splitting and formatting work as they do when it runs. One character stands
for any text that is not known.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

UNKNOWN = "\ue000"
OWN_FOLDER = "/\ue002"
"""The folder of the launch file itself, which is one place in the source and another one where it is installed."""

_ROOT = "\ue001"

# A path ends where a command line or a list of paths goes on; an unknown piece belongs to it.
_PREFIX = re.compile(rf"/{_ROOT}([^/\s]*)((?:/[^/\s'\":;,]*)*)")


class Installed(NamedTuple):
    """A place in the install space of a package."""

    package: str
    path: str
    """Relative to the prefix of the package, such as ``share/<package>/launch/a.launch.py``."""

    @property
    def known(self) -> bool:
        """Whether the package is known."""
        return bool(self.package) and UNKNOWN not in self.package

    @property
    def share(self) -> str | None:
        """The path below share/<package>, "" for the folder itself; None when it is elsewhere or not known whole."""
        folder = f"share/{self.package}"
        if UNKNOWN in self.path or not (self.path == folder or self.path.startswith(folder + "/")):
            return None
        return self.path[len(folder) + 1 :]

    @property
    def executable(self) -> str:
        """The name directly in lib/<package>, "" when the path is no such thing."""
        folder, _, name = self.path.rpartition("/")
        return name if folder == f"lib/{self.package}" and UNKNOWN not in name else ""


def prefix(package: str) -> str:
    """Return the path that stands for the install prefix of a package."""
    return f"/{_ROOT}{package}"


def share(package: str) -> str:
    """Return the path that stands for the share folder of a package."""
    return f"/{_ROOT}{package}/share/{package}"


def installed(text: str) -> Iterator[Installed]:
    """Yield the install places that a text mentions: one path, or several in a command line."""
    if _ROOT not in text:
        return
    for match in _PREFIX.finditer(text):
        parts: list[str] = []
        for part in match[2].split("/"):
            if part == ".." and parts:
                parts.pop()
            elif part not in ("", ".", ".."):
                parts.append(part)
        yield Installed(match[1], "/".join(parts))
