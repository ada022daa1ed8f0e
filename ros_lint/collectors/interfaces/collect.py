"""Reader of interface definitions: .msg, .srv, .action and .idl."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from ros_lint.collectors.cpp.includes import blank_comments
from ros_lint.collectors.interfaces import lines
from ros_lint.facts.sources import FileFacts, Mention

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ros_lint.base.text import Text

# The type of another package is first in its line; it is followed by a bound, a name or a default.
_FIELD = re.compile(r"^[ \t]*([A-Za-z]\w*(?:/\w+)+)(?=[\[\s<])", re.MULTILINE)
_IDL_INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(["<])(\w+)/\w+/(\w+)\.idl[">]', re.MULTILINE)
_IDL_NAME = re.compile(r"\b([a-z]\w*)::(?:msg|srv|action)::(\w+)")
_IDL_STRING = re.compile(r'"(?:[^"\\\n]|\\.)*"')


def collect(source: Text) -> FileFacts:
    """Return the types of other packages that an interface file uses, as ``package/Type``.

    A .msg field has a type ``package/Type``. A type with more slashes is returned, too, although rosidl rejects it. An .idl
    file includes ``package/msg/Type.idl`` and uses ``package::msg::Type``, also for its own package.
    """
    if source.path.endswith(".idl"):
        return FileFacts(tuple(_idl(source)))
    matches = list(_FIELD.finditer(source.text))
    mentions: list[Mention] = []
    for match, span in zip(matches, source.spans([match.span(1) for match in matches]), strict=True):
        parts = match[1].split("/")
        mentions.append(Mention(f"{parts[0]}/{parts[-1]}", "interface", span, match[1]))
    return FileFacts(tuple(mentions), interface=lines.collect(source))


def _idl(source: Text) -> Iterable[Mention]:
    text = blank_comments(source.text)
    types = [(match.start(2), match.end(3) + 4, match[2], match[3]) for match in _IDL_INCLUDE.finditer(text)]
    bare = _IDL_STRING.sub(lambda string: " " * len(string[0]), text)
    types += [(match.start(), match.end(), match[1], match[2]) for match in _IDL_NAME.finditer(bare)]
    types.sort()
    spans = source.spans([(start, end) for start, end, _, _ in types])
    for (start, end, package, name), span in zip(types, spans, strict=True):
        yield Mention(f"{package}/{name}", "interface", span, source.text[start:end])
