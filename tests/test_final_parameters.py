"""The parameters with which nodes start: reading parameter files as rcl does, and overriding in order."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence

import pytest

from ros_lint.base.text import Text
from ros_lint.collectors.launch.final_parameters import (
    FilledChange,
    FinalParameters,
    GivenParameter,
    NodeNames,
    final_parameters,
    matches,
    of_command_line,
)
from ros_lint.collectors.resources.parameter_files import collect
from ros_lint.collectors.resources.parameter_values import type_of
from ros_lint.collectors.symbolic_text import UNKNOWN
from ros_lint.facts.sources import ParameterFile
from tests.packages import manifest_text
from tests.test_launch_command import ask, xml


def file(text: str) -> ParameterFile:
    facts = collect(Text("a.yaml", text))
    assert facts is not None
    return facts


def final(
    files: Mapping[str, str], given: Sequence[GivenParameter], node: NodeNames, *, component: bool = False, **more: str
) -> FinalParameters:
    read = {path: file(text) for path, text in files.items()}
    return final_parameters(node, given, read.get, lambda text: (more.get(text, text),), component=component)


def values(result: FinalParameters) -> dict[str, str]:
    """Return each parameter with its values; "?" marks one that is perhaps not set."""
    return {p.name: " | ".join(p.texts) + ("" if p.certain else " ?") for p in result.parameters}


def of_file(*paths: str) -> list[GivenParameter]:
    return [GivenParameter("", (path,)) for path in paths]


NODE = NodeNames(("driver",), ("/robot",))


# The types and errors of rcl_yaml_param_parser, as test_parse_yaml.cpp of that package expects them.
@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("true", "bool"),
        ("Y", "bool"),
        ("oFF", "string"),
        ("010", "integer"),
        ("0x1F", "integer"),
        ("09", "double"),
        ("-5", "integer"),
        ("9223372036854775808", "double"),
        ("1.", "double"),
        (".5", "double"),
        ("1e3", "double"),
        ("1_000", "string"),
        (".nan", "double"),
        (".NaN", "double"),
        (".Nan", "string"),
        (".nananan", "string"),
        ("-.INF", "double"),
        (".INf", "string"),
        (".infinity", "string"),
        ("infinity", "double"),
        ("1.2.3", "string"),
        ("", "string"),
    ],
)
def test_types_of_plain_values(text: str, expected: str) -> None:
    assert type_of(text) == expected
    assert type_of(text, quoted=True) == "string"


@pytest.mark.parametrize(
    ("text", "kinds"),
    [
        ("a:\n  ros__parameters:\n    x: 1\n    y: {z: [1.0, 2.0], e: ''}\n", ()),
        ("a:\n  ros__parameters: {}\n", ()),
        ("a:\n  ros__parameters:\nb: 1\n", ("no-value", "value-outside")),
        ("ros__parameters:\n  x: 1\n", ("no-value",)),
        ("a:\n  ros__parameters:\n    x:\n", ("no-value",)),
        ("a:\n  ros__parameters:\n    x: [1, 2.0]\n", ("mixed-list",)),
        ("a:\n  ros__parameters:\n    x: [a, '1']\n", ()),
        ("ns:\n  a:\n    ros__parameters: {x: 1}\n  b:\n", ("value-outside",)),
        ("a: &a\n  ros__parameters: &p {x: 1}\nb:\n  ros__parameters: *p\n", ("alias",)),
        ("a:\n  ros__parameters:\n    x: &x 1\n    y: *x\n    z: [*x, *x]\n", ("alias", "alias", "alias")),
        ("a//b:\n  ros__parameters: {x: 1}\n", ("bad-name",)),
        ("/a:\n  /b:\n    ros__parameters: {x: 1}\n", ("bad-name",)),
        ("/a/:\n  b:\n    ros__parameters: {x: 1}\n", ()),
        ("/foo**:\n  ros__parameters: {x: 1}\n", ("bad-name",)),
        ("/**/n*ode:\n  ros__parameters: {x: 1}\n", ("bad-name",)),
        ("/**/*/node:\n  ros__parameters: {x: 1}\n", ()),
        ("a:\n  ros__parameters: {x: [1}\n", ("syntax",)),
        ("$(var ns)/b:\n  ros__parameters: {x: 1}\n", ()),
    ],
)
def test_refusals_of_rcl(text: str, kinds: tuple[str, ...]) -> None:
    assert tuple(problem.kind for problem in file(text).refusals) == kinds


def test_parameters_have_names_texts_types_and_places() -> None:
    facts = file("ns:\n  a:\n    ros__parameters:\n      x: 1\n      y:\n        z: ['1', b]\n")
    assert [(p.node, p.name, p.text, p.type, f"{p.span.line}:{p.span.column}") for p in facts.parameters] == [
        ("ns/a", "x", "1", "integer", "4:7"),
        ("ns/a", "y.z", "[1, b]", "string_array", "6:9"),
    ]


def test_aliases_are_replaced_by_their_values() -> None:
    facts = file(
        "a:\n  ros__parameters: &p {x: 1, y: [2]}\nb:\n  ros__parameters:\n    <<: *p\n    x: 3\nc:\n  ros__parameters: *p\n"
    )
    assert [(p.node, p.name, p.text) for p in facts.parameters] == [
        ("a", "x", "1"),
        ("a", "y", "[2]"),
        ("b", "x", "1"),
        ("b", "y", "[2]"),
        ("b", "x", "3"),
        ("c", "x", "1"),
        ("c", "y", "[2]"),
    ]


@pytest.mark.parametrize(
    ("row", "name", "expected"),
    [
        ("/**", "/a", True),
        ("/**", "/b/c/a", True),
        ("**", "/b/a", True),
        ("*", "/a", True),
        ("/*", "/b/a", False),
        ("/*/a", "/b/a", True),
        ("/*/a", "/a", False),
        ("/**/a", "/a", True),
        ("/**/a", "/b/c/a", True),
        ("/**/a", "/b/aa", False),
        ("b/**", "/b/c/a", True),
        ("/b/**/a", "/b/a", True),
        ("a", "/a", True),
        ("a", "/b/a", False),
        ("b/a", "/b/a", True),
    ],
)
def test_rows_match_full_names_as_in_rclcpp(row: str, name: str, expected: bool) -> None:
    assert matches(row, name) is expected


def test_later_files_override_earlier_ones_of_the_same_name() -> None:
    files = {"1": "/**:\n  ros__parameters: {a: 1, b: 1}\n", "2": "/**:\n  ros__parameters: {b: 2, c: 2}\n"}
    assert values(final(files, of_file("1", "2"), NODE)) == {"a": "1", "b": "2", "c": "2"}


def test_names_apply_in_the_order_of_their_first_occurrence() -> None:
    files = {
        "1": "/**:\n  ros__parameters: {a: 1}\nrobot/driver:\n  ros__parameters: {a: 2}\n",
        "2": "/**:\n  ros__parameters: {a: 3}\n",
    }
    assert values(final(files, of_file("1", "2"), NODE)) == {"a": "2"}
    assert values(final(files, of_file("2", "1"), NODE)) == {"a": "2"}
    assert values(final(files, of_file("2"), NODE)) == {"a": "3"}


def test_single_parameters_override_files_unless_they_are_rules_for_any_node() -> None:
    files = {"1": "robot/driver:\n  ros__parameters: {a: 1, b: 1}\n"}
    given = [*of_file("1"), GivenParameter("a", ("2",)), GivenParameter("b", ("2",), is_rule=True)]
    assert values(final(files, given, NODE)) == {"a": "2", "b": "2"}
    assert values(final(files, [given[2], *given[:2]], NODE)) == {"a": "2", "b": "1"}


def test_conditional_parameters_add_alternatives() -> None:
    given = [GivenParameter("a", ("1",)), GivenParameter("a", ("2",), certain=False), GivenParameter("b", ("3",), certain=False)]
    assert values(final({}, given, NODE)) == {"a": "1 | 2", "b": "3 ?"}


def test_a_file_that_is_not_in_sight_may_override_what_precedes_it() -> None:
    given = [GivenParameter("a", ("1",)), *of_file("missing"), GivenParameter("a", ("2",))]
    result = final({}, given, NODE)
    assert values(result) == {"a": "2 ?"}
    assert result.unknown == ("the file missing is not in the workspace",)
    assert values(final({}, given[1:], NODE)) == {"a": "2"}


@pytest.mark.parametrize(
    ("names", "program", "expected"),
    [
        ((), ("x",), {"a": "0", "b": "1 ?"}),
        (("",), ("driver",), {"a": "0", "b": "1 ?"}),
        (("driver", "other"), (), {"a": "0", "b": "1 ?"}),
        (("other",), ("driver",), {"a": "0"}),
    ],
)
def test_an_unknown_name_may_match(names: tuple[str, ...], program: tuple[str, ...], expected: dict[str, str]) -> None:
    files = {"1": "/**:\n  ros__parameters: {a: 0}\ndriver:\n  ros__parameters: {b: 1}\n"}
    assert values(final(files, of_file("1"), NodeNames(names, ("",), program))) == expected


def test_several_sections_do_not_apply_to_a_node_without_a_name() -> None:
    files = {"1": "one:\n  ros__parameters: {a: 0}\ntwo:\n  ros__parameters: {b: 1}\n"}
    result = final(files, of_file("1"), NodeNames((), ("",), ("three",)))
    assert values(result) == {}
    assert result.unknown == ("it is unknown which node name the program sets",)


def test_components_take_the_row_of_any_node_and_their_own_file_by_file() -> None:
    files = {
        "1": "robot:\n  driver:\n    ros__parameters: {a: 1, b: 1}\n/**:\n  ros__parameters: {a: 0, c: 0}\n",
        "2": "/**:\n  ros__parameters: {b: 2}\n/**/driver:\n  ros__parameters: {c: 3}\n",
    }
    assert values(final(files, of_file("1", "2"), NODE, component=True)) == {"a": "1", "b": "2", "c": "0"}


def test_components_get_the_files_of_their_container() -> None:
    shared = file("/**/driver:\n  ros__parameters: {a: 1, b: 1}\n")
    own = file("/**:\n  ros__parameters: {b: 2}\n")
    result = final_parameters(
        NODE, of_file("own"), {"own": own, "shared": shared}.get, lambda text: (text,), of_file("shared"), component=True
    )
    assert values(result) == {"a": "1", "b": "2"}


REWRITTEN = "b:\n  ros__parameters: {x: 1, y: {x: 2, z: 3}}\na:\n  ros__parameters: {x: 4}\n"


@pytest.mark.parametrize(
    ("change", "node", "expected"),
    [
        (FilledChange("rewrite", (("x", ("9",)),)), "/b", {"x": "9", "y.x": "9", "y.z": "3"}),
        (FilledChange("rewrite", (("b.ros__parameters.y.z", ("9",)),)), "/b", {"x": "1", "y.x": "2", "y.z": "9"}),
        (FilledChange("rewrite", (("b.ros__parameters.new", ("9",)),)), "/b", {"new": "9", "x": "1", "y.x": "2", "y.z": "3"}),
        (FilledChange("rewrite", root=("ns",)), "/ns/a", {"x": "4"}),
        (FilledChange("rewrite", root=("ns",)), "/a", {}),
        (FilledChange("rewrite", root=("",)), "/a", {"x": "4"}),
        (FilledChange("rewrite", keys=(("a", ("c",)),)), "/c", {"x": "4"}),
        (FilledChange("rewrite", (("x", ("9",)),), certain=False), "/a", {"x": "4 | 9"}),
        (FilledChange("exchange", (("4", ("9",)), ("2", ("8",)))), "/a", {"x": "9"}),
        (FilledChange("exchange", (("1", ("9",)), ("x", ("8",)))), "/b", {"x": "9", "y.x": "2", "y.z": "3"}),
        (FilledChange("replace", (("a", ("c",)),)), "/c", {"x": "4"}),
        (FilledChange("replace", (("4", ("5", "6")),)), "/a", {"x": "5 | 6"}),
    ],
)
def test_changes_of_files(change: FilledChange, node: str, expected: dict[str, str]) -> None:
    given = [GivenParameter("", ("1",), changes=(change,))]
    assert (
        values(final({"1": REWRITTEN}, given, NodeNames((node[1:].rpartition("/")[2],), (node.rpartition("/")[0],)))) == expected
    )


def test_a_list_with_an_exchanged_value_is_not_known() -> None:
    files = {"1": "/**:\n  ros__parameters: {a: [OLD, x], b: [y], c: OLDER}\n"}
    given = [GivenParameter("", ("1",), changes=(FilledChange("exchange", (("OLD", ("new",)),)),))]
    assert values(final(files, given, NodeNames(("n",), ("",)))) == {"a": UNKNOWN, "b": "[y]", "c": "OLDER"}


def test_substitutions_in_files_are_performed_only_if_allowed() -> None:
    files = {"1": "driver:\n  ros__parameters: {a: $(var x)}\n"}
    node = NodeNames(("driver",), ("",))
    assert values(final(files, of_file("1"), node, **{"$(var x)": "5"})) == {"a": "$(var x)"}
    allowed = [GivenParameter("", ("1",), changes=(FilledChange("substitute"),))]
    assert values(final(files, allowed, node, **{"$(var x)": "5"})) == {"a": "5"}


def test_parameters_of_the_command_line() -> None:
    words = [("--ros-args",), ("-p",), ("a:=1",), ("--params-file",), ("f.yaml",), ("-p driver:b:=2",), ("c:=3",)]
    assert [(given.name, given.texts) for given in of_command_line(words)] == [("a", ("1",)), ("", ("f.yaml",)), ("b", ("2",))]


def test_the_command_takes_the_name_that_the_code_gives_to_the_node() -> None:
    files = {
        "p/package.xml": manifest_text("p"),
        "p/CMakeLists.txt": (
            "project(p)\nfind_package(ament_cmake REQUIRED)\nadd_executable(program a.cpp)\n"
            "install(TARGETS program DESTINATION lib/p)\ninstall(DIRECTORY launch DESTINATION share/p)\nament_package()\n"
        ),
        "p/a.cpp": 'auto node = rclcpp::Node("driver");\n',
        "p/launch/p.yaml": "driver:\n  ros__parameters: {a: 1}\nother:\n  ros__parameters: {b: 2}\n",
        "p/launch/a.launch.xml": xml('<node pkg="p" exec="program"><param from="$(find-pkg-share p)/launch/p.yaml"/></node>'),
    }
    started = json.loads(ask(files, "p", "a.launch.xml", form="json")[0])["starts"]
    assert [(item["final"], item["final_unknown"]) for item in started] == [
        ([{"name": "a", "values": ["1"], "certain": True, "path": "p/launch/p.yaml", "line": 2, "column": 21}], [])
    ]


def test_the_command_takes_the_name_that_a_library_of_the_program_gives_to_the_node() -> None:
    files = {
        "p/package.xml": manifest_text("p"),
        "p/CMakeLists.txt": (
            "project(p)\nfind_package(ament_cmake REQUIRED)\nadd_library(core a.cpp)\nadd_executable(program main.cpp)\n"
            "target_link_libraries(program core)\n"
            "install(TARGETS program DESTINATION lib/p)\ninstall(DIRECTORY launch DESTINATION share/p)\nament_package()\n"
        ),
        "p/a.cpp": 'auto node = rclcpp::Node("driver");\n',
        "p/main.cpp": "int main() {}\n",
        "p/launch/p.yaml": "driver:\n  ros__parameters: {a: 1}\nother:\n  ros__parameters: {b: 2}\n",
        "p/launch/a.launch.xml": xml('<node pkg="p" exec="program"><param from="$(find-pkg-share p)/launch/p.yaml"/></node>'),
    }
    started = json.loads(ask(files, "p", "a.launch.xml", form="json")[0])["starts"]
    assert [(item["final"], item["final_unknown"]) for item in started] == [
        ([{"name": "a", "values": ["1"], "certain": True, "path": "p/launch/p.yaml", "line": 2, "column": 21}], [])
    ]
