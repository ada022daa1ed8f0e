"""``--since``: only findings that the commit of a branch point has not are shown."""

from __future__ import annotations

import json
import os
import subprocess
from collections import Counter
from pathlib import Path
from typing import Any

import pytest

from ros_lint.cli import git_commits
from ros_lint.cli.main import main
from ros_lint.workspace import collect as collecting
from tests.packages import manifest_text

CMAKE = "cmake_minimum_required(VERSION 3.8)\nproject({name})\nfind_package(ament_cmake REQUIRED)\n{more}ament_package()\n"


def git(folder: Path, *arguments: str) -> str:
    command = ["git", "-c", "user.name=a", "-c", "user.email=a@b.cc", "-c", "init.defaultBranch=main", *arguments]
    return subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True).stdout.strip()


def write(repository: Path, name: str, more: str = "", *depends: str) -> None:
    (repository / name).mkdir(exist_ok=True)
    lines = ["<buildtool_depend>ament_cmake</buildtool_depend>", *(f"<depend>{depend}</depend>" for depend in depends)]
    (repository / name / "package.xml").write_text(manifest_text(name, lines), "utf-8")
    (repository / name / "CMakeLists.txt").write_text(CMAKE.format(name=name, more=more), "utf-8")


@pytest.fixture
def repository(tmp_path: Path) -> Path:
    """A repository with a finding in its first commit, in the package arm."""
    root = tmp_path / "repository"
    root.mkdir()
    git(root, "init", "-q")
    write(root, "arm", "add_executable(node missing.cpp)\n")
    write(root, "hand")
    (root / "link").symlink_to("arm")
    git(root, "add", "-A")
    git(root, "commit", "-qm", "first")
    return root


def report(capsys: pytest.CaptureFixture[str], *arguments: str | Path, code: int = 1) -> Any:
    assert main([*map(str, arguments), "--format", "json", "--no-cache", "--distro", "jazzy"]) == code
    return json.loads(capsys.readouterr().out)


def keys(document: Any) -> Counter[tuple[str, str, str]]:
    return Counter((finding["rule"], finding["package"], finding["subject"]) for finding in document["findings"])


def test_nothing_is_new_in_an_unchanged_tree(repository: Path, capsys: pytest.CaptureFixture[str]) -> None:
    document = report(capsys, repository, "--since", "HEAD", code=0)
    assert document["findings"] == []
    assert [entry["reason"][:18] for entry in document["hidden"] if "commit" in entry["reason"]] == ["also in the commit"]


def test_findings_of_the_working_tree_and_of_commits_since_the_branch_point_are_new(
    repository: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    git(repository, "checkout", "-qb", "topic")
    before = report(capsys, repository)
    write(repository, "hand", "add_executable(node committed.cpp)\n")
    git(repository, "commit", "-qam", "second")
    write(repository, "head", "add_executable(node untracked.cpp)\n")
    git(repository, "checkout", "-q", "main")
    git(repository, "commit", "-q", "--allow-empty", "-m", "other")
    git(repository, "checkout", "-q", "topic")
    after = report(capsys, repository)
    new = keys(report(capsys, repository, "--since", "main"))
    assert new == keys(after) - keys(before)
    assert {"committed.cpp", "untracked.cpp"} <= {subject for _, _, subject in new}


def test_a_finding_in_a_package_that_did_not_change_is_new_if_its_cause_is(
    repository: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    launch = "from launch import LaunchDescription\nfrom launch_ros.actions import Node\n\n\ndef generate_launch_description():\n"
    (repository / "hand" / "start.launch.py").write_text(
        f'{launch}    return LaunchDescription([Node(package="arm", executable="node")])\n', "utf-8"
    )
    write(repository, "hand", "install(FILES start.launch.py DESTINATION share/${PROJECT_NAME})\n", "arm", "launch_ros")
    write(repository, "arm", "add_executable(node node.cpp)\ninstall(TARGETS node DESTINATION lib/${PROJECT_NAME})\n")
    (repository / "arm" / "node.cpp").write_text("int main() {}\n", "utf-8")
    git(repository, "add", "-A")
    git(repository, "commit", "-qm", "second")
    write(repository, "arm")
    new = keys(report(capsys, repository, "--since", "HEAD"))
    assert {(rule, package) for rule, package, _ in new} == {("launch-unknown-executable", "hand")}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--since", "nothing"], "--since: 'nothing' is not a commit of "),
        (["--since", "--all"], "expected one argument"),
        (["--since", "HEAD", "--fix"], "--since only shows findings; it cannot be combined with --fix"),
    ],
)
def test_an_invalid_use_is_an_error(
    arguments: list[str], message: str, repository: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    try:
        code = main([str(repository), "--no-cache", *arguments])
    except SystemExit as end:
        code = int(end.code or 0)
    assert code == 2
    assert message in capsys.readouterr().err


def test_a_folder_without_a_repository_is_an_error(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write(tmp_path, "arm")
    assert main([str(tmp_path), "--no-cache", "--since", "HEAD"]) == 2
    assert "--since needs paths in a git repository" in capsys.readouterr().err


def test_no_program_of_the_configuration_runs(repository: Path, tmp_path: Path) -> None:
    (repository / ".gitattributes").write_text("* filter=evil\n", "utf-8")
    git(repository, "add", "-A")
    git(repository, "commit", "-qm", "second")
    mark = tmp_path / "ran"
    for key in ("filter.evil.smudge", "filter.evil.clean", "core.fsmonitor", "core.pager", "core.sshCommand", "diff.external"):
        git(repository, "config", key, f"touch {mark}; cat")
    out = tmp_path / "out"
    out.mkdir()
    commit = git_commits.merge_base(str(repository), "HEAD", os.environ)
    git_commits.write_files(str(repository), commit, str(out), os.environ)
    assert not mark.exists()
    assert (out / "arm" / "CMakeLists.txt").read_bytes() == (repository / "arm" / "CMakeLists.txt").read_bytes()
    assert os.readlink(out / "link") == "arm"


def test_files_that_the_commit_shares_are_found_in_the_cache(
    repository: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    write(repository, "hand", "add_executable(node new.cpp)\n")
    command = [str(repository), "--format", "json", "--distro", "jazzy"]
    main([*command])
    (file,) = (tmp_path / "cache" / "ros-lint").glob("*.cache")
    before = file.read_bytes()
    analysed: list[str] = []
    collect = collecting.collect
    monkeypatch.setattr(collecting, "collect", lambda text, kind: analysed.append(text.path) or collect(text, kind))
    capsys.readouterr()
    assert main([*command, "--since", "HEAD"]) == 1
    assert {finding["subject"] for finding in json.loads(capsys.readouterr().out)["findings"]} == {"new.cpp"}
    assert (analysed, file.read_bytes()) == (["hand/CMakeLists.txt"], before)
