"""Check a workspace with the selected rules, and return a report."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, TypeVar

from ros_lint import __version__
from ros_lint.base.paths import is_below_any
from ros_lint.engine.parallel import run_in_processes
from ros_lint.engine.registry import plugin_of
from ros_lint.engine.report import OFF, BlindSpot, HiddenCount, Report
from ros_lint.engine.run import find_issues
from ros_lint.engine.selection import Selection, show
from ros_lint.facts.repositories import UnclonedRepositories
from ros_lint.knowledge.spelling import package_name

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from ros_lint.analysis.rule import Rule
    from ros_lint.facts.suppressions import Suppression
    from ros_lint.workspace.model import Package, Workspace

T = TypeVar("T")


class ReportContext(NamedTuple):
    """Data about a run that its report contains, and the rules that suppression comments may name."""

    rules: tuple[Rule, ...]
    """All rules, including those that are not selected."""
    data_date: str
    """The date of the package index, as YYYY-MM-DD."""
    folders: tuple[str, ...]
    """The folders whose findings are reported, relative to the base folder of the run; "" is the base folder itself.

    Packages outside these folders are only read, because the findings can depend on them.
    """
    warnings: tuple[str, ...]
    """Warnings about the command line and the settings."""
    jobs: int = 1
    """The number of processes that run rules, at most one for each core; 0 means that it depends on the number of packages."""


def check(
    workspaces: Sequence[Workspace], suppressions: Iterable[Suppression], selection: Selection, context: ReportContext
) -> Report:
    """Return the report of the selected rules, with suppression comments and settings applied.

    ``workspaces`` has the workspace once for each distribution of the run. Their findings, and their places that could
    not be analysed, are combined.
    """
    suppressions = tuple(suppressions)
    run_in_processes(workspaces, (*selection.rules, *selection.off), context.folders, context.jobs)
    checked = find_issues(workspaces, selection.rules, suppressions, context.rules, context.folders)
    shown, hidden = show(checked.issues, selection)
    of_others = find_issues(workspaces, selection.off, suppressions, context.rules, context.folders).issues
    if off := [issue for issue in of_others if not selection.ignores_path(issue) and selection.is_severe(issue)]:
        hidden = (*hidden, HiddenCount.of(OFF, off))
    if checked.suppressed:
        hidden = (*hidden, HiddenCount("suppressed by comments", len(checked.suppressed)))
    packages = [
        package for workspace in workspaces for package in workspace.packages if is_below_any(package.path, context.folders)
    ]
    manifests = [package for workspace in workspaces for package in (*workspace.packages, *workspace.unusable)]
    checked_manifests = [package for package in manifests if is_below_any(package.path, context.folders)]
    paths = {package.path for package in manifests}
    checked_packages = len({package.path for package in checked_manifests})
    return Report(
        issues=shown,
        rules=selection.rules,
        packages=checked_packages,
        context_packages=len(paths) - checked_packages,
        target=workspaces[0].target,
        named_distros=() if workspaces[0].target.explicit else workspaces[0].named_distros,
        data_date=context.data_date,
        version=__version__,
        hidden=hidden,
        not_checked=_union(workspace.not_checked for workspace in workspaces),
        not_cloned=_union(_not_cloned(workspace) for workspace in workspaces),
        blind_spots=_blind_spots(packages),
        ros1=_union([[_name(package) for package in packages if package.is_ros1]]),
        crashes=tuple([crash._replace(plugin=plugin_of(crash.rule)) for crash in checked.crashes]),
        workspace=context.folders[0] if len(context.folders) == 1 else "",
        warnings=context.warnings,
        package_names=tuple(sorted({package.name or package.path for package in checked_manifests})),
    )


def _union(parts: Iterable[Iterable[T]]) -> tuple[T, ...]:
    """Return the members of the collections ``parts`` in order, without duplicates."""
    return tuple(dict.fromkeys([member for part in parts for member in part]))


def _not_cloned(workspace: Workspace) -> Iterator[UnclonedRepositories]:
    """Yield for each list, such as a .repos file, the repositories in the list that are not in the workspace.

    Repositories with the name of a known package are left out.
    """
    world = workspace.world
    for path, names in world.awaited.lists:
        if unknown := [name for name in names if not world.is_package(package_name(name))]:
            yield UnclonedRepositories(path, tuple(unknown))


def _blind_spots(packages: Sequence[Package]) -> tuple[BlindSpot, ...]:
    from ros_lint.facts.visibility import Facet  # noqa: PLC0415

    words = {
        Facet.USES: "used dependencies",
        Facet.EXECUTABLES: "executables",
        Facet.SHARE: "installed share files",
        Facet.PYTHON: "Python modules",
        Facet.LIBRARIES: "libraries",
        Facet.INTERFACES: "interfaces",
        Facet.COMPONENTS: "components",
        Facet.EXPORTS: "exported dependencies",
    }
    names_by_word = {
        word: _union([[_name(package) for package in packages if package.hidden(facet) and not package.is_ros1]])
        for facet, word in words.items()
    }
    return tuple(BlindSpot(word, packages) for word, packages in names_by_word.items() if packages)


def _name(package: Package) -> str:
    """Return the name of a package, or its path if the manifest has no name."""
    return package.name or package.path
