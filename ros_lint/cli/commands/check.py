"""``ros-lint [check] PATH...``: check a workspace and print the findings."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

from ros_lint import __version__
from ros_lint.analysis.finding import Severity
from ros_lint.base.recorded_tree import RecordedTree
from ros_lint.base.tree import MachineTree, text_of
from ros_lint.cli.progress import Progress
from ros_lint.cli.session import UsageError, no_packages, open_session, parse_request, report_cache
from ros_lint.engine.report import Report
from ros_lint.errors import UserError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from ros_lint.cli.session import Request
    from ros_lint.cli.settings import Settings
    from ros_lint.engine.baseline import Baseline
    from ros_lint.engine.selection import Selection
    from ros_lint.reporters import Reporter, SourceTexts
    from ros_lint.reporters.ansi import Style


def run(options: Mapping[str, Any]) -> int:
    """Check the requested workspace and print the findings. Returns the exit code."""
    if options.get("version"):
        print(f"ros-lint {__version__}")
        return 0
    progress = Progress(sys.stderr, wanted=options.get("progress", True))
    try:
        with progress:
            request = parse_request(options, os.environ)
            _warn(request.settings.warnings)
            if request.settings["show-settings"]:
                print(request.settings.show(), end="")
                return 0
            if request.settings["statistics"] and request.settings["format"] != "text":
                raise UsageError("--statistics prints text; count the findings of --format json instead")
            known_findings = _baseline(request.settings)
            if request.settings["fix"] or request.settings["diff"]:
                from ros_lint.cli.commands import fix  # noqa: PLC0415

                report, code = fix.run(open_session(request, progress.update), selection_of(request.settings))
            else:
                report, code = _report(request, progress), 0
            if request.settings["write-baseline"]:
                return max(code, _write_baseline(report, request))
            if known_findings is not None:
                path = request.settings["baseline"]
                report = known_findings.hide_known(report, os.path.basename(path), _folders(request, path))
    except UserError as error:
        print(f"ros-lint: {error}", file=sys.stderr)
        return 2
    _warn((*report.warnings, *request.cache.notes, *_single_package_warning(request)))
    if request.settings["diff"]:  # standard output is the patch and nothing else
        return max(code, exit_code(report, request.settings["fail-on"]))
    return max(code, _print(report, request))


def _warn(warnings: Iterable[str]) -> None:
    for warning in warnings:
        print(f"ros-lint: {warning}", file=sys.stderr)


def _baseline(settings: Settings) -> Baseline | None:
    """Return the baseline to apply; None if no file is set, or if the file is to be written.

    Raises BaselineError, and UsageError for conflicting options.
    """
    path, write = settings["baseline"], settings["write-baseline"]
    if write and not path:
        raise UsageError("--write-baseline needs a file: use --baseline FILE, or set baseline in ros-lint.toml")
    if write and settings["diff"]:
        raise UsageError("--write-baseline and --diff cannot be combined, because --diff writes no files")
    if write or not path:
        return None
    from ros_lint.engine import baseline  # noqa: PLC0415

    return baseline.read(path)


def _write_baseline(report: Report, request: Request) -> int:
    """Write the findings to the baseline, unless the run failed. Returns the exit code. Raises BaselineError."""
    from ros_lint.engine import baseline  # noqa: PLC0415

    path = request.settings["baseline"]
    if code := exit_code(report, "never"):
        why = "a rule failed, so its findings are unknown" if report.packages else no_packages(request)
        print(f"ros-lint: {path}: not written: {why.removeprefix('ros-lint: ')}", file=sys.stderr)
        return code
    baseline.write(path, report, _folders(request, path))
    count = len(report.issues)
    print(f"ros-lint: wrote {count} finding{'s' * (count != 1)} to {path}", file=sys.stderr)
    return 0


def _folders(request: Request, path: str) -> list[str]:
    """Return the requested paths, relative to the folder of the file ``path``."""
    folder = os.path.dirname(os.path.realpath(path))
    return [os.path.relpath(os.path.join(request.base, root), folder).replace(os.sep, "/") for root in request.roots]


def _single_package_warning(request: Request) -> Iterator[str]:
    """Yield a warning if a single package of a workspace is checked and no workspace around it is recognized."""
    if request.context or not request.settings["context"]:
        return
    root = os.path.join(request.base, request.roots[0]) if request.roots[0] else request.base
    manifest, repository = (os.path.join(root, name) for name in ("package.xml", ".git"))
    if len(request.roots) > 1 or os.path.exists(repository) or not os.path.isfile(manifest):
        return
    from ros_lint.cli.commands.query import enclosing_workspace  # noqa: PLC0415

    workspace = enclosing_workspace(manifest)
    if workspace != root:
        what, where = os.path.relpath(root, workspace), os.path.relpath(workspace)
        yield f"'{what}' was checked without its sibling packages; run 'ros-lint {where}' for the whole workspace"


def _report(request: Request, progress: Progress) -> Report:
    """Return the report of a run: the cached report if its inputs are unchanged, else a new report."""
    cache = report_cache(request)
    disks = request.disk, MachineTree()
    recorded = [RecordedTree(disk) for disk in disks]
    if cached := cache.fetch(recorded):
        return cached
    session = open_session(request, progress.update, *(recorded if cache else disks))
    from ros_lint.cli.selected_packages import selected_folders  # noqa: PLC0415
    from ros_lint.engine import registry  # noqa: PLC0415
    from ros_lint.engine.check import ReportContext, check  # noqa: PLC0415

    workspaces = session.loader.load_all()
    folders, warnings = selected_folders(request.settings, session.roots, lambda: workspaces)
    rules = registry.load(request.settings["plugins"])
    context = ReportContext(rules, session.knowledge.date, folders, (*session.warnings, *warnings))
    report = check(workspaces, session.loader.suppressions(), selection_of(request.settings), context)
    cache.store(recorded, report)
    return report


def selection_of(settings: Settings) -> Selection:
    """Return the rules and findings that the settings select. Raises SelectionError and PluginError."""
    from ros_lint.engine import registry  # noqa: PLC0415  (not needed for a cached report)
    from ros_lint.engine.selection import select  # noqa: PLC0415

    return select(
        registry.load(settings["plugins"]),
        chosen=settings["select"],
        added=settings["extend-select"],
        ignored=settings["ignore"],
        severities=settings["severity"],
        per_path=settings["per-path-ignores"],
        pedantic=settings["pedantic"],
        min_severity=settings["min-severity"],
    )


def exit_code(report: Report, fail_on: str) -> int:
    """Return 2 if no package was found or a rule crashed, 1 for findings at or above ``fail_on``, else 0.

    ``fail_on`` is a severity or "never".
    """
    if not report.packages or report.crashes:
        return 2
    if fail_on == "never":
        return 0
    return int(any(issue.severity >= Severity[fail_on.upper()] for issue in report.issues))


def _print(report: Report, request: Request) -> int:
    """Print a report or write it to a file. Returns the exit code."""
    settings = request.settings
    render = _reporter(settings)
    texts: SourceTexts = partial(text_of, request.disk)
    shown = report
    if settings["format"] in ("text", "concise"):
        shown, texts = _relative_to_current_folder(request.base, report, texts)
    data = render(shown, texts, _style(settings)).encode("utf-8", "backslashreplace")
    if settings["output"]:
        from ros_lint.engine import edits  # noqa: PLC0415  (few runs write a file)

        try:
            edits.write(settings["output"], data)
        except edits.EditError as error:
            print(f"ros-lint: {error}", file=sys.stderr)
            return 2
    else:
        sys.stdout.buffer.write(data)
        sys.stdout.buffer.flush()
    if not report.packages:
        print(no_packages(request), file=sys.stderr)
    return exit_code(report, settings["fail-on"])


def _relative_to_current_folder(base: str, report: Report, texts: SourceTexts) -> tuple[Report, SourceTexts]:
    """Return the report and the texts of its files with paths relative to the current folder, for terminals and editors.

    If neither the base nor the current folder contains the other, paths stay relative to the base.
    """
    current = os.path.realpath(os.curdir)
    if current == base or os.path.commonpath((base, current)) not in (base, current):
        return report, texts
    from ros_lint.reporters.moved_paths import with_paths  # noqa: PLC0415  (mostly the current folder is the base)

    def relative(path: str, old: str, new: str) -> str:
        return os.path.relpath(os.path.join(old, path), new).replace(os.sep, "/")

    moved = with_paths(report, lambda path: relative(path, base, current))
    return moved, lambda path: texts(relative(path, current, base))


def _reporter(settings: Settings) -> Reporter:
    if settings["statistics"]:
        from ros_lint.reporters import statistics  # noqa: PLC0415

        return statistics.render
    from ros_lint.reporters import reporter  # noqa: PLC0415

    return reporter(settings["format"])


def _style(settings: Settings) -> Style:
    from ros_lint.reporters.ansi import Style  # noqa: PLC0415

    encoding = "utf-8" if settings["output"] else (sys.stdout.encoding or "ascii")
    only_ascii = "utf" not in encoding.lower()
    style = Style(_wants_color(settings), only_ascii, summary=not settings["quiet"])
    if sys.stdout.isatty() and not settings["output"]:
        import shutil  # noqa: PLC0415

        return style._replace(width=max(shutil.get_terminal_size().columns, 60), fixes=True)
    return style


def _wants_color(settings: Settings) -> bool:
    """Return whether to use colours: by the flag, NO_COLOR, FORCE_COLOR, or for a terminal, in this order."""
    if settings["color"] != "auto":
        return bool(settings["color"] == "always")
    if os.environ.get("NO_COLOR"):
        return False
    if os.environ.get("FORCE_COLOR") or os.environ.get("CLICOLOR_FORCE"):
        return not settings["output"]
    return sys.stdout.isatty() and not settings["output"] and os.environ.get("TERM") != "dumb"
