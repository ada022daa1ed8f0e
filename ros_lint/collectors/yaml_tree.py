"""YAML as a tree of nodes with exact places. No object is made from it."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from ros_lint.text import Text

if TYPE_CHECKING:
    import yaml


_DEEPEST: Final = 1_000
_LONGEST_FOR_PYTHON: Final = 50_000
"""How many characters are read by the library's own Python code, which is slow."""
_BRACKETS: Final = re.compile(r"[\[\]{}]")


class YamlError(Exception):
    """The text is not YAML that can be read. ``offset`` is from 0 to the length of the text."""

    def __init__(self, message: str, offset: int) -> None:
        super().__init__(message)
        self.message: Final = message
        self.offset: Final = offset


def compose(source: Text) -> yaml.Node | None:
    """Return the root node of the only document, None when there is none. Raises YamlError.

    The marks of the nodes count characters of the text. Refused is what launch and colcon refuse, which read with the
    library's Python code: that takes no tab within a plain text, and a "?" in brackets for a key, where libyaml does not.
    """
    import yaml  # noqa: PLC0415  (takes 20 ms to import)

    deep = _too_deep(source.text)
    if deep is not None:
        raise YamlError("nested too deeply", deep)
    told_apart = len(source.text) <= _LONGEST_FOR_PYTHON and ("\t" in source.text or "?" in source.text)
    loader = yaml.SafeLoader if told_apart else getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    try:
        return yaml.compose(source.text, Loader=loader)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        raise YamlError(error.problem or error.context or "not YAML", _offset(source, mark)) from None
    except yaml.YAMLError as error:
        raise YamlError(str(error).partition("\n")[0], 0) from None
    except (UnicodeError, RecursionError):
        raise YamlError("not text that YAML allows, or nested too deeply", 0) from None


def _too_deep(text: str) -> int | None:
    """Return where brackets are nested so deeply that the library takes seconds, None where that is nowhere."""
    if text.count("[") + text.count("{") <= _DEEPEST:
        return None
    depth = 0
    for match in _BRACKETS.finditer(text):
        depth += 1 if match[0] in "[{" else -1
        if depth > _DEEPEST:
            return match.start()
    return None


def _offset(source: Text, mark: yaml.Mark | None) -> int:
    return min(mark.index, len(source.text)) if mark is not None else 0
