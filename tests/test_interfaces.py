"""Interface definitions: types of other packages, and errors."""

from __future__ import annotations

import pytest

from ros_lint.base.text import Text, read
from ros_lint.collectors.interfaces import collect as interfaces


def collected(path: str, text: str) -> list[tuple[str, str]]:
    source = Text(path, text)
    facts = interfaces.collect(source)
    assert all(mention.via == "interface" and source.slice(mention.span) == mention.what for mention in facts.mentions)
    return [(mention.name, str(mention.span)) for mention in facts.mentions]


def test_fields_mention_interfaces_of_other_packages() -> None:
    text = (
        "# std_msgs/Header in a comment\n"
        "std_msgs/Header header  # geometry_msgs/Pose is none either\n"
        "geometry_msgs/Pose[] poses\r\n"
        "geometry_msgs/Point[<=3] corners\n"
        "Own own\n"
        "float64 x 1.5\n"
        "string<=10 name 'a/b c'\n"
        "string PATH=a/b\n"
        "---\n"
        "\tsensor_msgs/Image[4] image\n"
        "bool ok"
    )
    assert collected("a/srv/X.srv", text) == [
        ("std_msgs/Header", "a/srv/X.srv:2:1"),
        ("geometry_msgs/Pose", "a/srv/X.srv:3:1"),
        ("geometry_msgs/Point", "a/srv/X.srv:4:1"),
        ("sensor_msgs/Image", "a/srv/X.srv:10:2"),
    ]


@pytest.mark.parametrize("name", ["std_msgs/msg/Header", "std_msgs/msg/sub/Header"])
def test_a_type_with_too_many_slashes_mentions_its_package(name: str) -> None:
    assert collected("a/msg/X.msg", f"{name} header\n") == [("std_msgs/Header", "a/msg/X.msg:1:1")]


def test_idl_files_mention_included_and_qualified_types() -> None:
    text = (
        '#include "geometry_msgs/msg/Point.idl"\n'
        "#include <std_msgs/msg/Header.idl>\n"
        '// #include "no/msg/Comment.idl"\n'
        "module own { module msg {\n"
        "  struct X {\n"
        '    @verbatim (language="comment", text="see no_msgs::msg::String" "and more")\n'
        "    geometry_msgs::msg::Point point; /* no_msgs::msg::Block */\n"
        "    sequence<std_msgs::msg::Header, 3> headers;\n"
        "    other::Thing no_interface;\n"
        "  };\n"
        "}; };\n"
    )
    assert collected("own/msg/X.idl", text) == [
        ("geometry_msgs/Point", "own/msg/X.idl:1:11"),
        ("std_msgs/Header", "own/msg/X.idl:2:11"),
        ("geometry_msgs/Point", "own/msg/X.idl:7:5"),
        ("std_msgs/Header", "own/msg/X.idl:8:14"),
    ]


def problems(data: bytes, path: str = "a/msg/X.msg") -> list[tuple[str, str]]:
    interface = interfaces.collect(read(path, data)).interface
    assert interface is not None
    return [(f"{problem.span.line}:{problem.span.column}", problem.message.partition(";")[0]) for problem in interface.problems]


@pytest.mark.parametrize(
    ("data", "place", "message"),
    [
        (b"\xef\xbb\xbfint32 a\n", "1:1", "rosidl cannot read a file that begins with a byte order mark"),
        (b"int32 a\nint32 b # caf\xe9\n", "2:14", "rosidl cannot read a file that is not in UTF-8"),
        ("int32 a\n".encode("utf-16"), "1:1", "rosidl cannot read a file that is not in UTF-8"),
        (b"# coding: latin-1\nint32 a # caf\xe9\n", "1:1", "rosidl cannot read a file that is not in UTF-8"),
    ],
)
def test_a_file_in_a_wrong_encoding_is_a_problem(data: bytes, place: str, message: str) -> None:
    assert problems(data) == [(place, message)]


@pytest.mark.parametrize("data", [b"int32 a\r\nint32 b\r\n", "int32 a # é\n".encode(), b"# encoding: ascii\nint32 a\n", b""])
def test_a_file_in_utf_8_is_read_whatever_it_declares(data: bytes) -> None:
    assert problems(data) == []


def test_separators_with_windows_line_ends_are_recognised() -> None:
    assert problems(b"int32 a\r\n---\r\nint32 a\r\n", "a/srv/X.srv") == []
    message = "a separator line must contain nothing but '---'"
    assert problems(b"int32 a\r\n--- \r\nint32 a\r\n", "a/srv/X.srv") == [("2:1", message)]


def test_message_types_of_a_definition() -> None:
    interface = interfaces.collect(Text("a/srv/X.srv", "Own[] own\nother/Thing[<=2] thing\nint32 A=1\n---\nOwn own\n")).interface
    assert interface is not None
    assert [(name, str(span)) for name, span in interface.types] == [
        ("Own", "a/srv/X.srv:1:1"),
        ("other/Thing", "a/srv/X.srv:2:1"),
        ("Own", "a/srv/X.srv:5:1"),
    ]


@pytest.mark.parametrize(("name", "better"), [("motor_state", "MotorState"), ("Motor copy", "MotorCopy"), ("servoJ", "ServoJ")])
def test_an_invalid_interface_name_is_a_problem(name: str, better: str) -> None:
    interface = interfaces.collect(Text(f"a/msg/{name}.msg", "")).interface
    assert interface is not None
    assert [problem.message for problem in interface.problems] == [
        f"'{name}' is not a valid interface name; rename the file to '{better}.msg'"
    ]
