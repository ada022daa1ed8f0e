"""Reads the tables of a ``pyproject.toml``."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ros_lint.base.text import Text


def tables(source: Text) -> Mapping[str, Any]:
    """Return the tables of a TOML file, {} if the file is not valid TOML or is nested too deeply."""
    if sys.version_info >= (3, 11):
        import tomllib  # noqa: PLC0415  (few packages have such a file)
    else:
        import tomli as tomllib  # noqa: PLC0415
    try:
        return tomllib.loads(source.text)
    except (ValueError, RecursionError):
        return {}


def table(content: Any, *keys: str) -> Mapping[str, Any]:
    """Return the table below nested keys, such as ``[tool.black]`` for the keys "tool", "black"; {} if there is no such table."""
    for key in keys:
        content = content.get(key) if isinstance(content, dict) else None
    return content if isinstance(content, dict) else {}
