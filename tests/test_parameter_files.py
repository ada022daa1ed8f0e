"""Which nodes a YAML file has parameters for."""

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
    found = collect(Text("a.yaml", text))
    return None if found is None else tuple(name for name, _ in found.nodes)


def expected(document: Any, above: str = "") -> Iterator[str]:
    """Yield the full names of the nodes as a real parser of YAML sees them, those of keys that stand twice, too."""
    for key, value in document.value if isinstance(document, yaml.MappingNode) else ():
        if key.value == "ros__parameters":
            yield above or "/"
        elif above.count("/") < 5:
            yield from expected(value, f"{above}/{str(key.value).strip('/')}")


SAMPLES = [
    "a:\n  ros__parameters:\n    x: 1\n",
    "/ns:\n  b:\n    ros__parameters: {x: 1}\n  c:\n    # hi\n\n    ros__parameters:\n      y: 1\n",
    "/**:\n  ros__parameters:\n    x: 1\n",
    '"/a/b":\n  "ros__parameters":\n    x: 1\n',
    "a: &anchor\n  ros__parameters: &more\n    x: 1\nb:\n    ros__parameters:\n        <<: *more\n",
    "a:  # comment\n  b:\n    ros__parameters:\n      c: {d: 1}\n",
]


@pytest.mark.parametrize("text", SAMPLES)
def test_names_of_nodes(text: str) -> None:
    assert nodes(text) == tuple(expected(yaml.compose(text)))


@pytest.mark.parametrize(
    "text", ["a: {ros__parameters: {x: 1}}\n", "ros__parameters:\n  x: 1\n", "**:\n  ros__parameters:\n    x: 1\n"]
)
def test_what_is_written_in_another_way_may_be_for_any_node(text: str) -> None:
    assert nodes(text) == ("/**",)


def test_a_file_of_another_kind_has_none() -> None:
    assert nodes("x: 1\ny:\n  z: 2\n") == ()
    assert nodes("# a:\n#   ros__parameters:\nx: 1\n") == ()
    assert nodes("- a\n- b\n") is None
    assert nodes("") is None


def test_a_namespace_may_have_very_many_nodes() -> None:
    text = "ns:\n" + "".join(f"  n{number}:\n    ros__parameters:\n" for number in range(30_000))
    assert nodes(text) == tuple(f"/ns/n{number}" for number in range(30_000))


def test_places() -> None:
    found = collect(Text("a.yaml", "---\n# c\nns:\n  node:\n    ros__parameters:\n      x: 1\n"))
    assert found is not None
    assert [(str(span), name) for name, span in found.nodes] == [("a.yaml:4:3", "/ns/node")]
    assert str(found.first) == "a.yaml:3:1"


@pytest.mark.skipif("ROS_LINT_CORPUS" not in os.environ, reason="ROS_LINT_CORPUS is not set")
def test_names_of_nodes_in_real_files() -> None:
    for path in sorted(Path(os.environ["ROS_LINT_CORPUS"]).rglob("*.yaml")):
        data = path.read_bytes() if path.is_file() else b""
        if b"ros__parameters" not in data:
            continue
        try:
            document = yaml.compose(data, Loader=yaml.CSafeLoader)
        except yaml.YAMLError:
            continue
        found = collect(read(str(path), data))
        assert found is not None, path
        said = {name for name, _ in found.nodes}
        assert "/**" in said or said == set(expected(document)), path
