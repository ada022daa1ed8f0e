"""
## What it finds

Placeholders that `ros2 pkg create` writes into a new `package.xml`: `TODO: License declaration`, `TODO: Package description`,
and maintainer addresses that end in `@todo.todo`; also `Your Name` and `you@example.com`.

## Why it matters

Without a licence, others are not allowed to use the package; without an address, users cannot report bugs. Debian packages,
documentation and the ROS index show the placeholders.

## How to fix it

Write the real licence, description and maintainer. For licences use the SPDX names, such as `Apache-2.0`, `BSD-3-Clause` or
`MIT`.

## Limitations

Any other text is accepted, however short.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ros_lint.api import Element, Finding, Package, Rule, Severity, Workspace

_TODO = re.compile(r"TODO\b.*|@?(?:LICENSE|DESCRIPTION)@?|FIXME\b.*", re.DOTALL)
_NO_NAME = re.compile(r"TODO\b.*|your[ _]name", re.DOTALL | re.IGNORECASE)
_NO_ADDRESS = re.compile(r".*@todo\.todo|you@example\.(?:com|org)|your[._-]?(?:name|e?mail)@.*", re.IGNORECASE)
_REMEDIES = {"license": "name the licence, e.g. Apache-2.0", "description": "describe the package"}


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    manifest = package.manifest
    for element in manifest.elements if manifest else ():
        if element.tag in _REMEDIES and _TODO.fullmatch(element.text):
            yield Finding(_message(element, element.text, _REMEDIES[element.tag]), element.text_span, element.tag)
        elif element.tag == "maintainer":
            for text, template in ((element.get("email"), _NO_ADDRESS), (element.text, _NO_NAME)):
                if template.fullmatch(text):
                    yield Finding(_message(element, text, "name a real maintainer"), element.span, element.tag)
                    break


def _message(element: Element, text: str, remedy: str) -> str:
    shown = " ".join(text.split())
    return f"<{element.tag}> is still the placeholder '{shown[:50]}'; {remedy}"


RULE = Rule(
    name="placeholder-metadata",
    code="ROS112",
    summary="licence, description and maintainer are not placeholders",
    severity=Severity.INFO,
    since="0.1",
    doc=__doc__,
    package=check,
)
