"""``ros-lint graph --format html``: the dependency graph as one page that needs no other file and no network."""

from __future__ import annotations

from importlib import resources
from typing import TYPE_CHECKING

from ros_lint.base.json_text import for_html

if TYPE_CHECKING:
    from ros_lint.cli.commands.graph_view import GraphView


def render(view: GraphView, cycles: tuple[tuple[str, ...], ...], title: str) -> str:
    """Return the page. ``cycles`` are shortest cycles to list, ``title`` is the name of the workspace."""
    import html  # noqa: PLC0415

    folder = resources.files(__name__)
    page, style, script = ((folder / name).read_text("utf-8") for name in ("page.html", "page.css", "page.js"))
    data = {
        "title": title,
        "nodes": [node._asdict() for node in view.nodes],
        "edges": [
            {
                "start": edge.start,
                "end": edge.end,
                "test": edge.test_only,
                "cycle": edge.in_cycle,
                "implied": edge.implied,
                "reasons": [
                    {
                        "tag": reason.tag,
                        "place": f"{reason.span.path}:{reason.span.line}",
                        "kinds": reason.categories,
                        "certain": reason.certain,
                    }
                    for reason in edge.reasons
                ],
            }
            for edge in view.edges
        ],
        "cycles": cycles,
    }
    parts = {"TITLE": html.escape(title), "STYLE": style, "SCRIPT": script, "DATA": for_html(data)}
    for name, text in parts.items():
        page = page.replace(f"<!--{name}-->", text)
    return page
