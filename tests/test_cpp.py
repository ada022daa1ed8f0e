"""C and C++ sources: the scan for includes compared with a simple preprocessor, and places of mentions."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from ros_lint.base.text import Span, Text, read
from ros_lint.collectors.cpp import collect as cpp
from ros_lint.collectors.cpp.includes import STANDARD, IncludeScan, scan_exactly, scan_includes
from ros_lint.facts.sources import Mention

pytestmark = pytest.mark.slow


def includes(text: str) -> IncludeScan:
    """Return the result of both scans for includes. Checks that they are equal."""
    source = Text("a.cpp", text)
    result = scan_includes(source)
    precise = scan_exactly(source)
    assert (result.mentions, result.computed) == (precise.mentions, precise.computed)
    assert all(text.find(mention.name, at) >= at for mention, at in zip(result.mentions, result.code, strict=True))
    return result


def collected(text: str) -> list[tuple[str, str, bool]]:
    return [(mention.via, mention.name, mention.optional) for mention in cpp.collect(Text("a.cpp", text)).mentions]


# --- a second reader, written from the standard's phases of translation and without regard to speed


def slow_includes(text: str) -> list[str]:
    """Return the names of includes that are not in a comment, a raw string or ``#if 0``."""
    names: list[str] = []
    skipping: list[list[bool]] = []  # per conditional: [in a dead branch, a branch was certain]
    for line in _logical_lines(text):
        directive = re.match(r"\s*#\s*(\w+)\s*(.*)", line)
        if not directive:
            continue
        word, rest = directive[1], directive[2].strip()
        if word in ("if", "ifdef", "ifndef"):
            skipping.append([rest == "0" and word == "if", rest == "1" and word == "if"])
        elif word in ("elif", "else") and skipping:
            skipping[-1][0] = skipping[-1][1] or (word == "elif" and rest == "0")
            skipping[-1][1] |= word == "else" or rest == "1"
        elif word == "endif" and skipping:
            skipping.pop()
        elif word == "include" and not any(skipped for skipped, _ in skipping):
            name = re.match(r'<([^>]+)>|"([^"]+)"', rest)
            if name:
                names.append(name[1] or name[2])
    return names


def _logical_lines(text: str) -> list[str]:
    lines = [""]
    at = 0
    while at < len(text):
        char, two = text[at], text[at : at + 2]
        if text.startswith("\\\n", at):
            at += 2
        elif two == "//":
            while at < len(text) and text[at] != "\n":
                at += 2 if text[at] == "\\" else 1
        elif two == "/*":
            end = text.find("*/", at + 2)
            at = len(text) if end < 0 else end + 2
            lines[-1] += " "
        elif two == 'R"' and (raw := re.compile(r'R"([^()\\\s]{0,16})\(').match(text, at)) and not lines[-1][-1:].isalnum():
            end = text.find(f'){raw[1]}"', raw.end())
            if end < 0:
                lines[-1] += char
                at += 1
            else:
                lines[-1] += "''"
                at = end + len(raw[1]) + 2
        elif char == "<" and re.fullmatch(r"\s*#\s*include\s*", lines[-1]):
            end = at + 1
            while end < len(text) and text[end] not in ">\n":
                end += 1
            lines[-1] += text[at : end + 1] if text[end : end + 1] == ">" else text[at:end]
            at = end + (text[end : end + 1] == ">")
        elif char in "\"'" and (is_closed := re.compile(rf"{char}(?:[^{char}\\\n]|\\.)*{char}", re.DOTALL).match(text, at)):
            lines[-1] += is_closed[0].replace("\n", " ")
            at = is_closed.end()
        elif char == "\n":
            lines.append("")
            at += 1
        else:
            lines[-1] += char
            at += 1
    return lines


PIECES = st.sampled_from(
    [
        "#include <a/b.hpp>",
        '#include "c.h"',
        "  #  include <d/e.h> // why",
        "#if 0",
        "#if 1",
        "#if 0 // never",
        "#if 0 /* never\n*/",
        "#if X",
        "#ifdef Y",
        "#elif 0",
        "#else",
        "#endif",
        "#endif  // X",
        "/*",
        "*/",
        "/* one */",
        "/* #include <j/k.h> */",
        "/* l */ #include <m.hpp>",
        "// #include <n/o.h>",
        "// p \\",
        "foo(); #include <q.h>",
        '"a string"',
        '"// no comment"',
        '"/* no comment"',
        '"*/"',
        'R"(',
        ')"',
        'R"x(',
        ')x"',
        "'\"'",
        "'/'",
        "a * /b",
        "**/*c*/",
        "#define Z \\",
        '"continued \\',
        'rest"',
        "",
        " ",
    ]
)


