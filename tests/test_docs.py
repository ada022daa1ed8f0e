"""Every example in the docs is what the tool does."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

from ros_lint import docs, registry
from ros_lint.config import read
from ros_lint.options import OPTIONS

ROOT = Path(__file__).parent.parent
PAGES = ROOT / "docs" / "rules"
RULES = registry.load()
CONSOLE = re.compile(r"^```console\n\$ ros-lint (?P<arguments>[^\n]*)\n(?P<output>.*?)^```$", re.MULTILINE | re.DOTALL)
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]


def check(path: Path, text: str, request: pytest.FixtureRequest) -> None:
    if request.config.getoption("bless"):
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, "utf-8")
    assert path.read_text("utf-8") == text, "run pytest --bless"


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.name)
def test_the_page_of_a_rule(rule: registry.Rule, request: pytest.FixtureRequest) -> None:
    check(PAGES / f"{rule.name}.md", docs.page(rule), request)


def test_the_list_of_rules(request: pytest.FixtureRequest) -> None:
    check(PAGES / "README.md", docs.overview(RULES), request)


def test_no_page_without_a_rule() -> None:
    assert {page.stem for page in PAGES.glob("*.md")} == {rule.name for rule in RULES} | {"README"}


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_console_examples(document: Path, request: pytest.FixtureRequest) -> None:
    text = document.read_text("utf-8")

    def run(match: re.Match[str]) -> str:
        command = [sys.executable, "-m", "ros_lint", *match["arguments"].split()]
        done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, check=False)
        return f"```console\n$ ros-lint {match['arguments']}\n{done.stdout}{done.stderr}```"

    check(document, CONSOLE.sub(run, text), request)


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_settings_examples(document: Path, tmp_path: Path) -> None:
    for kind, body in BLOCK.findall(document.read_text("utf-8")):
        if kind != "toml" or "project.entry-points" in body:
            continue
        (tmp_path / "ros-lint.toml").write_text(body, "utf-8")
        assert read(str(tmp_path / "ros-lint.toml"))


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_python_examples_compile(document: Path) -> None:
    for kind, body in BLOCK.findall(document.read_text("utf-8")):
        if kind == "python":
            compile(body, str(document), "exec")


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_links_lead_somewhere(document: Path) -> None:
    for target in re.findall(r"\]\(([^)#]+)\)", document.read_text("utf-8")):
        if "://" not in target:
            assert (document.parent / target).exists(), target


def test_rules_and_settings_named_in_the_docs_exist() -> None:
    names = {rule.name for rule in RULES} | {option.name for option in OPTIONS}
    text = (ROOT / "README.md").read_text("utf-8")
    for name in re.findall(r"^\s*\"?([a-z]+(?:-[a-z]+)+)\"? = ", text, re.MULTILINE):
        assert name in names, name
    for listed in re.findall(r"(?:ignore|select) = \[([^\]]*)\]", text):
        for name in re.findall(r'"([^"]+)"', listed):
            assert name in names, name
