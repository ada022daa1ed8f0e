"""How a package generates code for its messages, services and actions."""

from __future__ import annotations

from typing import NamedTuple

from ros_lint.base.paths import folders_of
from ros_lint.base.text import Span
from ros_lint.workspace.model import Package


class InterfaceGeneration(NamedTuple):
    """The call of rosidl_generate_interfaces() in a package that installs interfaces."""

    span: Span
    """Span of the command name."""
    certain: bool
    """True if every build runs the call."""
    reads_manifest: bool
    """False if the CMake file is in a subfolder with its own package.xml, because CMake reads that package.xml instead."""


GENERATING = "rosidl_generate_interfaces"
"""The command that generates code for interfaces."""


def interface_generation(package: Package) -> InterfaceGeneration | None:
    """Return the call by which a package generates its interfaces.

    The result is None if the package installs no interfaces, or if its package.xml has errors.
    """
    script, manifest = package.script, package.manifest
    if script is None or manifest is None or manifest.problems or GENERATING not in script.commands.names:
        return None
    place = next((m for m in script.mentions if m.via == "macro" and m.purpose == "interfaces"), None)
    kinds = tuple(f"share/{package.name}/{kind}/" for kind in ("msg", "srv", "action"))
    if (
        place is None
        or not script.products.interfaces
        or not any(file.path.startswith(kinds) for file in script.products.installs)
    ):
        return None
    folders = folders_of(package.relative(place.span.path))
    own = any(f"{folder}/package.xml" in package.files for folder in folders)
    return InterfaceGeneration(place.span, not (place.optional or place.test), not own)
