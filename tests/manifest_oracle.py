"""A manifest as catkin_pkg reads it and as ros-lint reads it, and generated manifests to compare them."""

from __future__ import annotations

import html
import io
import re
import warnings
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from catkin_pkg.package import InvalidPackage, Package, parse_package_string

from ros_lint.base.text import read
from ros_lint.collectors.manifest import conditions
from ros_lint.collectors.manifest.collect import collect
from ros_lint.facts.manifest import Manifest

CONTEXTS = (
    {},
    {"ROS_VERSION": "2", "ROS_DISTRO": "jazzy", "ROS_PYTHON_VERSION": "3"},
    {"ROS_VERSION": "1", "ROS_DISTRO": "noetic", "ROS_PYTHON_VERSION": "2", "DISABLE_GROUPS_WORKAROUND": "1"},
)
KINDS = {
    "build_depend": ["build_depends"],
    "buildtool_depend": ["buildtool_depends"],
    "build_export_depend": ["build_export_depends"],
    "buildtool_export_depend": ["buildtool_export_depends"],
    "exec_depend": ["exec_depends"],
    "test_depend": ["test_depends"],
    "doc_depend": ["doc_depends"],
    "run_depend": ["build_export_depends", "exec_depends"],
    "depend": ["build_depends", "build_export_depends", "exec_depends"],
    "conflict": ["conflicts"],
    "replace": ["replaces"],
    "group_depend": ["group_depends"],
    "member_of_group": ["member_of_groups"],
}
VERSIONS = ("version_lt", "version_lte", "version_eq", "version_gte", "version_gt")


class Verdict(NamedTuple):
    """The result of a reader. All fields but ``accepted`` are empty for a rejected manifest."""

    accepted: bool
    name: str = ""
    version: str = ""
    form: int = 0
    evaluated: tuple[object, ...] = ()
    """For each context: "no condition parses" or the build type and all active dependencies, by kind."""


def by_catkin_pkg(data: bytes) -> Verdict:
    """Return the manifest as ``parse_package`` reads it: UTF-8, universal line ends."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # catkin_pkg uses old names of pyparsing
        package = _parsed(data)
        if package is None:
            return Verdict(False)
        result = tuple(_catkin_evaluated(package, context) for context in CONTEXTS)
    return Verdict(True, package.name, package.version, package.package_format, result)


def catkin_pkg_accepts(data: bytes) -> bool:
    """Return whether catkin_pkg accepts the manifest. Conditions are not evaluated, which takes most of the time."""
    return _parsed(data) is not None


def _parsed(data: bytes) -> Package | None:
    try:
        text = io.TextIOWrapper(io.BytesIO(data), encoding="utf8").read()
        return parse_package_string(text, warnings=[])
    except (InvalidPackage, AssertionError, ValueError):
        return None


def _catkin_evaluated(package: Package, context: Mapping[str, str]) -> object:
    try:
        package.evaluate_conditions(context)
    except ValueError:
        return "a condition does not parse"
    try:
        build_type = package.get_build_type()
        if "<" not in build_type:
            build_type = html.unescape(build_type)  # minidom gives markup, we give the text
    except InvalidPackage:
        build_type = "two build types"
    kinds = {
        kind: sorted(
            (depend.name, *(str(getattr(depend, name, None)) for name in VERSIONS))
            for depend in getattr(package, kind)
            if depend.evaluated_condition
        )
        for kinds in KINDS.values()
        for kind in kinds
    }
    return build_type, kinds


def by_ros_lint(data: bytes) -> Verdict:
    manifest = collect(read("package.xml", data))
    if manifest.problems:
        return Verdict(False)
    result = tuple(_evaluated(manifest, context) for context in CONTEXTS)
    return Verdict(True, manifest.name, manifest.version, manifest.format, result)


class _Complete(dict):
    """A context in which, as in catkin_pkg, every variable has a value."""

    def get(self, name: str, default: object = None) -> str:
        return super().get(name, "")


def _evaluated(manifest: Manifest, context: Mapping[str, str]) -> object:
    context = _Complete(context)
    if conditions.problems(manifest):
        return "a condition does not parse"
    types = conditions.build_types(manifest, context)
    build_type = "catkin" if not types else types[0][0] if len(types) == 1 else "two build types"
    kinds: dict[str, list[object]] = {kind: [] for kinds in KINDS.values() for kind in kinds}
    for depend in manifest.depends:
        if conditions.truth(depend.condition, context):
            versions = dict(depend.versions)
            for kind in KINDS[depend.tag]:
                kinds[kind].append((depend.name, *(str(versions.get(name)) for name in VERSIONS)))
    return build_type, {kind: sorted(result) for kind, result in kinds.items()}


SEEDS = (
    """<?xml version="1.0"?>
