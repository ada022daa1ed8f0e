"""Test a rule with cases written in Markdown, for our own rules and for those of plugins.

A file of cases is named after its rule. Every ``##`` heading is one case, a small workspace: a line with nothing but a
path in backticks, then a fenced block, is a file. In the files, comments say what is wanted:

    #include <std_msgs/msg/string.hpp>  // want "std_msgs is used"
    # want+1 "..."                      (for a line that cannot bear a comment; want-1 looks up)

A block ``output`` is what the tool prints for the case, a block ``diff`` what its fixes change. Both are checked to the
letter, and rewritten by ``pytest --bless``. A line ``settings: distro=humble, executable=scripts/a.py`` in the prose sets
the distribution (jazzy if not said) and gives files the executable bit; ``settings: told=no`` makes the distribution an
assumption; ``settings: underlay=opt`` takes the folder opt of the case for an underlay (mark it with COLCON_IGNORE).
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

from ros_lint.analysis.rule import Rule
from ros_lint.base.diff import unified
from ros_lint.base.text import Text, read, to_bytes
from ros_lint.base.tree import MemoryTree, OverlayTree, Tree
from ros_lint.engine import edits, registry
from ros_lint.engine import run as engine
from ros_lint.engine.report import Issue
from ros_lint.knowledge.underlays import in_tree
from ros_lint.workspace.loader import Loader
from ros_lint.workspace.target import TargetDistro

FENCE = re.compile(
    r"^(?:`(?P<path>[^`\n]+)`\n+)?(?P<fence>`{3,})(?P<kind>\w*)\n(?P<body>.*?)^(?P=fence)$", re.MULTILINE | re.DOTALL
)
HEADING = re.compile(r"^## (.+)$", re.MULTILINE)
SETTINGS = re.compile(r"^settings: (.+)$", re.MULTILINE)
WANT = re.compile(r'(?:#|//|<!--)[ \t]*want([+-]\d+)?((?:[ \t]+"[^"]*")+)')


class Case(NamedTuple):
    """A workspace, and what is expected of it."""

    title: str
    source: Path
    files: Mapping[str, str]
    output: str | None
    diff: str | None
    distro: str
    told: bool
    executable: frozenset[str]
    underlay: str

    def wants(self) -> list[tuple[str, int, str]]:
        """Return path, line and piece of message of every finding that is wanted."""
        return [
            (path, number + int(match[1] or 0), text)
            for path, body in self.files.items()
            for number, line in enumerate(body.split("\n"), 1)
            for match in WANT.finditer(line)
            for text in re.findall(r'"([^"]*)"', match[2])
        ]

    def tree(self) -> MemoryTree:
        return MemoryTree(self.files, self.executable)


def read_cases(source: Path) -> Iterator[Case]:
    """Yield the cases of a Markdown file."""
    _, *parts = HEADING.split(source.read_text("utf-8"))
    for title, body in zip(parts[::2], parts[1::2], strict=True):
        files: dict[str, str] = {}
        extra: dict[str, str] = {}
        for match in FENCE.finditer(body):
            if match["path"]:
                files[match["path"]] = match["body"]
            else:
                extra[match["kind"]] = match["body"]
        settings: dict[str, list[str]] = {}
        for line in SETTINGS.findall(FENCE.sub("", body)):
            for word in line.split(","):
                key, _, value = word.strip().partition("=")
                settings.setdefault(key, []).append(value)
        yield Case(
            title,
            source,
            files,
            extra.get("output"),
            extra.get("diff"),
            settings.get("distro", ["jazzy"])[0],
            settings.get("told", ["yes"])[0] == "yes",
            frozenset(settings.get("executable", [])),
            settings.get("underlay", [""])[0],
        )


def issues_of(tree: Tree, case: Case, rule: Rule) -> tuple[Issue, ...]:
    """Return what a rule says of a case, with the shipped knowledge and no underlay.

    A rule about suppressions hears what all rules say. Raises AssertionError with the traceback when a rule crashes.
    """
    target = TargetDistro(case.distro, "--distro" if case.told else "default", case.told)
    underlays = (in_tree(tree, case.underlay, case.distro),) if case.underlay else ()
    loader = Loader(tree, ("",), target, underlays=underlays)
    every = registry.load()
    rules = every if rule.suppressions else (rule,)
    checked = engine.check(loader.load(), rules, loader.suppressions(), every)
    if checked.crashes:
        raise AssertionError(checked.crashes[0].traceback)
    return tuple(issue for issue in checked.issues if issue.rule is rule)


def differences(case: Case, rule: Rule) -> Iterator[str]:
    """Say, line by line, in what the rule does not do what the case wants. Silence means success."""
    tree = case.tree()
    issues = issues_of(tree, case, rule)
    wanted = case.wants()
    for issue in issues:
        span, message = issue.finding.span, issue.finding.message
        hit = next((want for want in wanted if want[:2] == (span.path, span.line) and want[2] in message), None)
        if hit:
            wanted.remove(hit)
        else:
            yield f"{span}: not wanted: {message}"
    yield from (f'{path}:{line}: wanted, but not found: "{text}"' for path, line, text in wanted)

    if case.output is not None and (got := _output(tree, issues)) != case.output:
        yield f"the output is\n{got}"
    changed = fixed(tree, issues)
    if case.diff is not None and (got := _diff(tree, changed)) != case.diff:
        yield f"the fix is\n{got}"
    if changed and not rule.fixable:
        yield "the rule has a fix, and is not marked as fixable"
    if changed:
        after = OverlayTree(tree, {path: to_bytes(text) for path, text in changed.items()})
        again = issues_of(after, case, rule)
        yield from (f"{issue.finding.span}: still there after its fix" for issue in again if issue.finding.fix)

    backwards = case._replace(files=dict(reversed(list(case.files.items())))).tree()
    if issues_of(backwards, case, rule) != issues:
        yield "the result depends on the order of the files"


def bless(case: Case, rule: Rule) -> None:
    """Rewrite the blocks ``output`` and ``diff`` of the case from what the tool does now."""
    tree = case.tree()
    issues = issues_of(tree, case, rule)
    new = {"output": _output(tree, issues), "diff": _diff(tree, fixed(tree, issues))}
    head, found, rest = case.source.read_text("utf-8").partition(f"## {case.title}\n")
    body, more, tail = rest.partition("\n## ")
    for kind, text in new.items():
        block = f"```{kind}\n{text}```"
        body = _block(kind).sub(block.replace("\\", r"\\"), body)
    case.source.write_text(head + found + body + more + tail, "utf-8")


def _block(kind: str) -> re.Pattern[str]:
    return re.compile(rf"^```{kind}\n.*?^```$", re.MULTILINE | re.DOTALL)


def fixed(tree: Tree, issues: tuple[Issue, ...]) -> dict[str, str]:
    """Return the new text of every file that the fixes of the issues change, safe or not."""
    fixes = edits.choose(issue.finding.fix for issue in issues if issue.finding.fix)
    return edits.apply(fixes, lambda path: edits.text_of(tree, path))


def _output(tree: Tree, issues: tuple[Issue, ...]) -> str:
    from ros_lint.reporters.text import render_issues  # noqa: PLC0415  (rules can be tested without a block of output)

    return render_issues(issues, lambda path: _text(tree, path))


def _diff(tree: Tree, changed: Mapping[str, str]) -> str:
    return "".join(unified(path, _before(tree, path), after) for path, after in sorted(changed.items()))


def _before(tree: Tree, path: str) -> str | None:
    try:
        return _text(tree, path).text
    except FileNotFoundError:
        return None


def _text(tree: Tree, path: str) -> Text:
    return read(path, tree.read(path))
