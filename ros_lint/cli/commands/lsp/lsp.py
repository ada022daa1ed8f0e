"""``ros-lint lsp``: run the language server on standard input and output."""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Mapping
from typing import Any


def run(options: Mapping[str, Any]) -> int:
    """Serve an editor until it exits.

    Return the exit code: 2 if pygls, the library for the protocol, is not installed, else 0.
    """
    try:
        from ros_lint.cli.commands.lsp.server import create  # noqa: PLC0415  (needs pygls, an optional dependency)
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] not in ("pygls", "lsprotocol"):
            raise
        print("ros-lint: the language server needs pygls; install it with: pip install 'ros-lint[lsp]'", file=sys.stderr)
        return 2
    gc.enable()  # a server runs for hours
    create(options, os.environ).start_io(sys.stdin.buffer, sys.stdout.buffer)
    return 0
