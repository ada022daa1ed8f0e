"""The docs as a site."""

from __future__ import annotations

import re
import subprocess
import sys
from html.parser import HTMLParser
from importlib.util import find_spec
from pathlib import Path

import pytest
import yaml

from ros_lint.engine import registry

ROOT = Path(__file__).parents[1]


def pages(nav: object) -> list[str]:
    """Return the files that a navigation lists."""
    if isinstance(nav, str):
        return [nav]
    entries = nav if isinstance(nav, list) else list(nav.values()) if isinstance(nav, dict) else []
    return [page for entry in entries for page in pages(entry)]


def test_the_navigation_lists_every_page() -> None:
    settings = yaml.safe_load((ROOT / "mkdocs.yml").read_text("utf-8"))
    documents = {path.name for path in (ROOT / "docs").glob("*.md")}
    assert sorted(pages(settings["nav"])) == sorted([*documents, "rules/README.md"])


@pytest.mark.slow
@pytest.mark.skipif(not find_spec("mkdocs"), reason="mkdocs is not installed")
def test_the_site_builds_without_warnings(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "--site-dir", str(tmp_path / "site")]
    process = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert (process.returncode, process.stderr) == (0, "")
    assert all((tmp_path / "site" / "rules" / rule.name / "index.html").exists() for rule in registry.load())


def test_every_picture_is_small_and_has_an_alternative_text() -> None:
    used = {
        (path.parent / target).resolve(): alternative
        for path in (ROOT / "docs").rglob("*.md")
        for alternative, target in re.findall(r"!\[(.*?)\]\((.*?)\)", path.read_text("utf-8"))
    }
    assert set(used) == set((ROOT / "docs" / "images").iterdir()), "packaging/screenshots.py writes the pictures"
    assert [path.name for path in used if path.stat().st_size > 150_000] == []
    assert all(len(alternative) > 40 for alternative in used.values())


class _Tags(HTMLParser):
    """The names of the elements of a page."""

    def __init__(self) -> None:
        super().__init__()
        self.names: set[str] = set()

    def handle_starttag(self, tag: str, attrs: object) -> None:
        self.names.add(tag)


def elements(text: str) -> set[str]:
    tags = _Tags()
    tags.feed(text)
    return tags.names


@pytest.mark.skipif(not find_spec("markdown"), reason="mkdocs is not installed")
def test_tags_of_package_xml_are_escaped() -> None:
    """Browsers hide an unescaped tag, such as <package> in a path."""
    from markdown import markdown

    html = {"a", "br", "code", "details", "em", "h1", "h2", "h3", "h4", "hr", "img", "li", "ol", "p", "pre", "strong", "summary"}
    html |= {"table", "thead", "tbody", "tr", "th", "td", "ul"}
    found = {
        path.name: names
        for path in (ROOT / "docs").rglob("*.md")
        if (names := elements(markdown(path.read_text("utf-8"), extensions=["tables", "fenced_code"])) - html)
    }
    assert found == {}
