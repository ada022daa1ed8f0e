"""FetchContent and ExternalProject: external projects that are built together with the package."""

from __future__ import annotations

import re
from typing import Final

from ros_lint.collectors.cmake.evaluator.run import Handler, Run
from ros_lint.collectors.cmake.evaluator.values import HOLE, PREFIX, is_known
from ros_lint.facts.visibility import Facet

_ADDRESS: Final = re.compile(r"(?:/|@|\A)git(?:hub|lab)\.[\w.-]+[/:]([\w.-]+)/([\w.-]+?)(?:\.git)?(?:/|\Z)")
"""Pattern of the address of a repository on GitHub or GitLab. The groups are the owner and the repository name."""

_FETCHED: Final = "_deps"
"""The folder below the build folder into which FetchContent downloads projects."""


def _declare(run: Run, args: list[str]) -> None:
    """Run ``fetchcontent_declare(name options...)``: record a project and its possible names.

    Scripts may also use the project under a name that is derived from the address of its repository.
    """
    if args and is_known(args[0]):
        run.fetched_projects[args[0].lower()] = _names_from_address(args)


def _names_from_address(args: list[str]) -> list[str]:
    """Return the possible names of a project, given arguments with the address of its repository.

    ``https://github.com/owner/repo.git`` -> ``repo``, ``owner_repo``, ``owner/repo``.
    """
    matches = (_ADDRESS.search(arg) for arg in args if is_known(arg))
    places = [(place[1], place[2]) for place in matches if place]
    return [name for owner, repository in places for name in (repository, f"{owner}_{repository}", f"{owner}/{repository}")]


def _add(run: Run, args: list[str]) -> None:
    """Run ``externalproject_add(name options...)``: record an external project that the build builds."""
    _add_external_projects(run, [*args[:1], *_names_from_address(args)], args)


def _populate(run: Run, args: list[str]) -> None:
    """Run ``fetchcontent_populate(name options...)``: record that a project is fetched."""
    _fetch(run, args[:1], args)


def _make_available(run: Run, args: list[str]) -> None:
    """Run ``fetchcontent_makeavailable(names...)``: record that projects are fetched and built."""
    _fetch(run, args, args)


def _fetch(run: Run, projects: list[str], args: list[str]) -> None:
    names = [name for name in projects if is_known(name)]
    aliases = [alias for name in names for alias in run.fetched_projects.get(name.lower(), ())]
    _add_external_projects(run, [*names, *aliases], args)
    for name in names:
        run.set(f"{name.lower()}_SOURCE_DIR", HOLE)
        run.set(f"{name.lower()}_BINARY_DIR", HOLE)
        run.set(f"{name.lower()}_POPULATED", "TRUE")


def _add_external_projects(run: Run, names: list[str], args: list[str]) -> None:
    """Record external projects, whose targets and files are unknown.

    External projects install to lib/<package> or share/<package> only if an argument of the command contains such a folder.
    """
    run.open_world = True
    if not run.muted:
        run.results.bundled_projects.update(dict.fromkeys(names))
    hidden = Facet.USES | Facet.LIBRARIES
    if any(PREFIX in arg or "lib/" in arg or "share/" in arg for arg in args):
        hidden |= Facet.EXECUTABLES | Facet.SHARE
    # The project has its own sources, unless SOURCE_DIR is a folder of the package.
    inside = "" if "SOURCE_DIR" in args else _FETCHED
    run.hide(hidden, "the targets and files of an external project are unknown", inside=inside)


COMMANDS: Final[dict[str, Handler]] = {
    "externalproject_add": _add,
    "fetchcontent_declare": _declare,
    "fetchcontent_makeavailable": _make_available,
    "fetchcontent_populate": _populate,
}
