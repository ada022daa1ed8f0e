"""
## What it finds

Dependencies that `ament_export_dependencies()` lacks:

- Packages that installed headers include.
- Packages whose targets an exported library links publicly: arguments of `target_link_libraries()` without `PRIVATE`, and of
  `ament_target_dependencies()`, if the package is known to export targets.
- `generate_parameter_library`, if it generates an exported library.
- In addition to one of these packages: libraries outside of ROS whose targets an exported library links publicly, such as
  `Threads`.

Also reported: `Qt5` and `Qt6` in `ament_export_dependencies()`, which cannot pass components.

One rule reports both, because a package that finds this one lacks the dependency in either case. All packages that are
certainly missing in `ament_export_dependencies()` are one finding.

## Why it matters

Packages that find this package get neither the include directories nor the targets of the dependency. Its headers do not
compile there, unless they also find the dependency themselves. If a library in `ament_export_targets()` links targets of the
dependency, `find_package()` of this package fails: "imported targets are referenced, but are missing".

Qt5 and Qt6 cannot be found without components. Then `find_package()` of this package fails too, unless Qt was found before.

## How to fix it

Add `ament_export_dependencies(other)` before `ament_package()`, with the name used in `find_package()`: `gz-sim`, not
`gz_sim_vendor`. The fix adds it. The fix is unsafe, because dependents of this package then find the other package too.

For Qt, write `find_package(Qt5 REQUIRED COMPONENTS Widgets)` into a CMake file, and install it with
`ament_package(CONFIG_EXTRAS file.cmake)`, as `rviz_common` does.

## Limitations

Not reported:

- Packages with `ament_auto_package()`, which exports all dependencies.
- `DEPENDENCIES` of `rosidl_generate_interfaces()`, which are exported, and packages that a `CONFIG_EXTRAS` file finds.
- Qt after an exported package that depends on Qt, because that package finds Qt.
- Headers that are not installed or are installed under a condition, and scripts that cannot be fully analysed.
- Packages that the script does not find and the manifest does not declare: other rules report them.
- Targets that are linked in functions or under conditions, or that an exported dependency provides.
- Headers of test tools, such as `ament_cmake_gtest`.
- Libraries outside of ROS that are found with components, and all such libraries if nothing else is missing, because another
  exported package may find them.

Reported with medium confidence:

- Another exported package depends on the included package. Dependents find it as long as that package exports it, so the
  severity is info.
- An exported dependency whose own dependencies are unknown may provide the package.
- The package exports no include directories, so its headers may be only for itself.
- An exported target or `ament_export_include_directories()` contains the include directories of the other package literally.
- The package exports no library that it builds, and the header belongs to a source of a program or of a plugin. Its
  declarations cannot be linked elsewhere.
- Qt without components, because packages that need Qt usually find it before.
- Public links of a package that installs no headers: its libraries are plugins, and other packages do not find it with CMake.

The confidence is low if the header cannot be compiled in other packages, because it includes a file that is not installed, or a
package that exists only in ROS 1.
"""

from __future__ import annotations

import re
from collections.abc import Container, Iterable, Iterator, Sequence

from ros_lint.api import (
    BuildScript,
    Confidence,
    Facet,
    Finding,
    Fix,
    Package,
    Related,
    Role,
    Rule,
    Severity,
    Span,
    Use,
    Workspace,
    build,
    dependencies,
    edits,
    files,
    first_related,
    names,
)

_EXPORTS = frozenset({"ament_export_include_directories", "ament_export_targets", "ament_export_interfaces"})
_EXPORTS_ALL = frozenset({"ament_auto_package", "autoware_ament_auto_package"})
_TOOL_PREFIX = "ament_cmake_"


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    included = list(_included(package, workspace))
    linked = list(_linked(package, workspace, {finding.subject for _, finding in included}))
    certain = [lack for lack in (*included, *linked) if _is_certain(lack)]
    lacks = [lack for lack in (*included, *linked) if lack not in certain]
    if certain:
        of_system = tuple(_linked_of_system(package, workspace))
        lacks.insert(0, _together(certain, [lack for lack in linked if lack in certain], of_system))
    for all_names, finding in lacks:
        edit = edits.cmake.export_dependencies(package, all_names) if all_names else None
        yield finding._replace(fix=Fix.of(f"export {names.shorten_list(all_names)}", edit, safe=False))
    yield from _without_components(package, workspace)


