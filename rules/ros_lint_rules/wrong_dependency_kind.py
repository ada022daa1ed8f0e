"""
## What it finds

A dependency that is declared, but in a tag that does not reach where it is used: `<test_depend>` for what is built or
runs outside tests, `<exec_depend>` for what is compiled against, `<build_depend>` for what is imported, launched or
looked up at run time, or for what public headers include and `ament_export_dependencies` names.

## Why it matters

In a workspace it mostly works, for colcon puts every dependency on the path, whatever its tag. It fails elsewhere:
`exec_depend` is not installed where binary packages are built, `build_depend` is not installed with them, and
`test_depend` is neither when tests are off (REP 149).

## How to fix it

Use the tag that the message names. The fix does this, and puts it among its like where the file keeps kinds together.

## Limitations

- The package comes along in the right way with another declared dependency. Where it is declared for tests only, the confidence
  is then low: it works until the other one drops it.
- The use is optional, or in files that are perhaps not built or installed.
- Only launch files name it, for what they start, include or look up: see `launch-outside-closure`.
- Launch files import what comes with `ros2 launch`, and what packages of tests declare serves tests anyhow.
- A tag has a condition that not every environment of ROS 2 meets, or a declared dependency is itself not known, so that the
  package might come with it.
- Headers are not installed, or only under a condition: then nobody else includes them. If there is a library to link with, they
  may have been forgotten, and the confidence is low.
- What tests are made of, such as `ament_cmake_gtest`, is named by installed headers: they help tests elsewhere.
- With both `<build_depend>` and `<exec_depend>` the confidence is low, for rosdep keys medium: what is installed is then there
  to build against, too, but REP 149 wants `<build_export_depend>`.
- The confidence is medium for rosdep keys that only headers ask for, and where only installed headers include what
  `<build_export_depend>` names.
- Only ROS packages count for run time: a rosdep key for building may have another one for running, and build tools and
  vendor packages have nothing to run.
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
    Need,
    Package,
    Related,
    Role,
    Rule,
    Severity,
    Use,
    Workspace,
    change_dependency,
    comes_with_launching,
    covered,
    is_for_tests,
    is_unseen_by_name,
    needs,
    relative,
    several,
    tag_for,
    unguarded_tests,
)

_OF_TESTS = frozenset({
    "ament_cmake_gmock", "ament_cmake_google_benchmark", "ament_cmake_gtest", "benchmark", "gmock_vendor", "google-mock",
    "google_benchmark_vendor", "gtest", "gtest_vendor", "libgmock-dev", "libgtest-dev",
})  # fmt: skip
"""Who gives the libraries that tests in C++ are made of."""
_BUILT = ("include", "cmake", "interface", "symbol", "macro", "target")
_RUN = ("import", "package")
_EXPORTED = ("include", "interface", "target")
_ASKED = (Role.BUILD, Role.EXEC, Role.EXPORT)
_TEST = Role.TEST
_TO_BUILD = Role.BUILD | Role.TOOL
_AFTERWARDS = Role.EXEC | Role.EXPORT


class _Wrong(NamedTuple):
    """A name that is declared in tags which do not reach far enough."""

    name: str
    depends: list[Depend]
    tag: str
    """What to write instead."""
    why: str
    uses: list[Use]
    confidence: Confidence


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    every = list(_wrong(package, workspace))
    for wrong in every:
        name, tag = wrong.name, wrong.tag
        written = " and ".join(dict.fromkeys(f"<{depend.tag}>" for depend in wrong.depends))
        alike = [depend for other in every if other.tag == tag for depend in other.depends]
        yield Finding(
            f"{name} is declared as {written} only, {wrong.why}: make it <{tag}>{name}</{tag}>",
            wrong.depends[0].span,
            name,
            several(Related(f"used here: {use.what}", use.span) for use in wrong.uses),
            Fix(f"declare {name} as <{tag}>", change_dependency(package, wrong.depends, tag, alike)),
            wrong.confidence,
        )


def _wrong(package: Package, workspace: Workspace) -> Iterator[_Wrong]:
    manifest = package.manifest
    if manifest is None or manifest.problems or manifest.format == 1:
        return
    if is_for_tests(package.name):
        return
    unguarded = unguarded_tests(package)
    said: set[str] = set()
    by_name: dict[str, list[Declared]] = {}
    for declared in package.declared:
        by_name.setdefault(declared.name, []).append(declared)
    for need in needs(package, workspace):
        if not need.declared or any(_is_for_all(declared) for name in need.declared for declared in by_name[name]):
            continue
        # A key to build with and another one to run with are complete together.
        names = dict.fromkeys((*need.declared, *(name for use in need.uses for name in use.providers if name in by_name)))
        tags = [declared for name in names for declared in by_name[name]]
        if any(map(_is_for_all, tags)) or comes_with_launching(package, need.uses):
            continue
        seen = need._replace(uses=tuple(_outside(package, need, hopeful=False)))
        lacking = _lacks(package, workspace, seen, tags)
        if lacking is None and any(target.kind == "library" and not target.test for target in package.built.targets):
            seen = need._replace(uses=tuple(_outside(package, need, hopeful=True)))
            lacking = _once_installed(_lacks(package, workspace, seen, tags))
        if lacking is None:
            continue
        uses = [use for use in seen.uses if use.sure and _is_about(use, lacking.role)]
        name = next((name for name in uses[0].providers if name in need.declared), need.declared[0])
        if name in said or name in unguarded:
            continue  # unguarded-test tells where to put it
        said.add(name)
        mine = [declared.depend for declared in tags if declared.name == name]
        tag = tag_for(package, workspace, name, seen.role | (_given(tags, name) & ~_TEST))
        yield _Wrong(name, mine, tag, lacking.why, uses, lacking.confidence)


def _is_for_all(declared: Declared) -> bool:
    """Whether an element is enough for whatever it is needed for, or may be."""
    return declared.depend.tag == "depend" or not declared.always


def _outside(package: Package, need: Need, *, hopeful: bool) -> Iterator[Use]:
    """Yield the uses of a need as they look to others: nobody includes headers that are not installed, or may not be.

    ``hopeful``: headers that are not installed in any build will be one day.
    """
    script = package.script
    installed: dict[str, bool] | None = {} if script is None or package.hidden(Facet.LIBRARIES) else None
    for use in need.uses:
        if use.via != "include" or not use.role & Role.EXPORT:
            yield use
            continue
        if installed is None:
            installed = _installed_headers(package)
        always = installed.get(relative(package, use.span.path))
        if always is None:
            yield use if hopeful else use._replace(role=use.role & ~Role.EXPORT)
        elif always and not _OF_TESTS.issuperset(need.declared):
            yield use


def _installed_headers(package: Package) -> dict[str, bool]:
    """Return the sources of installed headers, and whether they are installed in every build."""
    found: dict[str, bool] = {}
    for provided in package.built.provides:
        if provided.path.startswith("include/"):
            found[provided.source] = found.get(provided.source, False) or not provided.conditional
    return found


class _Lack(NamedTuple):
    """What tags do not give."""

    role: Role
    why: str
    confidence: Confidence = Confidence.HIGH


def _once_installed(lacking: _Lack | None) -> _Lack | None:
    """Return what is lacking once headers are installed that are not, if it is that."""
    if lacking is None or lacking.role is not Role.EXPORT:
        return None
    why = "but its headers in include/ have it, and whoever builds against them needs it once they are installed"
    return lacking._replace(why=why, confidence=Confidence.LOW)


def _given(tags: Sequence[Declared], name: str = "") -> Role:
    """Return what tags give together: all, or those of one name."""
    role = Role(0)
    for declared in tags:
        if name in ("", declared.name):
            role |= declared.role
    return role


def _lacks(package: Package, workspace: Workspace, need: Need, tags: Sequence[Declared]) -> _Lack | None:
    """Return the first thing that the tags of a need do not give, and no other dependency either."""
    given = _given(tags)

    def asked(role: Role) -> bool:
        return any(use.sure and _is_about(use, role) for use in need.uses)

    def comes_along(enough: Role, *, surely: bool = False) -> bool:
        return covered(package, workspace, {name for use in need.uses for name in use.providers}, enough, surely=surely)

    def missing(role: Role, enough: Role) -> bool:
        return not given & enough and asked(role) and not comes_along(enough)

    if given is _TEST:
        role = next((role for role in _ASKED if asked(role)), None)
        if role is None:
            return None
        why = "but it is used outside tests"
        if not comes_along(~_TEST):
            return _Lack(role, why)
        named = any(use.sure and use.via != "macro" and _is_about(use, role) for use in need.uses)
        merely = f"{why}, where it merely comes along with what else is declared"
        return _Lack(role, merely, Confidence.LOW) if named and comes_along(~_TEST, surely=True) else None
    if not given & _TEST and missing(Role.BUILD, _TO_BUILD):
        # Its own sources may do without those of its headers that include it.
        handed_on = given & Role.EXPORT and all(use.role & Role.EXPORT for use in need.uses if _is_about(use, Role.BUILD))
        why = "but it is needed to build this package"
        return _Lack(Role.BUILD, why, Confidence.MEDIUM if handed_on else Confidence.HIGH)
    world = workspace.world
    packages = [name for name in need.declared if world.is_package(name)]
    if any(is_unseen_by_name(world, name) for name in packages):
        return None
    if packages and missing(Role.EXEC, _AFTERWARDS):
        return _Lack(Role.EXEC, "but it is needed at run time")
    if missing(Role.EXPORT, _AFTERWARDS):
        # A library that many have declared elsewhere is missed by few.
        sure = bool(packages) or any(use.via == "target" for use in need.uses if _is_about(use, Role.EXPORT))
        why = "but it is part of what this package exports, and whoever builds against that needs it"
        return _Lack(Role.EXPORT, why, Confidence.HIGH if sure else Confidence.MEDIUM)
    if missing(Role.EXPORT, Role.EXPORT):
        if packages:
            why = "which is enough to install it, but by REP 149 whoever builds against this package needs it, too"
            return _Lack(Role.EXPORT, why, Confidence.LOW)
        return _Lack(Role.EXPORT, "but whoever builds against this package needs it, too", Confidence.MEDIUM)
    return None


def _is_about(use: Use, role: Role) -> bool:
    if role is Role.BUILD:
        return use.via in _BUILT and bool(use.role & _TO_BUILD)
    if role is Role.EXEC:
        return use.via in _RUN and bool(use.role & Role.EXEC)
    return use.via in _EXPORTED and bool(use.role & Role.EXPORT)


RULE = Rule(
    name="wrong-dependency-kind",
    code="ROS203",
    summary="a dependency must be declared in a tag that reaches where it is used",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
