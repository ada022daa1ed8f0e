"""The nodes for which a YAML file has parameters, as rcl_yaml_param_parser reads the file."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from ros_lint.collectors.resources.parameter_values import read_values
from ros_lint.facts.sources import ANY_NODE, PARAMETERS_KEY, ParameterFile

if TYPE_CHECKING:
    from ros_lint.base.text import Text

_FIRST = re.compile(
    r"""^[ ]*["']?
    ([^\s"'\#:{}\[\],&!|>%@`-](?:[^"'\#:{}\[\]\n]*[^"'\#:{}\[\] \t\n])?(?:[ \t]*(?=["']))?)
    ["']?[ \t]*:(?=\s)""",
    re.VERBOSE | re.MULTILINE,
)


def collect(source: Text) -> ParameterFile | None:
    """Return the node names and parameters in a parameter file, with their places; None if the file has no keys."""
    text = source.text
    first = _FIRST.search(text)
    marks = text.count(PARAMETERS_KEY) - sum(
        PARAMETERS_KEY in line.partition("#")[2] for line in text.splitlines() if "#" in line
    )
    if not marks:
        return None if first is None else ParameterFile(source.path, (), source.span(*first.span(1)))
    nodes, parameters, refusals = read_values(source)
    if len(nodes) < marks:  # for example in a template, whose keys are no names
        nodes = (*nodes, (ANY_NODE, source.span(0, 0)))
    place = nodes[0][1] if first is None else source.span(*first.span(1))
    file = ParameterFile(source.path, nodes, place, parameters=parameters, refusals=refusals)
    if "$(var" not in text:
        return file
    from ros_lint.collectors.launch.markup.collect import configurations_read  # noqa: PLC0415  (few parameter files have substitutions)

    return file._replace(configurations_read=configurations_read(text))
