"""
## What it finds

Packages that need each other, directly or through others: by dependencies for building, running or testing, by groups,
or by what `colcon.pkg` and `colcon.meta` add. One finding for each knot of such packages. It tells a shortest cycle,
the line of every edge of the cycle, and the edges to do without so that no cycle is left: the fewest, and of these
rather test dependencies than those of run time, and rather those than what is compiled against.

## Why it matters

There is no order in which the packages could be built. `colcon build`, `test`, `list` and `graph` refuse the whole
workspace, also for packages that have nothing to do with the cycle. Test dependencies count, which the build farm, where
every package is built alone, may not notice.

## How to fix it

Remove one of the edges that the finding names. Where it is really needed, move what both sides share into a package of
its own, or the test that closes the cycle into a package that depends on both.

## Limitations

- Cycles through packages outside the workspace: those are built already.
- `<doc_depend>`, `<conflict>` and `<replace>` order nothing, nor does a dependency whose condition is false.
- Where a condition with an unknown variable decides, the confidence is medium.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Confidence, Edge, Finding, Graph, Knot, Reason, Related, Rule, Severity, Workspace, knots

_MOST_NAMES = 10


def check(workspace: Workspace) -> Iterator[Finding]:
    graph = workspace.graph
    for knot in knots(graph):
        edges = tuple(zip(knot.cycle, (*knot.cycle[1:], knot.cycle[0]), strict=True))
        anchor = next(edge for edge in edges if edge in knot.cut)
        here, *rest = graph.reasons(anchor)
        way = " -> ".join((*knot.cycle, knot.cycle[0]))
        yield Finding(
            f"packages {'need' if knot.certain else 'may need'} each other: {way}{_others(knot)}; "
            f"colcon refuses the workspace until {_way_out(knot, anchor, here)} gone",
            here.span,
            way,
            (
                *(Related(f"this {_named(reason)} has to go, too", reason.span) for reason in rest),
                *(related for edge in edges if edge != anchor for related in _needs(graph, edge, knot)),
                *(related for edge in knot.cut if edge not in edges for related in _needs(graph, edge, knot)),
            ),
            confidence=Confidence.HIGH if knot.certain else Confidence.MEDIUM,
            package=graph.places[anchor[0]][0].name,
        )


def _others(knot: Knot) -> str:
    if len(knot.names) == len(knot.cycle):
        return ""
    more = ", ..." if len(knot.names) > _MOST_NAMES else ""
    return f" (a knot of {len(knot.names)}: {', '.join(knot.names[:_MOST_NAMES])}{more})"


def _way_out(knot: Knot, anchor: Edge, reason: Reason) -> str:
    more = len(knot.cut) - 1
    also = f" and {more} more edge{'s' if more > 1 else ''} are" if more else " is"
    on = f"on {anchor[1]}" if reason.tag != "group_depend" else f"with its member {anchor[1]}"
    return f"this {_named(reason)} {on}{also}"


def _needs(graph: Graph, edge: Edge, knot: Knot) -> Iterator[Related]:
    out = ": removing this breaks the cycle" if edge in knot.cut else ""
    for reason in graph.reasons(edge):
        yield Related(f"{edge[0]} needs {edge[1]} by {_named(reason)}{out}", reason.span)


def _named(reason: Reason) -> str:
    return f"<{reason.tag}>" if "." not in reason.tag else f"dependency of {reason.tag}"


RULE = Rule(
    name="dependency-cycle",
    code="ROS103",
    summary="packages must not need each other",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    workspace=check,
)
