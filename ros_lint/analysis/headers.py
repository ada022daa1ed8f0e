"""The headers of a package: whether they are installed, and which packages include them."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from ros_lint.analysis.build.commands import EXPORTING_PLUGINS, REGISTERING, evaluated_name, opaque_except_undefined_targets
from ros_lint.analysis.dependencies.find_package import names_searched
from ros_lint.analysis.finding import Related
from ros_lint.analysis.memo import cached_by_package, cached_by_workspace
from ros_lint.analysis.wording import first_related
from ros_lint.base.auxiliary_files import THIRD_PARTY_FOLDERS, is_auxiliary
from ros_lint.base.text import Span
from ros_lint.collectors.suffixes import HEADERS
from ros_lint.facts.build import BuildScript
from ros_lint.facts.cmake import Call
from ros_lint.facts.sources import Use
from ros_lint.facts.visibility import Facet
from ros_lint.workspace.model import Package, Workspace

Includes = Sequence[tuple[Package, Use]]
"""Places that include a header, each with the package whose source contains the include."""


class OwnHeaders(NamedTuple):
    """The headers in ``include/`` of a package."""

    files: Sequence[str]
    """Paths relative to the package, at least one."""
    installed: bool
    """True if headers of the package are installed, in ``include/`` or elsewhere. Headers of third-party code do not count."""
    included: Includes
    """The includes of these headers in other packages of the workspace."""
    exports: Sequence[Call]
    """Unconditional calls of ament_export_include_directories() that export the folder of the headers."""
    library: bool
    """True if the package installs a library."""
    loaded: bool
    """True if a library of the package may be loaded at run time instead of linked."""
    insertion: Span
    """The place in the build script where a fix can insert an install() command."""


EXPORTING_LIBRARIES = ("ament_export_interfaces", "ament_export_libraries", "ament_export_targets")
"""Commands that export libraries, so that other packages can link to them."""
_FOLDERS = ("include_directories", "target_include_directories")


@cached_by_package
def own_headers(package: Package, workspace: Workspace) -> OwnHeaders | None:
    """Return the headers of a package; None if there are none, or if the build script cannot be fully analysed."""
    script = package.script
    if script is None or package.builds_with != "ament_cmake" or opaque_except_undefined_targets(package, Facet.LIBRARIES):
        return None
    headers = [file for file in package.files if file.startswith("include/") and file.endswith(HEADERS)]
    if not headers or script.commands.insertion is None:
        return None
    names = {_name(file) for file in headers}
    installed = [file for file in script.products.installs if file.path.endswith(HEADERS) and not _is_third_party(file.source)]
    includes = _includes(workspace).get(package.name, ())
    return OwnHeaders(
        headers,
        any(file.source or _name(file.path) in names for file in installed),
        [(other, use) for other, use in includes if any(file.endswith(f"/{use.name}") for file in headers)],
        _exports(package),
        any(file.path.startswith("lib/lib") for file in script.products.installs),
        _is_loaded(package, script),
        script.commands.insertion,
    )


def related_includes(includes: Includes) -> tuple[Related, ...]:
    """Return the places of the first four includes, as related places of a finding."""
    return first_related(Related(f"'{use.name}' is included in '{other.name}'", use.span) for other, use in includes)


_GAZEBO = re.compile(r"(?:gazebo|gz|ignition)(?!.*_msgs$)", re.IGNORECASE)
"""Matches names in find_package() that show that a package builds plugins of Gazebo."""


def _is_loaded(package: Package, script: BuildScript) -> bool:
    """Return whether a library of the package may be loaded at run time instead of linked."""
    if any(True for _ in package.calls(EXPORTING_PLUGINS, *REGISTERING, anywhere=True)):
        return True
    return any(_GAZEBO.match(name) for name in names_searched(package, script))


def _is_third_party(path: str) -> bool:
    return not THIRD_PARTY_FOLDERS.isdisjoint(path.split("/")[:-1])


def _name(path: str) -> str:
    return path.rpartition("/")[2]


@cached_by_workspace
def _includes(workspace: Workspace) -> Mapping[str, list[tuple[Package, Use]]]:
    """Return the places where packages include headers of other packages, by the name of the package with the header."""
    includes: dict[str, list[tuple[Package, Use]]] = {}
    for package in workspace.packages:
        if package.script is None or _searches_outside(package):
            continue
        for use in package.uses:
            others = workspace.by_name.get(use.package, ()) if use.via == "include" and use.certain and not use.optional else ()
            if others and use.package != package.name and not is_auxiliary(package.relative(use.span.path)):
                includes.setdefault(use.package, []).append((package, use))
    return includes


def _searches_outside(package: Package) -> bool:
    """Return whether an include directory of the package is a path that leads outside of it."""
    calls = package.calls(*_FOLDERS, anywhere=True)
    return any("../" in text or text.startswith("/") or "ENV{" in text for call in calls for text in call.texts)


def _exports(package: Package) -> list[Call]:
    return [
        call
        for call in package.calls("ament_export_include_directories", anywhere=True)
        if not call.blocks and any((evaluated_name(package, text) or "").startswith("include") for text in call.texts)
    ]
