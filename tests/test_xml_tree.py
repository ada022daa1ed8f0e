"""XML trees, compared with libxml2, which shares no code with expat."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree

from ros_lint.base.xml_tree import XmlElement, XmlError, attribute_places, parse

pytestmark = pytest.mark.slow

if TYPE_CHECKING:
    from hypothesis.strategies import DrawFn

_LETTERS = "abzAZ_é漢"
_NAMES = st.text(_LETTERS, min_size=1, max_size=3)
_GAPS = st.sampled_from((" ", "\n", "\r\n", "\t", "  \n "))
_PIECES = ("a", "é", "𝄞", " ", "\n", "\r\n", "\t", "&lt;", "&amp;", "&quot;", "&#65;", "&#x1D11E;", ">", "/", "=")
_VALUES = st.lists(st.sampled_from((*_PIECES, "'")), max_size=4).map("".join)
_ASIDES = st.sampled_from(("", "text", " \n", "<!-- <b x='1'> -->", "<![CDATA[<b x='1'>]]>", "<?b x='1'?>", "&amp;", "𝄞"))


@st.composite
def documents(draw: DrawFn) -> str:
    """Return the text of a well-formed document, some of which say which encoding they had."""
    opening = draw(st.sampled_from(("", "<?xml version='1.0'?>\n", '<?xml version="1.0" encoding="latin-1"?>', "<!-- é -->\r\n")))
    return opening + draw(elements(2)) + draw(st.sampled_from(("", "\n", "<!-- end -->")))


def elements(depth: int) -> st.SearchStrategy[str]:
    return st.composite(_element)(depth)


def _element(draw: DrawFn, depth: int) -> str:
    name = draw(_NAMES)
    attributes = draw(st.dictionaries(_NAMES, _VALUES, max_size=3))
    equals = draw(st.sampled_from(("=", " = ", "=\n")))
    written = "".join([f'{draw(_GAPS)}{key}{equals}"{value}"' for key, value in attributes.items()])
    start = f"<{name}{written}" + draw(st.sampled_from(("", " ", "\n")))
    children = draw(st.lists(elements(depth - 1), max_size=3)) if depth else []
    if not children and draw(st.booleans()):
        return f"{start}/>"
    return f"{start}>{''.join([draw(_ASIDES) + child for child in children])}{draw(_ASIDES)}</{name}>"


@given(documents())
def test_tags_attributes_and_lines_equal_those_of_libxml2(text: str) -> None:
    _agree(text, parse(text), _libxml2(text))


@given(documents(), st.data())
def test_documents_that_libxml2_rejects_are_rejected(text: str, data: st.DataObject) -> None:
    at = data.draw(st.integers(parse(text).start, len(text)))  # expat alone forgives slips in the XML declaration
    put = data.draw(st.sampled_from(("", "<", ">", "&", '"', "a", "/", "]]>", "<a>", "</a>")))
    damaged = text[:at] + put + text[at + data.draw(st.integers(0, 2)) :]
    try:
        expected = _libxml2(damaged)
    except etree.XMLSyntaxError:
        with pytest.raises(XmlError) as raised:
            parse(damaged)
        assert 0 <= raised.value.offset <= len(damaged)
    else:
        _agree(damaged, parse(damaged), expected)


def test_a_second_byte_order_mark_is_an_error() -> None:
    with pytest.raises(XmlError):
        parse("\ufeff<launch/>")  # the first one has been taken off with the encoding


def _libxml2(text: str) -> etree._Element:
    # The text is decoded already: an encoding that it claims is not asked.
    parser = etree.XMLParser(resolve_entities=False, no_network=True, encoding="utf-8", remove_comments=True, remove_pis=True)
    return etree.fromstring(text.encode(), parser)


def _agree(text: str, found: XmlElement, expected: etree._Element) -> None:
    assert found.tag == expected.tag
    assert found.attributes == dict(expected.attrib)
    assert text.startswith(f"<{found.tag}", found.start)
    places = attribute_places(text, found)
    assert list(places) == list(found.attributes)
    for name, (start, end) in places.items():
        assert text[start - 1] == text[end] == '"'
        assert etree.fromstring(f'<a x="{text[start:end]}"/>').get("x") == found.attributes[name]
    assert len(found.children) == len(expected)
    for child, other in zip(found.children, expected, strict=True):
        _agree(text, child, other)
