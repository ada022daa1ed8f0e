"""Write XML that every parser accepts: tags with escaped attributes, and escaped text."""

from __future__ import annotations

from html import escape

from ros_lint.reporters.ansi import Style, safe


def start(tag: str, **attributes: str | int) -> str:
    """Return a start tag. Characters that XML cannot represent become visible escapes, such as a backslash with a code."""
    return f"<{tag}{_attributes(attributes)}>"


def element(tag: str, **attributes: str | int) -> str:
    """Return an empty element, followed by a line feed."""
    return f"<{tag}{_attributes(attributes)}/>\n"


def text(value: str) -> str:
    """Return a text escaped for XML. It may have several lines."""
    return "\n".join(escape(_legal(line), quote=False) for line in value.split("\n"))


def _attributes(attributes: dict[str, str | int]) -> str:
    return "".join(f' {name}="{escape(_legal(str(value)))}"' for name, value in attributes.items())


def _legal(value: str) -> str:
    return "".join(f"\\u{ord(sign):04x}" if sign in "\ufffe\uffff" else sign for sign in safe(value, Style()))
