"""The encoding of facts: what is decoded equals what was encoded, and bytes of any kind create nothing else."""

from __future__ import annotations

import builtins
import pickle
import sys
from collections.abc import Callable, Iterator
from enum import Enum, Flag, IntEnum, auto
from importlib import import_module
from pkgutil import iter_modules
from typing import Any, Literal, NamedTuple, get_args

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from ros_lint import facts
from ros_lint.base import columns
from ros_lint.base.columns import Codec, DecodeError
from ros_lint.base.text import Span
from ros_lint.engine.report_cache import _CachedReport
from ros_lint.workspace.cache.facts import CachedFacts

Kind = Literal["a", "b"]


class Facet(Flag):
    ONE = auto()
    TWO = auto()


class Level(IntEnum):
    LOW = 1
    HIGH = 3


class Leaf(NamedTuple):
    text: str
    number: int = 0
    truth: bool = False
    data: bytes = b""
    kind: Kind = "a"


class Node(NamedTuple):
    leaf: Leaf
    optional: Leaf | None
    facets: Facet
    level: Level | None
    pairs: tuple[tuple[str, int], ...]
    texts: tuple[str, ...] | None
    children: tuple[Node, ...] = ()
    function: Callable[[Node], Iterator[Leaf]] | None = None


numbers = st.integers(-(1 << 63), (1 << 63) - 1) | st.integers(-2, 70_000)
texts = st.text(st.characters(exclude_categories=[]), max_size=5)
leaves = st.builds(Leaf, texts, numbers, st.booleans(), st.binary(max_size=4), st.sampled_from(get_args(Kind)))
nodes = st.recursive(
    st.builds(
        Node,
        leaves,
        st.none() | leaves,
        st.sampled_from([Facet(0), Facet.ONE, Facet.ONE | Facet.TWO]),
        st.none() | st.sampled_from(Level),
        st.lists(st.tuples(texts, numbers), max_size=3).map(tuple),
        st.none() | st.lists(texts, max_size=3).map(tuple),
        st.just(()),
        st.none(),
    ),
    lambda inner: st.builds(lambda node, children: node._replace(children=tuple(children)), inner, st.lists(inner, max_size=3)),
    max_leaves=8,
)
CODEC: Codec[Node] = Codec(Node)


@given(nodes)
@settings(max_examples=150, deadline=None)
def test_a_decoded_value_equals_the_encoded_one(node: Node) -> None:
    decoded = CODEC.decode(CODEC.encode(node))
    assert decoded == node
    assert repr(decoded) == repr(node)  # which contains the classes, too


NODE = Node(
    Leaf("\0\1 \ud800\U0001f600", -5, True, b"\n", "b"),
    Leaf("x", 1 << 40),
    Facet.ONE | Facet.TWO,
    Level.HIGH,
    (("\0", 3), ("y", 300)),
    ("x", "y"),
    tuple(Node(Leaf(str(n), n), None, Facet(0), None, (), None) for n in range(300)),
)


def types_in(value: object) -> Iterator[type]:
    yield type(value)
    if isinstance(value, tuple):
        for part in value:
            yield from types_in(part)


@given(st.data())
@settings(max_examples=300, deadline=None)
def test_damaged_bytes_create_only_facts(data: st.DataObject) -> None:
    encoded = bytearray(CODEC.encode(NODE))
    for _ in range(data.draw(st.integers(1, 4))):
        encoded[data.draw(st.integers(0, len(encoded) - 1))] = data.draw(st.integers(0, 255))
    cut = data.draw(st.integers(0, len(encoded)) | st.just(len(encoded)))
    try:
        decoded = CODEC.decode(bytes(encoded[:cut]))
    except DecodeError:
        return
    assert {*types_in(decoded)} <= {Node, Leaf, Facet, Level, tuple, str, int, bool, bytes, type(None)}


@given(st.binary(max_size=200))
@example(b"")
@example(pickle.dumps(NODE))
def test_foreign_bytes_are_rejected(data: bytes) -> None:
    with pytest.raises(DecodeError):
        CODEC.decode(data)


