"""Read YAML of unknown origin safely. This is the only module that calls the library PyYAML.

Two kinds of text are rejected before a node or an object is created. libyaml recurses for each level of nesting, so a
text of 100 KB could overflow the stack and end the process. A few aliases can expand to any number of values.
"""

from __future__ import annotations

import re
from functools import cache
from typing import TYPE_CHECKING, Any, Final, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    import yaml

_Result = TypeVar("_Result")

DEEPEST: Final = 100
"""Maximum nesting of lists and mappings. Published workspaces have up to 27 levels."""
_MOST_REPEATED: Final = 200_000
"""Maximum number of values that aliases repeat in a text, including the values within repeated values."""
_MOST_BITS: Final = 4_096
"""Maximum size of an integer in bits. Python does not convert integers of more than 4,300 digits to text."""
_LONGEST_FOR_PYTHON: Final = 50_000
"""Maximum length in characters of a text that is read with PyYAML's pure Python code, which is slow."""
_LIMIT_OF_LIBRARY: Final = "exceeded maximum nesting depth"
"""Error message of libyaml for nesting deeper than its own limit of 1,000 levels."""
_LEADING: Final = re.compile(r"^[ \t?:-]+", re.MULTILINE)


class YamlError(Exception):
    """The text is not YAML, or a value in it cannot be constructed. ``offset`` is the offset of the error in the text."""

    def __init__(self, message: str, offset: int = 0) -> None:
        super().__init__(message)
        self.message: Final = message
        self.offset: Final = offset


class YamlBoundError(YamlError):
    """The text exceeds a limit of this module. It may be valid YAML."""


def compose(text: str) -> yaml.Node | None:
    """Return the root node of a text with at most one document, None if there is no document. Raises YamlError.

    The positions in the nodes count characters of the text. launch and colcon read YAML with PyYAML's pure Python code,
    which rejects a tab within plain text and reads "?" in brackets as a key marker; libyaml does neither. Therefore a
    text with a tab or a "?" is read with the pure Python code, unless the text is very long.
    """
    strict = len(text) <= _LONGEST_FOR_PYTHON and ("\t" in text or "?" in text)
    return _read(text, _loader(fast=not strict), _root)


def load(text: str) -> Any:
    """Return a text with at most one document as Python values, None if there is no document. Raises YamlError."""
    return _read(text, _loader(fast=True), _value)


def scalar(node: yaml.ScalarNode) -> Any:
    """Return the Python value of a scalar node, such as 5 for the node ``5``. Raises YamlError."""
    return _read("", _loader(fast=True), lambda loader, _: loader.construct_object(node))


def tokens(text: str) -> list[tuple[int, int]]:
    """Return pairs of the start and end offset of each token of a text, in order. Raises YamlError."""
    import yaml  # noqa: PLC0415

    text = _bounded(text)
    try:
        return [(token.start_mark.index, token.end_mark.index) for token in yaml.scan(text, Loader=_loader(fast=True))]
    except (yaml.YAMLError, UnicodeError) as error:
        raise _as_yaml_error(error, len(text)) from None


def events(text: str) -> list[yaml.Event]:
    """Return the events of a text, in which aliases are replaced by the events of the value that they repeat.

    Each replaced alias follows as an AliasEvent after the repeated events. Unlike :func:`compose`, this reads several
    documents. Raises YamlError.
    """
    import yaml  # noqa: PLC0415

    result: list[yaml.Event] = []
    anchored: dict[str, tuple[int, int]] = {}
    open_anchors: list[tuple[str | None, int]] = []
    text = _bounded(text)
    try:
        for event in yaml.parse(text, Loader=_loader(fast=True)):
            start = len(result)
            if isinstance(event, yaml.AliasEvent):
                if event.anchor not in anchored:
                    raise YamlError(f"found undefined alias '{event.anchor}'", _start(event))
                first, end = anchored[event.anchor]
                if start + end - first > _MOST_REPEATED:
                    raise YamlBoundError(f"aliases repeat more than {_MOST_REPEATED:,} values", _start(event))
                result += result[first:end]
            result.append(event)
            if isinstance(event, yaml.CollectionStartEvent):
                open_anchors.append((event.anchor, start))
            elif isinstance(event, yaml.ScalarEvent) and event.anchor:
                anchored[event.anchor] = start, len(result)
            elif isinstance(event, yaml.CollectionEndEvent):
                anchor, first = open_anchors.pop()
                if anchor:
                    anchored[anchor] = first, len(result)
    except (yaml.YAMLError, UnicodeError) as error:
        raise _as_yaml_error(error, len(text)) from None
    return result


