"""Mutators: from the bytes of a real file to bytes that are not written by hand."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from random import Random
from typing import Final, NamedTuple

MOST_BYTES: Final = 200_000
"""A mutated file is cut here, so that many inputs fit into a minute. Larger files are hostile seeds."""

ODD: Final = (
    b"\0", b"\xff", b"\xc3", b"\xef\xbb\xbf", b"\xff\xfe", b"\r", b"\r\n", b"\x0b", b"\x0c", b"\x1b[31m", b"\x85", "\u2028".encode(),
    "\u202e".encode(), "\u2066".encode(), "\U000e0001".encode(), b"\xed\xb2\x80", b"\\", b"'", b'"', b'"""', b"'''", b"`", b"$", b"${",
    b"$(", b"$ENV{", b"$<", b"@", b"%", b"%(", b"{", b"}", b"{{", b"[", b"]", b"[[", b"]]", b"(", b")", b"<", b">", b"</", b"/>", b"<!--",
    b"-->", b"<![CDATA[", b"]]>", b"<?", b"&", b"&amp;", b"&#0;", b"&x;", b"#", b"#[[", b"//", b"/*", b"*/", b"---", b"- ", b"? ", b": ",
    b"&a ", b"*a", b"!!python/object:os.system ", b"|", b">", b"~", b"!", b"*", b"**", b"?", b"[a-z]", b"[z-a]", b"[!", b"..", b"../", b"/",
    b"//", b"\n", b"\n\n", b"\t", b" ", b";", b",", b"=", b"==", b"0", b"-1", b"1e999", b"nan", b"0x", b"99999999999999999999", b"\\ud800",
    b"\\x00", b"\\N{BELL}", b"\\u202e", b"f'{x}'", b"lambda: ", b"not ", b"-", b"yield ", b"await ", b"*x, ", b"x := ",
)  # fmt: skip
"""Pieces that end, open or escape something in one of the formats."""

_WORD: Final = re.compile(rb"[A-Za-z_][A-Za-z_0-9.-]*")
_NUMBER: Final = re.compile(rb"\d+")


class Material(NamedTuple):
    """What mutators take pieces from."""

    others: Sequence[bytes]
    """Contents of other files of the same format."""
    words: Sequence[bytes]
    """Words that mean something in the format."""


Mutator = Callable[[Random, bytes, Material], bytes]


def _place(random: Random, content: bytes) -> int:
    return random.randrange(len(content) + 1)


def _range(random: Random, content: bytes, most: int = 200) -> tuple[int, int]:
    start = _place(random, content)
    return start, min(len(content), start + random.randrange(1, most))


def flip(random: Random, content: bytes, _: Material) -> bytes:
    data = bytearray(content)
    for _number in range(random.choice((1, 1, 2, 8))):
        if data:
            data[random.randrange(len(data))] ^= 1 << random.randrange(8)
    return bytes(data)


def insert_odd(random: Random, content: bytes, _: Material) -> bytes:
    at = _place(random, content)
    return content[:at] + random.choice(ODD) * random.choice((1, 1, 1, 2, 3, 300)) + content[at:]


def delete(random: Random, content: bytes, _: Material) -> bytes:
    start, end = _range(random, content)
    return content[:start] + content[end:]


def truncate(random: Random, content: bytes, _: Material) -> bytes:
    return content[: _place(random, content)]


def repeat(random: Random, content: bytes, _: Material) -> bytes:
    start, end = _range(random, content, 60)
    return content[:start] + content[start:end] * random.choice((2, 2, 3, 10, 200)) + content[end:]


def nest(random: Random, content: bytes, _: Material) -> bytes:
    """Repeat the part before a place and, in the same number, the part after it, as brackets and tags do."""
    start, end = _range(random, content, 40)
    after = min(len(content), end + random.randrange(1, 40))
    times = random.choice((2, 5, 50, 300))
    return content[:start] + content[start:end] * times + content[end:after] * times + content[after:]


def splice(random: Random, content: bytes, material: Material) -> bytes:
    other = random.choice(material.others) if material.others else b""
    start, end = _range(random, other, 2_000)
    at = _place(random, content)
    return content[:at] + other[start:end] + content[random.choice((at, _place(random, content))) :]


def _lines(content: bytes) -> list[bytes]:
    return content.splitlines(keepends=True) or [b""]


def swap_lines(random: Random, content: bytes, _: Material) -> bytes:
    lines = _lines(content)
    first, second = random.randrange(len(lines)), random.randrange(len(lines))
    lines[first], lines[second] = lines[second], lines[first]
    return b"".join(lines)


def repeat_line(random: Random, content: bytes, _: Material) -> bytes:
    lines = _lines(content)
    at = random.randrange(len(lines))
    lines[at:at] = [lines[at]] * random.choice((1, 1, 2, 20))
    return b"".join(lines)


def delete_line(random: Random, content: bytes, _: Material) -> bytes:
    lines = _lines(content)
    del lines[random.randrange(len(lines))]
    return b"".join(lines)


def insert_line(random: Random, content: bytes, material: Material) -> bytes:
    lines = _lines(content)
    other = _lines(random.choice(material.others)) if material.others else lines
    lines.insert(random.randrange(len(lines) + 1), random.choice(other))
    return b"".join(lines)


def indent(random: Random, content: bytes, _: Material) -> bytes:
    lines = _lines(content)
    at = random.randrange(len(lines))
    lines[at] = random.choice((b" ", b"\t", b"    ", b"\xc2\xa0")) + lines[at]
    return b"".join(lines)


def replace_word(random: Random, content: bytes, material: Material) -> bytes:
    """Replace one or all occurrences of a word by another word of the file or of the format."""
    words = _WORD.findall(content)
    if not words:
        return content
    old = random.choice(words)
    new = random.choice((*material.words, random.choice(words), b"", old * 50, old.upper()))
    return content.replace(old, new, random.choice((1, -1)))


def replace_number(random: Random, content: bytes, _: Material) -> bytes:
    numbers = list(_NUMBER.finditer(content))
    if not numbers:
        return content
    match = random.choice(numbers)
    new = random.choice((b"0", b"-1", b"1e999", b"9" * 30, b"9" * 5000, b"0x" + b"f" * 40, b"", b"1.2.3.4.5", b"\xd9\xa1"))
    return content[: match.start()] + new + content[match.end() :]


def line_ends(random: Random, content: bytes, _: Material) -> bytes:
    return content.replace(b"\n", random.choice((b"\r\n", b"\r", b"\n\r", b"", b" \\\n")))


def encode(random: Random, content: bytes, _: Material) -> bytes:
    text = content.decode("utf-8", "replace")
    return text.encode(random.choice(("utf-16", "utf-16-be", "utf-32", "latin-1", "utf-8-sig", "utf-7")), "replace")


MUTATORS: Final[tuple[Mutator, ...]] = (
    flip, insert_odd, insert_odd, delete, truncate, repeat, nest, splice, splice, swap_lines, repeat_line, delete_line, insert_line,
    insert_line, indent, replace_word, replace_word, replace_word, replace_number, line_ends, encode,
)  # fmt: skip


def mutate(random: Random, content: bytes, material: Material) -> bytes:
    """Return the content after one or more mutations."""
    for _ in range(random.choice((1, 1, 1, 2, 2, 3, 5, 12))):
        content = random.choice(MUTATORS)(random, content, material)[:MOST_BYTES]
    return content
