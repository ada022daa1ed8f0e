"""Fill templates of HTML pages that need no other file."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import resources


def resource(package: str, name: str) -> str:
    """Return the text of the file ``name`` in the folder of a Python package."""
    return (resources.files(package) / name).read_text("utf-8")


def fill(template: str, parts: Mapping[str, str]) -> str:
    """Return the template with each placeholder ``<!--NAME-->`` replaced by the value of ``NAME`` in ``parts``.

    Placeholders in the values are not replaced. Raises KeyError for a placeholder without a value.
    """
    head, *pieces = template.split("<!--")
    named = [piece.partition("-->") for piece in pieces]
    return head + "".join(f"{parts[name]}{rest}" for name, _, rest in named)
