"""Rules of plugins: how they are loaded, selected, listed and blamed, and which of them are refused."""

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from ros_lint.analysis.finding import Finding, Severity
from ros_lint.analysis.rule import Rule
from ros_lint.base.text import Text
from ros_lint.base.tree import MemoryTree
from ros_lint.collectors.suppressions import collect
from ros_lint.engine import registry
from ros_lint.engine.plugins import Plugin, problems
from ros_lint.engine.run import run_rules
from ros_lint.engine.suppressions import apply_suppressions
from ros_lint.knowledge.store import KnowledgeError
from ros_lint.workspace.loader import Loader
from ros_lint.workspace.model import Package, Workspace
from ros_lint.workspace.target import TargetDistro
from tests.packages import manifest_text

ROOT = Path(__file__).parent.parent
DEMO = ROOT / "fixtures" / "workspaces" / "demo"
RULE_MODULE = """\
from ros_lint.api import Finding, Rule, Severity
def check(package, workspace):
    {body}
RULE = Rule('{name}', '{code}', 'a summary', Severity.ERROR, '1.0', '', package=check)
"""


def rule(name: str, code: str) -> Rule:
    return Rule(name, code, "a summary", Severity.ERROR, "1.0", "")


def plugin(name: str, *rules: tuple[str, str]) -> Plugin:
    return Plugin(f"{name} 1.0", tuple(rule(*words) for words in rules))


@pytest.mark.parametrize(
    ("plugins", "expected"),
    [
        ([plugin("a", ("old-name", "ACME001"), ("new-name", "ACME002"))], ""),
        ([plugin("a", ("a-x", "ACME001")), plugin("b", ("b-x", "ACMEB001"))], ""),
        (
            [plugin("a", ("old-name", "ROS999"))],
            "the plugin 'a 1.0': the code 'ROS999' of its rule 'old-name' begins with ROS, which is reserved for ros-lint; "
            "write other letters, such as 'ACME001'",
        ),
        (
            [plugin("a", ("old-name", "acme-1"))],
            "the plugin 'a 1.0': the code 'acme-1' of its rule 'old-name' is invalid; write capital letters and digits, "
            "such as 'ACME001'",
        ),
        (
            [plugin("a", ("a-x", "ACME001")), plugin("b", ("b-x", "ACME002"))],
            "the plugin 'a 1.0' and the plugin 'b 1.0' both have codes that begin with ACME, so their codes can collide; "
            "uninstall one of them",
        ),
        (
            [plugin("a", ("a-x", "ACME001"), ("a-y", "ACME001"))],
            "the plugin 'a 1.0' has two rules with the code 'ACME001'; give each rule a code of its own",
        ),
        (
            [plugin("a", ("missing-file", "ACME001"))],
            "the plugin 'a 1.0': the rule name 'missing-file' is already used by ros-lint; rename the rule of the plugin",
        ),
        (
            [plugin("a", ("x", "A1")), plugin("b", ("x", "B1"))],
            "the plugin 'b 1.0': the rule name 'x' is already used by the plugin 'a 1.0'; rename the rule of the plugin",
        ),
        (
            [plugin("a", ("all", "A1"))],
            "the plugin 'a 1.0': the rule name 'all' is invalid; write words with hyphens, such as 'old-name'",
        ),
    ],
)
def test_names_and_codes_that_are_invalid_or_collide_are_refused(plugins: list[Plugin], expected: str) -> None:
    assert "\n".join(problems(registry.load(), plugins)) == expected


@pytest.mark.parametrize(
    ("selector", "codes"),
    [
        ("ACME", ["ACME001", "ACME010"]),
        ("ACME01", ["ACME010"]),
        ("ACM", []),
        ("A", ["A1"]),
        ("acme", []),
        ("", []),
        ("ROS90", ["ROS901", "ROS902"]),
        ("RO", []),
    ],
)
def test_a_code_prefix_selects_the_rules_of_one_plugin(selector: str, codes: list[str]) -> None:
    rules = [*registry.load(), rule("x", "A1"), rule("y", "ACME001"), rule("z", "ACME010")]
    assert [matched.code for matched in registry.matching(rules, selector)] == codes


