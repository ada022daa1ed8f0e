"""The files for continuous integration."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import yaml
from packaging.requirements import Requirement
from packaging.specifiers import SpecifierSet
from packaging.utils import canonicalize_name

from ros_lint.cli.options import OPTIONS

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROOT = Path(__file__).parents[1]
WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))
ACTION = ROOT / "action.yml"
CHECK = ROOT / "integrations" / "github" / "check.sh"
DEMO = ROOT / "fixtures" / "workspaces" / "demo"
USES = re.compile(r"uses: (\S+)@(\S+)")
PAGES = [ROOT / "docs" / "ci.md", ROOT / "docs" / "colcon.md"]


def steps(document: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the steps of an action or a workflow."""
    if "runs" in document:
        return list(document["runs"]["steps"])
    return [step for job in document["jobs"].values() for step in job["steps"]]


@pytest.mark.parametrize("path", [ACTION, *WORKFLOWS], ids=lambda path: path.name)
def test_actions_are_pinned_and_no_script_contains_a_template(path: Path) -> None:
    text = path.read_text("utf-8")
    assert all(re.fullmatch(r"[0-9a-f]{40}", version) for _, version in USES.findall(text))
    assert not [step["run"] for step in steps(yaml.safe_load(text)) if "${{" in step.get("run", "")]


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.name)
def test_a_workflow_has_no_permissions_except_for_those_of_its_jobs(path: Path) -> None:
    document = yaml.safe_load(path.read_text("utf-8"))
    assert document["permissions"] == {}
    assert all(job["permissions"] for job in document["jobs"].values())


def test_every_dependency_has_a_fixed_version_in_ci() -> None:
    """The versions must satisfy the requirements, or pip finds no solution."""
    lines = (ROOT / "packaging" / "constraints.txt").read_text("utf-8").splitlines()
    fixed = [Requirement(line) for line in lines if not line.startswith("#")]
    versions: dict[str, list[str]] = {}
    for requirement in fixed:
        ((_, version),) = [(specifier.operator, specifier.version) for specifier in requirement.specifier]
        assert requirement.specifier == SpecifierSet(f"=={version}")
        versions.setdefault(canonicalize_name(requirement.name), []).append(version)
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    extras = project["optional-dependencies"]
    wanted = [Requirement(text) for group in (project["dependencies"], *extras.values()) for text in group]
    for requirement in [requirement for requirement in wanted if requirement.name != "ros-lint"]:
        found = versions[canonicalize_name(requirement.name)]
        assert all(requirement.specifier.contains(version) for version in found), requirement


def test_every_input_of_the_action_is_documented() -> None:
    inputs = set(yaml.safe_load(ACTION.read_text("utf-8"))["inputs"])
    page = (ROOT / "docs" / "ci.md").read_text("utf-8")
    assert (
        set(re.findall(r"^\| `([a-z-]+)` \|", page.partition("| input |")[2].partition("## GitLab")[0], re.MULTILINE)) == inputs
    )


def test_the_hooks_check_the_whole_workspace() -> None:
    for hook in yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text("utf-8")):
        assert (hook["pass_filenames"], hook["always_run"], hook["require_serial"]) == (False, True, True)
        assert hook["minimum_pre_commit_version"] == "3.2.0"  # the names of the stages


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.name)
def test_blocks_of_yaml_are_valid_and_options_exist(path: Path) -> None:
    text = path.read_text("utf-8")
    for block in re.findall(r"^```yaml\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
        assert yaml.safe_load(block)
    commands = re.findall(r"(?<![/\w])ros-lint (\$?[./\w]*(?: --[^\n|'`&]*)?)", text)
    options = {word for command in commands for word in re.findall(r"--[a-z][a-z-]+", command)}
    known = {f"--{option.name}" for option in OPTIONS} | {"--no-cache"}
    assert {option for option in options if not option.startswith(("--packages", "--base", "--ros-lint", "--xunit"))} <= known


@pytest.mark.slow
def test_the_script_of_the_action_sets_outputs_and_annotates(tmp_path: Path) -> None:
    """pip is replaced: the environment of the test has ros-lint."""
    programs = tmp_path / "ros-lint" / "venv" / "bin"
    programs.mkdir(parents=True)
    (programs / "pip").write_text("#!/bin/sh\n")
    (programs / "ros-lint").symlink_to(Path(sys.executable).parent / "ros-lint")
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin" / "python3").write_text("#!/bin/sh\n")
    for program in (programs / "pip", tmp_path / "bin" / "python3"):
        program.chmod(0o755)
    output, summary = tmp_path / "output", tmp_path / "summary"
    variables = {
        "PATH": f"{tmp_path / 'bin'}:/usr/bin:/bin",
        "HOME": str(tmp_path),
        "RUNNER_TEMP": str(tmp_path),
        "GITHUB_OUTPUT": str(output),
        "GITHUB_STEP_SUMMARY": str(summary),
        "ROS_LINT_ACTION": str(ROOT),
        "ROS_LINT_PATH": str(DEMO),
        "ROS_LINT_DISTRO": "jazzy",
        "ROS_LINT_ARGS": "--ignore\nunused-dependency",
    }
    process = subprocess.run(["bash", str(CHECK)], env=variables, capture_output=True, text=True, timeout=120, check=False)
    assert process.returncode == 0, process.stderr
    assert process.stdout.startswith("::error ")
    assert "unused-dependency" not in process.stdout
    sarif = tmp_path / "ros-lint" / "ros-lint.sarif"
    assert output.read_text() == f"sarif-file={sarif}\nexit-code=1\n"
    assert sarif.exists()
    assert "undeclared-dependency" in summary.read_text()
