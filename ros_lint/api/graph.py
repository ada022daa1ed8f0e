"""Functions and types about the dependency graph of a workspace and its cycles."""

from ros_lint.analysis.graph.cycles import Cycle, cycles
from ros_lint.analysis.graph.dependency_graph import Edge, Graph, Reason, dependency_graph
from ros_lint.workspace.side_by_side import workspace_of

__all__ = [
    "Cycle",
    "Edge",
    "Graph",
    "Reason",
    "cycles",
    "dependency_graph",
    "workspace_of",
]
