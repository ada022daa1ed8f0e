"""
## What it finds

A package that is used, although no dependency in `package.xml` provides it where it is needed: an included header, an imported
Python module, a `find_package()`, a message type, or a package whose files are looked up.

A used package that a declared dependency provides is reported as well if that dependency has a tag for another purpose:

- It is needed to build, and only an `<exec_depend>`, `<build_export_depend>` or `<test_depend>` provides it.
- It is needed to run, and only a `<build_depend>`, `<buildtool_depend>` or `<test_depend>` provides it.

## Why it matters

It works only if another package happens to be installed or built first. On a clean machine, in a container or on the build farm
it fails: colcon may build the packages in the wrong order, `rosdep install` does not install the package, and the released
binary lacks it.

The tags of a package decide what is installed:

- to build the package: its `build_depend`, `buildtool_depend` and `depend`, because bloom makes them the `Build-Depends` of the
  source package;
- together with the package: its `exec_depend`, `build_export_depend`, `buildtool_export_depend` and `depend`, because bloom
  makes them the `Depends` of the binary package.

`rosdep install --dependency-types` distinguishes the tags in the same way. What these dependencies need at run time or export
is installed with them. colcon alone makes everything available for every purpose, so such a mistake is not noticed in a
workspace.

## How to fix it

Declare the package in `package.xml`, with the tag that the message names. The fix adds it.

- `<depend>`: needed to compile and at run time;
- `<exec_depend>`: needed only at run time;
- `<test_depend>`: needed only for tests.

If `find_package()` finds a package that no code uses, remove the call. There is no fix here, because only you know whether the
code shall use the package.

If the package is declared under a condition that is false, widen the condition.

The fix is safe if the name resolves in the chosen distribution, or in every active one if none was chosen. Otherwise
the message names the distributions that have or lack the name, and the fix needs `--unsafe-fixes`. It is also unsafe for keys
that rosdep installs by pip, because pip refuses to install outside of virtual environments on newer systems (PEP 668).

## Limitations

Not reported:

- Packages that a declared dependency with a tag for the same purpose provides: see `transitive-dependency`.
- Packages that come with a dependency which needs another tag itself: see `wrong-dependency-kind`.
- Packages that come with a dependency with the right tag in another distribution, if the distribution is not set.
- Packages that exist only for tests, if a dependency with any tag provides what they use, because every tag then serves tests.
- Parts of launch that only launch files import, if a dependency with any tag provides them, because `ros2 launch` does so, too.
- Names that only launch files start, include or look up, except in tests: see `launch-outside-closure`.
- Templates for other packages, scripts that build the documentation, and copies made by editors.
- Names of the system, and names that are neither a known package nor a rosdep key. Exceptions are listed below.
- Optional uses of a package that depends on this one.

Unknown names are reported if they can only be packages:

- Packages whose messages are used. The confidence is medium, unless another package of the workspace declares the name or CMake
  requires it.
- Names that another package of the workspace declares, if CMake finds them here or something looks them up.
- With medium confidence, names that no package declares, if an installed file certainly looks them up: `$(find x)` always means
  a package.

Reported with medium confidence:

- The package is declared under a wrong name: see `unknown-dependency`. There is no fix here.
- colcon rejects `package.xml`, which has to be fixed first.
- Only other distributions have or had the package: the message names these distributions. A dependency that provides the
  package there counts as providing it here. If the distribution is not set, such packages are reported like other packages.
- A declared dependency is unknown and may provide the package, unless another use shows that it cannot.
- All uses are in files that may not be built or installed.
- The package is declared under a false condition and CMake does not ask for it: the files may be for other systems.
- Files are looked up in a released metapackage, which has none: another package of that name may be intended.
- The package depends on this one, with any tag, so declaring it would close a cycle that colcon rejects. There is no fix.

Optional uses are reported with low confidence and without a fix:

- `find_package(QUIET)` before `if(X_FOUND)`, and `__has_include`;
- `try: import`, and `try: from .file import` of the file that contains the use;
- imports where a comparison of `ROS_VERSION` selects ROS 1.

There is also no fix if no rosdep key resolves for the distribution, and for a project of the workspace without `package.xml`:
colcon builds it, but rosdep cannot resolve its name.

Some packages come with another undeclared package for the same purposes. They are not shown beside the other package, because
only one line is missing. Once the other package is declared, they are reported as `transitive-dependency`:

- parts of launch that only launch files import: `ament_index_python` beside `launch_ros`;
- tools that run tests: `python3-pytest` beside `ament_cmake_pytest`;
- libraries that are included only in files that also include headers of the other package, if the other package depends on them
  directly: `orocos_kdl_vendor` beside `kdl_parser`. Exceptions: interfaces, and packages that `find_package()` names.

The severity is lower if the package works where it is built, launched and tested today:

- info for modules of launch and its dependencies that only launch files import, because `ros2 launch` provides them;
- warning for `python3-pytest`, because colcon itself depends on it;
- warning for libraries that rosdep installs by pip, because released packages cannot depend on them;
- warning for libraries in requirement files or `install_requires`, if rosdep installs them only on some platforms;
- warning for packages whose tag is commented out in `package.xml`, because the author removed it on purpose;
- warning for `ros_environment`, which `ros_core` installs, so that the variables are unset only on the build farm;
- warning for packages that other dependencies provide in some distributions, if no distribution was chosen;
- warning for public headers that the package itself does not compile, because dependents that declare the package build;
- warning for imports whose names the file never uses: remove the import, or declare the package; the fix is unsafe;
- warning for imports in modules that no program, launch file, script or test of the package imports, if it has programs;
- warning for imports in modules that Python 3 cannot import: with a dash in the path, or with the syntax of Python 2;
- warning for files that a model looks up in `<xacro:if value="$(arg x)">`, if the default of the argument `x` is false.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ros_lint.api import (
    ByName,
    Confidence,
    Consequence,
    Facet,
    Finding,
    Package,
    Role,
    Rule,
    Severity,
    Use,
    Workspace,
    build,
    dependencies,
    first_related,
)


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    if not dependencies.manifest_is_complete(package):
        return
    undeclared_needs = dependencies.undeclared(package, workspace)
    by_name = ByName([need for need, _ in undeclared_needs])
    with_launch = {need.name for need, _ in undeclared_needs if dependencies.is_part_of_launch(package, workspace, need.uses)}
    for need, sure in undeclared_needs:
        declared_how = "declares it only in a comment" if _is_commented_out(package, need.name) else "does not declare it"
        problem = f"is used here, but package.xml {declared_how}"
        is_mild = (
            need.name == _PYTEST
            or _is_unreached(package, need)
            or _is_only_in_uncompiled_headers(package, need)
            or _is_left_to_pip(package, workspace, need)
            or _is_unused(need)
            or _is_of_environment(need)
            or _is_commented_out(package, need.name)
        )
        severity = Severity.INFO if need.name in with_launch else Severity.WARNING if is_mild else None
        finding = _finding(package, workspace, need, problem, Confidence.HIGH if sure else Confidence.MEDIUM)
        if dependencies.is_declared_misspelled(package, workspace, need):  # another rule fixes the name
            message = f"'{need.name}' is used here, but package.xml declares it under a wrong name; correct the name"
            finding = finding._replace(message=message, fix=None)
        elif _is_unused(need) and finding.fix:
            message = (
                f"'{need.name}' is imported but unused, and package.xml does not declare it: remove the import, or declare "
                f"'{need.name}'"
            )
            finding = finding._replace(message=message, fix=finding.fix._replace(safe=False))
        elif advice := _removal(package, workspace, need):
            finding = finding._replace(message=advice, fix=None)
        if finding.fix:
            finding = finding._replace(explains=_brought(package, workspace, need, by_name))
        yield finding._replace(severity=severity or finding.severity)
    for lack in dependencies.misplaced(package, workspace):
        tag = lack.depend.tag
        problem = f"is used here, but comes only with <{tag}>{lack.depend.name}</{tag}>, which is not installed {lack.purpose}"
        uses = (*lack.uses, *(use for use in lack.need.uses if use not in lack.uses))
        finding = _finding(package, workspace, lack.need._replace(uses=uses), problem, Confidence.HIGH)
        if advice := _removal(package, workspace, lack.need):
            finding = finding._replace(message=advice, fix=None, severity=Severity.WARNING)
        yield finding
    for wish in dependencies.optional_needs(package, workspace):
        if not wish.is_transitive:
            problem = "is used here if it is available, but package.xml does not declare it"
            yield _finding(package, workspace, wish, problem, Confidence.LOW)._replace(fix=None)


def _finding(package: Package, workspace: Workspace, need: dependencies.Need, problem: str, confidence: Confidence) -> Finding:
    """Return the finding for an undeclared package (``need``). ``problem``: the part of the message that says what is wrong.

    The confidence is at most medium if colcon rejects the manifest, or if the declaration would close a cycle.
    """
    best, *others = sorted(need.uses, key=lambda use: _is_in_unreached_module(package, use))
    name = need.name
    role = Role.TEST if name in build.unguarded_tests(package) else need.role  # unguarded-test asks to move it to the tests
    proposal = dependencies.remedy(package, workspace, name, role)
    elsewhere = _elsewhere(name, workspace)
    condition, suggestion = _condition(package, name), _suggestion(name, workspace)
    # A dependency with the wrong tag provides the package in other distributions, too.
    remark = _provided_elsewhere(package, workspace, name) if need.name not in _misplaced_names(package, workspace) else ""
    is_partial = proposal.conditional or bool(remark)
    if proposal.circular:
        message = f"'{name}' is used here, but cannot be declared: {proposal.obstacle}"
    elif elsewhere:
        remedy = "replace it, or add its sources to the workspace"
        message = f"'{name}' {problem}; {workspace.target.distro} has no such package, only {elsewhere}: {remedy}"
    elif suggestion:
        message = f"'{name}' is used here, but there is no such package; did you mean '{suggestion}'?"
    elif proposal.obstacle:
        message = f"'{name}' {problem}, and it cannot be declared: {proposal.obstacle}"
    elif condition:
        message = (
            f"'{name}' is used here, but package.xml declares it only under the condition '{condition}'; widen the condition"
        )
    elif best.what.startswith("$ENV{"):
        message = f"only '{name}' sets {best.what}, and package.xml does not declare it: add {proposal.written}"
    elif module := _module_of_declared_name(package, name, best):
        message = (
            f"the Python module '{module}' is not in the declared '{module}', but in '{name}', which package.xml does not "
            f"declare: add {proposal.written}"
        )
    else:
        message = f"'{name}' {problem}: add {proposal.written}{remark}"
        if instead := _instead_of_distutils(best):
            message = f"Python 3.12 removed '{best.name}': use {instead}, or add {proposal.written}, which still provides it"
        if _needs_back(name, package, workspace):
            message = (
                f"'{name}' {problem}; '{name}' also uses '{package.name}', but two packages cannot declare each other: "
                "move the shared part into one of them, and declare that package in the other"
            )
    return Finding(
        message,
        best.span,
        name,
        first_related(dependencies.use_note(name, use) for use in others),
        None if elsewhere or condition or suggestion else proposal.fix,
        confidence if proposal.certain else min(confidence, Confidence.MEDIUM),
        Severity.WARNING if _is_conditional(need) or (not workspace.target.explicit and is_partial) else None,
    )


def _misplaced_names(package: Package, workspace: Workspace) -> frozenset[str]:
    """Return the names of used packages that come only with a dependency whose tag does not fit the use.

    Example: the package is used to build, but comes with an ``<exec_depend>``.
    """
    return frozenset([lack.need.name for lack in dependencies.misplaced(package, workspace)])


def _provided_elsewhere(package: Package, workspace: Workspace, name: str) -> str:
    """Return a remark about the distributions in which declared dependencies provide ``name``; "" if there are none.

    The result is also "" if the user chose the distribution.
    """
    if workspace.target.explicit:
        return ""
    distros = dependencies.distros_providing(package, workspace, name)
    if not distros:
        return ""
    return f"; in {', '.join(distros)} other dependencies provide it, in {workspace.target.distro} they do not"


def _is_conditional(need: dependencies.Need) -> bool:
    """Return whether only optional parts of models need the package: xacro leaves them out unless an argument is passed."""
    return all(use.conditional for use in need.uses)


def _is_unreached(package: Package, need: dependencies.Need) -> bool:
    """Return whether the package is needed only in modules that nothing in this package starts or imports."""
    uses = [use for use in need.uses if use.certain] or need.uses
    return all(_is_in_unreached_module(package, use) for use in uses)


def _is_in_unreached_module(package: Package, use: Use) -> bool:
    return use.via == "import" and package.relative(use.span.path) in package.unreached_modules


def _is_commented_out(package: Package, name: str) -> bool:
    """Return whether a dependency tag with the name is commented out in the manifest: its author removed it on purpose."""
    text = package.manifest.text if package.manifest else ""
    if name not in text:
        return False
    tag = re.compile(rf"<\w*depend\b[^>]*>\s*{re.escape(name)}\s*</")
    return any(tag.search(comment) for comment in _COMMENT.findall(text))


_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)


def _is_of_environment(need: dependencies.Need) -> bool:
    """Return whether a needed package is used only for its environment variables.

    The package is then ros_environment, which ros_core installs.
    """
    return all(use.what.startswith("$ENV{") for use in need.uses)


def _is_unused(need: dependencies.Need) -> bool:
    """Return whether the package is only imported, and no source uses an imported name."""
    return all(use.unused for use in need.uses)


def _is_only_in_uncompiled_headers(package: Package, need: dependencies.Need) -> bool:
    """Return whether the needed package is included only by public headers that this package does not compile.

    Then this package builds without the needed package. Only dependents that do not declare the needed package fail.
    """
    targets = package.built.products.targets
    if package.hidden(Facet.LIBRARIES | Facet.EXECUTABLES) or any(
        target.optional_sources or target.test or not target.sources_known for target in targets
    ):
        return False
    compiled = frozenset().union(*package.compiled_headers.values())
    return all(
        use.via in _CODE and use.role & Role.EXPORT and package.relative(use.span.path) not in compiled for use in need.uses
    )


def _is_left_to_pip(package: Package, workspace: Workspace, need: dependencies.Need) -> bool:
    """Return whether rosdep installs a needed library by pip.

    True also for a library that rosdep does not install on every platform, if a requirement file or setup.py names it.
    """
    if workspace.world.is_package(need.name) or not all(use.via == "import" for use in need.uses):
        return False
    if dependencies.is_of_pip(workspace, need.name):
        return True
    library = need.name.removeprefix("python3-").removesuffix("-pip").replace("-", "_").lower()
    modules = {use.name.partition(".")[0].lower() for use in need.uses}
    is_required = not package.pip_requirements.isdisjoint({library, *modules})
    return is_required and bool(dependencies.availability_remark(workspace, need.name))


def _removal(package: Package, workspace: Workspace, need: dependencies.Need) -> str:
    """Return the message that advises to remove an unneeded find_package() of a package that is not declared (``need``).

    The result is "" if ``package`` may use what the find_package() finds.
    """
    if call := _leftover(package, workspace, need):
        return f"package.xml does not declare '{need.name}', and nothing in this package uses it; remove {call}"
    if call := _unused_find(package, workspace, need):
        return (
            f"package.xml does not declare '{need.name}', and no code uses it; remove {call}, or declare '{need.name}' "
            "if the code needs it"
        )
    return ""


def _leftover(package: Package, workspace: Workspace, need: dependencies.Need) -> str:
    """Return the unneeded find_package() of a package that only generates interfaces, as text for a message.

    The result is "" if the package builds other targets, or may use the found package (``need``).
    """
    products = package.built.products
    if not products.interfaces or any(target.kind != "other" for target in products.targets):
        return ""
    name = _unused_name(package, workspace, need)
    return _calls(name, need) if name else ""


def _unused_find(package: Package, workspace: Workspace, need: dependencies.Need) -> str:
    """Return the call find_package() that finds a package which no code uses, as text for a message.

    ``need`` is the found package, and only the build script names it. The result is "" if code or anything else may use it,
    or if ``package`` builds no targets.
    """
    if workspace.unread() or not dependencies.is_build_visible(package) or not package.built.products.targets:
        return ""
    name = _unused_name(package, workspace, need)
    if not name or _condition(package, need.name) or any(use.via not in _IN_BUILD_SCRIPT for use in need.uses):
        return ""
    return "" if dependencies.finding_others(package, workspace, (name,)) else _calls(name, need)


def _unused_name(package: Package, workspace: Workspace, need: dependencies.Need) -> str:
    """Return the name by which an unused find_package() finds the needed package, "" if there is none."""
    finds = {mention.span: mention.name for mention in dependencies.unused_find_packages(package, workspace)}
    return next((finds[use.span] for use in need.uses if use.span in finds), "")


def _calls(name: str, need: dependencies.Need) -> str:
    return f"find_package({name})" + (" and the other places that name it" if len(need.uses) > 1 else "")


def _brought(
    package: Package, workspace: Workspace, need: dependencies.Need, all_needs: ByName[dependencies.Need]
) -> tuple[Consequence, ...]:
    """Return the findings that are hidden because the finding for ``need``, an undeclared package, explains them.

    They are about undeclared packages on which ``need`` depends. These packages need no tag once ``need`` is declared.
    """
    closure = workspace.world.closure((need.name,))
    others = all_needs.named(*closure.names) if len(closure) < len(all_needs) else all_needs
    return tuple(
        [
            Consequence("undeclared-dependency", other.name)
            for other in others
            if other is not need and other.name in closure and _needs_no_tag(package, workspace, other, need)
        ]
    )


def _needs_no_tag(package: Package, workspace: Workspace, other: dependencies.Need, need: dependencies.Need) -> bool:
    """Return whether the needed package ``other`` needs no tag of its own once the package ``need`` is declared.

    This holds if ``need`` depends on ``other``, and packages that declare ``need`` rarely declare ``other``.
    """
    serves_more = bool(other.role & ~need.role)
    if dependencies.is_found_by_cmake(other) or (serves_more and other.role is not Role.TEST):
        return False
    if dependencies.is_part_of_launch(package, workspace, other.uses):
        return True
    if other.role is Role.TEST and other.name in dependencies.TEST_MODULES:
        return True
    files_of_need = {use.span.path for use in need.uses}
    return workspace.world.path((need.name,), other.name) == (need.name, other.name) and all(
        use.via in _CODE and use.span.path in files_of_need and not _GENERATED.match(use.name) for use in other.uses
    )


def _instead_of_distutils(use: Use) -> str:
    """Return the replacement for a module of distutils that an import names, "" for any other use."""
    module = use.name if use.via == "import" else ""
    return _INSTEAD_OF_DISTUTILS.get(module, "setuptools") if module.partition(".")[0] == "distutils" else ""


_INSTEAD_OF_DISTUTILS = {
    "distutils.archive_util": "shutil.make_archive()",
    "distutils.dir_util": "shutil.copytree(), shutil.rmtree() and os.makedirs()",
    "distutils.file_util": "shutil.copy() and shutil.move()",
    "distutils.log": "logging",
    "distutils.spawn": "subprocess.run() and shutil.which()",
    "distutils.sysconfig": "sysconfig",
    "distutils.util": "sysconfig.get_platform() or your own strtobool()",
    "distutils.version": "packaging.version.Version (rosdep key python3-packaging)",
}
"""Replacements for the modules of distutils, as PEP 632 recommends; setuptools replaces all others."""
_PYTEST = "python3-pytest"
_CODE = frozenset({"include", "symbol"})
_IN_BUILD_SCRIPT = frozenset({"cmake", "target"})
_GENERATED = re.compile(r"\w+/(?:msg|srv|action)/")
"""Pattern of headers of interfaces. Their packages are mostly declared even if another package provides them."""


def _suggestion(name: str, workspace: Workspace) -> str:
    """Return the package that the unknown name ``name`` most likely means, "" if the name is known or ambiguous.

    The result is a package with a similar name, or the only package of the workspace with the name after a prefix:
    ``my_robot_msgs`` for ``robot_msgs``.
    """
    if workspace.world.resolution(name) != "unknown":
        return ""
    meant = workspace.world.meant(name)
    if meant is not None and workspace.world.is_package(meant.name):
        return meant.name
    prefixed = [candidate for candidate in workspace.by_name if candidate.endswith(f"_{name}")]
    return prefixed[0] if len(prefixed) == 1 else ""


def _module_of_declared_name(package: Package, name: str, use: Use) -> str:
    """Return the imported module if package.xml declares its name, although package ``name`` contains the module.

    Example: ``import yaml`` of 'python3-yaml' while a package 'yaml' is declared. The result is "" for other uses.
    """
    module = use.name.partition(".")[0] if use.via == "import" else ""
    return module if module != name and package.tags(module) else ""


def _condition(package: Package, name: str) -> str:
    """Return the false condition under which the manifest declares a name; "" if it does not declare it."""
    depends = package.manifest.depends if package.manifest else ()
    return next((depend.condition for depend in depends if depend.name == name), "")


def _needs_back(name: str, package: Package, workspace: Workspace) -> bool:
    """Return whether ``name`` is a package of the workspace that certainly needs ``package`` without declaring it."""
    others = workspace.by_name.get(name, ())
    return any(need.name == package.name and sure for other in others for need, sure in dependencies.undeclared(other, workspace))


def _elsewhere(name: str, workspace: Workspace) -> str:
    """Return the distributions that have the package, as a list in text; "" if the chosen distribution has it or none does.

    If no distribution is set, packages of all distributions are available.
    """
    world = workspace.world
    if world.is_key(name) or dependencies.exists_in_any_distro(name, workspace):
        return ""
    # A package that another one declares may be available as source.
    ended = () if world.is_declared(name) else world.knowledge.names.end_of_life(name)
    return ", ".join(world.where_else(name) or ended)


RULE = Rule(
    name="undeclared-dependency",
    code="ROS201",
    summary="packages declare the packages that they use",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
