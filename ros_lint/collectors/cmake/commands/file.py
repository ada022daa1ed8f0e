"""Commands for paths and files: file(), get_filename_component(), configure_file()."""

from __future__ import annotations

import posixpath
import re
from itertools import pairwise
from typing import Final

from ros_lint.base.paths import is_outside, strip_folder
from ros_lint.base.text import octets, to_bytes
from ros_lint.collectors.cmake.commands.basic import nothing
from ros_lint.collectors.cmake.commands.targets import note_generated
from ros_lint.collectors.cmake.evaluator.glob import path_pattern
from ros_lint.collectors.cmake.evaluator.run import Handler, Run
from ros_lint.collectors.cmake.evaluator.truth import TRUE_WORDS
from ros_lint.collectors.cmake.evaluator.values import ATOM, HOLE, SLOW, TREE, is_fixed, is_known, join


def _file(run: Run, args: list[str]) -> None:
    mode = args[0] if args else ""
    if mode in ("GLOB", "GLOB_RECURSE"):
        _glob(run, args[1:], mode == "GLOB_RECURSE")
    elif mode in ("WRITE", "APPEND", "TOUCH", "GENERATE", "CONFIGURE", "TOUCH_NOCREATE"):
        outputs = args[1:2] if mode not in ("GENERATE", "CONFIGURE") else args[args.index("OUTPUT") + 1 :][:1]
        for output in outputs:
            note_generated(run, output)
    elif mode == "MAKE_DIRECTORY":
        for folder in args[1:]:
            note_generated(run, folder, folder=True)
    elif mode in ("COPY_FILE", "RENAME", "CREATE_LINK") and len(args) > 2:
        note_generated(run, args[2])
        if mode == "RENAME" and not run.uncertain_conditions:
            run.paths.generated.discard(run.paths.source(args[1]) or "")
    elif mode == "COPY" and "DESTINATION" in args[:-1]:
        at = args.index("DESTINATION")
        _copy(run, args[1:at], args[at + 1])
    elif mode in ("DOWNLOAD", "UPLOAD"):
        if mode == "DOWNLOAD":
            note_generated(run, args[2] if len(args) > 2 else "")
        for word, variable in pairwise(args):
            if word in ("STATUS", "LOG"):
                run.set(variable, HOLE)
    elif mode == "RELATIVE_PATH" and len(args) == 4:
        run.set(args[1], _relative(args[3], args[2]))
    elif mode in ("TO_CMAKE_PATH", "TO_NATIVE_PATH") and len(args) > 2:
        run.set(args[2], args[1] if _SAME_EVERYWHERE.fullmatch(args[1]) else HOLE)
    elif mode == "REAL_PATH" and len(args) > 2:
        # Whether a backslash separates folders depends on policy CMP0152.
        run.set(args[2], HOLE if "\\" in args[1] else _absolute(args[1], run.path_variables["CMAKE_CURRENT_SOURCE_DIR"]))
    elif mode in ("READ", "SIZE", "TIMESTAMP", "READ_SYMLINK", "MD5", "SHA1", "SHA256", "STRINGS"):
        run.set(args[2] if len(args) > 2 else "", HOLE)


_SAME_EVERYWHERE: Final = re.compile(rf"[/{ATOM}]?(?:[^/:;\\ \0\2\3]+/)*[^/:;\\ \0\2\3]+")
"""Pattern of paths that file(TO_CMAKE_PATH) and file(TO_NATIVE_PATH) do not change on any system."""


def _copy(run: Run, copied: list[str], destination: str) -> None:
    """Run ``file(COPY)``: record the copies as generated files if ``destination`` is absolute.

    ``copied`` are paths. A folder with a slash at the end is copied without its name. A relative destination is in the build
    folder, where no files are recorded.
    """
    for path in copied if destination.startswith("/") else ():
        source = run.paths.source(path)
        is_folder = source is not None and run.paths.is_folder(source)
        note_generated(run, f"{destination}/{posixpath.basename(path)}", folder=is_folder)


def _glob(run: Run, args: list[str], recurse: bool) -> None:
    if not args or HOLE in args[0]:
        return
    relative: str | None = None
    folders = not recurse
    patterns: list[str] = []
    index = 1
    while index < len(args):
        word = args[index]
        index += 1
        if word == "RELATIVE" and index < len(args):
            relative = args[index]
            index += 1
        elif word == "LIST_DIRECTORIES" and index < len(args):
            folders = args[index].upper() in TRUE_WORDS
            index += 1
        elif word not in ("CONFIGURE_DEPENDS", "FOLLOW_SYMLINKS"):
            patterns.append(word)
    paths: list[str] = []
    for pattern in patterns:
        if HOLE in pattern or (pattern.startswith("/") and not pattern.startswith(TREE)):
            run.set(args[0], HOLE)
            return
        paths += _matches(run, pattern, recurse, folders)
    if relative is not None:
        paths = [_relative(path, relative) for path in paths]
    run.set(args[0], HOLE if HOLE in paths else join(sorted(dict.fromkeys(paths), key=to_bytes)))


