"""Find the distributions that a repository builds for: CI configuration, container files, the branch or the README name them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Final

from ros_lint.base.paths import join
from ros_lint.base.tree import Tree
from ros_lint.workspace.target import NamedDistro

_FOLDERS: Final = (".github/workflows", "", ".devcontainer", ".docker", "docker")
_MOST_FILES: Final = 30
"""Maximum number of files to read in each folder."""
_MOST_BYTES: Final = 1 << 16
"""Maximum size of the files in bytes. Larger files are generated, not written by hand."""

_BUILD_FILE = re.compile(
    r"(?i)Dockerfile[^/]*|[^/]*\.Dockerfile|Containerfile|(?:docker-)?compose[^/]*\.ya?ml|devcontainer\.json|\.gitlab-ci\.yml"
)
_WORKFLOW = re.compile(r"[^/]*\.ya?ml")
_README = re.compile(r"(?i)README(?:\.md|\.rst|\.txt)?")

_PLACE = re.compile(r"\bros[:-]([a-z]+)\b|/opt/ros/([a-z]+)")
"""Matches an image, a Debian package or a folder: ``osrf/ros:humble-desktop``, ``ros-humble-rviz2``, ``/opt/ros/humble``."""
_KEY = re.compile(r"""(?i)\bros2?[-_]?(?:distro|distribution)s?["']?\s*[:=]?\s*(.*)""")
"""Matches a variable or a key of YAML or JSON: ``ROS_DISTRO=humble``, ``ros_distro: [humble, jazzy]``."""
_ITEM = re.compile(r"\s*-\s+(.*)")
_BADGE = re.compile(r"(?i)\bbadge\b|img\.shields\.io")
_WORD = re.compile(r"[A-Za-z]+")


def named_distros(tree: Tree, roots: Sequence[str], known: Mapping[str, bool]) -> tuple[NamedDistro, ...]:
    """Return each distribution that the repository names, with the place of the first occurrence, in the order of the files.

    ``known`` has the distributions to search for; the value is True if ros-lint has an index of the distribution's packages.
    Searched are the base folder, the ``roots``, and a few subfolders of both, e.g. ``.github/workflows``. The branch of git
    counts only if none of these files names a distribution, and a README only if the branch does not name one either.
    """
    tops = dict.fromkeys(("", *roots))
    files = [path for top in tops for folder in _FOLDERS for path in _files(tree, join(top, folder) if folder else top)]
    places = [named for path in files for named in _in_build_file(path, _lines(tree, path), known)]
    places = places or [named for top in tops for named in _in_branch(tree, join(top, ".git/HEAD"), known)]
    if not places:
        readmes = [path for top in tops for path in _matching(tree, top, _README)]
        places = [named for path in readmes for named in _in_readme(path, _lines(tree, path), known)]
    first: dict[str, NamedDistro] = {}
    for place in places:
        first.setdefault(place.distro, place)
    return tuple(first.values())


def _files(tree: Tree, folder: str) -> list[str]:
    return _matching(tree, folder, _WORKFLOW if folder.endswith(".github/workflows") else _BUILD_FILE)


def _matching(tree: Tree, folder: str, pattern: re.Pattern[str]) -> list[str]:
    try:
        entries = tree.list(folder)
    except OSError:
        return []
    names = [entry.name for entry in entries if entry.kind == "file" and pattern.fullmatch(entry.name)]
    return [join(folder, name) for name in names[:_MOST_FILES]]


def _lines(tree: Tree, path: str) -> list[str]:
    """Return the lines of a file, [] if the file is unreadable or too large."""
    try:
        data = tree.read(path) if tree.stamp(path).size <= _MOST_BYTES else b""
    except OSError:
        return []
    return data.decode("utf-8", "replace").splitlines()


def _in_build_file(path: str, lines: Sequence[str], known: Mapping[str, bool]) -> Iterator[NamedDistro]:
    """Yield the distributions that a build file (CI configuration or container file) names.

    The names are in container images, in the values of variables and keys, and in YAML lists below a key.
    """
    in_list = False
    for number, line in enumerate(lines, 1):
        code = line.partition(" #")[0]
        if code.lstrip().startswith(("#", "//")):
            continue
        item = _ITEM.match(code) if in_list else None
        key = _KEY.search(code)
        in_list = item is not None or (key is not None and not key[1].strip())
        text = item[1] if item else key[1] if key else ""
        names = [match[1] or match[2] for match in _PLACE.finditer(code)]
        names += [word.lower() for word in _WORD.findall(text)]
        yield from (NamedDistro(name, path, number, known[name]) for name in names if name in known)


_BRANCH = re.compile(r"ref: refs/heads/([a-z]+)(?:[-_/]|\Z)")
"""Matches the branch in ``.git/HEAD``: ``humble``, ``humble-devel``."""


def _in_branch(tree: Tree, path: str, known: Mapping[str, bool]) -> Iterator[NamedDistro]:
    """Yield the distribution whose name begins the name of the current git branch: humble for ``humble-devel``."""
    for line in _lines(tree, path)[:1]:
        branch = _BRANCH.match(line)
        if branch and branch[1] in known:
            yield NamedDistro(branch[1], path, 1, known[branch[1]])


def _in_readme(path: str, lines: Sequence[str], known: Mapping[str, bool]) -> list[NamedDistro]:
    """Return the distributions that a README names in lines with a badge.

    Without such lines, the result is the distribution that the text names after "ROS 2". A text that names several
    distributions may compare them, so the result is then [].
    """
    in_badges = list(_names_in(path, ((n, _WORD.findall(line)) for n, line in enumerate(lines, 1) if _BADGE.search(line)), known))
    if in_badges:
        return in_badges
    in_text = list(_names_in(path, ((number, _IN_TEXT.findall(line)) for number, line in enumerate(lines, 1)), known))
    return in_text[:1] if len({named.distro for named in in_text}) == 1 else []


def _names_in(path: str, words: Iterable[tuple[int, Sequence[str]]], known: Mapping[str, bool]) -> Iterator[NamedDistro]:
    """Yield the words that are names of distributions. ``words`` has the words of each line with the number of the line."""
    for number, in_line in words:
        yield from (NamedDistro(word.lower(), path, number, known[word.lower()]) for word in in_line if word.lower() in known)


_IN_TEXT = re.compile(r"(?i)(?<![a-z])ROS[ -]?2?[ -]{1,2}\(?\*{0,2}([a-z]+)")
"""Matches the word after "ROS 2" in a text: ``ROS 2 Jazzy``, ``ROS2-Humble``, ``ROS (Iron)``."""
