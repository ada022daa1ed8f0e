"""Reading of a launch file in any of the languages Python, XML and YAML."""

from __future__ import annotations

from ros_lint.base.text import Text
from ros_lint.collectors.launch.detect import Language
from ros_lint.facts.launch import LaunchFile


def collect(source: Text, language: Language) -> LaunchFile:
    """Return the facts of a launch file. Errors in the file raise no exception, but are in ``problems`` of the result."""
    facts = _collect(source, language)
    return facts._replace(substitutes_parameters=True) if "allow_substs" in source.text else facts


def _collect(source: Text, language: Language) -> LaunchFile:
    if language == "python":
        from ros_lint.collectors.launch.python import collect as launch_py  # noqa: PLC0415  (most workspaces have files of one language)

        return launch_py.collect(source)
    if language == "xml":
        from ros_lint.collectors.launch.markup import xml as launch_xml  # noqa: PLC0415

        return launch_xml.collect(source)
    from ros_lint.collectors.launch.markup import yaml as launch_yaml  # noqa: PLC0415

    return launch_yaml.collect(source)
