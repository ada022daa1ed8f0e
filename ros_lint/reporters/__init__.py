"""From a report to text. A reporter is a pure function: it reads nothing, prints nothing, and always says the same."""

from __future__ import annotations

import importlib
from collections.abc import Callable

from ros_lint.base.text import Text
from ros_lint.engine.report import Report
from ros_lint.reporters.ansi import Style

Texts = Callable[[str], Text | None]
"""Gives the source of a file, or None when it cannot be read."""
Reporter = Callable[[Report, Texts, Style], str]


def reporter(name: str) -> Reporter:
    """Return the reporter of a format. Raises KeyError for a name that is none of them."""
    if name not in FORMATS:
        raise KeyError(name)
    # Imported by name, for each costs the imports of its own format only.
    module = importlib.import_module(f"{__name__}.{'json_report' if name == 'json' else name}")
    render: Reporter = module.render
    return render


FORMATS = ("text", "concise", "json", "sarif", "github", "gitlab")
