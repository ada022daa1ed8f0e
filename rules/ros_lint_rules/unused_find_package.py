"""
## What it finds

A `find_package()` of a ROS package that the code does not use: no include, macro, interface or import refers to it. Linking its
targets, exporting it, or naming it in the `DEPENDENCIES` of `rosidl_generate_interfaces()` does not count as use.

## Why it matters

Configuring takes longer, and this package can only be built where the other one is available.

## How to fix it

Remove the `find_package()` and the linked target, and the dependency from `package.xml`.

## Limitations

Not reported:

- The package provides CMake macros, plugins or components, or is a build tool.
- The code contains the name of the package, for example as a namespace, which a header of another package may declare.
- Another file of the package contains the name.
- The code uses a type of the package by its bare name.
- The code includes a header of an unknown package, in a folder whose name begins like that of the package.
- The script uses variables of the package other than those for linking.
- The package is found for tests, or it is optional.
- The script compiles sources outside of the package, or has include directories there.
- The script cannot be fully evaluated, or code is generated from interfaces that cannot be read or are written in IDL.

Reported with medium confidence:

- The package is not declared by `<depend>` or `<build_depend>`. If it is not declared at all, see `undeclared-dependency`.
- The script links or exports it, and a package whose headers the code includes depends on it. The code may use it by other
  names, such as an alias of a type. Packages of interfaces are an exception.
- Only this `find_package()` may find another package, which the code uses.
- Only its tag may provide a package that is used but not declared, by this package or another one of the workspace.
- The package has no code of its own, such as a metapackage, whose dependencies are its purpose.
- A file of the workspace cannot be read.
"""

from __future__ import annotations

import re
from collections.abc import Container, Iterator, Mapping, Sequence

from ros_lint.api import (
    Confidence,
    Consequence,
    Declared,
    Finding,
    Mention,
    Package,
    Related,
    Rule,
    Severity,
    Workspace,
    dependencies,
    first_related,
)

_TAGS = ("depend", "build_depend")

_RUN_TAGS = ("build_export_depend", "exec_depend")
"""Tags that are removed together with those to build."""


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    unused = dependencies.unused_find_packages(package, workspace)
    if not unused:
        return
    declared = {mention.name: _always_declared(package, mention.name, _TAGS) for mention in unused}
    needed = _needed_for_others(package, workspace, declared)
    included = {use.package for use in package.uses if use.via == "include"}
    reached = workspace.world.closure(sorted(included))
    unsure = workspace.unread() or not dependencies.is_build_visible(package)
    for mention in unused:
        name, tags = mention.name, declared[mention.name]
        others = _also_named(package, mention)
        places = [_call(package, mention)] + ([f"the other uses of '{name}' in the build script"] if others else [])
        if tags and name not in needed:
            removed = (*tags, *_always_declared(package, name, _RUN_TAGS))
            places += [f"<{tag.depend.tag}>{name}</{tag.depend.tag}>" for tag in removed]
        remedy = f"remove {_listed(places)}"
        if places[0].startswith("'") and len(places) > 1:
            remedy = f"remove {places[0]}, and remove {_listed(places[1:])}"
        by_alias = bool(others) and name in reached and not _is_of_interfaces(name, workspace)
        sure = tags and name not in needed and not by_alias and not unsure
        yield Finding(
            f"no code uses '{name}'; {remedy}",
            mention.span,
            name,
            first_related(Related(f"'{name}' is also named here: {other.what or other.name}", other.span) for other in others),
            confidence=Confidence.HIGH if sure else Confidence.MEDIUM,
            explains=tuple(Consequence(rule, name) for rule in _EXPLAINED) if sure else (),
        )


_EXPLAINED = ("wrong-dependency-kind", "unexported-dependency")
"""Rules that ask to declare or export the package. Without find_package() there is nothing to declare or export."""


def _listed(places: Sequence[str]) -> str:
    *first, last = places
    return f"{', '.join(first)} and {last}" if first else last


def _call(package: Package, find: Mention) -> str:
    """Return what to remove, as text for a message: a call of find_package(), or a name in the list of a loop around the call."""
    finds = [mention for mention in package.built.mentions if mention.via == "cmake" and mention.span == find.span]
    in_loop = any(mention.name != find.name for mention in finds)
    return f"'{find.name}' from the loop around this find_package()" if in_loop else f"find_package({find.name})"


def _is_of_interfaces(name: str, workspace: Workspace) -> bool:
    """Return whether a package generates interfaces.

    Code contains the name of such a package wherever it uses an interface, because it writes types in full.
    """
    released = workspace.world.released(name)
    local = workspace.by_name.get(name)
    return any(member.built.products.interfaces for member in local) if local else bool(released and released.interfaces)


def _always_declared(package: Package, name: str, tags: Container[str]) -> tuple[Declared, ...]:
    """Return the declarations of a dependency by some tags, without those that have a condition."""
    return tuple([declared for declared in package.tags(name) if declared.depend.tag in tags and declared.always])


def _needed_for_others(package: Package, workspace: Workspace, unused: Mapping[str, Sequence[Declared]]) -> frozenset[str]:
    """Return those packages of ``unused`` that may have to stay, because they provide or find a package that is used.

    ``unused``: the names of the packages, each with the tags that declare the package.
    """
    tags = [declared for declared_tags in unused.values() for declared in declared_tags]
    return dependencies.finding_others(package, workspace, unused).union(
        dependencies.needed_transitively(package, workspace, tags)
    )


def _also_named(package: Package, find: Mention) -> list[Mention]:
    """Return the other places where the build script names the package, such as links and exports.

    They have to be removed, too, because they fail without the find_package(). The variables of the package in lists of names to
    link are among them: ``set(names ${std_msgs_TARGETS})``.
    """
    places = {
        mention.span: mention
        for mention in package.built.mentions
        if mention.name.partition("::")[0] == find.name and mention.span != find.span
    }
    for call in package.calls("list", "set", anywhere=True):
        for index, text in enumerate(call.texts):
            if (match := _LINKED.fullmatch(text)) and match[1] == find.name:
                places.setdefault(call.span(index), Mention(find.name, "target", call.span(index), text))
    return [places[span] for span in sorted(places)]


_LINKED = re.compile(r"\$\{(\w+)_(?:TARGETS|LIBRARIES|INCLUDE_DIRS)\}")


RULE = Rule(
    name="unused-find-package",
    code="ROS205",
    summary="packages found with find_package() are used by code",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    package=check,
)
