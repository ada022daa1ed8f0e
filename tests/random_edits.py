"""Random edits of a workspace in memory, and the comparison of an incremental check with a check from scratch.

The environment variable ``ROS_LINT_EDITED`` names a folder with a workspace: ``tests/test_incremental.py`` then edits a copy
of it in memory, ``ROS_LINT_EDITS`` times (by default 100).
"""

from __future__ import annotations

import os
import random
import re
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

from ros_lint.base.text import to_bytes
from ros_lint.base.tree import Entry, MemoryTree, Stamp, Tree
from ros_lint.engine import registry
from ros_lint.engine.run import find_issues
from ros_lint.knowledge import Knowledge
from ros_lint.testing import read_cases
from ros_lint.workspace.loader import Loader
from ros_lint.workspace.model import Workspace
from ros_lint.workspace.state import DistroData
from ros_lint.workspace.target import TargetDistro

Files = dict[str, bytes]
Result = tuple[dict[str, bytes | None], str]
"""The new contents of files by path (None: deleted), and a description of the edit."""

_FIXTURES = Path(__file__).parent.parent / "fixtures"
_MOST_BYTES = 1 << 20


class EditedTree:
    """A tree in memory whose files can be replaced."""

    def __init__(self, files: Files) -> None:
        self.now = MemoryTree(files)

    def list(self, path: str) -> list[Entry]:
        return self.now.list(path)

    def read(self, path: str) -> bytes:
        return self.now.read(path)

    def stamp(self, path: str) -> Stamp:
        return self.now.stamp(path)

    def identity(self, path: str) -> str:
        return path

    def is_untracked(self, path: str) -> bool:
        return self.now.is_untracked(path)


def several_cases(seed: int, count: int = 6) -> Files:
    """Return the files of some cases of rules, each in one of three folders."""
    sources = sorted(_FIXTURES.glob("*.md"))
    chosen = random.Random(seed)
    cases = [chosen.choice(list(read_cases(chosen.choice(sources)))) for _ in range(count)]
    return {f"{chosen.choice('abc')}/{path}": to_bytes(text) for case in cases for path, text in case.files.items()}


def files_below(folder: str) -> Files:
    """Return the files below a folder, without those of git and without very large ones."""
    files: Files = {}
    for place, folders, names in os.walk(folder):
        folders[:] = [name for name in folders if name != ".git"]
        for name in names:
            path = os.path.join(place, name)
            if not os.path.islink(path) and os.path.getsize(path) <= _MOST_BYTES:
                with open(path, "rb") as file:
                    files[os.path.relpath(path, folder)] = file.read()
    return files


class Comparison:
    """A workspace that is edited, checked incrementally and compared with a check from scratch.

    It is checked for each of ``distros``, by default for jazzy.
    """

    def __init__(self, files: Files, *distros: str, explicit: bool = False) -> None:
        self.files = dict(files)
        self.unsaved: Files = {}
        names = distros or ("jazzy",)
        self._targets = [TargetDistro(name, "test", explicit, tuple(other for other in names if other != name)) for name in names]
        self._knowledge = [Knowledge(name) for name in names]
        self._rules = registry.load(())
        self._tree = EditedTree(files)
        self._loader = self._loader_of(self._tree, [Knowledge(name) for name in names], again=True)
        self.incremental()

    def _loader_of(self, tree: Tree, knowledge: list[Knowledge], *, again: bool = False) -> Loader:
        others = [DistroData(*pair) for pair in zip(self._targets[1:], knowledge[1:], strict=True)]
        return Loader(tree, ("",), self._targets[0], knowledge=knowledge[0], others=others, again=again)

    def apply(self, changes: Mapping[str, bytes | None], *, saved: bool = True) -> None:
        """Change files: on the disk if ``saved`` is True, else in the editor only. A file with the contents None is deleted."""
        for path, data in changes.items():
            if data is None:
                self.files.pop(path, None)
                self.unsaved.pop(path, None)
            elif saved:
                self.files[path] = data
                self.unsaved.pop(path, None)
            else:
                self.unsaved[path] = data
        if saved:
            self._tree.now = MemoryTree(self.files)
            self._loader.forget(changes)

    def incremental(self) -> str:
        return self._result(self._loader)

    def from_scratch(self) -> str:
        return self._result(self._loader_of(MemoryTree(self.files), self._knowledge))

    def _result(self, loader: Loader) -> str:
        workspaces = loader.load_all(self.unsaved)
        checked = find_issues(workspaces, self._rules, loader.suppressions(), self._rules)
        return "\n".join([*_issues(checked), *(line for workspace in workspaces for line in _lines(workspace))])


