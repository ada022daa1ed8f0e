"""Pages in HTML that need no other file: a template with places for its parts."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import resources


def resource(package: str, name: str) -> str:
    """Return the text of a file in the folder of a Python package."""
    return (resources.files(package) / name).read_text("utf-8")


def fill(template: str, parts: Mapping[str, str]) -> str:
    """Return a template in which each place, such as ``<!--TITLE-->``, is replaced by the part of this name.

    Parts are not searched for places. Raises KeyError for a place without a part.
    """
    head, *pieces = template.split("<!--")
    named = [piece.partition("-->") for piece in pieces]
    return head + "".join(f"{parts[name]}{rest}" for name, _, rest in named)
