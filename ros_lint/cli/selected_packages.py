"""The options that select packages of a workspace by name: ``--packages-select`` and the others."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from ros_lint.base.paths import is_below_any
from ros_lint.base.suggestions import did_you_mean, similar_names
from ros_lint.cli.session import UsageError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ros_lint.analysis.graph.package_selection import PackageSelection
    from ros_lint.cli.settings import Settings
    from ros_lint.workspace.model import Workspace


def selected_folders(
    settings: Settings, roots: Sequence[str], load: Callable[[], Sequence[Workspace]]
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the folders whose findings are reported, and warnings.

    The folders are those of the selected packages below ``roots``; if no option selects packages, they are ``roots``. A
    package with an unusable manifest has unknown dependencies, so it is selected only if an option names it. ``load``
    returns the workspace once for each distribution; it is called only if an option selects packages. Raises UsageError
    for an unknown package, and if no package is selected.
    """
    names = tuple(f"packages-{word}" for word in ("select", "up-to", "above", "select-regex", "skip"))
    if not any(settings[name] for name in names):
        return tuple(roots), ()
    from ros_lint.analysis.graph.dependency_graph import dependency_graph  # noqa: PLC0415  (few runs select packages)
    from ros_lint.analysis.graph.package_selection import PackageSelection  # noqa: PLC0415

    selection = PackageSelection(*[settings[name] for name in names])
    _check_patterns(selection)
    workspaces = load()
    unusable = {package.name: package.path for workspace in workspaces for package in workspace.unusable}
    known = {name for workspace in workspaces for name in dependency_graph(workspace).names} | unusable.keys()
    for option, name in selection.named():
        if name not in known:
            raise UsageError(f"--{option}: {_unknown(name, known)}")
    warnings = tuple(f"--packages-skip: {_unknown(name, known)}" for name in selection.skip if name not in known)
    paths = [
        package.path
        for workspace in workspaces
        for name in sorted(selection.names(dependency_graph(workspace)))
        for package in dependency_graph(workspace).places[name]
    ]
    paths += [unusable[name] for _, name in selection.named() if name in unusable and name not in selection.skip]
    folders = [path for path in dict.fromkeys(paths) if is_below_any(path, roots)]
    if not folders:
        raise UsageError(f"no package below {', '.join(root or '.' for root in roots)} is selected by the options --packages-...")
    return tuple(folders), warnings


def _unknown(name: str, known: set[str]) -> str:
    return f"there is no package '{name}'{did_you_mean(similar_names(name, known))}"


def _check_patterns(selection: PackageSelection) -> None:
    for pattern in selection.select_regex:
        try:
            re.compile(pattern)
        except re.error as error:
            raise UsageError(f"--packages-select-regex: '{pattern}' is not a regular expression: {error}") from error
