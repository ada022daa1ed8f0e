"""Packages for tests, made by hand or from what discovery finds."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from ros_lint.base.by_name import ByName
from ros_lint.base.text import Text
from ros_lint.collectors.manifest import collect as manifests
from ros_lint.collectors.manifest import conditions
from ros_lint.facts.manifest import ROLES, ColconDepend, Depend, Manifest, Role
from ros_lint.workspace.discovery.discover import DiscoveredPackage
from ros_lint.workspace.model import Declared, Package

CONTEXT = {"ROS_VERSION": "2", "ROS_PYTHON_VERSION": "3", "ROS_DISTRO": "jazzy", "DISABLE_GROUPS_WORKAROUND": "1"}


def manifest_text(name: str, lines: Iterable[str] = (), build_type: str = "ament_cmake") -> str:
    """Return a valid ``package.xml`` of format 3, a line of it for each of ``lines``."""
    head = f'<package format="3">\n  <name>{name}</name>\n  <version>0.1.0</version>\n  <description>d</description>\n'
    head += '  <maintainer email="a@b.cc">a</maintainer>\n  <license>L</license>\n'
    body = "".join(f"  {line}\n" for line in lines)
    return f"{head}{body}  <export><build_type>{build_type}</build_type></export>\n</package>\n"


def package(
    name: str,
    lines: Iterable[str] = (),
    path: str = "",
    kind: str = "ros.ament_cmake",
    extra: Iterable[ColconDepend] = (),
) -> Package:
    """Return a package whose manifest has these lines; it lies in a folder of its name if not said otherwise."""
    path = path or name
    manifest = manifests.collect(Text(f"{path}/package.xml", manifest_text(name, lines)))
    return made(name, path, kind, manifest, tuple(extra))


def found_package(found: DiscoveredPackage, context: Mapping[str, str] = CONTEXT) -> Package:
    """Return a package as far as discovery knows it."""
    made_of = made(found.name, found.path, found.type, found.manifest, found.colcon_depends, found.files, context)
    return made_of._replace(renamed=found.colcon_name if found.colcon_name != found.name else "")


def made(
    name: str,
    path: str,
    kind: str,
    manifest: Manifest | None,
    colcon_depends: tuple[ColconDepend, ...] = (),
    files: tuple[str, ...] = (),
    context: Mapping[str, str] = CONTEXT,
) -> Package:
    active = [
        (depend, truth)
        for depend in (manifest.depends if manifest else ())
        if (truth := conditions.truth(depend.condition, context)) is not False
    ]
    return Package(
        name=name,
        path=path,
        type=kind,
        manifest=manifest,
        declared=ByName(_declared(depend, truth) for depend, truth in active if depend.tag in ROLES),
        groups=tuple(depend.name for depend, _ in active if depend.tag == "member_of_group"),
        group_depends=tuple(_declared(depend, truth) for depend, truth in active if depend.tag == "group_depend"),
        colcon_depends=colcon_depends,
        files=files,
        unvisited_folders=(),
        nested=(),
        script=None,
        launch=(),
        uses=(),
        textual_mentions={},
        opaque=(),
    )


def _declared(depend: Depend, truth: bool | None) -> Declared:
    return Declared(depend, ROLES.get(depend.tag, Role(0)), truth is True)
