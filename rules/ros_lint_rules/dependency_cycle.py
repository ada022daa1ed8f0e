"""
## What it finds

Packages that depend on each other, directly or through other packages. Build, run-time, test and group dependencies
(`<group_depend>`) count, and dependencies that `colcon.pkg` and `colcon.meta` add.

There is one finding for each set of packages that all depend on each other. It shows a shortest cycle with the line of every
dependency in it, and which dependencies to remove so that no cycle remains. As few dependencies as possible are named: test
dependencies if possible, else run-time dependencies, else build dependencies.

## Why it matters

No build order exists. `colcon build`, `test`, `list` and `graph` stop for the whole workspace, even for packages outside the
cycle. Test dependencies count as well; the build farm may not notice those, because it builds every package alone.

## How to fix it

Remove one of the dependencies that the finding names. If the dependency is needed, move the shared code to a package of its
own, or move the test that closes the cycle to a package that depends on both packages.

## Limitations

- Cycles through packages outside the workspace are not reported, because those are already built.
- `<doc_depend>`, `<conflict>`, `<replace>` and dependencies with a false condition are ignored, because they do not affect the
  build order.
- The confidence is medium if the cycle depends on a condition with an unknown variable.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ros_lint.api import Confidence, Finding, Related, Rule, Severity, Workspace, graph

_MOST_NAMES = 10


def check(workspace: Workspace) -> Iterator[Finding]:
    package_graph = graph.dependency_graph(workspace)
    for knot in graph.cycles(package_graph):
        edges = tuple(zip(knot.cycle, (*knot.cycle[1:], knot.cycle[0]), strict=True))
        anchor = next(edge for edge in edges if edge in knot.cut)
        here, *rest = package_graph.reasons(anchor)
        around = (*knot.cycle, knot.cycle[0])
        yield Finding(
            f"{'' if knot.certain else 'possible '}dependency cycle {' -> '.join(_quoted(around))}{_others(knot)}; "
            f"colcon cannot build the workspace until {_removal(knot, anchor, here)} removed",
            here.span,
            " -> ".join(around),
            (
                *(
                    Related(f"'{anchor[0]}' also depends on '{anchor[1]}' by {_named(reason)}; remove this, too", reason.span)
                    for reason in rest
                ),
                *(related for edge in edges if edge != anchor for related in _reasons(package_graph, edge, knot)),
                *(related for edge in knot.cut if edge not in edges for related in _reasons(package_graph, edge, knot)),
            ),
            confidence=Confidence.HIGH if knot.certain else Confidence.MEDIUM,
            package=package_graph.places[anchor[0]][0].name,
        )


def _quoted(names: Iterable[str]) -> list[str]:
    return [f"'{name}'" for name in names]


def _others(knot: graph.Cycle) -> str:
    if len(knot.names) == len(knot.cycle):
        return ""
    more = ", ..." if len(knot.names) > _MOST_NAMES else ""
    return f" ({len(knot.names)} packages depend on each other: {', '.join(_quoted(knot.names[:_MOST_NAMES]))}{more})"


def _removal(knot: graph.Cycle, anchor: graph.Edge, reason: graph.Reason) -> str:
    more = len(knot.cut) - 1
    also = f" and {more} more dependenc{'ies' if more > 1 else 'y'} are" if more else " is"
    on = f"on '{anchor[1]}'" if reason.tag != "group_depend" else f"with its member '{anchor[1]}'"
    return f"this {_named(reason)} {on}{also}"


def _reasons(package_graph: graph.Graph, edge: graph.Edge, knot: graph.Cycle) -> Iterator[Related]:
    hint = "; remove this, too" if edge in knot.cut else ""
    for reason in package_graph.reasons(edge):
        yield Related(f"'{edge[0]}' depends on '{edge[1]}' by {_named(reason)}{hint}", reason.span)


def _named(reason: graph.Reason) -> str:
    return f"<{reason.tag}>" if "." not in reason.tag else f"dependency of {reason.tag}"


RULE = Rule(
    name="dependency-cycle",
    code="ROS103",
    summary="packages do not depend on each other cyclically",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    workspace=check,
)
