"""FetchContent and ExternalProject: projects from elsewhere that are built along with the package."""

from __future__ import annotations

import re
from typing import Final

from ros_lint.collectors.cmake.evaluator.run import Handler, Run
from ros_lint.collectors.cmake.evaluator.values import HOLE, PREFIX, is_known
from ros_lint.facts.visibility import Facet

_ADDRESS: Final = re.compile(r"(?:/|@|\A)git(?:hub|lab)\.[\w.-]+[/:]([\w.-]+)/([\w.-]+?)(?:\.git)?(?:/|\Z)")
"""Where a project is had from, up to its owner and name."""

_FETCHED: Final = "_deps"
"""The folder that CMake puts what it fetches into, below that of the build."""


def _declare(run: Run, args: list[str]) -> None:
    """``fetchcontent_declare(name options...)``: the address tells what the project is called where it is used."""
    if args and is_known(args[0]):
        run.fetched[args[0].lower()] = _called(args)


def _called(args: list[str]) -> list[str]:
    """Return what a project may be called by those who use it, going by where it is had from."""
    found = (_ADDRESS.search(arg) for arg in args if is_known(arg))
    places = [(place[1], place[2]) for place in found if place]
    return [name for owner, own in places for name in (own, f"{owner}_{own}", f"{owner}/{own}")]


def _add(run: Run, args: list[str]) -> None:
    """``externalproject_add(name options...)``."""
    _from_elsewhere(run, [*args[:1], *_called(args)], args)


def _populate(run: Run, args: list[str]) -> None:
    """``fetchcontent_populate(name options...)``."""
    _fetch(run, args[:1], args)


def _make_available(run: Run, args: list[str]) -> None:
    """``fetchcontent_makeavailable(names...)``."""
    _fetch(run, args, args)


def _fetch(run: Run, given: list[str], args: list[str]) -> None:
    names = [name for name in given if is_known(name)]
    called = [other for name in names for other in run.fetched.get(name.lower(), ())]
    _from_elsewhere(run, [*names, *called], args)
    for name in names:
        run.set(f"{name.lower()}_SOURCE_DIR", HOLE)
        run.set(f"{name.lower()}_BINARY_DIR", HOLE)
        run.set(f"{name.lower()}_POPULATED", "TRUE")


def _from_elsewhere(run: Run, names: list[str], args: list[str]) -> None:
    """Note projects from elsewhere: these know neither lib/<package> nor share/<package> unless they are told."""
    run.open_world = True
    if not run.muted:
        run.bundled.update(dict.fromkeys(names))
    hidden = Facet.USES | Facet.LIBRARIES
    if any(PREFIX in arg or "lib/" in arg or "share/" in arg for arg in args):
        hidden |= Facet.EXECUTABLES | Facet.SHARE
    # It has sources of its own, unless it is told that they are those of the package.
    inside = "" if "SOURCE_DIR" in args else _FETCHED
    run.hide(hidden, "what a project from elsewhere builds and installs is not in sight", inside=inside)


COMMANDS: Final[dict[str, Handler]] = {
    "externalproject_add": _add,
    "fetchcontent_declare": _declare,
    "fetchcontent_makeavailable": _make_available,
    "fetchcontent_populate": _populate,
}