def _issues(checked: Any) -> Iterator[str]:
    for issue in (*checked.issues, *checked.suppressed):
        finding = issue.finding
        yield f"{issue.rule.code} {issue.package} {finding} {issue.explained} {issue.distros} {issue.other_messages}"
    yield from (f"crash {crash.rule} {crash.package} {crash.error}" for crash in checked.crashes)


def _lines(workspace: Workspace) -> Iterator[str]:
    """Yield the parts of a workspace that appear in reports besides the findings."""
    yield from map(repr, (workspace.not_checked, workspace.source_lists, workspace.named_distros))
    for package in (*workspace.packages, *workspace.unusable):
        yield f"{package.path} {package.name} {package.colcon_name} {package.is_ros1} {package.opaque}"


class Edits:
    """Random edits of the files of a workspace."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)
        common = (self.move_lines, self.change_name, self.change_tag, self.change_cmake, self.delete_line)
        self._kinds: tuple[Callable[[Files], Result | None], ...] = (
            *common, *common, self.change_name, self.change_launch, self.damage, self.add_file, self.delete_file,
            self.rename_file, self.move_package, self.rename_package, self.copy_package, self.ignore,
        )  # fmt: skip

    def next(self, files: Files) -> Result:
        while True:
            if result := self.random.choice(self._kinds)(files):
                return result

    def _file(self, files: Files, pattern: str) -> str | None:
        paths = [path for path in files if re.search(pattern, path)]
        return self.random.choice(paths) if paths else None

    def _package(self, files: Files) -> str | None:
        path = self._file(files, r"(?:^|/)package\.xml$")
        return None if path is None else path[: -len("package.xml")]

    def move_lines(self, files: Files) -> Result | None:
        path = self._file(files, _TEXTS)
        if path is None:
            return None
        mark = b"// " if path.endswith((".cpp", ".hpp", ".h")) else b"<!-- x -->" if path.endswith((".xml", ".launch")) else b"# "
        lines = files[path].split(b"\n")
        at = self.random.randrange(len(lines))
        return {path: b"\n".join([*lines[:at], mark if self.random.random() < 0.5 else b"", *lines[at:]])}, f"line in {path}"

    def change_name(self, files: Files) -> Result | None:
        path = self._file(files, _TEXTS)
        words = re.findall(rb"[a-z][a-z0-9]*_[a-z0-9_]+", files[path]) if path else []
        if path is None or not words:
            return None
        word = self.random.choice(words)
        other = self._file(files, _TEXTS) or path
        others = re.findall(rb"[a-z][a-z0-9]*_[a-z0-9_]+", files[other])
        new = self.random.choice(others) if others and self.random.random() < 0.7 else word + b"_2"
        count = 1 if self.random.random() < 0.5 else -1
        return {path: files[path].replace(word, new, count)}, f"{word!r} -> {new!r} in {path}"

    def delete_line(self, files: Files) -> Result | None:
        path = self._file(files, _TEXTS)
        if path is None:
            return None
        lines = files[path].split(b"\n")
        del lines[self.random.randrange(len(lines))]
        return {path: b"\n".join(lines)}, f"line deleted in {path}"

    def damage(self, files: Files) -> Result | None:
        path = self._file(files, _TEXTS)
        if path is None or self.random.random() < 0.5:
            return None
        at = self.random.randrange(len(files[path]) + 1)
        return {path: files[path][:at]}, f"{path} cut at {at}"

    def add_file(self, files: Files) -> Result | None:
        folder, source = self._package(files), self._file(files, r"/[^/]+$")
        if folder is None or source is None:
            return None
        below = self.random.choice(["", "src/", "include/", "launch/", "config/", "scripts/", "test/", "msg/"])
        name = source.rpartition("/")[2]
        return {f"{folder}{below}{name}": files[source]}, f"{source} copied to {folder}{below}"

    def delete_file(self, files: Files) -> Result | None:
        path = self._file(files, r".")
        return None if path is None else ({path: None}, f"{path} deleted")

    def rename_file(self, files: Files) -> Result | None:
        path = self._file(files, r"\.(?:py|cpp|hpp|launch|yaml|xml|msg|txt|cmake|urdf|md)$")
        if path is None:
            return None
        new = re.sub(r"([^/]+)$", self.random.choice([r"new_\1", r"\1.in", r"sub/\1"]), path)
        return {path: None, new: files[path]}, f"{path} -> {new}"

    def _moved(self, files: Files, folder: str, new: str) -> dict[str, bytes | None]:
        inside = [path for path in files if path.startswith(folder)]
        return {**dict.fromkeys(inside), **{new + path[len(folder) :]: files[path] for path in inside}}

    def move_package(self, files: Files) -> Result | None:
        folder = self._package(files)
        if not folder or self.random.random() < 0.5:
            return None
        new = f"{self.random.choice(['moved', 'moved/deep', 'a_ws/src', 'b_ws/src'])}/{folder.rstrip('/').rpartition('/')[2]}/"
        return (self._moved(files, folder, new), f"{folder} -> {new}") if new != folder else None

    def copy_package(self, files: Files) -> Result | None:
        folder = self._package(files)
        if not folder or self.random.random() < 0.7:
            return None
        new = f"{self.random.choice(['copies', 'a_ws/src', 'b_ws/src'])}/{folder.rstrip('/').rpartition('/')[2]}/"
        inside = [path for path in files if path.startswith(folder)]
        return {new + path[len(folder) :]: files[path] for path in inside}, f"{folder} copied to {new}"

    def rename_package(self, files: Files) -> Result | None:
        path = self._file(files, r"(?:^|/)package\.xml$")
        match = re.search(rb"<name>([^<]*)</name>", files[path]) if path else None
        if path is None or match is None or self.random.random() < 0.3:
            return None
        names = [other[1] for data in files.values() if (other := re.search(rb"<name>([a-z_0-9]+)</name>", data[:2000]))]
        new = self.random.choice([match[1] + b"_new", self.random.choice(names), b"rclcpp"])
        text = files[path][: match.start(1)] + new + files[path][match.end(1) :]
        return {path: text}, f"package {match[1]!r} renamed to {new!r}"

    def change_tag(self, files: Files) -> Result | None:
        path = self._file(files, r"(?:^|/)package\.xml$")
        if path is None:
            return None
        kinds = [b"depend", b"build_depend", b"exec_depend", b"test_depend", b"build_export_depend"]
        tags = [*kinds, b"member_of_group", b"group_depend"]
        words = [word for data in (files[path],) for word in re.findall(rb">([a-z_0-9]+)<", data)]
        others = [b"rclcpp", b"tf2_ros", b"std_msgs", b"nav2_util", b"rcl", b"pluginlib", b"ament_index_cpp", b"unknown_thing"]
        names = [match[1] for data in files.values() if (match := re.search(rb"<name>([a-z_0-9]+)</name>", data[:2000]))]
        name, tag = self.random.choice([*others, *names[:50], *words]), self.random.choice(tags)
        line = b"<%s>%s</%s>\n  <export>" % (tag, name, tag)
        if self.random.random() < 0.4 and (found := re.findall(rb"[ \t]*<\w*depend[^\n]*\n", files[path])):
            return {path: files[path].replace(self.random.choice(found), b"", 1)}, f"tag removed in {path}"
        return {path: files[path].replace(b"<export>", line, 1)}, f"{line!r} in {path}"

    def change_cmake(self, files: Files) -> Result | None:
        path = self._file(files, r"(?:CMakeLists\.txt|\.cmake)$")
        if path is None:
            return None
        lines = [
            b"install(DIRECTORY launch config DESTINATION share/${PROJECT_NAME})", b"find_package(rclcpp REQUIRED)",
            b"find_package(nav2_util REQUIRED)", b"install(FILES README.md DESTINATION share/${PROJECT_NAME})",
            b"include(${CMAKE_CURRENT_SOURCE_DIR}/../cmake/x.cmake)", b"set(X ${UNKNOWN})", b"add_subdirectory(test)",
            b"ament_export_dependencies(rclcpp)", b"install(PROGRAMS scripts/x.py DESTINATION lib/${PROJECT_NAME})",
            b"ament_package(CONFIG_EXTRAS cmake/x.cmake)", b"install(TARGETS ${PROJECT_NAME})", b"return()",
        ]  # fmt: skip
        line = self.random.choice(lines)
        text = files[path]
        at = text.rfind(b"ament_package")
        at = max(at, text.rfind(b"ament_auto_package"))
        at = at if at >= 0 else len(text)
        return {path: text[:at] + line + b"\n" + text[at:]}, f"{line!r} in {path}"

    def change_launch(self, files: Files) -> Result | None:
        path = self._file(files, r"launch")
        if path is None:
            return None
        text = re.sub(rb"(executable\s*=\s*['\"])(\w)", rb"\1x\2", files[path], count=1)
        if self.random.random() < 0.5:
            text = re.sub(rb"(package\s*=\s*['\"])(\w)", rb"\1x\2", files[path], count=1)
        return ({path: text}, f"node renamed in {path}") if text != files[path] else None

    def ignore(self, files: Files) -> Result | None:
        folder = self._package(files)
        if folder is None or self.random.random() < 0.7:
            return None
        name = self.random.choice(["COLCON_IGNORE", ".gitignore", "colcon.pkg", "../deps.repos", "README.md"])
        path = os.path.normpath(f"{folder}{name}")
        if path.startswith(".."):
            return None
        contents = {".gitignore": b"*.pgm\nmaps/\n", "colcon.pkg": b"name: other\n"}
        repos = b"repositories:\n  nav2_util:\n    type: git\n    url: https://x.org/nav2_util.git\n"
        data = repos if path.endswith(".repos") else contents.get(name, b"ros2 run nav2_util x\n")
        return ({path: None} if path in files else {path: data}), f"{path} toggled"


_TEXTS = r"\.(?:py|cpp|hpp|h|launch|yaml|yml|xml|msg|srv|txt|cmake|urdf|xacro|md|cfg)$"


def first_difference(comparison: Comparison, seed: int, count: int, undo: float = 0.4) -> str:
    """Make ``count`` random edits. Return a description of the first after which the results differ, "" if there is none.

    With the probability ``undo``, an edit is undone after it has been compared.
    """
    edits = Edits(seed)
    done: list[str] = []
    for number in range(count):
        files = {**comparison.files, **comparison.unsaved}
        changes, description = edits.next(files)
        in_editor = all(data is not None and path in files for path, data in changes.items())
        saved = not in_editor or edits.random.random() < 0.5
        before = {path: files.get(path) for path in changes}
        done.append(f"{number}: {description} ({'saved' if saved else 'unsaved'})")
        comparison.apply(changes, saved=saved)
        if difference := _difference(comparison):
            return "\n".join([*done[-8:], difference])
        if edits.random.random() < undo:
            comparison.apply(before, saved=saved)
            done.append(f"{number}: undone")
    return _difference(comparison)


def _difference(comparison: Comparison) -> str:
    incremental, scratch = comparison.incremental(), comparison.from_scratch()
    if incremental == scratch:
        return ""
    lines, expected = incremental.splitlines(), scratch.splitlines()
    only = [f"only incremental: {line}" for line in lines if line not in expected]
    return "\n".join(
        [*only, *(f"only from scratch: {line}" for line in expected if line not in lines), "other order" * (not only)]
    )
