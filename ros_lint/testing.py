"""Test rules with cases in Markdown files. It serves the rules of ros-lint and of plugins.

A file of cases has the name of its rule. Each ``##`` heading begins a case, which is a small workspace:

- A line that is a path in backticks, followed by a fenced block, is a file.
- A line ``package robot (ament_cmake): depend rclcpp, exec_depend rviz2`` is the file ``robot/package.xml``. The build
  type may be left out. ``package robot (ament_cmake) in src/robot`` names another folder; ``.`` is the root.
- Comments in files state the expected findings. Words in brackets must be the confidence or the rule of the finding:

      #include <std_msgs/msg/string.hpp>  // want "std_msgs is used"
      # want+1 [medium] "..."             (a finding in the next line; want-1 is for the previous line)

- A block ``output`` is the expected output for the case, a block ``diff`` the expected changes of its fixes. Both are
  compared exactly; ``pytest --bless`` rewrites them.
- A block ``toml`` without a path has settings of the case:
  ``distro = "humble"``: the distribution, by default jazzy; a list has several;
  ``chosen = false``: the distribution counts as a default, not as chosen by the user;
  ``executable = ["scripts/a.py"]``: files with the executable bit;
  ``underlay = "opt"``: a folder of the case that is an underlay. The folder must contain a file COLCON_IGNORE.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from ros_lint.analysis.rule import Rule
from ros_lint.base.diff import unified
from ros_lint.base.text import Text, read, to_bytes
from ros_lint.base.tree import MemoryTree, OverlayTree, Tree
from ros_lint.engine import edits, registry
from ros_lint.engine.explanations import without_explained
from ros_lint.engine.report import Issue
from ros_lint.engine.run import find_issues
from ros_lint.knowledge import Knowledge
from ros_lint.knowledge.underlays import in_tree
from ros_lint.workspace.loader import Loader
from ros_lint.workspace.state import DistroData
from ros_lint.workspace.target import TargetDistro

FENCE = re.compile(
    r"^(?:`(?P<path>[^`\n]+)`\n+)?(?P<fence>`{3,})(?P<kind>\w*)\n(?P<body>.*?)^(?P=fence)$", re.MULTILINE | re.DOTALL
)
HEADING = re.compile(r"^## (.+)$", re.MULTILINE)
PACKAGE = re.compile(
    r"^package (?P<name>[\w.-]+)(?: \((?P<type>\w+)\))?(?: in (?P<folder>[\w./-]+))?(?:: (?P<depends>[^\n]+))?$", re.MULTILINE
)
WANT = re.compile(r'(?:#|//|<!--)[ \t]*want(?P<offset>[+-]\d+)?(?:[ \t]*\[(?P<tags>[\w, -]+)\])?(?P<texts>(?:[ \t]+"[^"]*")+)')


class Want(NamedTuple):
    """A finding that a case expects."""

    path: str
    line: int
    text: str
    """A part of the message of the finding."""
    tags: frozenset[str]
    """Words in brackets: each must be the confidence of the finding or the name of its rule."""

    @property
    def written(self) -> str:
        """The comment for the expected finding, such as ``want [medium] "is used"``."""
        tags = f"[{', '.join(sorted(self.tags))}] " if self.tags else ""
        return f'want {tags}"{self.text}"'

    def fits(self, issue: Issue) -> bool:
        """Return whether ``issue`` is the finding that is expected."""
        finding = issue.finding
        place = (finding.span.path, finding.span.line) == (self.path, self.line)
        return place and self.text in finding.message and self.tags <= {str(finding.confidence), issue.rule.name}


class Case(NamedTuple):
    """A small workspace, with the findings and outputs that are expected for it."""

    title: str
    source: Path
    files: Mapping[str, str]
    output: str | None
    diff: str | None
    distros: tuple[str, ...]
    """The distributions of ROS for which the workspace is checked."""
    chosen: bool
    """True if the distribution counts as chosen by the user, False if it counts as a default."""
    executable: frozenset[str]
    underlay: str

    def wants(self) -> list[Want]:
        """Return the findings that comments in the files expect."""
        return [
            Want(path, number + int(match["offset"] or 0), text, frozenset(re.findall(r"[\w-]+", match["tags"] or "")))
            for path, body in self.files.items()
            for number, line in enumerate(body.split("\n"), 1)
            for match in WANT.finditer(line)
            for text in re.findall(r'"([^"]*)"', match["texts"])
        ]

    def tree(self) -> MemoryTree:
        return MemoryTree(self.files, self.executable)


def read_cases(source: Path) -> Iterator[Case]:
    """Yield the cases in a Markdown file. Raises AssertionError for an unknown setting."""
    _, *parts = HEADING.split(source.read_text("utf-8"))
    for title, body in zip(parts[::2], parts[1::2], strict=True):
        files = dict(manifest(match) for match in PACKAGE.finditer(FENCE.sub("", body)))
        extra: dict[str, str] = {}
        for match in FENCE.finditer(body):
            if match["path"]:
                files[match["path"]] = match["body"]
            else:
                extra[match["kind"]] = match["body"]
        settings = _settings(extra.get("toml", ""))
        distro = settings.pop("distro", "jazzy")
        yield Case(
            title,
            source,
            files,
            extra.get("output"),
            extra.get("diff"),
            (distro,) if isinstance(distro, str) else tuple(distro),
            settings.pop("chosen", True),
            frozenset(settings.pop("executable", [])),
            settings.pop("underlay", ""),
        )
        assert not settings, f"{source.name}: {title}: unknown settings {sorted(settings)}"


def _settings(text: str) -> dict[str, Any]:
    if not text:
        return {}
    if sys.version_info >= (3, 11):
        import tomllib  # noqa: PLC0415  (most cases have no settings)
    else:
        import tomli as tomllib  # noqa: PLC0415
    settings: dict[str, Any] = tomllib.loads(text)
    return settings


def manifest(header: re.Match[str]) -> tuple[str, str]:
    """Return the path and the text of the manifest for a line ``package NAME (TYPE) in FOLDER: TAG NAME, ...``."""
    folder = header["folder"] or header["name"]
    depends = [depend.split() for depend in (header["depends"] or "").split(",") if depend.strip()]
    lines = [
        '<package format="3">',
        f"  <name>{header['name']}</name><version>0.1.0</version><description>d</description>",
        '  <maintainer email="a@b.org">A</maintainer><license>Apache-2.0</license>',
        *(f"  <{tag}>{name}</{tag}>" for tag, name in depends),
        *([f"  <export><build_type>{header['type']}</build_type></export>"] if header["type"] else []),
        "</package>",
        "",
    ]
    return ("package.xml" if folder == "." else f"{folder}/package.xml"), "\n".join(lines)


def loader_of(tree: Tree, case: Case) -> Loader:
    """Return a loader of the workspace of ``case``. The files are read from ``tree``."""
    first, *others = [_distro_data(tree, case, distro) for distro in case.distros]
    return Loader(tree, ("",), first.target, knowledge=first.knowledge, underlays=first.underlays, others=others)


def _distro_data(tree: Tree, case: Case, distro: str) -> DistroData:
    others = tuple(other for other in case.distros if other != distro)
    target = TargetDistro(distro, "--distro" if case.chosen else "default", case.chosen, others)
    return DistroData(target, _knowledge(distro), (in_tree(tree, case.underlay, distro),) if case.underlay else ())


@cache
def _knowledge(distro: str) -> Knowledge:
    """Return the data about a distribution, once for all cases, because to read it takes a third of the time of a case."""
    return Knowledge(distro)


def issues_of(tree: Tree, case: Case, rule: Rule) -> tuple[Issue, ...]:
    """Return the findings of a rule in the workspace of ``case``. The files are read from ``tree``.

    Only this rule runs, except for a rule about suppressions, which needs the findings of all rules. Raises
    AssertionError with the traceback if a rule crashes.
    """
    loader = loader_of(tree, case)
    all_rules = registry.load()
    rules = all_rules if rule.suppressions else (rule,)
    checked = find_issues(loader.load_all(), rules, loader.suppressions(), all_rules)
    if checked.crashes:
        raise AssertionError(checked.crashes[0].traceback)
    return without_explained([issue for issue in checked.issues if issue.rule is rule])


def differences(case: Case, rule: Rule) -> Iterator[str]:
    """Yield a line for each difference between the results of a rule and the expectations of a case.

    Besides findings, output and diff, this checks that each fix resolves its finding, and that the order of files has no
    effect.
    """
    tree = case.tree()
    issues = issues_of(tree, case, rule)
    wanted = case.wants()
    for issue in issues:
        match = next((want for want in wanted if want.fits(issue)), None)
        if match:
            wanted.remove(match)
        else:
            yield f"{issue.finding.span}: unexpected [{issue.finding.confidence}]: {issue.finding.message}"
    yield from (f"{want.path}:{want.line}: no finding here meets {want.written}" for want in wanted)

    if case.output is not None and (actual := _output(tree, issues)) != case.output:
        yield f"the output is\n{actual}"
    changed = fixed(tree, issues)
    if case.diff is not None and (actual := _diff(tree, changed)) != case.diff:
        yield f"the fix is\n{actual}"
    if changed and not rule.fixable:
        yield "the rule has a fix, but is not marked as fixable"
    if changed:
        after = OverlayTree(tree, {path: to_bytes(text) for path, text in changed.items()})
        remaining = issues_of(after, case, rule)
        yield from (f"{issue.finding.span}: still reported after its fix" for issue in remaining if issue.finding.fix)

    reversed_tree = case._replace(files=dict(reversed(list(case.files.items())))).tree()
    if issues_of(reversed_tree, case, rule) != issues:
        yield "the result depends on the order of the files"


def bless(case: Case, rule: Rule) -> None:
    """Replace the blocks ``output`` and ``diff`` of a case by the current results.

    Raises AssertionError if the case still fails, for example because an expected finding is missing.
    """
    tree = case.tree()
    issues = issues_of(tree, case, rule)
    new = {"output": _output(tree, issues), "diff": _diff(tree, fixed(tree, issues))}
    head, heading, rest = case.source.read_text("utf-8").partition(f"## {case.title}\n")
    body, separator, tail = rest.partition("\n## ")
    for kind, text in new.items():
        block = f"```{kind}\n{text}```"
        body = _block(kind).sub(block.replace("\\", r"\\"), body)
    case.source.write_text(head + heading + body + separator + tail, "utf-8")
    blessed = case._replace(
        output=None if case.output is None else new["output"], diff=None if case.diff is None else new["diff"]
    )
    if remaining := "\n".join(differences(blessed, rule)):
        raise AssertionError(f"{case.source.name}: {case.title}: the blocks are rewritten, but the case fails:\n{remaining}")


def _block(kind: str) -> re.Pattern[str]:
    return re.compile(rf"^```{kind}\n.*?^```$", re.MULTILINE | re.DOTALL)


def fixed(tree: Tree, issues: tuple[Issue, ...]) -> dict[str, str]:
    """Return the new text of each file that the fixes of the issues change, by path. Unsafe fixes are included."""
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