<?xml-model href="http://download.ros.org/schema/package_format3.xsd" schematypens="http://www.w3.org/2001/XMLSchema"?>
<package format="3">
  <name>talker</name>
  <version>1.2.3</version>
  <description>Says <b>things</b> &amp; more.</description>
  <maintainer email="a@example.org">A. Nobody</maintainer>
  <license file="LICENSE">Apache-2.0</license>
  <url type="website">https://example.org</url>
  <author email="b@example.org">B.</author>

  <buildtool_depend>ament_cmake</buildtool_depend>
  <!-- the messages -->
  <depend version_gte="1.0.0" condition="$ROS_VERSION == 2">std_msgs</depend>  <!-- why -->
  <depend condition="$ROS_VERSION == 1 or $ROS_DISTRO &lt; humble">roscpp</depend>
  <build_depend>eigen</build_depend>
  <build_export_depend>eigen</build_export_depend>
  <exec_depend>rclpy</exec_depend>
  <test_depend>ament_lint_auto</test_depend>
  <doc_depend>doxygen</doc_depend>
  <conflict>listener</conflict>
  <replace version_lt="1.0.0">talkers</replace>
  <group_depend>rmw_implementation_packages</group_depend>
  <member_of_group condition="$ROS_DISTRO != 'foxy'">rosidl_interface_packages</member_of_group>
  <export>
    <build_type condition="$ROS_VERSION == 1">catkin</build_type>
    <build_type condition="$ROS_VERSION == 2">ament_cmake</build_type>
    <other plugin="${prefix}/plugin.xml"/>
  </export>
</package>
""",
    """<package format="2">
\t<name>old-style</name>
\t<version compatibility="0.1.0">0.1.0</version>
\t<description><![CDATA[All <in> one]]></description>
\t<maintainer email="a.b+c@x.example.org">Ünï</maintainer>
\t<license>BSD</license>
\t<license>MIT</license>
\t<depend>rclcpp</depend>
\t<exec_depend>rclpy</exec_depend>
\t<test_depend>rclcpp</test_depend>
\t<buildtool_export_depend>ament_cmake</buildtool_export_depend>
\t<export><build_type>ament_python</build_type></export>
</package>
""",
    """<package><name>Ancient</name><version>0.0.01</version><description>d</description>
<maintainer email="a@b.cc">m</maintainer><license>l</license><buildtool_depend>catkin</buildtool_depend>
<build_depend>roscpp</build_depend><run_depend>roscpp</run_depend><test_depend>rostest</test_depend>
<export><metapackage/></export></package>
""",
)

_TAGS = (
    *KINDS,
    *("name", "version", "description", "maintainer", "license", "url", "author", "export", "build_type", "Depend", "x:depend"),
)
_ATTRIBUTES = (
    *("email", "format", "condition", "type", "file", "compatibility", "x:y", "xml:lang", "xmlns", "xmlns:x"),
    *VERSIONS,
)
_VALUES = (
    *("", " ", "1", "2", "3", "03", " 3 ", "4", "1.0", "1.2.3", "01.2.3", "1.2.3rc1", "a@b", "a@b.cc", "talker", "rclcpp"),
    *("std_msgs", "ament_cmake", "ament_python", "$ROS_VERSION == 2", "$ROS_VERSION"),
    *("$ROS_DISTRO == jazzy and ($A == b or $ROS_VERSION &gt; 1)", "&lt;", "&#97;", "&#x20;", "&#x6A;", "&nbsp;", "\u00a0"),
    *("é\u4e2d\U0001f600", "a b", "a\n  b", "\r\n", "\t", "0.0.0\u0660", "-x", "Talker_2"),
)
_FRAGMENTS = (
    *("<!-- c -->", "<![CDATA[x]]>", "<![CDATA[]]>", "<?pi x?>", "<b>x</b>", "<br/>", "text", "&amp;", "&", "<", ">", "]]>"),
    *("\x01", "\n\n", "<depend>rclcpp</depend>", "<exec_depend>std_msgs</exec_depend>", "<test_depend>talker</test_depend>"),
    *("<depend/>", "</package>", "<build_type>ament_cargo</build_type>", "<export/>", "<license> </license>", "\ufeff"),
    *("<<<<<<< HEAD\n", "=======\n", ">>>>>>> x\n", '<depend xmlns="u">rclcpp</depend>', "<a><a><a>x</a></a></a>"),
    '<x:depend xmlns:x="u">a</x:depend>',
)
_ELEMENT = re.compile(r"<(\w+)(?:\s[^<>]*)?>[^<>]*</\1>|<\w+/>")
_NAME = re.compile(r"(?<=</)[\w:]+|(?<=<)[\w:]+")
_ATTRIBUTE = re.compile(r""" [\w:]+="[^"]*\"""")
_VALUE = re.compile(r"""(?<=")[^"<>]*(?=")|(?<=>)[^<>]*(?=</)""")

