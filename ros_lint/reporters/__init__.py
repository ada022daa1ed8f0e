"""Output formats. Each is a function that converts a report to text, and that reads no file and prints nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Callable

    from ros_lint.base.text import Text
    from ros_lint.engine.report import Report
    from ros_lint.reporters.ansi import Style

SourceTexts: TypeAlias = "Callable[[str], Text | None]"
"""A function that returns the text of a file by its path, None if the file cannot be read."""
Reporter: TypeAlias = "Callable[[Report, SourceTexts, Style], str]"
"""A function that returns a report as text in one format, given the texts of sources and the style."""


def reporter(name: str) -> Reporter:
    """Return the function that writes the format ``name``. Raises KeyError for an unknown format."""
    if name not in FORMATS:
        raise KeyError(name)
    import importlib  # noqa: PLC0415  (the options of the command line need only the names of formats)

    # The module is imported by its name, so that only this format is loaded.
    module = importlib.import_module(f"{__name__}.{'json_report' if name == 'json' else name}")
    render: Reporter = module.render
    return render


FORMATS = (
    "text", "concise", "json", "jsonl", "sarif", "github", "gitlab", "azure", "junit", "checkstyle", "rdjson", "markdown", "html",
)  # fmt: skip