Lack = tuple[tuple[str, ...], Finding]
"""The CMake names of the packages to export, and the finding. The names are () if it is uncertain that exporting suffices."""


def _is_certain(lack: Lack) -> bool:
    all_names, finding = lack
    return bool(all_names) and finding.confidence is Confidence.HIGH and finding.severity is None


def _together(lacks: Sequence[Lack], linked: Sequence[Lack], of_system: tuple[str, ...]) -> Lack:
    """Return one finding for all packages that a single ament_export_dependencies() has to export.

    ``lacks``: the separate findings. ``linked``: those of the findings that are about linked packages, not about includes.
    ``of_system``: names of find_package() outside of ROS that exported libraries link as well.
    """
    (first_names, first), *others = lacks
    if not (others or of_system):
        return first_names, first
    all_names = tuple(dict.fromkeys([*(name for cmake_names, _ in lacks for name in cmake_names), *of_system]))
    who = "installed headers or exported libraries use" if linked or of_system else "installed headers include"
    related = (
        Related(f"{names.shorten_list(cmake_names)} {'is' if len(cmake_names) == 1 else 'are'} needed here", finding.span)
        for cmake_names, finding in others
    )
    message = (
        f"{who} {names.shorten_list(all_names)}, but packages that use this package do not find them; "
        f"add ament_export_dependencies({' '.join(all_names)})"
    )
    return all_names, Finding(message, first.span, first.subject, first_related([*related, *first.related]))


def _is_seen(package: Package) -> bool:
    """Return whether all exports of a package are known and are written as commands in its CMakeLists.txt."""
    script = package.script
    if script is None or build.stops_early(script) or package.builds_with != "ament_cmake":
        return False
    return not (script.hides(Facet.EXPORTS) or _EXPORTS_ALL.intersection(script.commands.names))


def _linked(package: Package, workspace: Workspace, reported: Container[str]) -> Iterator[Lack]:
    """Yield findings about unexported packages whose targets an exported library links publicly.

    Each finding comes with the CMake names of the packages. The names are () if dependents may find the packages
    nevertheless. ``reported``: packages that are left out.
    """
    script = package.script
    if script is None or not _is_seen(package):
        return
    found = dependencies.names_searched(package, script)
    closure = dependencies.partial_closure(workspace, dependencies.names_exported(package, script), dependencies.names_exported)
    places: dict[str, list[Span]] = {}
    for name, span in _linked_publicly(package, workspace):
        if name in found and name not in reported and workspace.world.is_package(name):
            places.setdefault(name, []).append(span)
    all_names = [name for name in places if name not in closure]
    sure = [name for name in all_names if closure.complete or not dependencies.may_provide(closure.unknown, name, workspace)]
    usable = Confidence.HIGH if _has_headers(script) else Confidence.MEDIUM
    for group, confidence in ((sure, usable), ([name for name in all_names if name not in sure], Confidence.MEDIUM)):
        if not group:
            continue
        (_, first), *others = [(name, span) for name in group for span in places[name]]
        message = (
            f"an exported library links targets of {names.shorten_list(group)}, but packages that use this package do not find "
            f"them; add ament_export_dependencies({' '.join(group)})"
        )
        related = first_related(Related(f"'{name}' is also linked publicly here", span) for name, span in others)
        yield tuple(group) if group is sure else (), Finding(message, first, group[0], related, confidence=confidence)


