"""Edits of setup.py and setup.cfg that keep their style: elements added to lists that are written out, options."""

from __future__ import annotations

import posixpath
from collections.abc import Iterable, Sequence

from ros_lint.base.edit import Edit
from ros_lint.base.text import Span, file_start
from ros_lint.facts.build import BuildScript
from ros_lint.facts.setup_py import EditableList


def slot(script: BuildScript, option: str) -> EditableList | None:
    """Return the list of an option, None when it is not written out or is empty."""
    return next((found for found in script.editable_lists if found.option == option and found.size), None)


def add(to: EditableList, element: str) -> Edit:
    """Add an element after the last one: on a line of its own if that has one, and with a comma if that has one."""
    gap = " " if to.indent is None else f"\n{to.indent}"
    return Edit(to.end, f"{gap}{element}," if to.comma else f",{gap}{element}")


def place(script: BuildScript) -> Span:
    """Return where a build script says what is installed: where a rule can be added, or else where it names the package."""
    found = slot(script, "data_files")
    return script.insertion or (found.end if found else script.name_span) or file_start(script.path)


def add_files(to: EditableList, package: str, paths: Iterable[str], others: Sequence[str]) -> Edit:
    """Add to data_files what installs files of the package under their folders in the share directory.

    Those of a folder are globbed if setup.py globs: by their ending, unless another file of the folder, among ``others``, has
    it, or all of them, where it has no folder in it, which data_files do not take. What lies beside setup.py is listed.
    """
    by_folder: dict[str, list[str]] = {}
    for path in sorted(paths):
        by_folder.setdefault(posixpath.dirname(path), []).append(path)
    gap = " " if to.indent is None else f"\n{to.indent}"
    return add(to, f",{gap}".join(_files(to, package, inner, others) for inner in by_folder.values()))


def _files(to: EditableList, package: str, paths: Sequence[str], others: Sequence[str]) -> str:
    folder = posixpath.dirname(paths[0])
    target = joined(to, package, "share/", f"/{folder}" if folder else "")
    ending = _ending(paths)
    inside = [other for other in others if other.startswith(f"{folder}/")]
    files = [other for other in inside if posixpath.dirname(other) == folder]
    alike = [other for other in files if other.endswith(ending)]
    if to.glob and folder and (ending or inside == files) and sorted(alike) == sorted(paths):
        return f"({target}, {to.glob}({quoted(to, f'{folder}/*{ending}')}))"
    return f"({target}, [{', '.join(quoted(to, path) for path in paths)}])"


def _ending(paths: Sequence[str]) -> str:
    """Return what the names end with, from a dot on: as much as they share, "" if that is nothing."""
    names = [posixpath.basename(path) for path in paths]
    shared = posixpath.commonprefix([name[::-1] for name in names])[::-1] if len(names) > 1 else names[0][1:]
    return shared[shared.find(".") :] if "." in shared else ""


def joined(to: EditableList, package: str, before: str, after: str = "") -> str:
    """Return an expression for a text with the name of the package in it, by the variable that holds it if there is one.

    It is put together as others in the list are. Slashes stand between what goes before, the name, and what comes after.
    """
    name = to.variable
    if to.joins not in ("", "f") and "/" in before + after:
        parts = (*before.split("/"), package, *after.split("/"))
        return f"{to.joins}({', '.join(name if name and part == package else quoted(to, part) for part in parts if part)})"
    if not name:
        return quoted(to, f"{before}{package}{after}")
    if to.joins == "f":
        return f"f{quoted(to, f'{before}{{{name}}}{after}')}"
    return " + ".join(part for part in (quoted(to, before) if before else "", name, quoted(to, after) if after else "") if part)


def quoted(to: EditableList, text: str) -> str:
    """Return a text as Python writes it, with the quotes of the list."""
    plain = repr(text)
    return plain if to.quote in plain[1:-1] or "\\" in plain else f"{to.quote}{text}{to.quote}"


_FOLDERS = (("develop", "script_dir"), ("install", "install_scripts"))
"""What setup.cfg says of where programs go: with links to the sources, and without."""


def program_folders(script: BuildScript) -> dict[str, Span]:
    """Return the places where setup.cfg says where programs go, by section and option as ``install.install_scripts``."""
    wanted = {f"{section}.{option}" for section, option in _FOLDERS}
    return {text.text: text.span for text in script.editable_texts if text.kind == "option" and text.text in wanted}


def config(place: Span, package: str) -> Edit:
    """Write a setup.cfg where there is none, so that programs go to ``lib/<package>``."""
    return Edit(place, "".join(f"[{section}]\n{option}=$base/lib/{package}\n" for section, option in _FOLDERS))


def programs_to(script: BuildScript, package: str) -> tuple[Edit, ...]:
    """Add to a setup.cfg what it lacks so that programs go to ``lib/<package>``, and change what it says else.

    Nothing where there is none.
    """
    headers = {text.text: text.span for text in script.editable_texts if text.kind == "section"}
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
