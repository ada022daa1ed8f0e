"""The JSON documents of the commands that answer questions follow their published schema."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

import ros_lint
from ros_lint.cli.main import main

jsonschema = pytest.importorskip("jsonschema")
ROOT = Path(__file__).parent.parent
DEMO = str(ROOT / "fixtures" / "workspaces" / "demo")
LAUNCH = str(ROOT / "fixtures" / "workspaces" / "launch")
SCHEMA = json.loads((Path(ros_lint.__file__).parent / "cli" / "commands" / "commands.schema.json").read_text("utf-8"))
ARGUMENTS: dict[str, Sequence[str]] = {
    "why": ("rover_bringup", "rclcpp", "-C", DEMO),
    "order": (LAUNCH,),
    "explain-package": ("rover_driver", "-C", DEMO),
    "graph": (DEMO, "--metrics"),
    "launch": ("-C", LAUNCH, "arm_bringup", "arm.launch.py", "side:=left"),
}


def closed(schema: Any) -> Any:
    """Return a schema that allows no keys but those that it names."""
    if isinstance(schema, list):
        return [closed(entry) for entry in schema]
    if not isinstance(schema, dict):
        return schema
    result = {name: closed(entry) for name, entry in schema.items()}
    return {**result, "additionalProperties": False} if "properties" in schema else result


def validate(command: str, document: Any) -> None:
    schema = {"$schema": SCHEMA["$schema"], "$defs": closed(SCHEMA["$defs"]), "$ref": f"#/$defs/{command}"}
    jsonschema.Draft202012Validator(schema).validate(document)


def answer(capsys: pytest.CaptureFixture[str], command: str, *arguments: str, code: int = 0) -> Any:
    assert main([command, *arguments, "--format", "json", "--distro", "jazzy", "--no-cache"]) == code
    return json.loads(capsys.readouterr().out)


@pytest.fixture(autouse=True)
def _no_underlay(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)


@pytest.mark.parametrize("command", ARGUMENTS)
def test_documents_follow_the_schema(capsys: pytest.CaptureFixture[str], command: str) -> None:
    validate(command, answer(capsys, command, *ARGUMENTS[command]))


def test_the_schema_rejects_a_document_with_a_missing_or_unknown_key(capsys: pytest.CaptureFixture[str]) -> None:
    document = answer(capsys, "order", LAUNCH)
    for changed in ({**document, "more": 1}, {name: value for name, value in document.items() if name != "complete"}):
        with pytest.raises(jsonschema.ValidationError):
            validate("order", changed)


def test_why_has_each_edge_with_its_tags_and_uses(capsys: pytest.CaptureFixture[str]) -> None:
    document = answer(capsys, "why", *ARGUMENTS["why"])
    for path in document["paths"]:
        assert path[0]["package"] == "rover_bringup"
        assert path[-1]["dependency"] == "rclcpp"
        assert [edge["dependency"] for edge in path[:-1]] == [edge["package"] for edge in path[1:]]
        assert all(edge["reasons"] for edge in path)
    assert document["paths"]
    document = answer(capsys, "why", "rover_interfaces", "rover_bringup", "-C", DEMO, code=1)
    assert (document["paths"], document["uses"]) == ([], [])


def test_order_has_the_problems_that_colcon_rejects(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    manifest = (
        '<package format="3"><name>{}</name><version>1.0.0</version><description>d</description>'
        '<maintainer email="a@robots.example">a</maintainer><license>Apache-2.0</license><depend>{}</depend>'
        "<export><build_type>ament_cmake</build_type></export></package>"
    )
    for name, depend in (("arm", "hand"), ("hand", "arm"), ("base", "rclcpp")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "package.xml").write_text(manifest.format(name, depend))
    document = answer(capsys, "order", str(tmp_path), code=1)
    validate("order", document)
    assert document["packages"] == [{"name": "base", "paths": ["base"]}]
    assert not document["complete"]
    assert document["problems"][0] == "no build order, because of a dependency cycle: arm, hand"


def test_overlay_says_which_layer_is_in_use(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    (tmp_path / "package.xml").write_text(
        '<package format="3"><name>rclcpp</name><version>1.2.3</version><description>d</description>'
        '<maintainer email="a@robots.example">a</maintainer><license>Apache-2.0</license></package>'
    )
    document = answer(capsys, "overlay", str(tmp_path))
    validate("overlay", document)
    (package,) = document["packages"]
    assert package["name"] == "rclcpp"
    assert [(layer["layer"], layer["in_use"]) for layer in package["layers"]] == [("workspace", True), ("distribution", False)]
    assert package["layers"][0]["version"] == "1.2.3"


def test_explanations_of_absence_have_no_json(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["why", "rover_driver", "rclcpp", "-C", DEMO, "--explain-silence", "--format", "json"]) == 2
    assert capsys.readouterr().err == "ros-lint: --explain-silence prints text only; remove --format\n"
