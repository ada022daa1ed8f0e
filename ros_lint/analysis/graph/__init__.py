"""The dependency graph of a workspace: order, cycles and metrics."""
