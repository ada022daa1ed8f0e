import pytest
from hypothesis import given
from hypothesis import strategies as st

from ros_lint.base.text import Span, Text, decode, read, span_in

TEXTS = st.text(st.sampled_from("ab \t\r\n\f\u2028é漢\U0001f916"), max_size=40)


@given(TEXTS, st.data())
def test_offset_and_position_are_inverse(text: str, data: st.DataObject) -> None:
    source = Text("f", text)
    offset = data.draw(st.integers(0, len(text)))
    line, column = source.position(offset)
    assert source.offset(line, column) == offset
    assert source.slice(source.span(offset, len(text))) == text[offset:]


@given(TEXTS)
def test_lines_are_those_of_universal_newlines(text: str) -> None:
    source = Text("f", text)
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    assert [source.line(number) for number in range(1, source.line_count + 1)] == lines


@given(TEXTS, st.lists(st.integers(0, 39), max_size=6))
def test_spans_of_many_ranges_equal_the_span_of_each_range(text: str, places: list[int]) -> None:
    source = Text("f", text)
    ranges = [
        (place, place) for place in sorted(places) if place <= len(text) and not (place and text[place - 1 : place + 1] == "\r\n")
    ]
    assert list(source.spans(ranges)) == [source.span(*entry) for entry in ranges]


@given(TEXTS, st.lists(st.integers(0, 40), min_size=4, max_size=4))
def test_a_span_covers_another_if_its_offsets_do(text: str, offsets: list[int]) -> None:
    source = Text("f", text)
    a, b, c, d = (min(offset, len(text)) for offset in offsets)
    one, other = (min(a, b), max(a, b)), (min(c, d), max(c, d))
    assert source.span(*one).covers(source.span(*other)) is (one[0] <= other[0] and other[1] <= one[1])
    assert not source.span(*one).covers(source.span(*one)._replace(path="g"))


def test_a_call_covers_itself_and_its_arguments_only() -> None:
    call = Span("CMakeLists.txt", 3, 1, 4, 20)
    assert call.covers(call)
    assert call.covers(Span("CMakeLists.txt", 4, 3, 4, 19))
    assert not call.covers(Span("CMakeLists.txt", 4, 3, 4, 21))
    assert not call.covers(Span("CMakeLists.txt", 2, 30, 4, 3))


BEGINNINGS = (b"\xef\xbb\xbf", b"\xff\xfe", b"\xfe\xff", b"<\0", b"\0<", b"# coding: utf-16\n", b'<?xml encoding="utf-8"?>')


@given(
    st.binary(max_size=60)
    | TEXTS.map(lambda text: text.encode("utf-8", "surrogateescape"))
    | st.builds(bytes.__add__, st.sampled_from(BEGINNINGS), st.binary(max_size=9))
)
def test_decoding_and_encoding_keeps_all_bytes(data: bytes) -> None:
    text = read("f", data)
    assert text.encode(text.text) == data


@pytest.mark.parametrize(
    ("data", "text", "codec"),
    [
        (b"\xef\xbb\xbfa", "a", "utf-8-sig"),
        ("é".encode("utf-16"), "é", "utf-16"),
        (b"\xfe\xff\x00\xe9", "\ufeffé", "utf-16-be"),
        (b"\xfe\xff", "\ufeff", "utf-16-be"),
        (b"\xff\xfe\xff\xfe", "\ufeff", "utf-16"),
        (b'<?xml version="1.0" encoding="ISO-8859-1"?>\xe9', '<?xml version="1.0" encoding="ISO-8859-1"?>é', "iso8859-1"),
        (b"# -*- coding: latin-1 -*-\n\xe9", "# -*- coding: latin-1 -*-\né", "iso8859-1"),
        (b'<?xml version="1.0" encoding="no-such"?>\xe9', '<?xml version="1.0" encoding="no-such"?>\udce9', "utf-8"),
        (b"\xff\xfe\x00", "\udcff\udcfe\x00", "utf-8"),
    ],
)
def test_the_encoding_is_detected(data: bytes, text: str, codec: str) -> None:
    assert decode(data) == (text, codec)


def test_a_span_in_bytes_equals_the_span_in_the_text() -> None:
    text = Text("a.cpp", "# ä\nä ö word ß\nlast")
    data = text.text.encode()
    for word in ("ä ö", "word", "ß", "last"):
        at, start = data.index(word.encode()), text.text.index(word)
        assert span_in("a.cpp", data, at, at + len(word.encode())) == text.span(start, start + len(word))


@pytest.mark.parametrize(
    ("written", "found"), [('"robot"', "robot"), ("robot", "robot"), ("[[robot]]", None), ("'robots'", None), ("rob\not", None)]
)
def test_the_inner_span_of_a_text_is_within_its_quotes(written: str, found: str | None) -> None:
    text = Text("setup.py", f"name={written}")
    place = text.span(5, 5 + len(written)).inner("robot")
    assert (text.slice(place) if place else None) == found
