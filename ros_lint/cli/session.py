"""Open a workspace: from the options of the command line to a loader of the workspace."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from ros_lint.base.suggestions import and_list, did_you_mean, similar_names
from ros_lint.base.tracked_tree import TrackedTree
from ros_lint.base.tree import DiskTree, repository_of
from ros_lint.cli.context import context_of, requested_folder
from ros_lint.cli.options import COMMANDS, OPTIONS
from ros_lint.cli.patterns import Excluder
from ros_lint.cli.settings import Settings, settle
from ros_lint.engine.registry import BUILTIN
from ros_lint.engine.report_cache import ReportCache
from ros_lint.errors import UserError
from ros_lint.knowledge import Knowledge, distros, newest_lts
from ros_lint.knowledge.store import user_directory
from ros_lint.workspace.cache.file import NO_CACHE, CacheFile, files_below
from ros_lint.workspace.cache.folder import folder as cache_folder
from ros_lint.workspace.target import TargetDistro

if TYPE_CHECKING:
    from ros_lint.base.git_index import Tracked
    from ros_lint.base.tree import Tree
    from ros_lint.knowledge.underlays import Underlay
    from ros_lint.workspace.join import Progress
    from ros_lint.workspace.loader import Loader


class UsageError(UserError):
    """A request of the user is invalid. The message names the problem and a remedy."""


class Request(NamedTuple):
    """The validated options: the workspace to check and the settings. No file of the workspace has been read yet."""

    settings: Settings
    base: str
    """Absolute folder to which paths in the output are relative: the root of the git repository, or else the workspace."""
    roots: tuple[str, ...]
    """The requested folders, relative to ``base``. The packages in them are checked."""
    context: tuple[str, ...]
    """Folders, relative to ``base``, whose further packages are read as well; () if only the requested ones are read."""
    inside: tuple[str, ...]
    """Absolute folders into which symbolic links in the workspace may lead: the repository, or the requested paths."""
    tracked: Tracked | None
    """The files that git tracks, if all other files are ignored; None if all files are read."""
    targets: tuple[TargetDistro, ...]
    """The distributions to check for, at least one."""
    places: tuple[str, ...]
    """Folders with data about released packages, which override the shipped data."""
    cache: CacheFile
    """The file with cached results of the workspace."""
    warnings: tuple[str, ...]
    """Warnings about the settings."""

    @property
    def disk(self) -> DiskTree:
        """The files of the workspace on disk."""
        return TrackedTree(self.base, self.inside, self.tracked) if self.tracked else DiskTree(self.base, self.inside)


class Session(NamedTuple):
    """A loader of the requested workspace, with the data that a command needs."""

    loader: Loader
    settings: Settings
    knowledge: Knowledge
    """The data about released packages of the first distribution."""
    base: str
    """Absolute folder to which paths in the output are relative, as in :class:`Request`."""
    roots: tuple[str, ...]
    """The requested folders, relative to ``base``, as in :class:`Request`."""
    warnings: tuple[str, ...]
    cache: CacheFile
    """The file with cached results of the workspace, as in :class:`Request`."""
    excluder: Excluder
    """The patterns of paths not to read."""


def open_workspace(options: Mapping[str, Any], environment: Mapping[str, str], progress: Progress) -> Session:
    """Return a session for the requested workspace and one distribution. The workspace is not loaded yet.

    If a configuration file lists several distributions, the first one is used, with a warning. ``options`` is the result
    of :func:`ros_lint.cli.arguments.parse`. ``progress`` is called with the name of a step and two numbers, see
    :meth:`ros_lint.cli.progress.Progress.update`. Raises UsageError, ConfigError and KnowledgeError.
    """
    request = parse_request(options, environment, with_context=False)
    return open_session(_for_one_distro(request), progress)


def _for_one_distro(request: Request) -> Request:
    """Return the request for its first distribution only. Raises UsageError if the command line names several."""
    first, *others = request.targets
    if not others:
        return request
    named = and_list(first.distros)
    if first.source == "--distro":
        raise UsageError(f"--distro: this command answers for one distribution, not for {named}; use --distro {first.distro}")
    warning = f"{first.source}: distro lists {named}; the answer is for {first.distro} (set with --distro)"
    return request._replace(targets=(first._replace(others=()),), warnings=(*request.warnings, warning))


def parse_request(options: Mapping[str, Any], environment: Mapping[str, str], *, with_context: bool = True) -> Request:
    """Return the request that the options of the command line make. Raises UsageError and ConfigError.

    If ``with_context`` is False, only the requested folders are read, without the packages around them.
    """
    paths = list(dict.fromkeys(_requested_folder(written) for written in options.get("paths") or ["."]))
    places = (user_directory(environment),)
    given = {name: value for name, value in options.items() if name != "paths"}
    around = list(dict.fromkeys(context_of(path) if with_context and given.get("context", True) else path for path in paths))
    base = _base(around)
    settings = settle(given, os.path.commonpath(paths), environment, base)
    inside = (base,) if repository_of(base) else tuple(repository_of(path) or path for path in around)
    targets = _targets(settings, places)
    return Request(
        settings,
        base,
        _relative(paths, base),
        _relative(around, base) if around != paths else (),
        inside,
        _tracked(base, environment),
        targets,
        places,
        CacheFile(cache_folder(environment) if settings["cache"] else "", base),
        (),
    )


def _tracked(base: str, environment: Mapping[str, str]) -> Tracked | None:
    """Return the files that git tracks in the repository at ``base`` if pre-commit is running, else None.

    pre-commit checks the files of a commit, and untracked files are not part of a commit.
    """
    if environment.get("PRE_COMMIT") != "1" or repository_of(base) != base:
        return None
    from ros_lint.base.git_index import read_index  # noqa: PLC0415  (for pre-commit only)

    return read_index(base, environment)


def _requested_folder(written: str) -> str:
    """Return the absolute folder to check for a path on the command line. Raises UsageError if there is none."""
    path = os.path.realpath(written)
    if not os.path.exists(path):
        raise UsageError(f"{written}: no such file or directory{_command(written)}")
    if folder := requested_folder(path):
        return folder
    raise UsageError(f"{written}: not a directory and not in a package; pass a workspace, a package or a file of a package")


def _relative(paths: Iterable[str], base: str) -> tuple[str, ...]:
    return tuple("" if path == base else os.path.relpath(path, base).replace(os.sep, "/") for path in paths)


def open_session(
    request: Request, progress: Progress, workspace: Tree | None = None, machine: Tree | None = None, *, again: bool = False
) -> Session:
    """Return a session for a request.

    ``workspace`` and ``machine`` replace the files of the workspace and of the machine on disk. ``again`` is True if the loader
    will load the workspace several times. Raises UsageError and KnowledgeError.
    """
    # Not needed for a cached report.
    from ros_lint.workspace.cache.facts import FactCache  # noqa: PLC0415
    from ros_lint.workspace.loader import Loader  # noqa: PLC0415
    from ros_lint.workspace.state import DistroData  # noqa: PLC0415

    settings, base = request.settings, request.base
    knowledge = Knowledge(request.targets[0].distro, request.places)
    underlays, unread = _underlays(settings, request.targets[0].distro, base, machine)
    others = [
        DistroData(target, knowledge.of(target.distro), _underlays(settings, target.distro, base, machine)[0])
        for target in request.targets[1:]
    ]
    excluder = Excluder(settings["exclude"])
    loader = Loader(
        workspace or request.disk,
        request.roots,
        request.targets[0],
        context=request.context,
        underlays=underlays,
        knowledge=knowledge,
        others=others,
        exclude=excluder,
        jobs=settings["jobs"],
        cache=FactCache(request.cache, () if request.inside == (request.base,) else request.inside),
        progress=progress,
        again=again,
    )
    return Session(loader, settings, knowledge, base, request.roots, (*request.warnings, *unread), request.cache, excluder)


_WITHOUT_EFFECT = frozenset((
    "baseline", "cache", "color", "config", "diff", "fail-on", "fix", "format", "isolated", "jobs", "output", "progress",
    "fix-only", "quiet", "rule-url", "show-fixes", "show-settings", "since", "statistics", "stdin-filename", "unsafe-fixes",
    "watch", "write-baseline",
))  # fmt: skip
"""Settings that do not affect a report. Of ``config``, the path does not; the settings in the file are compared themselves."""


_LIBRARIES = ("libcst", "networkx", "yaml")
"""Libraries with which ros-lint reads files of a workspace. Another version of a library invalidates the cache of reports."""


def report_cache(request: Request) -> ReportCache:
    """Return the cache of the reports for a request.

    If plugins are enabled, reports are not cached, because a change in the files of a plugin would not be noticed.
    """
    settings = request.settings
    if not request.cache or settings["plugins"]:
        return ReportCache(NO_CACHE, "", ())
    from importlib.util import find_spec  # noqa: PLC0415

    values = [(option.name, settings[option.name]) for option in OPTIONS if option.name not in _WITHOUT_EFFECT]
    rules = find_spec(BUILTIN)
    folders = [*(rules.submodule_search_locations or () if rules else ()), *request.places]
    libraries = [spec.origin or "" for name in _LIBRARIES if (spec := find_spec(name))]
    data = [*libraries, *(file for folder in folders for file in files_below(folder))]
    prefixes = [os.path.abspath(prefix) for prefix in settings["underlay"] if prefix]
    request_key = repr(
        (request.roots, request.context, request.inside, request.targets, values, prefixes, settings.origin("underlay"))
    )
    if request.tracked:
        request_key += repr([sorted(paths) for paths in request.tracked])
    return ReportCache(request.cache, request_key, data)


def _underlays(settings: Settings, distro: str, base: str, machine: Tree | None) -> tuple[tuple[Underlay, ...], tuple[str, ...]]:
    """Return the underlays and warnings. An invalid prefix in AMENT_PREFIX_PATH results only in a warning.

    Raises UsageError for an invalid prefix on the command line or in the configuration file.
    """
    prefixes = [prefix for prefix in settings["underlay"] if prefix]
    if not prefixes:
        return (), ()
    from ros_lint.knowledge import underlays  # noqa: PLC0415

    if settings.origin("underlay") != "AMENT_PREFIX_PATH":
        try:
            return underlays.read(prefixes, distro, machine=machine), ()
        except underlays.UnderlayError as error:
            raise UsageError(str(error)) from error
    result: list[Underlay] = []
    warnings: list[str] = []
    for prefix in prefixes:
        try:
            result += underlays.read([prefix], distro, base, machine)
        except underlays.UnderlayError as error:
            warnings.append(f"AMENT_PREFIX_PATH: {error}")
    return tuple(result), tuple(warnings)


def no_packages(request: Request | Session) -> str:
    """Return the error message for a workspace without packages. It lists the folders that were skipped."""
    from ros_lint.workspace.discovery.discover import discover  # noqa: PLC0415  (not needed for a cached report)

    places = ", ".join(root or request.base for root in request.roots)
    folders = discover(DiskTree(request.base), request.roots, {}).skipped
    skipped = [f"{folder.path or '.'} ({folder.reason})" for folder in folders]
    if not skipped:
        return f"no package found below {places}; is there a package.xml?"
    remaining = f" and {len(skipped) - _MOST_SKIPPED} more" if len(skipped) > _MOST_SKIPPED else ""
    listed = ", ".join(skipped[:_MOST_SKIPPED])
    nothing = f"no package found below {places}; skipped: {listed}{remaining}"
    return f"{nothing}; to check a skipped folder, pass its path"


_MOST_SKIPPED = 3


def _command(written: str) -> str:
    """Return the suggestion of a command for a path that does not exist: "; did you mean the command 'why'?"; "" if none fits."""
    return next((f"; did you mean the command '{command}'?" for command in similar_names(written, COMMANDS)), "")


def _base(paths: Sequence[str]) -> str:
    """Return the root of the git repository that contains the paths, or else the deepest folder that contains all of them.

    Paths in the output are relative to the repository, as in code review, in whatever folder ros-lint is called.
    """
    common = os.path.commonpath(paths)
    return repository_of(common) or common


def _targets(settings: Settings, places: Sequence[str]) -> tuple[TargetDistro, ...]:
    """Return the distributions to check for. Raises UsageError for a distribution without data."""
    names = list(dict.fromkeys(name for name in settings["distro"] if name))
    origin = settings.origin("distro")
    if not names:
        return (TargetDistro(newest_lts(places), "newest LTS", explicit=False),)
    available = [distro.name for distro in distros(places)]
    if unknown := next((name for name in names if name not in available), ""):
        remedy = "; pass --distro" if origin == "ROS_DISTRO" else ""
        raise UsageError(f"{settings.place('distro', unknown)}: {_unknown_distro(unknown, available)}{remedy}")
    return tuple([TargetDistro(name, origin, others=tuple(other for other in names if other != name)) for name in names])


def _unknown_distro(name: str, available: Sequence[str]) -> str:
    from ros_lint.knowledge.names import has_ended  # noqa: PLC0415

    kind, hint = ("end-of-life", "") if has_ended(name) else ("unknown", did_you_mean(similar_names(name, available)))
    return f"{kind} distribution '{name}'{hint} (available: {', '.join(available)})"
