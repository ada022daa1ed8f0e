"""
## What it finds

A valid `package.xml` with a build script next to it, in a folder below another package. If a build script in a folder without
`package.xml` turns this folder and several packages below it into one plain package, there is a single finding.

## Why it matters

colcon does not search below a package. It does not build, list or test the nested package, and reports no error. The outer
package needs no `package.xml`: if the root of a repository has a `setup.py`, or a `CMakeLists.txt` with `project()`, colcon
treats the whole repository as one plain package.

## How to fix it

- Move the nested package next to the outer one.
- If the outer folder should not be a package, put the packages into a folder of their own and build from there
  (`colcon build --base-paths src`, `ros-lint src`), or rename the build script.
- If the nested package should not be built, put an empty `COLCON_IGNORE` next to its manifest.

## Limitations

Not reported:

- The folder, or a folder between the two packages, has `COLCON_IGNORE`, `AMENT_IGNORE` or `CATKIN_IGNORE`.
- A `CMakeLists.txt` of the outer package adds the folder with `add_subdirectory()`, or with a function of a similar name
  (`add_rosidl_subdirectory()`): it is a part of the outer package.
- The nested manifest is invalid, or has no build script next to it.

Reported with medium confidence:

- Nested packages in folders of tests, templates, examples, vendored or old code (`legacy`), and nested packages that the outer
  one installs: such manifests are usually data.
- A file of the outer package cannot be read.
- One of the two packages is a ROS 1 package (catkin).
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ros_lint.api import Confidence, Finding, Manifest, Package, Related, Rule, Severity, Workspace, files, first_related, names

_DATA = re.compile(
    r"\..*|tests?|testing|fixtures|data|resources?|templates?|examples?|demos?|docs?|vendor|third_?party|3rdparty|external|contrib",
    re.IGNORECASE,
)
"""Names of folders in which a manifest is probably data."""


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    inside = [nested for nested in package.nested if not nested.problems]
    lost = [] if workspace.unread(package) else [nested for nested in inside if _is_lost(package, nested)]
    together = lost if len(lost) > 1 and not package.type.startswith("ros.") else []
    if together:
        yield _all_hidden(package, together)
    for nested in inside:
        if nested not in together:
            yield Finding(
                f"colcon ignores '{nested.name}', because it is inside {_outer(package)}; {_remedy(package, [nested], 'it')}",
                nested.name_span,
                nested.name,
                confidence=Confidence.HIGH if nested in lost else Confidence.MEDIUM,
            )


def _all_hidden(package: Package, lost: list[Manifest]) -> Finding:
    """Return the finding for several packages that colcon ignores, because a folder around them counts as one package."""
    all_names = names.shorten_list(nested.name for nested in lost)
    return Finding(
        f"colcon ignores {all_names}, because they are inside {_outer(package)}; {_remedy(package, lost, 'them')}",
        package.span,
        package.name,
        first_related(Related(f"colcon ignores '{nested.name}'", nested.name_span) for nested in lost),
    )


def _is_lost(package: Package, nested: Manifest) -> bool:
    """Return whether a nested manifest probably belongs to a package that should be built, not to data or to ROS 1."""
    data = any(_DATA.fullmatch(folder) or files.is_auxiliary(f"{folder}/") for folder in _between(package, nested))
    return not (data or _is_installed(package, nested) or package.builds_with == "catkin" or _is_of_ros_1(nested))


def _is_installed(package: Package, nested: Manifest) -> bool:
    """Return whether the outer package installs the manifest with its folder."""
    installed = "/".join(nested.path.split("/")[-2:])
    return any(provided.path.endswith(f"/{installed}") for provided in package.built.products.installs)


def _between(package: Package, nested: Manifest) -> list[str]:
    """Return the names of the folders on the path from a package to a nested manifest."""
    return nested.path.removeprefix(f"{package.path}/").split("/")[:-1]


def _is_of_ros_1(manifest: Manifest) -> bool:
    """Return whether a manifest depends on catkin and has no build type."""
    typed = any(element.tag == "build_type" for element in manifest.exports)
    return not typed and any(depend.name == "catkin" for depend in manifest.depends)


def _outer(package: Package) -> str:
    if package.type.startswith("ros."):
        return f"the package '{package.name}'"
    script = "CMakeLists.txt" if package.type == "cmake" else "setup.py"
    place = f"'{package.path}'" if package.path else "the root folder"
    return f"the package '{package.name}' ({script} makes {place} a package)"


def _remedy(package: Package, inside: list[Manifest], it: str) -> str:
    """Return the remedy for packages that colcon ignores. ``it`` is the pronoun for them in the text, "it" or "them".

    If the package around them is in the root folder, the remedy also names the option --base-paths of colcon, because the
    build script in the root folder may be intended.
    """
    folders = dict.fromkeys(folder for nested in inside for folder in _between(package, nested)[:1])
    place = "its folder" if it == "it" else "their folders"
    remedies = f"move {it} out, or put an empty file COLCON_IGNORE into {place}"
    return remedies if package.path or not folders else f"build with --base-paths {' '.join(folders)}, {remedies}"


RULE = Rule(
    name="nested-package",
    code="ROS115",
    summary="no package is inside another one",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    package=check,
)
