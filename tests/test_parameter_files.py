"""The nodes for which a YAML file has parameters."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml

from ros_lint.base.text import Text, read
from ros_lint.collectors.resources.parameter_files import collect


def nodes(text: str) -> tuple[str, ...] | None:
    facts = collect(Text("a.yaml", text))
    return None if facts is None else tuple(name for name, _ in facts.nodes)


def expected(document: Any, parents: str = "") -> Iterator[str]:
    """Yield the full node names according to a YAML parser, with those of repeated keys."""
    for key, value in document.value if isinstance(document, yaml.MappingNode) else ():
        if key.value == "ros__parameters":
            yield parents or "/"
        elif parents.count("/") < 5:
            name = str(key.value).strip("/")
            yield from expected(value, f"{parents}/{name}" if name else parents)


SAMPLES = [
    "a:\n  ros__parameters:\n    x: 1\n",
    "/ns:\n  b:\n    ros__parameters: {x: 1}\n  c:\n    # hi\n\n    ros__parameters:\n      y: 1\n",
    "/**:\n  ros__parameters:\n    x: 1\n",
    '"/a/b":\n  "ros__parameters":\n    x: 1\n',
    "a: &anchor\n  ros__parameters: &more\n    x: 1\nb:\n    ros__parameters:\n        <<: *more\n",
    "a:  # comment\n  b:\n    ros__parameters:\n      c: {d: 1}\n",
    "a: {ros__parameters: {x: 1}}\n",
    "/:\n  a:\n    ros__parameters: {x: 1}\n",
    "a: &a\n  ros__parameters: {x: 1}\nb:\n  c: *a\n",
]


@pytest.mark.parametrize("text", SAMPLES)
def test_node_names_equal_those_of_a_yaml_parser(text: str) -> None:
    assert nodes(text) == tuple(expected(yaml.compose(text)))


@pytest.mark.parametrize(
    "text",
    [
        "ros__parameters:\n  x: 1\n",
        "**:\n  ros__parameters:\n    x: 1\n",
        "${name}_driver:\n  ros__parameters: {x: 1}\n",
        "{{ name }}:\n  ros__parameters: {x: 1}\n",
        "- ros__parameters: {x: 1}\n",
        "a:\n  ros__parameters: {x: [1}\n",
    ],
)
def test_parameters_without_a_plain_name_may_be_for_any_node(text: str) -> None:
    assert nodes(text) == ("/**",)


def test_a_file_without_parameters_has_no_nodes() -> None:
    assert nodes("x: 1\ny:\n  z: 2\n") == ()
    assert nodes("# a:\n#   ros__parameters:\nx: 1\n") == ()
    assert nodes("- a\n- b\n") is None
    assert nodes("") is None


def test_a_namespace_with_many_nodes_takes_linear_time() -> None:
    text = "ns:\n" + "".join(f"  n{number}:\n    ros__parameters:\n" for number in range(12_000))
    assert nodes(text) == tuple(f"/ns/n{number}" for number in range(12_000))


def test_spans_of_elements_and_names() -> None:
    facts = collect(Text("a.yaml", "---\n# c\nns:\n  node:\n    ros__parameters:\n      x: 1\n"))
    assert facts is not None
    assert [(str(span), name) for name, span in facts.nodes] == [("a.yaml:4:3", "/ns/node")]
    assert str(facts.first) == "a.yaml:3:1"


@pytest.mark.skipif("ROS_LINT_CORPUS" not in os.environ, reason="ROS_LINT_CORPUS is not set")
def test_node_names_in_real_files_equal_those_of_a_yaml_parser() -> None:
    for path in sorted(Path(os.environ["ROS_LINT_CORPUS"]).rglob("*.yaml")):
        data = path.read_bytes() if path.is_file() else b""
        if b"ros__parameters" not in data:
            continue
        try:
            document = yaml.compose(data, Loader=yaml.CSafeLoader)
        except yaml.YAMLError:
            continue
        facts = collect(read(str(path), data))
        assert facts is not None, path
        names = {name for name, _ in facts.nodes}
        assert "/**" in names or names == set(expected(document)), path
