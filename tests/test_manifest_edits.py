"""Edited manifests have the intended meaning for catkin_pkg, and the surrounding text is unchanged."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections import Counter
from collections.abc import Callable, Sequence
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ros_lint.analysis.finding import Fix
from ros_lint.base.edit import Edit
from ros_lint.base.text import Text
from ros_lint.collectors.manifest import edits as manifest_edits
from ros_lint.collectors.manifest.collect import collect
from ros_lint.engine import edits
from ros_lint.facts.manifest import Manifest
from tests.manifest_oracle import KINDS, catkin_pkg_accepts

TAGS = [tag for tag in KINDS if tag != "run_depend"]
NAMES = ["rclcpp", "rclpy", "std_msgs", "tf2", "tf2_ros", "a-key", "eigen", "zlib"]
HEAD = ["<name>p</name>", "<version>1.0.0</version>", "<description>d &amp; <b>e</b></description>"]
HEAD += ['<maintainer email="a@b.cc">m</maintainer>', "<license>MIT</license>"]


def apply(text: str, changes: Sequence[Edit]) -> str:
    source = Text("package.xml", text)
    return edits.apply([Fix("", tuple(changes))], lambda _: source)["package.xml"] if changes else text


def read(text: str) -> Manifest:
    return collect(Text("package.xml", text))


def manifest_of(body: str, head: str = "\n".join(f"  {line}" for line in HEAD)) -> str:
    return f'<?xml version="1.0"?>\n<package format="3">\n{head}\n{body}\n</package>\n'


def declared(text: str) -> Counter[tuple[str, str, str]]:
    """Return the declared dependencies. Checks that catkin_pkg accepts the manifest."""
    assert catkin_pkg_accepts(text.encode()), text
    return Counter((depend.tag, depend.name, depend.condition) for depend in read(text).depends)


def comments(text: str) -> list[str]:
    return re.findall(r"<!--.*?-->", text, re.DOTALL)


def assert_in_style(original: str, edited: str) -> None:
    assert comments(edited) == comments(original)
    if "\n\n\n" not in original.replace("\r", "").replace(" ", "").replace("\t", ""):
        assert "\n\n\n" not in edited.replace("\r", "").replace(" ", "").replace("\t", "")
    if "\r\n" in original:
        assert not re.search(r"(?<!\r)\n", edited)


def manifest_of_seed(seed: int) -> str:
    """Return a manifest that catkin_pkg accepts, in one of many styles."""
    random = Random(seed)
    choice = random.choice
    depends: list[tuple[str, str]] = []
    for tag, name in ((choice(TAGS), choice(NAMES)) for _ in range(random.randrange(9))):
        accepted = [other for other, its_name in depends if its_name == name]
        if not accepted and not (tag in ("group_depend", "member_of_group") and name in [n for t, n in depends if "group" in t]):
            depends.append((tag, name))
    if choice((True, False)):
        depends.sort(key=lambda pair: (TAGS.index(pair[0]), pair[1]))
    indent = choice(["  ", "\t", "    ", ""])
    lines: list[str] = []
    for tag, name in depends:
        name_written = choice([name, name, name, f" {name}\n  ", f"<!-- in -->{name}"])
        attributes = choice(["", "", "", ' condition="$ROS_VERSION == 2"', " condition='$A == 1'\n   "])
        close = choice([">", ">", ">", " >", "\n>"])
        lead = choice(["", "", "", "<!-- above -->\n", "\n", "\n\n", "\n<!-- group -->\n", "<!-- l -->"])
        tail = choice(["\n", "\n", "\n", "  <!-- why -->\n", "<!-- of\n two lines -->\n", "", " ", "\n\n"])
        lines.append(f"{lead}{indent}<{tag}{attributes}>{name_written}</{tag}{close}{tail}")
    body = "".join(lines)
    export = choice(["", "<export><build_type>ament_cmake</build_type></export>", "\n  <export>\n  </export>\n"])
    separator = choice(["\n", "\n\n", ""])
    head = separator.join(f"{indent}{line}" for line in HEAD)
    text = f'<package format="3">{separator}{head}{separator}{body}{separator}{export}{separator}</package>'
    return choice((text, text.replace("\n", "\r\n")))


MANIFESTS = st.integers(0, 2**32).map(manifest_of_seed)
"""Manifests by seed, because to draw each part of them takes most of the time of the tests."""


@settings(max_examples=300)
@given(MANIFESTS, st.sampled_from(TAGS), st.sampled_from(["mid_name", "aaa", "zzz"]))
def test_add_declares_the_dependency_in_the_style_of_the_file(text: str, tag: str, name: str) -> None:
    edited = apply(text, [manifest_edits.add(read(text), tag, name)])
    assert declared(edited) == declared(text) + Counter([(tag, name, "")])
    assert_in_style(text, edited)


@settings(max_examples=300)
@given(MANIFESTS, st.integers(0, 7))
def test_remove_takes_out_only_the_dependency(text: str, index: int) -> None:
    manifest = read(text)
    if not manifest.depends:
        return
    depend = manifest.depends[index % len(manifest.depends)]
    edited = apply(text, [manifest_edits.remove(manifest, depend)])
    assert declared(edited) == declared(text) - Counter([(depend.tag, depend.name, depend.condition)])
    outer = [comment for comment in comments(text) if comment != "<!-- in -->"]
    assert [comment for comment in comments(edited) if comment != "<!-- in -->"] == outer
    assert_in_style(re.sub("<!-- in -->", "", text), re.sub("<!-- in -->", "", edited))


@settings(max_examples=200)
@given(MANIFESTS, st.integers(0, 7), st.sampled_from([tag for tag in TAGS if "group" not in tag]))
def test_change_tag_and_rename_change_only_the_dependency(text: str, index: int, tag: str) -> None:
    manifest = read(text)
    depends = [depend for depend in manifest.depends if "group" not in depend.tag]
    if not depends:
        return
    depend = depends[index % len(depends)]
    changed = apply(text, manifest_edits.change_tag(depend, tag))
    gone = Counter([(depend.tag, depend.name, depend.condition)])
    assert declared(changed) == declared(text) - gone + Counter([(tag, depend.name, depend.condition)])
    if tag != depend.tag:
        changed = apply(text, manifest_edits.change_kind(manifest, depend, tag, depends[:2]))
        assert declared(changed) == declared(text) - gone + Counter([(tag, depend.name, depend.condition)])
    renamed = apply(text, [manifest_edits.rename(depend, "renamed")])
    assert declared(renamed) == declared(text) - gone + Counter([(depend.tag, "renamed", depend.condition)])


@settings(max_examples=200)
@given(MANIFESTS)
def test_sort_orders_the_children_by_the_schema(text: str) -> None:
    changes = manifest_edits.sort(read(text))
    edited = apply(text, changes)
    assert declared(edited) == declared(text)
    assert_in_style(text, edited)
    if changes:
        tags = read(edited)
        children = sorted((child.span, child.tag) for child in (*tags.elements, *tags.depends))
        ranks = [manifest_edits.schema_rank(tag) for _, tag in children]
        assert ranks == sorted(ranks)


@pytest.mark.parametrize(
    ("body", "tag", "name", "expected"),
    [
        (
            "  <depend>a</depend>\n  <depend>c</depend>",
            "depend",
            "b",
            "  <depend>a</depend>\n  <depend>b</depend>\n  <depend>c</depend>",
        ),
        (
            "  <depend>c</depend>\n  <depend>a</depend>",
            "depend",
            "b",
            "  <depend>c</depend>\n  <depend>a</depend>\n  <depend>b</depend>",
        ),
        (
            "  <depend>a</depend>  <!-- why -->\n\n  <test_depend>t</test_depend>",
            "depend",
            "b",
            "  <depend>a</depend>  <!-- why -->\n  <depend>b</depend>\n\n  <test_depend>t</test_depend>",
        ),
        (
            "\n  <buildtool_depend>t</buildtool_depend>\n\n  <depend>a</depend>\n\n  <export/>",
            "exec_depend",
            "b",
            "\n  <buildtool_depend>t</buildtool_depend>\n\n  <depend>a</depend>\n\n  <exec_depend>b</exec_depend>\n\n  <export/>",
        ),
        (
            "\n  <buildtool_depend>t</buildtool_depend>\n  <depend>a</depend>\n\n  <export/>",
            "exec_depend",
            "b",
            "\n  <buildtool_depend>t</buildtool_depend>\n  <depend>a</depend>\n  <exec_depend>b</exec_depend>\n\n  <export/>",
        ),
        ("  <export/>", "depend", "b", "  <depend>b</depend>\n  <export/>"),
        ("\n  <export/>", "depend", "b", "\n  <depend>b</depend>\n\n  <export/>"),
        (
            "  <!-- run -->\n  <exec_depend>a</exec_depend>",
            "depend",
            "b",
            "  <depend>b</depend>\n  <!-- run -->\n  <exec_depend>a</exec_depend>",
        ),
        (
            "  <test_depend>t</test_depend>\n  <depend>a</depend>\n  <export/>",
            "member_of_group",
            "g",
            "  <test_depend>t</test_depend>\n  <depend>a</depend>\n  <member_of_group>g</member_of_group>\n  <export/>",
        ),
        (
            "  <test_depend>t</test_depend>\n  <depend>a</depend>\n  <export/>",
            "group_depend",
            "g",
            "  <test_depend>t</test_depend>\n  <depend>a</depend>\n  <group_depend>g</group_depend>\n  <export/>",
        ),
        ("\t<depend>a</depend>", "depend", "b", "\t<depend>a</depend>\n\t<depend>b</depend>"),
        ("  <depend>a</depend><depend>c</depend>", "depend", "b", "  <depend>a</depend><depend>b</depend><depend>c</depend>"),
        (
            "  <depend>a</depend> <test_depend>t</test_depend>",
            "depend",
            "b",
            "  <depend>a</depend>\n  <depend>b</depend> <test_depend>t</test_depend>",
        ),
        (
            "  <depend>a</depend> <!-- on\n  two lines -->",
            "depend",
            "b",
            "  <depend>a</depend> <!-- on\n  two lines -->\n  <depend>b</depend>",
        ),
        ("    <depend>a</depend>", "depend", "b", "    <depend>a</depend>\n    <depend>b</depend>"),
        (  # the order of tags, not of the file, chooses the place
            "  <exec_depend>e</exec_depend>\n  <build_depend>c</build_depend>",
            "build_export_depend",
            "b",
            "  <exec_depend>e</exec_depend>\n  <build_depend>c</build_depend>\n  <build_export_depend>b</build_export_depend>",
        ),
        (  # most kinds are not apart
            "  <depend>a</depend>\n\n  <build_depend>c</build_depend>\n  <exec_depend>e</exec_depend>",
            "test_depend",
            "b",
            "  <depend>a</depend>\n\n  <build_depend>c</build_depend>\n  <exec_depend>e</exec_depend>\n"
            "  <test_depend>b</test_depend>",
        ),
        (  # the only kind is apart from the rest
            "\n  <!-- what it uses -->\n  <depend>a</depend> <!-- why -->\n\n  <export/>",
            "test_depend",
            "b",
            "\n  <!-- what it uses -->\n  <depend>a</depend> <!-- why -->\n\n  <test_depend>b</test_depend>\n\n  <export/>",
        ),
        (  # a comment at the end of a line belongs to its line
            "  <author>x</author> <!-- why -->\n  <!-- run -->\n  <exec_depend>a</exec_depend>",
            "depend",
            "b",
            "  <author>x</author> <!-- why -->\n  <depend>b</depend>\n  <!-- run -->\n  <exec_depend>a</exec_depend>",
        ),
        (
            "  <author>x</author> <!-- why -->\n  <exec_depend>a</exec_depend>",
            "depend",
            "b",
            "  <author>x</author> <!-- why -->\n  <depend>b</depend>\n  <exec_depend>a</exec_depend>",
        ),
        (  # every kind that can be compared is sorted
            "  <depend>a</depend>\n  <depend>c</depend>\n  <exec_depend>m</exec_depend>",
            "exec_depend",
            "b",
            "  <depend>a</depend>\n  <depend>c</depend>\n  <exec_depend>b</exec_depend>\n  <exec_depend>m</exec_depend>",
        ),
        (  # its own kind is sorted
            "  <depend>a</depend>\n  <depend>c</depend>\n  <test_depend>z</test_depend>\n  <test_depend>y</test_depend>",
            "depend",
            "b",
            "  <depend>a</depend>\n  <depend>b</depend>\n  <depend>c</depend>\n  <test_depend>z</test_depend>\n"
            "  <test_depend>y</test_depend>",
        ),
        (  # one of them is not
            "  <depend>a</depend>\n  <depend>c</depend>\n  <test_depend>z</test_depend>\n  <test_depend>y</test_depend>\n"
            "  <exec_depend>m</exec_depend>",
            "exec_depend",
            "b",
            "  <depend>a</depend>\n  <depend>c</depend>\n  <test_depend>z</test_depend>\n  <test_depend>y</test_depend>\n"
            "  <exec_depend>m</exec_depend>\n  <exec_depend>b</exec_depend>",
        ),
    ],
)
def test_add_inserts_at_the_place_of_its_kind(body: str, tag: str, name: str, expected: str) -> None:
    text = manifest_of(body)
    assert apply(text, [manifest_edits.add(read(text), tag, name)]) == manifest_of(expected)


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("  <depend>a</depend>", "  <depend>a</depend>\n  <export>\n    <build_type>cmake</build_type>\n  </export>"),
        (
            "\n  <depend>a</depend>\n",
            "\n  <depend>a</depend>\n\n  <export>\n    <build_type>cmake</build_type>\n  </export>\n",
        ),
        ("  <export/>", "  <export>\n    <build_type>cmake</build_type>\n  </export>"),
        ("  <export><a/></export>", "  <export><build_type>cmake</build_type><a/></export>"),
        ("  <export></export>", "  <export>\n    <build_type>cmake</build_type>\n  </export>"),
        (
            "\n  <url>u</url> <!-- why -->\n",
            "\n  <url>u</url> <!-- why -->\n\n  <export>\n    <build_type>cmake</build_type>\n  </export>\n",
        ),
        (
            "  <depend>a</depend>\n\n  <exec_depend>b</exec_depend>",
            "  <depend>a</depend>\n\n  <exec_depend>b</exec_depend>\n\n"
            "  <export>\n    <build_type>cmake</build_type>\n  </export>",
        ),
        (
            "  <export>\n    <!-- none -->\n  </export>",
            "  <export>\n    <build_type>cmake</build_type>\n    <!-- none -->\n  </export>",
        ),
    ],
)
def test_set_build_type_adds_the_export(body: str, expected: str) -> None:
    text = manifest_of(body)
    assert apply(text, [manifest_edits.set_build_type(read(text), "cmake")]) == manifest_of(expected)


def test_set_build_type_follows_the_indentation_of_the_file() -> None:
    head = "\n".join(f"\t{line}" for line in HEAD)
    text = manifest_of("\t<export>\n\t\t<a/>\n\t</export>", head)
    edited = manifest_of("\t<export>\n\t\t<build_type>a&amp;b</build_type>\n\t\t<a/>\n\t</export>", head)
    assert apply(text, [manifest_edits.set_build_type(read(text), "a&b")]) == edited
    text = manifest_of("\t<author>a</author>", head)
    edited = manifest_of("\t<author>a</author>\n\t<export>\n\t\t<build_type>cmake</build_type>\n\t</export>", head)
    assert apply(text, [manifest_edits.set_build_type(read(text), "cmake")]) == edited
    text = "<package></package>"
    edited = "<package>\n  <export>\n    <build_type>cmake</build_type>\n  </export>\n</package>"
    assert apply(text, [manifest_edits.set_build_type(read(text), "cmake")]) == edited


@pytest.mark.parametrize(
    ("body", "changed", "expected"),
    [
        (  # versions and conditions are kept
            "  <depend>a</depend>\n  <test_depend>b</test_depend>\n"
            '  <test_depend version_gte="1" condition="$A == \'1\' and $B &lt; c">x</test_depend>',
            "x",
            '  <depend>a</depend>\n  <depend version_gte="1" condition="$A == \'1\' and $B &lt; c">x</depend>\n'
            "  <test_depend>b</test_depend>",
        ),
        (
            "  <depend>a</depend>\n  <test_depend>b</test_depend>\n"
            '  <test_depend condition="$A == &quot;1&quot;">x</test_depend>',
            "x",
            '  <depend>a</depend>\n  <depend condition="$A == &quot;1&quot;">x</depend>\n  <test_depend>b</test_depend>',
        ),
        (  # another spelling of the element
            "  <depend>a</depend>\n  <test_depend>b</test_depend>\n  <test_depend> x</test_depend>",
            "x",
            "  <depend>a</depend>\n  <test_depend>b</test_depend>\n  <depend> x</depend>",
        ),
        (  # it is not alone on its line
            "  <depend>a</depend>\n  <test_depend>b</test_depend> <test_depend>x</test_depend>",
            "x",
            "  <depend>a</depend>\n  <test_depend>b</test_depend> <depend>x</depend>",
        ),
        (  # a kind stays together, and sorted
            "  <test_depend>a</test_depend>\n  <test_depend>x</test_depend>\n\n  <depend>b</depend>\n  <depend>z</depend>",
            "x",
            "  <test_depend>a</test_depend>\n\n  <depend>b</depend>\n  <depend>x</depend>\n  <depend>z</depend>",
        ),
        (  # one of several goes to where its new kind belongs
            "  <build_depend>a</build_depend>\n  <test_depend>b</test_depend>\n  <test_depend>x</test_depend>\n"
            "  <test_depend>y</test_depend>",
            "x",
            "  <depend>x</depend>\n  <build_depend>a</build_depend>\n  <test_depend>b</test_depend>\n"
            "  <test_depend>y</test_depend>",
        ),
        (  # all of a row stay, for nothing is torn apart
            "  <build_depend>x</build_depend>\n  <build_depend>y</build_depend>\n  <test_depend>b</test_depend>",
            "xy",
            "  <depend>x</depend>\n  <depend>y</depend>\n  <test_depend>b</test_depend>",
        ),
        (  # it is not put beside itself
            "  <build_depend>a</build_depend>\n  <build_depend>b</build_depend>\n\n  <build_depend>x</build_depend>\n\n"
            "  <export/>",
            "x",
            "  <depend>x</depend>\n  <build_depend>a</build_depend>\n  <build_depend>b</build_depend>\n\n  <export/>",
        ),
        (
            "  <buildtool_depend>a</buildtool_depend>\n  <buildtool_depend>b</buildtool_depend>\n\n"
            "  <buildtool_depend>x</buildtool_depend>\n\n",
            "x",
            "  <buildtool_depend>a</buildtool_depend>\n  <buildtool_depend>b</buildtool_depend>\n  <depend>x</depend>",
        ),
        (  # where kinds are mixed
            "  <depend>a</depend>\n  <test_depend>x</test_depend>\n  <depend>c</depend>\n  <test_depend>d</test_depend>",
            "x",
            "  <depend>a</depend>\n  <depend>x</depend>\n  <depend>c</depend>\n  <test_depend>d</test_depend>",
        ),
        (  # a comment says what it is for
            "  <depend>a</depend>\n\n  <!-- why -->\n  <test_depend>x</test_depend>",
            "x",
            "  <depend>a</depend>\n\n  <!-- why -->\n  <depend>x</depend>",
        ),
    ],
)
def test_change_kind_moves_the_dependency_to_its_kind(body: str, changed: str, expected: str) -> None:
    text = manifest_of(body)
    manifest = read(text)
    alike = [depend for depend in manifest.depends if depend.name in changed]
    edits_made = [edit for depend in alike for edit in manifest_edits.change_kind(manifest, depend, "depend", alike)]
    assert apply(text, edits_made) == manifest_of(expected)


@pytest.mark.parametrize(
    ("body", "wanted", "expected"),
    [
        ("<depend>a</depend>\n<depend>m</depend>", ["depend z", "depend n"], "amnz"),
        ("<depend>m</depend>\n<depend>a</depend>", ["depend z", "depend n"], "mazn"),
        ("<depend>a</depend>\n<depend>m</depend>", ["test_depend z", "exec_depend y", "test_depend n", "depend o"], "amoynz"),
    ],
)
def test_several_insertions_at_one_place_are_in_order(body: str, wanted: list[str], expected: str) -> None:
    text = manifest_of(body)
    edits = [manifest_edits.add(read(text), *element.split()) for element in wanted]
    assert [depend.name for depend in read(apply(text, edits)).depends] == list(expected)


@pytest.mark.parametrize("tag", TAGS)
def test_several_insertions_give_the_same_text_as_one_after_the_other(tag: str) -> None:
    for seed in range(20):
        text = manifest_of_seed(seed)
        names = [name for name in ("aaa", "mmm", "nnn", "zzz") if Random(f"{seed}{name}").randrange(2)]
        together = apply(text, [manifest_edits.add(read(text), tag, name) for name in names])
        for name in names:
            text = apply(text, [manifest_edits.add(read(text), tag, name)])
        assert together == text


def test_raise_format_changes_only_the_format() -> None:
    for original, edited in [
        ("<package>\n</package>", '<package format="3">\n</package>'),
        ("<package\n  format='2'\n></package>", "<package\n  format='3'\n></package>"),
    ]:
        assert apply(original, [manifest_edits.raise_format(read(original), 3)]) == edited


def test_add_to_an_empty_package() -> None:
    for text in ("<package></package>", "<package>\n</package>\n"):
        edited = apply(text, [manifest_edits.add(read(text), "depend", "a")])
        assert edited.strip() == "<package>\n  <depend>a</depend>\n</package>"
        assert manifest_edits.sort(read(text)) == ()
    text = "<package>\n\t\t<export/>\n</package>"
    edited = apply(text, [manifest_edits.add(read(text), "depend", "a")])
    assert edited == "<package>\n\t\t<depend>a</depend>\n\t\t<export/>\n</package>"


def test_an_element_is_indented_as_its_neighbour() -> None:
    text = "<package>\n\t<name>p</name>\n\t\t<depend>a</depend>\n</package>"
    edited = apply(text, [manifest_edits.add(read(text), "depend", "b")])
    assert edited == text.replace("</depend>", "</depend>\n\t\t<depend>b</depend>")


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("  <depend>x</depend>\n  <depend>a</depend>", "  <depend>a</depend>"),
        ("\n  <depend>x</depend>\n\n  <depend>a</depend>", "\n  <depend>a</depend>"),
        ("  <depend>x</depend>  <!-- why -->\n", "  <!-- why -->\n"),
        ("  <depend>a</depend> <depend>x</depend>", "  <depend>a</depend>"),
        ("  <depend>x</depend> <depend>a</depend>", "  <depend>a</depend>"),
        ("  <depend\n    >x</depend>\n  <depend>a</depend>", "  <depend>a</depend>"),
        ("  <!-- heading -->\n  <depend>x</depend>\n  <depend>a</depend>", "  <!-- heading -->\n  <depend>a</depend>"),
        ("  <depend>a</depend>\n  <export/>\n\n  <depend>x</depend>", "  <depend>a</depend>\n  <export/>"),
    ],
)
def test_remove_takes_out_the_line_and_separating_blank_lines(body: str, expected: str) -> None:
    text = manifest_of(body)
    manifest = read(text)
    depend = next(depend for depend in manifest.depends if depend.name == "x")
    assert apply(text, [manifest_edits.remove(manifest, depend)]) == manifest_of(expected)


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("  <depend>a</depend>\n  <export/>", None),
        ("  <export/>\n  <depend>a</depend>", "  <depend>a</depend>\n  <export/>"),
        (
            "  <member_of_group>g</member_of_group>\n  <depend>a</depend>\n  <depend>b</depend>",
            "  <depend>a</depend>\n  <depend>b</depend>\n  <member_of_group>g</member_of_group>",
        ),
        (
            "  <author>a</author>\n\n  <depend>a</depend>\n  <depend>b</depend>\n\n"
            "  <url>u</url>\n  <url>v</url>\n\n  <test_depend>c</test_depend>",
            "  <url>u</url>\n  <url>v</url>\n"
            "  <author>a</author>\n\n  <depend>a</depend>\n  <depend>b</depend>\n\n  <test_depend>c</test_depend>",
        ),
        ('  <author>a</author>\n  <url type="website">u</url>', '  <url type="website">u</url>\n  <author>a</author>'),
        ("  <export/>\n  <depend>a</depend> <!-- why -->", None),
        ("  <export/>\n  <!-- for the tests -->\n  <depend>a</depend>", None),
        ("  <export/>\n  <depend>a<!-- inside --></depend>", None),
        ("  <author>a</author>\n  <url\n    type='website'>u</url>", None),
        (
            "  <author>a</author>\n  <author>b</author>\n  <author>c</author>\n  <author>d</author>\n\n"
            "  <url>1</url>\n  <url>2</url>\n  <url>3</url>",
            "  <url>1</url>\n  <url>2</url>\n  <url>3</url>\n  <author>a</author>\n  <author>b</author>\n"
            "  <author>c</author>\n  <author>d</author>",
        ),
    ],
)
def test_sort_moves_as_few_elements_as_possible(body: str, expected: str | None) -> None:
    text = manifest_of(body)
    assert apply(text, manifest_edits.sort(read(text))) == (text if expected is None else manifest_of(expected))


@pytest.mark.parametrize("seed", range(60))
def test_sort_moves_no_more_elements_than_needed(seed: int) -> None:
    """The elements that stay are a longest sequence of elements in the right order."""
    tags = ["author", "url", "depend", "member_of_group", "group_depend", "test_depend", "maintainer", "license"]
    random = Random(seed)
    chosen = [random.choice(tags) for _ in range(random.randint(1, 9))]
    text = "<package>\n" + "".join(f"  <{tag}>n{number}</{tag}>\n" for number, tag in enumerate(chosen)) + "</package>\n"
    changes = manifest_edits.sort(read(text))
    ends: list[int] = []  # the lowest last rank of the sequences of each length
    for rank in map(manifest_edits.schema_rank, chosen):
        at = bisect_right(ends, rank)
        ends[at : at + 1] = [rank]
    assert sum(bool(change.text) for change in changes) == len(chosen) - len(ends)
    edited = apply(text, changes)
    assert sorted(edited.splitlines()) == sorted(text.splitlines())
    moved = {change.text for change in changes}
    assert [line for line in edited.splitlines() if f"{line}\n" not in moved] == [
        line for line in text.splitlines() if f"{line}\n" not in moved
    ]


def test_names_are_escaped() -> None:
    text = manifest_of("  <depend/>\n  <exec_depend>a</exec_depend>")
    manifest = read(text)
    edit: Callable[..., Edit] = manifest_edits.rename
    assert "<depend>a&lt;b</depend>" in apply(text, [edit(manifest.depends[0], "a<b")])
    assert "<exec_depend>a&amp;b</exec_depend>" in apply(text, [edit(manifest.depends[1], "a&b")])
    assert "<test_depend></test_depend>" in apply(text, manifest_edits.change_tag(manifest.depends[0], "test_depend"))
