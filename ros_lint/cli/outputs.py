"""Print a report, and write it to files, in the formats that the options select."""

from __future__ import annotations

import os
import re
import sys
from types import MappingProxyType
from typing import TYPE_CHECKING

from ros_lint.base.text import Text, read
from ros_lint.base.tree import text_of
from ros_lint.cli.messages import show
from ros_lint.cli.session import UsageError
from ros_lint.reporters import FORMATS

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ros_lint.cli.session import Request
    from ros_lint.cli.settings import Settings
    from ros_lint.engine.report import Report
    from ros_lint.reporters import Reporter, SourceTexts
    from ros_lint.reporters.ansi import Style

_URL = re.compile(r"(?:https?|file)://[!#-'*-;=?-~]*\{rule\}[!#-'*-;=?-~]*")
"""Pattern of a URL with ``{rule}`` whose characters need no escapes in Markdown, HTML and terminals."""


def validate(settings: Settings) -> None:
    """Raise UsageError if options of the output exclude each other, such as ``--statistics`` and ``--format json``."""
    if settings["statistics"] and settings["format"] != "text":
        raise UsageError("--statistics prints text; count the findings of --format json instead")
    if settings["diff"] and (settings["output"] or settings["format"] != "text"):
        raise UsageError("--diff prints a patch; redirect standard output instead of using --output or --format")
    if settings["since"] and (settings["fix"] or settings["diff"] or settings["write-baseline"]):
        raise UsageError("--since only shows findings; it cannot be combined with --fix, --diff or --write-baseline")
    if settings["rule-url"] and not _URL.fullmatch(settings["rule-url"]):
        origin = settings.origin("rule-url")
        raise UsageError(f"{origin}: rule-url must be a URL with {{rule}}, such as https://example.org/rules/{{rule}}.html")
    if sum(form == "" for form, _ in _files(settings)) > 1:
        raise UsageError("--output: only one file can replace standard output; use FORMAT:FILE for the others")


def _files(settings: Settings) -> list[tuple[str, str]]:
    """Return the format and the path of each file in ``--output``. The format is "" for a file that replaces standard output."""
    pairs = [(value.partition(":"), value) for value in settings["output"] if value]
    return [(form, path) if form in FORMATS and path else ("", value) for (form, _, path), value in pairs]


def print_report(report: Report, request: Request, unsaved: Mapping[str, bytes] = MappingProxyType({})) -> int:
    """Write a report to the files of ``--output``, and print it unless one of these files replaces standard output.

    ``unsaved`` has contents of files, by path, that replace those on disk. Return 2 if a file cannot be written, else 0.
    """
    settings = request.settings

    def render(form: str, style: Style) -> bytes:
        def texts(path: str) -> Text | None:
            return read(path, unsaved[path]) if path in unsaved else text_of(request.disk, path)

        return _render(report, request, form, style, texts)

    report = report._replace(rule_url=settings["rule-url"])
    files = _files(settings)
    code = 0
    for form, path in files:
        code = max(code, _write(path, render(form or settings["format"], _style(settings, path))))
    if all(form for form, _ in files):
        sys.stdout.buffer.write(render(settings["format"], _style(settings)))
        sys.stdout.buffer.flush()
    return code


def _write(path: str, data: bytes) -> int:
    from ros_lint.engine import edits  # noqa: PLC0415  (few runs write a file)

    try:
        edits.write(path, data)
    except edits.EditError as error:
        show(str(error))
        return 2
    return 0


def _render(report: Report, request: Request, form: str, style: Style, texts: SourceTexts) -> bytes:
    shown = report
    if form in ("text", "concise"):
        shown, texts = _relative_to_current_folder(request.base, report, texts)
    return _reporter(form, request.settings)(shown, texts, style).encode("utf-8", "backslashreplace")


def _relative_to_current_folder(base: str, report: Report, texts: SourceTexts) -> tuple[Report, SourceTexts]:
    """Return the report with paths relative to the current folder, and a function that returns the source text of such a path.

    Paths stay relative to ``base`` if neither ``base`` nor the current folder contains the other.
    """
    current = os.path.realpath(os.curdir)
    if current == base or os.path.commonpath((base, current)) not in (base, current):
        return report, texts
    from ros_lint.reporters.moved_paths import with_paths  # noqa: PLC0415  (mostly the current folder is the base)

    def relative(path: str, old: str, new: str) -> str:
        return os.path.relpath(os.path.join(old, path), new).replace(os.sep, "/")

    moved = with_paths(report, lambda path: relative(path, base, current))
    return moved, lambda path: texts(relative(path, current, base))


def _reporter(form: str, settings: Settings) -> Reporter:
    if settings["statistics"] and form == "text":
        from ros_lint.reporters import statistics  # noqa: PLC0415

        return statistics.render
    from ros_lint.reporters import reporter  # noqa: PLC0415

    return reporter(form)


def _style(settings: Settings, path: str = "") -> Style:
    """Return the output style for standard output, or for the file at ``path`` if it is not ""."""
    from ros_lint.reporters.ansi import Style  # noqa: PLC0415

    encoding = "utf-8" if path else (sys.stdout.encoding or "ascii")
    only_ascii = "utf" not in encoding.lower()
    style = Style(_wants_color(settings, path), only_ascii, summary=not settings["quiet"])
    if sys.stdout.isatty() and not path:
        import shutil  # noqa: PLC0415

        return style._replace(width=max(shutil.get_terminal_size().columns, 60), fixes=True, rule_url=_shown_links(settings))
    return style


def _shown_links(settings: Settings) -> str:
    """Return the setting ``rule-url``, or "" if the terminal supports no links."""
    return str(settings["rule-url"]) if os.environ.get("TERM") != "dumb" else ""


def _wants_color(settings: Settings, path: str) -> bool:
    """Return whether to use colours. In this order: ``--color``, NO_COLOR, FORCE_COLOR, whether the output is a terminal."""
    if settings["color"] != "auto":
        return bool(settings["color"] == "always")
    if os.environ.get("NO_COLOR"):
        return False
    if os.environ.get("FORCE_COLOR") or os.environ.get("CLICOLOR_FORCE"):
        return not path
    return sys.stdout.isatty() and not path and os.environ.get("TERM") != "dumb"