def test_few_bytes_do_not_create_many_values() -> None:
    codec: Codec[tuple[tuple[int, ...], ...]] = Codec(tuple[tuple[int, ...], ...])
    bomb = codec.encode(((7,) * 3,) * 3)
    amount, many = (3).to_bytes(8, "little"), (1 << 40).to_bytes(8, "little")
    assert bomb.count(amount) == 2
    with pytest.raises(DecodeError, match="too many values"):
        codec.decode(bomb.replace(amount, many))
    with pytest.raises(DecodeError, match="too many values"):
        codec.decode(bomb.replace(amount, (1 << 14).to_bytes(8, "little")).replace(many, amount))
    deep: Codec[Node] = Codec(Node)
    chain = NODE._replace(children=())
    for _ in range(200):
        chain = NODE._replace(children=(chain,))
    assert deep.decode(deep.encode(chain)) == chain


@pytest.mark.parametrize(
    "wrong",
    [
        NODE._replace(leaf=Leaf(5)),  # type: ignore[arg-type]
        NODE._replace(leaf=Leaf("", kind="c")),  # type: ignore[arg-type]
        NODE._replace(leaf=("a",)),
        NODE._replace(leaf=Leaf("", 1 << 70)),
        NODE._replace(function=print),
    ],
)
def test_values_of_another_type_are_not_encoded(wrong: Node) -> None:
    with pytest.raises((TypeError, ValueError, KeyError, OverflowError)):
        CODEC.encode(wrong)


@pytest.mark.parametrize("kind", [object, float, dict[str, int], list[int], str | int, Callable[[], int], builtins])
def test_other_types_have_no_codec(kind: Any) -> None:
    with pytest.raises(TypeError, match="no encoding"):
        Codec(kind)


def test_the_schema_changes_with_each_definition() -> None:
    def schema(name: str, kind: str, value: int) -> str:
        member = Enum("Member", {"A": value}, module=__name__)
        module = sys.modules[__name__]
        vars(module)["Member"] = member
        made = NamedTuple("Made", [(name, kind), ("member", "Member | None")])  # type: ignore[misc]  # noqa: F821
        made.__module__ = __name__
        return Codec(tuple[made, ...]).schema  # type: ignore[valid-type]

    schemas = [
        schema("a", "str", 1),
        schema("b", "str", 1),
        schema("a", "str | None", 1),
        schema("a", "Literal['a']", 1),
        schema("a", "Literal['a', 'b']", 1),
        schema("a", "tuple[str, ...]", 1),
        schema("a", "tuple[str, str]", 1),
        schema("a", "int", 1),
        schema("a", "str", 2),
    ]
    assert len(set(schemas)) == len(schemas)
    assert schema("a", "str", 1) == schemas[0]
    assert Codec(Node).schema == CODEC.schema


def test_all_cached_types_have_a_codec() -> None:
    described = Codec(CachedFacts).schema + Codec(_CachedReport).schema
    cached = {
        fact
        for module in iter_modules(facts.__path__, "ros_lint.facts.")
        for fact in vars(import_module(module.name)).values()
        if isinstance(fact, type) and f"'{fact.__module__}.{fact.__qualname__}'" in described
    }
    assert {"Mention", "LaunchAction", "FileFacts", "Opaque", "Facet", "UnclonedRepositories"} <= {f.__name__ for f in cached}
    assert Span.__name__ in described


def test_equal_integers_take_no_space_each() -> None:
    codec: Codec[tuple[int, ...]] = Codec(tuple[int, ...])
    sizes = [len(codec.encode((number,) * 1000)) for number in (0, 1 << 40)]
    assert sizes[0] == sizes[1] < 50
    assert [codec.decode(codec.encode((0, top))) for top in (255, 256, 65535, 65536, (1 << 32) - 1, 1 << 32)] == [
        (0, top) for top in (255, 256, 65535, 65536, (1 << 32) - 1, 1 << 32)
    ]
    assert columns._MOST_VALUES > 1_000_000
