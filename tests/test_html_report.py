"""The html format: escapes, and the filters in a browser."""

from __future__ import annotations

import re
from html.parser import HTMLParser
from pathlib import Path

import pytest

from ros_lint.reporters import html
from ros_lint.reporters.ansi import Style
from tests.browser import opened
from tests.reports import REPORTS, texts

HOSTILE = "</article><script>alert(1)</script><!--FINDINGS-->\x1b[31m\u202e"


class Elements(HTMLParser):
    """Counts the start tags and collects the texts of a page. Raises AssertionError for a wrong end tag."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: list[str] = []
        self.texts: list[str] = []

    def handle_starttag(self, tag: str, attrs: object) -> None:
        self.tags.append(tag)
        if tag not in ("meta", "input", "br"):
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        if tag != "option":
            while self.open[-1] == "option":
                self.open.pop()
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.texts.append(data)


@pytest.mark.parametrize("name", REPORTS)
def test_the_page_is_well_formed_and_has_every_finding(name: str) -> None:
    report = REPORTS[name]
    page = html.render(report, texts, Style())
    elements = Elements()
    elements.feed(page)
    elements.close()
    assert not elements.open
    assert elements.tags.count("article") == len(report.issues)
    assert elements.tags.count("script") == 1
    assert not re.search(r"""(?:src|href)=|url\(|@import|fetch\(""", page)


def test_hostile_texts_stay_texts() -> None:
    report = REPORTS["everything"]
    issues = tuple([issue._replace(package=HOSTILE, finding=issue.finding._replace(message=HOSTILE)) for issue in report.issues])
    page = html.render(report._replace(issues=issues), texts, Style())
    elements = Elements()
    elements.feed(page)
    assert elements.tags.count("script") == 1
    assert "\x1b" not in page
    assert "\u202e" not in page
    assert sum("</article><script>" in text for text in elements.texts) >= len(issues)


@pytest.mark.slow
def test_the_filters_in_a_browser(tmp_path: Path) -> None:
    report = REPORTS["everything"]
    with opened(tmp_path / "report.html", html.render(report, texts, Style())) as tab:
        errors = sum(str(issue.severity) == "error" for issue in report.issues)
        assert tab.inner_text("#shown") == f"{len(report.issues)} of {len(report.issues)} findings"
        tab.select_option("select[name=severity]", "error")
        assert tab.inner_text("#shown") == f"{errors} of {len(report.issues)} findings"
        tab.reload()
        assert tab.locator("article:visible").count() == errors, "the address keeps the filters"
        tab.fill("input[name=text]", "no finding has this text")
        assert tab.locator("article:visible").count() == 0
        tab.click("button[type=reset]")
        tab.wait_for_function("document.querySelectorAll('article[hidden]').length === 0")
