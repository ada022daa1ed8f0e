"""The dependency graph of a workspace and its cycles."""

from ros_lint.analysis.graph.cycles import Cycle, cycles
from ros_lint.analysis.graph.dependency_graph import Edge, Graph, Reason, dependency_graph

__all__ = [
    "Cycle",
    "Edge",
    "Graph",
    "Reason",
    "cycles",
    "dependency_graph",
]
