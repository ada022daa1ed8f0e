"""``ros-lint why A B --explain-silence``: why the dependency rules report nothing about A and B."""

from __future__ import annotations

from collections.abc import Mapping

from ros_lint.analysis.dependencies.explain import RULES, explain
from ros_lint.analysis.finding import Confidence
from ros_lint.engine import registry
from ros_lint.workspace.model import Package, Workspace


def run(workspace: Workspace, name: str, dependency: str) -> tuple[str, str, int]:
    """Return standard output, standard error and the exit code: 0, or 2 if the workspace has no package ``name``.

    ``dependency`` is a package or a rosdep key.
    """
    packages = workspace.called(name)
    if not packages:
        return "", f"ros-lint: the workspace has no package '{name}'\n", 2
    lines: list[str] = []
    for package in packages:
        lines += explain(package, workspace, dependency, _reported(package, workspace, dependency))
    return "".join(f"{line}\n" for line in lines), "", 0


def _reported(package: Package, workspace: Workspace, name: str) -> Mapping[str, Confidence]:
    """Return the names of the rules that report a dependency in a package, with the highest confidence of each."""
    result: dict[str, Confidence] = {}
    for rule in registry.load():
        if rule.name in RULES and rule.package is not None:
            confidences = [finding.confidence for finding in rule.package(package, workspace) if finding.subject == name]
            result.update({rule.name: max(confidences)} if confidences else {})
    return result
