"""``ros-lint graph``: print the dependency graph of a workspace, as a drawing or as JSON.

The JSON has ``schema_version`` 1 and the following lists, sorted by name:

- ``packages``: ``name``; ``places``, each with ``path`` (relative, "." for the base folder) and ``type``, the build type
  as colcon prints it. A package outside of the workspace has no places. With ``--metrics`` also ``metrics``, as in
  :class:`ros_lint.analysis.graph.metrics.Metrics`; its ``redundant`` lists the indirect paths.
- ``edges``: ``from`` depends on ``to``; ``test_only``; ``certain``, false if the edge depends on an unknown condition;
  ``reasons``, each with ``tag``, ``categories`` (build, run, test, group), ``path``, ``line`` and ``column``.
- ``cycles``: the ``packages``, a shortest ``cycle``, the ``cut`` (edges whose removal breaks the cycle) as pairs, and
  ``certain``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from ros_lint.analysis.graph.cycles import cycles
from ros_lint.cli.commands.graph_part import GraphOptions, edges_in_cycles, is_test_only, part_of_graph
from ros_lint.cli.commands.output import document, label, where

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from ros_lint.analysis.graph.dependency_graph import Graph
    from ros_lint.analysis.graph.metrics import Metrics
    from ros_lint.workspace.model import Workspace

Format = Literal["dot", "mermaid", "json", "html"]
FORMATS: tuple[Format, ...] = ("dot", "mermaid", "json", "html")
_WHOLE_GRAPH = GraphOptions()


def run(
    workspace: Workspace, form: Format = "dot", options: GraphOptions = _WHOLE_GRAPH, *, metrics: bool = False, title: str = ""
) -> tuple[str, str, int]:
    """Return standard output, standard error and the exit code, which is 0.

    If ``metrics`` is True, the JSON contains the metrics and the graph; in the other formats, a table of the metrics
    replaces the graph. ``title`` is the title of the HTML page. Raises UsageError if the focus is not a package of the
    graph.
    """
    graph = part_of_graph(workspace, options)
    figures = _measure(graph) if metrics else {}
    if form == "json":
        return _json(graph, figures), "", 0
    if form == "html" and not metrics:
        from ros_lint.cli.commands import graph_page  # noqa: PLC0415  (only for this format)

        return graph_page.render(graph, title), "", 0
    lines = _table(figures) if metrics else _dot(graph) if form == "dot" else _mermaid(graph)
    return "".join(f"{line}\n" for line in lines), "", 0


def _measure(graph: Graph) -> Mapping[str, Metrics]:
    from ros_lint.analysis.graph.metrics import measure  # noqa: PLC0415  (only with metrics)

    return measure(graph)


def _dot(graph: Graph) -> Iterator[str]:
    in_cycles = edges_in_cycles(graph)
    yield "digraph workspace {"
    yield "  rankdir=LR;"
    yield "  node [shape=box, fontname=Helvetica];"
    for name, places in graph.places.items():
        yield f"  {_quoted(name)}{'' if places else ' [style=dashed]'};"
    for edge in graph.edges:
        style = [*(["style=dashed"] if is_test_only(graph, edge) else []), *(["color=red"] if edge in in_cycles else [])]
        attributes = f" [{', '.join(style)}]" if style else ""
        yield f"  {_quoted(edge[0])} -> {_quoted(edge[1])}{attributes};"
    yield "}"


def _quoted(name: str) -> str:
    # DOT cannot escape a backslash, which must not precede a quote, but supports HTML entities.
    text = name.replace("&", "&amp;").replace("\\", "&#92;").replace('"', '\\"')
    return f'"{text}"'


def _mermaid(graph: Graph) -> Iterator[str]:
    in_cycles = edges_in_cycles(graph)
    identifier = {name: f"p{number}" for number, name in enumerate(graph.names)}
    yield "flowchart LR"
    for name in graph.names:
        yield f'  {identifier[name]}["{label(name)}"]'
    red = []
    for number, edge in enumerate(graph.edges):
        arrow = "-.->" if is_test_only(graph, edge) else "-->"
        yield f"  {identifier[edge[0]]} {arrow} {identifier[edge[1]]}"
        if edge in in_cycles:
            red.append(str(number))
    if red:
        yield f"  linkStyle {','.join(red)} stroke:red"


def _json(graph: Graph, figures: Mapping[str, Metrics]) -> str:
    content = {
        "packages": [
            {
                "name": name,
                "places": [{"path": package.path or ".", "type": package.type} for package in places],
                **({"metrics": figures[name]._asdict()} if figures else {}),
            }
            for name, places in graph.places.items()
        ],
        "edges": [
            {
                "from": edge[0],
                "to": edge[1],
                "test_only": is_test_only(graph, edge),
                "certain": edge[1] in graph.certain_arcs[edge[0]],
                "reasons": [
                    {"tag": reason.tag, "categories": reason.categories, **where(reason.span)} for reason in graph.reasons(edge)
                ],
            }
            for edge in graph.edges
        ],
        "cycles": [
            {"packages": cycle.names, "cycle": cycle.cycle, "cut": cycle.cut, "certain": cycle.certain} for cycle in cycles(graph)
        ],
    }
    return document(content)


def _table(figures: Mapping[str, Metrics]) -> Iterator[str]:
    rows: list[tuple[str, ...]] = [("package", "needed by", "needs", "depth", "reach", "redundant")]
    for name, metrics in figures.items():
        numbers = (metrics.needed_by, metrics.needs, metrics.depth, metrics.reach, len(metrics.redundant))
        rows.append((name, *map(str, numbers)))
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    for name, *cells in rows:
        yield "  ".join((name.ljust(widths[0]), *(cell.rjust(width) for cell, width in zip(cells, widths[1:], strict=True))))
    redundant_paths = [path for metrics in figures.values() for path in metrics.redundant]
    if redundant_paths:
        yield ""
        yield "Redundant edges, because another path implies the same build order:"
        yield from (f"  {path[0]} -> {path[-1]}: {' -> '.join(path)}" for path in redundant_paths)