def _linked_of_system(package: Package, workspace: Workspace) -> Iterator[str]:
    """Yield the unexported libraries outside of ROS, such as Threads, that an exported library links publicly.

    Left out are libraries that are found with components, because an exported dependency cannot pass them.
    """
    script = package.script
    assert script is not None
    calls = [call.texts for call in package.calls("find_package", anywhere=True)]
    found = {texts[0] for texts in calls if texts and {"COMPONENTS", "OPTIONAL_COMPONENTS"}.isdisjoint(texts)}
    linked = dict.fromkeys([name for name, _ in _linked_publicly(package, workspace)])
    exported = dependencies.names_exported(package, script)
    for name in linked:
        if name in found and name not in exported and not any(map(workspace.world.is_package, (name, name.lower()))):
            yield name


def _without_components(package: Package, workspace: Workspace) -> Iterator[Finding]:
    """Yield findings for exported packages that CMake only finds with components (Qt).

    ament_export_dependencies() cannot pass components.
    """
    script = package.script
    if script is None or not _is_seen(package) or build.has_extras(package):
        return
    before: list[str] = []
    for call in package.calls("ament_export_dependencies", anywhere=True):
        if call.blocks:
            return
        for index, name in enumerate(call.texts):
            if name in _COMPONENTS_ONLY and _is_without(workspace, before, _COMPONENTS_ONLY[name]):
                yield Finding(
                    f"{call.name}() cannot pass components, so find_package({package.name}) fails unless '{name}' was found "
                    f"before; find '{name}' with components in a CONFIG_EXTRAS file of ament_package()",
                    call.span(index),
                    name,
                    confidence=Confidence.MEDIUM,
                )
            before.append(name)


def _is_without(workspace: Workspace, all_names: Iterable[str], keys: re.Pattern[str]) -> bool:
    """Return whether packages certainly do not depend, directly or indirectly, on a rosdep key that matches ``keys``.

    ``all_names``: the CMake names of the packages.
    """
    packages = [provider for name in all_names for provider in workspace.world.by_cmake(name).names or (name,)]
    closure = workspace.world.closure(packages)
    return closure.complete and not any(keys.match(key) for key in closure)


_COMPONENTS_ONLY = {"Qt5": re.compile("qt.*5|libqt5|rviz_"), "Qt6": re.compile("libqt6|qt6-|rviz_")}
"""CMake packages that can only be found with components, with patterns of packages that find them for dependents.

The patterns also match the rosdep keys that install them.
"""


def _has_headers(script: BuildScript) -> bool:
    """Return whether the package installs headers. A package without headers has only plugins, which no package links.

    Generated headers do not count, because they serve the package itself, e.g. the parameters of a plugin.
    """
    return script.hides(Facet.SHARE) or any(
        provided.path.endswith(files.HEADERS) and provided.source for provided in script.products.installs
    )


def _exported_targets(script: BuildScript) -> frozenset[str]:
    """Return the targets that dependents of the package can link."""
    return frozenset([export.target for export in script.exports.targets if export.reaches_dependents])


def _linked_publicly(package: Package, workspace: Workspace) -> Iterator[tuple[str, Span]]:
    """Yield the packages whose targets an exported library links publicly, with the place."""
    exported = _exported_targets(package.built)
    kinds = ("library", "interface")
    libraries = {target.name for target in package.built.products.targets if target.name in exported and target.kind in kinds}
    for call in package.calls("target_link_libraries"):
        if not call.args or call.blocks or build.evaluated_name(package, call.texts[0]) not in libraries:
            continue
        public = True
        for index, word in enumerate(call.texts[1:], 1):
            if word in ("PUBLIC", "INTERFACE", "PRIVATE"):
                public = word != "PRIVATE"
            elif public and (match := _TARGET.match(word)):
                yield match[1] or match[2], call.span(index)
    for call in package.calls("generate_parameter_library"):
        if call.args and not call.blocks and build.evaluated_name(package, call.texts[0]) in libraries:
            yield call.name, call.span(0)
    for call in package.calls("ament_target_dependencies"):
        if (
            not call.args
            or call.blocks
            or build.evaluated_name(package, call.texts[0]) not in libraries
            or "PRIVATE" in call.texts
        ):
            continue
        for index, word in enumerate(call.texts[1:], 1):
            if edits.cmake.exports_targets(word, workspace):
                yield word, call.span(index)


