"""Edits of setup.py that keep its style: elements added to lists that are written out."""

from __future__ import annotations

import posixpath
from collections.abc import Sequence

from ros_lint.facts.build import BuildScript
from ros_lint.facts.setup_py import Slot
from ros_lint.rule import Edit


def slot(script: BuildScript, option: str) -> Slot | None:
    """Return the list of an option, None when it is not written out or is empty."""
    return next((found for found in script.slots if found.option == option and found.size), None)


def add(place: Slot, element: str) -> Edit:
    """Add an element after the last one: on a line of its own if that has one, and with a comma if that has one."""
    gap = " " if place.indent is None else f"\n{place.indent}"
    return Edit(place.end, f"{gap}{element}," if place.comma else f",{gap}{element}")


def files(place: Slot, package: str, paths: Sequence[str], others: Sequence[str]) -> str:
    """Return an element of data_files that installs files of one folder under the same folder of the share directory.

    They are globbed by their ending, if setup.py globs and no other file of the folder, among ``others``, has it.
    """
    folder = posixpath.dirname(paths[0])
    target = joined(place, package, "share/", f"/{folder}" if folder else "")
    ending = _ending(paths)
    pattern = posixpath.join(folder, f"*{ending}")
    alike = [other for other in others if posixpath.dirname(other) == folder and other.endswith(ending)]
    if place.glob and ending and sorted(alike) == sorted(paths):
        return f"({target}, {place.glob}('{pattern}'))"
    return f"({target}, [{', '.join(repr(path) for path in paths)}])"


def _ending(paths: Sequence[str]) -> str:
    """Return what the names end with, from a dot on: as much as they share, "" if that is nothing."""
    names = [posixpath.basename(path) for path in paths]
    shared = posixpath.commonprefix([name[::-1] for name in names])[::-1] if len(names) > 1 else names[0][1:]
    return shared[shared.find(".") :] if "." in shared else ""


def joined(place: Slot, package: str, before: str, after: str = "") -> str:
    """Return an expression for a text with the name of the package in it, by the variable that holds it if there is one."""
    if not place.variable:
        return f"'{before}{package}{after}'"
    return " + ".join(part for part in (f"'{before}'" if before else "", place.variable, f"'{after}'" if after else "") if part)
