"""Output formats. A reporter is a pure function from a report to text: it reads and prints nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Callable

    from ros_lint.base.text import Text
    from ros_lint.engine.report import Report
    from ros_lint.reporters.ansi import Style

SourceTexts: TypeAlias = "Callable[[str], Text | None]"
"""A function from the path of a file to its text, or to None if it cannot be read."""
Reporter: TypeAlias = "Callable[[Report, SourceTexts, Style], str]"
"""A function from a report to its text in one format."""


def reporter(name: str) -> Reporter:
    """Return the reporter of a format. Raises KeyError for an unknown name."""
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
