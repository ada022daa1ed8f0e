"""
## What it finds

Keywords of `rclcpp_components_register_node()` among the arguments of `rclcpp_components_register_nodes()`:

    rclcpp_components_register_nodes(library PLUGIN "robot::Talker" EXECUTABLE talker)

## Why it matters

This command takes only class names. `PLUGIN`, `EXECUTABLE` and `talker` become components that cannot be loaded, and no
executable is built.

## How to fix it

Remove the keywords and their values, as the fix does, or call `rclcpp_components_register_node()`. There, the value of
`EXECUTABLE` must not be the name of the library.

## Limitations

Packages whose components cannot be fully analysed are not reported.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ros_lint.api import Call, Facet, Finding, Fix, Package, Rule, Severity, Workspace, edits


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    if package.builds_with != "ament_cmake" or package.hidden(Facet.COMPONENTS):
        return
    for call in package.calls("rclcpp_components_register_nodes"):
        if strays := _strays(call):
            yield _confused(call, strays)


_WORDS = {"PLUGIN": 0, "NO_UNDEFINED_SYMBOLS": 0, "EXECUTABLE": 1, "EXECUTOR": 1}
"""Keywords of rclcpp_components_register_node(), with the number of arguments after each that are not class names."""


def _strays(call: Call) -> list[tuple[int, int]]:
    """Return the first and last index of each keyword with its value, such as ``EXECUTABLE talker``.

    rclcpp_components_register_nodes() has no keywords, so it takes these arguments for class names.
    """
    words = ((at, _WORDS[text]) for at, text in enumerate(call.texts) if at and text in _WORDS)
    return [(at, min(at + more, len(call.args) - 1)) for at, more in words]


def _confused(call: Call, strays: Sequence[tuple[int, int]]) -> Finding:
    words = " and ".join([call.texts[first] for first, _ in strays])
    return Finding(
        f"rclcpp_components_register_nodes() accepts only class names, not {words}; remove {words}, or call "
        "rclcpp_components_register_node()",
        call.span(strays[0][0]),
        call.texts[0],
        fix=Fix(f"remove {words}", tuple([edits.cmake.drop(call, *stray) for stray in strays])),
    )


RULE = Rule(
    name="component-keyword",
    code="ROS422",
    summary="only class names are passed to rclcpp_components_register_nodes()",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