@given(st.lists(st.tuples(PIECES, st.sampled_from(["\n", "\n", "\n", " ", ""])), max_size=14))
@example([("*//*", "\n"), ("/*// #include <n/o.h>", "\n"), ("#include <a/b.hpp>", "\n")])
@settings(max_examples=1500)
def test_includes_equal_those_of_a_simple_preprocessor(parts: list[tuple[str, str]]) -> None:
    # What follows a condition on its line would be an error, about which both readers may think as they like.
    text = "".join(piece + ("\n" if re.match("#(if|el|endif)", piece) else end) for piece, end in parts)
    assert [item.name for item in includes(text).mentions] == slow_includes(text)


def test_comment_marks_in_bracketed_includes_are_part_of_the_name() -> None:
    assert [item.name for item in includes("#include <a//b>\n#include <c/*d>\n#include <e>\n/* #include <f> */\n").mentions] == [
        "a//b",
        "c/*d",
        "e",
    ]


@given(st.text(alphabet="#includef <>\"'/*\\\nR()01x\r", max_size=80))
@settings(max_examples=1500)
def test_arbitrary_text_is_read_without_an_exception(text: str) -> None:
    for mention in cpp.collect(source := Text("a.h", text)).mentions:
        assert source.slice(mention.span) == mention.name


# --- what depends on the build


@pytest.mark.parametrize(
    ("text", "optional"),
    [
        ("#include <p/a.hpp>\n", False),
        ("#ifndef A_H\n#define A_H\n#include <p/a.hpp>\n#endif\n", False),
        ("// licence\n#ifndef A_H_\n#define A_H\n#include <p/a.hpp>\n#endif\n", False),
        ("#if !defined(A_H)\n#  define A_H\n#include <p/a.hpp>\n#endif\n", False),
        ("#ifdef __cplusplus\n#include <p/a.hpp>\n#endif\n", False),
        ("#ifndef Q_MOC_RUN\n#include <p/a.hpp>\n#endif\n", False),
        ("#if 1\n#include <p/a.hpp>\n#endif\n", False),
        ("#if 0\n#else\n#include <p/a.hpp>\n#endif\n", False),
        ("#if __has_include(<p/a.hpp>)\n#include <p/a.hpp>\n#endif\n", True),
        ("#ifdef USE_P\n#include <p/a.hpp>\n#endif\n", True),
        ("#ifdef HUMBLE\n#include <p/a.h>\n#else\n#include <p/a.hpp>\n#endif\n", False),
        ("#ifdef HUMBLE\n#include <p/a.h>\n#elif X\n#include <p/a.hpp>\n#endif\n", True),
        ("#ifdef HUMBLE\n#include <q/a.h>\n#else\n#include <p/a.hpp>\n#endif\n", True),
        ("#ifndef A_H\n#define A_H\n#if X\n#include <p/a.h>\n#else\n#include <p/b.h>\n#endif\n#endif\n", False),
        ("#if X\n#if Y\n#include <p/a.h>\n#else\n#include <p/b.h>\n#endif\n#else\n#include <p/c.h>\n#endif\n", False),
        ("#if X\n#if Y\n#include <p/a.h>\n#endif\n#else\n#include <p/c.h>\n#endif\n", True),
        ("#if X\n#include <p/a.h>\n", True),
    ],
)
def test_conditional_includes_are_optional(text: str, optional: bool) -> None:
    result = [item.optional for item in includes(text).mentions if item.name.startswith("p/")]
    assert result
    assert set(result) == {optional}


def test_standard_headers_are_left_out() -> None:
    text = "".join(f"#include <{name}>\n" for name in sorted(STANDARD)) + "#include <armadillo>\n#include <Eigen>\n"
    assert [item.name for item in includes(text).mentions] == ["armadillo", "Eigen"]


# --- places, quotes, look-ups


@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_includes_have_place_and_quotes(newline: str) -> None:
    lines = [
        "// ß",
        '#include "x/y.hpp"',
        "",
        "  # include <z/ü.h>",
        "auto d = f::get_package_share_directory(",
        '  "q");',
    ]
    source = Text("a.cpp", newline.join(lines))
    mentions = cpp.collect(source).mentions
    assert [(m.name, m.via, m.what, str(m.span)) for m in mentions] == [
        ("x/y.hpp", "include", '#include "x/y.hpp"', "a.cpp:2:11"),
        ("z/ü.h", "include", "#include <z/ü.h>", "a.cpp:4:14"),
        ("q", "package", 'get_package_share_directory("q")', "a.cpp:6:4"),
    ]
    assert [source.slice(mention.span) for mention in mentions] == ["x/y.hpp", "z/ü.h", "q"]