def test_a_suggestion_for_a_suppression_has_the_spelling_of_the_code() -> None:
    text = Text("a/CMakeLists.txt", "project(a)  # ros-lint: ignore[ACME0001] because\n")
    outcome = apply_suppressions((), collect(text), [rule("old-name", "ACME001")], ())
    assert [unknown.suggestion for unknown in outcome.use.unknown] == ["ACME001"]


@pytest.mark.parametrize(
    ("result", "error"),
    [
        (None, "TypeError: 'NoneType' object is not iterable"),
        (["text"], "TypeError: a rule must yield Finding, not str"),
        ([Finding("m", None, "s")], "TypeError: the span of a Finding must be a Span, not NoneType"),  # type: ignore[arg-type]
    ],
)
def test_an_invalid_result_of_a_rule_is_a_failure_of_the_rule(result: Any, error: str) -> None:
    tree = MemoryTree({"a/package.xml": manifest_text("a")})
    workspace = Loader(tree, ("",), TargetDistro("jazzy", "test")).load()
    for check, package in (({"package": lambda package, workspace: result}, "a"), ({"workspace": lambda workspace: result}, "")):
        issues, (crash,) = run_rules(workspace, [rule("acme-x", "ACME001")._replace(**check)])
        assert (issues, crash.rule, crash.package, crash.error) == ((), "acme-x", package, error)


def test_data_that_cannot_be_read_are_no_failure_of_a_rule() -> None:
    def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
        raise KnowledgeError("no index")

    workspace = Loader(MemoryTree({"a/package.xml": manifest_text("a")}), ("",), TargetDistro("jazzy", "test")).load()
    with pytest.raises(KnowledgeError, match="no index"):
        run_rules(workspace, [rule("acme-x", "ACME001")._replace(package=check)])


def install(site: Path, name: str, module: str, body: str = "yield Finding('mine', package.span, package.name)") -> None:
    """Install a plugin with one rule: ``module`` is the text of its module, or the code of its rule."""
    info = site / f"{name}-1.0.dist-info"
    info.mkdir(parents=True)
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(f"[ros_lint.rules]\n{name} = {name}_rules\n")
    text = RULE_MODULE.format(body=body, name=name, code=module) if module.isalnum() else module
    (site / f"{name}_rules.py").write_text(text)


def run(site: Path, *arguments: str | Path) -> subprocess.CompletedProcess[str]:
    path = os.pathsep.join([str(site), os.environ.get("PYTHONPATH", "")])
    command = [sys.executable, "-m", "ros_lint", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, cwd=ROOT, env={**os.environ, "PYTHONPATH": path}, check=False)


@pytest.fixture
def demo(tmp_path: Path) -> Path:
    return Path(shutil.copytree(DEMO, tmp_path / "ws"))


@pytest.mark.slow
def test_a_plugin_adds_rules(demo: Path, tmp_path: Path) -> None:
    site = tmp_path / "site"
    install(site, "mine", "MY001")
    assert "[mine]" not in run(site, demo, "--format", "concise").stdout
    for options in ((), ("--select", "mine"), ("--select", "MY001"), ("--select", "MY")):
        assert run(site, demo, "--plugins", "--format", "concise", *options).stdout.count("[mine]") == 5
    file = demo / "ros-lint.toml"
    file.write_text("plugins = true\n")
    process = run(site, demo, "--format", "concise")
    assert (process.returncode, "[mine]" in process.stdout) == (1, False)
    assert (
        f"ros-lint: {file}:1: 'plugins' has no effect in a configuration file, because it loads code; use --plugins"
        in process.stderr
    )
    assert f"{file}:1: 'plugins' has no effect" in run(site, "order", demo).stderr
    file.write_text("plugins = true\nselect = ['mine']\n")
    process = run(site, demo)
    assert f"{file}:1: 'plugins' has no effect" in process.stderr
    assert "unknown rule 'mine'" in process.stderr


