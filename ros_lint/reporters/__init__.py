"""Output formats. A reporter is a pure function from a report to text: it reads and prints nothing."""

from __future__ import annotations

import importlib
from collections.abc import Callable

from ros_lint.base.text import Text
from ros_lint.engine.report import Report
from ros_lint.reporters.ansi import Style

Texts = Callable[[str], Text | None]
"""A function that returns the source of a file, or None if it cannot be read."""
Reporter = Callable[[Report, Texts, Style], str]


def reporter(name: str) -> Reporter:
    """Return the reporter of a format. Raises KeyError for an unknown name."""
    if name not in FORMATS:
        raise KeyError(name)
    # Imported by name, so that only the imports of this format are loaded.
    module = importlib.import_module(f"{__name__}.{'json_report' if name == 'json' else name}")
    render: Reporter = module.render
    return render


FORMATS = ("text", "concise", "json", "sarif", "github", "gitlab")
