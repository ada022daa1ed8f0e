"""
## What it finds

Installed headers that include another package which `ament_export_dependencies()` does not name, and exported libraries that
hand on targets of one: what `target_link_libraries()` is given without `PRIVATE`, and `ament_target_dependencies()` of packages
that are known to export targets. And Qt where it is exported by its name alone, which says nothing of components.

## Why it matters

Whoever finds this package gets neither the include directories nor the targets of the other one: its headers do not
compile there, unless they happen to find the other package themselves. Where a library that `ament_export_targets()` exports
hands on targets of the other one, `find_package()` of this package stops: "imported targets are referenced, but are missing".
Qt5 and Qt6 are not found without components: then `find_package()` of this package stops as well, but for those who have
found Qt before.

## How to fix it

Add `ament_export_dependencies(other)` before `ament_package()`, with the name that `find_package()` calls it by: `gz-sim` and
not `gz_sim_vendor`. The fix does this; it needs `--unsafe-fixes`, for whoever finds this package then finds the other, too.
Of Qt, which `ament_export_dependencies()` can give no components, write `find_package(Qt5 REQUIRED COMPONENTS Widgets)` into a
CMake file, and give that to `ament_package(CONFIG_EXTRAS file.cmake)`, as `rviz_common` does.

## Limitations

- `ament_auto_package()` does the exporting, `rosidl_generate_interfaces()` that of its `DEPENDENCIES`, or a file of
  `CONFIG_EXTRAS` searches the other package itself.
- Something that depends on Qt is exported before it, and finds it.
- The header is not installed, or perhaps not, or the script cannot be followed everywhere.
- The script does not find the other package, and the manifest does not declare it: that is another mistake.
- Targets are handed on in functions or under conditions, or are those of a package that comes along with one that is exported.
- What the header includes comes with the tools that tests are built with, such as `ament_cmake_gtest`.

The confidence is medium when

- the other package comes along, or may come along, with one that is exported;
- the package exports no include directories, so that its headers may be there for itself;
- an exported target or `ament_export_include_directories()` has the include directories of the other one written out;
- the package exports no library that it builds, and the header belongs to one of the sources of a program or of a library, such
  as a plugin: what it declares can be linked nowhere else;
- it is Qt without components, which those who need Qt themselves have found before;
- targets are handed on by a package that installs no headers: its libraries are plugins, and nobody finds it by CMake.

It is low when the header compiles nowhere else, because it includes a file that is not installed, or a package that only ROS 1
has.
"""

from __future__ import annotations

import re
from collections.abc import Container, Iterable, Iterator

from ros_lint.api import (
    HEADERS,
    VENDOR,
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
    called,
    cmake_edits,
    evaluated_name,
    few,
    found_along,
    found_names,
    given_for,
    has_extras,
    is_cut_short,
    may_bring,
    relative,
    several,
    stem,
)

_EXPORTS = frozenset({"ament_export_include_directories", "ament_export_targets", "ament_export_interfaces"})
_EXPORTS_ALL = frozenset({"ament_auto_package", "autoware_ament_auto_package"})
_OF_TOOLS = "ament_cmake_"


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    included = list(_included(package, workspace))
    every = [*included, *_linked(package, workspace, {finding.subject for _, finding in included})]
    sure = list(dict.fromkeys([name for names, finding in every if finding.confidence is Confidence.HIGH for name in names]))
    for names, finding in every:
        together = sure if finding.confidence is Confidence.HIGH else names
        edit = cmake_edits.export_dependencies(package, " ".join(names), together) if names else None
        yield finding._replace(fix=Fix.of(f"export {few(names)}", edit, safe=False))
    yield from _without_components(package, workspace)


def _is_seen(package: Package) -> bool:
    """Whether all that a script exports is seen, and written there."""
    script = package.script
    if script is None or is_cut_short(script) or package.builds_with != "ament_cmake":
        return False
    return not (script.hides(Facet.USES) or _EXPORTS_ALL.intersection(script.calls))


def _exported(script: BuildScript) -> set[str]:
    """Return what whoever finds the package finds along with it, by what find_package() calls it."""
    given = {mention.name for mention in given_for(script, "export", "interfaces")}
    return given.union(mention.name for mention, _ in script.handed_on)


def _linked(package: Package, workspace: Workspace, told: Container[str]) -> Iterator[tuple[tuple[str, ...], Finding]]:
    """Yield the packages that exported libraries hand on as targets, and that whoever finds this package does not find.

    With what to say of them. There are no names where it is not sure that they are not found.
    """
    script = package.script
    if script is None or not _is_seen(package):
        return
    found = found_names(package, script)
    along = found_along(workspace, _exported(script))
    places: dict[str, list[Span]] = {}
    for name, span in _handed_on(package, workspace):
        if name in found and name not in told and workspace.world.is_package(name):
            places.setdefault(name, []).append(span)
    names = [name for name in places if name not in along]
    sure = [name for name in names if along.complete or not may_bring(along.unknown, name, workspace)]
    usable = Confidence.HIGH if _has_headers(script) else Confidence.MEDIUM
    for some, confidence in ((sure, usable), ([name for name in names if name not in sure], Confidence.MEDIUM)):
        if not some:
            continue
        first, *others = [span for name in some for span in places[name]]
        says = (
            f"an exported library hands on targets of {few(some)}, and whoever finds this package does not find them: "
            f"add ament_export_dependencies({' '.join(some)})"
        )
        related = several(Related("also handed on", span) for span in others)
        yield tuple(some) if some is sure else (), Finding(says, first, some[0], related, confidence=confidence)


