"""Answer requests about a place in a file: hover text, definition and uses of the name at the place, and completions."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.analysis.launch.files import installed_programs
from ros_lint.base.text import Span
from ros_lint.facts.manifest import DEPENDENCY_KINDS

if TYPE_CHECKING:
    from ros_lint.base.text import Text
    from ros_lint.cli.commands.lsp.positions import Place
    from ros_lint.cli.commands.lsp.project import Snapshot
    from ros_lint.workspace.model import Package, Workspace

_MOST_USES = 5
"""Maximum number of uses in a hover text."""

MOST_COMPLETIONS = 200
"""Maximum number of completions."""


class Target(NamedTuple):
    """A name in a file that has a definition: the name of a package, or of an executable, class or file in a package."""

    span: Span
    """The place of the name in the file."""
    package: str
    """Name of the package or rosdep key."""
    name: str = ""
    """Name of the executable, class or file in the package, "" for the package itself."""
    kind: str = "package"
    """Kind of the name: package, node, component, include (of a launch file), file, header or import."""


def targets(workspace: Workspace, path: str) -> Iterator[Target]:
    """Yield the names in a file that refer to packages, or to executables, classes or files of packages, unsorted."""
    for package in workspace.packages:
        if package.manifest is not None and package.manifest.path == path:
            yield Target(package.manifest.name_span, package.name)
            for depend in package.manifest.depends:
                yield Target(depend.span, depend.name)
        for launch in package.launch:
            if launch.path == path:
                for reference in launch.references:
                    yield Target(reference.package_span, reference.package)
                    if reference.name:
                        yield Target(reference.span, reference.package, reference.name, reference.kind)
        for use in package.uses:
            if use.span.path == path:
                kind = {"include": "header", "import": "import"}.get(use.via, "package")
                yield Target(use.span, use.package, use.name if kind != "package" else "", kind)
        for lookup in package.lookups:
            if lookup.span.path == path:
                yield Target(lookup.span, lookup.package, lookup.path, "file")


def target_at(workspace: Workspace, path: str, place: Place) -> Target | None:
    """Return the name at a place: the one with the shortest span if several include the place, None if there is none."""
    here = [target for target in targets(workspace, path) if place.is_in(target.span)]
    return min(here, key=lambda target: _size(target.span), default=None)


def _size(span: Span) -> tuple[int, int]:
    return span.end_line - span.line, span.end_column - span.column


def definitions(workspace: Workspace, target: Target) -> list[Span]:
    """Return the places where a target is defined: a name in a manifest, a CMake target, a module of an entry point, or a file.

    The list is empty for packages outside of the workspace. If the definition is not found in the package, the place of
    the package is returned.
    """
    packages = workspace.called(target.package)
    found = [span for package in packages for span in _in_package(package, target)]
    return list(dict.fromkeys(found)) or [package.span for package in packages]


def _in_package(package: Package, target: Target) -> Iterator[Span]:
    name = target.name
    if not name:
        return
    products = package.built.products
    if target.kind == "node":
        modules = {module.name: module.path for module in package.built.python.entry_point_modules}
        for entry in products.entry_points:
            if entry.name == name and entry.group == "console_scripts" and entry.module in modules:
                yield package.start_of(modules[entry.module])
                return
        for installed in products.installs:
            if installed.path == f"lib/{package.name}/{name}":
                yield from _source(package, installed.source, installed.target)
    elif target.kind in ("include", "file"):
        for installed in products.installs:
            if installed.path == f"share/{package.name}/{name}" and installed.source:
                yield package.start_of(installed.source)
    elif target.kind == "header":
        ending = f"/{name}"
        for installed in products.installs:
            if installed.source and installed.path.startswith("include/") and installed.path.endswith(ending):
                yield package.start_of(installed.source)
    elif target.kind == "component":
        yield from (registration.span for registration in package.registrations if registration.name == name)
    elif target.kind == "import":
        yield from _module(package, name)


def _module(package: Package, name: str) -> Iterator[Span]:
    """Yield the start of the file of a Python module of a package. ``name`` may be dotted."""
    path = name.replace(".", "/")
    for file in (f"{path}.py", f"{path}/__init__.py"):
        if file in package.files:
            yield package.start_of(file)


def _source(package: Package, source: str, target: str) -> Iterator[Span]:
    """Yield the definition of an installed program: the start of its source, or the command that creates its CMake target."""
    if source:
        yield package.start_of(source)
    for built in package.built.products.targets:
        if target and built.name == target:
            yield built.span


def references(workspace: Workspace, name: str) -> list[Span]:
    """Return the places that refer to a package: dependency tags, uses in sources, and references in launch files."""
    spans = []
    for package in workspace.packages:
        if package.manifest is not None:
            spans += [depend.name_span for depend in package.manifest.depends if depend.name == name]
        spans += [use.span for use in package.uses if use.package == name]
        spans += [
            reference.package_span for launch in package.launch for reference in launch.references if reference.package == name
        ]
    return sorted(set(spans))


def describe(snapshot: Snapshot, target: Target, owner: Package | None) -> str:
    """Return the hover text of a target in Markdown: its kind and origin, and the places where the package ``owner`` uses it."""
    workspace = snapshot.workspace
    lines = [f"**{target.package}**: {_origin(workspace, target.package)}"]
    if target.name:
        lines.append(f"`{target.name}`: {_thing(workspace, target)}")
    if owner is not None:
        tags = sorted({f"`<{declared.depend.tag}>`" for declared in owner.tags(target.package)})
        uses = [use for use in owner.uses if target.package in use.providers]
        if tags:
            lines.append(f"Declared by '{owner.name}' as {', '.join(tags)}.")
        if uses:
            listed = "\n".join(f"- `{use.what}` in {use.span.path}:{use.span.line}" for use in uses[:_MOST_USES])
            more = f"\n- and {len(uses) - _MOST_USES} more" if len(uses) > _MOST_USES else ""
            lines.append(f"Used by '{owner.name}':\n\n{listed}{more}")
        elif tags:
            lines.append(f"No use in '{owner.name}' was found.")
    return "\n\n".join(lines)


def _origin(workspace: Workspace, name: str) -> str:
    world, distro = workspace.world, workspace.target.distro
    packages = workspace.called(name)
    if packages:
        return f"package of this workspace in {packages[0].path or '.'}"
    version = world.version(name)
    match world.layer(name):
        case "underlay":
            return f"package of an underlay{f', version {version}' if version else ''}"
        case "index":
            return f"released in {distro}{f', version {version}' if version else ''}"
    if world.is_key(name):
        return "rosdep key"
    return {
        "elsewhere": f"not released in {distro}, but in another distribution",
        "end-of-life": "released in distributions at their end of life only",
        "unknowable": "not found, but a repository or data is missing",
    }.get(world.resolution(name), f"unknown in {distro}")


def _thing(workspace: Workspace, target: Target) -> str:
    packages = workspace.called(target.package)
    spans = [span for package in packages for span in _in_package(package, target)]
    programs = [installed_programs(package) for package in packages] if target.kind == "node" else []
    installed = any(of_package is not None and target.name in of_package.names for of_package in programs)
    ending = f", installed as `lib/{target.package}/{target.name}`" if installed else ""
    if spans:
        return f"defined in {spans[0].path}:{spans[0].line}{ending}"
    return f"not found in '{target.package}'" if packages else f"in '{target.package}'"


_TAGS = "|".join(tag for tag in DEPENDENCY_KINDS if tag not in ("member_of_group", "group_depend"))
_IN_TAG = re.compile(rf"<(?:{_TAGS})\b[^<>]*>([\w.+-]*)\Z")
_PACKAGE_VALUE = re.compile(
    r"""(?:\b(?:package|pkg)\s*=\s*|\bpkg:\s*|\b(?:get_package_share_directory|FindPackageShare)\(\s*)["']?([\w-]*)\Z"""
)
_EXECUTABLE_VALUE = re.compile(r"""(?:\bexecutable\s*=\s*|\bexec\s*=\s*|\bexec:\s*)["']?([\w.-]*)\Z""")
_SHARE_PATHS = (
    re.compile(r"\$\(find-pkg-share (?P<package>[\w-]+)\)(?P<folders>)/(?P<word>[\w./-]*)\Z"),
    re.compile(
        r"""\b(?:get_package_share_directory|FindPackageShare)\(\s*["'](?P<package>[\w-]+)["']\s*\)\s*,"""
        r"""(?P<folders>(?:\s*["'][\w./-]*["']\s*,)*)\s*["'](?P<word>[\w./-]*)\Z"""
    ),
)
"""The beginning of the path of an installed file in a launch file: of XML, and of Python with the parts of a joined path."""
_FOLDER = re.compile(r"[\w./-]+")
_PACKAGE = re.compile(r"""\b(?:package|pkg)\s*[=:]\s*["']?([\w-]+)""")
_MOST_LINES = 6
"""Number of lines above the name of an executable in which the name of its package is searched for."""


def completions(workspace: Workspace, text: Text, place: Place) -> tuple[str, Sequence[str]]:
    """Return the word before a place, and at most 200 names that begin with the word and can replace it.

    In a dependency tag, these are names of packages and rosdep keys; in a launch file, names of packages, of the programs
    that packages install, and of the files in their share folders.
    """
    try:
        before = text.line(place.line)[: place.column - 1]
    except IndexError:
        return "", ()
    if (match := _IN_TAG.search(before)) and text.path.endswith("package.xml"):
        world = workspace.world
        names = {*workspace.by_name, *world.knowledge.index.names(), *world.knowledge.rosdep.names()}
    elif match := _PACKAGE_VALUE.search(before):
        names = set(workspace.by_name)
    elif match := _EXECUTABLE_VALUE.search(before):
        names = _programs(workspace, text, place)
    elif match := next(filter(None, (pattern.search(before) for pattern in _SHARE_PATHS)), None):
        names = _shared_files(workspace, match["package"], "/".join(_FOLDER.findall(match["folders"])))
    else:
        return "", ()
    word = match[match.lastindex or 0]
    of_workspace = set(workspace.by_name)
    fitting = sorted(
        (name for name in names if name.startswith(word)),
        key=lambda name: (name not in of_workspace, ".launch" not in name, name),
    )
    return word, fitting[:MOST_COMPLETIONS]


def _programs(workspace: Workspace, text: Text, place: Place) -> set[str]:
    """Return the programs of the package whose name is nearest above a place."""
    above = [text.line(number) for number in range(max(1, place.line - _MOST_LINES), place.line)]
    before = "\n".join([*above, text.line(place.line)])
    names = _PACKAGE.findall(before)
    programs = [installed_programs(package) for package in workspace.called(names[-1])] if names else []
    return {name for installed in programs if installed for name in installed.names}


def _shared_files(workspace: Workspace, name: str, folder: str) -> set[str]:
    """Return the paths of the files that a package installs below a folder of its share folder, relative to this folder."""
    start = f"share/{name}/{folder}/" if folder else f"share/{name}/"
    installs = [installed.path for package in workspace.called(name) for installed in package.built.products.installs]
    return {path.removeprefix(start) for path in installs if path.startswith(start)}


def links(workspace: Workspace, path: str) -> Iterator[tuple[Span, Span]]:
    """Yield pairs for the links in a launch file: the place of a file's name, and the start of the file in the workspace."""
    for target in targets(workspace, path):
        if target.kind in ("include", "file") and target.name:
            for package in workspace.called(target.package):
                yield from ((target.span, span) for span in _in_package(package, target))
