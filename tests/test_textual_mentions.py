"""Textual mentions of names: spellings and places."""

from __future__ import annotations

from ros_lint.base.text import read
from ros_lint.collectors.cpp import collect as cpp
from ros_lint.knowledge.names import Names
from ros_lint.knowledge.store import Store
from ros_lint.workspace.usage.package_files import PackageSource
from ros_lint.workspace.usage.textual_mentions import find_code_mentions, find_mentions


def test_a_name_is_found_in_many_spellings() -> None:
    files = [
        ("a.cpp", b"'\xff'\nacme::route_tools::Route route;\n"),
        ("b.cpp", b"auto message = tf2::toMsg(transform);\n"),
        ("c.yaml", b"key: my-own-tools\nother: nav_msgs_extra\n"),
    ]
    places = find_mentions(("acme_route_tools", "tf2_eigen", "my_own_tools", "route", "nav", "std_msgs", "xnav_msgs"), files)
    assert {name: (span.path, span.line) for name, span in places.items()} == {
        "acme_route_tools": ("a.cpp", 2),
        "tf2_eigen": ("b.cpp", 1),
        "my_own_tools": ("c.yaml", 1),
        "route": ("a.cpp", 2),
        "nav": ("c.yaml", 2),
    }


def test_inner_namespaces_and_library_names_without_prefix_are_found() -> None:
    files = [
        ("a.cpp", b"int route_tools = 0; draw_tools::Pen pen; my_line_tools::Line line;\n"),
        ("b.cpp", b"namespace acme { route_tools::Route route; }\n"),
        ("c.cpp", b"#include <arm/arm.hpp>\nleg::Leg left;\n"),
    ]
    places = find_mentions(
        ("acme_route_tools", "acme_tools", "acme_draw", "acme_line_tools", "libarm", "libleg", "libfoot"), files
    )
    assert {name: (span.path, span.line) for name, span in places.items()} == {
        "acme_route_tools": ("b.cpp", 1),
        "libarm": ("c.cpp", 1),
        "libleg": ("c.cpp", 2),
    }


def test_replacement_words_are_found_case_insensitively() -> None:
    files = [("a.cpp", b"#include <cpprest/http_client.h>\n"), ("CMakeLists.txt", b"find_package(CHOLMOD)\n")]
    names = Names(Store())
    keys = ("libcpprest-dev", "suitesparse", "python3-open3d")
    places = find_mentions(keys, files, {key: names.called(key) for key in keys})
    assert {name: (span.path, span.line) for name, span in places.items()} == {
        "libcpprest-dev": ("a.cpp", 1),
        "suitesparse": ("CMakeLists.txt", 1),
    }


def test_a_name_in_an_include_is_found_at_its_place() -> None:
    source = b"#include <acme/route_tools/route.hpp>\n#include <Eigen/Core>\nacme_msgs::msg::Route route;\n"
    names, words = ("acme_route_tools", "acme_msgs", "eigen", "acme_other"), {"eigen": ("eigen",)}
    facts = {file: cpp.collect(read(f"talker/{file}", source)) for file in ("a.cpp", "readme.cpp")}
    package = PackageSource("talker", "talker", tuple(facts), None, facts, (), "ament_cmake")
    places = find_code_mentions(names, package, words, lambda file: file != "readme.cpp")
    texts = find_mentions(names, [("talker/a.cpp", source)], words)
    assert {name: span.line for name, span in places.items()} == {name: span.line for name, span in texts.items()}
    assert places.keys() == {"acme_route_tools", "acme_msgs", "eigen"}
    assert not find_code_mentions(names, package, words, lambda file: False)


def test_names_in_comments_are_skipped() -> None:
    files = [
        ("a.cpp", "// angles é\n/* std_msgs */ std_msgs::msg::String text; // OpenCV\n".encode()),
        ("b.py", b"# nav_msgs\nprint('nav_msgs # angles')\n"),
    ]
    places = find_mentions(("angles", "std_msgs", "nav_msgs", "libopencv-dev"), files, {"libopencv-dev": ("opencv",)})
    assert {name: (span.path, span.line, span.column) for name, span in places.items()} == {
        "angles": ("b.py", 2, 19),
        "std_msgs": ("a.cpp", 2, 16),
        "nav_msgs": ("b.py", 2, 8),
    }
