"""The sarif format, for code review: SARIF 2.1.0 within the limits of GitHub code scanning.

Equal findings give equal bytes, because the output contains no time, no random identifier and no absolute path.
Suppressed findings are left out, because GitHub would show them as open.
"""

from __future__ import annotations

import re
from functools import cache
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

from ros_lint.base.json_text import encode
from ros_lint.base.suggestions import and_list
from ros_lint.base.text import Span, Text, to_bytes
from ros_lint.reporters.fingerprint import line_hashes
from ros_lint.reporters.sarif_rules import LEVELS, TOPICS, capital, descriptor, sentence, topic
from ros_lint.reporters.summary import crashed, hidden_findings, name_or_count, unread_file

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from ros_lint.analysis.finding import Finding, Fix
    from ros_lint.base.edit import Edit
    from ros_lint.engine.report import Issue, Report
    from ros_lint.reporters import SourceTexts
    from ros_lint.reporters.ansi import Style

JsonObject = dict[str, Any]
IssueGroup = tuple["Issue", ...]

_RESULTS = 25_000
"""Maximum number of results of a run that GitHub accepts."""
_RELATED = 100
"""Maximum number of related locations of a result that GitHub shows."""
_LINKS = 10
"""Maximum number of links to related places in a message."""
_CONTEXT = 1000
"""Maximum number of characters quoted from the lines around a place."""
_ROOT = "%SRCROOT%"


def render(report: Report, texts: SourceTexts, style: Style) -> str:  # noqa: ARG001  (the signature of reporters)
    """Return the report as SARIF."""
    texts = cache(texts)
    groups = _groups(report.issues)
    kept = _most_important(groups)
    crashed_rules = {crash.rule for crash in report.crashes}
    used = (*(rule for rule in report.rules if rule.name in crashed_rules), *(issue.rule for group in kept for issue in group))
    rules = {rule.code: rule for rule in used}
    codes = {code: index for index, code in enumerate(sorted(rules))}
    hashes = _hashes(kept, texts)
    run = {
        "tool": {
            "driver": {
                "name": "ros-lint",
                "fullName": f"ros-lint {report.version}",
                "version": report.version,
                "semanticVersion": _semantic(report.version),
                "informationUri": "sarif:/runs/0/tool/driver/fullDescription",
                "shortDescription": {"text": "Static analysis for ROS 2 workspaces."},
                "fullDescription": {
                    "text": "ros-lint reports what will break in a ROS 2 workspace on the build farm, on a colleague's "
                    "machine or at launch, without building it. 'ros-lint rule NAME' explains a rule."
                },
                "rules": [descriptor(rules[code], index, report.url_of(rules[code])) for code, index in codes.items()],
                "notifications": TOPICS,
            }
        },
        "automationDetails": {"id": f"ros-lint/{report.workspace}/" if report.workspace else "ros-lint/"},
        "columnKind": "unicodeCodePoints",
        "originalUriBaseIds": {_ROOT: {"description": {"text": "The root of the checkout that was checked."}}},
        # The repository is not looked up, but paths are relative to its root.
        "versionControlProvenance": [
            {"repositoryUri": "sarif:/runs/0/originalUriBaseIds/%25SRCROOT%25", "mappedTo": {"uriBaseId": _ROOT}}
        ],
        "invocations": [
            {
                # GitHub rejects a run that is marked as failed, so errors are only in the notifications.
                "executionSuccessful": True,
                "toolExecutionNotifications": [*_notes(report, codes), *_omitted(groups, kept)],
            }
        ],
        "properties": {
            "distro": report.target.distro,
            "distros": list(report.target.distros),
            "distroSource": report.target.source,
            "dataDate": report.data_date,
            "packages": report.packages,
        },
        "results": [_result(group, report.target.distros, codes, texts, hashes) for group in kept],
    }
    schema = "https://json.schemastore.org/sarif-2.1.0.json"
    return encode({"$schema": schema, "version": "2.1.0", "runs": [run]}, 4)


def _groups(issues: Sequence[Issue]) -> list[IssueGroup]:
    """Return the issues in groups with the same rule and line, because GitHub shows such a group as one alert."""
    groups: dict[tuple[str, str, int], IssueGroup] = {}
    for issue in issues:
        span = issue.finding.span
        key = (issue.rule.code, span.path, span.line)
        groups[key] = (*groups.get(key, ()), issue)
    return list(groups.values())


def _most_important(groups: list[IssueGroup]) -> list[IssueGroup]:
    if len(groups) <= _RESULTS:
        return groups
    ranked = sorted(range(len(groups)), key=lambda index: (-_severity(groups[index]), index))
    return [groups[index] for index in sorted(ranked[:_RESULTS])]


