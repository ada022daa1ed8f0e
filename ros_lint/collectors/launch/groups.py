"""Creation of groups of launch actions, as ``GroupAction.get_sub_entities()`` of launch expands them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros_lint.facts.launch import UNSCOPED, LaunchAction, LaunchCondition, LaunchValue

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ros_lint.base.text import Span


def group(
    span: Span,
    children: Iterable[LaunchAction],
    configurations: tuple[tuple[str, LaunchValue], ...],
    conditions: tuple[LaunchCondition, ...],
    *,
    scoped: bool,
    forwarding: bool,
) -> LaunchAction:
    """Return a group of launch actions that sets the launch configurations ``configurations`` at its start.

    ``scoped`` and ``forwarding`` are options of GroupAction. A scoped group without ``forwarding`` starts without the launch
    configurations of the surrounding actions.
    """
    if scoped and not forwarding:
        resets = (LaunchAction("reset_environment", span), LaunchAction("reset", span, arguments=configurations))
        return LaunchAction("group", span, conditions=conditions, children=(*resets, *children))
    name = None if scoped else LaunchValue((UNSCOPED,), span)
    return LaunchAction("group", span, name=name, arguments=configurations, conditions=conditions, children=tuple(children))
