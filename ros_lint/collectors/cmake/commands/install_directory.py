"""install(DIRECTORY): folders with their files, except those that patterns exclude."""

from __future__ import annotations

import posixpath
import re
from typing import TYPE_CHECKING, Final, NamedTuple

from ros_lint.base.budget import Budget
from ros_lint.base.paths import is_outside
from ros_lint.base.paths import join as join_path
from ros_lint.base.text import Span, octets
from ros_lint.collectors.cmake.commands.install_destinations import destination_of, facet_of, hide
from ros_lint.collectors.cmake.evaluator.arguments import sections
from ros_lint.collectors.cmake.evaluator.glob import end_pattern
from ros_lint.collectors.cmake.evaluator.run import Run
from ros_lint.collectors.cmake.evaluator.values import ATOM, FILE, HOLE, is_known, strip_mark
from ros_lint.facts.build import InstalledFile
from ros_lint.facts.visibility import Facet

if TYPE_CHECKING:
    from ros_lint.collectors.cmake.evaluator.regex import Searcher

_WORDS: Final = {
    "TYPE": 1, "DESTINATION": 1, "FILE_PERMISSIONS": -1, "DIRECTORY_PERMISSIONS": -1, "USE_SOURCE_PERMISSIONS": 0,
    "OPTIONAL": 0, "MESSAGE_NEVER": 0, "CONFIGURATIONS": -1, "COMPONENT": 1, "EXCLUDE_FROM_ALL": 0, "FILES_MATCHING": 0,
}  # fmt: skip


class _Pattern(NamedTuple):
    matches: re.Pattern[str] | Searcher
    excluded: bool
    executable: bool | None
    """True if the PERMISSIONS of the pattern have an execute permission, None if the pattern has no PERMISSIONS."""


class _Rule(NamedTuple):
    """The options of one install(DIRECTORY). They apply to all of its folders."""

    patterns: list[_Pattern]
    only: bool
    """True if only files that match a pattern are installed (FILES_MATCHING)."""
    executable: bool | None
    """True if installed files get an execute permission, None if they keep the permissions of the source."""
    optional: bool


def install_directories(run: Run, args: list[str]) -> None:
    """Run ``install(DIRECTORY args...)``: record the installed files."""
    at = min([args.index(word) for word in ("PATTERN", "REGEX") if word in args], default=len(args))
    parts = sections(args[:at], _WORDS)
    destination = destination_of(run, parts)
    patterns = _patterns(args[at:], run.budget) if at < len(args) else []
    if patterns is None:
        hide(run, destination, "a pattern of install(DIRECTORY) is unknown")
        return
    permissions = parts.get("FILE_PERMISSIONS")
    executable: bool | None = None if "USE_SOURCE_PERMISSIONS" in parts else False
    if permissions is not None:
        executable = any(word.endswith("_EXECUTE") for word in permissions)
    rule = _Rule(patterns, "FILES_MATCHING" in parts or "FILES_MATCHING" in args[at:], executable, "OPTIONAL" in parts)
    for value in parts[""]:
        plain = strip_mark(value)[0]
        source = run.paths.source_or_outside(plain)
        name = posixpath.basename(plain)  # the folder keeps its name, even if it is outside of the package
        if destination is None or HOLE in plain or (source is not None and ATOM in name):
            is_known_place = destination is not None and name not in ("", ".", "..") and is_known(name)
            place = join_path(destination or "", name) if is_known_place else destination
            hide(run, place, "the folder or the destination of install(DIRECTORY) is unknown")
        elif source is None or (is_outside(source) and not (run.paths.files_below(source) or run.paths.is_file(source))):
            hide(run, destination, "install(DIRECTORY) installs a folder that is not in the sources")
            _install_configured(run, value, destination, rule)
        elif not run.muted:
            target = posixpath.normpath(join_path(destination, name))
            _install_directory(run, value, source, "" if target == "." else target, rule)


def _install_directory(run: Run, value: str, source: str, target: str, rule: _Rule) -> None:
    plain, certain = strip_mark(value)
    span = run.place_of(value)
    conditional = run.conditional or run.testing or not certain
    if run.paths.is_file(source):
        run.add_problem("directory-is-file", f"install(DIRECTORY) cannot install '{source}', because it is a file", span, source)
        return
    unlisted_files = unlisted(run, source, facet_of(run, target), span) if run.paths.sources.unlisted_folders else []
    listed_files = run.paths.files_below(source)
    generated, is_filled = _generated_below(run, source)
    top = plain.rstrip("/") if plain.startswith("/") else f"/{join_path(run.paths.directory, plain)}".rstrip("/")
    if is_filled:
        hide(run, target, "install(DIRECTORY) installs a folder that the build fills")
    elif not (listed_files or generated) and source and not run.paths.is_unlisted(source):
        # CMake treats a path that does not exist as a file, and ignores it if patterns exclude that file.
        if not rule.optional and _selection(posixpath.basename(top), posixpath.dirname(top), rule)[0]:
            run.results.missing_files.append((f"{source}/", span, conditional))
        return
    skip = len(source) + 1 if source else 0
    start = f"{target}/" if target else ""
    has_patterns = bool(rule.patterns or rule.only)
    files = (*listed_files, *unlisted_files, *generated) if unlisted_files or generated else listed_files
    run.budget.charge(FILE * len(files))
    for file in files:
        program = file in run.paths.sources.executables if rule.executable is None else rule.executable
        if has_patterns:
            is_selected, executable = _selection(file[skip:], top, rule)
            if not is_selected:
                continue
            program = program if executable is None else executable
        path = f"{start}{file[skip:]}"
        run.results.installed.append(
            InstalledFile(path, run.paths.normalized(file), program, conditional, span, test=run.testing)
        )


