"""``ros-lint launch``, compared with the real launch on files that use one construct each.

``tests/golden/real_launch.json`` has what launch 3.10.0 and launch_ros 0.30.1 start. If both can be imported, or
ROS_LINT_LAUNCH_PATH lists the folders to import them from, ``--bless`` writes the file again, and a test compares it.
"""

import json
import os
import re
import subprocess
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest

from ros_lint.cli import main as cli

PACKAGE = Path(__file__).parents[1] / "fixtures/workspaces/real_launch/src/constructs"
FILES = sorted((PACKAGE / "launch").iterdir())
GOLDEN = Path(__file__).parent / "golden" / "real_launch.json"
UNKNOWN = "?"


def _real() -> dict[str, Any] | None:
    """Return what the real launch starts, by file name; None if it cannot be imported."""
    path = os.environ.get("ROS_LINT_LAUNCH_PATH", "")
    packages = json.dumps({"constructs": str(PACKAGE), "demo_nodes_cpp": str(PACKAGE)})
    environment = {name: value for name, value in os.environ.items() if not name.startswith("ROS")} | {"PYTHONPATH": path}
    command = [sys.executable, str(Path(__file__).parent / "real_launch.py"), packages, *map(str, FILES)]
    run = subprocess.run(command, capture_output=True, text=True, env=environment, check=False)
    if "ModuleNotFoundError" in run.stderr + run.stdout:
        return None
    assert run.returncode == 0, run.stderr
    return {Path(file).name: items for file, items in json.loads(run.stdout).items()}


def _flat(items: list[dict[str, Any]]) -> Iterator[dict[str, Any]]:
    """Yield what a tree of includes starts, in order."""
    for item in items:
        if item["kind"] == "include":
            yield from _flat(item["starts"])
        else:
            yield item


def _pattern(values: list[str]) -> str:
    """Return a pattern of the texts that a value of ros-lint may have."""
    alternatives = (".*".join(map(re.escape, value.lstrip("/").split(UNKNOWN))) for value in values)
    return "|".join(alternatives)


def _matches(ours: Mapping[str, Any], real: Mapping[str, Any]) -> bool:
    """Return whether an item of ros-lint may be an item of launch."""
    if ours["kind"] != real["kind"]:
        return False
    if real["kind"] == "process":
        return re.fullmatch(_pattern(ours["target"]), " ".join(real["words"])) is not None
    texts = all(re.fullmatch(_pattern(ours[key]), real[key]) for key in ("package", "target", "name"))
    if real["kind"] == "component":
        return texts and re.fullmatch(_pattern(ours["container"]), real["container"].lstrip("/")) is not None
    pairs = [tuple(pair) for pair in real["remappings"]]
    return (
        texts
        and re.fullmatch(_pattern(ours["namespace"]), real["namespace"].lstrip("/")) is not None
        and [(remap["from"][0], remap["to"][0]) for remap in ours["remappings"]] == pairs
    )


def _is_exact(item: Mapping[str, Any]) -> bool:
    """Return whether ros-lint knows that an item starts once, and with which texts."""
    texts = [*item["package"], *item["target"], *item["name"], *item["namespace"]]
    return bool(item["certain"] and not item["when"] and not any(UNKNOWN in text for text in texts))


@pytest.mark.parametrize("file", FILES, ids=lambda file: str(file.name))
def test_each_item_of_launch_is_found_and_no_certain_item_is_false(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    real = json.loads(GOLDEN.read_text())[file.name]
    assert isinstance(real, list), "launch refuses the file"
    cli.main(["launch", str(file), "--format", "json", "--distro", "rolling"])
    ours = list(_flat(json.loads(capsys.readouterr().out)["starts"]))
    remaining = list(real)
    for item in filter(_is_exact, ours):
        match = next((other for other in remaining if _matches(item, other)), None)
        assert match is not None, f"launch does not start {item}"
        remaining.remove(match)
    inexact = [item for item in ours if not _is_exact(item)]
    assert [item for item in remaining if not any(_matches(other, item) for other in inexact)] == []


def test_most_items_are_exact(capsys: pytest.CaptureFixture[str]) -> None:
    exact = total = 0
    for file in FILES:
        cli.main(["launch", str(file), "--format", "json", "--distro", "rolling"])
        ours = list(_flat(json.loads(capsys.readouterr().out)["starts"]))
        exact += sum(map(_is_exact, ours))
        total += len(ours)
    assert exact / total > 0.9


@pytest.mark.slow
def test_the_expected_items_are_those_of_the_real_launch(request: pytest.FixtureRequest) -> None:
    real = _real()
    if real is None:
        pytest.skip("launch and launch_ros cannot be imported; ROS_LINT_LAUNCH_PATH may list their folders")
    if request.config.getoption("--bless"):
        GOLDEN.write_text(json.dumps(real, indent=1) + "\n")
    assert real == json.loads(GOLDEN.read_text())
