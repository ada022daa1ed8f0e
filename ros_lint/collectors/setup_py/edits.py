"""Edits of setup.py and setup.cfg in the style of the file: new elements of list literals, and changed options."""

from __future__ import annotations

import posixpath
from collections.abc import Iterable, Sequence

from ros_lint.base.edit import Edit
from ros_lint.base.text import Span, file_start
from ros_lint.facts.build import BuildScript
from ros_lint.facts.setup_py import EditableList


def slot(script: BuildScript, option: str) -> EditableList | None:
    """Return the list literal of an option of setup(), None if the option is missing, empty or not a list literal."""
    return next((editable for editable in script.python.editable_lists if editable.option == option and editable.size), None)


def add(to: EditableList, element: str) -> Edit:
    """Return the edit that adds ``element`` after the last element of a list literal.

    The new element begins a new line if the last element does, and ends with a comma if the last element does.
    """
    gap = " " if to.indent is None else f"\n{to.indent}"
    return Edit(to.end, f"{gap}{element}," if to.comma else f",{gap}{element}")


def place(script: BuildScript) -> Span:
    """Return the span where install rules can be added to a build script.

    If there is no such span, return the span of the project name, else the start of the file.
    """
    data_files = slot(script, "data_files")
    return script.commands.insertion or (data_files.end if data_files else script.project.name_span) or file_start(script.path)


def add_files(to: EditableList, package: str, paths: Iterable[str], others: Sequence[str]) -> Edit:
    """Return the edit that adds files to the list data_files, so that they are installed in share/<package>.

    ``others`` are the paths of all files of the package. The files of a folder are added as a glob if setup.py uses globs
    and the glob matches no further file:

    - a glob with the common suffix of the files, such as ``launch/*.launch.py``
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
    # A glob does not match hidden files.
    inside = [file for file in others if file.startswith(f"{folder}/") and not posixpath.basename(file).startswith(".")]
    files = [file for file in inside if posixpath.dirname(file) == folder]
    alike = [file for file in files if file.endswith(ending)]
    if to.glob and folder and (ending or inside == files) and sorted(alike) == sorted(paths):
        return f"({target}, {to.glob}({quoted(to, f'{folder}/*{ending}')}))"
    return f"({target}, [{', '.join(quoted(to, path) for path in paths)}])"


def _ending(paths: Sequence[str]) -> str:
    """Return the longest common suffix of file names that begins with a dot, "" if there is none.

    ["a.launch.py", "b.launch.py"] -> ``.launch.py``
    """
    names = [posixpath.basename(path) for path in paths]
    shared = posixpath.commonprefix([name[::-1] for name in names])[::-1]
    return shared[shared.find(".") :] if "." in shared else ""


def joined(to: EditableList, package: str, before: str, after: str = "") -> str:
    """Return a Python expression for the text ``before`` + package + ``after``, such as ``'share/' + package_name``.

    The expression uses the variable with the package name if there is one, and composes texts as the list ``to`` does.
    ``before`` ends with a slash and ``after`` begins with a slash, unless they are empty.
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
    """Return a text as a Python string literal, with the kind of quotes that the list ``to`` uses."""
    plain = repr(text)
    return plain if to.quote in text or "\\" in plain else f"{to.quote}{text}{to.quote}"


_FOLDERS = (("develop", "script_dir"), ("install", "install_scripts"))
"""Sections and options of setup.cfg that set the install folder of programs: first with symlink-install, then without."""


def program_folders(script: BuildScript) -> dict[str, Span]:
    """Return the spans of the options in setup.cfg that set the install folder of programs.

    The keys are ``develop.script_dir`` and ``install.install_scripts``.
    """
    wanted = {f"{section}.{option}" for section, option in _FOLDERS}
    return {text.text: text.span for text in script.python.editable_texts if text.kind == "option" and text.text in wanted}


def config(place: Span, package: str) -> Edit:
    """Return the edit that writes a new setup.cfg, so that programs are installed to ``lib/<package>``."""
    return Edit(place, "".join(f"[{section}]\n{option}=$base/lib/{package}\n" for section, option in _FOLDERS))


def programs_to(script: BuildScript, package: str) -> tuple[Edit, ...]:
    """Return the edits of an existing setup.cfg that make it install programs to ``lib/<package>``.

    The result is empty if there is no setup.cfg.
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