Op = tuple[int, int, int]
"""Indexes of the mutation, its place and its content, modulo the number of choices."""


def mutate(seed: int, ops: Sequence[Op], encoding: int = 0) -> bytes:
    """Return a seed after some mutations. The same arguments give the same bytes."""
    return mutate_text(SEEDS[seed % len(SEEDS)], ops, encoding)


def mutate_text(text: str, ops: Sequence[Op], encoding: int = 0) -> bytes:
    for op, where, what in ops:
        text = _MUTATIONS[op % len(_MUTATIONS)](text, where, what)
    if encoding % 12 == 1:
        text = text.replace("\n", "\r\n")
    elif encoding % 12 == 2:
        text = text.replace("\n", "\r")
    elif encoding % 12 == 3:
        text = text.replace("\n", " ")
    elif encoding % 12 in (4, 5):
        text = re.sub(r"\A<\?xml [^?]*\?>|\A", '<?xml version="1.0" encoding="iso-8859-1"?>', text, count=1)
    codec = {4: "iso-8859-1", 6: "utf-8-sig", 7: "utf-16", 8: "utf-16-le", 9: "cp1252"}.get(encoding % 12, "utf-8")
    return text.encode(codec, "replace")


def _places(pattern: re.Pattern[str], text: str) -> list[tuple[int, int]]:
    return [match.span() for match in pattern.finditer(text)] or [(0, 0)]


def _pick(pattern: re.Pattern[str], text: str, where: int) -> tuple[int, int]:
    places = _places(pattern, text)
    return places[where % len(places)]


def _remove_element(text: str, where: int, _: int) -> str:
    start, end = _pick(_ELEMENT, text, where)
    return text[:start] + text[end:]


def _copy_element(text: str, where: int, what: int) -> str:
    start, end = _pick(_ELEMENT, text, where)
    at = _pick(_ELEMENT, text, what)[what % 2]
    return text[:at] + text[start:end] + text[at:]


def _rename_element(text: str, where: int, what: int) -> str:
    start, end = _pick(_ELEMENT, text, where)
    tag = _TAGS[what % len(_TAGS)]
    return text[:start] + _NAME.sub(tag, text[start:end]) + text[end:]


def _rename_tag(text: str, where: int, what: int) -> str:
    start, end = _pick(_NAME, text, where)
    return text[:start] + _TAGS[what % len(_TAGS)] + text[end:]


def _remove_attribute(text: str, where: int, _: int) -> str:
    start, end = _pick(_ATTRIBUTE, text, where)
    return text[:start] + text[end:]


def _add_attribute(text: str, where: int, what: int) -> str:
    _, end = _pick(re.compile(r"<[\w:]+"), text, where)
    name, value = _ATTRIBUTES[what % len(_ATTRIBUTES)], _VALUES[what // len(_ATTRIBUTES) % len(_VALUES)]
    quote = "'" if what % 3 == 0 and "'" not in value else '"'
    return f"{text[:end]}{chr(10) if what % 5 == 0 else ' '}{name} = {quote}{value}{quote}{text[end:]}"


def _change_value(text: str, where: int, what: int) -> str:
    start, end = _pick(_VALUE, text, where)
    return text[:start] + _VALUES[what % len(_VALUES)] + text[end:]


def _insert_fragment(text: str, where: int, what: int) -> str:
    at = _pick(re.compile(r"(?<=>)|(?=<)"), text, where)[0]
    return text[:at] + _FRAGMENTS[what % len(_FRAGMENTS)] + text[at:]


def _truncate(text: str, where: int, what: int) -> str:
    at = where % (len(text) + 1)
    return text[:at] if what % 3 else text[:at] + text[at + 1 + what % 40 :]


_MUTATIONS = (
    _remove_element,
    _copy_element,
    _rename_element,
    _rename_tag,
    _remove_attribute,
    _add_attribute,
    _change_value,
    _change_value,
    _add_attribute,
    _insert_fragment,
    _truncate,
)


def differences(data: bytes) -> Iterator[str]:
    """Return the differences between the two readers."""
    ours, theirs = by_ros_lint(data), by_catkin_pkg(data)
    for name, our, their in zip(Verdict._fields, ours, theirs, strict=True):
        if our != their:
            yield f"{name}: ros-lint {our!r}, catkin_pkg {their!r}"