def test_look_ups_in_comments_do_not_count() -> None:
    assert collected('// get_package_prefix("a")\n/* get_package_prefix("b") */ get_package_prefix("c");') == [
        ("package", "c", False)
    ]
    assert collected("get_package_prefix(name);") == []


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ('x = get_package_share_directory("p") + "/config/a.yaml";', [("p", "config/a.yaml")]),
        ('x = fs::path(a::get_package_share_directory("p")) / "config" / "a.yaml";', [("p", "config/a.yaml")]),
        ('x = get_package_share_path("p") / "a" + ".yaml";', [("p", "a.yaml")]),
        ('auto d = a::get_package_share_directory("p");\nf(d + "/a.yaml"); g(d + name);', [("p", "a.yaml")]),
        ('std::string d(get_package_share_directory("p"));\nf(fs::path(d) / "b" / "a.yaml");', [("p", "b/a.yaml")]),
        ('fs::path d{fs::path{get_package_share_directory("p")}};', []),
        ('x = get_package_share_directory("p") + "/config/" + name;', []),
        ('x = get_package_share_directory("p") + "_suffix";', []),
        ('x = get_package_share_directory("p") + "/../a";', []),
        ('x = get_package_prefix("p") + "/lib/a";', []),
        ('auto d = get_package_share_directory("p");\nauto d = get_package_share_directory("q"); f(d + "/a");', []),
    ],
)
def test_looked_up_files_are_found(text: str, expected: list[tuple[str, str]]) -> None:
    facts = cpp.collect(source := Text("a.cpp", text))
    assert [(result.package, result.path) for result in facts.lookups] == expected
    assert all(source.slice(result.span).strip("/") in result.path for result in facts.lookups)
    assert facts.mentions[0].name == "p"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ('pluginlib::ClassLoader<nav2_core::X> loader("nav2_core", "nav2_core::X");', ["nav2_core"]),
        ('Server::Server() : lp_loader_("a_b", "a_b::Base"), x_(1) {', ["a_b"]),
        ('p = std::make_unique<pluginlib::ClassLoader<a::B<C>>>("a", "a::B");', ["a"]),
        ('// ClassLoader<X> loader("a", "a::B");', []),
        ('ClassLoader<X> loader("a", "b::C");', []),
        ('Chain::Chain() : loader_("a", "a::Filter<b::msg::C>") {', ["a"]),
    ],
)
def test_plugin_loaders_are_found(text: str, expected: list[str]) -> None:
    assert [name for via, name, _ in collected("#include <pluginlib/class_loader.hpp>\n" + text) if via == "package"] == expected
    assert not [name for via, name, _ in collected(text) if via == "package"]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ('p = std::make_unique<pluginlib::ClassLoader<b::C>>(\n  "a", "b::C");', [("a", "b::C")]),
        ('Chain::Chain() : loader_("a", "a::Filter<b::msg::C>") {', [("a", "a::Filter<b::msg::C>")]),
        ('// ClassLoader<X> loader("a", "b::C");', []),
        ('loader.load("a", "b");', []),
    ],
)
def test_base_classes_of_plugin_loaders_are_found(text: str, expected: list[tuple[str, str]]) -> None:
    facts = cpp.collect(source := Text("a.cpp", "#include <pluginlib/class_loader.hpp>\n" + text))
    assert [(loader.package, loader.base) for loader in facts.loaders] == expected
    assert all(source.slice(loader.span) == loader.package for loader in facts.loaders)
    assert not cpp.collect(Text("a.cpp", text)).loaders
    # The header that declares the loader usually has the name of the source.
    facts = cpp.collect(Text("src/chain.cpp", '#include "robot/chain.hpp"\n' + text))
    assert [(loader.package, loader.base) for loader in facts.loaders] == expected
    assert not cpp.collect(Text("src/chain.cpp", '#include "robot/chain_links.hpp"\n' + text)).loaders
    assert not cpp.collect(Text("include/chain.hpp", '#include "robot/chain.hpp"\n' + text)).loaders


def test_a_computed_include_is_opaque() -> None:
    facts = cpp.collect(Text("a.h", "#include CONFIG_H // x\n"))
    assert not facts.mentions
    assert [(o.reason, str(o.span)) for o in facts.opaque] == [
        ("the header in '#include CONFIG_H' is known only to the preprocessor", "a.h:1:10")
    ]


