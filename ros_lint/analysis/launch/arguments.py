"""Compare the launch arguments that a launch file declares with the launch configurations that launch files read."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from ros_lint.analysis.launch.configurations import include_tree, read_sites, required_configurations
from ros_lint.analysis.launch.includes import include_resolver
from ros_lint.base.suggestions import similar_names
from ros_lint.base.text import Span
from ros_lint.facts.launch import LaunchFile
from ros_lint.workspace.model import Workspace

_DIGITS = re.compile(r"\d+")


class SimilarRead(NamedTuple):
    """A launch configuration that a file reads with a default but does not declare, although it declares a similar argument."""

    span: Span
    """The first place where the configuration is read."""
    declared: str
    """The declared argument with a similar name."""


class ArgumentUse(NamedTuple):
    """The arguments that a launch file declares and the configurations that it reads, where they do not match."""

    declared: Mapping[str, Span]
    """All arguments that the file declares."""
    undeclared: Mapping[str, Span]
    """Configurations that the file reads without a default, although no launch file declares or sets them."""
    similar: Mapping[str, SimilarRead]
    """Undeclared configurations that the file reads with a default, if it declares an argument with a similar name."""
    unused: frozenset[str]
    """Declared arguments that neither the file nor an included or including file reads."""


def argument_use(file: LaunchFile, workspace: Workspace) -> ArgumentUse | None:
    """Return the launch arguments that a launch file declares, and the launch configurations that it reads.

    The result is None if further arguments may be declared or read, because a file of the workspace cannot be read, or
    because the launch file or an included file cannot be fully analysed.
    """
    tree, resolver = include_tree(workspace), include_resolver(workspace)
    own = tree.names(file)
    if workspace.unread() or not own.complete or not resolver.takes(file).complete:
        return None
    above = tree.above(file)
    if above is None:
        return None
    inside = frozenset().union(*(resolver.takes(inner).known for inner in resolver.includes(file)))
    known = {*own.declared, *own.set_or_passed}.union(*([*names.declared, *names.set_or_passed] for names in above))
    unknown = own.read - known - inside
    undeclared = required_configurations(file, unknown) if unknown else {}
    similar = _similar(file, unknown - undeclared.keys() - tree.set_or_passed, own.declared)
    unused = own.declared.keys() - own.read.union(inside, *(names.read for names in above))
    return ArgumentUse(own.declared, undeclared, dict(similar), frozenset(unused))


def _similar(file: LaunchFile, names: frozenset[str], declared: Mapping[str, Span]) -> Iterator[tuple[str, SimilarRead]]:
    """Yield those elements of ``names`` that resemble a declared argument and that the file reads with a default.

    Names with different digits are not similar: ``camera1`` and ``camera2``.
    """
    by_digits: dict[tuple[str, ...], list[str]] = {}
    for argument in declared if names else ():
        by_digits.setdefault(tuple(_DIGITS.findall(argument)), []).append(argument)
    for (name, has_default), span in read_sites(file, names).items() if names else ():
        near = similar_names(name, by_digits.get(tuple(_DIGITS.findall(name)), ()), 1, 0.85)
        if has_default and near:
            yield name, SimilarRead(span, near[0])
