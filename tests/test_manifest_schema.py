"""The verdict of the schemas of package.xml: that of xmllint with the published schemas."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest
from lxml import etree

from ros_lint.base.text import read
from ros_lint.collectors.manifest.collect import collect
from ros_lint.collectors.manifest.schema.named import named_schema
from ros_lint.collectors.manifest.schema.validate import MISPLACED, MOST_CHARACTERS, violations
from ros_lint_rules.manifest_schema import RULE
from tests.manifest_mutants import mutants
from tests.one_package import loaded

ROOT = Path(__file__).parent.parent
_PARTS = {
    "name": "<name>p</name>",
    "version": "<version>1.0.0</version>",
    "description": "<description>d</description>",
    "maintainer": '<maintainer email="a@b.cc">m</maintainer>',
    "license": "<license>MIT</license>",
    "rest": "",
}


def manifest(form: int, *parts: str) -> bytes:
    """Return a manifest. ``name=...`` replaces the element, ``format=...`` the attribute; other texts are the rest."""
    own = dict(_PARTS)
    attributes = f' format="{form}"'
    before = ""
    for part in parts:
        key, is_part, value = part.partition("=")
        if is_part and key in own:
            own[key] = value
        elif is_part and key == "format":
            attributes = value
        elif is_part and key == "before":
            before = value
        else:
            own["rest"] += part
    return f"{before}<package{attributes}>{''.join(own.values())}</package>".encode()


Row = tuple[int, tuple[str, ...], bool]
# As xmllint 2.9.14 reports it with the published schemas, of which ament_xmllint passes one.
TABLE: tuple[Row, ...] = (
    (1, (), True),
    (2, (), True),
    (3, (), True),
    (1, ("format=",), True),
    (2, ("format=",), False),
    (3, ("format=",), False),
    (3, ('format= format="2"',), False),
    (3, ('format= format="03"',), False),
    (3, ('format= format=" 3 "',), False),
    (3, ('format= format="3" x="1"',), False),
    (3, ('format= format="3" xml:lang="en"',), False),
    (3, ('format= format="3" xmlns="u"',), False),
    (3, ('format= format="3" xmlns:u="u"',), True),
    (3, ('format= format="3" xmlns:x="http://www.w3.org/2001/XMLSchema-instance" x:noNamespaceSchemaLocation="a.xsd"',), True),
    (3, ("before=<!-- c -->",), True),
    (3, ("before=<!DOCTYPE package>",), True),
    (3, ('before=<?xml version="1.0" encoding="utf-8"?>',), True),
    (3, ("name=<name>a_1</name>",), True),
    (3, ("name=<name> a </name>",), True),
    (3, ("name=<name>A</name>",), False),
    (3, ("name=<name>a-b</name>",), False),
    (3, ("name=<name>a__b</name>",), False),
    (3, ("name=<name>a_</name>",), False),
    (3, ("name=<name>1a</name>",), False),
    (3, ("name=<name>a<!-- c -->b</name>",), True),
    (3, ("name=<name><![CDATA[a]]></name>",), True),
    (3, ("name=<name>a<b/></name>",), False),
    (3, ("name=",), False),
    (3, ("version=<version>01.0.0</version>",), False),
    (3, ("version=<version>1.0</version>",), False),
    (3, ("version=<version>1-0-0</version>",), True),
    (3, ("version=<version>0.0.0</version>",), True),
    (3, ('version=<version compatibility="1.0.0">1.0.0</version>',), False),
    (2, ('version=<version compatibility="1.0.0">1.0.0</version>',), False),
    (3, ("description=<description/>",), True),
    (3, ("description=<description>a <b x='1'>b</b></description>",), True),
    (3, ("description=<description brief='a'>b</description>",), False),
    (3, ("description=<description/><description/>",), False),
    (3, ("maintainer=<maintainer>m</maintainer>",), False),
    (3, ('maintainer=<maintainer email="a@b">m</maintainer>',), False),
    (3, ('maintainer=<maintainer email=" a@b.cc ">m</maintainer>',), True),
    (3, ('maintainer=<maintainer email="a@b.cc"/><maintainer email="c@d.ee"/>',), True),
    (3, ("license=<license/>",), True),
    (3, ("license=<license>MIT</license><license>BSD</license>",), True),
    (3, ('license=<license file="LICENSE">MIT</license>',), True),
    (2, ('license=<license file="LICENSE">MIT</license>',), False),
    (3, ("license=",), False),
    (3, ("<url/>",), True),
    (3, ("<url>https://a.example/b c</url>",), True),
    (3, ("<url>https://a.example:port</url>",), False),
    (3, ("<url>::</url>",), False),
    (3, ('<url type=" website ">a</url>',), True),
    (3, ('<url type="bugtracker">a</url>', '<url type="repository">a</url>'), True),
    (3, ('<url type="homepage">a</url>',), False),
    (3, ("<author>a</author>", "<url>a</url>"), False),
    (3, ('<author email="a@b.cc">a</author>', "<author>b</author>"), True),
    (3, ('<author email="">a</author>',), False),
    (3, ("<depend>a</depend>", "<author>a</author>"), False),
    (3, ("<test_depend>a</test_depend>", "<depend>b</depend>", "<conflict>c</conflict>", "<replace>d</replace>"), True),
    (3, ("<run_depend>a</run_depend>",), False),
    (2, ("<run_depend>a</run_depend>",), False),
    (1, ("<run_depend>a</run_depend>",), True),
    (1, ("<exec_depend>a</exec_depend>",), False),
    (1, ("<depend>a</depend>",), False),
    (2, ("<doc_depend>a</doc_depend>",), True),
    (3, ('<depend version_gte="1" version_lt="1.2" version_eq="1.2.3">a</depend>',), True),
    (3, ('<depend version_gte="1x2">a</depend>',), True),
    (3, ('<depend version_gte="01">a</depend>',), False),
    (3, ('<depend version_gte="1.2.3.4">a</depend>',), False),
    (3, ('<depend version="1">a</depend>',), False),
    (3, ('<depend condition="">a</depend>',), True),
    (3, ("<depend condition='$A == \"b\"'>a</depend>",), True),
    (3, ('<depend condition="$A == 1.0">a</depend>',), False),
    (3, ('<depend condition="$A == b, c">a</depend>',), False),
    (2, ('<depend condition="$A == b">a</depend>',), False),
    (3, ('<depend xmlns="u">a</depend>',), False),
    (3, ('<depend xmlns:u="u" u:v="w">a</depend>',), False),
    (3, ("<group_depend>g</group_depend>", "<member_of_group>h</member_of_group>"), True),
    (3, ("<member_of_group>h</member_of_group>", "<group_depend>g</group_depend>"), False),
    (3, ("<member_of_group>h</member_of_group>", "<depend>a</depend>"), False),
    (3, ('<member_of_group condition="$A == b">h</member_of_group>',), True),
    (3, ("<member_of_group condition=\"$A == 'b'\">h</member_of_group>",), False),
    (2, ("<member_of_group>h</member_of_group>",), False),
    (3, ("<export/>",), True),
    (3, ("<export><a b='c'>d<e/></a><!-- f --></export>",), True),
    (3, ("<export>text<a/></export>",), False),
    (3, ("<export x='1'/>",), False),
    (3, ("<export/>", "<export/>"), False),
    (3, ("<export/>", "<depend>a</depend>"), False),
    (3, ("text",), False),
    (3, ("<![CDATA[ ]]>",), False),
    (3, ("&#32;",), True),
    (3, ("&#160;",), False),
    (3, ("<?pi x?>",), True),
    (3, ("<unknown/>",), False),
)


@pytest.mark.parametrize(("form", "parts", "valid"), TABLE, ids=lambda value: str(value)[:60])
def test_the_verdict_is_that_of_xmllint(form: int, parts: tuple[str, ...], valid: bool) -> None:
    assert (violations(read("package.xml", manifest(form, *parts)), form) == ()) == valid


@pytest.mark.skipif("ROS_LINT_SCHEMAS" not in os.environ, reason="no folder with the published schemas given")
def test_mutants_have_the_verdict_of_the_published_schemas() -> None:
    folder = os.environ.get("ROS_LINT_SCHEMAS", "")
    published = {form: etree.XMLSchema(etree.parse(f"{folder}/package_format{form}.xsd")) for form in (1, 2, 3)}
    texts = [manifest(form, *parts) for form, parts, _ in TABLE]
    checked = 0
    for data in (*texts, *mutants(1, 4000)):
        for form, schema in published.items():
            found = violations(read("package.xml", data), form)
            if found is None or any(not violation.kind for violation in found):
                continue  # it is not for the schema to decide
            # Invalid addresses of namespaces do not matter to xmllint.
            root = etree.fromstring(data, etree.XMLParser(strip_cdata=False, resolve_entities=False, recover=True))
            assert (found == ()) == schema.validate(root), data
            checked += 1
    assert checked > 5000


def test_the_rule_explains_exactly_the_manifests_that_are_invalid() -> None:
    expected = reported = 0
    for data in mutants(2, 400):
        facts = collect(read("package.xml", data))
        if facts.problems:
            continue
        workspace = loaded({"package.xml": "<package/>"})
        (package, *_) = (*workspace.packages, *workspace.unusable)
        findings = list(RULE.package(package._replace(manifest=facts), workspace)) if RULE.package else []
        named = named_schema(read("package.xml", data))
        invalid = bool(violations(read("package.xml", data), facts.format)) or bool(named and named.format != facts.format)
        assert bool(findings) == invalid, data
        assert all("\n" not in finding.message and finding.span.path == "package.xml" for finding in findings)
        expected += invalid
        reported += len(findings)
    assert reported >= expected > 30


def test_what_follows_a_misplaced_element_is_checked() -> None:
    data = manifest(3, "<author>a</author>", '<url type="x">a</url>', '<depend version_gte="x">a</depend>', "<export>t</export>")
    found = violations(read("package.xml", data), 3) or ()
    assert [(violation.kind == MISPLACED, violation.child, violation.attribute) for violation in found] == [
        (True, 6, ""),
        (False, 6, "type"),
        (False, 7, "version_gte"),
        (False, 8, ""),
    ]


def test_thousands_of_violations_take_linear_time() -> None:
    data = manifest(3, *['<depend version_gt="x"/>'] * 2000, *["<url>::</url><author/>"] * 1500)
    started = time.process_time()
    found = violations(read("package.xml", data), 3) or ()
    assert time.process_time() - started < 3  # seconds; quadratic time takes ten times as long
    assert len(found) == 2000 + 1500
    assert [violation.child for violation in found] == [*range(5, 2005), *range(2005, 5005, 2)]


_DEEP = b"<a>" * 300 + b"</a>" * 300
_LAUGHS = '<!DOCTYPE package [<!ENTITY a "ha">' + "".join(f'<!ENTITY a{n} "&a;&a;">' for n in range(9)) + "]>"


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\0",
        b"<package>",
        manifest(3).replace(b"<name>p", b"<name>\0p"),
        manifest(3, "<export>").replace(b"</package>", _DEEP + b"</export></package>"),
        manifest(3, f"before={_LAUGHS}"),
        manifest(3, 'before=<!DOCTYPE package [<!ENTITY f SYSTEM "file:///etc/passwd">]>', "&f;"),
        manifest(3).replace(b"<name>p", b"<name>\xff"),
        manifest(3).decode().encode("utf-16"),
        manifest(3).decode().encode("utf-16-le"),
        manifest(3, "<depend/>" * (MOST_CHARACTERS // 9)),
    ],
    ids=range(11),
)
def test_what_is_not_safe_or_not_xml_is_not_checked(data: bytes) -> None:
    assert violations(read("package.xml", data), 3) is None


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b'<?xml version="1.0" encoding="x-none"?>' + manifest(3), "ncod"),
        (b'\xef\xbb\xbf<?xml version="1.0" encoding="utf-16"?>' + manifest(3), "contradicts the byte order mark"),
        (b'\xef\xbb\xbf<?xml version="1.0" encoding="x-none"?>' + manifest(3), "contradicts the byte order mark"),
    ],
)
def test_an_encoding_that_xmllint_cannot_read_is_a_violation(data: bytes, message: str) -> None:
    found = violations(read("package.xml", data), 3) or ()
    assert [(violation.kind, violation.child) for violation in found] == [("", -1)]
    assert message in found[0].message


@pytest.mark.parametrize(
    "data",
    [
        b"\xef\xbb\xbf" + manifest(3),
        b'\xef\xbb\xbf<?xml version="1.0" encoding="utf-8"?>' + manifest(3),
        b'<?xml version="1.0" encoding="iso-8859-1"?>' + manifest(3).replace(b"MIT", b"\xc3\xbc"),
        manifest(3).replace(b"><", b">\r\n<"),
        manifest(3, 'before=<!DOCTYPE package SYSTEM "http://127.0.0.1:9/p.dtd">'),
        manifest(3, "<depend xmlns:a='&lt;'>a</depend>"),
    ],
    ids=range(6),
)
def test_harmless_peculiarities_are_valid(data: bytes) -> None:
    assert violations(read("package.xml", data), 3) == ()


_MODEL = (
    '<?xml-model href="http://download.ros.org/schema/package_format{}.xsd" schematypens="http://www.w3.org/2001/XMLSchema"?>'
)


@pytest.mark.parametrize(
    ("before", "attributes", "named"),
    [
        ("", "", None),
        (_MODEL.format(2), "", 2),
        (_MODEL.format(2) + _MODEL.format(3), "", 3),
        (_MODEL.format(4), "", None),
        (_MODEL.format(3) + _MODEL.format(3).replace("ros.org", "robots.example"), "", None),
        (_MODEL.format(3).replace('"', "'").replace(" ", "\n "), "", 3),
        (_MODEL.format(3).replace("http://www.w3.org/2001/XMLSchema", "http://relaxng.org/ns/structure/1.0"), "", None),
        (_MODEL.format(3).split(" schematypens")[0] + "?>", "", None),
        (f"<!-- {_MODEL.format(3)} -->", "", None),
        (_MODEL.format(2), ' xsi:noNamespaceSchemaLocation="http://download.ros.org/schema/package_format1.xsd"', 1),
        (_MODEL.format(2), ' xsi:noNamespaceSchemaLocation="a.xsd"', None),
    ],
)
def test_the_named_schema_is_that_of_ament_xmllint(before: str, attributes: str, named: int | None) -> None:
    instance = ' xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"' if attributes else ""
    source = read("package.xml", manifest(3, f"before={before}", f'format= format="3"{instance}{attributes}'))
    found = named_schema(source)
    assert (found.format if found else None) == named
    assert found is None or source.slice(found.span) == str(named)


def test_the_schemas_are_files_of_the_package_and_are_read_once() -> None:
    code = (
        "from ros_lint.collectors.manifest.schema import validate\n"
        "from lxml import etree\n"
        "from ros_lint.base.text import read\n"
        "made = []\n"
        "schema = etree.XMLSchema\n"
        "etree.XMLSchema = lambda tree: made.append(tree) or schema(tree)\n"
        "for _ in range(3): validate.violations(read('package.xml', b'<package/>'), 3)\n"
        "print(len(made))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "1\n"
    folder = ROOT / "ros_lint" / "collectors" / "manifest" / "schema"
    assert {path.name for path in folder.glob("*.xsd")} == {"common.xsd", "format1.xsd", "format2.xsd", "format3.xsd"}


@pytest.mark.parametrize(
    "command", ["order", "explain-package p", "rules", "check --ignore manifest-schema", "check --select ROS2"]
)
def test_lxml_is_imported_only_by_the_rule(tmp_path: Path, command: str) -> None:
    (tmp_path / "package.xml").write_bytes(manifest(3, "<export><build_type>ament_cmake</build_type></export>"))
    (tmp_path / "CMakeLists.txt").write_text("project(p)\nfind_package(ament_cmake REQUIRED)\nament_package()\n")
    code = (
        "import sys\nfrom ros_lint.cli.main import main\ntry:\n    main(sys.argv[1:])\nexcept SystemExit:\n    pass\n"
        "assert 'lxml' not in sys.modules"
    )
    arguments = [*command.split(), *(["--no-cache"] if command.startswith("check") else [])]
    subprocess.run([sys.executable, "-c", code, *arguments], capture_output=True, cwd=tmp_path, check=True)