def _severity(group: IssueGroup) -> int:
    return max(issue.severity for issue in group)


def _hashes(groups: Sequence[IssueGroup], texts: SourceTexts) -> dict[tuple[str, int], str]:
    """Return, by path and line number, the hash of the line in which the issues of each group begin.

    Lines of unreadable files are left out.
    """
    lines: dict[str, set[int]] = {}
    for group in groups:
        span = group[0].finding.span
        lines.setdefault(span.path, set()).add(span.line)
    return {
        (path, line): line_hash
        for path, numbers in lines.items()
        if (source := texts(path))
        for line, line_hash in line_hashes(source, numbers).items()
    }


def _result(
    group: IssueGroup,
    distros: Sequence[str],
    codes: dict[str, int],
    texts: SourceTexts,
    hashes: dict[tuple[str, int], str],
) -> JsonObject:
    first = group[0]
    finding = first.finding
    repeated = [(issue.finding.message, issue.finding.span) for issue in group[1:]]
    places = [(related.message, related.span) for issue in group for related in issue.finding.related]
    related = [*repeated, *(place for place in dict.fromkeys(places) if place not in repeated)]
    identity = " ".join(issue.identity for issue in group)
    line = hashes.get((finding.span.path, finding.span.line)) or line_hashes(Text("", identity), (1,))[1]
    result: JsonObject = {
        "ruleId": first.rule.code,
        "ruleIndex": codes[first.rule.code],
        "level": LEVELS[max(issue.severity for issue in group)],
        "message": {"text": _message(finding.message, related, len(repeated))},
        "locations": [_primary(finding.span, texts(finding.span.path))],
        "partialFingerprints": {"primaryLocationLineHash": line, "rosLint/v1": identity},
        "properties": {
            "package": first.package,
            "subject": finding.subject,
            "distros": [distro for distro in distros if any(distro in (issue.distros or distros) for issue in group)],
            "confidence": str(min(issue.finding.confidence for issue in group)),
        },
    }
    if related:
        result["relatedLocations"] = [
            {"id": number, **_location(span), "message": {"text": _escape(sentence(message))}}
            for number, (message, span) in enumerate(related[:_RELATED], 1)
        ]
    if finding.steps:
        result["codeFlows"] = [{"threadFlows": [{"locations": list(_steps(finding))}]}]
    if fixes := dict.fromkeys(issue.finding.fix for issue in group if issue.finding.fix):
        result["fixes"] = [_fix(fix) for fix in fixes]  # without duplicates, as the schema requires
    return result


def _message(message: str, related: Sequence[tuple[str, Span]], repeated: int) -> str:
    """Return the message with links to the related places, because GitHub shows only places to which a message links.

    ``related`` has a text and a place for each link. The first ``repeated`` of them are further findings of the same rule in
    the same line.
    """
    links = [f"[{_link(text)}]({number})" for number, (text, _) in enumerate(related[:_LINKS], 1)]
    parts = [_escape(sentence(message))]
    if links[:repeated]:
        parts.append(f"Also {and_list(links[:repeated])}.")
    if links[repeated:]:
        parts.append(f"See {and_list(links[repeated:])}.")
    if len(related) > _LINKS:
        parts.append(f"There {'is' if len(related) == _LINKS + 1 else 'are'} {len(related) - _LINKS} more.")
    return " ".join(parts)


def _escape(text: str) -> str:
    return re.sub(r"([\[\]])", r"\\\1", text)


def _link(text: str) -> str:
    # Several SARIF viewers end a link at the first closing bracket, escaped or not.
    return text.translate({ord("["): "(", ord("]"): ")", ord("\\"): "/"})


def _steps(finding: Finding) -> Iterator[JsonObject]:
    steps = [(step.message, step.span) for step in finding.related[:_RELATED]]
    if finding.span not in (span for _, span in steps):
        steps.insert(0, (finding.message, finding.span))
    for text, span in steps:
        yield {"location": {**_location(span), "message": {"text": _escape(sentence(text))}}}


def _location(span: Span) -> JsonObject:
    return {
        "physicalLocation": {
            "artifactLocation": {"uri": _uri(span.path), "uriBaseId": _ROOT},
            "region": _region(span),
        }
    }


def _uri(path: str) -> str:
    """Return a relative path as a URI reference, with percent-encoding."""
    return quote(to_bytes(path), safe="/!$&'()*+,;=@") or "."


