"""``ros-lint new-rule``: the plugin that it writes works, and nothing is overwritten."""

import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from ros_lint.cli.commands import new_rule
from ros_lint.cli.main import main
from ros_lint.engine.plugins import Plugin, problems
from ros_lint.engine.registry import load
from ros_lint.testing import differences, read_cases

ROOT = Path(__file__).parent.parent


def test_the_cases_of_a_new_rule_pass(tmp_path: Path) -> None:
    new_rule.write(str(tmp_path / "new"), new_rule.files("acme-old-name", "ACME001"))
    namespace: dict[str, Any] = {"__name__": "rule"}
    source = (tmp_path / "new" / "src" / "acme_old_name" / "rule.py").read_text("utf-8")
    exec(compile(source, "rule.py", "exec"), namespace)
    rule = namespace["RULE"]
    assert list(problems(load(), [Plugin("acme-old-name 1.0", (rule,))])) == []
    cases = list(read_cases(tmp_path / "new" / "tests" / "acme-old-name.md"))
    assert [bool(case.wants()) for case in cases] == [True, False]
    assert [list(differences(case, rule)) for case in cases] == [[], []]


@pytest.mark.parametrize(
    ("version", "expected"),
    [("0.1.0", ">=0.1,<0.2"), ("0.10.3", ">=0.10,<0.11"), ("1.4.2", ">=1.4,<2"), ("2.0.0rc1", ">=2.0,<3")],
)
def test_the_bounds_of_ros_lint_follow_semantic_versioning(version: str, expected: str) -> None:
    assert new_rule.bounds(version) == expected


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["address"], "new-rule: a later version of ros-lint may have a rule 'address'; begin the name with a word of your own"),
        (["ros-x", "--code", "X1"], "begin the name with a word of your own, such as 'acme-x'"),
        (["ros-x"], "the code 'ROS001' of its rule 'ros-x' begins with ROS, which is reserved for ros-lint"),
        (["Acme-X"], "the rule name 'Acme-X' is invalid; write words with hyphens, such as 'old-name'"),
        (["../acme-x"], "the rule name '../acme-x' is invalid"),
        (["missing-file"], "the rule name 'missing-file' is already used by ros-lint; rename the rule of the plugin"),
        (["acme-x", "--code", "x"], "the code 'x' of its rule 'acme-x' is invalid; write capital letters and digits"),
        (["there-already"], "new-rule: 'there-already' exists, and new-rule overwrites nothing; choose another name"),
    ],
)
def test_invalid_names_and_existing_folders_are_refused(
    arguments: list[str], message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "there-already").mkdir()
    (tmp_path / "there-already" / "README.md").write_text("mine")
    assert main(["new-rule", *arguments]) == 2
    assert message in capsys.readouterr().err
    assert [str(path.relative_to(tmp_path)) for path in tmp_path.rglob("*")] == ["there-already", "there-already/README.md"]
    assert (tmp_path / "there-already" / "README.md").read_text() == "mine"


@pytest.mark.slow
def test_the_tests_of_a_new_rule_pass_in_a_fresh_environment(tmp_path: Path) -> None:
    """By the command of its README. The new environment has ros-lint as pip installs it, so ``new-rule`` works there, too."""
    environment = {**os.environ, "ROS_LINT": str(ROOT)}
    subprocess.run([sys.executable, "-m", "ros_lint", "new-rule", "acme-old-name"], cwd=tmp_path, check=True)
    folder = tmp_path / "acme-old-name"
    command = re.search(r"^python3 -m venv .*$", (folder / "README.md").read_text("utf-8"), re.MULTILINE)
    assert command
    done = subprocess.run(command[0], shell=True, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "3 passed" in done.stdout
    listed = subprocess.run([".venv/bin/ros-lint", "rules", "--plugins"], cwd=folder, capture_output=True, text=True, check=True)
    assert "ACME001  acme-old-name " in listed.stdout
    subprocess.run([".venv/bin/ros-lint", "new-rule", "beta-old-name"], cwd=folder, check=True)
    assert (folder / "beta-old-name" / "src" / "beta_old_name" / "rule.py").is_file()
