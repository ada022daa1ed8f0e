"""The spelling of files, unreadable files and names for colcon do not change the findings."""

from __future__ import annotations

import ast
import json
import re
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

import pytest

from ros_lint.analysis.finding import Confidence
from ros_lint.base.paths import join
from ros_lint.base.tree import DiskTree, MemoryTree, Tree
from ros_lint.engine import registry
from ros_lint.engine.run import find_issues
from ros_lint.testing import Case, loader_of, read_cases
from ros_lint.workspace.discovery.discover import discover
from ros_lint.workspace.loader import Loader
from ros_lint.workspace.target import TargetDistro
from tests.trees import Locked

pytestmark = pytest.mark.slow

FIXTURES = Path(__file__).parent.parent / "fixtures"
RULES = registry.load()
CASES = [case for source in sorted(FIXTURES.glob("*.md")) for case in read_cases(source)]
TEXTS = re.compile(r'"(?:\\.|[^"\\])*"|#\[(=*)\[.*?\]\1\]|#[^\n]*|\[(=*)\[.*?\]\2\]|\\.|[()]|[ \t]+|[^\s"#()\[\\]+|.', re.DOTALL)
TAGS = re.compile(r"""<!--.*?-->|<!\[CDATA\[.*?\]\]>|<\?.*?\?>|<[A-Za-z](?:[^<>"']|"[^"]*"|'[^']*')*>""", re.DOTALL)
ATTRIBUTE = re.compile(r"""\s+([\w:.-]+)\s*=\s*("[^"<]*"|'[^'<]*')""")


def found(tree: Tree, case: Case, *, default: bool = False) -> Counter[tuple[str, str, str, str]]:
    """Return what is said of a case, or by ``default``: rule, package, subject and message of each finding."""
    loader = loader_of(tree, case)
    checked = find_issues(loader.load_all(), RULES, loader.suppressions(), RULES)
    assert not checked.crashes
    return Counter(
        (issue.rule.name, issue.package, issue.finding.subject, issue.finding.message)
        for issue in checked.issues
        if not default or (issue.rule.default and issue.finding.confidence is Confidence.HIGH)
    )


LINE_OF_INCLUDE = r"('[^']*') is looked up here, and its ('[^']*') is included in line \d+"


def spelt(path: str, text: str) -> str:
    """Return a file that says the same in another spelling, as another editor or formatter would have left it."""
    if path.endswith(("CMakeLists.txt", ".cmake")):
        return _cmake(text)
    if path.endswith(".py"):
        return _python(text)
    if path.endswith((".launch", ".launch.xml", ".urdf", ".xacro")):
        return TAGS.sub(_on_lines, text).replace("\n", "\r\n")
    if path.endswith((".hpp", ".h", ".cpp")):
        return re.sub(r"(?m)^#include[ \t]*", "/* #include <a/b.hpp> */ #  include\t", text)
    return text


def _cmake(text: str) -> str:
    """Write commands in capitals, and arguments a line each with remarks between them."""
    parts = []
    depth = 0
    for match in TEXTS.finditer(re.sub(r"(?m)^([ \t]*)([A-Za-z]\w*)(?=[ \t]*\()", lambda m: m[1] + m[2].upper(), text)):
        depth += (match[0] == "(") - (match[0] == ")")
        parts.append('\n    # not "this (\n    ' if depth > 0 and not match[0].strip(" \t") else match[0])
    return "".join(parts)


def _python(text: str) -> str:
    """Write the statements as ast.unparse does, and the comments, in which names count as uses, behind them."""
    if "noqa" in text:  # it belongs to its line
        return text
    head = text.partition("\n")[0] + "\n" if text.startswith("#!") else ""
    comments = [comment for comment in re.findall("#[^\n]*", text.removeprefix(head)) if "ros-lint:" not in comment]
    try:
        return f"{head}{ast.unparse(ast.parse(text))}\n" + "".join(f"{comment}\n" for comment in comments)
    except SyntaxError:
        return text