def _region(span: Span) -> JsonObject:
    return {
        "startLine": span.line,
        "startColumn": span.column,
        "endLine": span.end_line,
        "endColumn": span.end_column,
    }


def _primary(span: Span, source: Text | None) -> JsonObject:
    """Return the location of a result, shortened to its first line, with the source text.

    In a pull request, GitHub ignores locations that include unchanged lines.
    """
    if source is None or span.line > source.line_count:
        return _location(span.start())
    line = source.line(span.line)
    if span.end_line > span.line:
        span = Span(span.path, span.line, span.column, span.line, max(len(line) + 1, span.column))
    location = _location(span)
    location["physicalLocation"]["region"]["snippet"] = {"text": line[span.column - 1 : span.end_column - 1]}
    location["physicalLocation"]["contextRegion"] = _context(span, source)
    return location


def _context(span: Span, source: Text) -> JsonObject:
    """Return the SARIF region of the line of ``span``, with the lines before and after it, and the source text.

    If these lines are long, return the region of only the part of the line around ``span``.
    """
    first, last = max(span.line - 1, 1), min(span.line + 1, source.line_count)
    context = Span(span.path, first, 1, last, len(source.line(last)) + 1)
    text = source.slice(context)
    if len(text) > _CONTEXT:
        end = min(span.end_column + _CONTEXT // 4, len(source.line(span.line)) + 1)
        context = Span(span.path, span.line, max(span.column - _CONTEXT // 4, 1), span.line, end)
        text = source.slice(context)
    if context == span:
        # The place is the whole file. The context has to be larger, so the end of the file is added as a character.
        context = context._replace(end_column=context.end_column + 1)
    return {**_region(context), "snippet": {"text": text}}


def _fix(fix: Fix) -> JsonObject:
    edits: dict[str, list[Edit]] = {}
    for edit in fix.edits:
        edits.setdefault(edit.span.path, []).append(edit)
    return {
        "description": {"text": capital(fix.title)},
        "artifactChanges": [
            {
                "artifactLocation": {"uri": _uri(path), "uriBaseId": _ROOT},
                "replacements": [
                    {"deletedRegion": _region(edit.span), "insertedContent": {"text": edit.text}} for edit in in_file
                ],
            }
            for path, in_file in sorted(edits.items())
        ],
        "properties": {"safe": fix.safe},
    }


def _notes(report: Report, codes: dict[str, int]) -> Iterator[JsonObject]:
    """Yield the notifications of the run: files that were not checked, crashes of rules, and hidden findings."""
    if not report.packages:
        yield _note("NoPackage", "error", "no package was found, so nothing was checked")
    for entry in report.not_checked:
        note = _note("NotChecked", "warning", f"not checked: {unread_file(entry)}")
        yield {**note, "locations": [_location(entry.span)]} if entry.span else note
    by_name = {rule.name: rule.code for rule in report.rules}
    for crash in report.crashes:
        note = _note("CheckFailed", "error", f"a rule failed: {crashed(crash)}")
        code = by_name.get(crash.rule, "")
        yield {**note, "associatedRule": {"id": code, "index": codes[code]}} if code in codes else note
    for hidden in report.hidden:
        yield _note("NotShown", "note", f"hidden: {hidden_findings(hidden)}")
    if report.ros1:
        yield _note("NotSeenThrough", "note", f"not analysed, because only ROS 2 is supported: {name_or_count(report.ros1)}")
    for spot in report.blind_spots:
        yield _note("NotSeenThrough", "note", f"not fully analysed: {spot.what} of {name_or_count(spot.packages)}")


def _omitted(groups: Sequence[IssueGroup], kept: Sequence[IssueGroup]) -> Iterator[JsonObject]:
    if len(groups) > len(kept):
        omitted = f"{len(groups) - len(kept)} results of the lowest severity are left out"
        yield _note("NotShown", "warning", f"{omitted}, because GitHub accepts at most {_RESULTS}")


def _note(name: str, level: str, message: str) -> JsonObject:
    return {"descriptor": topic(name), "level": level, "message": {"text": _escape(capital(message))}}


def _semantic(version: str) -> str:
    """Return a Python version as a Semantic Version: 1.2rc1 becomes 1.2.0-rc1."""
    numbers = re.match(r"\d+(?:\.\d+){0,2}", version)
    core = (numbers[0] if numbers else "0").split(".")
    rest = version[numbers.end() if numbers else 0 :].strip(".+-")
    suffix = re.sub(r"[^0-9A-Za-z.]+", ".", rest)
    return ".".join([*core, "0", "0"][:3]) + (f"-{suffix}" if suffix else "")
