"""Make edits of CMakeLists.txt in its style. A function returns None if the file has no place for the edit."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

from ros_lint.base.edit import Edit
from ros_lint.base.paths import join
from ros_lint.base.text import Span
from ros_lint.facts.build import BuildScript
from ros_lint.facts.cmake import Call
from ros_lint.workspace.model import Package, Workspace

_LIBRARY = """\
install(TARGETS {}
  ARCHIVE DESTINATION lib
  LIBRARY DESTINATION lib
  RUNTIME DESTINATION bin)"""


def at_end(script: BuildScript, code: str) -> Edit | None:
    """Return the edit that adds commands before ament_package(), None if the script has no place for further commands.

    Blank lines surround the added commands if a blank line is before ament_package().
    """
    if script.commands.insertion is None:
        return None
    return (
        Edit(script.commands.insertion_after, f"\n\n{code}")
        if script.commands.insertion_after
        else Edit(script.commands.insertion, f"{code}\n")
    )


def install_library(script: BuildScript, name: str) -> Edit | None:
    """Return the edit that installs a library target, None if the script has no place for further commands."""
    return at_end(script, _LIBRARY.format(name))


def install_program(script: BuildScript, kind: str, *names: str) -> Edit | None:
    """Return the edit that installs programs into ``lib/<package>``. ``kind`` is "TARGETS" or "PROGRAMS".

    The result is None if the script has no place for further commands.
    """
    return at_end(script, f"install({kind} {' '.join(map(_word, names))} DESTINATION lib/${{PROJECT_NAME}})")


def install_files(script: BuildScript, paths: Sequence[str], folder: str) -> Edit | None:
    """Return the edit that installs files into ``share/<package>/<folder>``, or into ``share/<package>`` if ``folder`` is "".

    The result is None if the script has no place for further commands.
    """
    words = " ".join([*map(_word, paths), "DESTINATION", _word(join("share/${PROJECT_NAME}", folder))])
    return at_end(script, f"install(FILES {words})")


def _word(path: str) -> str:
    """Return a path as an argument of a CMake command, quoted if it contains a blank, "(", ")", "#" or ";"."""
    return f'"{path}"' if re.search(r"[\s()#;]", path) else path


def install_folder(package: Package, folder: str) -> Edit | None:
    """Return the edit that installs a folder to ``share/<package>``, None if the script has no place for further commands.

    The edit extends the install() command that installs other folders to ``share/<package>``, or else adds a command.
    """
    call = _beside(package)
    if call is not None:
        return _append(call, call.texts.index("DESTINATION") - 1, _word(folder))
    return at_end(package.built, f"install(DIRECTORY {_word(folder)} DESTINATION share/${{PROJECT_NAME}})")


def install_folder_place(package: Package) -> Span | None:
    """Return the place of the install(DIRECTORY) that :func:`install_folder` extends, None if it adds a new command."""
    call = _beside(package)
    return call.name_span if call is not None else None


def export_dependencies(package: Package, names: Sequence[str]) -> Edit | None:
    """Return the edit that adds ``names`` to an existing call of ament_export_dependencies(), or else adds a new call.

    The result is None if the script has no place for further commands.
    """
    call = next((call for call in package.calls("ament_export_dependencies") if call.args and not call.blocks), None)
    if call is not None:
        return add_argument(call, *names)
    return at_end(package.built, f"ament_export_dependencies({' '.join(names)})")


LINKED = "replace ament_target_dependencies() by target_link_libraries()"
"""Title of the fix that :func:`link_to_targets` makes."""

_NAME = re.compile(r"[A-Za-z]\w*")


def link_to_targets(calls: Iterable[Call], workspace: Workspace) -> Iterator[Edit | None]:
    """Yield the edits that replace each ``ament_target_dependencies()`` by ``target_link_libraries()``.

    ``rclcpp`` becomes ``${rclcpp_TARGETS}``. Yields None for an argument that contains a variable, and for a package
    without exported targets (:func:`exports_targets`), which can only be used by its variables.
    """
    for call in calls:
        yield Edit(call.name_span, "target_link_libraries")
        for index, text in enumerate(call.texts[1:], 1):
            if text not in ("PUBLIC", "INTERFACE"):
                known = _NAME.fullmatch(text) and exports_targets(text, workspace)
                yield Edit(call.span(index), f"${{{text}_TARGETS}}") if known else None


def exports_targets(name: str, workspace: Workspace) -> bool:
    """Return whether a package certainly exports CMake targets, so that ``<package>_TARGETS`` is set.

    Every package of the workspace called ``name`` has to export targets. A package outside of the workspace counts if the
    data about released packages list its exported targets.
    """
    local_packages = workspace.by_name.get(name)
    if local_packages is None:
        return workspace.world.exports_targets(name)
    return all(not _EXPORTS_TARGETS.isdisjoint(package.built.commands.names) for package in local_packages)


_EXPORTS_TARGETS = frozenset({"ament_export_targets", "rosidl_generate_interfaces"})


def add_argument(call: Call, *texts: str) -> Edit:
    """Return the edit that adds arguments at the end of a call. The call must have arguments."""
    return _append(call, len(call.args) - 1, *texts)


def _append(call: Call, last: int, *texts: str) -> Edit:
    """Return the edit that adds arguments after argument number ``last`` of a call, counted from 0.

    Each new argument gets its own line if argument ``last`` is not on the line of the argument before it.
    """
    span = call.span(last)
    above = call.span(last - 1).line if last else call.line
    separator = " " if span.line == above else f"\n{' ' * (span.column - 1)}"
    return Edit(span.end(), "".join(f"{separator}{text}" for text in texts))


def _beside(package: Package) -> Call | None:
    """Return the first plain ``install(DIRECTORY a b DESTINATION share/<package>)``, None if there is none.

    A plain call has no variables and options, and is not inside of a block such as if().
    """
    for call in package.calls("install"):
        texts = call.texts
        if texts[:1] != ("DIRECTORY",) or call.blocks or texts[-2:-1] != ("DESTINATION",):
            continue
        folders = texts[1:-2]
        plain = all("$" not in folder and not folder.isupper() for folder in folders)
        if folders and plain and texts[-1].rstrip("/") in ("share/${PROJECT_NAME}", f"share/{package.name}"):
            return call
    return None


def keep_permissions(call: Call) -> Edit:
    """Return the edit that adds USE_SOURCE_PERMISSIONS to a call of install(DIRECTORY).

    The keyword is added after the destination, because PATTERN options have to follow it.
    """
    at = call.texts.index("DESTINATION") + 1 if "DESTINATION" in call.texts[:-1] else len(call.args) - 1
    return Edit(call.span(at).end(), " USE_SOURCE_PERMISSIONS")


def write(call: Call, index: int, text: str) -> Edit:
    """Return the edit that replaces argument number ``index`` of a call, counted from 0, by ``text``."""
    return Edit(call.span(index), text)


def drop(call: Call, first: int, last: int) -> Edit:
    """Return the edit that removes the arguments ``first`` to ``last`` of a call, both included. ``first`` is at least 1."""
    gap, span = call.span(first - 1).end(), call.span(last)
    return Edit(gap._replace(end_line=span.end_line, end_column=span.end_column), "")
