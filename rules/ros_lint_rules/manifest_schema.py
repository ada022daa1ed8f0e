"""
## What it finds

What the XML schemas of REP 127, 140 and 149 want of a `package.xml` beyond what `catkin_pkg` asks for: the order of the
elements, `url type` out of `website`, `bugtracker` and `repository`, versions without leading zeros, names of small
letters, digits and single underscores, and nothing but elements in `<package>`. The rules are restated
here; no schema is downloaded.

## Why it matters

Build tools do not look at the schema. `ament_xmllint`, which is part of `ament_lint_common`, does for manifests that name
it in an `<?xml-model ...?>` line, and then the tests of the package fail.

## How to fix it

As the message says. The fix brings the elements into the order name, version, description, maintainer, license, url,
author, dependencies, group_depend, member_of_group, export.

## Limitations

This rule is off unless it is asked for. It does not look at XML namespaces and at text in `<export>`. It has no fix when
an element would have to move that has a comment, shares its line with another one, or is a description or an export.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ros_lint.api import Depend, Element, Finding, Fix, Manifest, Package, Rule, Severity, Span, Workspace, manifest_edits

_NAME = re.compile(r"[a-z](_?[a-z0-9]+)*")
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
        if manifest_edits.schema_rank(child.tag) < manifest_edits.schema_rank(highest.tag):
            fix = Fix.of("sort the elements", *manifest_edits.sort(manifest))
            message = f"<{child.tag}> stands after <{highest.tag}>, which the schema does not allow; move it before"
            yield _finding(message, child.span, "order")._replace(fix=fix)
            return
        highest = child


def _text_between(manifest: Manifest) -> Iterator[Finding]:
    for aside in manifest.strays:
        yield _finding("text stands between the elements, where the schema wants none; remove it", aside, "text")


def _element(element: Element) -> Iterator[Finding]:
    text, place = element.text, element.text_span
    if element.tag == "name" and not _NAME.fullmatch(text):
        message = f'name "{text}" must be of small letters, digits and single underscores in the schema; rename the package'
        yield _finding(message, place, "name")
    elif element.tag == "version":
        if not _VERSION.fullmatch(text):
            yield _finding(f"version {text} must not have leading zeros in the schema; remove them", place, "version")
        if (compatibility := element.get("compatibility")) and not _LIMIT.fullmatch(compatibility):
            message = f"compatibility {compatibility} must not have leading zeros in the schema; remove them"
            yield _finding(message, element.span, "version")
    elif element.tag == "url" and element.get("type", "website") not in _URLS:
        message = f'url type "{element.get("type")}" is not in the schema; write website, bugtracker or repository'
        yield _finding(message, element.span, "url")


def _depend(depend: Depend) -> Iterator[Finding]:
    for attribute, limit in depend.versions:
        if not _LIMIT.fullmatch(limit):
            message = f'{attribute}="{limit}" is not of the form 1.2.3 that the schema wants; write numbers with dots'
            yield _finding(message, depend.span, depend.name)
    grouped = depend.tag in ("group_depend", "member_of_group")
    if not (_GROUP_CONDITION if grouped else _CONDITION).fullmatch(depend.condition):
        quotes = " without quotes" if grouped else ""
        message = f"condition {depend.condition} has a character that the schema does not allow; use words{quotes} only"
        yield _finding(message, depend.span, depend.name)


def _finding(message: str, span: Span, subject: str) -> Finding:
    return Finding(message, span, subject)


RULE = Rule(
    name="manifest-schema",
    code="ROS111",
    summary="a manifest must be valid by the schema of its format",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    default=False,
    fixable=True,
    package=check,
)
