"""Manifests that the schemas of package.xml accept or reject for many reasons: seeded mutants."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from random import Random

from tests.manifest_oracle import SEEDS, mutate

_TEXTS = (
    *("text", "<a/>", '<a xmlns="u"/>', "<!-- c -->", "<![CDATA[x]]>", "<![CDATA[ ]]>", "<?pi x?>", "&#32;", "&#160;"),
    *(" ", "&amp;"),
)
_CONDITIONS = (
    *("$A == b", "$ROS_VERSION==1", "a.b", "", " ", "\t", "$A == 'x'", "é", "a,b", "a-b", "a/b", "(a)", "a and b", "a\nb", "{a}"),
    *("&lt;", "a;b", "&quot;a&quot;", "x &amp; y"),
)
_VERSIONS = (
    *("1", "1.2", "1.2.3", "01.2", "1.02.3", "1.2.3.4", "v1", "1x2", "1.2.", "10000", "1..2", " 1.2.3 ", "1. 2", "", "0", "00"),
    *("1-2-3", "9" * 30, "1.2.3rc1", "+1.0.0"),
)
_VALUES = {
    "name": ("a", "A", "a_b", "a__b", "_a", "a_", "a-b", "a1", "1a", "a.b", "é", "a b", " a ", "", "a_1_b", "aB"),
    "version": _VERSIONS,
    "url": ("http://a", "http://[x", "http://a/%zz", "a b", "::", "", "é", "http://a:x", "{a}", "1:", "//", "http://a?b#c#d"),
}
_ATTRIBUTES = (
    *('xml:lang="en"', 'x="1"', 'condition="a"', 'file="L"', 'compatibility="1.2"', 'xmlns:q="u" q:z="1"', 'version_gte="1"'),
    *('xmlns="u"', 'type="website"', 'type="Website"', 'type=" website "', 'type=""', 'email="a@b.cc"', 'email="a@b.c1"'),
    *('email=" a@b.cc "', 'email=".a@b.cc"', 'xsi:nil="true" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'),
)
_PACKAGES = (
    *("<package>", '<package format="1">', '<package format="2">', '<package format="3">', '<package format=" 3 ">'),
    *('<package format="03">', '<package format="3" xmlns="u">', "<package format='3'>"),
)
_BEFORE = (
    *("<!DOCTYPE package>", '<!DOCTYPE package SYSTEM "p.dtd">', '<!DOCTYPE package [<!ENTITY e "x">]>', "<!-- c -->"),
    '<!DOCTYPE package [<!ATTLIST package format CDATA "3">]>',
)
_ENCODINGS = ("utf-8", "UTF-8", "utf8", "iso-8859-1", "windows-1252", "ascii", "utf-16", "x-none")
_ELEMENT = re.compile(r"[ \t]*<(\w+)(?:\s[^<>]*)?>[^<>]*</\1>\n?|<\w+/>")


def mutants(seed: int, count: int) -> Iterator[bytes]:
    """Yield manifests, always the same for a seed."""
    random = Random(seed)
    for number in range(count):
        if number % 3 == 0:
            steps = range(random.randrange(1, 4))
            ops = [(random.randrange(100), random.randrange(1000), random.randrange(10000)) for _ in steps]
            yield mutate(random.randrange(3), ops, random.randrange(12))
            continue
        text = random.choice(SEEDS)
        for _ in range(random.randrange(1, 4)):
            text = random.choice(_STEPS)(random, text)
        yield text.encode(random.choice(("utf-8",) * 12 + ("utf-8-sig", "utf-16-le", "iso-8859-1")), "replace")


def _move(random: Random, text: str) -> str:
    elements = list(_ELEMENT.finditer(text))
    if len(elements) < 2:
        return text
    moved = random.choice(elements)
    rest = text[: moved.start()] + text[moved.end() :]
    at = random.choice(list(_ELEMENT.finditer(rest))).span()[random.randrange(2)]
    return rest[:at] + moved[0] + rest[at:]


def _copy(random: Random, text: str) -> str:
    copied = random.choice(list(_ELEMENT.finditer(text)))
    return text[: copied.start()] + copied[0] + text[copied.start() :]


def _remove(random: Random, text: str) -> str:
    removed = random.choice(list(_ELEMENT.finditer(text)))
    return text[: removed.start()] + text[removed.end() :]


def _insert(pattern: str, texts: Sequence[str]) -> Callable[[Random, str], str]:
    """Return the mutation that inserts a text after a match."""

    def mutation(random: Random, text: str) -> str:
        ends = [match.end() for match in re.finditer(pattern, text)]
        at = random.choice(ends) if ends else 0
        return text[:at] + random.choice(texts) + text[at:]

    return mutation


def _replace(pattern: str, texts: Sequence[str]) -> Callable[[Random, str], str]:
    """Return the mutation that replaces the first match."""
    return lambda random, text: re.sub(pattern, lambda _: random.choice(texts), text, count=1, flags=re.DOTALL)


_LIMITS = [f' version_{kind}="{version}"' for kind in ("lt", "lte", "eq", "gte", "gt") for version in _VERSIONS]
_STEPS = (
    *(_move, _move, _copy, _remove),
    _insert(">", _TEXTS),
    _insert(r"<(\w*depend|member_of_group|build_type|author)\b", [f' condition="{condition}"' for condition in _CONDITIONS]),
    _insert(r"<(\w*depend|conflict|replace)\b", _LIMITS),
    _insert(r"<\w+", [f" {attribute}" for attribute in _ATTRIBUTES]),
    _insert(r"<\?xml [^>]*\?>\n?", _BEFORE),
    _replace("<package[^>]*>", _PACKAGES),
    _replace(r"\A<\?xml [^>]*\?>|\A", [f'<?xml version="1.0" encoding="{encoding}"?>' for encoding in _ENCODINGS]),
    *(
        _replace(rf"<{tag}\b[^>]*>.*?</{tag}>", [f"<{tag}>{value}</{tag}>" for value in values])
        for tag, values in _VALUES.items()
    ),
)
