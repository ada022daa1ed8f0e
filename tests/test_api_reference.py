"""docs/api.md is what the docstrings say, and the docstrings say something."""

import ast
import re

import pytest

import ros_lint.api
from tests import api_reference
from tests.api_reference import ROOT, Definition

PAGE = ROOT / "docs" / "api.md"
CONTENTS = "\n\n## Contents\n"
SHOWN = [(name, definition) for section in api_reference.sections() for name, definition in section.members]


def test_the_page_of_the_api(request: pytest.FixtureRequest) -> None:
    head = PAGE.read_text("utf-8").partition(CONTENTS)[0]
    text = api_reference.page(head)
    if request.config.getoption("bless"):
        PAGE.write_text(text, "utf-8")
    assert PAGE.read_text("utf-8") == text, "run pytest tests/test_api_reference.py --bless"


def test_every_exported_name_is_on_the_page() -> None:
    names = {name for name, _ in SHOWN} | {section.title for section in api_reference.sections()}
    assert set(ros_lint.api.__all__) - names == set()


@pytest.mark.parametrize(("name", "definition"), SHOWN, ids=[name for name, _ in SHOWN])
def test_every_name_has_a_docstring(name: str, definition: Definition) -> None:
    assert definition.doc
    if isinstance(definition.node, ast.ClassDef):
        attributes = api_reference.public_attributes(definition.node)
        assert [attribute.name for attribute in attributes if not attribute.doc] == []
        assert [method.name for method in api_reference.methods(definition.node) if not ast.get_docstring(method)] == []


def test_links_lead_to_headings() -> None:
    anchors = set(api_reference.anchors_of(api_reference.sections()).values()) | {"edits"}
    assert set(re.findall(r"\]\(#([^)]*)\)", PAGE.read_text("utf-8"))) - anchors == set()
