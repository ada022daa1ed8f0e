"""``ros-lint why A B --explain-silence``: why the rules about dependencies say nothing of A and B."""

from __future__ import annotations

from ros_lint.silence import explain
from ros_lint.workspace import Workspace


def run(workspace: Workspace, name: str, other: str) -> tuple[str, str, int]:
    """Return what goes to standard output and to standard error, and the exit code: 2 when there is no such package."""
    packages = workspace.by_name.get(name, ())
    if not packages:
        return "", f"ros-lint: no package of the workspace is called {name}\n", 2
    lines = [line for package in packages for line in explain(package, workspace, other)]
    return "".join(f"{line}\n" for line in lines), "", 0
