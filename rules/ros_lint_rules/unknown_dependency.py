"""
## What it finds

A dependency in `package.xml` that is neither a package (of the workspace, an underlay or any distribution) nor a rosdep key:

- misspelt names;
- the name that CMake, `#include`, Python, apt or pip uses instead of the rosdep key;
- the folder of a package of the workspace instead of its name;
- modules of the Python standard library, and programs and modules of the package itself;
- groups of packages;
- `ament_python`, which is a build type, not a package;
- a tag without a name.

One rule reports all of them, because the tag is the same mistake for rosdep and colcon; only the correct name differs.

## Why it matters

colcon ignores unknown names, so a workspace that is already built keeps working. `rosdep install` stops with "Cannot locate
rosdep definition", in every container and on the build farm.

## How to fix it

Write the name of the package or the rosdep key. The fix does this if only one name is possible. The fix is unsafe if the
message says that not every distribution has that name. If the package is not released, put its sources into the workspace, or
name its install prefix with `--underlay`.

## Limitations

Not reported:

- Tags under a condition that is false or cannot be evaluated.
- Packages of ROS 1 (build type catkin).
- Any name, if there is no index of the distribution.
- Packages that may be in a repository that is not cloned: `laser_tools` and `laser_tools_msgs`, if a `.repos` file, a
  `.rosinstall` file or `.gitmodules` lists a repository `laser_tools`.

Reported with medium confidence, so shown with `--pedantic` only:

- Names that may be those of packages that are not released anywhere.
- Misspelt names, if the package has more than 500 unknown names. Then the intended names are not searched.
- Names of libraries, if a `.repos` file or `.gitmodules` lists sources that are not in the workspace.

The confidence is high for:

- names that are clearly misspelt and that nothing else uses;
- names similar to a package that is used but not declared;
- names similar to an ament tool, because nearly all of these are released;
- names that are not valid for a package (REP 144: no dashes, no capitals).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from ros_lint.api import (
    Confidence,
    Edit,
    Finding,
    Fix,
    Package,
    Rule,
    Severity,
    Workspace,
    cached_by_workspace,
    dependencies,
    launch,
    names,
)

_CALLED_SO_BY = {"cmake": "find_package", "header": "#include", "python": "Python", "system": "the system's package manager"}
_PYTHON_BUILD = "ament_python"
_PYTHON_IN_CMAKE = "ament_cmake_python"
_MOST_KEYS = 3
_REMEDY = "correct it, or add the package to the workspace"
_FINDS_DECLARED = "ament_auto_find_build_dependencies"


def check(workspace: Workspace) -> Iterator[Finding]:
    renamed: dict[tuple[str, str], dependencies.UnresolvedDependency] = {}
    for name, packages in dependencies.declared_names(workspace).items():
        if workspace.world.resolution(name) == "unknown":
            for unresolved in dependencies.unresolved(name, packages):
                if not name:
                    yield _needless(
                        unresolved, f"an empty <{unresolved.declared.depend.tag}> declares nothing and makes rosdep fail"
                    )
                elif name == _PYTHON_BUILD:
                    yield _build_type(unresolved, workspace)
                elif workspace.world.group_members(name):
                    yield _needless(unresolved, f"'{name}' is a group of packages, not a package")
                elif unresolved.runs_python and workspace.world.by_import(name).none_needed:
                    why = f"'{name}' is a module of the Python standard library, so rosdep has nothing to install"
                    yield _needless(unresolved, why)
                elif not dependencies.are_corrected(unresolved.package, workspace):
                    yield _uncorrected(unresolved, workspace)
                elif workspace.world.meant(name, python=unresolved.runs_python) is None and (own := _own(unresolved)):
                    yield _needless(unresolved, f"'{name}' is a {own} of this package, not a package")
                else:
                    yield _unknown(unresolved, workspace, renamed)


def _build_type(unresolved: dependencies.UnresolvedDependency, workspace: Workspace) -> Finding:
    package, name = unresolved.package, unresolved.name
    why = f"'{name}' is a build type, not a package, so rosdep cannot resolve it"
    if package.builds_with != "ament_cmake" or "ament_python_install_package" not in package.built.commands.names:
        return _needless(unresolved, why)
    remedy = f"write '{_PYTHON_IN_CMAKE}'"
    fix = dependencies.naming_fix(workspace, _PYTHON_IN_CMAKE, remedy, *_rename(unresolved, _PYTHON_IN_CMAKE))
    return Finding(f"{why}; {remedy}", unresolved.declared.depend.span, name, fix=fix, package=package.name)


def _needless(unresolved: dependencies.UnresolvedDependency, why: str) -> Finding:
    package, depend = unresolved.package, unresolved.declared.depend
    title = f"remove the dependency on '{unresolved.name}'" if unresolved.name else "remove the empty tag"
    fix = Fix(title, _removal(unresolved))
    return Finding(
        f"{why}; remove this <{depend.tag}>",
        depend.span,
        unresolved.name or depend.tag,
        fix=fix,
        package=package.name,
        explains=dependencies.wrong_name_explains(unresolved.name),
    )


def _own(unresolved: dependencies.UnresolvedDependency) -> str:
    """Return "program" or "module" if the package itself has a program or module that is called like the unresolved name.

    "" if it has none, or if its build script or launch files refer to a package of this name.
    """
    package, name = unresolved.package, unresolved.name
    if any(mention.name == name for mention in package.built.mentions):
        return ""
    if any(reference.package == name for launch_file in package.launch for reference in launch_file.references):
        return ""
    own = launch.installed_programs(package)
    if own is not None and name in own.names:
        return "program"
    folders = [module.replace(".", "/") for module in package.built.products.python_packages]
    return "module" if any(f"{folder}/{name}.py" in package.files for folder in folders) else ""


def _uncorrected(unresolved: dependencies.UnresolvedDependency, workspace: Workspace) -> Finding:
    return Finding(
        f"{_what(unresolved.name, workspace)}; {_REMEDY}",
        unresolved.declared.depend.name_span,
        unresolved.name,
        confidence=_confidence(unresolved, "", workspace),
        package=unresolved.package.name,
    )


def _what(name: str, workspace: Workspace) -> str:
    known = f"{workspace.target.distro}, as of {workspace.world.knowledge.date}"
    return f"'{name}' is neither a package nor a rosdep key ({known})"


def _unknown(
    unresolved: dependencies.UnresolvedDependency,
    workspace: Workspace,
    renamed: dict[tuple[str, str], dependencies.UnresolvedDependency],
) -> Finding:
    """Return the finding for an unknown name with a suggestion.

    ``renamed``: the dependencies for which fixes already write another name, by package and new name.
    """
    name, world = unresolved.name, workspace.world
    what = _what(name, workspace)
    meant = world.meant(name, python=unresolved.runs_python)
    other_library = ""
    if meant and meant.by == "slip" and not world.is_package(meant.name) and dependencies.is_used_in_sources(unresolved):
        other_library, meant = meant.name, None  # the code uses the name as well, so it is not a typo of another library
    if (meant is None or meant.by == "slip") and (inside := _in_folder(name, workspace)):
        return _of_folder(unresolved, workspace, f"{what}, only the name of the folder of '{inside}'", inside)
    fix = None
    intended = meant.name if meant else ""
    of_cmake = not unresolved.runs_python and bool(world.knowledge.names.cmake(name))
    installing = () if of_cmake else world.knowledge.rosdep.installing(name)
    sure = _confidence(unresolved, meant.by if meant else "system" if installing else "", workspace)
    if meant is None and installing:
        keys = " or ".join(f"'{key}'" for key in installing[:_MOST_KEYS])
        message = f"{what}, only the name that {_caller('system', installing[0])} uses; write {keys}"
    elif meant is None:
        near = [other for other in world.suggest(name, python=unresolved.runs_python) if other != other_library]
        hint = names.did_you_mean(near, "") or _REMEDY
        if lacking := dependencies.undeclared_match(unresolved, workspace):
            hint = f"write '{lacking}', which is used but not declared{dependencies.availability_remark(workspace, lacking)}"
            sure, intended = Confidence.HIGH, lacking
            fix = dependencies.naming_fix(
                workspace, lacking, f"write '{lacking}' instead of '{name}'", *_rename(unresolved, lacking)
            )
        message = f"{what}; {hint}"
    else:
        # A name that looks like a rosdep key is not the name in another system.
        caller = "" if name.startswith("python3-") else _caller(meant.by, meant.name)
        why = f", only the name that {caller} uses" if caller else ""
        twin = renamed.get((unresolved.package.name, meant.name))
        duplicate = f"'{twin.name}' is declared as well, and both mean '{meant.name}'" if twin else ""
        if unresolved.package.declares(meant.name):
            duplicate = f"'{meant.name}' is declared as well"
        remedy = f"remove it, because {duplicate}" if duplicate else f"write '{meant.name}'"
        message = f"{what}{why}; {remedy}{'' if duplicate else dependencies.availability_remark(workspace, meant.name)}"
        alone = meant.by == "cmake" and _is_found_as_declared(unresolved.package, name)
        if alone:
            message += f" and add find_package({name}), because only {_FINDS_DECLARED}() finds it so far"
        edits, safe = _rename(unresolved, meant.name, twin), sure == Confidence.HIGH and not alone
        if duplicate:
            fix = Fix.of(f"remove '{name}'", *edits, safe=safe)
        else:
            fix = dependencies.naming_fix(workspace, meant.name, f"write '{meant.name}' instead of '{name}'", *edits, safe=safe)
        if fix and fix.safe:
            renamed.setdefault((unresolved.package.name, meant.name), unresolved)
    return Finding(
        message,
        unresolved.declared.depend.name_span,
        name,
        fix=fix,
        confidence=sure,
        package=unresolved.package.name,
        explains=dependencies.wrong_name_explains(name, intended) if fix else (),
    )


def _in_folder(name: str, workspace: Workspace) -> str:
    """Return the only package of the workspace whose folder is called ``name``, "" if there is none or several."""
    all_names = _by_folder(workspace).get(name, ())
    return all_names[0] if len(all_names) == 1 else ""


@cached_by_workspace
def _by_folder(workspace: Workspace) -> Mapping[str, tuple[str, ...]]:
    """Return the names of the packages by the name of their folder."""
    result: dict[str, tuple[str, ...]] = {}
    for package in workspace.packages:
        folder = package.path.rpartition("/")[2]
        if package.name not in result.get(folder, ()):
            result[folder] = (*result.get(folder, ()), package.name)
    return result


def _of_folder(unresolved: dependencies.UnresolvedDependency, workspace: Workspace, what: str, meant: str) -> Finding:
    package = unresolved.package
    own = meant == package.name
    remedy, title = f"write '{meant}'", f"write '{meant}' instead of '{unresolved.name}'"
    if own or package.declares(meant):
        remedy = "remove it" if own else f"remove it, because '{meant}' is declared as well"
        title = f"remove '{unresolved.name}'"
    edits = _removal(unresolved) if own else _rename(unresolved, meant)
    place = unresolved.declared.depend.name_span
    return Finding(
        f"{what}; {remedy}",
        place,
        unresolved.name,
        fix=dependencies.naming_fix(workspace, meant, title, *edits),
        package=package.name,
        explains=dependencies.wrong_name_explains(unresolved.name, meant),
    )


def _caller(by: str, key: str) -> str:
    """Return the tool to which a declared name belongs, such as "pip" or "find_package"; "" if unknown.

    ``by``: the kind of the declared name, e.g. "cmake" for a name of find_package(). ``key``: the rosdep key to declare instead.
    """
    return "pip" if by == "system" and key.endswith("-pip") else _CALLED_SO_BY.get(by, "")


def _is_found_as_declared(package: Package, name: str) -> bool:
    """Return whether CMake finds a package only because it is declared under exactly this name."""
    if _FINDS_DECLARED not in package.built.commands.names:
        return False
    return not any(name in call.texts[:1] for call in package.calls("find_package", anywhere=True))


def _confidence(unresolved: dependencies.UnresolvedDependency, by: str, workspace: Workspace) -> Confidence:
    if not by:
        # Valid package names (REP 144) may belong to unreleased packages; all rosdep keys are known.
        exists = names.may_be_package(unresolved.name) and not dependencies.resembles_ament_package(unresolved.name, workspace)
        return Confidence.MEDIUM if exists else Confidence.HIGH
    # A library may be wrapped in a package of the same name whose sources are in another repository.
    elsewhere = bool(workspace.source_lists) and by in _CALLED_SO_BY
    return Confidence.MEDIUM if elsewhere and names.may_be_package(unresolved.name) else Confidence.HIGH


def _removal(unresolved: dependencies.UnresolvedDependency) -> tuple[Edit, ...]:
    return tuple(edit for tag in unresolved.tags for edit in dependencies.remove_dependency(unresolved.package, tag))


def _rename(
    unresolved: dependencies.UnresolvedDependency, name: str, twin: dependencies.UnresolvedDependency | None = None
) -> tuple[Edit, ...]:
    """Return the edits that write ``name`` into every tag of a dependency.

    If <depend> or the same kinds of tags declare ``name`` already, the edits remove the tags of the dependency instead. The
    result is () if other kinds of tags declare ``name``. ``twin``: another dependency of the package that is renamed to ``name``.
    """
    package = unresolved.package
    have = {declared.depend.tag for declared in package.tags(name)}
    if twin is not None:
        have.update([tag.tag for tag in twin.tags])
    if have:
        if have <= {"depend"} or have == {tag.tag for tag in unresolved.tags}:
            return _removal(unresolved)
        return ()
    return tuple(Edit(tag.name_span, name) for tag in unresolved.tags)


RULE = Rule(
    name="unknown-dependency",
    code="ROS104",
    summary="declared dependencies are known packages or rosdep keys",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    workspace=check,
)
