"""Every example in the docs is what ros-lint prints."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from ros_lint import testing
from ros_lint.cli import rule_pages as docs
from ros_lint.cli.options import OPTIONS
from ros_lint.cli.settings import read
from ros_lint.engine import registry

ROOT = Path(__file__).parent.parent
PAGES = ROOT / "docs" / "rules"
RULES = registry.load()
CONSOLE = re.compile(r"^```console\n\$ ros-lint (?P<arguments>[^\n]*)\n(?P<output>.*?)^```$", re.MULTILINE | re.DOTALL)
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
SETTINGS = re.compile(r"^\| setting \|.*?(?=\n\n)", re.MULTILINE | re.DOTALL)
WANTED = re.compile(r" *(?:#|//|<!--) *want .*")
DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]


def check(path: Path, text: str, request: pytest.FixtureRequest) -> None:
    if request.config.getoption("bless"):
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, "utf-8")
    assert path.read_text("utf-8") == text, "run pytest --bless"


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.name)
def test_the_page_of_a_rule_is_up_to_date(rule: registry.Rule, request: pytest.FixtureRequest) -> None:
    check(PAGES / f"{rule.name}.md", docs.page(rule, example_of(rule)), request)


def example_of(rule: registry.Rule) -> str:
    """Return the first finding in the cases of a rule that says nothing about its confidence, else the first of all."""
    cases = testing.read_cases(ROOT / "fixtures" / f"{rule.name}.md")
    result = [issue for case in cases for issue in (case.output or "").strip("\n").split("\n\n") if issue]
    assert result, f"no case of {rule.name} has a block output"
    return WANTED.sub("", next((issue for issue in result if "= note:" not in issue), result[0]))


def test_the_list_of_rules_is_up_to_date(request: pytest.FixtureRequest) -> None:
    check(PAGES / "README.md", docs.overview(RULES), request)


def test_every_page_belongs_to_a_rule() -> None:
    assert {page.stem for page in PAGES.glob("*.md")} == {rule.name for rule in RULES} | {"README"}


def test_the_comparison_has_numbers_or_a_reason_for_each_tool() -> None:
    """An error that a tool raised is no result of a comparison."""
    text = (ROOT / "docs" / "comparison.md").read_text("utf-8")
    rows = [
        line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith(("| ros-lint", "| colcon", "| deptry"))
    ]
    assert len(rows) >= 8
    for _, *cells in rows:
        assert all(map(str.isdigit, cells)) or (
            set(cells[:-1]) == {"–"} and cells[-1].startswith(("not applicable: ", "not run: "))
        )


def test_the_table_of_settings_is_up_to_date(request: pytest.FixtureRequest) -> None:
    page = ROOT / "docs" / "settings.md"
    check(page, SETTINGS.sub(lambda _: docs.settings(OPTIONS), page.read_text("utf-8")), request)


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_console_examples_show_the_actual_output(document: Path, request: pytest.FixtureRequest) -> None:
    text = document.read_text("utf-8")

    def run(match: re.Match[str]) -> str:
        command = [sys.executable, "-m", "ros_lint", *match["arguments"].split()]
        process = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, check=False)
        return f"```console\n$ ros-lint {match['arguments']}\n{process.stdout}{process.stderr}```"

    check(document, CONSOLE.sub(run, text), request)


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_settings_examples_are_valid(document: Path, tmp_path: Path) -> None:
    for kind, body in BLOCK.findall(document.read_text("utf-8")):
        if kind != "toml" or "project.entry-points" in body:
            continue
        (tmp_path / "ros-lint.toml").write_text(body, "utf-8")
        settings, warnings, _ = read(str(tmp_path / "ros-lint.toml"))
        assert settings
        assert not warnings


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_python_examples_compile(document: Path) -> None:
    for kind, body in BLOCK.findall(document.read_text("utf-8")):
        if kind == "python":
            compile(body, str(document), "exec")


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_links_lead_to_existing_files_and_headings(document: Path) -> None:
    for target in re.findall(r"\]\(([^)#]+)\)", document.read_text("utf-8")):
        if "://" not in target:
            assert (document.parent / target).exists(), target


@pytest.mark.parametrize("document", [ROOT / "README.md", ROOT / "docs" / "adopting.md"], ids=lambda path: path.name)
def test_rules_and_settings_named_in_the_docs_exist(document: Path) -> None:
    names = {rule.name for rule in RULES} | {option.name for option in OPTIONS}
    text = document.read_text("utf-8")
    for name in re.findall(r"^\s*\"?([a-z]+(?:-[a-z]+)+)\"? = ", text, re.MULTILINE):
        assert name in names, name
    for listed in re.findall(r"(?:ignore|select) = \[([^\]]*)\]", text):
        for name in re.findall(r'"([^"]+)"', listed):
            assert name in names, name


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_yaml_examples_are_yaml(document: Path) -> None:
    for kind, body in BLOCK.findall(document.read_text("utf-8")):
        if kind == "yaml":
            assert yaml.safe_load(body)


def test_every_page_is_named_in_the_readme() -> None:
    text = (ROOT / "README.md").read_text("utf-8")
    assert [path.name for path in DOCUMENTS[1:] if f"](docs/{path.name})" not in text] == []


def test_every_room_has_its_line_in_the_page_about_the_architecture() -> None:
    text = (ROOT / "docs" / "architecture.md").read_text("utf-8")
    named = set(re.findall(r"^\| `([a-z_]+(?:\.py|/))`", text, re.MULTILINE))
    modules = {path.name for path in (ROOT / "ros_lint").glob("*.py")} - {"__init__.py", "__main__.py"}
    assert named == modules | {f"{path.parent.name}/" for path in (ROOT / "ros_lint").glob("*/__init__.py")}


def test_every_path_in_the_page_about_the_architecture_exists() -> None:
    text = (ROOT / "docs" / "architecture.md").read_text("utf-8")
    paths = {path for path in re.findall(r"`([\w/]+/[\w/.]+)`", text) if "<" not in path}
    lacking = [path for path in paths if not (ROOT / path).exists() and not (ROOT / "ros_lint" / path).exists()]
    assert lacking == []


def demo(*arguments: str) -> str:
    command = [sys.executable, "-m", "ros_lint", "fixtures/workspaces/demo", "--distro", "jazzy", *arguments]
    return subprocess.run(command, capture_output=True, text=True, cwd=ROOT, check=False).stdout


def example(kind: str, word: str) -> str:
    """Return the block of a kind in the page about adopting that has a word."""
    text = (ROOT / "docs" / "adopting.md").read_text("utf-8")
    return next(body for result, body in BLOCK.findall(text) if result == kind and word in body)


def test_the_problem_matcher_of_the_editor_matches_concise_output() -> None:
    pattern = json.loads(example("json", "problemMatcher"))["tasks"][0]["problemMatcher"]["pattern"]
    result = [match for line in demo("--format", "concise").splitlines() if (match := re.match(pattern["regexp"], line))]
    findings = json.loads(demo("--format", "json"))["findings"]
    keys = (("path", "file"), ("line", "line"), ("column", "column"), ("severity", "severity"), ("rule", "code"))
    assert sorted([match[pattern[group]] for _, group in keys] for match in result) == sorted(
        [str(finding[key]) for key, _ in keys] for finding in findings
    )
