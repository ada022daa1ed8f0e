"""The examples of docs/writing-a-rule.md and docs/api.md work as written."""

import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from ros_lint.base.tree import MemoryTree
from ros_lint.engine import edits
from ros_lint.testing import differences, read_cases
from ros_lint.workspace.loader import Loader
from ros_lint.workspace.target import TargetDistro
from tests.packages import manifest_text

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

DOCS = Path(__file__).parent.parent / "docs"
FILE = re.compile(r"^`(?P<path>[^`\n]+)`\n\n(?P<fence>`{3,})\w+\n(?P<body>.*?)^(?P=fence)$", re.MULTILINE | re.DOTALL)


@pytest.fixture
def plugin(tmp_path: Path) -> Path:
    """Return the folder of the documented plugin, with the metadata that pip writes from its pyproject.toml."""
    section = (
        (DOCS / "writing-a-rule.md").read_text("utf-8").partition("## A plugin from nothing")[2].partition("\n## The module")[0]
    )
    for match in FILE.finditer(section):
        path = tmp_path / match["path"]
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(match["body"], "utf-8")
    (tmp_path / "src" / "acme_rules" / "__init__.py").touch()
    project = tomllib.loads((tmp_path / "pyproject.toml").read_text("utf-8"))["project"]
    metadata = tmp_path / "src" / "acme_rules-1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {project['name']}\nVersion: {project['version']}\n")
    entries = project["entry-points"]["ros_lint.rules"]
    (metadata / "entry_points.txt").write_text("[ros_lint.rules]\n" + "".join(f"{key} = {entries[key]}\n" for key in entries))
    return tmp_path


def run(folder: Path, *arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    path = os.pathsep.join([str(folder / "src"), os.environ.get("PYTHONPATH", "")])
    return subprocess.run(
        [sys.executable, "-m", *arguments],
        capture_output=True,
        text=True,
        cwd=folder,
        env={**os.environ, "PYTHONPATH": path, **environment},
        check=False,
    )


def test_the_cases_of_the_documented_plugin_pass_after_blessing(plugin: Path) -> None:
    assert run(plugin, "pytest", "-q", "-p", "no:cacheprovider").returncode == 1
    assert run(plugin, "pytest", "-q", "-p", "no:cacheprovider", BLESS="1").returncode == 0
    done = run(plugin, "pytest", "-q", "-p", "no:cacheprovider")
    assert done.returncode == 0, done.stdout
    assert "+  <depend>acme_msgs</depend>" in (plugin / "tests" / "renamed-package.md").read_text("utf-8")


def test_the_documented_plugin_runs_on_a_workspace(plugin: Path) -> None:
    case = next(read_cases(plugin / "tests" / "renamed-package.md"))
    for path, text in case.files.items():
        file = plugin / "ws" / path
        file.parent.mkdir(parents=True)
        file.write_text(text, "utf-8")
    options = ("ros_lint", "--plugins", "--select", "renamed-package")
    assert "warning: 'acme_old_msgs' was renamed" in run(plugin, *options, "--format", "concise", "ws").stdout
    changed = run(plugin, *options, "--fix", "--unsafe-fixes", "--diff", "ws").stdout
    assert "+  <depend>acme_msgs</depend>" in changed


def example(page: str, word: str) -> dict[str, Any]:
    """Return the names that the Python example with a word defines."""
    blocks = re.findall(r"^```python\n(.*?)^```$", (DOCS / page).read_text("utf-8"), re.MULTILINE | re.DOTALL)
    namespace: dict[str, Any] = {"__name__": "example"}
    exec(compile(next(block for block in blocks if word in block), page, "exec"), namespace)
    return namespace


def test_the_first_example_of_the_page_of_the_api(tmp_path: Path) -> None:
    cases = tmp_path / "boost-header.md"
    cases.write_text(
        "## A header of Boost is reported\n\npackage robot (ament_cmake): depend boost\n\n`robot/CMakeLists.txt`\n\n```cmake\n"
        "project(robot)\nfind_package(ament_cmake REQUIRED)\nadd_executable(a a.cpp)\nament_package()\n```\n\n`robot/a.cpp`\n\n"
        "```cpp\n#include <boost/any.hpp>  // want \"'boost/any.hpp' is included\"\n#include <any>\nint main() {}\n```\n",
        "utf-8",
    )
    (case,) = read_cases(cases)
    assert list(differences(case, example("api.md", "boost")["RULE"])) == []


@pytest.mark.parametrize(
    ("name", "text", "expected"),
    [
        (
            "a.launch.py",
            "from launch_ros.actions import Node\ndef generate_launch_description():\n"
            '    return [Node(package="a", executable="b")]\n',
            '[Node(package="a", executable="b", output="screen")]',
        ),
        ("a.launch.xml", '<launch>\n  <node pkg="a" exec="b"/>\n</launch>\n', '<node pkg="a" exec="b" output="screen"/>'),
        (
            "a.launch.yaml",
            "launch:\n  - node:\n      pkg: a\n      exec: b\n",
            "  - node:\n      pkg: a\n      output: screen\n      exec: b\n",
        ),
        ("b.launch.yaml", "launch:\n  - node: {pkg: a, exec: b}\n", ""),
    ],
)
def test_the_examples_about_launch_files(name: str, text: str, expected: str) -> None:
    tree = MemoryTree({"a/package.xml": manifest_text("a"), f"a/{name}": text})
    ((file,),) = [package.launch for package in Loader(tree, ("",), TargetDistro("jazzy", "test")).load().packages]
    assert example("writing-a-rule.md", "def executables")["executables"](file) == ["b"]
    fix = example("writing-a-rule.md", "def set_output")["set_output"](file, file.actions[0])
    changed = edits.apply([fix], lambda path: edits.text_of(tree, path))[f"a/{name}"] if fix else ""
    assert expected in changed
    assert bool(changed) == bool(expected)
