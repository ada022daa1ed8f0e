"""Launch files in YAML: detection, references and problems."""

import pytest

from ros_lint.collectors.launch import detect as launch
from tests.launch_cases import collect, summaries


@pytest.mark.parametrize(
    ("path", "text", "expected"),
    [
        ("a.launch.yaml", "launch:\n  - node: {pkg: a, exec: b}\n", "yaml"),
        ("a.yaml", "%YAML 1.2\n---\n# x\nlaunch:\n- arg:\n    name: a\n", "yaml"),
        ("a.launch", '"launch":\n  - node:\n', "yaml"),
        ("a.yaml", "launch: true\nother: 1\n", None),
        ("a.yaml", "node:\n  launch: 1\n", None),
        ("a.yaml", "launcher: 1\n", None),
    ],
)
def test_launch_files_are_recognised_by_content(path: str, text: str, expected: str | None) -> None:
    assert launch.is_launch_file(path, text) == expected


def test_references_of_tags() -> None:
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
    assert summaries(*collect("a.launch.yaml", text)) == [
        "file a config/x.yaml",
        "node? a b",
        "file? c d.yaml",
        "node e f",
        "include? g launch/h.launch.py",
        "node rclcpp_components component_container",
        "component i i::J",
        "node l m",
    ]


def test_a_value_in_another_notation_is_not_exact() -> None:
    source, launch_file = collect("a.launch.yaml", 'launch:\n- node:\n    pkg: a\n    exec: "b\\x63"\n')
    (node,) = launch_file.references
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
def test_invalid_yaml_is_a_problem(text: str, line: int) -> None:
    _, launch_file = collect("a.launch.yaml", text)
    assert [problem.span.line for problem in launch_file.problems] == [line]
    assert launch_file.opaque


def doubled(times: int, where: str = "") -> str:
    """Return nested YAML lists, each of which contains the previous one twice."""
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
def test_yaml_that_exceeds_a_limit_is_not_checked(text: str, reason: str, line: int) -> None:
    _, launch_file = collect("a.launch.yaml", text)
    assert [(opaque.reason, opaque.span.line, opaque.unchecked) for opaque in launch_file.opaque] == [(reason, line, True)]
    assert not launch_file.problems


def test_aliases_within_the_limit_are_read() -> None:
    text = "launch:\n- arg: &v0\n    name: a\n- let:\n    name: b\n    value:\n" + doubled(15, "    ")
    _, launch_file = collect("a.launch.yaml", text + "- arg: *v0\n")
    assert not any(opaque.unchecked for opaque in launch_file.opaque)
    assert [action.kind for action in launch_file.actions] == ["argument", "argument"]


def test_an_empty_text_as_children_means_no_children() -> None:
    """launch_yaml iterates over the empty text as over a list (launch 3.7.1)."""
    assert not collect("a.launch.yaml", "launch:\n- timer: {period: '1', children: ''}\n")[1].problems
    assert collect("a.launch.yaml", "launch:\n- timer: {period: '1', children: 'a'}\n")[1].problems