def _without_components(package: Package, workspace: Workspace) -> Iterator[Finding]:
    """Yield what is exported and found with components only, of which ament_export_dependencies() says none."""
    script = package.script
    if script is None or not _is_seen(package) or has_extras(package):
        return
    before: list[str] = []
    for call in called(package, "ament_export_dependencies", anywhere=True):
        if call.blocks:
            return
        for index, name in enumerate(call.texts):
            if name in _COMPONENTS_ONLY and _is_without(workspace, before, _COMPONENTS_ONLY[name]):
                yield Finding(
                    f"{name} is not found without components, and {call.name}() names none: whoever finds {package.name} "
                    f"and not {name} before stops; find it with them in a file that ament_package(CONFIG_EXTRAS) is given",
                    call.span(index),
                    name,
                    confidence=Confidence.MEDIUM,
                )
            before.append(name)


def _is_without(workspace: Workspace, names: Iterable[str], keys: re.Pattern[str]) -> bool:
    """Whether nothing that comes along with what CMake finds is a library of Qt, as far as that is known."""
    packages = [provider for name in names for provider in workspace.world.by_cmake(name).names or (name,)]
    closure = workspace.world.closure(packages)
    return closure.complete and not any(keys.match(each) for each in closure)


_COMPONENTS_ONLY = {"Qt5": re.compile("qt.*5|libqt5|rviz_"), "Qt6": re.compile("libqt6|qt6-|rviz_")}
"""What CMake finds with components only, and what brings them: keys, and packages that find them for others."""


def _has_headers(script: BuildScript) -> bool:
    """Whether a package installs headers of its own: libraries without are plugins, which nobody links and nobody finds by CMake.

    What is generated, such as the parameters of a plugin, is there for its own code.
    """
    return script.hides(Facet.SHARE) or any(provided.path.endswith(HEADERS) and provided.source for provided in script.provides)


def _exported_targets(script: BuildScript) -> frozenset[str]:
    """Return the targets that whoever finds the package can link."""
    return frozenset([one.target for one in script.exported if one.handed_on])


def _handed_on(package: Package, workspace: Workspace) -> Iterator[tuple[str, Span]]:
    """Yield the packages whose targets an exported library hands on to those who link it."""
    exported = _exported_targets(package.built)
    kinds = ("library", "interface")
    libraries = {target.name for target in package.built.targets if target.name in exported and target.kind in kinds}
    for call in called(package, "target_link_libraries"):
        if not call.args or call.blocks or evaluated_name(package, call.texts[0]) not in libraries:
            continue
        handed = True
        for index, word in enumerate(call.texts[1:], 1):
            if word in ("PUBLIC", "INTERFACE", "PRIVATE"):
                handed = word != "PRIVATE"
            elif handed and (match := _TARGET.match(word)):
                yield match[1] or match[2], call.span(index)
    for call in called(package, "ament_target_dependencies"):
        if not call.args or call.blocks or evaluated_name(package, call.texts[0]) not in libraries or "PRIVATE" in call.texts:
            continue
        for index, word in enumerate(call.texts[1:], 1):
            if cmake_edits.exports_targets(word, workspace):
                yield word, call.span(index)


_TARGET = re.compile(r"([\w-]+)::[\w:-]+\Z|\$\{(\w+)_TARGETS\}\Z")


def _included(package: Package, workspace: Workspace) -> Iterator[tuple[tuple[str, ...], Finding]]:
    """Yield what installed headers include and is not exported, as find_package() calls it, and what to say of it.

    There is no name where it is not sure.
    """
    script = package.script
    if script is None or not _is_seen(package):
        return
    by_cmake = workspace.world.by_cmake
    exported = _exported(script)
    exported_packages = exported.union(*(by_cmake(name).names for name in exported))
    finds = sorted(found_names(package, script))
    usable = _usable(package, workspace, script)
    for name, uses in _public(package, workspace, script).items():
        found = [each for each in finds if each == name or name in by_cmake(each).names[:1]]
        if name in exported_packages or not (found or _is_to_be_found(package, workspace, name)):
            continue
        compiled = [use for use in uses if relative(package, use.span.path) in usable]
        first, *others = compiled or uses
        # A vendor package mostly hands on nothing but the folder in which CMake finds what it stands for.
        written = next((each for each in found if each != name), name) if not found or name.endswith(VENDOR) else found[0]
        way_out = f"add {'' if found else f'find_package({written} REQUIRED) and '}ament_export_dependencies({written})"
        if not compiled:
            way_out += ", or do not install it, for it includes what others do not have"
        confidence = _confidence(package, workspace, name, exported, compiled) if compiled else Confidence.LOW
        yield (
            (written,) if found and confidence is Confidence.HIGH else (),
            Finding(
                f"{name} is included by this installed header, but not exported: {way_out}",
                first.span,
                name,
                several(Related(f"also included here: {use.what}", use.span) for use in others),
                None,
                confidence,
            ),
        )