def _matches(run: Run, pattern: str, recurse: bool, folders: bool) -> list[str]:
    """Return the absolute paths of the files that a pattern of file(GLOB) matches; ``[HOLE]``, an unknown text, if unknown.

    ``recurse`` is True for file(GLOB_RECURSE). With ``folders``, matching folders are included.
    """
    path = pattern if pattern.startswith(TREE) else f"{run.path_variables['CMAKE_CURRENT_SOURCE_DIR']}/{pattern}"
    parts = path.split("/")
    fixed = next((index for index, part in enumerate(parts) if any(letter in part for letter in "*?[")), len(parts) - 1)
    fixed = min(fixed, len(parts) - 1)
    top = "/".join(parts[:fixed])
    folder = run.paths.source_or_outside(top)
    if folder is None or (is_outside(folder) and not run.paths.files_below(folder)):
        return [HOLE]
    pattern_of_rest = path_pattern(parts[fixed:], recurse=recurse)
    files = [strip_folder(folder, file) for file in run.paths.files_below(folder)]
    run.budget.charge(SLOW * len(files))
    names = [file for file in files if pattern_of_rest.fullmatch(octets(file))]
    if folders:
        above = {file[:end] for file in files for end in range(len(file)) if file[end] == "/"}
        if recurse and len(parts) - fixed > 1:
            return [HOLE]
        # GLOB_RECURSE lists every folder that it enters.
        names += [name for name in above if recurse or pattern_of_rest.fullmatch(octets(name))]
    return [f"{top}/{name}" for name in names]


def _relative(path: str, base: str) -> str:
    root = next((root for root in _ROOTS if path.startswith(root) and base.startswith(root)), None)
    if not (is_fixed(path) and is_fixed(base)):
        return HOLE
    if root is None and not (path.startswith("/") and base.startswith("/") and is_known(path) and is_known(base)):
        return HOLE
    path_to = posixpath.relpath(path, base)
    if path_to == ".":
        return ""
    if ATOM in path_to and path_to.startswith(".."):
        return HOLE  # the path leaves the analysed tree, whose own name is unknown
    return f"{path_to}/" if path_to.endswith("..") else path_to


_ROOTS: Final = ("/\1source", "/\1build", "/\1prefix")


def _absolute(path: str, base: str) -> str:
    if not is_fixed(path) or not is_fixed(base) or _DRIVE.match(path):
        return HOLE
    path, base = (
        path.replace("\\", "/"),
        base.replace("\\", "/"),
    )  # CMake converts these on every system
    joined = path if path.startswith("/") else posixpath.join(base, path)
    normalized = posixpath.normpath(joined)
    # The folders above the tree are unknown.
    return normalized if joined.split("/")[1][:1] != ATOM or normalized.split("/")[1] == joined.split("/")[1] else HOLE


def _component(run: Run, args: list[str]) -> None:
    """Run ``get_filename_component(variable path mode [BASE_DIR d] [CACHE])``: set a variable to a part of a path."""
    if len(args) < 3 or HOLE in args[0]:
        return
    name, path, mode = args[:3]
    if "PROGRAM_ARGS" in args[3:-1]:
        run.set(args[args.index("PROGRAM_ARGS") + 1], HOLE)
    base = args[args.index("BASE_DIR") + 1] if "BASE_DIR" in args[:-1] else run.path_variables["CMAKE_CURRENT_SOURCE_DIR"]
    run.set(name, _part(path, mode, base))


_DRIVE: Final = re.compile("[A-Za-z]:")


def _part(path: str, mode: str, base: str) -> str:
    if mode in ("ABSOLUTE", "REALPATH"):
        return _absolute(path, base)
    if mode in ("PROGRAM", "PROGRAM_ARGS") or "\2" in path or "\\" in path or _DRIVE.match(path):
        return HOLE
    if mode in ("DIRECTORY", "PATH"):
        path = re.sub("/{2,}", "/", path).rstrip("/") or path[:1]
    folder, slash, last = path.rpartition("/")
    if mode in ("DIRECTORY", "PATH"):
        return HOLE if HOLE in last or path == TREE else (folder or ("/" if slash else ""))
    if HOLE in last or "\1" in last:
        return HOLE
    stem, dot, end = last.partition(".")
    if mode == "NAME":
        return last
    if mode == "EXT":
        return dot + end
    if mode == "NAME_WE":
        return stem if stem or not dot else ""
    root, dot, end = last.rpartition(".")
    if mode == "LAST_EXT":
        return dot + end if dot else ""
    if mode == "NAME_WLE":
        return root if dot else last
    return HOLE


def _configure(run: Run, args: list[str]) -> None:
    """Run ``configure_file(input output)``: record that the build generates the file ``output``."""
    if len(args) > 1:
        output = args[1]
        if not output.startswith("/") and is_fixed(output):
            output = f"{run.path_variables['CMAKE_CURRENT_BINARY_DIR']}/{output}"
        path = run.paths.build_path(output)
        if path is None:
            note_generated(run, output)
        elif not run.muted:
            run.paths.configured[path] = run.paths.configured.get(path, False) or not run.conditional


def _configure_config(run: Run, args: list[str]) -> None:
    """Run ``configure_package_config_file(input output ...)``: record ``input`` as a template of a CMake config file."""
    path = run.paths.source(args[0]) if args else None
    if path in run.paths.files and not run.uncertain_conditions and not run.testing:
        run.results.config_templates[path] = None


COMMANDS: Final[dict[str, Handler]] = {
    "file": _file,
    "get_filename_component": _component,
    "configure_file": _configure,
    "configure_package_config_file": _configure_config,
    "write_basic_package_version_file": nothing,
}
