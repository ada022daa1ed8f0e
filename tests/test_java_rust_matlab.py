"""Packages that sources in Java, Rust and MATLAB use."""

from __future__ import annotations

import pytest

from ros_lint.base.text import Text
from ros_lint.collectors.file_types import kind_of
from ros_lint.facts.sources import Mention
from ros_lint.workspace.collect import collect


def collected(path: str, text: str) -> tuple[Mention, ...]:
    source = Text(path, text)
    kind = kind_of(path)
    assert kind
    facts = collect(source, kind).facts
    assert facts
    assert {mention.via for mention in facts.mentions} <= {"symbol"}
    return facts.mentions


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("package a.b;\nimport std_msgs.msg.String;\n", [("std_msgs", "std_msgs.msg.String")]),
        ("import static std_msgs.srv.*;", [("std_msgs", "std_msgs.srv.*")]),
        ("x = new a_b.action.C_Goal(); y = new a_b.msg.D();", [("a_b", "a_b.action.C_Goal")]),
        ("package org.ros2.rcljava.examples;\nimport org.ros2.rcljava.RCLJava;", [("rcljava", "org.ros2.rcljava.RCLJava")]),
        ("import org.ros2.rcljava.common.JNIUtils;", [("rcljava_common", "org.ros2.rcljava.common")]),
        ("import com.example.msg.String; import java.util.List;", []),
        ('// std_msgs.msg.A\n/* std_msgs.msg.B */ s = "std_msgs.msg.C";', []),
    ],
)
def test_java_sources_mention_interface_packages(text: str, expected: list[tuple[str, str]]) -> None:
    assert [(mention.name, mention.what) for mention in collected("a/B.java", text)] == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("use std_msgs::msg::String as Text;\n", [("std_msgs", False)]),
        ("use {a_b::srv::{C, D}, rclrs::Node};\nuse rclrs::*;\n", [("a_b", False), ("rclrs", False)]),
        ("use crate::vendor::a_b::msg::C;\n// a_b::msg::C\n", []),
        ("use crate::x;\nuse {\n  a_b::msg::C,\n};\nuse other::{\n  i::j, d_e::msg::F,\n};\n", [("a_b", False)]),
        ("fn f(c: ::a_b::msg::C) {}\n#[cfg(test)]\nmod tests { use d_e::msg::F; }\n", [("a_b", False), ("d_e", True)]),
    ],
)
def test_rust_sources_mention_interface_packages(text: str, expected: list[tuple[str, bool]]) -> None:
    assert [(mention.name, mention.test) for mention in collected("src/main.rs", text)] == expected


def test_cargo_dependencies_are_mentioned() -> None:
    text = """
[package]
name = "a"
version = "*"

[dependencies]  # of ROS
rclrs = "*"
serde = { version = "1", features = ["derive"] }  # path = "of serde"
b_msgs = { path = "../b_msgs" }

[dependencies.c_msgs]
version = "*"

[dev-dependencies]
test_msgs = "*"

[target.'cfg(unix)'.build-dependencies]
d = "*"

[features]
default = []
"""
    assert [(mention.name, mention.optional, mention.test) for mention in collected("Cargo.toml", text)] == [
        ("rclrs", False, False),
        ("serde", True, False),
        ("b_msgs", False, False),
        ("c_msgs", False, False),
        ("test_msgs", False, True),
        ("d", False, False),
    ]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ('p = ros2publisher(node, "/chatter", "std_msgs/String");', ["std_msgs"]),
        ("p = ros2subscriber(node, '/chatter', ...  the topic\n  'std_msgs/msg/String', @f);", ["std_msgs"]),
        ('m = ros2message("a_b/srv/CRequest"); c = ros2svcclient(n, "/s", "d_e/F");', ["a_b", "d_e"]),
        ('% p = ros2publisher(node, "/chatter", "std_msgs/String");\nx = "std_msgs/String";', []),
        ('p = rospublisher("/chatter", "std_msgs/String");', []),
    ],
)
def test_matlab_scripts_mention_interface_packages(text: str, expected: list[str]) -> None:
    mentions = collected("scripts/talk.m", text)
    assert [mention.name for mention in mentions] == expected
    assert all(mention.optional for mention in mentions)


def test_a_manifest_of_cargo_without_sections_mentions_nothing() -> None:
    assert collected("Cargo.toml", "rclrs = '*'\n") == ()
