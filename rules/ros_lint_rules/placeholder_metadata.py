"""
## What it finds

What `ros2 pkg create` writes into a new `package.xml` and nobody replaced: `TODO: License declaration`,
`TODO: Package description`, and maintainers whose address ends in `@todo.todo`; also `Your Name` and `you@example.com`.

## Why it matters

Without a licence nobody may use the package, and without an address nobody can report what is broken. Debian packages,
documentation and the ROS index repeat these texts.

## How to fix it

Write what is meant. For licences use the SPDX names, such as `Apache-2.0`, `BSD-3-Clause` or `MIT`.

## Limitations

For every text that somebody has written, however short.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ros_lint.api import Element, Finding, Package, Rule, Severity, Workspace

_TODO = re.compile(r"TODO\b.*|@?(?:LICENSE|DESCRIPTION)@?|FIXME\b.*", re.DOTALL)
_NOBODY = re.compile(r"TODO\b.*|your[ _]name", re.DOTALL | re.IGNORECASE)
_NO_ADDRESS = re.compile(r".*@todo\.todo|you@example\.(?:com|org)|your[._-]?(?:name|e?mail)@.*", re.IGNORECASE)
_INSTEAD = {"license": "name the licence, such as Apache-2.0", "description": "say what the package is for"}


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    manifest = package.manifest
    for element in manifest.elements if manifest else ():
        if element.tag in _INSTEAD and _TODO.fullmatch(element.text):
            yield Finding(_message(element, element.text, _INSTEAD[element.tag]), element.text_span, element.tag)
        elif element.tag == "maintainer":
            for text, template in ((element.get("email"), _NO_ADDRESS), (element.text, _NOBODY)):
                if template.fullmatch(text):
                    yield Finding(_message(element, text, "name who can be asked"), element.span, element.tag)
                    break


def _message(element: Element, text: str, way_out: str) -> str:
    shown = " ".join(text.split())
    return f'<{element.tag}> is still "{shown[:50]}"; {way_out}'


RULE = Rule(
    name="placeholder-metadata",
    code="ROS112",
    summary="licence, description and maintainer must not be those of the template",
    severity=Severity.INFO,
    since="0.1",
    doc=__doc__,
    package=check,
)
