"""Edits of setup.py and setup.cfg in the style of the file: elements of list literals, and options."""

from __future__ import annotations

import posixpath
from collections.abc import Iterable, Sequence

from ros_lint.base.edit import Edit
from ros_lint.base.text import Span, file_start
from ros_lint.facts.build import BuildScript
from ros_lint.facts.setup_py import EditableList


def slot(script: BuildScript, option: str) -> EditableList | None:
    """Return the list of an option, None if it is no list literal or is empty."""
    return next((editable for editable in script.python.editable_lists if editable.option == option and editable.size), None)


def add(to: EditableList, element: str) -> Edit:
    """Return the edit that adds an element after the last one.

    The new element has its own line, or a trailing comma, if the last one has it.
    """
    gap = " " if to.indent is None else f"\n{to.indent}"
    return Edit(to.end, f"{gap}{element}," if to.comma else f",{gap}{element}")


def place(script: BuildScript) -> Span:
    """Return the place in a build script where install rules can be added, else the name of the package."""
    data_files = slot(script, "data_files")
    return script.commands.insertion or (data_files.end if data_files else script.project.name_span) or file_start(script.path)


def add_files(to: EditableList, package: str, paths: Iterable[str], others: Sequence[str]) -> Edit:
    """Return the edit that adds files to data_files, to install them in share/<package>.

    ``others`` are the paths of all files of the package. The files of a folder are added as a glob if setup.py uses globs
    and the glob matches no other file:

    - a glob with the common suffix of the files
    - without a common suffix, a glob of the whole folder, unless it has subfolders, which data_files do not accept

    Otherwise, and in the folder of setup.py, the files are listed.
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
    inside = [file for file in others if file.startswith(f"{folder}/")]
    files = [file for file in inside if posixpath.dirname(file) == folder]
    alike = [file for file in files if file.endswith(ending)]
    if to.glob and folder and (ending or inside == files) and sorted(alike) == sorted(paths):
        return f"({target}, {to.glob}({quoted(to, f'{folder}/*{ending}')}))"
    return f"({target}, [{', '.join(quoted(to, path) for path in paths)}])"


def _ending(paths: Sequence[str]) -> str:
    """Return the longest common suffix of the names that begins with a dot, "" if there is none."""
    names = [posixpath.basename(path) for path in paths]
    shared = posixpath.commonprefix([name[::-1] for name in names])[::-1] if len(names) > 1 else names[0][1:]
    return shared[shared.find(".") :] if "." in shared else ""


def joined(to: EditableList, package: str, before: str, after: str = "") -> str:
    """Return an expression for the text ``before`` + package + ``after``.

    The expression uses the variable with the package name if there is one, and is composed like others in the list.
    Slashes separate the package name from the texts before and after it.
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
    """Return a text as a Python literal, with the quotes that the list uses."""
    plain = repr(text)
    return plain if to.quote in plain[1:-1] or "\\" in plain else f"{to.quote}{text}{to.quote}"


_FOLDERS = (("develop", "script_dir"), ("install", "install_scripts"))
"""Sections and options of setup.cfg for the folder of programs, with and without symlink-install."""


def program_folders(script: BuildScript) -> dict[str, Span]:
    """Return the places in setup.cfg that set the folder of programs, by ``section.option``."""
    wanted = {f"{section}.{option}" for section, option in _FOLDERS}
    return {text.text: text.span for text in script.python.editable_texts if text.kind == "option" and text.text in wanted}


def config(place: Span, package: str) -> Edit:
    """Return the edit that writes a new setup.cfg, so that programs are installed to ``lib/<package>``."""
    return Edit(place, "".join(f"[{section}]\n{option}=$base/lib/{package}\n" for section, option in _FOLDERS))


def programs_to(script: BuildScript, package: str) -> tuple[Edit, ...]:
    """Return the edits of a setup.cfg that make programs install to ``lib/<package>``.

    Empty if there is no setup.cfg.
    """
    headers = {text.text: text.span for text in script.python.editable_texts if text.kind == "section"}
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
