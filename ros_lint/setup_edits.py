"""Edits of setup.py and setup.cfg that keep their style: elements added to lists that are written out, options."""

from __future__ import annotations

import posixpath
from collections.abc import Sequence

from ros_lint.facts.build import BuildScript
from ros_lint.facts.setup_py import Slot
from ros_lint.rule import Edit
from ros_lint.text import Span


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


_FOLDERS = (("develop", "script_dir"), ("install", "install_scripts"))
"""What setup.cfg says of where programs go: with links to the sources, and without."""


def program_folders(script: BuildScript) -> dict[str, Span]:
    """Return the places where setup.cfg says where programs go, by section and option as ``install.install_scripts``."""
    wanted = {f"{section}.{option}" for section, option in _FOLDERS}
    return {text.text: text.span for text in script.texts if text.kind == "option" and text.text in wanted}


def programs_to(script: BuildScript, package: str) -> tuple[Edit, ...]:
    """Add to a setup.cfg what it lacks so that programs go to ``lib/<package>``, and change what it says else.

    Nothing where there is none.
    """
    headers = {text.text: text.span for text in script.texts if text.kind == "section"}
    end = headers.get("")
    if end is None:
        return ()
    values = program_folders(script)
    place = f"$base/lib/{package}"
    edits: list[Edit] = []
    rest = ""
    for section, option in _FOLDERS:
        value, header = values.get(f"{section}.{option}"), headers.get(section)
        if value is not None:
            edits.append(Edit(value, place))
        elif header == end:
            rest = f"\n{option}={place}{rest}"
        elif header is not None:
            edits.append(Edit(header, f"\n{option}={place}"))
        else:
            rest += f"\n[{section}]\n{option}={place}"
    return (*edits, Edit(end, rest)) if rest else tuple(edits)
