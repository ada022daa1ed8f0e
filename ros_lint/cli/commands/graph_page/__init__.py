"""``ros-lint graph --format html``: the dependency graph as one page that needs no other file and no network."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ros_lint.analysis.graph.cycles import cycles
from ros_lint.base.html_page import fill, resource
from ros_lint.base.json_text import for_html
from ros_lint.cli.commands.graph_part import edges_in_cycles, implied_edges, is_test_only

if TYPE_CHECKING:
    from ros_lint.analysis.graph.dependency_graph import Graph


def render(graph: Graph, title: str) -> str:
    """Return the HTML page of a graph. ``title`` is the name of the workspace."""
    import html  # noqa: PLC0415

    return fill(
        resource(__name__, "page.html"),
        {
            "TITLE": html.escape(title),
            "STYLE": resource(__name__, "page.css"),
            "SCRIPT": resource(__name__, "page.js"),
            "DATA": for_html(_data(graph)),
        },
    )


def _data(graph: Graph) -> dict[str, Any]:
    implied, in_cycles = implied_edges(graph), edges_in_cycles(graph)
    return {
        "nodes": [
            {"name": name, "path": places[0].path or "." if places else "", "type": places[0].type if places else ""}
            for name, places in graph.places.items()
        ],
        "edges": [
            {
                "start": edge[0],
                "end": edge[1],
                "test": is_test_only(graph, edge),
                "cycle": edge in in_cycles,
                "implied": edge in implied,
                "reasons": [
                    {
                        "tag": reason.tag,
                        "place": f"{reason.span.path}:{reason.span.line}",
                        "kinds": reason.categories,
                        "certain": reason.certain,
                    }
                    for reason in graph.reasons(edge)
                ],
            }
            for edge in graph.edges
        ],
        "cycles": [cycle.cycle for cycle in cycles(graph)],
    }
