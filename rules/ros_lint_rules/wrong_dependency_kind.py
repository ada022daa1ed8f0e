"""
## What it finds

A dependency that is declared with a tag that does not cover its use:

- `<test_depend>` for what is built or run outside tests;
- `<exec_depend>` for what the package is compiled against;
- `<build_depend>` for what is imported, launched or looked up at run time;
- `<build_depend>` for what public headers include or `ament_export_dependencies` names.

## Why it matters

In a workspace it mostly works, because colcon makes every dependency available, whatever its tag. It fails elsewhere (REP 149):

- Where binary packages are built, `exec_depend` is not installed.
- Where binary packages are installed, `build_depend` is not installed.
- Where no tests are built, `test_depend` is not installed.

## How to fix it

Use the tag that the message names. The fix does this, and moves the tag to others of its kind if the file groups them.

## Limitations

Not reported:

- The package is available through another declared dependency with the right tag.
- The use is optional, or is in files that may not be built or installed.
- Only launch files name the package, because they start, include or look up something of it: see `launch-outside-closure`.
- Imports of launch files that are satisfied by what is installed with `ros2 launch`.
- Packages that exist only for tests, because all their dependencies serve tests.
- A tag has a condition that is false in some ROS 2 environment.
- A declared dependency is unknown, so that it may provide the package.
- Headers that are not installed, or only under a condition, because other packages do not include them.
- Test libraries such as `ament_cmake_gtest` that installed headers include, because these headers help tests elsewhere.
- rosdep keys at run time, because a key for building may have another one for running. Build tools and vendor packages, because
  they have nothing to run.

Reported with medium confidence:

- rosdep keys that only headers need.
- `<exec_depend>` on what only a `find_package()` without `REQUIRED` names, because CMake continues without it.
- `<build_export_depend>` on what only installed headers include.
- `<build_depend>` together with `<exec_depend>` for a rosdep key that is exported.

Reported with low confidence:

- Headers of a library that are not installed: their installation may have been forgotten.
- `<test_depend>` on parts of launch that launch files import, if another dependency provides them.
- `<build_depend>` together with `<exec_depend>` for a package that is exported. Both are installed where other packages are
  built, but REP 149 requires `<build_export_depend>`.

`<test_depend>` on a package that another dependency provides is an info, because it works until that dependency drops it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from ros_lint.api import (
    Confidence,
    Declared,
    Depend,
    Facet,
    Finding,
    Fix,
    Package,
    Role,
    Rule,
    Severity,
    Use,
    Workspace,
    build,
    dependencies,
    files,
    first_related,
)

_BUILT = ("include", "cmake", "interface", "symbol", "macro", "target")
_RUN = ("import", "package")
_EXPORTED = ("include", "interface", "target")
_ROLES = (Role.BUILD, Role.EXEC, Role.EXPORT)
_TEST = Role.TEST
_TO_BUILD = Role.BUILD | Role.TOOL
_AFTERWARDS = Role.EXEC | Role.EXPORT


class _Wrong(NamedTuple):
    """A declared name whose tags do not cover its use."""

    name: str
    depends: list[Depend]
    tag: str
    """The tag to write instead."""
    why: str
    uses: list[Use]
    confidence: Confidence
    severity: Severity


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    every = list(_wrong(package, workspace))
    for wrong in every:
        name, tag = wrong.name, wrong.tag
        written = " and ".join(dict.fromkeys(f"<{depend.tag}>" for depend in wrong.depends))
        same_tag = [depend for other in every if other.tag == tag for depend in other.depends]
        yield Finding(
            f"'{name}' is declared as {written} only, {wrong.why}; write <{tag}>{name}</{tag}>",
            wrong.depends[0].span,
            name,
            first_related(dependencies.use_note(name, use, "is used here") for use in wrong.uses),
            Fix(f"declare '{name}' as <{tag}>", dependencies.change_dependency(package, wrong.depends, tag, same_tag)),
            wrong.confidence,
            wrong.severity,
        )


def _wrong(package: Package, workspace: Workspace) -> Iterator[_Wrong]:
    manifest = package.manifest
    if manifest is None or manifest.problems or manifest.format == 1:
        return
    if files.is_for_tests(package.name):
        return
    unguarded = build.unguarded_tests(package)
    reported: set[str] = set()
    by_name: dict[str, list[Declared]] = {}
    for declared in package.declared:
        by_name.setdefault(declared.name, []).append(declared)
    for need in dependencies.needs(package, workspace):
        if not need.declared or any(_is_for_all(declared) for name in need.declared for declared in by_name[name]):
            continue
        # A key for building and another one for running complement each other.
        names = dict.fromkeys((*need.declared, *(name for use in need.uses for name in use.providers if name in by_name)))
        tags = [declared for name in names for declared in by_name[name]]
        if any(map(_is_for_all, tags)) or dependencies.is_part_of_launch(package, workspace, need.uses):
            continue
        exported = need._replace(uses=tuple(_exported_uses(package, need, assume_installed=False)))
        lacking = _lacks(package, workspace, exported, tags)
        if lacking is None and any(target.kind == "library" and not target.test for target in package.built.products.targets):
            exported = need._replace(uses=tuple(_exported_uses(package, need, assume_installed=True)))
            lacking = _once_installed(_lacks(package, workspace, exported, tags))
        if lacking is None:
            continue
        uses = [use for use in exported.uses if use.certain and _is_about(use, lacking.role)]
        name = next((name for name in uses[0].providers if name in need.declared), need.declared[0])
        if name in reported or name in unguarded:
            continue  # unguarded-test reports the tests
        reported.add(name)
        depends = [declared.depend for declared in tags if declared.name == name]
        tag = dependencies.tag_for(package, workspace, name, exported.role | (_given(tags, name) & ~_TEST))
        yield _Wrong(name, depends, tag, lacking.why, uses, lacking.confidence, lacking.severity)


def _is_for_all(declared: Declared) -> bool:
    """Return whether a tag is right for every use: it is <depend>. A tag with a condition counts, because it is not judged."""
    return declared.depend.tag == "depend" or not declared.always


def _exported_uses(package: Package, need: dependencies.Need, *, assume_installed: bool) -> Iterator[Use]:
    """Yield the uses of a needed package. An include in a header that is not installed is yielded without the role EXPORT.

    With ``assume_installed``, such an include keeps the role. Includes in headers that only some builds install are left out.
    """
    script = package.script
    installed: dict[str, bool] | None = {} if script is None or package.hidden(Facet.LIBRARIES) else None
    for use in need.uses:
        if use.via != "include" or not use.role & Role.EXPORT:
            yield use
            continue
        if installed is None:
            installed = _installed_headers(package)
        always = installed.get(package.relative(use.span.path))
        if always is None:
            yield use if assume_installed else use._replace(role=use.role & ~Role.EXPORT)
        elif always and not dependencies.TEST_LIBRARIES.issuperset(need.declared):
            yield use


def _installed_headers(package: Package) -> dict[str, bool]:
    """Return for each installed header, by its source path, whether every build installs it."""
    headers: dict[str, bool] = {}
    for provided in package.built.products.installs:
        if provided.path.startswith("include/"):
            headers[provided.source] = headers.get(provided.source, False) or not provided.conditional
    return headers


class _Lack(NamedTuple):
    """A use that no tag of the dependency covers."""

    role: Role
    why: str
    confidence: Confidence = Confidence.HIGH
    severity: Severity = Severity.WARNING


def _once_installed(lacking: _Lack | None) -> _Lack | None:
    """Return ``lacking`` with low confidence, as a problem that appears once the headers of the package are installed.

    The result is None if ``lacking`` is None or is not about an export.
    """
    if lacking is None or lacking.role is not Role.EXPORT:
        return None
    why = "but headers in 'include/' use it; once these headers are installed, packages that include them need it, too"
    return lacking._replace(why=why, confidence=Confidence.LOW)


def _given(tags: Sequence[Declared], name: str = "") -> Role:
    """Return the roles (build, run, export, test) that ``tags`` cover together.

    With ``name``, only the tags of the dependency ``name`` count.
    """
    role = Role(0)
    for declared in tags:
        if name in ("", declared.name):
            role |= declared.role
    return role


def _lacks(package: Package, workspace: Workspace, need: dependencies.Need, tags: Sequence[Declared]) -> _Lack | None:
    """Return the first kind of use of a needed package that its ``tags`` and other dependencies do not cover; else None."""
    given = _given(tags)

    def is_used(role: Role) -> bool:
        return any(use.certain and _is_about(use, role) for use in need.uses)

    def is_provided(enough: Role, *, surely: bool = False) -> bool:
        return dependencies.provided_transitively(
            package, workspace, {name for use in need.uses for name in use.providers}, enough, surely=surely
        )

    def missing(role: Role, enough: Role) -> bool:
        return not given & enough and is_used(role) and not is_provided(enough)

    if given is _TEST:
        role = next((role for role in _ROLES if is_used(role)), None)
        if role is None:
            return None
        why = "but it is used outside tests"
        if not is_provided(~_TEST):
            return _Lack(role, why)
        named = any(use.certain and use.via != "macro" and _is_about(use, role) for use in need.uses)
        indirect = "but it is also used outside tests, where only other dependencies provide it"
        if not (named and is_provided(~_TEST, surely=True)):
            return None
        by_launch = dependencies.is_part_of_launch(package, workspace, [use for use in need.uses if use.role & ~_TEST])
        return _Lack(role, indirect, Confidence.LOW if by_launch else Confidence.HIGH, Severity.INFO)
    if not given & _TEST and missing(Role.BUILD, _TO_BUILD):
        # The sources of the package may not need the headers that include it.
        handed_on = given & Role.EXPORT and all(use.role & Role.EXPORT for use in need.uses if _is_about(use, Role.BUILD))
        why = "but it is needed to build this package"
        unsure = handed_on or _is_only_looked_for(package, need)
        return _Lack(Role.BUILD, why, Confidence.MEDIUM if unsure else Confidence.HIGH)
    world = workspace.world
    packages = [name for name in need.declared if world.is_package(name)]
    if any(dependencies.is_traceless_by_name(world, name) for name in packages):
        return None
    if packages and missing(Role.EXEC, _AFTERWARDS):
        return _Lack(Role.EXEC, "but it is needed at run time")
    if missing(Role.EXPORT, _AFTERWARDS):
        # A common library is often declared by the packages that build against this one.
        sure = bool(packages) or any(use.via == "target" for use in need.uses if _is_about(use, Role.EXPORT))
        why = "but it is part of the public interface, so packages that build against this package need it"
        return _Lack(Role.EXPORT, why, Confidence.HIGH if sure else Confidence.MEDIUM)
    if missing(Role.EXPORT, Role.EXPORT):
        if packages:
            why = "but it is part of the public interface, so REP 149 requires <build_export_depend> as well"
            return _Lack(Role.EXPORT, why, Confidence.LOW, Severity.INFO)
        return _Lack(Role.EXPORT, "but packages that build against this package need it, too", Confidence.MEDIUM)
    return None


def _is_only_looked_for(package: Package, need: dependencies.Need) -> bool:
    """Return whether only calls of find_package() without REQUIRED use a package in the build."""
    calls = package.calls("find_package", anywhere=True)
    not_required = {call.span(0) for call in calls if call.args and "REQUIRED" not in call.texts}
    return all(use.via == "cmake" and use.span in not_required for use in need.uses if _is_about(use, Role.BUILD))


def _is_about(use: Use, role: Role) -> bool:
    if role is Role.BUILD:
        return use.via in _BUILT and bool(use.role & _TO_BUILD)
    if role is Role.EXEC:
        return use.via in _RUN and bool(use.role & Role.EXEC)
    return use.via in _EXPORTED and bool(use.role & Role.EXPORT)


RULE = Rule(
    name="wrong-dependency-kind",
    code="ROS203",
    summary="dependencies are declared with tags that cover their use",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