def _is_to_be_found(package: Package, workspace: Workspace, name: str) -> bool:
    """Whether a package is declared for more than tests, and is one of ament, so that CMake calls it by its name."""
    others = workspace.by_name.get(name, ())
    released = workspace.world.released(name)
    built = {other.builds_with for other in others} or {released.build_type if released else ""}
    return built == {"ament_cmake"} and bool(package.declares(name) & ~Role.TEST)


def _confidence(package: Package, workspace: Workspace, name: str, exported: set[str], uses: list[Use]) -> Confidence:
    script = package.script
    assert script is not None
    along = found_along(workspace, exported)
    if name in along or (not along.complete and may_bring(along.unknown, name, workspace)):
        return Confidence.MEDIUM
    if _kept(package, script).issuperset([stem(use.span.path) for use in uses]):
        return Confidence.MEDIUM
    sure = _EXPORTS.intersection(script.calls) and not _is_written_out(package, workspace, name)
    return Confidence.HIGH if sure else Confidence.MEDIUM


def _kept(package: Package, script: BuildScript) -> frozenset[str]:
    """Return how the sources of programs and of libraries that are not exported are called, without folder and suffix.

    A program of a single source may have all but that in headers, which are there for others, too; so may all that is built
    in a package of programs and libraries that are exported.
    """
    built = [target for target in script.targets if not target.test]
    words = [text for call in called(package, "ament_export_libraries", anywhere=True) for text in call.texts]
    handed_on = {*_exported_targets(script), *(evaluated_name(package, word) for word in words)}
    if None in handed_on:
        return frozenset()
    inner = [target for target in built if target.kind == "executable" or target.name not in handed_on]
    outer = [target for target in built if target not in inner]
    if any(target.sources for target in outer) or not all(target.whole for target in built):
        return frozenset()
    found: set[str] = set()
    for target in inner:
        sources = [source for source in target.sources if not source.endswith(HEADERS)]
        if len(sources) > 1 or target.kind == "library":
            found.update(map(stem, sources))
    return frozenset(found)


def _is_written_out(package: Package, workspace: Workspace, name: str) -> bool:
    """Whether the include directories of a package are handed on as they are on this machine."""
    calls = called(package, "target_include_directories", "ament_export_include_directories", anywhere=True)
    words = [word for call in calls if "PRIVATE" not in call.texts for word in call.texts]
    found = [match[1] for word in words if (match := _DIRECTORIES.fullmatch(word))]
    return any(each.lower() == name.lower() or name in workspace.world.by_cmake(each).names for each in found)


_DIRECTORIES = re.compile(r"\$\{(\w+?)_INCLUDE_DIRS?\}")


def _public(package: Package, workspace: Workspace, script: BuildScript) -> dict[str, list[Use]]:
    """Return what installed headers include of ROS packages, and of libraries that vendor packages wrap, with the places."""
    is_package = workspace.world.is_package
    installed = _installed(script)
    finds = found_names(package, script)
    uses: dict[str, list[Use]] = {}
    for use in _includes(package):
        known = any(is_package(name) for name in use.providers if name == use.package or name.endswith(VENDOR))
        known = known or (use.package in finds and _is_not_here(package, workspace, use))
        tool = any(name.startswith(_OF_TOOLS) for name in use.providers)
        if use.sure and known and not tool and relative(package, use.span.path) in installed:
            uses.setdefault(use.package, []).append(use)
    return uses


def _is_not_here(package: Package, workspace: Workspace, use: Use) -> bool:
    """Whether a header is of a package that is neither here nor released: it is declared by the name that its headers have.

    Only headers of interfaces, and those that packages of other distributions have, are known to be of a package.
    """
    away = workspace.world.standing(use.package) in ("unknown", "elsewhere")
    return away and use.name.startswith(f"{use.package}/") and bool(package.declares(use.package) & ~Role.TEST)


def _usable(package: Package, workspace: Workspace, script: BuildScript) -> set[str]:
    """Return the installed headers that compile elsewhere."""
    standing = workspace.world.standing
    old = {relative(package, use.span.path) for use in _includes(package) if standing(use.package) == "end-of-life"}
    return _installed(script).difference(package.unusable_headers, old)


def _includes(package: Package) -> Iterator[Use]:
    for use in package.uses:
        if use.via == "include" and not use.optional and use.role & Role.EXPORT:
            yield use


def _installed(script: BuildScript) -> set[str]:
    """Return the headers that are installed in every build."""
    return {each.source for each in script.provides if each.path.startswith("include/") and not each.conditional}


RULE = Rule(
    name="unexported-dependency",
    code="ROS207",
    summary="what installed headers include must be exported",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