def _generated_below(run: Run, folder: str) -> tuple[list[str], bool]:
    """Return the generated files below ``folder``, sorted, and whether the build also generates unknown files below it."""
    below = f"{folder}/" if folder else ""
    generated = sorted(path for path in run.paths.generated if path.startswith(below) and path not in run.paths.files)
    folders = [path[:-1] for path in generated if path[-1] == "/"]
    return [path for path in generated if path[-1] != "/"], any(not run.paths.files_below(path) for path in folders)


def _install_configured(run: Run, value: str, destination: str, rule: _Rule) -> None:
    """Record as installed the files that configure_file() wrote to ``value``, a folder in the build folder.

    Some files may be missing in the record, because the build may write further files to the folder.
    """
    plain, certain = strip_mark(value)
    folder = run.paths.build_path(plain)
    if folder is None or run.muted:
        return
    span = run.place_of(value)
    target = destination if plain.endswith("/") or not folder else join_path(destination, posixpath.basename(folder))
    for path, always in run.paths.configured.items():
        path_inside = path if not folder else path[len(folder) + 1 :] if path.startswith(f"{folder}/") else ""
        if path_inside and _selection(path_inside, plain.rstrip("/"), rule)[0]:
            conditional = run.conditional or run.testing or not certain or not always
            run.results.installed.append(InstalledFile(join_path(target, path_inside), "", False, conditional, span))


def unlisted(run: Run, source: str, facet: Facet, span: Span) -> list[str]:
    """Return the files below ``source`` that install(DIRECTORY) installs although they do not belong to the package.

    These files are in nested packages, or in folders with a COLCON_IGNORE.
    """
    unlisted_files: list[str] = []
    for folder in run.paths.sources.unlisted_folders:
        inside = source == folder or source.startswith(f"{folder}/")
        if inside or not source or folder.startswith(f"{source}/"):
            files = run.paths.sources.list_unlisted(folder)
            if not files:
                run.hide(facet, "install(DIRECTORY) installs a folder whose files are not listed", span)
            unlisted_files += [file for file in files if not source or file.startswith(f"{source}/")]
    return unlisted_files


def _selection(file: str, top: str, rule: _Rule) -> tuple[bool, bool | None]:
    """Return whether the patterns of install(DIRECTORY) include a file, and whether they make the file executable.

    The second value is None if no pattern with PERMISSIONS matches. ``file`` is relative to ``top``, the path of the
    installed folder in the script: CMake matches the patterns with ``top/file``.
    """
    end = -1
    while True:  # the folder itself and the folders between it and the file
        folder = f"{top}/{file[:end]}" if end > 0 else top
        if any(pattern.excluded and pattern.matches.search(octets(folder)) for pattern in rule.patterns):
            return False, None
        end = file.find("/", end + 1)
        if end < 0:
            break
    matching = [pattern for pattern in rule.patterns if pattern.matches.search(octets(f"{top}/{file}"))]
    if any(pattern.excluded for pattern in matching) or (rule.only and not matching):
        return False, None
    permissions = [pattern.executable for pattern in matching if pattern.executable is not None]
    return True, any(permissions) if permissions else None


def _patterns(args: list[str], budget: Budget) -> list[_Pattern] | None:
    patterns: list[_Pattern] = []
    index = 0
    while index < len(args):
        word = args[index]
        index += 1
        if word not in ("PATTERN", "REGEX") or index >= len(args):
            continue
        text = args[index]
        if not is_known(text):
            return None
        index += 1
        regex = _regex(text, budget) if word == "REGEX" else end_pattern(text)
        if regex is None:
            return None
        excluded, executable = False, None
        while index < len(args) and args[index] not in ("PATTERN", "REGEX"):
            excluded = excluded or args[index] == "EXCLUDE"
            if args[index] == "PERMISSIONS":
                executable = False
            executable = executable or (True if args[index].endswith("_EXECUTE") else executable)
            index += 1
        patterns.append(_Pattern(regex, excluded, executable))
    return patterns


def _regex(text: str, budget: Budget) -> Searcher | None:
    from ros_lint.collectors.cmake.evaluator.regex import translated  # noqa: PLC0415  (few packages use REGEX)

    return translated(text, budget)
