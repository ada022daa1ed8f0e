"""Edits of setup.py that keep its style: elements added to lists that are written out."""

from __future__ import annotations

from ros_lint.facts import BuildScript, Slot
from ros_lint.rule import Edit


def slot(script: BuildScript, option: str) -> Slot | None:
    """Return the list of an option, None when it is not written out or is empty."""
    return next((found for found in script.slots if found.option == option and found.size), None)


def add(place: Slot, element: str) -> Edit:
    """Add an element after the last one: on a line of its own if that has one, and with a comma if that has one."""
    gap = " " if place.indent is None else f"\n{place.indent}"
    return Edit(place.end, f"{gap}{element}," if place.comma else f",{gap}{element}")


def joined(place: Slot, package: str, before: str, after: str = "") -> str:
    """Return an expression for a text with the name of the package in it, by the variable that holds it if there is one."""
    if not place.variable:
        return f"'{before}{package}{after}'"
    return " + ".join(part for part in (f"'{before}'" if before else "", place.variable, f"'{after}'" if after else "") if part)
