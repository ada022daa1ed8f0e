"""Manifests compared with catkin_pkg, and places of their elements."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest
from catkin_pkg.package import InvalidPackage, parse_package
from hypothesis import example, given, settings
from hypothesis import strategies as st

from ros_lint.base.text import Span, Text, read
from ros_lint.collectors.manifest.collect import collect
from ros_lint.facts.manifest import Depend, Element, Manifest
from tests.manifest_oracle import SEEDS, by_catkin_pkg, differences, mutate

GOOD = """<package format="3">
  <name>p</name>
  <version>1.0.0</version>
  <description>d</description>
  <maintainer email="a@b.cc">m</maintainer>
  <license>MIT</license>
</package>
"""
numbers = st.integers(0, 1 << 24)


def kinds(text: str | bytes) -> list[str]:
    return [problem.kind for problem in of(text).problems]


def of(text: str | bytes) -> Manifest:
    return collect(read("package.xml", text if isinstance(text, bytes) else text.encode("utf-8", "surrogatepass")))


def with_(*children: str, form: str = "3", own: str = GOOD) -> str:
    return own.replace('format="3"', f'format="{form}"').replace("</package>", "\n".join(children) + "\n</package>")


@settings(max_examples=500)
@given(numbers, st.lists(st.tuples(numbers, numbers, numbers), max_size=4), st.one_of(st.just(0), numbers))
@example(0, [], 8)
@example(1, [], 4)
@example(1, [], 7)
@example(0, [(21679, 0, 1617)] * 2, 0)  # two byte order marks
def test_manifests_are_read_as_by_catkin_pkg(seed: int, ops: list[tuple[int, int, int]], encoding: int) -> None:
    assert list(differences(mutate(seed, ops, encoding))) == []


@settings(max_examples=200)
@given(st.one_of(st.binary(max_size=200), st.text(max_size=200).map(lambda text: text.encode("utf-8", "surrogatepass"))))
def test_garbage_is_rejected_without_an_exception(data: bytes) -> None:
    assert of(data).problems


def test_every_unmutated_seed_is_accepted() -> None:
    """Otherwise most mutations would only compare rejections."""
    assert all(by_catkin_pkg(seed.encode()).accepted for seed in SEEDS)


def test_encodings_and_line_ends_are_read_as_by_catkin_pkg(tmp_path: Path) -> None:
    for data in (GOOD.replace("\n", "\r").encode(), GOOD.replace(">m<", ">Ü<").encode("latin-1"), GOOD.encode("utf-8-sig")):
        (tmp_path / "package.xml").write_bytes(data)
        try:
            accepted = parse_package(str(tmp_path / "package.xml"), warnings=[]).name == "p"
        except (InvalidPackage, UnicodeDecodeError):
            accepted = False
        assert accepted == (not of(data).problems)


@pytest.mark.parametrize(
    "content",
    [
        "<![CDATA[x]]>",
        "a>b",
        "a &amp; b",
        "a &#62; b<!-- c -->",
        "a > <b>c</b> &lt; d",
        "x> <?pi y?> z",
        "x><![CDATA[y>]]>",
        "a\r\nb<b/>",
    ],
)
def test_content_with_markup_equals_that_of_catkin_pkg(content: str) -> None:
    elements = f"<export><build_type>{content}</build_type></export></package>"
    assert list(differences(GOOD.replace("</package>", elements).replace(">d<", f">{content}<").encode())) == []


@pytest.mark.skipif("ROS_LINT_CORPUS" not in os.environ, reason="no directory of repositories given")
def test_real_manifests_are_read_as_by_catkin_pkg() -> None:
    for folder, _, files in os.walk(os.environ["ROS_LINT_CORPUS"]):
        path = os.path.join(folder, "package.xml")
        if "package.xml" in files and os.path.isfile(path):
            assert list(differences(Path(path).read_bytes())) == [], path


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (GOOD, []),
        ("", ["invalid-xml"]),
        ("hello", ["invalid-xml"]),
        ("<launch/>", ["no-package"]),
        (GOOD + GOOD, ["invalid-xml"]),
        (GOOD[:60], ["invalid-xml"]),
        (with_(form="4"), ["format"]),
        (with_(form="x"), ["format"]),
        (with_(own=GOOD.replace("  <version>1.0.0</version>\n", "")), ["missing-tag"]),
        (with_("<name>q</name>"), ["repeated-tag"]),
        (with_("<export/>", "<export/>"), ["repeated-tag"]),
        (with_(own=GOOD.replace(">p<", "><")), ["empty-tag"]),
        (with_(own=GOOD.replace(">p<", ">my package<")), ["invalid-name"]),
        (with_(own=GOOD.replace("1.0.0", "1.0")), ["invalid-version"]),
        (with_(own=GOOD.replace("<version", '<version compatibility="1"')), ["invalid-version"]),
        (with_(own=GOOD.replace(">d<", "> <")), ["empty-tag"]),
        (with_(own=GOOD.replace(' email="a@b.cc"', "")), ["missing-attribute"]),
        (with_(own=GOOD.replace("b.cc", "b")), ["invalid-email"]),
        (with_(own=GOOD.replace("MIT", "")), ["empty-tag"]),
        (with_("<run_depend>a</run_depend>"), ["unknown-tag"]),
        (with_("<exec_depend>a</exec_depend>", form="1"), ["unknown-tag"]),
        (with_("<depend foo='1'>a</depend>"), ["unknown-attribute"]),
        (with_("<depend condition='$A == 1'>a</depend>", form="2"), ["unknown-attribute"]),
        (with_("<depend>a<b/></depend>"), ["nested-tag"]),
        (with_("<exec_depend>p</exec_depend>"), ["self-dependency"]),
        (with_("<group_depend>g</group_depend>", "<member_of_group>g</member_of_group>"), ["own-group"]),
        (with_("<depend>a</depend>", "<exec_depend>a</exec_depend>"), ["duplicate-dependency"]),
        (with_("<depend>a</depend>", "<depend>a</depend>", "<depend>a</depend>"), ["duplicate-dependency"] * 2),
        (with_("<build_depend>a</build_depend>", "<test_depend>a</test_depend>", form="1"), ["duplicate-dependency"]),
        (with_("<<<<<<< HEAD", "<depend>a</depend>", "=======", "<depend>b</depend>", ">>>>>>> other"), ["merge-conflict"]),
        (GOOD.replace(">m<", ">Ü<").encode("latin-1"), ["encoding"]),
        (GOOD.encode("utf-16"), ["encoding"]),
    ],
)
def test_kinds_of_problems(text: str | bytes, expected: list[str]) -> None:
    assert kinds(text) == expected
    assert by_catkin_pkg(text if isinstance(text, bytes) else text.encode()).accepted == (not expected)


@pytest.mark.parametrize(
    ("text", "where", "message"),
    [
        ("", "1:1-1:1", "the file is empty"),
        (GOOD.replace(">d<", ">a & b<"), "4:18-4:19", "a bare '&' is not valid in XML; write '&amp;'"),
        (GOOD.replace(">d<", ">1 < 2<"), "4:18-4:19", "a bare '<' is not valid in XML; write '&lt;'"),
        (GOOD.replace(">d<", ">&nbsp;<"), "4:16-4:22", "'&nbsp;' is not defined in XML; write the character itself"),
        (
            GOOD.replace("</version>", "</Version>"),
            "3:19-3:26",
            "</Version> closes <version>; one of the two is misspelt or missing",
        ),
        (GOOD[:-11], "7:1-7:1", "the file ends inside <package>; close this element"),
        (GOOD[:-22], "6:15-6:15", "the file ends inside <license>; close this element"),
        (GOOD[:-20], "6:15-6:17", "'</' is never closed"),
        (GOOD.replace(">d<", "><!-- d<"), "4:16-8:1", "'<!--' is never closed"),
        (GOOD.replace(">d<", "><![CDATA[d<"), "4:16-8:1", "'<![CDATA[' is never closed"),
        (
            GOOD + "<depend>a</depend>",
            "8:1-8:2",
            "the file continues after the end of its root element; remove the rest, because only one <package> is allowed",
        ),
        (
            "<license>MIT</license>\n" + GOOD,
            "1:1-1:10",
            "<license> comes before <package>; remove it, because only one root element is allowed",
        ),
        (GOOD.replace("email=", "email='' email="), "5:24-5:25", "the attribute 'email' is repeated; remove one"),
        (with_("<x:a/>"), "7:1-7:2", "the prefix before ':' belongs to no namespace; remove it"),
        ("<launch/>", "1:2-1:8", "the root element is <launch>, but a manifest has <package>"),
        (with_(form="4"), "1:18-1:19", "there is no format '4' of package.xml; write format=\"3\""),
        (
            with_("  <run_depend>a</run_depend>"),
            "7:3-7:29",
            "there is no <run_depend> in format 3 of package.xml; write <exec_depend>",
        ),
        (
            with_("<exec_depend>a</exec_depend>", form="1"),
            "7:1-7:29",
            "there is no <exec_depend> in format 1 of package.xml; write <run_depend>, or raise the format to 2 or 3",
        ),
        (with_("<dependd>a</dependd>"), "7:1-7:21", "there is no <dependd> in format 3 of package.xml; did you mean <depend>?"),
        (
            with_("<build_type>cmake</build_type>"),
            "7:1-7:31",
            "there is no <build_type> in format 3 of package.xml; move it into <export>",
        ),
        (
            with_("<member_of_group>g</member_of_group>", form="2"),
            "7:1-7:37",
            "there is no <member_of_group> in format 2 of package.xml; raise the format to 3",
        ),
        (
            with_("<depend\n  condition='$A == 1'>a</depend>", form="2"),
            "8:3-8:22",
            "the attribute 'condition' of <depend> needs format 3; write <package format=\"3\">",
        ),
        (with_("<depend>p</depend>"), "7:1-7:19", "the package depends on itself; remove this <depend>"),
        (
            with_("<exec_depend>a</exec_depend>", "<depend>a</depend>"),
            "7:1-7:29",
            "'a' is already declared as <depend>; remove this <exec_depend>",
        ),
        (
            GOOD.replace(">p<", "> a b <"),
            "2:10-2:13",
            "'a b' is not a valid package name; use only letters, digits and underscores",
        ),
        (GOOD.replace("1.0.0", "\n 1.0 "), "4:2-4:5", "version '1.0' is not of the form 1.2.3; write three numbers"),
        (
            GOOD.replace(">m<", ">Ü<").encode("latin-1"),
            "5:30-5:31",
            "the file is not valid UTF-8, the encoding of manifests; save it as UTF-8",
        ),
    ],
)
def test_problems_have_place_and_remedy(text: str | bytes, where: str, message: str) -> None:
    (problem,) = of(text).problems
    span = problem.span
    assert (f"{span.line}:{span.column}-{span.end_line}:{span.end_column}", problem.message) == (where, message)


@pytest.mark.parametrize(
    ("lines", "form", "newer"),
    [
        ("<exec_depend>a</exec_depend>", "1", "2"),
        ("<depend>a</depend>", "1", "2"),
        ("<group_depend>g</group_depend>", "1", "3"),
        ("<member_of_group>g</member_of_group>", "2", "3"),
        ("<depend condition='$A == 1'>a</depend>", "2", "3"),
        ("<run_depend>a</run_depend>", "3", ""),
        ("<depend foo='1'>a</depend>", "2", ""),
    ],
)
def test_problems_name_the_format_that_has_the_tag_or_attribute(lines: str, form: str, newer: str) -> None:
    (problem,) = of(with_(lines, form=form)).problems
    assert problem.subject == newer


def test_a_declared_encoding_is_ignored_as_by_catkin_pkg() -> None:
    declared = '<?xml version="1.0" encoding="iso-8859-1"?>\n'
    assert kinds((declared + GOOD.replace(">m<", ">Ü<")).encode("latin-1")) == ["encoding"]
    assert kinds((declared + GOOD.replace(">m<", ">Ü<")).encode()) == []


def test_the_beginning_of_a_truncated_file_is_read() -> None:
    manifest = of(with_("<depend>a</depend>", "<export><build_type>ament_cmake</build_type><b").removesuffix("</package>\n"))
    assert manifest.name == "p"
    assert [depend.name for depend in manifest.depends] == ["a"]
    assert [export.text for export in manifest.exports] == ["ament_cmake"]
    assert [problem.kind for problem in manifest.problems] == ["invalid-xml"]


def test_both_sides_of_a_merge_conflict_are_read() -> None:
    manifest = of(with_("<<<<<<< HEAD", "<depend>a</depend>", "=======", "<depend>b</depend>", ">>>>>>> other"))
    assert [(depend.name, depend.span.line) for depend in manifest.depends] == [("a", 8), ("b", 10)]
    assert manifest.problems[0].span == Span("package.xml", 7, 1, 7, 13)


def test_entities_and_deep_nesting_are_rejected() -> None:
    bomb = '<!DOCTYPE package [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;">]>' + GOOD
    outside = '<!DOCTYPE package [<!ENTITY a SYSTEM "file:///etc/passwd">]>' + GOOD.replace(">d<", ">&a;<")
    assert kinds(bomb) == kinds(outside) == ["entity"]
    assert kinds('<!DOCTYPE package SYSTEM "http://example.org/package.dtd">' + GOOD) == []
    assert kinds(with_(own=GOOD.replace(">d<", f">{'<b>' * 300}{'</b>' * 300}<"))) == ["too-deep"]


def test_large_and_hostile_files_take_linear_time() -> None:
    started = time.process_time()
    assert of(with_("<depend>a</depend>" * 20_000)).problems
    assert of("<package>" + "<a>" * 50_000).problems
    assert of("<package>" + '<"' * 50_000).problems
    assert of("<package>" + "<!-- <" * 50_000).problems
    assert of(with_("é" + "<exec_depend>a</exec_depend>" * 20_000)).problems == ()
    assert time.process_time() - started < 10


def spans(fact: Depend | Element) -> tuple[str, str]:
    inner = fact.name_span if isinstance(fact, Depend) else fact.text_span
    return tuple(f"{s.line}:{s.column}-{s.end_line}:{s.end_column}" for s in (fact.span, inner))  # type: ignore[return-value]


@pytest.mark.parametrize("newline", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize(
    ("child", "expected"),
    [
        ("<depend>a</depend>", ("7:1-7:19", "7:9-7:10")),
        ("\t<depend> a </depend>", ("7:2-7:22", "7:11-7:12")),
        ("é<!-- ü --><depend>a</depend>", ("7:12-7:30", "7:20-7:21")),
        ("<!-- \U0001f600 --> <depend>\U0001f600</depend>", ("7:12-7:30", "7:20-7:21")),
        ('<depend\n  version_gte="1.0.0"\n  condition="$A > 1"\n>\n  a\n</depend >', ("7:1-12:11", "11:3-11:4")),
        ("<depend><!-- c -->a<!-- d --></depend>", ("7:1-7:39", "7:19-7:20")),
        ("<depend>&#97;b</depend>", ("7:1-7:24", "7:9-7:15")),
        ("<depend/>", ("7:1-7:10", "7:10-7:10")),
        ("<depend\n/>", ("7:1-8:3", "8:3-8:3")),
        ("<url>u</url><depend>a</depend>", ("7:13-7:31", "7:21-7:22")),
    ],
)
def test_spans_of_elements_and_names(child: str, expected: tuple[str, str], newline: str) -> None:
    manifest = of(with_(child).replace("\n", newline))
    assert manifest.problems == ()
    assert spans(manifest.depends[0]) == expected
    (end_line,) = {7 + child.count("\n") + 1}
    assert manifest.end[1:] == (end_line, 1, end_line, 1)


def test_spans_in_a_file_with_a_byte_order_mark() -> None:
    manifest = of(GOOD.encode("utf-8-sig"))
    assert manifest.begin == Span("package.xml", 1, 21, 1, 21)
    assert manifest.format_span == Span("package.xml", 1, 18, 1, 19)


def test_facts_of_a_manifest() -> None:
    manifest = of(SEEDS[0])
    assert (manifest.name, manifest.version, manifest.format, manifest.indent) == ("talker", "1.2.3", 3, "  ")
    assert manifest.elements[2].text == "Says <b>things</b> &amp; more."
    assert manifest.elements[3].get("email") == "a@example.org"
    depend = manifest.depends[1]
    assert depend[:4] == ("std_msgs", "depend", "$ROS_VERSION == 2", (("version_gte", "1.0.0"),))
    assert depend.close == len("</depend>")
    assert [(export.tag, export.text, export.get("condition")) for export in manifest.exports] == [
        ("build_type", "catkin", "$ROS_VERSION == 1"),
        ("build_type", "ament_cmake", "$ROS_VERSION == 2"),
        ("other", "", ""),
    ]
    text = Text("package.xml", SEEDS[0])
    assert [text.slice(aside) for aside in manifest.other_contents] == ["<!-- the messages -->", "<!-- why -->"]


def test_comments_and_texts_between_elements_are_listed() -> None:
    text = with_("<depend>a</depend> <!-- one\n two --> stray text\nmore", "<?pi x?><depend>b</depend>").replace("\n", "\r\n")
    manifest = of(text)
    source = Text("package.xml", text)
    assert [source.slice(aside) for aside in manifest.other_contents] == [
        "<!-- one\r\n two -->",
        "stray text",
        "more",
        "<?pi x?>",
    ]
    assert manifest.newline == "\r\n"
    assert manifest.problems == ()


def test_an_empty_condition_differs_from_no_condition() -> None:
    manifest = of(with_("<depend condition=''>a</depend>", "<exec_depend>a</exec_depend>"))
    assert [depend.condition for depend in manifest.depends] == [" ", ""]


def test_attributes_of_elements_have_places() -> None:
    text = Text("p/package.xml", GOOD.replace("</package>", '<url type="bugtracker"\n  note="ä">u</url><export/></package>'))
    (url,) = [element for element in collect(text).elements if element.tag == "url"]
    places = [(text.offset(*span[1:3]), text.offset(*span[3:5])) for span in url.attribute_spans]
    assert [text.text[start:end] for start, end in places] == ["bugtracker", "ä"]
    assert url.span_of("note") == url.attribute_spans[1]
    assert url.span_of("nothing") == url.span
