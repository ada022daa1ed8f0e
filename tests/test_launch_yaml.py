"""Launch files in YAML: which they are, and what they refer to."""

import pytest

from ros_lint.collectors.launch import detect as launch
from tests.launch_cases import collect, said


@pytest.mark.parametrize(
    ("path", "text", "wanted"),
    [
        ("a.launch.yaml", "launch:\n  - node: {pkg: a, exec: b}\n", "yaml"),
        ("a.yaml", "%YAML 1.2\n---\n# x\nlaunch:\n- arg:\n    name: a\n", "yaml"),
        ("a.launch", '"launch":\n  - node:\n', "yaml"),
        ("a.yaml", "launch: true\nother: 1\n", None),
        ("a.yaml", "node:\n  launch: 1\n", None),
        ("a.yaml", "launcher: 1\n", None),
    ],
)
def test_recognised_by_content(path: str, text: str, wanted: str | None) -> None:
    assert launch.is_launch_file(path, text) == wanted


def test_references() -> None:
    text = """\
launch:
  - arg: {name: x, default: "$(find-pkg-share a)/config/x.yaml"}
  - node:
      pkg: a
      exec: 'b'
      if: $(var x)
      param:
        - from: $(find-pkg-share c)/d.yaml
  - group:
      - push_ros_namespace: {namespace: n}
      - node: {pkg: e, exec: "f"}
  - group:
      unless: $(var x)
      children:
        - include:
            file: "$(find-pkg-share g)/launch/h.launch.py"
  - node_container:
      pkg: rclcpp_components
      exec: component_container
      name: n
      namespace: ''
      composable_node:
        - pkg: i
          plugin: i::J
          name: k
  - executable: {cmd: ros2 run l m}
"""
    assert said(*collect("a.launch.yaml", text)) == [
        "file a config/x.yaml",
        "node? a b",
        "file? c d.yaml",
        "node e f",
        "include? g launch/h.launch.py",
        "node rclcpp_components component_container",
        "component i i::J",
        "node l m",
    ]


def test_a_value_that_is_written_otherwise_is_not_replaced() -> None:
    source, found = collect("a.launch.yaml", 'launch:\n- node:\n    pkg: a\n    exec: "b\\x63"\n')
    (node,) = found.references
    assert (node.name, node.exact, source.slice(node.span)) == ("bc", False, '"b\\x63"')


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("launch:\n- node: [\n", 3),
        ("launch:\n\t- a\n", 2),
        ("launch:\n- *x\n", 2),
        ("launch: &a [*a]\n---\nlaunch:\n", 2),
        ("launch:\n- log:\n    message: a\tb\n", 3),
        ("launch:\n- log: {message: a?}\n", 2),
    ],
)
def test_what_is_no_yaml(text: str, line: int) -> None:
    _, found = collect("a.launch.yaml", text)
    assert [problem.span.line for problem in found.problems] == [line]
    assert found.opaque


def doubled(times: int, where: str = "") -> str:
    """Return lists in each of which the one before stands twice."""
    return "".join(f"{where}- &v{n} [*v{n - 1}, *v{n - 1}]\n" for n in range(1, times))


BOMB = "launch:\n- group: &x0\n  - node: {pkg: a, exec: b}\n" + "".join(
    f"- group: &x{number}\n" + f"  - group: *x{number - 1}\n" * 9 for number in range(1, 30)
)


@pytest.mark.parametrize(
    ("text", "reason", "line"),
    [
        (BOMB, "aliases repeat more than 200,000 values", 44),
        ("launch: &a\n- group: *a\n- group: *a\n", "a value contains itself through an alias", 1),
        ("launch:\n- let:\n    name: a\n    value: &v [*v]\n", "a value contains itself through an alias", 4),
        ("launch:\n- &v0 [a, b]\n" + doubled(30), "aliases repeat more than 200,000 values", 18),
        ("launch:\n- " + "[" * 3_000, "nested more than 100 levels deep", 2),
        ("launch:\n- " + "- " * 3_000, "nested more than 100 levels deep", 2),
        ("launch:\n- " + "? " * 3_000, "nested more than 100 levels deep", 2),
        ("launch:\n" + "".join(" " * n + "a:\n" for n in range(1, 200)), "nested more than 100 levels deep", 101),
        ("launch:\n- " + '["]", ' * 101 + "]" * 101, "nested more than 100 levels deep", 2),
    ],
)
def test_what_exceeds_a_bound_is_not_checked(text: str, reason: str, line: int) -> None:
    _, found = collect("a.launch.yaml", text)
    assert [(opaque.reason, opaque.span.line, opaque.unchecked) for opaque in found.opaque] == [(reason, line, True)]
    assert not found.problems


def test_aliases_within_the_bound() -> None:
    text = "launch:\n- arg: &v0\n    name: a\n- let:\n    name: b\n    value:\n" + doubled(15, "    ")
    _, found = collect("a.launch.yaml", text + "- arg: *v0\n")
    assert not any(opaque.unchecked for opaque in found.opaque)
    assert [action.kind for action in found.actions] == ["argument", "argument"]


def test_children_that_are_an_empty_text_are_none() -> None:
    """As launch_yaml takes them, which goes through them as through a list (launch 3.7.1)."""
    assert not collect("a.launch.yaml", "launch:\n- timer: {period: '1', children: ''}\n")[1].problems
    assert collect("a.launch.yaml", "launch:\n- timer: {period: '1', children: 'a'}\n")[1].problems
