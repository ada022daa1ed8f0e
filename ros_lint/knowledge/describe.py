"""Convert a package manifest to an entry of the package index."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros_lint.collectors.interfaces.naming import GROUP
from ros_lint.collectors.manifest.conditions import ConditionError, build_types, parse, truth, variables
from ros_lint.facts.environment import ROS_2
from ros_lint.facts.manifest import DEPENDENCY_KINDS
from ros_lint.knowledge.index import BUILD_TYPES, Released

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ros_lint.facts.manifest import Manifest


def context(distro: str) -> Mapping[str, str]:
    """Return the values of the variables in manifest conditions that bloom uses for a release in the distribution ``distro``."""
    return {**ROS_2, "ROS_DISTRO": distro}


def describe(manifest: Manifest, known_variables: Mapping[str, str]) -> Released:
    """Return the package index entry for a manifest. Unknown variables in conditions count as empty, as in all ROS tools.

    The name of the entry is the name in the manifest. The name of the folder or of the release may differ.
    """
    depends: dict[str, set[str]] = {}
    interfaces = False
    for depend in manifest.depends:
        if not holds(depend.condition, known_variables):
            continue
        kinds = DEPENDENCY_KINDS[depend.tag].letters
        if kinds == "M" and depend.name == GROUP:
            interfaces = True
            continue
        for kind in kinds:
            depends.setdefault(kind, set()).add(depend.name)
    types = [name for name, _ in build_types(manifest, known_variables)] or ["catkin"]
    letter = next((letter for letter, name in BUILD_TYPES.items() if name == types[-1]), "?")
    exported = {element.tag for element in manifest.exports}
    flags = letter + "i" * interfaces + "m" * ("metapackage" in exported) + "D" * ("deprecated" in exported)
    sorted_names = {kind: tuple(sorted(names)) for kind, names in depends.items()}
    return Released(manifest.name, manifest.version, flags, manifest.name, sorted_names)


def holds(condition: str, known_variables: Mapping[str, str]) -> bool:
    """Return whether a condition (REP 149) is true if unknown variables are empty. Return True for an invalid condition."""
    if not condition:
        return True
    try:
        empty = dict.fromkeys(variables(parse(condition)), "")
    except ConditionError:
        return True
    return truth(condition, {**empty, **known_variables}) is not False
