"""
## What it finds

A dependency in `package.xml` whose name means nothing to anybody: no package of the workspace, of an underlay or of any
distribution has it, and no rosdep key is called so. Misspelt packages, the name that CMake, `#include`, Python, apt or pip use
instead of the rosdep key, the folder that a package of the workspace lies in, modules of Python itself, programs and modules of
the package, groups of packages, and `ament_python`, which is a build type and no package. And a tag without a name.

## Why it matters

colcon ignores names that it does not know, so a workspace that is built already goes on working. `rosdep install` stops
with "Cannot locate rosdep definition", in every container and on the build farm.

## How to fix it

Write the name of the package or the rosdep key. Where it is clear which one is meant, the fix does this; it is unsafe where
the message says that not every distribution has that name. When the package is not released, put its sources into the
workspace, or name the prefix it is installed in with `--underlay`.

## Limitations

For tags under a condition that is false or cannot be evaluated, for packages of ROS 1 (build type catkin), and when there
is no index of the distribution. Unless the name is clearly a slip, one that nothing else names, near a package that is used
and not declared, near one of the tools of ament, of which nearly everything
is released, or one that no package has (REP 144: no dashes, no capitals), the confidence is medium, so that the finding shows
with `--pedantic` only: packages that are not released anywhere cannot be told from those that do not exist. So it is for the
names of libraries when a `.repos` file or `.gitmodules` says that sources of the workspace are elsewhere.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import (
    Confidence,
    Edit,
    Finding,
    Fix,
    Package,
    Rule,
    Severity,
    Stranger,
    Workspace,
    availability,
    called,
    declared_names,
    did_you_mean,
    is_named,
    is_near_tool,
    may_be_package,
    naming,
    programs,
    remove_dependency,
    strangers,
    used_instead,
)

_CALLED_SO_BY = {"cmake": "find_package", "header": "#include", "python": "Python", "system": "the system's package manager"}
_PYTHON_BUILD = "ament_python"
_PYTHON_IN_CMAKE = "ament_cmake_python"
_MOST_KEYS = 3
_FINDS_DECLARED = "ament_auto_find_build_dependencies"


def check(workspace: Workspace) -> Iterator[Finding]:
    renamed: dict[tuple[str, str], Stranger] = {}
    for name, packages in declared_names(workspace).items():
        if workspace.world.standing(name) == "unknown":
            for stranger in strangers(name, packages):
                if not name:
                    yield _needless(
                        stranger, f"an empty <{stranger.declared.depend.tag}> declares nothing, and rosdep stops at it"
                    )
                elif name == _PYTHON_BUILD:
                    yield _build_type(stranger, workspace)
                elif workspace.world.group_members(name):
                    yield _needless(stranger, f"{name} is a group of packages and none itself")
                elif stranger.runs_python and workspace.world.by_import(name).none_needed:
                    why = f"{name} is a module of Python itself, so there is nothing that rosdep could install"
                    yield _needless(stranger, why)
                elif workspace.world.meant(name, python=stranger.runs_python) is None and (own := _own(stranger)):
                    yield _needless(stranger, f"{name} is a {own} of this package and no package")
                else:
                    yield _unknown(stranger, workspace, renamed)


def _build_type(stranger: Stranger, workspace: Workspace) -> Finding:
    package, name = stranger.package, stranger.name
    why = f"{name} is a build type and no package, so rosdep cannot resolve it"
    if package.builds_with != "ament_cmake" or "ament_python_install_package" not in package.built.calls:
        return _needless(stranger, why)
    way_out = f"write {_PYTHON_IN_CMAKE}"
    fix = naming(workspace, _PYTHON_IN_CMAKE, way_out, *_rename(stranger, _PYTHON_IN_CMAKE))
    return Finding(f"{why}: {way_out}", stranger.declared.depend.span, name, fix=fix, package=package.name)


def _needless(stranger: Stranger, why: str) -> Finding:
    package, depend = stranger.package, stranger.declared.depend
    fix = Fix(f"remove {f'the dependency on {stranger.name}' if stranger.name else 'the empty tag'}", _removal(stranger))
    return Finding(f"{why}: remove the tag", depend.span, stranger.name or depend.tag, fix=fix, package=package.name)


def _own(stranger: Stranger) -> str:
    """Return what of the package itself is called so, if nothing finds or launches a package of the name; "" for nothing."""
    package, name = stranger.package, stranger.name
    if any(mention.name == name for mention in package.built.mentions):
        return ""
    if any(each.package == name for launch in package.launch for each in launch.references):
        return ""
    own = programs(package)
    if own is not None and name in own.names:
        return "program"
    folders = [module.replace(".", "/") for module in package.built.python_packages]
    return "module" if any(f"{folder}/{name}.py" in package.files for folder in folders) else ""


def _unknown(stranger: Stranger, workspace: Workspace, renamed: dict[tuple[str, str], Stranger]) -> Finding:
    """Say what a name may stand for; ``renamed`` are those that a fix makes another of, by package and by what is meant."""
    name, world, target = stranger.name, workspace.world, workspace.target
    known = f"{target.distro}, as of {world.knowledge.date}"
    what = f"{name} is neither a package nor a rosdep key ({known})"
    meant = world.meant(name, python=stranger.runs_python)
    other_library = ""
    if meant and meant.by == "slip" and not world.is_package(meant.name) and is_named(stranger):
        other_library, meant = meant.name, None  # what the code calls so, too, is no slip for the library of somebody else
    if (meant is None or meant.by == "slip") and (lying := _in_folder(name, workspace)):
        return _of_folder(stranger, workspace, f"{what}, but the folder of {lying}", lying)
    fix = None
    of_cmake = not stranger.runs_python and bool(world.knowledge.names.cmake(name))
    installing = () if of_cmake else world.knowledge.rosdep.installing(name)
    sure = _confidence(stranger, meant.by if meant else "system" if installing else "", workspace)
    if meant is None and installing:
        message = f"{what}, but what {_caller('system', installing[0])} calls it: write {' or '.join(installing[:_MOST_KEYS])}"
    elif meant is None:
        near = [other for other in world.suggest(name, python=stranger.runs_python) if other != other_library]
        hint = did_you_mean(near, "") or "correct it, or add what provides it"
        if lacking := used_instead(stranger, workspace):
            hint = f"write {lacking}, which is used and not declared{availability(workspace, lacking)}"
            sure = Confidence.HIGH
            fix = naming(workspace, lacking, f"write {lacking} for {name}", *_rename(stranger, lacking))
        message = f"{what}: {hint}"
    else:
        # What is written like a key is not what anybody calls it.
        caller = "" if name.startswith("python3-") else _caller(meant.by, meant.name)
        why = f", but what {caller} calls it" if caller else ""
        twin = renamed.get((stranger.package.name, meant.name))
        other = f"{twin.name}, which is {meant.name}," if twin else ""
        if stranger.package.declares(meant.name):
            other = meant.name
        message = f"{what}{why}: " + (
            f"remove it, {other} is declared, too" if other else f"write {meant.name}{availability(workspace, meant.name)}"
        )
        alone = meant.by == "cmake" and _is_found_as_declared(stranger.package, name)
        if alone:
            message += f", and find_package({name}), which nothing but {_FINDS_DECLARED}() does"
        edits, safe = _rename(stranger, meant.name, twin), sure == Confidence.HIGH and not alone
        if other:
            fix = Fix.of(f"remove {name}", *edits, safe=safe)
        else:
            fix = naming(workspace, meant.name, f"write {meant.name} for {name}", *edits, safe=safe)
        if fix and fix.safe:
            renamed.setdefault((stranger.package.name, meant.name), stranger)
    return Finding(
        message,
        stranger.declared.depend.name_span,
        name,
        fix=fix,
        confidence=sure,
        package=stranger.package.name,
    )


def _in_folder(name: str, workspace: Workspace) -> str:
    """Return the only package that lies in a folder of a name, "" if there is none or several."""
    lying = {package.name for package in workspace.packages if package.path.rpartition("/")[2] == name}
    return lying.pop() if len(lying) == 1 else ""


def _of_folder(stranger: Stranger, workspace: Workspace, what: str, meant: str) -> Finding:
    package = stranger.package
    own = meant == package.name
    other = own or package.declares(meant)
    way_out = f"remove it{'' if own else f', {meant} is declared, too'}" if other else f"write {meant}"
    title = f"remove {stranger.name}" if other else f"write {meant} for {stranger.name}"
    edits = _removal(stranger) if own else _rename(stranger, meant)
    place = stranger.declared.depend.name_span
    return Finding(f"{what}: {way_out}", place, stranger.name, fix=naming(workspace, meant, title, *edits), package=package.name)


def _caller(by: str, key: str) -> str:
    """Return who calls by another name what a rosdep key installs, or ""."""
    return "pip" if by == "system" and key.endswith("-pip") else _CALLED_SO_BY.get(by, "")


def _is_found_as_declared(package: Package, name: str) -> bool:
    """Whether CMake finds something only because it is declared by this very name."""
    if _FINDS_DECLARED not in package.built.calls:
        return False
    return not any(name in call.texts[:1] for call in called(package, "find_package", anywhere=True))


def _confidence(stranger: Stranger, by: str, workspace: Workspace) -> Confidence:
    if not by:
        # Packages are called otherwise (REP 144), and rosdep knows its keys.
        exists = may_be_package(stranger.name) and not is_near_tool(stranger.name, workspace)
        return Confidence.MEDIUM if exists else Confidence.HIGH
    # A library may be wrapped in a package of its own name whose sources come with another repository.
    elsewhere = bool(workspace.source_lists) and by in _CALLED_SO_BY
    return Confidence.MEDIUM if elsewhere and may_be_package(stranger.name) else Confidence.HIGH


def _removal(stranger: Stranger) -> tuple[Edit, ...]:
    return tuple(edit for tag in stranger.tags for edit in remove_dependency(stranger.package, tag))


def _rename(stranger: Stranger, name: str, twin: Stranger | None = None) -> tuple[Edit, ...]:
    """Return the edits that put another name into every tag. None where tags would then repeat each other.

    ``twin`` is what gets that name already.
    """
    package = stranger.package
    have = {declared.depend.tag for declared in package.tags(name)}
    if twin is not None:
        have.update([tag.tag for tag in twin.tags])
    if have:
        if have <= {"depend"} or have == {tag.tag for tag in stranger.tags}:
            return _removal(stranger)
        return ()
    return tuple(Edit(tag.name_span, name) for tag in stranger.tags)


RULE = Rule(
    name="unknown-dependency",
    code="ROS104",
    summary="a declared name must be that of a package or of a rosdep key",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    workspace=check,
)