@pytest.mark.slow
def test_a_rule_of_a_plugin_that_is_not_loaded_names_the_option(demo: Path, tmp_path: Path) -> None:
    install(tmp_path / "site", "mine", "MY001")
    (demo / "ros-lint.toml").write_text("[severity]\nmine = 'info'\n")
    process = run(tmp_path / "site", demo)
    assert process.returncode == 2
    assert (
        process.stderr
        == "ros-lint: ros-lint.toml:2: severity: unknown rule 'mine'; rules of installed plugins ('mine 1.0') need --plugins\n"
    )
    process = run(tmp_path, demo)
    assert (
        process.stderr
        == "ros-lint: ros-lint.toml:2: severity: unknown rule 'mine'; if a plugin has it, install the plugin and add --plugins\n"
    )
    assert "unknown rule 'mime'; did you mean 'mine'?\n" in run(tmp_path / "site", "rule", "mime", "--plugins").stderr


@pytest.mark.slow
def test_rules_of_plugins_are_listed_and_explained(tmp_path: Path) -> None:
    install(tmp_path / "site", "mine", "MY001")
    assert "MY001 " not in run(tmp_path / "site", "rules").stdout
    assert "MY001   mine " in run(tmp_path / "site", "rules", "--plugins").stdout
    assert run(tmp_path / "site", "rule", "my001", "--plugins").stdout.startswith("# mine (MY001)\n")
    listed = json.loads(run(tmp_path / "site", "rules", "--plugins", "--format", "json").stdout)
    assert {entry["group"] for entry in listed if entry["name"] in ("mine", "missing-file")} == {
        "Plugin mine 1.0",
        "Build scripts",
    }
    assert run(tmp_path / "site", "rule", "mine").returncode == 2


@pytest.mark.slow
def test_plugins_that_cannot_be_loaded_end_the_run(demo: Path, tmp_path: Path) -> None:
    site = tmp_path / "site"
    install(site, "bad", "import nothing_of_that_name\n")
    process = run(site, demo, "--plugins")
    assert process.returncode == 2
    expected = "the plugin 'bad 1.0' cannot be loaded (bad = bad_rules): No module named 'nothing_of_that_name'"
    assert process.stderr == f"ros-lint: {expected}\n"
    assert run(site, "rules", "--plugins").stderr == process.stderr
    (site / "bad_rules.py").unlink()
    shutil.rmtree(site / "bad-1.0.dist-info")
    install(site, "bad", "ROS299")
    assert "the code 'ROS299' of its rule 'bad' begins with ROS" in run(site, demo, "--plugins").stderr


@pytest.mark.slow
def test_a_crashing_rule_names_its_plugin_and_hides_no_finding_of_another_rule(demo: Path, tmp_path: Path) -> None:
    site = tmp_path / "site"
    install(site, "bad", "BAD01", "raise ValueError('oh')")
    process = run(site, demo, "--plugins", "--format", "json")
    assert process.returncode == 2
    report = json.loads(process.stdout)
    shown = json.loads(run(site, demo, "--format", "json").stdout)
    assert report["findings"] == shown["findings"] != []
    assert {(crash["rule"], crash["plugin"]) for crash in report["crashes"]} == {("bad", "bad 1.0")}
    assert "ValueError: oh" in report["crashes"][0]["traceback"]
    text = run(site, demo, "--plugins").stdout
    assert "5 checks failed. This is a bug in the plugin 'bad 1.0'; please report it to its author:\n" in text
    assert "  bad of the plugin 'bad 1.0' for rover_bringup: ValueError: oh\n" in text
