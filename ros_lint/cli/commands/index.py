"""``ros-lint index``: rebuild the data about released packages, or create such data from installed packages."""

from __future__ import annotations

import os
import sys
import tempfile
from datetime import datetime, timezone
from typing import TYPE_CHECKING, Any, NamedTuple

from ros_lint.base.auxiliary_files import TEST_FOLDERS
from ros_lint.cli.messages import show
from ros_lint.knowledge import index, provides, rosdep, underlays
from ros_lint.knowledge.provides import LETTERS, ReleasedContents
from ros_lint.knowledge.refresh import rosdep_rules, rosdistro
from ros_lint.knowledge.store import KnowledgeError, Store, user_directory

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from ros_lint.knowledge.underlays import Installed


class Refreshed(NamedTuple):
    """A data file that was written, with its number of lines and the numbers of added, removed and changed lines."""

    path: str
    lines: int
    added: int
    removed: int
    changed: int

    def __str__(self) -> str:
        return f"{self.path}: {self.lines} lines, {self.added} added, {self.removed} removed, {self.changed} changed"


def run(options: Mapping[str, Any]) -> int:
    """Run ``ros-lint index`` with its options. Return the exit code: 2 if a file cannot be read or written, else 0."""
    try:
        if options["action"] == "refresh":
            to = options["to"] or user_directory(os.environ)
            for line in refresh(options["source"], options["distro"], to, options["rosdep"]):
                print(line)
        else:
            _write_scan(options["distro"], options["to"], *scan(options["prefixes"], options["distro"]))
    except (KnowledgeError, underlays.UnderlayError) as error:
        show(str(error))
        return 2
    except OSError as error:
        show(f"{error.filename or 'data'} cannot be written: {error.strerror}")
        return 2
    return 0


def refresh(
    source: str, distros: Sequence[str], to: str, rosdep_files: Sequence[str] = (), date: str = ""
) -> tuple[Refreshed, ...]:
    """Write the ``.idx`` files of distributions, and ``rosdep.tsv`` if ``rosdep_files`` are given. Return the written files.

    ``source`` (the ``index-v4.yaml`` of rosdistro) and ``rosdep_files`` are paths or URLs. If ``distros`` is empty, all
    active ROS 2 distributions are written. ``to`` is the output folder. ``date`` is the date of the data, by default
    today. All inputs are read before a file is written. Raises KnowledgeError if an input cannot be read, and OSError if
    a file cannot be written.
    """
    date = date or _today()
    available = rosdistro.sources(source)
    unknown = [name for name in distros if name not in available]
    if unknown:
        raise KnowledgeError(f"{source} has no distribution '{unknown[0]}'; available: {', '.join(sorted(available))}")
    names = distros or sorted(name for name, entry in available.items() if entry.active)
    files = {f"{name}.idx": index.render_file(name, "", date, rosdistro.packages(available[name])) for name in names}
    if rosdep_files:
        rules = [(place, rosdistro.load_yaml(place)) for place in rosdep_files]
        files["rosdep.tsv"] = rosdep.render_file(rosdep_rules.keys(rules))
    os.makedirs(to, exist_ok=True)
    return tuple(_replace(to, name, text) for name, text in files.items())


def scan(prefixes: Sequence[str], distro: str, date: str = "") -> tuple[str, str]:
    """Return the contents of an ``.idx`` and a ``.prov`` data file for the packages in install prefixes.

    If several prefixes have a package, the first one counts. Raises UnderlayError for a folder that is not an install
    prefix.
    """
    result: dict[str, Installed] = {}
    for layer in underlays.read(prefixes, distro):
        for name, installed in layer.packages.items():
            result.setdefault(name, installed)
    described = (installed.released or index.Released(name, "", "?-", name, {}) for name, installed in result.items())
    idx = index.render_file(distro, "", date or _today(), described)
    return idx, provides.render_file(distro, (_provided(installed) for installed in result.values()))


def _provided(installed: Installed) -> ReleasedContents:
    fields = {}
    for facet, letter in LETTERS.items():
        contents = installed.known(facet)
        names = (*contents.names, *(f"{name}?" for name in contents.maybe))
        if facet == "modules" and installed.known("interfaces").names:
            # The module of an interface package is implied by its interfaces.
            names = tuple(name for name in names if name != installed.name)
        if facet == "modules":
            # Test modules that find_packages() includes are not for import; the shipped data do not have them either.
            names = tuple(name for name in names if name not in TEST_FOLDERS)
        if facet == "plugins":
            names = tuple(name.replace(" ", "") for name in names)  # the notation of the shipped data
        # Other names with a space would be ambiguous in a line.
        fields[letter] = tuple(sorted(name for name in names if " " not in name))
    return ReleasedContents(installed.name, "=", fields)


def _write_scan(distro: str, to: str, idx: str, prov: str) -> None:
    if not to:
        sys.stdout.write(idx + prov)
        return
    os.makedirs(to, exist_ok=True)
    for name, text in ((f"{distro}.idx", idx), (f"{distro}.prov", prov)):
        print(_replace(to, name, text, shipped=False))


def _replace(folder: str, name: str, text: str, *, shipped: bool = True) -> Refreshed:
    """Write a data file atomically, so that no process reads an incomplete file. Return the numbers of changed lines.

    Lines are compared with the earlier file at the path. If there is none and ``shipped`` is True, they are compared with
    the shipped data file of this name, because the new file replaces the shipped data.
    """
    path = os.path.join(folder, name)
    try:
        before = _by_name(Store((folder,)).lines(name)[1]) if shipped or os.path.exists(path) else {}
    except KnowledgeError:
        before = {}  # a damaged file is about to be replaced
    after = _by_name(text.split("\n")[1:-1])
    handle, temporary = tempfile.mkstemp(dir=folder, prefix=f".{name}.")
    try:
        with os.fdopen(handle, "w", encoding="utf-8", newline="\n") as file:
            file.write(text)
        os.chmod(temporary, 0o644)
        os.replace(temporary, path)
    except BaseException:
        os.unlink(temporary)
        raise
    changed = sum(after[key] != before[key] for key in after.keys() & before.keys())
    return Refreshed(path, len(after), len(after.keys() - before), len(before.keys() - after), changed)


def _by_name(lines: Iterable[str]) -> dict[str, str]:
    return {line.partition("\t")[0]: line for line in lines}


def _today() -> str:
    return datetime.now(timezone.utc).strftime("%Y-%m-%d")