_TARGET = re.compile(r"([\w-]+)::[\w:-]+\Z|\$\{(\w+)_TARGETS\}\Z")


def _included(package: Package, workspace: Workspace) -> Iterator[Lack]:
    """Yield a finding about each unexported package that installed headers include.

    Each finding comes with the CMake name of the package in a tuple. The tuple is () if the finding is uncertain.
    """
    script = package.script
    if script is None or not _is_seen(package):
        return
    by_cmake = workspace.world.by_cmake
    exported = dependencies.names_exported(package, script)
    exported_packages = exported.union(*(dependencies.standing_for_first(workspace, by_cmake(name).names) for name in exported))
    finds = sorted(dependencies.names_searched(package, script))
    usable = _compilable_elsewhere(package, workspace, script)
    for name, uses in _public_includes(package, workspace, script).items():
        found = [cmake for cmake in finds if cmake == name or name in by_cmake(cmake).names[:1]]
        if name in exported_packages or not (found or _can_be_found(package, workspace, name)):
            continue
        compiled = [use for use in uses if package.relative(use.span.path) in usable]
        first, *others = compiled or uses
        # A vendor package mostly provides only the folder in which CMake finds the wrapped library.
        cmake_name = (
            next((cmake for cmake in found if cmake != name), name) if not found or name.endswith(names.VENDOR) else found[0]
        )
        remedy = f"add {'' if found else f'find_package({cmake_name} REQUIRED) and '}ament_export_dependencies({cmake_name})"
        if not compiled:
            remedy += ", or do not install the header, because other packages cannot compile it"
        confidence, severity = _certainty(package, workspace, name, exported, compiled) if compiled else (Confidence.LOW, None)
        lost = "; " if severity is None else ", so packages that use this package find it only through other exported packages; "
        yield (
            (cmake_name,) if found and (severity or confidence is Confidence.HIGH) else (),
            Finding(
                f"'{name}' is included by this installed header, but not exported{lost}{remedy}",
                first.span,
                name,
                first_related(dependencies.use_note(name, use, "is also included here") for use in others),
                None,
                confidence,
                severity,
            ),
        )


def _can_be_found(package: Package, workspace: Workspace, name: str) -> bool:
    """Return whether find_package() can find the package ``name`` by its package name.

    It can if the package is built with ament_cmake and declared for more than tests.
    """
    others = workspace.by_name.get(name, ())
    released = workspace.world.released(name)
    built = {other.builds_with for other in others} or {released.build_type if released else ""}
    return built == {"ament_cmake"} and bool(package.declares(name) & ~Role.TEST)


def _certainty(
    package: Package, workspace: Workspace, name: str, exported: frozenset[str], uses: list[Use]
) -> tuple[Confidence, Severity | None]:
    """Return the confidence and the severity of the finding for a package that installed headers include.

    The severity is info if a package in ``exported`` depends on ``name``, because dependents then find ``name`` through it.
    Otherwise it is None, which means the severity of the rule.
    """
    script = package.script
    assert script is not None
    closure = dependencies.partial_closure(workspace, exported, dependencies.names_exported)
    provided = all(any(provider in closure for provider in use.providers) for use in uses)
    if provided:
        return Confidence.MEDIUM, Severity.INFO
    if not closure.complete and dependencies.may_provide(closure.unknown, name, workspace):
        return Confidence.MEDIUM, None
    if _internal_sources(package, script).issuperset([build.stem(use.span.path) for use in uses]):
        return Confidence.MEDIUM, None
    sure = _EXPORTS.intersection(script.commands.names) and not _is_written_out(package, workspace, name)
    return Confidence.HIGH if sure else Confidence.MEDIUM, None


