"""``ros-lint [check] PATH...``: check a workspace and print the findings."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ros_lint import __version__
from ros_lint.analysis.finding import Severity
from ros_lint.base.recorded_tree import RecordedTree
from ros_lint.base.tree import MachineTree
from ros_lint.cli import outputs
from ros_lint.cli.messages import show
from ros_lint.cli.progress import Progress
from ros_lint.cli.session import UsageError, no_packages, open_session, parse_request, report_cache
from ros_lint.engine.report import Report
from ros_lint.errors import UserError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from ros_lint.cli.session import Request
    from ros_lint.cli.settings import Settings
    from ros_lint.engine.baseline import Baseline


def run(options: Mapping[str, Any], report_of: Callable[[Request, Progress], Report] | None = None) -> int:
    """Check the requested workspace and print the findings. Return the exit code: 0, 1 or 2, see :func:`exit_code`.

    ``report_of`` checks the workspace; by default a report of the cache is used if its inputs are unchanged.
    """
    if options.get("version"):
        print(f"ros-lint {__version__}")
        return 0
    progress = Progress(sys.stderr, wanted=options.get("progress", True))
    code = 0
    unsaved: Mapping[str, bytes] = {}
    try:
        with progress:
            request = parse_request(_with_place(options), os.environ)
            _warn(request.settings.warnings)
            if request.settings["show-settings"]:
                print(request.settings.show(), end="")
                return 0
            outputs.validate(request.settings)
            if request.settings["watch"]:
                from ros_lint.cli.commands import watch  # noqa: PLC0415

                return watch.run(options, request, run)
            known_findings = _baseline(request.settings)
            if request.settings["stdin-filename"]:
                from ros_lint.cli.commands import stdin_file  # noqa: PLC0415

                report, unsaved = stdin_file.check(request, progress.update)
            elif request.settings["fix"] or request.settings["diff"]:
                from ros_lint.cli.commands import fix  # noqa: PLC0415

                report, code = fix.run(open_session(request, progress.update, again=True))
            else:
                report = (report_of or _report)(request, progress)
            if request.settings["since"]:
                from ros_lint.cli.since import only_new  # noqa: PLC0415

                report = only_new(report, request, os.environ, progress.update)
            if request.settings["write-baseline"]:
                return max(code, _write_baseline(report, request))
            if known_findings is not None:
                path = request.settings["baseline"]
                report = known_findings.hide_known(report, os.path.basename(path), _folders(request, path))
    except UserError as error:
        show(str(error))
        return 2
    _warn((*report.warnings, *request.cache.notes, *_single_package_warning(request)))
    if request.settings["diff"]:  # standard output is the patch and nothing else
        return max(code, exit_code(report, request.settings["fail-on"]))
    if not report.packages:
        show(no_packages(request))
    written = outputs.print_report(report, request, unsaved)
    return max(code, written, exit_code(report, request.settings["fail-on"]))


def _with_place(options: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the options with the place of the file of ``--stdin-filename`` as the only path, if there is such a file."""
    name = str(options.get("stdin-filename") or "")
    return {**options, "paths": [name if os.path.exists(name) else os.path.dirname(name) or "."]} if name else options


def _warn(warnings: Iterable[str]) -> None:
    for warning in warnings:
        show(warning)


def _baseline(settings: Settings) -> Baseline | None:
    """Return the known findings to hide; None if the settings name no baseline file, or if the file is to be written.

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
    """Write the findings to the baseline file, unless the run failed. Return the exit code. Raises BaselineError."""
    from ros_lint.engine import baseline  # noqa: PLC0415

    path = request.settings["baseline"]
    if code := exit_code(report, "never"):
        why = "a rule failed, so its findings are unknown" if report.packages else no_packages(request)
        show(f"{path}: not written: {why}")
        return code
    baseline.write(path, report, _folders(request, path))
    count = len(report.issues)
    show(f"wrote {count} finding{'s' * (count != 1)} to {path}")
    return 0


def _folders(request: Request, path: str) -> list[str]:
    """Return the requested paths, relative to the folder that contains the baseline file at ``path``."""
    folder = os.path.dirname(os.path.realpath(path))
    return [os.path.relpath(os.path.join(request.base, root), folder).replace(os.sep, "/") for root in request.roots]


def _single_package_warning(request: Request) -> Iterator[str]:
    """Yield a warning if a single package of a larger workspace is checked and this workspace was not recognized."""
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
    """Return the report of a run: the cached report if its inputs are unchanged, otherwise a new report."""
    cache = report_cache(request)
    disks = request.disk, MachineTree()
    recorded = [RecordedTree(disk) for disk in disks]
    if cached := cache.fetch(recorded):
        return cached
    # The findings are kept only if the workspace has been checked before, because this makes a run slower.
    kept = cache.findings(recorded[1]) if cache.outdated else None
    session = open_session(request, progress.update, *(recorded if cache else disks), again=kept is not None)
    from ros_lint.cli.checking import check_session  # noqa: PLC0415  (not needed for a cached report)

    report = check_session(session, kept)
    cache.store(recorded, report)
    return report


def exit_code(report: Report, fail_on: str) -> int:
    """Return the exit code: 2 if no package was found or a rule crashed, 1 for findings at or above ``fail_on``, else 0.

    ``fail_on`` is a severity or "never".
    """
    if not report.packages or report.crashes:
        return 2
    if fail_on == "never":
        return 0
    return int(any(issue.severity >= Severity[fail_on.upper()] for issue in report.issues))
