"""What several rules ask of a package: which launch files count, which files are used, and what can be started from it."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from ros_lint.analysis.finding import Fix
from ros_lint.analysis.memo import cached_by_workspace
from ros_lint.base.auxiliary_files import in_auxiliary_folder, is_auxiliary, is_backup_copy
from ros_lint.base.edit import Edit
from ros_lint.base.paths import strip_folder
from ros_lint.base.text import Span
from ros_lint.facts.launch import LaunchFile, LaunchReference
from ros_lint.facts.sources import LookUp
from ros_lint.facts.visibility import Facet
from ros_lint.workspace.model import Package, Workspace


class PackageLaunchFile(NamedTuple):
    """A launch file with its place in the package."""

    file: LaunchFile
    path: str
    """Relative to the package."""
    installed: bool
    run: bool = True
    """Whether somebody runs it: people, unless it is a test, an example or a template; the tests of the package."""


def package_launch_files(package: Package, *, apart: bool = False) -> Iterator[PackageLaunchFile]:
    """Yield the launch files that are there to be launched: no mere helpers, and tests and examples only if asked for."""
    if not package.launch:  # so it is with most packages, and many rules ask
        return
    script = package.built
    installed = {provided.source: provided.conditional for provided in script.installs if provided.source}
    tests = frozenset(script.interpreted_tests or ())
    modules = tuple(f"{module.replace('.', '/')}/" for module in script.python_packages)
    for file in package.launch:
        path = strip_folder(package.path, file.path)
        if file.helper:
            continue
        is_installed = path in installed or path.startswith(modules)
        # What is merely called a test, and always installed, is for people to start.
        started = is_installed and not (installed.get(path) or is_backup_copy(path))
        aside = file.test or (in_auxiliary_folder(path) if started else is_auxiliary(path))
        if apart or not aside:
            yield PackageLaunchFile(file, path, is_installed, not aside or path in tests)


def is_launch_file(package: Package, path: str) -> bool:
    """Whether a file, by its path in the tree, is a launch file of ROS 2."""
    return any(launch.path == path for launch in package.launch)


def used_files(package: Package) -> frozenset[str]:
    """Return the files of a package that are seen to be installed, built, launched or part of its build script."""
    script = package.built
    modules = tuple([f"{module.replace('.', '/')}/" for module in script.python_packages])
    files = set(script.installed)
    files.update(source for target in script.targets if not target.test for source in target.sources)
    files.update(launch.path for launch in package_launch_files(package))
    # A file that only sets variables may be a product of CMake and no part of the build script.
    scripts = (script.path, *(call.path for call in script.calls if call.name != "set"))
    files.update(strip_folder(package.path, path) for path in scripts)
    return frozenset(files).union([file for file in package.files if file.startswith(modules)])


def references_by_name(
    package: Package, kinds: Container[str], *, apart: bool = False
) -> dict[tuple[str, str], list[LaunchReference]]:
    """Return the references of some kinds in what :func:`launchable` yields, by the package and the name that they mean."""
    found: dict[tuple[str, str], list[LaunchReference]] = {}
    for launch in package_launch_files(package, apart=apart):
        for reference in launch.file.references:
            if reference.kind in kinds:
                found.setdefault((reference.package, reference.name), []).append(reference)
    return found


def rename_fix(title: str, text: str, places: Sequence[tuple[Span, bool]]) -> Fix | None:
    """Return the unsafe fix that writes a text at places, each with whether nothing but the name stands there.

    None where there is no text, or where something else stands at a place.
    """
    if not text or not all(exact for _, exact in places):
        return None
    return Fix.of(title, *(Edit(span, text) for span in dict.fromkeys(span for span, _ in places)), safe=False)


class InstalledPrograms(NamedTuple):
    """What a package of the workspace installs to be started."""

    names: frozenset[str]
    """In lib/<package>, where ``ros2 run`` and launch look (reference, section D5)."""
    elsewhere: dict[str, str]
    """Others by name: the path that they are installed to."""


def installed_programs(package: Package) -> InstalledPrograms | None:
    """Return what can be started from a package, None when that cannot be seen whole."""
    script = package.script
    if script is None or package.hidden(Facet.EXECUTABLES) or package.builds_with not in ("ament_cmake", "ament_python"):
        return None
    names: set[str] = set()
    elsewhere: dict[str, str] = {}
    for provided in script.installs:
        folder, _, name = provided.path.rpartition("/")
        if folder == f"lib/{package.name}":
            names.add(name)
        elif folder == "bin" or (folder.startswith("lib/") and not provided.importable):
            elsewhere.setdefault(name, provided.path)
    return InstalledPrograms(frozenset(names), elsewhere)


_SUFFIX = re.compile(r"(?:[._-]?launch\.(?:py|xml|ya?ml)|\.launch)$")


def launch_suffix(path: str) -> str:
    """Return that by which a name is one of a launch file, "" if nothing is."""
    found = _SUFFIX.search(path.rpartition("/")[2])
    return found[0] if found else ""


def is_excluded_from_install(package: Package, path: str) -> bool:
    """Whether a launch file that is not installed is so on purpose: a rule that installs its like leaves it out."""
    folder, suffix, provides = path.rpartition("/")[0], launch_suffix(path), package.built.installs
    if not suffix:
        return False
    together = Counter(provided.span for provided in provides)
    return any(
        together[provided.span] > 1 and provided.source.rpartition("/")[0] == folder and provided.source.endswith(suffix)
        for provided in provides
    )


@cached_by_workspace
def nodes_started(workspace: Workspace) -> Mapping[str, Mapping[str, Sequence[LaunchReference]]]:
    """Return where launch files start executables, by package and name."""
    return node_references(workspace.packages)


@cached_by_workspace
def files_looked_up(workspace: Workspace) -> Mapping[str, Sequence[LookUp]]:
    """Return the files that launch files and models need from the share directory of a package, by package."""
    return looked_up(workspace.packages)


def node_references(packages: Iterable[Package], *, kept_back: bool = False) -> dict[str, dict[str, list[LaunchReference]]]:
    """Return the places where launch files start executables, by package and name; those of tests count, too.

    Either of launch files that are installed, or may have been forgotten, or of those which are ``kept_back``.
    """
    found: dict[str, dict[str, list[LaunchReference]]] = {}
    for package in packages:
        installed = package.built.installed if package.launch else ()
        for launch in package.launch:
            path = strip_folder(package.path, launch.path)
            if (path not in installed and is_excluded_from_install(package, path)) is not kept_back:
                continue
            for reference in [reference for reference in launch.references if reference.kind == "node"]:
                found.setdefault(reference.package, {}).setdefault(reference.name, []).append(reference)
    return found


def looked_up(packages: Iterable[Package]) -> dict[str, list[LookUp]]:
    """Return the files that launch files and models need from the share directory of a package, by package."""
    found: dict[str, list[LookUp]] = {}
    for package in packages:
        for launch in package_launch_files(package):
            for reference in launch.file.references:
                if reference.kind in ("file", "include") and not reference.optional:
                    one = LookUp(reference.package, reference.name, reference.span)
                    found.setdefault(one.package, []).append(one)
        for look_up in package.lookups:
            if not is_auxiliary(strip_folder(package.path, look_up.span.path)):
                found.setdefault(look_up.package, []).append(look_up)
    return found