@cache
def _loader(*, fast: bool) -> Any:
    """Return a subclass of PyYAML's safe loader class that limits the size of integers.

    Its base class is the loader in C if ``fast`` is True and PyYAML has the loader in C, otherwise the loader in Python.
    """
    import yaml  # noqa: PLC0415

    class LimitedLoader(getattr(yaml, "CSafeLoader", yaml.SafeLoader) if fast else yaml.SafeLoader):  # type: ignore[misc]
        """A YAML loader that limits the size of integers.

        It is a subclass, because a constructor added to PyYAML's class would affect all other code that uses PyYAML.
        """

    def integer(loader: Any, node: yaml.ScalarNode) -> int:
        value: int = loader.construct_yaml_int(node)
        if value.bit_length() > _MOST_BITS:
            raise YamlBoundError(f"an integer of more than {_MOST_BITS:,} bits", _start(node))
        return value

    LimitedLoader.add_constructor("tag:yaml.org,2002:int", integer)
    return LimitedLoader


def _read(text: str, kind: Any, take: Callable[[Any, str], _Result]) -> _Result:
    """Return ``take(loader, text)``, where ``loader`` is an instance of the class ``kind`` for the text.

    Raises YamlError for every error of PyYAML.
    """
    text = _bounded(text)
    loader = None
    try:
        loader = kind(text)
        return take(loader, text)
    except YamlError:
        raise
    except Exception as error:  # a tag on a value of the wrong type makes the library raise any exception
        raise _as_yaml_error(error, len(text)) from None
    finally:
        if loader is not None:
            loader.dispose()


def _root(loader: Any, text: str) -> yaml.Node | None:
    node: yaml.Node | None = loader.get_single_node()
    if node is not None and "*" in text and "&" in text:
        _check_aliases(node)
    return node


def _value(loader: Any, text: str) -> Any:
    node = _root(loader, text)
    return None if node is None else loader.construct_document(node)


def _as_yaml_error(error: Exception, length: int) -> YamlError:
    import yaml  # noqa: PLC0415

    if isinstance(error, yaml.MarkedYAMLError):
        mark = error.problem_mark or error.context_mark
        offset = min(mark.index, length) if mark is not None else 0
        return YamlError(error.problem or error.context or "not YAML", offset)
    if isinstance(error, yaml.YAMLError):
        return YamlError(str(error).partition("\n")[0])
    if isinstance(error, UnicodeError):
        return YamlError("not text that YAML allows")
    return YamlError(f"a value that cannot be constructed ({type(error).__name__})")


def _bounded(text: str) -> str:
    """Return the text as a plain ``str``, because PyYAML rejects subclasses of ``str``.

    Raises YamlBoundError if lists and mappings in the text nest more deeply than DEEPEST.
    """
    import yaml  # noqa: PLC0415

    text = str(text)  # the library rejects subclasses
    # Brackets nest, and so do indented lines: a column has at most a mapping and a list.
    widest = max(map(len, _LEADING.findall(text)), default=0)
    if text.count("[") + text.count("{") + 2 * (widest + 2) <= DEEPEST:
        return text
    depth = 0
    opening = (yaml.SequenceStartEvent, yaml.MappingStartEvent)
    try:
        for event in yaml.parse(text, Loader=_loader(fast=True)):  # not recursive
            if isinstance(event, opening):
                depth += 1
                if depth > DEEPEST:
                    raise YamlBoundError(f"nested more than {DEEPEST} levels deep", _start(event))
            elif isinstance(event, yaml.CollectionEndEvent):
                depth -= 1
    except (yaml.YAMLError, UnicodeError) as error:
        # libyaml scans ahead of its events, and the one in PyYAML 6.0.4 and later has a limit of its own.
        if isinstance(error, yaml.MarkedYAMLError) and error.problem == _LIMIT_OF_LIBRARY:
            raise YamlBoundError(f"nested more than {DEEPEST} levels deep", _as_yaml_error(error, len(text)).offset) from None
    return text  # reading the text raises every other error again


def _check_aliases(root: yaml.Node) -> None:
    """Raise YamlBoundError if aliases below the node ``root`` repeat too many values, or if a value contains itself."""
    sizes: dict[int, int] = {}
    waiting: list[tuple[yaml.Node, bool]] = [(root, False)]
    entered: set[int] = set()
    while waiting:
        node, finished = waiting.pop()
        key = id(node)
        if finished:
            sizes[key] = 1 + sum(sizes[id(inner)] for inner in _within(node))
            if sizes[key] - len(sizes) > _MOST_REPEATED:
                raise YamlBoundError(f"aliases repeat more than {_MOST_REPEATED:,} values", _start(node))
        elif key not in sizes:
            if key in entered:
                raise YamlBoundError("a value contains itself through an alias", _start(node))
            entered.add(key)
            waiting.append((node, True))
            waiting += [(inner, False) for inner in _within(node)]


def _start(node: yaml.Node | yaml.Event) -> int:
    return node.start_mark.index if node.start_mark is not None else 0


def _within(node: yaml.Node) -> Iterator[yaml.Node]:
    """Yield the direct children of a node."""
    if isinstance(node.value, list):
        for item in node.value:
            if isinstance(item, tuple):
                yield from item
            else:
                yield item
