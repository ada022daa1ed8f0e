"""``ros-lint graph``: print the dependency graph, for people or for programs.

The JSON has ``schema_version`` 1 and, in the order of names:

- ``packages``: ``name``; ``places``, each with ``path`` (relative, "." for the base) and ``type`` as colcon prints it;
  and with ``--metrics`` also ``metrics`` as in :class:`ros_lint.analysis.graph.metrics.Metrics`, where ``redundant`` lists longer
  paths.
- ``edges``: ``from`` depends on ``to``; ``test_only``; ``certain``, false if it depends on an unknown condition;
  ``reasons``, each with ``tag``, ``categories`` (build, run, test, group), ``path``, ``line`` and ``column``.
- ``cycles``: the ``packages``, a shortest ``cycle``, the ``cut`` as pairs, and ``certain``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from ros_lint.analysis.graph.cycles import cycles
from ros_lint.analysis.graph.dependency_graph import dependency_graph
from ros_lint.cli.commands.graph_view import ViewOptions, view
from ros_lint.cli.commands.output import label, where
from ros_lint.cli.session import UsageError

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from ros_lint.analysis.graph.dependency_graph import Edge, Graph
    from ros_lint.analysis.graph.metrics import Metrics
    from ros_lint.cli.commands.graph_view import GraphView
    from ros_lint.workspace.model import Workspace

Format = Literal["dot", "mermaid", "json", "html"]
FORMATS: tuple[Format, ...] = ("dot", "mermaid", "json", "html")
_EVERYTHING = ViewOptions()

SCHEMA_VERSION = 1


def run(
    workspace: Workspace, form: Format = "dot", options: ViewOptions = _EVERYTHING, *, metrics: bool = False, title: str = ""
) -> tuple[str, str, int]:
    """Return standard output, standard error and the exit code, which is 0.

    With ``metrics``, the JSON contains the metrics and the graph; in the other formats, a table of the metrics replaces
    the graph. ``title`` is the title of the page. Raises UsageError for options that do not go together, and if the focus is not
    a package of the graph.
    """
    graph = dependency_graph(workspace)
    if (metrics or form == "json") and options != _EVERYTHING:
        what = "--metrics" if metrics else "--format json"
        raise UsageError(f"{what} is about the whole graph; leave out --focus, --depth, --external, --edges and --reduce")
    if form == "json":
        return _json(graph, _measure(graph) if metrics else {}), "", 0
    if metrics:
        lines = _table(_measure(graph))
    else:
        drawn = view(workspace, options)
        if form == "html":
            from ros_lint.cli.commands import graph_page  # noqa: PLC0415  (only for this format)

            return graph_page.render(drawn, tuple([cycle.cycle for cycle in cycles(graph)]), title or "the workspace"), "", 0
        lines = _dot(drawn) if form == "dot" else _mermaid(drawn)
    return "".join(f"{line}\n" for line in lines), "", 0


def _measure(graph: Graph) -> Mapping[str, Metrics]:
    from ros_lint.analysis.graph.metrics import measure  # noqa: PLC0415  (only with metrics)

    return measure(graph)


def _dot(drawn: GraphView) -> Iterator[str]:
    yield "digraph workspace {"
    yield "  rankdir=LR;"
    yield "  node [shape=box, fontname=Helvetica];"
    for node in drawn.nodes:
        yield f"  {_quoted(node.name)}{'' if node.path else ' [style=dashed]'};"
    for edge in drawn.edges:
        style = [*(["style=dashed"] if edge.test_only else []), *(["color=red"] if edge.in_cycle else [])]
        attributes = f" [{', '.join(style)}]" if style else ""
        yield f"  {_quoted(edge.start)} -> {_quoted(edge.end)}{attributes};"
    yield "}"


def _quoted(name: str) -> str:
    # DOT cannot escape a backslash, which must not precede a quote, but supports HTML entities.
    text = name.replace("&", "&amp;").replace("\\", "&#92;").replace('"', '\\"')
    return f'"{text}"'


def _mermaid(drawn: GraphView) -> Iterator[str]:
    identifier = {node.name: f"p{number}" for number, node in enumerate(drawn.nodes)}
    yield "flowchart LR"
    for node in drawn.nodes:
        yield f'  {identifier[node.name]}["{label(node.name)}"]'
    red = []
    for number, edge in enumerate(drawn.edges):
        arrow = "-.->" if edge.test_only else "-->"
        yield f"  {identifier[edge.start]} {arrow} {identifier[edge.end]}"
        if edge.in_cycle:
            red.append(str(number))
    if red:
        yield f"  linkStyle {','.join(red)} stroke:red"


def _json(graph: Graph, figures: Mapping[str, Metrics]) -> str:
    import json  # noqa: PLC0415  (only for this format)

    document = {
        "schema_version": SCHEMA_VERSION,
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
    return json.dumps(document, indent=2, ensure_ascii=False) + "\n"


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


def is_test_only(graph: Graph, edge: Edge) -> bool:
    """Return whether an edge is only needed for tests."""
    return all(reason.categories == ("test",) for reason in graph.reasons(edge))
