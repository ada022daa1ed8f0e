"""Edits of CMakeLists.txt that keep its style: worked out from the commands as they are written, without their text."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

from ros_lint.base.edit import Edit
from ros_lint.base.paths import join
from ros_lint.facts.build import BuildScript
from ros_lint.facts.cmake import Call
from ros_lint.workspace.model import Package, Workspace

_LIBRARY = """\
install(TARGETS {}
  ARCHIVE DESTINATION lib
  LIBRARY DESTINATION lib
  RUNTIME DESTINATION bin)"""


def at_end(script: BuildScript, code: str) -> Edit | None:
    """Add commands before ament_package(), set off by blank lines if that is. None where there is no such place."""
    if script.insertion is None:
        return None
    return Edit(script.insertion_after, f"\n\n{code}") if script.insertion_after else Edit(script.insertion, f"{code}\n")


def install_library(script: BuildScript, name: str) -> Edit | None:
    """Install a library, before ament_package()."""
    return at_end(script, _LIBRARY.format(name))


def install_program(script: BuildScript, kind: str, name: str) -> Edit | None:
    """Install one of TARGETS, PROGRAMS to lib/<package>."""
    return at_end(script, f"install({kind} {_word(name)} DESTINATION lib/${{PROJECT_NAME}})")


def install_files(script: BuildScript, paths: Sequence[str], folder: str) -> Edit | None:
    """Install files to a folder below share/<package>, "" for that itself."""
    words = " ".join([*map(_word, paths), "DESTINATION", _word(join("share/${PROJECT_NAME}", folder))])
    return at_end(script, f"install(FILES {words})")


def _word(path: str) -> str:
    """Write a path as an argument, in quotes where blanks, parentheses and their like would end it."""
    return f'"{path}"' if re.search(r"[\s()#;]", path) else path


def install_folder(package: Package, folder: str) -> Edit | None:
    """Install a folder to share/<package>: in the rule that does it for other folders, if there is one, or else in a new one.

    None when there is no place for a new one.
    """
    call = _beside(package)
    if call is not None:
        return _append(call, call.texts.index("DESTINATION") - 1, _word(folder))
    return at_end(package.built, f"install(DIRECTORY {_word(folder)} DESTINATION share/${{PROJECT_NAME}})")


def export_dependencies(package: Package, name: str, all_names: Sequence[str]) -> Edit | None:
    """Export a package: in the call that does it for others, if there is one, or else in a new one, with all that lack it.

    So the edit is one and the same for all of them. None when there is no place for a new call.
    """
    call = next((call for call in package.calls("ament_export_dependencies") if call.args and not call.blocks), None)
    if call is not None:
        return add_argument(call, name)
    return at_end(package.built, f"ament_export_dependencies({' '.join(all_names)})")


LINKED = "link to the targets of the packages"
"""What :func:`link_to_targets` does."""

_NAME = re.compile(r"[A-Za-z]\w*")


def link_to_targets(calls: Iterable[Call], workspace: Workspace) -> Iterator[Edit | None]:
    """Replace each ``ament_target_dependencies()`` by the link to targets that it makes itself (reference, section C3).

    None for a package that is not named, or not known to export targets: for such it takes other variables.
    """
    for call in calls:
        yield Edit(call.name_span, "target_link_libraries")
        for index, text in enumerate(call.texts[1:], 1):
            if text not in ("PUBLIC", "INTERFACE"):
                known = _NAME.fullmatch(text) and exports_targets(text, workspace)
                yield Edit(call.span(index), f"${{{text}_TARGETS}}") if known else None


def exports_targets(name: str, workspace: Workspace) -> bool:
    """Return whether a package is known to export targets, which ament_target_dependencies() then links."""
    own = workspace.by_name.get(name)
    if own is None:
        return workspace.world.exports_targets(name)
    return all(not _EXPORTS_TARGETS.isdisjoint(package.built.command_names) for package in own)


_EXPORTS_TARGETS = frozenset({"ament_export_targets", "rosidl_generate_interfaces"})


def add_argument(call: Call, text: str) -> Edit:
    """Add an argument at the end of a call that has some."""
    return _append(call, len(call.args) - 1, text)


def _append(call: Call, last: int, text: str) -> Edit:
    """Add an argument after the one with the number ``last``: on a line of its own if that has one."""
    span = call.span(last)
    above = call.span(last - 1).line if last else call.line
    return Edit(span.end(), f" {text}" if span.line == above else f"\n{' ' * (span.column - 1)}{text}")


def _beside(package: Package) -> Call | None:
    """Return a rule that installs folders to share/<package> as they are, and does nothing else."""
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
    """Add USE_SOURCE_PERMISSIONS to install(DIRECTORY), after the destination: patterns come later."""
    at = call.texts.index("DESTINATION") + 1 if "DESTINATION" in call.texts[:-1] else len(call.args) - 1
    return Edit(call.span(at).end(), " USE_SOURCE_PERMISSIONS")


def write(call: Call, index: int, text: str) -> Edit:
    """Put another argument in the place of one."""
    return Edit(call.span(index), text)


def drop(call: Call, first: int, last: int) -> Edit:
    """Remove the arguments from ``first`` to ``last``, and what separates them from the one before, which must be there."""
    gap, span = call.span(first - 1).end(), call.span(last)
    return Edit(gap._replace(end_line=span.end_line, end_column=span.end_column), "")