def _internal_sources(package: Package, script: BuildScript) -> frozenset[str]:
    """Return the sources of programs and of libraries that are not exported, without folder and suffix.

    The result is empty if an exported library has sources. Programs of a single source are left out, because their headers may
    be for other packages.
    """
    built = [target for target in script.products.targets if not target.test]
    words = [text for call in package.calls("ament_export_libraries", anywhere=True) for text in call.texts]
    exported_names = {*_exported_targets(script), *(build.evaluated_name(package, word) for word in words)}
    if None in exported_names:
        return frozenset()
    inner = [target for target in built if target.kind == "executable" or target.name not in exported_names]
    outer = [target for target in built if target not in inner]
    if any(target.sources for target in outer) or not all(target.sources_known for target in built):
        return frozenset()
    all_names: set[str] = set()
    for target in inner:
        sources = [source for source in target.sources if not source.endswith(files.HEADERS)]
        if len(sources) > 1 or target.kind == "library":
            all_names.update(map(build.stem, sources))
    return frozenset(all_names)


def _is_written_out(package: Package, workspace: Workspace, name: str) -> bool:
    """Return whether the include directories of the package ``name`` are exported or public.

    They are if a call names their variable, e.g. ``ament_export_include_directories(${x_INCLUDE_DIRS})``.
    """
    calls = package.calls("target_include_directories", "ament_export_include_directories", anywhere=True)
    words = [word for call in calls if "PRIVATE" not in call.texts for word in call.texts]
    cmake_names = [match[1] for word in words if (match := _DIRECTORIES.fullmatch(word))]
    return any(cmake.lower() == name.lower() or name in workspace.world.by_cmake(cmake).names for cmake in cmake_names)


_DIRECTORIES = re.compile(r"\$\{(\w+?)_INCLUDE_DIRS?\}")


def _public_includes(package: Package, workspace: Workspace, script: BuildScript) -> dict[str, list[Use]]:
    """Return the includes in installed headers by included package: a ROS package, or a library with a vendor package."""
    is_package = workspace.world.is_package
    installed = _installed(script)
    finds = dependencies.names_searched(package, script)
    uses: dict[str, list[Use]] = {}
    for use in _includes(package):
        known = any(is_package(name) for name in use.providers if name == use.package or name.endswith(names.VENDOR))
        known = known or (use.package in finds and _is_unavailable(package, workspace, use))
        tool = any(name.startswith(_TOOL_PREFIX) for name in use.providers)
        if use.certain and known and not tool and package.relative(use.span.path) in installed:
            uses.setdefault(use.package, []).append(use)
    return uses


def _is_unavailable(package: Package, workspace: Workspace, use: Use) -> bool:
    """Return whether a header belongs to a declared package that is neither in the workspace nor in the distribution.

    The header must be included by a path that begins with the name of the package: ``arm_msgs/msg/joint.hpp``.
    """
    unavailable = workspace.world.resolution(use.package) in ("unknown", "elsewhere")
    return unavailable and use.name.startswith(f"{use.package}/") and bool(package.declares(use.package) & ~Role.TEST)


def _compilable_elsewhere(package: Package, workspace: Workspace, script: BuildScript) -> set[str]:
    """Return the installed headers that other packages can compile and probably use.

    A folder that is installed with the sources of a target is probably not meant for other packages.
    """
    standing = workspace.world.resolution
    old = {package.relative(use.span.path) for use in _includes(package) if standing(use.package) == "end-of-life"}
    installed = _installed(script)
    compiled = {source for target in script.products.targets for source in target.sources if not source.endswith(files.HEADERS)}
    folders = {source.rpartition("/")[0] for source in installed & compiled}
    with_sources = {header for header in installed if header.rpartition("/")[0] in folders}
    return installed.difference(package.unusable_headers, old, with_sources)


def _includes(package: Package) -> Iterator[Use]:
    for use in package.uses:
        if use.via == "include" and not use.optional and use.role & Role.EXPORT:
            yield use


def _installed(script: BuildScript) -> set[str]:
    """Return the sources of the files that are certainly installed into include/."""
    return {file.source for file in script.products.installs if file.path.startswith("include/") and not file.conditional}


RULE = Rule(
    name="unexported-dependency",
    code="ROS207",
    summary="dependencies of installed headers and exported libraries are exported",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
