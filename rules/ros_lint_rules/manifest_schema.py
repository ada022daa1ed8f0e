"""
## What it finds

A `package.xml` that `catkin_pkg` accepts but that is not valid by the XML schema of its format (REP 127, 140 and 149):

- Elements in the wrong order.
- `url type` other than `website`, `bugtracker` and `repository`.
- Versions with leading zeros.
- Package names with anything but lower-case letters, digits and single underscores.
- Text between the elements of `<package>` or of `<export>`.
- Everything else that `xmllint` rejects, such as unknown attributes in a namespace.

Also reported: a manifest that names the schema of another format than its own.

lxml validates the manifests with the same library as `xmllint`. No schema is downloaded.

## Why it matters

Build tools do not check the schema. `ament_xmllint`, a part of `ament_lint_common`, does so for manifests that name the schema
in an `<?xml-model ...?>` line: the tests of the package fail.

The confidence is high if the manifest names the schema and the tests of the package run `ament_xmllint`:

- CMake calls `ament_xmllint()`, or finds the test dependencies, and `ament_cmake_xmllint` or a collection of linters such as
  `ament_lint_common` is a `<test_depend>`;
- in a package of type `ament_python`, a test imports `ament_xmllint`.

For other packages it is medium; `extend-select = ["manifest-schema"]` shows these findings as well.

## How to fix it

Follow the message. The fix sorts the elements: name, version, description, maintainer, license, url, author, dependencies,
group_depend, member_of_group, export. Another fix corrects the format in the address of the schema.

## Limitations

- There is no fix if an element to be moved has a comment, shares its line with another element, or is a `<description>` or
  `<export>`.
- Only the schemas in `http://download.ros.org/schema/` are known. A manifest that names another address is validated by the
  schema of its format, with medium confidence.
- A manifest of more than 100,000 characters is not validated.
- A manifest in UTF-16 is not validated, because versions of `xmllint` differ.
- Only `package.xml` is validated. `ament_xmllint` checks all XML files of the package.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from ros_lint.api import (
    Confidence,
    Depend,
    Edit,
    Element,
    Finding,
    Fix,
    Manifest,
    Package,
    Rule,
    Severity,
    Span,
    Workspace,
    build,
    edits,
    manifests,
)

_VERSIONS = ("version_lt", "version_lte", "version_eq", "version_gte", "version_gt")


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    manifest = package.manifest
    if manifest is None or manifest.problems:
        return
    named = manifests.named_schema(manifest)
    invalid = [*_format(manifest, named), *_invalid(manifest)]
    if invalid:
        fails = named is not None and build.runs_xmllint(package, workspace)
        confidence = Confidence.HIGH if fails else Confidence.MEDIUM
        for finding in invalid:
            message = f"ament_xmllint fails in the tests: {finding.message}" if fails else finding.message
            yield finding._replace(message=message, confidence=confidence)


def _format(manifest: Manifest, named: manifests.NamedSchema | None) -> Iterator[Finding]:
    """Yield a finding if the manifest names the schema of another format than its own."""
    if named is not None and named.format != manifest.format:
        yield Finding(
            f"the manifest has format {manifest.format}, but names the schema of format {named.format}; write "
            f"package_format{manifest.format}.xsd",
            named.span,
            "format",
            fix=Fix.of(f"name the schema package_format{manifest.format}.xsd", Edit(named.span, str(manifest.format))),
        )


def _invalid(manifest: Manifest) -> Iterator[Finding]:
    """Yield a finding for each violation of the schema."""
    children: list[Element | Depend] = sorted((*manifest.elements, *manifest.depends), key=lambda child: child.span)
    for violation in manifests.violations(manifest):
        if violation.child < 0:
            yield from _of_package(manifest, violation)
            continue
        child = children[violation.child]
        if violation.kind == manifests.MISPLACED and (finding := _order(manifest, children)):
            yield finding
        elif isinstance(child, Depend):
            yield _of_depend(child, violation)
        else:
            yield _of_element(child, violation)


def _order(manifest: Manifest, children: list[Element | Depend]) -> Finding | None:
    """Return the finding about the first element that has to come before its predecessor; None if the order is right."""
    ranks = [edits.manifest.schema_rank(child.tag) for child in children]
    for number, (earlier, child) in enumerate(pairwise(children), 1):
        if ranks[number] < ranks[number - 1]:
            fix = Fix.of("sort the elements of <package> as the schema requires", *edits.manifest.sort(manifest))
            several_follow = number + 1 < len(children) and ranks[number - 1] > max(ranks[number:])
            step = f"move <{earlier.tag}> to the end" if several_follow else f"move it before <{earlier.tag}>"
            message = f"<{child.tag}> after <{earlier.tag}> violates the schema; {step}"
            return _finding(message, child.span, "order")._replace(fix=fix)
    return None


def _of_package(manifest: Manifest, violation: manifests.Violation) -> Iterator[Finding]:
    if violation.kind == manifests.TEXT and manifest.stray_text:
        for span in manifest.stray_text:
            yield _finding("the schema allows no text between elements; remove it", span, "text")
    elif violation.attribute == "format":
        message = f'format {manifest.format} must be written as format="{manifest.format}"'
        yield _finding(message, manifest.format_span or manifest.name_span, "format")
    elif not violation.kind:
        yield _finding(f"xmllint cannot read the file: {violation.message}", manifest.name_span, "package")
    else:
        yield _other(manifest.name_span, "package", violation)


def _of_element(element: Element, violation: manifests.Violation) -> Finding:
    text, place = element.text, element.text_span
    if element.tag == "export" and violation.kind == manifests.TEXT:
        return _finding("the schema allows no text in <export>, only elements; remove it", element.span, "export")
    match element.tag, violation.attribute if violation.kind in manifests.BAD_VALUE else None:
        case "name", "":
            message = f"the schema allows only lower-case letters, digits and single underscores in '{text}'; rename the package"
            return _finding(message, place, "name")
        case "version", "":
            return _finding(f"the schema allows no leading zeros in version {text}; remove them", place, "version")
        case "url", "type":
            message = f'url type "{element.get("type")}" is not in the schema; write website, bugtracker or repository'
            return _finding(message, element.span, "url")
        case "url", "":
            return _finding(f"'{text}' is not a valid address; write an address such as https://example.org/robot", place, "url")
    if element.tag == "version" and violation.attribute == "compatibility":
        message = "the schema has no attribute 'compatibility', although REP 149 has it; remove it"
        return _finding(message, element.span, "version")
    return _other(element.span, element.tag, violation)


def _of_depend(depend: Depend, violation: manifests.Violation) -> Finding:
    attribute = violation.attribute
    if violation.kind in manifests.BAD_VALUE and attribute in _VERSIONS:
        limit = dict(depend.versions)[attribute]
        message = f'{attribute}="{limit}" violates the schema, which requires the form 1.2.3; write numbers and dots'
        return _finding(message, depend.span, depend.name)
    if violation.kind in manifests.BAD_VALUE and attribute == "condition":
        grouped = depend.tag in ("group_depend", "member_of_group")
        quotes = " without quotes" if grouped else ""
        message = f"condition {depend.condition} contains a character that the schema does not allow; use only words{quotes}"
        return _finding(message, depend.span, depend.name)
    return _other(depend.span, depend.name, violation)


def _other(span: Span, subject: str, violation: manifests.Violation) -> Finding:
    return _finding(
        f"package.xml violates its schema; correct this element, about which xmllint reports: {violation.message}", span, subject
    )


def _finding(message: str, span: Span, subject: str) -> Finding:
    return Finding(message, span, subject)


RULE = Rule(
    name="manifest-schema",
    code="ROS111",
    summary="manifests are valid by the schema of their format",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
