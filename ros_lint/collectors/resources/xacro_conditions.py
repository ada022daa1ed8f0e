"""Parts of xacro files that are left out unless an argument is passed.

xacro evaluates ``<xacro:if value="$(arg use_sim)">`` with the default of ``<xacro:arg name="use_sim" default="false"/>``
(xacro/__init__.py, ``get_boolean_value``).
"""

from __future__ import annotations

import re

_ARGUMENT = re.compile(r"<xacro:arg\s[^<>]*>")
_ATTRIBUTE = re.compile(r"""\s(name|default|value)\s*=\s*["']([^"'<>]*)["']""")
_CONDITION = re.compile(r"<(/?)xacro:(if|unless)\b([^<>]*)>")
_VALUE = re.compile(r"\$\(arg\s+([\w.-]+)\s*\)")
_FALSE = frozenset({"false", "False", "0"})
_TRUE = frozenset({"true", "True", "1"})


def inactive_ranges(text: str) -> tuple[range, ...]:
    """Return the offsets of the blocks whose condition is false with the defaults of the arguments in the same file.

    Only conditions that consist of one argument are evaluated: ``value="$(arg use_sim)"``.
    """
    if "<xacro:arg" not in text:
        return ()
    attributes = [dict(_ATTRIBUTE.findall(match[0])) for match in _ARGUMENT.finditer(text)]
    defaults = {found.get("name", ""): found.get("default", "") for found in attributes}
    result: list[range] = []
    openings: list[tuple[int, bool]] = []
    for match in _CONDITION.finditer(text):
        if match[1]:
            start, inactive = openings.pop() if openings else (0, False)
            if inactive:
                result.append(range(start, match.start()))
        elif not match[3].endswith("/"):
            value = _VALUE.fullmatch(dict(_ATTRIBUTE.findall(match[3])).get("value", "").strip())
            excluding = _FALSE if match[2] == "if" else _TRUE
            openings.append((match.end(), value is not None and defaults.get(value[1], "") in excluding))
    return tuple(result)
