"""Print messages to standard error."""

from __future__ import annotations

import sys

from ros_lint.reporters.ansi import harmless


def show(message: str) -> None:
    """Print a message of ros-lint to standard error, with escapes for characters that control a terminal."""
    print(f"ros-lint: {harmless(message)}", file=sys.stderr)