def _on_lines(tag: re.Match[str]) -> str:
    if tag[0].startswith(("<!", "<?")):
        return tag[0]
    return ATTRIBUTE.sub(lambda attribute: f"\n  {attribute[1]} = {attribute[2]}", tag[0])


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.source.stem}: {case.title}")
def test_another_spelling_of_a_file_keeps_the_findings(case: Case) -> None:
    if case.source.stem.endswith("-suppression"):
        return  # the comments are what these rules are about
    other = MemoryTree({path: spelt(path, text) for path, text in case.files.items()}, case.executable)
    assert _without_lines(found(other, case)) == _without_lines(found(case.tree(), case))


def _without_lines(issues: Counter[tuple[str, ...]]) -> Counter[tuple[str, ...]]:
    """Return findings without the lines that messages name, which change with the spelling of a file."""
    return Counter(
        tuple(re.sub(LINE_OF_INCLUDE, r"\2 of \1 is included here", part) for part in issue) for issue in issues.elements()
    )


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.source.stem}: {case.title}")
def test_an_unreadable_file_adds_no_finding(case: Case) -> None:
    before = Counter(issue[:2] for issue in found(case.tree(), case).elements())
    for path in case.files:
        if path.endswith(("package.xml", "colcon.pkg", ".gitignore", ".gitmodules", "Dockerfile")) or path == "setup.py":
            continue  # they decide where packages are, what they are called and for which distribution; only git reads the others
        after = Counter(issue[:2] for issue in found(Locked(case.files, path, case.executable), case, default=True).elements())
        assert not _weakened(after - before, before), path


def _weakened(added: Counter[tuple[str, ...]], before: Counter[tuple[str, ...]]) -> Counter[tuple[str, ...]]:
    """Return findings without those of ``transitive-dependency`` where a stronger rule reported the package before."""
    return added - Counter(
        {("transitive-dependency", *key[1:]): count for key, count in before.items() if key[0] == "undeclared-dependency"}
    )


OF_COLCON = ("dependency-cycle", "duplicate-package")
"""Rules about names as colcon uses them."""


def renamed(tree: Tree, names: Callable[[Sequence[str]], Iterable[str]]) -> dict[str, str]:
    """Return a ``colcon.pkg`` for every package with a manifest: new names, given those of all these packages."""
    packages = [entry for entry in discover(tree, ("",)).packages if entry.manifest and "colcon.pkg" not in entry.files]
    new = names([package.name for package in packages])
    return {join(package.path, "colcon.pkg"): json.dumps({"name": name}) for package, name in zip(packages, new, strict=True)}


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.source.stem}: {case.title}")
def test_another_name_for_colcon_keeps_the_findings(case: Case) -> None:
    more = renamed(case.tree(), lambda names: [f"renamed_{number}" for number in range(len(names))])
    # Messages differ where colcon no longer sees a cycle.
    before, after = (
        Counter(issue[:3] for issue in found(MemoryTree(files, case.executable), case).elements() if issue[0] not in OF_COLCON)
        for files in (case.files, {**case.files, **more})
    )
    assert after == before


@pytest.mark.parametrize("names", [lambda names: [f"{name}_2" for name in names], lambda names: [*names[1:], names[0]]])
def test_other_names_for_colcon_keep_the_findings_of_a_workspace(names: Callable[[Sequence[str]], list[str]]) -> None:
    """New names, and each package called as the next one."""
    demo = DiskTree(str(FIXTURES / "workspaces" / "demo"))
    files = {path: text.encode() for path, text in renamed(demo, names).items()}
    assert len(files) > 2
    workspaces = [Loader(demo, ("",), TargetDistro("jazzy", "test")).load(changed) for changed in ({}, files)]
    own, other = ([package.colcon_name for package in workspace.packages] for workspace in workspaces)
    assert other == names(own)
    before, after = (find_issues((workspace,), RULES, (), RULES) for workspace in workspaces)
    assert not after.crashes
    of_ament = [[issue for issue in checked.issues if issue.rule.name not in OF_COLCON] for checked in (before, after)]
    assert of_ament[1] == of_ament[0] != []
