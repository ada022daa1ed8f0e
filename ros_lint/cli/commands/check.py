"""``ros-lint [check] PATH...``: check a workspace and print the findings."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

from ros_lint import __version__
from ros_lint.analysis.finding import Severity
from ros_lint.base.tree import Machine, RecordedTree, text_of
from ros_lint.cli import session as opening
from ros_lint.cli.progress import Progress
from ros_lint.engine.report import Report
from ros_lint.errors import UserError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from ros_lint.cli.session import Request
    from ros_lint.cli.settings import Settings
    from ros_lint.engine.baseline import Baseline
    from ros_lint.engine.selection import Selection
    from ros_lint.reporters.ansi import Style

Said = Mapping[str, Any]


def run(options: Said) -> int:
    """Check the requested workspace, print the findings, return the exit code."""
    if options.get("version"):
        print(f"ros-lint {__version__}")
        return 0
    progress = Progress(sys.stderr, wanted=options.get("progress", True))
    try:
        with progress:
            request = opening.parse_request(options, os.environ)
            _warn(request.settings.warnings)
            if request.settings["show-settings"]:
                print(request.settings.show(), end="")
                return 0
            known = _known(request.settings)
            if request.settings["fix"] or request.settings["diff"]:
                from ros_lint.cli.commands import fix  # noqa: PLC0415

                report, code = fix.run(opening.open_session(request, progress.tell), _selection(request.settings))
            else:
                report, code = _checked(request, progress), 0
            if request.settings["write-baseline"]:
                return max(code, _keep(report, request))
            if known is not None:
                path = request.settings["baseline"]
                report = known.hide_known(report, os.path.basename(path), _folders(request, path))
    except UserError as error:
        print(f"ros-lint: {error}", file=sys.stderr)
        return 2
    _warn((*report.warnings, *_alone(request)))
    if request.settings["diff"]:  # standard output is the patch and nothing else
        return max(code, exit_code(report, request.settings["fail-on"]))
    return max(code, _print(report, request))


def _warn(warnings: Iterable[str]) -> None:
    for warning in warnings:
        print(f"ros-lint: {warning}", file=sys.stderr)


def _known(settings: Settings) -> Baseline | None:
    """Return the baseline, or None if there is none.

    Raises BaselineError, and UsageError for conflicting options.
    """
    path, write = settings["baseline"], settings["write-baseline"]
    if write and not path:
        raise opening.UsageError("--write-baseline needs a file: use --baseline FILE, or set baseline in ros-lint.toml")
    if write and settings["diff"]:
        raise opening.UsageError("--write-baseline and --diff cannot be combined, because --diff writes no files")
    if write or not path:
        return None
    from ros_lint.engine import baseline  # noqa: PLC0415

    return baseline.read(path)


def _keep(report: Report, request: Request) -> int:
    """Write the findings to the baseline, unless the report is incomplete. Raises BaselineError."""
    from ros_lint.engine import baseline  # noqa: PLC0415

    path = request.settings["baseline"]
    if code := exit_code(report, "never"):
        why = "a rule failed, so its findings are unknown" if report.packages else opening.no_packages(request)
        print(f"ros-lint: {path}: not written: {why.removeprefix('ros-lint: ')}", file=sys.stderr)
        return code
    baseline.write(path, report, _folders(request, path))
    count = len(report.issues)
    print(f"ros-lint: wrote {count} finding{'s' * (count != 1)} to {path}", file=sys.stderr)
    return 0


def _folders(request: Request, path: str) -> list[str]:
    """Return the requested paths, relative to the folder of a file."""
    folder = os.path.dirname(os.path.realpath(path))
    return [os.path.relpath(os.path.join(request.base, root), folder).replace(os.sep, "/") for root in request.roots]


def _alone(request: Request) -> Iterator[str]:
    """Yield a warning if a single package of a workspace is checked: its siblings are unknown then."""
    root = os.path.join(request.base, request.roots[0]) if request.roots[0] else request.base
    manifest, repository = (os.path.join(root, name) for name in ("package.xml", ".git"))
    if len(request.roots) > 1 or os.path.exists(repository) or not os.path.isfile(manifest):
        return
    from ros_lint.cli.commands.query import enclosing_workspace  # noqa: PLC0415

    around = enclosing_workspace(manifest)
    if around != root:
        what, where = os.path.relpath(root, around), os.path.relpath(around)
        yield f"'{what}' was checked without its sibling packages; run 'ros-lint {where}' for the whole workspace"


def _checked(request: Request, progress: Progress) -> Report:
    """Return the report of a run, or the cached one if nothing that it depends on has changed."""
    reports = opening.reports(request)
    disks = request.disk, Machine()
    recorded = [RecordedTree(disk) for disk in disks]
    if kept := reports.fetch(recorded):
        return kept
    session = opening.open_session(request, progress.tell, *(recorded if reports else disks))
    from ros_lint.engine import registry  # noqa: PLC0415
    from ros_lint.engine.check import ReportContext, check  # noqa: PLC0415

    context = ReportContext(registry.load(request.settings["plugins"]), session.knowledge.date, session.folder, session.warnings)
    workspace = session.loader.load()
    report = check(workspace, session.loader.suppressions(), _selection(request.settings), context)
    reports.store(recorded, report)
    return report


def _selection(settings: Settings) -> Selection:
    """Return the rules that the settings select. Raises SelectionError and PluginError."""
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
    )


def exit_code(report: Report, fail_on: str) -> int:
    """Return 2 if the run was incomplete, 1 for findings at or above ``fail_on``, else 0."""
    if not report.packages or report.crashes:
        return 2
    if fail_on == "never":
        return 0
    return int(any(issue.severity >= Severity[fail_on.upper()] for issue in report.issues))


def _print(report: Report, request: Request) -> int:
    from ros_lint import reporters  # noqa: PLC0415

    settings = request.settings
    render = reporters.reporter(settings["format"])
    data = render(report, partial(text_of, request.disk), _style(settings)).encode("utf-8", "backslashreplace")
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
        print(opening.no_packages(request), file=sys.stderr)
    return exit_code(report, settings["fail-on"])


def _style(settings: Settings) -> Style:
    from ros_lint.reporters.ansi import Style  # noqa: PLC0415

    encoding = "utf-8" if settings["output"] else (sys.stdout.encoding or "ascii")
    only_ascii = "utf" not in encoding.lower()
    if sys.stdout.isatty() and not settings["output"]:
        import shutil  # noqa: PLC0415

        return Style(_wants_color(settings), only_ascii, max(shutil.get_terminal_size().columns, 60), fixes=True)
    return Style(_wants_color(settings), only_ascii)


def _wants_color(settings: Settings) -> bool:
    """Return whether to use colours: by the flag, NO_COLOR, FORCE_COLOR, or for a terminal, in this order."""
    if settings["color"] != "auto":
        return bool(settings["color"] == "always")
    if os.environ.get("NO_COLOR"):
        return False
    if os.environ.get("FORCE_COLOR") or os.environ.get("CLICOLOR_FORCE"):
        return not settings["output"]
    return sys.stdout.isatty() and not settings["output"] and os.environ.get("TERM") != "dumb"
