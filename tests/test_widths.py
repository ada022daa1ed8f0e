"""The table of character widths agrees with the version of Unicode that the running Python has."""

import unicodedata

import pytest

from ros_lint.reporters.ansi import glyph
from ros_lint.reporters.widths import columns


def expected(character: str) -> int | None:
    category = unicodedata.category(character)
    if category in ("Cc", "Cf", "Cs", "Zl", "Zp"):
        return None
    if category in ("Mn", "Me", "Mc") or "\u1160" <= character <= "\u11ff" or "\ud7b0" <= character <= "\ud7fb":
        return 0
    return 2 if unicodedata.east_asian_width(character) in "WF" else 1


def test_the_table_agrees_with_unicodedata() -> None:
    assigned = [c for c in map(chr, range(0x80, 0x110000)) if unicodedata.category(c) != "Cn"]
    odd = [c for c in assigned if columns(c) != expected(c)]
    version = tuple(map(int, unicodedata.unidata_version.split(".")))
    # Unicode 16 made a few signs wide that were narrow.
    assert not odd or (version >= (16,) and len(odd) < 200)


@pytest.mark.parametrize(
    ("character", "width"),
    [("é", 1), ("漢", 2), ("\u0301", 0), ("\U0001fae8", 2), ("\U0001e08f", 0), ("\U0001e030", 1), ("\U000323af", 2)],
)
def test_characters_that_are_new_in_unicode_15(character: str, width: int) -> None:
    """Python 3.11 knows Unicode 14."""
    assert glyph(character, False) == (character, width)


@pytest.mark.parametrize("character", ["\x00", "\x1b", "\x7f", "\x85", "\u202e", "\ufeff", "\udc80", "\U0001343f"])
def test_control_and_format_characters_are_escaped(character: str) -> None:
    assert glyph(character, False)[0].startswith("\\")