# --- names without an include


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("std_msgs::msg::String s;", [("std_msgs", "std_msgs::msg::String", False)]),
        ("f<::a_b::srv::C::Request>();\nd_e::action::F g;", [("a_b", "a_b::srv::C", False), ("d_e", "d_e::action::F", False)]),
        ("using a_b::msg::C;\nusing namespace d_e::msg;", [("a_b", "a_b::msg::C", False)]),
        ('#include "a_b/msg/c.hpp"\na_b::msg::D d; g_h::msg::I i;', [("g_h", "g_h::msg::I", False)]),
        ("void f(tf2_ros::Buffer & b);\ntf2_ros::Buffer c;", [("tf2_ros", "tf2_ros::Buffer", False)]),
        ("#include <rclcpp_lifecycle/lifecycle_node.hpp>\nclass A : public rclcpp_lifecycle::LifecycleNode", []),
        ("my_tf2_ros::Buffer b; x::tf2_ros::Buffer c; tf2::Transform d; namespace tf2_ros::e {}", []),
        ("outer::a_b::msg::C c; T::msg::D d; MsgT::msg::E e;", []),
        ('// a_b::msg::C\n/* a_b::msg::C */ /*\na_b::msg::C */ x = "a_b::msg::C";\nR"(\na_b::msg::C)";', []),
        ("// a_b::msg::C\nvoid f(a_b::msg::C c);", [("a_b", "a_b::msg::C", False)]),
        ("#define M a_b::msg::C\nnamespace a_b::msg::d {\n}", []),
        ("#define M \\\n  a_b::msg::C\n\na_b::msg::D d;", [("a_b", "a_b::msg::D", False)]),
        ("#ifdef X\na_b::msg::C c;\n#endif\n", [("a_b", "a_b::msg::C", True)]),
        ("#ifdef X\na_b::msg::C c;\n#else\na_b::msg::D d;\n#endif\n", [("a_b", "a_b::msg::C", True)]),
        ("#ifdef X\na_b::msg::C c;\n#endif\na_b::msg::D d;\n", [("a_b", "a_b::msg::D", False)]),
        ("#ifndef A_H\n#define A_H\na_b::msg::C c;\n#if 0\n#endif\n#endif\n", [("a_b", "a_b::msg::C", False)]),
        ("#ifndef A_H\n#define A_H\n#if 1\n#else\na_b::msg::C c;\n#endif\n#endif\n", [("a_b", "a_b::msg::C", True)]),
    ],
)
def test_qualified_interface_types_are_symbols(text: str, expected: list[tuple[str, str, bool]]) -> None:
    source = Text("a.cpp", text)
    result = [mention for mention in cpp.collect(source).mentions if mention.via == "symbol"]
    assert [(mention.name, mention.what, mention.optional) for mention in result] == expected
    assert all(source.slice(mention.span) == mention.what for mention in result)


def test_facts_have_all_fields() -> None:
    # Facts are created without their constructors, which would add the defaults of new fields.
    facts = cpp.collect(Text("a.cpp", '#include "a/b.h"\nc_d::msg::E e;\n'))
    assert [len(mention) for mention in facts.mentions] == [len(Mention._fields)] * 2
    assert [len(mention.span) for mention in facts.mentions] == [len(Span._fields)] * 2


@pytest.mark.skipif("ROS_LINT_CORPUS" not in os.environ, reason="ROS_LINT_CORPUS names no folder of repositories")
def test_fast_and_exact_scans_agree_on_real_sources() -> None:
    sources = [path for path in Path(os.environ["ROS_LINT_CORPUS"]).rglob("*.[ch]pp") if path.is_file()]
    assert sources
    for path in sources:
        source = read(str(path), path.read_bytes())
        result, precise = scan_includes(source), scan_exactly(source)
        assert (result.mentions, result.computed) == (precise.mentions, precise.computed), path


@pytest.mark.parametrize(
    ("handler", "optional"),
    [
        ("catch (const ament_index_cpp::PackageNotFoundError & e) { warn(); return; }", True),
        ("catch (ament_index_cpp::PackageNotFoundError &) {\n  if (x) { y(); }\n}", True),
        ("catch (const ament_index_cpp::PackageNotFoundError & e) { throw std::runtime_error(e.what()); }", False),
        ("catch (const ament_index_cpp::PackageNotFoundError & e) { exit(1); }", False),
        ("catch (const std::out_of_range & e) { /* PackageNotFoundError */ }", False),
    ],
)
def test_a_look_up_in_a_try_block_is_optional(handler: str, optional: bool) -> None:
    text = f'void f() {{\n  try {{\n    if (a) {{ d = get_package_share_directory("meshes"); }}\n  }}\n  {handler}\n}}\n'
    facts = cpp.collect(Text("a.cpp", text + 'void g() { get_package_share_directory("maps"); }\n'))
    result = {mention.name: mention.optional for mention in facts.mentions if mention.via == "package"}
    assert result == {"meshes": optional, "maps": False}
