"""
## What it finds

A `package.xml` that `catkin_pkg` accepts but that violates the XML schemas of REP 127, 140 and 149:

- Elements in the wrong order.
- `url type` other than `website`, `bugtracker` and `repository`.
- Versions with leading zeros.
- Package names with anything but lower-case letters, digits and single underscores.
- Text between the elements of `<package>`.

No schema is downloaded.

## Why it matters

Build tools do not check the schema. `ament_xmllint`, a part of `ament_lint_common`, does so for manifests that name the schema
in an `<?xml-model ...?>` line: the tests of the package fail.

## How to fix it

Follow the message. The fix sorts the elements: name, version, description, maintainer, license, url, author, dependencies,
group_depend, member_of_group, export.

## Limitations

- The rule is off by default.
- XML namespaces and text in `<export>` are not checked.
- There is no fix if an element to be moved has a comment, shares its line with another element, or is a description or an export.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ros_lint.api import Depend, Element, Finding, Fix, Manifest, Package, Rule, Severity, Span, Workspace, edits

_NAME = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")
_VERSION = re.compile(r"(0|[1-9][0-9]*)(\.(0|[1-9][0-9]*)){2}")
_LIMIT = re.compile(r"(0|[1-9][0-9]*)(\.(0|[1-9][0-9]*)){0,2}")
_CONDITION = re.compile(r"""[$A-Za-z0-9_\s"'<>!=()-]*""")
_GROUP_CONDITION = re.compile(r"[$A-Za-z0-9_\s<>!=()-]*")
_URLS = ("website", "bugtracker", "repository")


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    manifest = package.manifest
    if manifest is None or manifest.problems:
        return
    yield from _order(manifest)
    yield from _text_between(manifest)
    for element in manifest.elements:
        yield from _element(element)
    for depend in manifest.depends:
        yield from _depend(depend)
    if manifest.format > 1 and manifest.format_span is None:
        yield _finding(f'format {manifest.format} must be written as format="{manifest.format}"', manifest.name_span, "format")


def _order(manifest: Manifest) -> Iterator[Finding]:
    children: list[Element | Depend] = sorted((*manifest.elements, *manifest.depends), key=lambda child: child.span)
    highest = children[0]
    for child in children:
        if edits.manifest.schema_rank(child.tag) < edits.manifest.schema_rank(highest.tag):
            fix = Fix.of("sort the elements", *edits.manifest.sort(manifest))
            message = f"<{child.tag}> after <{highest.tag}> violates the schema; move it before <{highest.tag}>"
            yield _finding(message, child.span, "order")._replace(fix=fix)
            return
        highest = child


def _text_between(manifest: Manifest) -> Iterator[Finding]:
    for span in manifest.strays:
        yield _finding("the schema allows no text between elements; remove it", span, "text")


def _element(element: Element) -> Iterator[Finding]:
    text, place = element.text, element.text_span
    if element.tag == "name" and not _NAME.fullmatch(text):
        message = f"the schema allows only lower-case letters, digits and single underscores in '{text}'; rename the package"
        yield _finding(message, place, "name")
    elif element.tag == "version":
        if not _VERSION.fullmatch(text):
            yield _finding(f"the schema allows no leading zeros in version {text}; remove them", place, "version")
        if (compatibility := element.get("compatibility")) and not _LIMIT.fullmatch(compatibility):
            message = f"the schema allows no leading zeros in compatibility {compatibility}; remove them"
            yield _finding(message, element.span, "version")
    elif element.tag == "url" and element.get("type", "website") not in _URLS:
        message = f'url type "{element.get("type")}" is not in the schema; write website, bugtracker or repository'
        yield _finding(message, element.span, "url")


def _depend(depend: Depend) -> Iterator[Finding]:
    for attribute, limit in depend.versions:
        if not _LIMIT.fullmatch(limit):
            message = f'{attribute}="{limit}" violates the schema, which requires the form 1.2.3; write numbers and dots'
            yield _finding(message, depend.span, depend.name)
    grouped = depend.tag in ("group_depend", "member_of_group")
    if not (_GROUP_CONDITION if grouped else _CONDITION).fullmatch(depend.condition):
        quotes = " without quotes" if grouped else ""
        message = f"condition {depend.condition} contains a character that the schema does not allow; use only words{quotes}"
        yield _finding(message, depend.span, depend.name)


def _finding(message: str, span: Span, subject: str) -> Finding:
    return Finding(message, span, subject)


RULE = Rule(
    name="manifest-schema",
    code="ROS111",
    summary="manifests are valid by the schema of their format",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    default=False,
    fixable=True,
    package=check,
)
